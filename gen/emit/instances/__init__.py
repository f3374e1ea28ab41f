"""Instances in Ada: protected objects, and the rows over them."""
