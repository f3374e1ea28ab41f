"""Periodic rows of a model put together anew: tables searched, and judged by the whole model."""
