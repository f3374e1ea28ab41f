"""The command line: it composes `gen`, `analysis` and the bench, and touches files."""
