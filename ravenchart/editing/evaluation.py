# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The evaluation of a model's files in one state: the ordinary pipeline, over texts in memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.building.checking import with_good_identifiers
from ravenchart.building.garbage import without_collector
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.files.load import Reader, read_file
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.gen.rules.folding import folded

from .edits import Document
from .places import ModelPlaces

Texts = Mapping[str, bytes]
"""The files of a model by the names that its messages use, main file first."""

MARK = "\ufeff"
"""The byte order mark, which a model file may begin with."""


def over(texts: Texts, read: Reader = read_file) -> Reader:
    """A reader that gives the texts in memory, and reads what is not among them."""

    def reader(path: Path, limit: int) -> bytes:
        known = texts.get(str(path))
        return read(path, limit) if known is None else known[:limit]

    return reader


@dataclass(frozen=True)
class Evaluation:
    """The files, and what they mean: no analysis where the model has errors."""

    texts: Texts
    loaded: Loaded
    analysis: Analysis | None
    late: tuple[Diagnostic, ...]
    """Deadlines and limits that are not kept."""

    @property
    def found(self) -> tuple[Diagnostic, ...]:
        """All that is wrong."""
        return (*self.loaded.diagnostics, *self.late)

    @cached_property
    def places(self) -> ModelPlaces:
        """Where the files say what."""
        return ModelPlaces({name: document(content) for name, content in self.texts.items()})


def document(content: bytes) -> Document | None:
    """The document of a file; None where it is not YAML in UTF-8."""
    try:
        return Document.of(content.decode("utf-8").removeprefix(MARK))
    except UnicodeDecodeError:
        return None


def content(document: Document, before: bytes) -> bytes:
    """The bytes of a document, with the byte order mark that the file had before."""
    mark = MARK if before.startswith(MARK.encode()) else ""
    return f"{mark}{document.text}".encode()


@without_collector()
def evaluate(path: Path, texts: Texts, other: Reader = read_file) -> Evaluation:
    """Load and analyse the model at ``path``, its files as in ``texts``; ``other`` reads others.

    The files of the result are those that were read.
    """
    seen: dict[str, bytes] = {}
    inner = over(texts, other)

    def read(file: Path, limit: int) -> bytes:
        seen[str(file)] = inner(file, limit)
        return seen[str(file)]

    loaded = load(path, read)
    if loaded.system is None:
        return Evaluation(seen, loaded, None, ())
    system, unordered = with_good_identifiers(loaded.system)
    analysis = analyse(system)
    late = unordered or folded(findings(analysis), system.instances)
    return Evaluation(seen, loaded, analysis, late)
