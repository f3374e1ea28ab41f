"""Timing analysis of a `System`: response times, bus load, and the report."""
