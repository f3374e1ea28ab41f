"""What commands on a model share: how it is named, checked and written."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ravenchart.building.checking import Checked
    from ravenchart.building.generation import Written


def add_model(sub: argparse.ArgumentParser) -> None:
    """The model that the command is about."""
    sub.add_argument("model", type=Path, metavar="MODEL", help="the model's YAML file")


def checked(
    options: argparse.Namespace, *, deadlines: bool = True, finish: bool = False
) -> Checked:
    """The model, with its warnings printed; Refused with its errors."""
    from ravenchart.building import checking

    found = checking.check(options.model, deadlines=deadlines, finish=finish)
    if found.warnings:
        print(found.warnings, file=sys.stderr)
    return found


def several(count: int, what: str) -> str:
    """A count in words: `1 file`, `2 files`."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def tell_written(written: Written) -> None:
    """What a generation did, and what is still to write."""
    from ravenchart.building.generation import EDITED

    print(f"{written.folder}: {several(written.files, 'file')}, {written.changed} changed")
    for name in written.edited:
        print(
            f"warning: {written.folder / name} was edited by hand and is generated again; "
            f"your version is kept as {name}{EDITED}",
            file=sys.stderr,
        )
    for path in written.untouched:
        state = (
            "new; its bodies do nothing yet"
            if path in written.first
            else "its bodies do nothing yet"
        )
        print(f"note: {path}: {state}. Write them: the file is yours", file=sys.stderr)
