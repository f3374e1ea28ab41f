# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Checks that gnatprove could not prove, in the words of the user who must change something.

gnatprove names a location in Ada and a check, but the user wrote a model and bodies. So each
finding has the line of the body or generated unit, and the element of the model that the code
belongs to. It also has values for which the check fails, where the prover found some, and a
change that usually helps.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ravenchart.gen.emit.nodes.termination import EndingClaim
from ravenchart.gen.language.names import path_name
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin

from . import contracts
from .spark_results import Open

_MESSAGE = re.compile(r"(?P<file>[^:\n]+):(?P<line>\d+):(?P<column>\d+): \w+: (?P<text>.*)")
_EXAMPLE = re.compile(r"\s*\(e\.g\. when (?P<values>.*?)\)(?= \[|$)")
_NOTE = re.compile(r"\s*\[(?:reason for check|possible fix|possible explanation|#\d+)[^\]]*\]")

HELPS: Mapping[str, str] = {
    "overflow": "bound the operands first, or compute in a type with more room",
    "range": "bound the value before it gets this type, for example with 'Min and 'Max",
    "array index": "test the index first, or give it the type of the array's index",
    "divide by zero": "test the divisor first, or give it a type without 0",
    "length": "make both sides equally long on every way that leads here",
    "discriminant": "test the discriminant before a component that depends on it is read",
    "predicate": "give the value all parts that its type asks for before it is passed on",
    "precondition": "test before the call what the called subprogram requires; its spec states it",
    "postcondition": "follow each way through the body: on one of them the result is not as stated",
    "assertion": "assert first what it follows from, and see which of these is not proved",
    "loop invariant": "state in the invariant what one iteration leaves for the next",
    "loop variant": "let the loop count something that falls or rises in every iteration",
    "initialized": "set the variable on every way that leads here",
    "terminat": "end every loop after a number of iterations that is known before",
}
"""By a word of the message, in this order."""
ENDS = (
    "give each `while` loop and each `loop` below it a `pragma Loop_Variant`, and each recursion a "
    "Subprogram_Variant; a `for` loop ends by itself"
)
"""For what may not end."""
OTHERWISE = "simplify the expression, or test before what the check needs"
IN_GENERATED = (
    "bound the value in the model: a narrower range, `min` and `max`, or a guard; "
    "generated code follows"
)


@dataclass(frozen=True, slots=True)
class UnprovedCheck:
    """One check that is not proved."""

    file: str
    """As seen from the model's folder, such as ``user/plant-tank-activities.adb``."""
    line: int
    column: int
    check: str
    """The check, in the words of gnatprove."""
    source: str
    """The line of the file."""
    example: str
    """Values for which it fails; empty where the prover found none."""
    element: str
    """The element of the model; empty where none has the code."""
    origin: Origin | None
    help: str

    def lines(self) -> Iterator[str]:
        """The finding for a terminal."""
        yield f"{self.file}:{self.line}:{self.column}: not proved: {self.check}"
        if self.source:
            margin = f"{self.line:5} | "
            yield margin + self.source
            yield " " * (len(margin) - 2) + "| " + " " * (self.column - 1) + "^"
        if self.example:
            yield f"  fails for example when {self.example}"
        if self.element:
            yield f"  belongs to {self.element}" + (f" ({self.origin})" if self.origin else "")
        yield f"  what usually helps: {self.help}"


def findings(
    output: str, unproved: Sequence[Open], system: System, folder: Path, places: Sequence[Path]
) -> tuple[UnprovedCheck, ...]:
    """A finding for each message of gnatprove about a check that is not proved.

    ``places`` are the folders with sources. A check without a message has a finding as well.
    """
    texts: dict[tuple[str, int, int], str] = {}
    for found in map(_MESSAGE.fullmatch, output.splitlines()):
        if found is not None:  # of several about a place the first one names the check
            place = found["file"], int(found["line"]), int(found["column"])
            texts.setdefault(place, found["text"])
    return tuple(
        _finding(one, texts.get((one.file, one.line, one.column), ""), system, folder, places)
        for one in unproved
    )


def endless(unproved: Sequence[Open], claims: Sequence[EndingClaim]) -> tuple[UnprovedCheck, ...]:
    """A finding for each row of a processor that may not end.

    Where each of its rows ends, the processor itself is what does not.
    """
    open_ = {one.entity.lower() for one in unproved}
    left = {one.element: one.origin for one in claims if one.entity.lower() in open_}
    rows = [name for name in left if "." in name]
    return tuple(
        UnprovedCheck(
            left[name].file,
            left[name].line,
            left[name].column,
            f"an execution of {name} may never end",
            "",
            "",
            name,
            None,
            ENDS,
        )
        for name in rows or left
    )


def _finding(
    one: Open, text: str, system: System, folder: Path, places: Sequence[Path]
) -> UnprovedCheck:
    example = _EXAMPLE.search(text)
    check = _NOTE.sub("", _EXAMPLE.sub("", text)) or _words(one.rule)
    path = next((place / one.file for place in places if (place / one.file).is_file()), None)
    shown = one.file if path is None else os.path.relpath(path, folder)
    element, origin = element_of(system, one.entity)
    generated = shown.startswith("generated")
    help_ = next((text for word, text in HELPS.items() if word in check), OTHERWISE)
    help_ = IN_GENERATED if generated else help_
    part = contracts.part_of(one, check, system, places)
    if part is not None:
        element, origin = f"{part.element}.{part.side}", part.origin
        help_ = contracts.HELPS[part.side]
    return UnprovedCheck(
        shown,
        one.line,
        one.column,
        check,
        "" if path is None else _line(path, one.line),
        "" if example is None else example["values"],
        element,
        origin,
        help_,
    )


def _words(rule: str) -> str:
    return rule.removeprefix("VC_").replace("_", " ").lower() + " is not proved"


def _line(path: Path, number: int) -> str:
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    return lines[number - 1] if number <= len(lines) else ""


def element_of(system: System, entity: str) -> tuple[str, Origin | None]:
    """The element of the model behind an Ada entity such as ``Plant.Tank.Activities.Regulate``."""
    words = entity.lower().split(".")[1:]
    if not words:
        return "", None
    owners = {
        **{one.name: one.origin for one in system.messages},
        **{one.name: one.origin for one in system.processors},
        **{one.name: one.origin for one in system.instances},
    }
    for component in system.components:
        if component.name.lower() in (words[0], words[0].removesuffix("_type")):
            regions = {one.name: one.origin for one in component.regions}
            members = regions | {one.name: one.origin for one in component.activities}
            for name, origin in members.items():
                if name.lower() in words[1:]:
                    return f"{component.name}.{name}", origin
            return component.name, component.origin
    for name, origin in owners.items():
        if path_name(name).lower() == words[0]:
            return name, origin
    return "", None
