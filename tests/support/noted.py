# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The most records that generated Ada notes, read from its statements.

An independent count beside `analysis.system.records`: it follows each call of a row, takes the
branch with the most records, and knows of a model only how often two loops go round.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ravenchart.analysis.system.records import Records
from ravenchart.gen.emit.ada.declarations import Package, Subprogram, Unit
from ravenchart.gen.emit.ada.expressions import IntegerLiteral, Range
from ravenchart.gen.emit.ada.named import DottedName
from ravenchart.gen.emit.ada.naming import ada_case, root_package
from ravenchart.gen.emit.ada.statements import Case, Do, IfStatement, Loop, Stmt
from ravenchart.gen.emit.ada.walking import names_in
from ravenchart.gen.emit.charts.shape import RegionShape
from ravenchart.gen.emit.instances.glue import emit_instances
from ravenchart.gen.emit.language.own_names import event_literal
from ravenchart.gen.emit.nodes.deployment import emit_deployment
from ravenchart.gen.model.chart.steps import RAISED, Steps
from ravenchart.gen.model.chart.tree import Tree
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Slot, System, Work

Place = tuple[tuple[str, ...], str]
"""A package below the system's, and a procedure in it."""


def most(parts: Iterable[Records]) -> Records:
    """The most of each kind."""
    found = Records()
    for one in parts:
        found = Records(max(found.trace, one.trace), max(found.values, one.values))
    return found


@dataclass
class Noted:
    """The procedures of the program of one node."""

    system: System
    bodies: dict[Place, Subprogram]

    @classmethod
    def of(cls, system: System) -> Noted:
        """Those of the instances, buses and processors of a system of one node."""
        units = (*emit_instances(system, ""), *emit_deployment(system, ""))
        bodies = {}
        for unit in units:
            for place, one in _procedures(unit):
                bodies[_below(place[0], system), place[1]] = one
        return cls(system, bodies)

    def of_slot(self, slot: Slot) -> Records:
        """The most records of one execution of a row; its own is noted by the processor."""
        home = ada_case(slot.owner)
        special = {Work.BUS_RECEIVE: ("Receiver", "Receive"), Work.BUS_WATCH: ("Watch", "Watch")}
        if slot.work in special:
            unit, name = special[slot.work]
            return Records(1) + self.called((home, unit), f"Run_{name}")
        return Records(1) + self.called((home,), f"Run_{ada_case(slot.name)}")

    def called(self, home: tuple[str, ...], name: str, event: str | None = None) -> Records:
        """A call of a procedure; of `Offer` with that event."""
        return self._statements(self.bodies[home, name].body or (), (home, name), event)

    def _statements(self, body: Iterable[Stmt], at: Place, event: str | None) -> Records:
        return sum((self._statement(one, at, event) for one in body), Records())

    def _statement(self, one: Stmt, at: Place, event: str | None) -> Records:
        match one:
            case Do(name, _):
                return self._call(one, name, at)
            case IfStatement(branches, otherwise):
                bodies = [*(body for _, body in branches), otherwise]
                return most(self._statements(body, at, event) for body in bodies)
            case Case(_, branches):
                chosen = [
                    body
                    for choices, body in branches
                    if event is None or event in {n.last for n in names_in(choices)}
                ]
                return most(self._statements(body, at, event) for body in chosen)
            case Loop(head, body):
                assert head is not None, at
                assert isinstance(head.domain, Range), at
                return self._repeated(head.domain, body, at)
        return Records()

    def _repeated(self, domain: Range, body: tuple[Stmt, ...], at: Place) -> Records:
        """A loop: a given number of times, for all firings, or for all events of a step."""
        if isinstance(domain.high, IntegerLiteral):
            return self._statements(body, at, None).times(domain.high.value)
        region = self._region(at)
        names = {name.text for name in names_in(domain.high)}
        if "Fired.Count" in names:
            count = RegionShape(self.system, self._component(at), region).most_firings
            return self._statements(body, at, None).times(count)
        assert "Box.Raised" in names, (at, names)
        steps = Steps(Tree(region))
        raised = (len(t.get(RAISED, ())) for _, t in (*steps.single(), *steps.shared()))
        each = most(self.called(at[0], "Offer", self._literal(at, e)) for e in region.raises)
        return each.times(max(raised, default=0))

    def _call(self, call: Do, name: DottedName, at: Place) -> Records:
        text = name.text
        if text.endswith(("Faults.Report", "Buffer.Note")):  # of the trace of any core
            return Records(1)
        if text.endswith("Values.Note"):
            return Records(0, 1)
        if text.endswith("_Answered_Offers.Offer"):
            queued = name.parts[-2].removesuffix("_Answered_Offers")
            return Records(1) + self.called(at[0], f"{queued}_Overflowed")
        if text.endswith("_Offers.Offer"):
            return Records(1)
        parts = _below(name.parts, self.system)
        places = ((at[0], parts[0]),) if len(parts) == 1 else ()
        for home, own in (*places, (parts[:-1], parts[-1]), ((*at[0], *parts[:-1]), parts[-1])):
            if (home, own) in self.bodies:
                event = self._offered(call, home) if own == "Offer" else None
                return self.called(home, own, event)
        return Records()  # of the runtime, of a chart, or of the user

    def _offered(self, call: Do, home: tuple[str, ...]) -> str | None:
        component = self._component((home, ""))
        literals = {event_literal(event.name) for event in component.events}
        return next(
            (n.last for arg in call.args for n in names_in(arg) if n.last in literals), None
        )

    def _component(self, at: Place) -> Component:
        (home,) = at[0]
        found = (i.component for i in self.system.instances if ada_case(i.name) == home)
        return next(found)

    def _region(self, at: Place) -> Region:
        regions = self._component(at).regions
        return next(r for r in regions if at[1] == f"Step_{ada_case(r.name)}")

    def _literal(self, at: Place, event: str) -> str:
        events = self._component(at).events
        return next(event_literal(e.name) for e in events if e.name.lower() == event.lower())


def _procedures(unit: Unit) -> Iterator[tuple[Place, Subprogram]]:
    if isinstance(unit.item, Package) and unit.item.is_body:
        for item in unit.item.items:
            if isinstance(item, Subprogram):
                yield (unit.name.parts, item.name), item


def _below(parts: tuple[str, ...], system: System) -> tuple[str, ...]:
    """A name without the system's package in front."""
    root = root_package(system)
    own = root.parts if isinstance(root, DottedName) else (root,)
    return parts[len(own) :] if parts[: len(own)] == own else parts
