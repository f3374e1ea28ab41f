"""One test suite over any python-can interface that has two ends on one bus."""
