"""Proof mutation score: generated code broken in small ways, and who notices."""
