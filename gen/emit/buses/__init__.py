"""Buses in Ada: codecs, layout tables, controllers; and the DBC."""
