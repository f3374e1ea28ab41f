"""The timing certificate in Ada, and what the program takes from it."""
