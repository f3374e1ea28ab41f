"""What is printed for people: tables in at most 80 columns, and progress while they wait.

Colour is for terminals alone. https://no-color.org holds: a `NO_COLOR` that is not empty means
no colour, and no other style. So does `TERM=dumb`. Progress needs a terminal at standard error,
and never gets into standard output.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

WIDTH = 80
"""Columns of what is printed."""


def console(width: int | None = WIDTH, *, errors: bool = False) -> Console:
    """Standard output, or error, with styles only where a terminal shall show them."""
    from rich.console import Console

    class Ours(Console):
        """Leaves a broken pipe to `start`, where rich would end with status 1."""

        def on_broken_pipe(self) -> None:
            raise

    plain = bool(os.environ.get("NO_COLOR")) or os.environ.get("TERM") == "dumb"
    return Ours(width=width, highlight=False, stderr=errors, color_system=None if plain else "auto")


@contextmanager
def progress(text: str) -> Iterator[Callable[[str], None]]:
    """Say what is going on for the time of a block; the function changes the text."""
    if not (sys.stderr.isatty() and os.environ.get("TERM") != "dumb"):
        yield lambda _: None
        return
    out = console(None, errors=True)
    with out.status(text) as status:
        yield lambda changed: status.update(changed)
