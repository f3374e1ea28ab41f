# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The output of `--json`: one object for each call, whether it succeeds or fails.

A command fills in ``result`` and adds its warnings; `command_line` adds its failure. This module
keeps the text for people off standard output, and prints the object. Standard error has the same
text as without `--json`. docs/answer.schema.json is made of `Answer`, and of the classes in
`reported` and `results`.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, redirect_stdout
from dataclasses import asdict, dataclass, field
from os import devnull
from typing import Any

from ravenchart.described import Result
from ravenchart.failures import INTERNAL, INTERNAL_TEXT, OK
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.paths import version
from ravenchart.reported import SEVERITIES, Found, Note, Severity, found_of

FORMAT = 1
"""The version of the object: raised when a key goes or changes its meaning."""

LOCATED = re.compile(
    r"(?P<file>[^\s:|][^:|]*):(?P<line>\d+):(?:(?P<column>\d+):)? "
    r"(?:(?P<severity>error|warning|note|hint|info|high|medium|low): )?"
    r"(?P<message>.*?)(?: \[(?P<code>RV-\d{4})\])?"
)
"""A line as compilers, provers and Ravenchart itself print it."""
NAMED = re.compile(r"(?:(?P<file>[^\n]+?): )?(?P<severity>error|warning|note): (?P<message>.*)")
"""The same without a line of a file; ``ravenchart`` is no file."""
EXCERPT = re.compile(r" *\d* \| .*")
"""A line of the file that a message is about."""
HINT = re.compile(r"\s*hint: (?P<message>.*)")


def add_option(sub: argparse._ActionsContainer) -> None:
    """Declare `--json`."""
    sub.add_argument("--json", action="store_true", help="print the answer as one JSON object")


@dataclass(slots=True)
class Answer:
    """The answer to one call; ``figures`` are those of `analyse`, ``lines`` those of `simulate`."""

    command: str | None
    result: Result | None = None
    found: list[Found] = field(default_factory=list)
    figures: Mapping[str, Any] = field(default_factory=dict)
    lines: str | None = None
    write: Callable[[str], object] | None = None
    """Where it is printed; None once it is, and without `--json`."""

    def add(self, diagnostics: Iterable[object]) -> None:
        """Diagnostics of a model."""
        self.found += [found_of(one) for one in diagnostics if isinstance(one, Diagnostic)]

    def tell(self, text: str, severity: Severity = "error") -> None:
        """Add the messages of a text for people, which an outside program may have printed."""
        self.found += found_in(text, severity)

    def fail(self, text: str, diagnostics: Iterable[object] = ()) -> None:
        """Why a command could not go on: the diagnostics, or what the text says."""
        kept = list(diagnostics)
        if kept:
            self.add(kept)
        else:
            self.tell(text)

    def print(self, status: int) -> None:
        """Print it, once."""
        if self.write is not None:
            self.write(self.text(status))
            self.write = None

    def serves(self, result: Result) -> None:
        """Print it at once: the command goes on until it is stopped."""
        self.result = result
        self.print(OK)

    def text(self, status: int) -> str:
        """The printed text."""
        if self.lines is not None and status == 0:
            return self.lines
        head = {
            "format": FORMAT,
            "version": version(),
            "command": self.command,
            "status": status,
            "diagnostics": [asdict(one) for one in self.found],
        }
        answer = self.figures or {"result": None if self.result is None else asdict(self.result)}
        return f"{json.dumps(head | dict(answer), indent=1)}\n"


def say(answer: Answer, text: str, severity: Severity = "error") -> None:
    """Print what is not the result of a command to standard error, and put it in the answer."""
    print(text, file=sys.stderr)
    answer.tell(text, severity)


def printed(answer: Answer, execute: Callable[[], int]) -> int:
    """Execute a command, and print its answer alone; the exit status."""
    with _alone() as answer.write:
        try:
            status = execute()
        except BrokenPipeError:
            raise
        except Exception:
            answer.tell(INTERNAL_TEXT)
            answer.print(INTERNAL)
            raise
        answer.print(status)
    return status


@contextmanager
def _alone() -> Iterator[Callable[[str], None]]:
    """Nothing gets to standard output but what is written by the function."""
    out = sys.stdout

    def write(text: str) -> None:
        out.write(text)
        out.flush()

    with open(devnull, "w", encoding="utf-8") as nowhere, redirect_stdout(nowhere):
        yield write


def found_in(text: str, severity: Severity = "error") -> list[Found]:
    """The messages in a text; one with all of it where no line has the form of a message."""
    made: list[Found] = []
    for line in (line for line in text.splitlines() if not EXCERPT.fullmatch(line)):
        located = LOCATED.fullmatch(line)
        named = None if located else HINT.fullmatch(line) or NAMED.fullmatch(line)
        if located is not None:
            _take(made, located.groupdict(), severity)
        elif named is not None:
            _take(made, named.groupdict(), severity)
    if not made and text.strip():
        made.append(Found(severity, text.strip()))
    return made


def _take(made: list[Found], parts: Mapping[str, str | None], severity: Severity) -> None:
    """One message more, or a note or hint of the last one."""
    word, message = parts.get("severity"), parts["message"] or ""
    file = parts.get("file")
    line, column = (int(n) if (n := parts.get(key)) else None for key in ("line", "column"))
    if made and (word == "hint" or "severity" not in parts):
        made[-1].hint = message
    elif made and word == "note" and line is not None:
        made[-1].notes.append(Note(message, file, line, column))
    else:
        kind = severity if word is None else SEVERITIES.get(word, "error")
        named = None if file == "ravenchart" else file
        made.append(Found(kind, message, parts.get("code"), named, line, column))
