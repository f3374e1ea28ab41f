"""Ada as nodes, their only printer, and the names of generated units."""
