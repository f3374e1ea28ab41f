# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The records that may wait in the trace of a node, and in its buffer of values.

Each execution of a row notes a record, and one for each transition, state, event, value, frame and
fault. Here every row does the most that it can: each step takes transitions in all regions and
raises the most events, all values are sent, and each queue is full. Such a count is safe, and
seldom attained; a test compares it with the statements of generated code. Missed deadlines,
overruns and silence do not count: none of them comes where the bounds are within their deadlines.

In a window of length w a task with response R and period T executes in at most
ceil((w + R) / T) jobs. As many consecutive jobs of its table note the most that they can, summed as
execution times are (Baruah, Chen, Gorinsky and Mok 1999).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ravenchart.analysis.core.multiframe import Demand
from ravenchart.analysis.core.responses import Response
from ravenchart.gen.derive.calls import (
    callers_of,
    calls_from_afar,
    delivered,
    element_bindings,
    publications,
)
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.chart.steps import RAISED, Steps
from ravenchart.gen.model.chart.tree import Tree
from ravenchart.gen.model.commands import Binding, Gathered, Need, Remote, RemoteRead, Server
from ravenchart.gen.model.component import Activity, PortKind
from ravenchart.gen.model.instances import End, Instance, Requests
from ravenchart.gen.model.statechart import DONE, PseudoKind, Region
from ravenchart.gen.model.system import Slot, System, Work

FRAME = 2
"""Records of a frame: it is sent, and finds no room."""


@dataclass(frozen=True, slots=True)
class Records:
    """Numbers of records: of the trace, and of recorded values."""

    trace: int = 0
    values: int = 0

    def __add__(self, other: Records) -> Records:
        """One after the other."""
        return Records(self.trace + other.trace, self.values + other.values)

    def times(self, count: int) -> Records:
        """So many times."""
        return Records(self.trace * count, self.values * count)


