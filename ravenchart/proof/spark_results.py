# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The results of gnatprove, read from the files that one run leaves in a result folder.

Each analysed unit has a `.spark` file (JSON) with its checks and its parts in SPARK, and an
`.ali` file that names its sources. gnatprove's own summary counts every file of the object
folders that it knows, so its numbers depend on earlier runs. The numbers here are those of the
given folders.

The older age of gnatprove (`ages`) writes each entity where it is meant; the younger one writes a
number, and a table `entities` for the unit.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True, slots=True)
class Entity:
    """One subprogram, task or package, and what was proved of it."""

    path: str
    checks: int
    provers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Outside:
    """A unit or subprogram that gnatprove did not analyse, or analysed without its body."""

    name: str
    location: str
    """File and line of its declaration; the file alone of a whole unit, and of a kept result."""


@dataclass(frozen=True, slots=True)
class Open:
    """A check that is neither proved nor justified."""

    file: str
    line: int
    column: int
    rule: str
    """gnatprove's name of the check, such as ``VC_RANGE_CHECK``."""
    entity: str
    """The subprogram, task or package with the check."""


@dataclass(frozen=True, slots=True)
class Results:
    """The outcome of one run."""

    checks: int
    justified: int
    open: tuple[Open, ...]
    """The checks that are not proved, in the order of their locations."""
    assumed: int
    """Statements `pragma Assume`."""
    outside: tuple[Outside, ...]
    files: frozenset[str]
    """Names of the sources that were analysed, and of all that these depend on."""
    entities: tuple[Entity, ...]

    @property
    def unproved(self) -> int:
        """How many checks are not proved."""
        return len(self.open)


TERMINATION = "SUBPROGRAM_TERMINATION"
"""gnatprove's name of the check that a subprogram ends; flow analysis proves it."""


def read_results(
    folders: Sequence[Path], analysed: Sequence[str] = (), *, with_bodies: bool = False
) -> Results:
    """The results in ``folders``; nothing of another run may lie there.

    ``analysed`` are the source files that gnatprove was asked for, if not for all. The results
    rest on the specs of what these use, and ``with_bodies`` on the bodies too.
    """
    found = [(path.stem, json.loads(path.read_text("utf-8"))) for path in _files(folders, "spark")]
    units = [
        unit
        for unit in map(_unit, _files(folders, "ali"))
        if not analysed or unit.files & {*analysed}
    ]
    checks = justified = assumed = 0
    unproved: list[Open] = []
    tallies: dict[str, tuple[int, set[str]]] = {}
    for _, unit in found:
        assumed += len(unit.get("pragma_assume", ()))
        for check in _checks(unit):
            checks += 1
            if "suppressed" in check:
                justified += 1
            elif check["severity"] != "info":
                unproved.append(_open(unit, check))
        ended = (one for one in unit.get("flow", ()) if one["rule"] == TERMINATION)
        for check in (*unit.get("proof", ()), *ended):
            name = entity_of(unit, check["entity"])["name"]
            count, provers = tallies.get(name, (0, set()))
            provers |= set(check.get("stats", ()))
            tallies[name] = (count + 1, provers)
    entities = tuple(
        Entity(name, count, tuple(sorted(provers)))
        for name, (count, provers) in sorted(tallies.items())
    )
    seen = {name for name, unit in found if unit["spark"]}
    outside = {
        *(o for _, unit in found for o in _outside(unit)),
        *(Outside(u.name, u.first) for u in units if not u.generic and u.stem not in seen),
    }
    read = _with_used(units, folders) if with_bodies else units
    files = frozenset(name for unit in read for name in unit.sources)
    ordered = tuple(sorted(outside, key=lambda o: (o.name, o.location)))
    places = tuple(sorted(unproved, key=lambda o: (o.file, o.line, o.column, o.rule)))
    return Results(checks, justified, places, assumed, ordered, files, entities)


def entity_of(unit: Mapping[str, Any], reference: Any) -> Mapping[str, Any]:
    """An entity that a unit's results refer to, with its ``name`` and ``sloc``."""
    if isinstance(reference, dict):
        return reference
    number = int(reference)
    found: Mapping[str, Any]
    found = next(entity for key, entity in unit["entities"].items() if int(key) == number)
    return found


def _open(unit: Mapping[str, Any], check: Mapping[str, Any]) -> Open:
    name = entity_of(unit, check["entity"])["name"]
    return Open(check["file"], check["line"], check["col"], check["rule"], name)


def _files(folders: Sequence[Path], ending: str) -> list[Path]:
    return sorted(path for folder in folders for path in folder.glob(f"*.{ending}"))


def _checks(unit: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Checks of flow analysis and of proof; warnings, such as an unused value, are none."""
    for check in (*unit.get("flow", ()), *unit.get("proof", ())):
        if check["severity"] != "warning":
            yield check


def _outside(unit: dict[str, Any]) -> Iterator[Outside]:
    """The entities that are not wholly in SPARK, or skipped by an annotation.

    The mode "spec" means in SPARK without the body, "no" means not in SPARK.
    """
    for key in (*unit.get("skip_flow_proof", ()), *unit.get("skip_proof", ())):
        yield _not_proved(entity_of(unit, key))
    modes = unit["spark"]
    pairs = (
        ((entity_of(unit, key), mode) for key, mode in modes.items())
        if isinstance(modes, dict)
        else ((entity, entity["spark"]) for entity in modes)
    )
    for entity, mode in pairs:
        if mode != "all":
            yield _not_proved(entity)


def _not_proved(entity: Mapping[str, Any]) -> Outside:
    at = entity["sloc"][0]
    return named_outside(entity["name"], f"{at['file']}:{at['line']}")


def named_outside(name: str, location: str) -> Outside:
    """An entity by its name; in an instance of the runtime, by that in the generic unit."""
    file = location.partition(":")[0]
    if file.startswith("ravenchart-") and not name.lower().startswith("ravenchart."):
        unit = file.rpartition(".")[0].replace("-", ".").title()
        name = f"{unit}.{name.rpartition('.')[2]}"
    return Outside(name, location)


@dataclass(frozen=True, slots=True)
class _Unit:
    """A library unit by its `.ali` file: the lines U (the unit) and D (what it depends on)."""

    stem: str
    name: str
    first: str
    """Its body, or its spec where it has no body."""
    files: frozenset[str]
    generic: bool
    sources: tuple[str, ...]
    uses: tuple[str, ...]
    """The stems of the units that it names."""


def _with_used(units: Sequence[_Unit], folders: Sequence[Path]) -> list[_Unit]:
    """The units, and all that they use, directly or not."""
    there = {path.stem: path for path in _files(folders, "ali")}
    found = {unit.stem: unit for unit in units}
    left = [*units]
    while left:
        for stem in left.pop().uses:
            if stem in there and stem not in found:
                found[stem] = _unit(there[stem])
                left.append(found[stem])
    return [*found.values()]


def _unit(path: Path) -> _Unit:
    lines = [line.split() for line in path.read_text(encoding="utf-8").splitlines() if line]
    units = [words for words in lines if words[0] == "U"]
    sources = tuple(words[1] for words in lines if words[0] == "D" and "/" not in words[1])
    name = units[0][1].partition("%")[0]
    files = frozenset(words[2] for words in units)
    uses = tuple(words[3].removesuffix(".ali") for words in lines if words[0] == "W" and words[3:])
    return _Unit(path.stem, name, units[0][2], files, "GE" in units[0], sources, uses)
