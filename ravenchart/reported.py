# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A diagnostic as programs get it: in the answer of `--json`, and on the page of the workbench."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from ravenchart.described import Described
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.origins import Origin

Severity = Literal["error", "warning", "note"]
SEVERITIES: Mapping[str, Severity] = {"warning": "warning", "note": "note", "info": "note"}
"""Of a word before a message; every other one is an error."""


@dataclass(slots=True)
class Note(Described):
    """Another location that a diagnostic is about."""

    message: str
    """The relation of this location to the diagnostic."""
    file: str | None = None
    """The file, as it was given."""
    line: int | None = None
    """The line, from 1."""
    column: int | None = None
    """The column, from 1."""


@dataclass(slots=True)
class Found(Described):
    """An error, a warning or a note."""

    severity: Severity
    """`error`, `warning` or `note`."""
    message: str
    """The problem."""
    code: str | None = None
    """The code, for `ravenchart explain`; null where the message has none."""
    file: str | None = None
    """The file, as it was given; null where the message is about none."""
    line: int | None = None
    """The line, from 1."""
    column: int | None = None
    """The column, from 1."""
    hint: str | None = None
    """How to correct it."""
    notes: list[Note] = field(default_factory=list)
    """Other locations."""


def found_of(one: Diagnostic) -> Found:
    """A diagnostic of a model in that form."""
    notes = [Note(text, *_place(origin)) for origin, text in one.notes]
    severity = SEVERITIES.get(one.severity.value, "error")
    return Found(severity, one.message, one.code, *_place(one.origin), one.hint, notes)


def _place(origin: Origin) -> tuple[str, int, int]:
    return origin.file, origin.line, origin.column
