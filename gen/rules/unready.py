"""What is checked and analysed, and cannot be generated yet: told before anything is written."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.model.system import System

UNREADY = "RV-0804"
"""The model is checked and analysed, but not generated yet."""


def unready(system: System) -> Iterator[Diagnostic]:
    """An error for each element that has no code yet."""
    for node in system.nodes:
        if node.cores > 1:
            text = f"{node.name} has {node.cores} cores: several are analysed, not generated yet"
            yield error(UNREADY, node.origin, text, hint="put all processors on one core")
