"""Texts of a model while they are edited: where they say what, and what they come to."""
