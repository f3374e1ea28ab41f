# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A model as the editor has it: its files, open or on the disk, and what the pipeline finds."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ravenchart.building import checking
from ravenchart.editing.evaluation import MARK, Evaluation, evaluate
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.files import deployments
from ravenchart.gen.files.load import Reader, read_file
from ravenchart.gen.files.spans import YamlScalar
from ravenchart.gen.pipeline import Loaded, load

from .symbols import Symbols
from .texts import FileText

Open = Mapping[str, str]
"""The texts that are open in the editor, by the absolute names of their files."""


def real(name: str | Path) -> str:
    """The absolute name of a file, without `..`: names of one file are equal."""
    return os.path.normpath(os.path.abspath(name))


def reader(documents: Open) -> Reader:
    """Reads what is open from the editor, and all else from the disk."""

    def read(path: Path, limit: int) -> bytes:
        known = documents.get(real(path))
        return read_file(path, limit) if known is None else known.encode()[:limit]

    return read


@dataclass(frozen=True)
class OpenModel:
    """A model at one moment."""

    path: Path
    loaded: Loaded
    texts: Mapping[str, FileText]
    """Its files, by the names that its messages use, main file first."""

    @cached_property
    def symbols(self) -> Symbols:
        """Its names."""
        return Symbols(self.loaded.uses, self.texts)

    def file(self, name: str) -> str | None:
        """How messages call a file, given its absolute name; None of one of another model."""
        return next((one for one in self.texts if real(one) == name), None)


def model(path: Path, documents: Open) -> OpenModel:
    """The model whose main file is at ``path``."""
    seen: dict[str, FileText] = {}
    return OpenModel(path, load(path, _noting(reader(documents), seen)), seen)


def evaluated(path: Path, documents: Open) -> tuple[OpenModel, Evaluation]:
    """The same, with its timing where it has no errors."""
    seen: dict[str, FileText] = {}
    found = evaluate(path, {}, _noting(reader(documents), seen))
    return OpenModel(path, found.loaded, seen), found


def checked(path: Path, documents: Open) -> tuple[Diagnostic, ...]:
    """All that `check` finds, the rules of behaviour included."""
    try:
        found = checking.check(path, read=reader(documents), library=True).diagnostics
    except Refused as problem:
        return tuple(one for one in problem.found if isinstance(one, Diagnostic))
    return found


def main_file(name: str, documents: Open, known: Callable[[str], str | None]) -> str:
    """The main file of the model that a file belongs to: the file itself where no other has it.

    That is a file with `system`: the file itself, the one that was seen to include it, or one in
    its folder or the two above. Of several deployments it is the first that has the file.
    """
    text = _text(name, documents)
    if text is not None and _is_main(text):
        return str(_paths(Path(name), text)[0])
    found = known(name)
    if found is not None:
        return found
    folder = Path(name).parent
    for place in (folder, *folder.parents[:2]):
        for other in sorted(place.glob("*.yaml")):
            text = _text(str(other), documents)
            for path in _paths(other, text) if text is not None and _is_main(text) else ():
                if model(path, documents).file(name) is not None:
                    return str(path)
    return name


def _paths(main: Path, text: FileText) -> list[Path]:
    """The path of each deployment that a main file names; its own where it names none."""
    named = None if text.root is None else text.root.mapping("deployments")
    return [
        deployments.at(main, name.value)
        for name, file in (() if named is None else named.entries)
        if isinstance(file, YamlScalar) and file.value
    ] or [main]


def _is_main(text: FileText) -> bool:
    if "system" not in text.text:
        return False
    if text.root is None:  # it is being written
        return any(line.startswith("system:") for line in text.text.splitlines())
    return text.root.get("system") is not None


def _text(name: str, documents: Open) -> FileText | None:
    try:
        content = reader(documents)(Path(name), 2**22)
        return FileText(content.decode("utf-8").removeprefix(MARK))
    except (OSError, ValueError):
        return None


def _noting(read: Reader, seen: dict[str, FileText]) -> Reader:
    """A reader that keeps what it reads."""

    def noting(path: Path, limit: int) -> bytes:
        content = read(path, limit)
        seen[str(path)] = FileText(content.decode("utf-8", "replace").removeprefix(MARK))
        return content

    return noting
