# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The files that a generation writes, and the list of them beside them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

MANIFEST = "generated.list"
"""SHA-256 and name of each file of the last generation, as `sha256sum` prints them.

Only these files are ever deleted, and an edit of one of them is noticed.
"""


EDITED = ".edited"
"""Ending of the copy that is kept of an edited file."""


@dataclass(frozen=True, slots=True)
class Written:
    """The result of a generation.

    ``files`` were generated, the manifest not counted; of these ``changed`` have other bytes
    than before. ``edited`` had been changed by hand: their copies lie beside them.
    ``first`` are units of the user that were not there and got a first version; ``untouched``
    are those that are still as first written, and do nothing. ``manifest`` and ``user`` have the
    SHA-256 of the list of files, and of each file of the user that the program needs.
    """

    folder: Path
    files: int
    changed: int
    edited: tuple[str, ...]
    first: tuple[Path, ...]
    untouched: tuple[Path, ...]
    manifest: str
    user: Mapping[Path, str]


def listed(folder: Path) -> dict[str, str]:
    """Name to SHA-256 of each file of the last generation; "" where the list has no digest."""
    if not (folder / MANIFEST).is_file():
        return {}
    lines = (folder / MANIFEST).read_text(encoding="utf-8").splitlines()
    pairs = (line.rpartition("  ")[::2] for line in lines)
    return {name: digest for digest, name in pairs if _is_inside(name)}


def _is_inside(name: str) -> bool:
    """Whether a generated file can have that name: in generated/, or one or two folders below."""
    parts = Path(name).parts
    return len(parts) in (1, 2, 3) and ".." not in parts and not Path(name).is_absolute()
