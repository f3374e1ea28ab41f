"""Commands in Ada: devices, calls, and both between nodes."""
