"""The program of a node: its tasks, supervision, reports and project."""
