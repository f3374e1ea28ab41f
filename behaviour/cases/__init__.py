"""Test cases of charts: event files that take every transition and decide every guard both ways."""
