# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Longest execution times that a run showed, beside the WCETs of the model and of a static tool.

They are measurements: a run executes some paths, and a longer one may be left.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import yaml

from ravenchart.analysis.plain.bounds import Bound
from ravenchart.analysis.system.observed import Observation
from ravenchart.analysis.units import microseconds
from ravenchart.described import Described
from ravenchart.gen.model.system import Slot, System, Work
from ravenchart.gen.origins import Origin

WARNING = "measured in one run, and no bounds: a path that takes longer may not have been executed"
PROPOSED = "To write into the model: the longest of all instances, with the margin."
OF_THIS_MACHINE = "processor time by the clock of this machine, whose interrupts and caches count"


@dataclass(slots=True)
class MeasuredRow(Described):
    """A row of a processor's table."""

    row: str
    """`owner.name`."""
    wcet: int
    """The WCET that the model gives, in ns."""
    measured: int | None
    """Longest execution that was observed, in ns; null where there was none."""
    proposed: int | None
    """The same with the margin, in ns."""
    bound: int | None
    """Bound of a static tool, in ns; null where none is given."""

    @property
    def words(self) -> list[str]:
        """The problems: each bound that the figures refute."""
        seen, found = self.measured or 0, []
        if seen > self.wcet:
            found.append("measured above `wcet`")
        if self.bound is not None and self.bound > self.wcet:
            found.append("bound above `wcet`")
        if self.bound is not None and seen > self.bound:
            found.append("measured above its bound")
        return found


@dataclass(slots=True)
class Coverage(Described):
    """How many transitions of a region were taken."""

    region: str
    """`instance.Region`."""
    taken: int
    """How many different ones."""
    transitions: int
    """How many there are."""


@dataclass(slots=True)
class Measurement(Described):
    """Execution times of one run: measurements, no bounds."""

    target: str
    """The target of the run."""
    clock: str
    """The meaning of the times."""
    run: str
    """The title of the scenario, or the length of a run without one."""
    margin: int
    """In percent: the difference between `proposed` and `measured`."""
    rows: list[MeasuredRow]
    """In the order of the model."""
    coverage: list[Coverage]
    """Of each region."""
    not_measured: list[str]
    """WCETs of the model that no run measures."""


def measured(
    system: System,
    seen: Observation,
    target: str,
    clock: str,
    run: str,
    margin: int,
    bounds: Mapping[str, Bound],
) -> Measurement:
    """The execution times of a run, with a margin in percent."""
    rows = []
    for slot in system.slots:
        longest = seen.executions.get(slot.element) or None  # 0: it was not executed
        with_margin = None if longest is None else -(-longest * (100 + margin) // 100)
        bound = bounds.get(slot.element)
        given = None if bound is None else bound.wcet
        rows.append(MeasuredRow(slot.element, slot.timing.wcet, longest, with_margin, given))
    return Measurement(target, clock, run, margin, rows, list(_coverage(seen)), list(_left(system)))


def _coverage(seen: Observation) -> Iterator[Coverage]:
    for region in seen.map.of_kind("region"):
        taken = {record.value for record in seen.of("transition", region.name)}
        yield Coverage(region.name, len(taken), len(region.transitions))


def _left(system: System) -> Iterator[str]:
    """The WCETs of a model that a run does not measure."""
    for node in system.nodes:
        parts = {
            "probe": node.probe,
            "supervision": node.supervision,
            "tick": node.tick,
            "stream": node.stream,
        }
        yield from (f"{node.name}.{key}.wcet" for key, part in parts.items() if part is not None)
    for bus in system.buses:
        yield f"{bus.name}.driver_wcet"


def _slot(system: System, row: str) -> Slot:
    return next(slot for slot in system.slots if slot.element == row)


def origin_of(system: System, row: str) -> Origin:
    """The location of a row's WCET in the model, or of its component or bus."""
    slot = _slot(system, row)
    if slot.of_bus:
        return next(bus.origin for bus in system.buses if bus.name == slot.owner)
    component = system.instance(slot.owner).component
    places = {one.name: one.origin for one in component.activities}
    places |= {one.name: one.origin for one in component.regions}
    return places.get(slot.name, component.origin)


def key_of(system: System, row: str) -> str:
    """The key of the model that holds the WCET of a row."""
    return "driver_wcet" if _slot(system, row).work is Work.BUS_RECEIVE else "wcet"


def proposed(found: Measurement, system: System) -> dict[str, int]:
    """The times to write into the model, in ns: of a component the longest of its instances."""
    times: dict[str, int] = {}
    for one in found.rows:
        slot = _slot(system, one.row)
        owner = slot.owner if slot.of_bus else system.instance(slot.owner).component.name
        if one.proposed is not None:
            name = f"{owner}.{slot.name}"
            times[name] = max(times.get(name, 0), one.proposed)
    return times


def text(found: Measurement, system: System) -> str:
    """The measurement as YAML."""
    head = {
        "system": system.name,
        "digest": system.digest,
        "target": found.target,
        "clock": found.clock,
        "run": found.run,
        "margin": f"{found.margin} %",
    }
    wcet = {name: _us(time) for name, time in proposed(found, system).items()}
    rows = {
        one.row: {"measured": _us(one.measured), "model": _us(one.wcet)}
        for one in found.rows
        if one.measured is not None
    }
    left = {
        "not_executed": [one.row for one in found.rows if one.measured is None],
        "not_measured": found.not_measured,
        "transitions_taken": {
            one.region: f"{one.taken} of {one.transitions}" for one in found.coverage
        },
    }
    parts = [
        (f"Execution times {WARNING}.", _yaml(head)),
        (PROPOSED, _yaml({"wcet": wcet})),
        ("The longest of each row beside its WCET.", _yaml({"rows": rows}, flow=None)),
        ("Left out of the figures.", _yaml(left)),
    ]
    return "\n".join(f"# {said}\n{part}" for said, part in parts)


def _yaml(content: object, *, flow: bool | None = False) -> str:
    text: str = yaml.safe_dump(content, sort_keys=False, default_flow_style=flow, width=1_000)
    return text


def _us(time: int) -> str:
    return f"{microseconds(time)} us"
