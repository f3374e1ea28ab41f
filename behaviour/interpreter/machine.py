# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A whole system in virtual time.

At each instant every processor that is due runs its table in order, the highest
priority first. An execution takes no time. A processor that a queue or interrupt releases is due
when something has come there and its separation is over; its releases are at such
instants too. A processor that a bus releases does not run: received values come as
stimuli, and values sent on a bus are discarded. Activities that the user writes do
nothing.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator

from ravenchart.gen.language.terms import Ns, Value
from ravenchart.gen.model.component import Activity, Port, PortKind
from ravenchart.gen.model.instances import End, Events, Instance
from ravenchart.gen.model.logical import logical_links
from ravenchart.gen.model.nodes import InterruptLine
from ravenchart.gen.model.statechart import DONE, OnEvent, Overflow, Region
from ravenchart.gen.model.system import Processor, Slot, System, Work

from .expressions import Outbox, PortReading, View, least_value, perform
from .region import RegionRun
from .stimuli import Arrived, InterruptCame, Raised, Stimuli, Stimulus
from .traces import StepRecord, ValueRecord


class Mailbox:
    """The values at an input port that wait for the row that handles it."""

    def __init__(self, port: Port) -> None:
        """An empty mailbox; that of a sampled port keeps the last value."""
        self.port = port
        sampled = port.kind is PortKind.SAMPLED
        self.depth = 1 if sampled else port.depth
        self.policy = Overflow.DROP_OLDEST if sampled else port.overflow
        self.waiting: deque[Value] = deque()
        self.has_lost = False
        """A value was lost since the last run of the handler."""

    def put(self, value: Value, visible: int) -> None:
        """Keep a value, or lose one; it is visible at once."""
        if len(self.waiting) < self.depth:
            self.waiting.append(value)
            return
        self.has_lost = True
        if self.policy is Overflow.DROP_OLDEST:
            self.waiting.popleft()
            self.waiting.append(value)

    def look(self, now: int) -> None:
        """Let the handler find what is visible at an instant: all that waits."""

    def coming(self) -> list[Value]:
        """The values that the handler has not taken, oldest first."""
        return list(self.waiting)


class LogicalMailbox(Mailbox):
    """The values of a sender with a logical execution time, the newest first."""

    def __init__(self, port: Port, depth: int) -> None:
        """An empty mailbox that keeps so many values."""
        super().__init__(port)
        self.kept: list[tuple[int, Value]] = []
        self.most, self.next = depth, 0

    def put(self, value: Value, visible: int) -> None:
        """Keep a value that is visible from an instant on."""
        same = bool(self.kept) and self.kept[0][0] == visible
        self.kept = [(visible, value), *self.kept[same:]][: self.most]

    def coming(self) -> list[Value]:
        """As of any mailbox; some of the values are not visible yet."""
        return [value for at, value in reversed(self.kept) if at >= self.next]

    def look(self, now: int) -> None:
        """Let the handler find the newest value that is visible and was not taken before."""
        self.waiting.clear()
        found = next(((at, value) for at, value in self.kept if at <= now), None)
        if found is not None and found[0] >= self.next:
            self.next = found[0] + 1
            self.waiting.append(found[1])


class InstanceRun:
    """A component instance that runs."""

    def __init__(self, instance: Instance, region_run: type[RegionRun] = RegionRun) -> None:
        """Before anything has run; ``region_run`` runs its regions."""
        self.instance = instance
        self.component = instance.component
        self.parameters = dict(instance.parameters)
        self.data = {data.name: data.initial for data in self.component.data}
        self.ports = {
            port.name: PortReading(least_value(port.type)) for port in self.component.inputs()
        }
        self.mailboxes = {port.name: Mailbox(port) for port in self.component.inputs()}
        policies = {e.name: e.overflow for e in self.component.events if e.overflow is not None}
        self.regions = {
            region.name: region_run(region, policies, self._works_in(region))
            for region in self.component.regions
        }

    def _works_in(self, region: Region) -> list[str]:
        """The states of a region that have a do activity."""
        states = [a.while_in for a in self.component.activities if a.while_in is not None]
        return [one.state for one in states if one.region == region.name]

    def view(self) -> View:
        """The values that an execution reads when it begins now."""
        active = {name: run.published for name, run in self.regions.items()}
        return View(dict(self.data), self.parameters, dict(self.ports), active)

    # --- events

    def offer(self, event: str, value: Value | None) -> None:
        """Offer an event to every region that names it; each loss raises its `on_overflow` once."""
        for full in self._enqueue(event, value):
            self._enqueue(full, None)

    def _enqueue(self, event: str, value: Value | None) -> list[str]:
        """Queue an event; the `on_overflow` events of the regions that lost one."""
        told: list[str] = []
        for run in self.regions.values():
            if _names(run.region, event) and not run.offer(event, value):
                told += [run.region.on_overflow] if run.region.on_overflow is not None else []
        return told

    # --- rows

    def run_ports(self, handler: str, now: Ns) -> list[tuple[str, Value]]:
        """Run a row that handles ports: at most one arrival of each; the values that it took."""
        taken: list[tuple[str, Value]] = []
        timing = self.component.handlers()[handler]
        for port in self.component.handled(handler):
            self.mailboxes[port.name].look(now)
            mailbox, before = self.mailboxes[port.name], self.ports[port.name]
            happened: list[tuple[str | None, Value | None]] = []
            if mailbox.has_lost:
                happened.append((port.on_overflow, None))
                mailbox.has_lost = False
            if mailbox.waiting:
                value = mailbox.waiting.popleft()
                self.ports[port.name] = PortReading(value, "fresh")
                happened.append((port.on_arrival, value))
                taken.append((port.name, value))
            elif before.state != "never_received":
                age = before.age + 1
                old = port.max_age is not None and age > port.max_age // timing.period
                self.ports[port.name] = PortReading(
                    before.value, "stale" if old else before.state, age
                )
                if old and before.state == "fresh":
                    happened.append((port.on_stale, None))
            for event, value_of_event in happened:
                if event is not None:
                    self.offer(event, value_of_event if self._is_typed(event) else None)
        return taken

    def _is_typed(self, event: str) -> bool:
        return any(e.name == event and e.type is not None for e in self.component.events)

    def publish(self, view: View, written: tuple[str, ...]) -> None:
        """Let others see the data that an execution wrote."""
        self.data |= {name: view.data[name] for name in written}


