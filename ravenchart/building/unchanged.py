# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Generations and builds that have nothing to do, known before the model is read (`kept`).

The record of a generation has the SHA-256 of every file that it read or wrote, and of the user's
files that it looked at. Its key covers the tool, the folder, and the name of the model. While all
files are as recorded, messages and results are those of the record. The record of a build has its
calls of gprbuild, too. They are made again: gprbuild alone knows whether compilers, switches and
sources have changed. The programs must then be those that were examined.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.paths import work
from ravenchart.stacks.report import Memory, memory_of
from ravenchart.tools import kept

from .compilation import Compilation
from .written import MANIFEST, Written, listed

if TYPE_CHECKING:
    from .checking import Checked

KIND = "generations"
FORMAT = 1
"""Part of each key: raised when what an entry holds changes."""
UNREADABLE = (AttributeError, KeyError, OSError, TypeError, ValueError)
"""Exceptions of an entry that has another form, and of a file that cannot be read."""


@dataclass(frozen=True, slots=True)
class Generation:
    """The diagnostics and the written files of a model: a new generation would be the same."""

    warnings: str
    found: tuple[Diagnostic, ...]
    written: Written


@dataclass(frozen=True, slots=True)
class BuiltNode:
    """The program of a node: how it was compiled, and what was found of it."""

    node: str
    compilation: Compilation
    memory: Memory


@dataclass(frozen=True, slots=True)
class Build:
    """The programs of a model, and ``files``: the SHA-256 of all that was examined."""

    generation: Generation
    programs: tuple[BuiltNode, ...]
    files: Mapping[str, str]

    def holds(self) -> bool:
        """Whether the programs are those that were examined."""
        try:
            return _are(self.files)
        except OSError:
            return False


def generation(model: Path) -> Generation | None:
    """The last generation; None where anything is not as it was, or nothing is known of it."""
    try:
        entry: Any = kept.load(KIND, _key(model))
        return _generation(entry)
    except UNREADABLE:
        return None


def build(model: Path, switches: Sequence[str]) -> Build | None:
    """The last build with these switches; None as for a generation."""
    try:
        entry: Any = kept.load(KIND, _key(model, *switches))
        made = _generation(entry["generation"])
        programs = tuple(_built(one) for one in entry["programs"])
        found = None if made is None else Build(made, programs, dict(entry["files"]))
        return found if found is not None and found.holds() else None
    except UNREADABLE:
        return None


def keep(checked: Checked, done: Written) -> None:
    """Keep what a generation found and did."""
    if _is_final(checked):
        with suppress(OSError):  # it is done again next time
            kept.store(KIND, _key(checked.path), _entry(checked, done))


def keep_build(
    checked: Checked,
    done: Written,
    switches: Sequence[str],
    programs: Sequence[BuiltNode],
    facts: Iterable[Path],
) -> None:
    """Keep what a build made; ``facts`` are the files by which the programs were examined."""
    if _is_final(checked):
        files = {*facts, *(one.compilation.image for one in programs)}
        with suppress(OSError):
            entry: dict[str, object] = {
                "generation": _entry(checked, done),
                "programs": [_listed(one) for one in programs],
                "files": {str(file): _digest(file) for file in sorted(files)},
            }
            kept.store(KIND, _key(checked.path, *switches), entry)


def _is_final(checked: Checked) -> bool:
    """Whether the next check finds the same: all rules of behaviour have been finished."""
    from ravenchart.behaviour.limits import UNFINISHED  # only here: it imports all of the model

    return all(one.code != UNFINISHED for one in checked.diagnostics)


# --- Keys --------------------------------------------------------------------------


def _key(model: Path, *switches: str) -> str:
    return kept.digest([_tool(), str(work()), os.getcwd(), str(model), switches])


@cache
def _tool() -> list[object]:
    """All that decides what is made of a model."""
    return [FORMAT, sys.version, _installed(), kept.sources("")]


def _installed() -> list[str]:
    """The libraries of Python, with their versions."""
    places = [place for place in sys.path if os.path.isdir(place)]
    return sorted({name for one in places for name in os.listdir(one) if name.endswith("-info")})


# --- Entries -----------------------------------------------------------------------


def _entry(checked: Checked, done: Written) -> dict[str, object]:
    return {
        "read": dict(checked.read),
        "warnings": checked.warnings,
        "found": [kept.listed(one) for one in checked.diagnostics],
        "folder": str(done.folder),
        "files": done.files,
        "untouched": [str(path) for path in done.untouched],
        "manifest": done.manifest,
        "user": {str(path): one for path, one in done.user.items()},
    }


def _generation(entry: Any) -> Generation | None:
    folder, manifest = Path(entry["folder"]), str(entry["manifest"])
    user = {Path(name): one for name, one in entry["user"].items()}
    as_it_was = (
        _are(entry["read"])
        and _are({folder / MANIFEST: manifest})
        and _are({folder / name: one for name, one in listed(folder).items()})
        and _are(user)
    )
    if not as_it_was:
        return None
    untouched = tuple(map(Path, entry["untouched"]))
    found = tuple(kept.diagnostic(one) for one in entry["found"])
    written = Written(folder, int(entry["files"]), 0, (), (), untouched, manifest, user)
    return Generation(str(entry["warnings"]), found, written)


def _listed(one: BuiltNode) -> list[object]:
    call = one.compilation
    told = [call.arguments, str(call.where), dict(call.scenario), str(call.image)]
    return [one.node, told, asdict(one.memory)]


def _built(entry: Any) -> BuiltNode:
    node, (arguments, where, scenario, image), memory = entry
    call = Compilation(tuple(arguments), Path(where), dict(scenario), Path(image))
    return BuiltNode(str(node), call, memory_of(memory))


def _are(files: Mapping[Any, str]) -> bool:
    """Whether each file has its SHA-256."""
    return all(_digest(Path(file)) == one for file, one in files.items())


def _digest(file: Path) -> str:
    """SHA-256 of a regular file; OSError where there is none."""
    if not file.is_file():
        raise FileNotFoundError(file)
    return kept.file_digest(file)
