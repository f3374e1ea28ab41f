# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Which condition of an activity's contract a check is about that gnatprove could not prove.

`ensures` is the postcondition of the activity's procedure, and a check of it is in the spec.
`requires` is its precondition, and a check of that is where an instance calls the procedure.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.model.component import Activity, Clause, Component
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin

from .spark_results import Open

HELPS = {
    "requires": "let a type, a parameter of the instance or `ensures` of the activity that writes "
    "the data imply it; or test it in the body and not require it",
    "ensures": "follow each way through the body: on one of them the condition does not hold",
}
_CALL = re.compile(r"\.(?P<home>Activities|Flows|\w+_Fallback)\.(?P<name>\w+)")
_UNSHOWN = re.compile(r"cannot prove (?P<condition>.*?)(?: \(e\.g\.|$| \[)")


@dataclass(frozen=True, slots=True)
class Part:
    """One condition of a contract, or all of one side where it is not known which."""

    element: str
    side: str
    origin: Origin


def part_of(one: Open, text: str, system: System, places: Sequence[Path]) -> Part | None:
    """The condition that a check is about; None where it is about no contract of an activity."""
    if "precondition" in text:
        return _required(one, text, system, places)
    if "postcondition" in text:
        return _ensured(one, system, places)
    return None


def _ensured(one: Open, system: System, places: Sequence[Path]) -> Part | None:
    for component, activity in _activities(system):
        if one.entity.lower().split(".")[1::2] == [component.name.lower(), activity.name.lower()]:
            spec = _text(one.file, places)
            at = _offset(spec, one.line, one.column)
            spans = _conditions(spec, activity, "Post")
            found = next((i for i, (first, last) in enumerate(spans) if first <= at < last), None)
            return _part(component, activity, "ensures", activity.ensures, found)
    return None


def _required(one: Open, text: str, system: System, places: Sequence[Path]) -> Part | None:
    lines = _text(one.file, places).splitlines()
    call = _CALL.search(lines[one.line - 1]) if one.line <= len(lines) else None
    owner = one.entity.lower().split(".")[1:2]
    components = {i.component.name for i in system.instances if [ada_case(i.name).lower()] == owner}
    for component, activity in _activities(system):
        named = call is not None and call["name"].lower() == activity.name.lower()
        if call is not None and named and component.name in components:
            home = call["home"].lower()
            unit = f"{ada_case(system.name)}-{component.name}-{home}.ads".lower()
            spec = _text(unit, places)
            unshown = _UNSHOWN.search(text)
            asked = "" if unshown is None else _flat(unshown["condition"])
            spans = _conditions(spec, activity, "Pre")
            fits = [i for i, (first, last) in enumerate(spans) if asked in _flat(spec[first:last])]
            found = fits[0] if asked and fits else None
            return _part(component, activity, "requires", activity.requires, found)
    return None


def _activities(system: System) -> Iterator[tuple[Component, Activity]]:
    for component in system.components:
        for activity in component.activities:
            yield component, activity


def _part(
    component: Component,
    activity: Activity,
    side: str,
    clauses: Sequence[Clause],
    found: int | None,
) -> Part | None:
    if not clauses:
        return None
    place = found if found is not None and found < len(clauses) else 0
    return Part(f"{component.name}.{activity.name}", side, clauses[place].origin)


def _text(file: str, places: Sequence[Path]) -> str:
    path = next((place / file for place in places if (place / file).is_file()), None)
    return "" if path is None else path.read_text(encoding="utf-8", errors="replace")


def _offset(text: str, line: int, column: int) -> int:
    return sum(len(one) + 1 for one in text.split("\n")[: line - 1]) + column - 1


def _flat(text: str) -> str:
    return re.sub(r"\s", "", text).lower()


def _conditions(spec: str, activity: Activity, aspect: str) -> list[tuple[int, int]]:
    """The locations of an aspect's conditions in the spec of a package of activities."""
    name = re.escape(ada_case(activity.name))
    begins = re.search(rf"\bprocedure {name}\b(?:(?!\bprocedure\b).)*?\b{aspect} =>", spec, re.S)
    if begins is None:
        return []
    first, depth = begins.end(), 0
    spans: list[tuple[int, int]] = []
    for sign in re.compile(r"[(),;]|\band\s+then\b").finditer(spec, begins.end()):
        depth += {"(": 1, ")": -1}.get(sign[0], 0)
        if depth == 0 and sign[0] not in "()":
            spans.append((first, sign.start()))
            first = sign.end()
            if sign[0] in ",;":
                break
    return spans