def _names(region: Region, event: str) -> bool:
    """Whether a region waits for an event or defers it."""
    triggers = any(t.trigger == OnEvent(event) for t in region.transitions)
    return triggers or any(event in state.defers for state in region.states)


class Machine:
    """A system that runs."""

    def __init__(self, system: System, region_run: type[RegionRun] = RegionRun) -> None:
        """Before the epoch; ``region_run`` runs the regions."""
        self.system = system
        self.instances = {one.name: InstanceRun(one, region_run) for one in system.instances}
        for link in logical_links(system):
            end = link.connection.target
            boxes = self.instances[end.instance].mailboxes
            boxes[end.name] = LogicalMailbox(boxes[end.name].port, link.depth)
        self._lasting = {
            (row, link.connection.target): link.lasting
            for link in logical_links(system)
            for row in link.rows
        }
        self._periodic = [one for one in system.processors if one.released_by is None]
        kinds = End | Events | InterruptLine
        woken = (one for one in system.processors if isinstance(one.released_by, kinds))
        self._woken = sorted(woken, key=lambda one: -one.priority)
        self.earliest = {one.name: 0 for one in self._woken}
        """The earliest next release of each processor that a queue or interrupt releases."""
        self.accepted: frozenset[InterruptLine] = frozenset()
        """The interrupts that have not released their processors yet."""
        self.started = False
        """The regions whose events release a processor have made their start."""
        self.values: list[ValueRecord] = []
        """The recorded values so far."""

    def run(self, stimuli: Stimuli) -> Iterator[StepRecord]:
        """Run up to the last instant; the steps that executed a behaviour."""
        coming = deque(stimuli.entries)
        for now, slots in self.instants(stimuli.until):
            due: list[Stimulus] = []
            while coming and coming[0].at <= now:
                due.append(coming.popleft())
            yield from self.execute(now, slots, due)

    def execute(
        self, now: Ns, slots: Iterable[Slot], entries: Iterable[Stimulus] = ()
    ) -> Iterator[StepRecord]:
        """Execute one instant: first the stimuli from outside, then the rows."""
        yield from self._start()
        for entry in entries:
            self._take(entry, now)
        for slot in slots:
            if self._woken:
                above = self.system.processor_of(slot.element)
                yield from self._release(now, above)
            yield from self._execute(now, slot)
        yield from self._release(now, None)

    def _start(self) -> Iterator[StepRecord]:
        """Before the first instant: the starts of regions whose events release a processor."""
        if self.started:
            return
        self.started = True
        for taken in (one.released_by for one in self._woken):
            if isinstance(taken, Events):
                yield from self._run_region(Ns(0), self.instances[taken.instance], taken.name)

    def _waits(self, queue: End | Events | InterruptLine) -> bool:
        """Whether something has come that releases a processor."""
        if isinstance(queue, InterruptLine):
            return queue in self.accepted
        own = self.instances[queue.instance]
        if isinstance(queue, End):
            return bool(own.mailboxes[queue.name].waiting)
        run = own.regions[queue.name]
        return bool(run.completed or run.queue)

    def _release(self, now: Ns, before: Processor | None) -> Iterator[StepRecord]:
        """Run the processors that values and events release and that are above ``before``."""
        for one in self._woken:
            queue = one.released_by
            due = before is None or (one.priority > before.priority)
            if not due or now < self.earliest[one.name]:
                continue
            if isinstance(queue, End | Events | InterruptLine) and self._waits(queue):
                self.accepted -= {queue}
                self.earliest[one.name] = now + one.period
                for slot in one.slots:
                    yield from self._execute(now, slot)

    def instants(self, until: Ns) -> Iterator[tuple[Ns, list[Slot]]]:
        """Each release instant with the rows that run then, in order."""
        found = self.following(-1)
        while found is not None and found[0] <= until:
            yield found
            found = self.following(found[0])

    def following(self, after: int) -> tuple[Ns, list[Slot]] | None:
        """The first release instant after that time, with its rows; None: there is no release."""
        releases: list[tuple[Ns, int, int, int]] = []
        for index, own in enumerate(self._periodic):
            count = max(0, (after - own.offset) // own.period + 1)
            releases.append((Ns(own.offset + count * own.period), -own.priority, index, count))
        if not releases:
            return None
        now = min(releases)[0]
        slots = [
            slot
            for at, _, index, count in sorted(releases)
            if at == now
            for slot in self._periodic[index].slots
            if count % slot.divisor == slot.phase
        ]
        return now, slots

    def _take(self, entry: Stimulus, now: int) -> None:
        match entry:
            case Raised():
                self.instances[entry.instance].offer(entry.event, entry.value)
            case Arrived():
                self._put(entry.end, entry.value, now)
            case InterruptCame():
                self._interrupt(entry.line, now)

    def _interrupt(self, line: InterruptLine, now: int) -> None:
        """Accept an interrupt once the separation of its processor is over."""
        released = (one for one in self._woken if one.released_by == line)
        if all(now >= self.earliest[one.name] for one in released):
            self.accepted |= {line}

    def _put(self, end: End, value: Value, visible: int) -> None:
        self.instances[end.instance].mailboxes[end.name].put(value, visible)

    def _execute(self, now: Ns, slot: Slot) -> Iterator[StepRecord]:
        """One execution of a row."""
        match slot.work:
            case Work.PORT_REGION:
                for name, value in self.instances[slot.owner].run_ports(slot.name, now):
                    self._record(now, slot.owner, name, value)
            case Work.REGION:
                yield from self._run_region(now, self.instances[slot.owner], slot.name)
            case Work.ACTIVITY:
                own = self.instances[slot.owner]
                activity = next(a for a in own.component.activities if a.name == slot.name)
                self._run_activity(now, own, activity)
            case Work.BUS_RECEIVE | Work.BUS_WATCH:
                pass

    def _run_region(self, now: Ns, own: InstanceRun, name: str) -> Iterator[StepRecord]:
        run = own.regions[name]
        view = own.view()
        run.begin()
        for _ in range(run.region.steps_per_execution):
            step = run.step(view)
            self._deliver(now, own, name, step.out)
            if step.lost and run.region.on_overflow is not None:
                own.offer(run.region.on_overflow, None)
            if step.behaviours:
                yield StepRecord(now, own.instance.name, name, tuple(step.behaviours))
        run.publish()
        own.publish(view, run.region.writes)
        for data in own.component.data:
            if data.name in run.region.writes:
                self._record(now, own.instance.name, data.name, own.data[data.name])

    def _run_activity(self, now: Ns, own: InstanceRun, activity: Activity) -> None:
        state = activity.while_in
        if activity.flow is None:
            return
        if state is not None and state.state not in own.regions[state.region].published:
            return
        view, out = own.view(), Outbox()
        perform(activity.flow, view, out)
        own.publish(view, activity.writes)
        for name in activity.writes:
            self._record(now, own.instance.name, name, own.data[name])
        raised = dict(out.raised)
        if state is not None and DONE in raised:
            own.regions[state.region].finish(state.state)
        in_order = [(event, raised[event]) for event in activity.raises if event in raised]
        out.raised = [one for one in in_order if one[0] != DONE]
        self._deliver(now, own, activity.name, out)

    def _record(self, now: Ns, instance: str, item: str, value: Value) -> None:
        """Record a value that was set, sent or taken, where the model records it."""
        for one in self.system.values_of(instance, item):
            scalar = dict(value)[one.field or ""] if isinstance(value, tuple) else value
            self.values.append(ValueRecord(now, one.element, scalar))

    def _deliver(self, now: Ns, own: InstanceRun, row: str, out: Outbox) -> None:
        """Send the values, ports in model order; then raise the events, in the order raised."""
        for port in own.component.outputs():
            if port.name in out.sent:
                self._record(now, own.instance.name, port.name, out.sent[port.name])
                for connection in self.system.connections:
                    if connection.source == End(own.instance.name, port.name):
                        sent = f"{own.instance.name}.{row}", connection.target
                        visible = now + self._lasting.get(sent, 0)
                        self._put(connection.target, out.sent[port.name], visible)
        for event, value in out.raised:
            own.offer(event, value)