def most_noted(
    system: System, node: str, responses: Iterable[Response], window: int
) -> Records | None:
    """The most records that the tasks of a node note within ``window`` (ns), with the shutdown.

    None where one of them may miss its deadline.
    """
    slots = {slot.element: slot for slot in system.slots}
    found = _events(system, node, system.shutdown.raises)
    for one in responses:
        if not one.task.rows:
            continue
        if one.bound is None or not one.met:
            return None
        jobs = -(-(window + one.bound) // one.task.period)
        of_rows = {row.name: of_slot(system, slots[row.name]) for row in one.task.rows}
        tables = [[of_rows[row.name] for row in rows] for rows in one.task.frames]
        trace = Demand(tuple(sum(records.trace for records in table) for table in tables))
        values = Demand(tuple(sum(records.values for records in table) for table in tables))
        found += Records(trace.most(jobs), values.most(jobs))
    return found


def of_slot(system: System, slot: Slot) -> Records:
    """The most records of one execution of a row, its own among them."""
    own, node = Records(1), system.processor_of(slot.element).node
    if slot.work is Work.BUS_RECEIVE:
        return own + _reception(system, node, slot.owner)
    if slot.work is Work.BUS_WATCH:
        return own + Records(3) + _events(system, node, system.bus(slot.owner).raises)
    counts = _Counts(system, slot.owner)
    if slot.work is Work.PORT_REGION:
        return own + counts.ports(slot.name)
    rows = counts.instance.component.runnables()
    return own + counts.row(next(row for row in rows if row.name == slot.name))


def _sum(parts: Iterable[Records]) -> Records:
    return sum(parts, Records())


def _events(system: System, node: str, events: Iterable[tuple[str, str]]) -> Records:
    """Those of the events (instance, event) that are raised on that node."""
    here = ((i, e) for i, e in events if system.home(End(i, e)) == node)
    return _sum(_Counts(system, instance).offered(event) for instance, event in here)


def _reception(system: System, node: str, bus: str) -> Records:
    """One frame: it has arrived, or is refused, and its value goes to all receivers of the node."""
    most = 0
    for message in system.messages:
        ends = [end for end in message.targets if system.home(end) == node]
        if message.bus == bus and ends:
            refused = () if message.check is None else message.check.on_error
            one = Records(1) + _events(system, node, refused)
            one += _sum(_Counts(system, end.instance).taken(message, end) for end in ends)
            most = max(most, one.trace)
    return Records(most)


def _watches(row: Region | Activity, binding: Binding) -> bool:
    """Whether a row looks first whether a reply, or published data, is too late."""
    made, name = binding.provider, binding.need.command.name
    if isinstance(made, RemoteRead):
        return made.watcher == row.name
    return isinstance(made, Remote) and made.reply is not None and name in row.sends


class _Counts:
    """The records that one instance notes."""

    def __init__(self, system: System, instance: str) -> None:
        self.system = system
        self.instance: Instance = system.instance(instance)

    # --- what others make it note

    def put(self, port: str) -> Records:
        """A value arrives at an input port, and may find its queue full."""
        queued = self.instance.component.port(port).kind is PortKind.QUEUED
        return Records(2 if queued else 1)

    def offered(self, event: str | None) -> Records:
        """An event is raised; each queue that it is for may be full, and raise an event of that."""
        if event is None or event == DONE:
            return Records()
        heard = list(self._heard(event))
        told = (sum(1 for _ in self._heard(one.on_overflow)) for one in heard if one.on_overflow)
        return Records(1 + len(heard) + sum(told))

    def _heard(self, event: str) -> Iterator[Region]:
        for region in self.instance.component.regions:
            if event.lower() in {name.lower() for name in region.events()}:
                yield region

    def taken(self, message: Message, end: End) -> Records:
        """The value of a message arrives here: at a port, as a call, a reply, or published data."""
        if message.call is not None:
            return self.replied(message.call.need) if message.is_reply else Records(1)
        ports = {port.name for port in self.instance.component.inputs()}
        return self.put(end.name) if end.name in ports else Records()

    # --- its rows

    def ports(self, row: str) -> Records:
        """A handler: each of its ports has a new value, or none in time, and has lost some."""
        found = Records()
        ports = self.instance.component.handled(row)
        for port in ports:
            new, stale = self.offered(port.on_arrival), self.offered(port.on_stale)
            found += Records(1 + max(new.trace, stale.trace)) + self.offered(port.on_overflow)
            found += self._recorded(port.name)
        own, polls = {port.name for port in ports}, self.system.polls
        polled = (p.port for p in polls if p.instance == self.instance.name and p.port in own)
        found += _sum(self.put(port) for port in polled)
        controls = (name for one, name in self._messages() if one.controls and name in own)
        return found + _sum(Records(FRAME + 1) for _ in controls)

    def row(self, row: Region | Activity) -> Records:
        """A region or an activity, with what goes before and behind its steps or requests."""
        found = self._steps(row) if isinstance(row, Region) else self._executions(row)
        found += _sum(self._recorded(name) for name in row.writes)
        found += Records(FRAME * len(publications(self.system, self.instance.name, row)))
        for message, port in self._messages():
            if port in row.sends and (message.transmission or message.transport):
                given_up = 0 if message.transport is None else 1
                found += Records(FRAME + given_up)
        return found + _sum(
            Records(1) + self.offered(binding.need.on_timeout)
            for binding in self.system.bindings
            if binding.instance == self.instance.name and _watches(row, binding)
        )

    def _messages(self) -> Iterator[tuple[Message, str]]:
        """The messages that it sends, each with the port or data item that it is made of."""
        for message in self.system.messages:
            source = message.source
            if source is not None and source.instance == self.instance.name:
                yield message, source.name

    def _steps(self, region: Region) -> Records:
        """The steps of one execution, each with the most transitions, events and values."""
        passed = sum(1 for one in region.pseudostates if one.kind is not PseudoKind.JUNCTION)
        concurrent = len(region.concurrent_regions())
        steps = Steps(Tree(region))
        tallies = [tally for _, tally in (*steps.single(), *steps.shared())]
        raised = max((len(tally.get(RAISED, ())) for tally in tallies), default=0)
        worst = max((self.offered(event).trace for event in region.raises), default=0)
        one = Records(concurrent * (2 + passed) + raised * worst)
        one += _sum(self._sent(port) for port in region.sends)
        if any(state.defers for state in region.states):
            one += Records(1) + self.offered(region.on_overflow)
        return one.times(region.steps_per_execution)

    def _executions(self, activity: Activity) -> Records:
        """An activity, once or for each request that may wait, with the replies to these."""
        component = self.instance.component
        one = _sum(self._sent(port) for port in activity.sends)
        one += _sum(self.offered(event) for event in activity.raises)
        provided = component.served_by(activity.name)
        if provided is None:
            return one
        for binding in callers_of(self.system, self.instance.name, provided):
            one += _Counts(self.system, binding.instance).replied(binding.need)
        one += Records(FRAME * len(calls_from_afar(self.system, self.instance.name, provided)))
        one += _sum(self._recorded(name) for name in activity.writes)
        woken = self.system.called(Requests(self.instance.name, provided.name))
        return one if woken is not None else one.times(provided.depth)

    # --- sending

    def _sent(self, name: str) -> Records:
        """A value is sent, or a command called, with all that its receivers note at once."""
        port = self.instance.component.port(name)
        if port.is_command:
            return self._called(name)
        found = Records(1) + self._recorded(name)
        for connection in self.system.connections:
            if (connection.source.instance, connection.source.name) == (self.instance.name, name):
                target = connection.target
                found += _Counts(self.system, target.instance).put(target.name)
        for message, source in self._messages():
            if source == name and not (message.transmission or message.transport):
                found += Records(FRAME)
        return found

    def _called(self, name: str) -> Records:
        """A command is called: it may find no room, or bring its reply at once."""
        binding = self.system.bound[self.instance.name, name]
        if binding.provider is None:
            return Records()
        full = Records(1) + self.offered(binding.need.on_full)
        if isinstance(binding.provider, Gathered):
            return full + _sum(
                self._called_at(part) + self.replied(part.need)
                for part in element_bindings(self.system, binding)
            )
        return self._called_at(binding)

    def _called_at(self, binding: Binding) -> Records:
        """A command of one provider is called."""
        full = Records(1) + self.offered(binding.need.on_full)
        if isinstance(binding.provider, Server):
            return full
        if isinstance(binding.provider, Remote):
            return Records(max(FRAME, full.trace))
        return self.replied(binding.need)

    def replied(self, need: Need) -> Records:
        """The reply to a command arrives."""
        if not delivered(self.instance.component, need):
            return Records()
        late = self.offered(need.on_timeout) if need.is_part else Records()
        return self.offered(need.on_reply) + late

    def _recorded(self, name: str) -> Records:
        return Records(0, len(self.system.values_of(self.instance.name, name)))
