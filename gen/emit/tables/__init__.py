"""The rows of processors in Ada: what is executed, and what the trace says of it."""
