"""What a system must keep to be valid, each with its code."""
