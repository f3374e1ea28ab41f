# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Latencies from end to end through the rows of a system.

A way of values through messages, ports, rows and data is taken hop by hop. A row
that runs later in the same job than the row before it follows at once. Any other row
samples its input at its own times, or takes one value in a job from a queued port,
where the writer may put several in a job. A region that takes its occurrences one by
one has no bound, because the number of waiting occurrences is not known here.

A received frame waits in the queue of its bus for the reception, which takes
one at a time and keeps its least separation.

`core.chains` computes the sums. It gets the rows as items of their own, each with its
period and its response inside the job.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from ravenchart.analysis.core import can
from ravenchart.analysis.core.bus import Bus, Frame
from ravenchart.analysis.core.chains import ChainStep, HopKind, Latency, TimedChain, latency
from ravenchart.analysis.core.holistic import Holistic, Network
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.responses import Level, Response
from ravenchart.analysis.core.tasks import Task
from ravenchart.gen.derive.calls import calls_at_once
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import Ns, named
from ravenchart.gen.model.buses import Message, Reception
from ravenchart.gen.model.component import Activity, Port, PortKind
from ravenchart.gen.model.instances import End, Events, Requests
from ravenchart.gen.model.logical import links_by_port, saved_wait, timed_row
from ravenchart.gen.model.nodes import InterruptLine
from ravenchart.gen.model.raising import more_events, raised_at_once, raises_for
from ravenchart.gen.model.samples import hidden_by
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Carried, Chain, Processor, Stop, System

from .transport import Transfer, transfers

__all__ = ["Delivery", "HopKind", "Latencies", "Latency", "deliveries"]


@dataclass(frozen=True, slots=True)
class Delivery:
    """The time of a received message from its event until it is handed over on a node.

    ``bound`` is None where frames come faster than they are taken; ``wait`` is the time
    in the queue.
    """

    reception: Reception
    bound: int | None
    wait: int | None

    @property
    def message(self) -> Message:
        """The received message."""
        return self.reception.message


def deliveries(system: System, found: Holistic) -> dict[str, Delivery]:
    """Every message on every node that hands it over, by the element of its reception.

    The separation counts from when the reception first ran, which can be as late as
    its response.
    """
    made: dict[str, Delivery] = {}
    for processor in system.processors:
        frames = reception_frames(processor, system, found)
        turns = {r.frame.name: r.bound for r in can.analyse(frames, Bus(bit_time=1))}
        own = found.responses[processor.name].bound
        for one in system.received(processor.released_by, processor.node):
            bound, late = turns.get(one.element), found.from_event(one.driver)
            if bound is None or own is None or late is None:
                made[one.element] = Delivery(one, None, None)
            else:
                turn = bound - processor.period
                made[one.element] = Delivery(one, turn + 2 * own, turn + own - late)
    return made


def reception_frames(processor: Processor, system: System, found: Holistic) -> list[Frame]:
    """The frames that wait for a reception, as frames of one sender: each takes the separation.

    They are served in the order of arrival, like a first-in first-out queue of a bus. Empty
    where the time of an arrival has no bound.
    """
    frames = []
    received = system.received(processor.released_by, processor.node)
    for number, one in enumerate(received):
        late = found.from_event(one.driver)
        if late is None:
            return []
        times = (one.message.period, one.message.limit, processor.period, late)
        frames.append(Frame(one.element, number, *times, queue=processor.name))
    return frames


@dataclass(frozen=True, slots=True)
class Latencies:
    """Rows, drivers, frames and deliveries as items of chains, with their responses."""

    system: System
    network: Network
    found: Holistic
    rows: Mapping[str, tuple[Processor, int]]
    """Each row's processor, and its place in the table."""
    travels: Mapping[str, Transfer] = field(default_factory=dict)
    """Values in several frames, by their reception."""

    @classmethod
    def of(
        cls, system: System, network: Network, found: Holistic, delivered: Mapping[str, Delivery]
    ) -> Latencies:
        """From the responses of a system's network."""
        items: list[tuple[Task, int | None]] = []
        for task in network.tasks:
            response = found.responses[task.name]
            bounds = {r.row.name: r.bound for r in getattr(response, "rows", ())}
            for row in task.rows:
                item = _item(row.name, task.period * row.every, row.wcet)
                items.append((item, bounds.get(row.name)))
        released = {n: by for n, by in network.released_by.items() if n not in _sending(system)}
        periods = {task.name: task.period for task in network.tasks}  # others where those are tried
        travels = transfers(system, delivered)
        for element, one in delivered.items():
            period = periods[one.reception.driver]
            #  of a value in several frames the whole of it
            bound = travels[element].bound if element in travels else one.bound
            items.append((_item(handed(element), period, 1), bound))
            released[handed(element)] = one.reception.driver
        tasks = [task for task in network.tasks if not task.rows]
        tasks += [item for item, _ in items]
        view = replace(network, tasks=tuple(tasks), released_by=released)
        responses = dict(found.responses)
        for item, bound in items:
            responses[item.name] = Response(item, Level((item,), 1, Platform()), None, bound)
        places = {
            slot.element: (processor, place)
            for processor in system.processors
            for place, slot in enumerate(processor.slots)
        }
        best = dict.fromkeys(responses, 0)
        view_of = replace(found, responses=responses, best=best)
        return cls(system, view, view_of, places, travels)

    def of_chain(self, chain: Chain) -> Latency:
        """The latency of a chain, with its limits."""
        limits = (chain.reaction or 0, chain.age or 0)
        return self.along(chain.name, chain.way, *limits, of_call=chain.of_call)

    def along(
        self,
        name: str,
        way: Sequence[Stop],
        reaction: int = 0,
        age: int = 0,
        *,
        of_call: bool = False,
    ) -> Latency:
        """The latency of a way, which lists messages, ports, rows and data.

        ``of_call``: from the release of the row that the way begins with.
        """
        steps: list[ChainStep] = []
        released = dict(self.network.released_by)
        kept = self._seldom(way[0])  # why a job may leave what comes next as it was
        following: Stop | None
        for place, following in zip(way, (*way[1:], None), strict=True):
            if isinstance(place, Carried):
                found = named(self.system.messages, place.message)
                received = self.system.reception(found, following)
                steps += _of_message(found, received, steps, released)
                steps[-1] = self._whole(steps[-1], received)
                continue
            row, port = str(place), self._input(place)
            if port is not None:
                row = self.system.handler(place)
            elif row not in self.rows:
                continue
            if kept:
                steps[-1] = replace(steps[-1], keeps=kept)
            line = self.rows[row][0].released_by_interrupt
            if line is not None and not steps:
                steps.append(ChainStep(str(line), HopKind.RELEASED))
            steps.append(self._row(row, port, place, steps, released))
            kept = self._kept(place, following) if port is None else self._rarely(place, following)
        if kept:
            steps[-1] = replace(steps[-1], keeps=kept)
        if of_call:
            steps[0] = replace(steps[0], hop=HopKind.RELEASED, waits="")
        network = replace(self.network, released_by=released)
        return latency(TimedChain(name, tuple(steps), reaction, age), network, self.found)

    def _whole(self, step: ChainStep, received: Reception | None) -> ChainStep:
        """The handing over of a value in several frames; only one value travels at a time."""
        travel = None if received is None else self.travels.get(received.element)
        if travel is None or travel.cycle is None:
            return step
        return replace(step, longest=travel.cycle, delay=travel.cycle - travel.message.period)

    def _input(self, place: End) -> Port | None:
        """The input port of a place; None for a place that is none."""
        ports = self.system.instance(place.instance).component.inputs()
        return next((port for port in ports if port.name == place.name), None)

    def _seldom(self, first: Stop) -> str:
        """Why the time to the next frame of the first message of a way has no bound.

        "" where it has one, or where this follows from the message alone.
        """
        if not isinstance(first, Carried):
            return ""
        message = named(self.system.messages, first.message)
        source = message.source
        if source is None or message.call is not None or message.transmission is not None:
            return ""
        senders = self.system.instance(source.instance).component.senders(source.name)
        kept = (self._kept(End(source.instance, one.name), source) for one in senders)
        return next(filter(None, kept), "")

    def _kept(self, row: End, following: Stop | None) -> str:
        """Why jobs of a row may leave the next place unchanged; "" where none does."""
        if rarely := self._rarely(row, following):
            return rarely
        component = self.system.instance(row.instance).component
        item = named(component.runnables(), row.name)
        if not isinstance(following, End) or component.renews(item, following.name):
            return ""
        return f"{row} gives {following} a new value in some of its jobs only"

    def _rarely(self, place: End, following: Stop | None) -> str:
        """The reason of `_kept` where a row or port raises events for the next row; else ""."""
        if not raises_for(self.system, place, following):
            return ""
        return f"{place} raises events for {following} in some jobs only"

    def _row(
        self,
        row: str,
        port: Port | None,
        place: End,
        steps: Sequence[ChainStep],
        released: dict[str, str],
    ) -> ChainStep:
        """A row: later in the same job as the step before, or at its own times."""
        woken = port is not None and bool(steps) and self.system.woken_by(place) is not None
        called = self.rows[row][0].released_by
        if isinstance(called, Requests) and steps and self.rows[row][1] == 0:
            made = ChainStep(row, HopKind.WOKEN, puts=calls_at_once(self.system, called))
            return self._rare(made, self.rows[row][0], steps[-1].name)
        if isinstance(called, InterruptLine) and steps and steps[-1].name == str(called):
            return self._rare(ChainStep(row, HopKind.WOKEN), self.rows[row][0], steps[-1].name)
        if isinstance(called, Events) and steps and row == str(called):
            raised = raised_at_once(self.system, called).get(steps[-1].name, 0)
            if raised:
                waits = more_events(self.system, called, steps[-1].name)
                made = ChainStep(row, HopKind.WOKEN, puts=raised, waits=waits)
                return made if waits else self._rare(made, self.rows[row][0], steps[-1].name)
        queued = not woken and port is not None and port.kind is PortKind.QUEUED and bool(steps)
        senders = self._senders(place) if queued or woken else ()
        puts = max((getattr(one, "steps_per_execution", 1) for one in senders), default=1)
        before = steps[-1].name if steps else ""
        hop = HopKind.QUEUED if queued else HopKind.WOKEN if woken else HopKind.SAMPLED
        made = self._visible(ChainStep(row, hop, puts=puts), place, before)
        if before in self.rows and row in self.rows and puts == 1 and len(senders) < 2:
            (processor, first), (other, then) = self.rows[before], self.rows[row]
            divisors = {processor.slots[first].divisor, other.slots[then].divisor}
            phases = {processor.slots[first].phase, other.slots[then].phase}
            if processor is other and first < then and len(divisors) == len(phases) == 1:
                released[row] = before
                made = ChainStep(row, HopKind.RELEASED)
        if len(senders) > 1:
            names = " and ".join(sender.name for sender in senders)
            made = replace(made, waits=f"{names} both send to {place}, which gives one in a job")
        if port is not None and before in self.rows:
            hider = hidden_by(self.system, before, place)
            if hider is not None:
                made = replace(made, waits=f"{hider} may hide the values of {before} in {place}")
        processor, at = self.rows[row]
        slot = processor.slots[at]
        if processor.released_by_value is not None and made.hop is not HopKind.RELEASED:
            made = self._rare(made, processor, before)
        regions = self.system.instance(slot.owner).component.regions
        if any(region.name == slot.name and region.takes_turns for region in regions):
            waits = f"{row} takes events, time-outs and completions one by one, oldest first"
            made = replace(made, waits=waits)
        return made

    def _visible(self, step: ChainStep, place: End, before: str) -> ChainStep:
        """The step, with the instants from which on it sees the values of the one before."""
        link = links_by_port(self.system).get(place)
        if link is None or before not in link.rows:
            return step
        rows = timed_row(self.system, before), timed_row(self.system, step.name)
        return replace(step, lasting=link.lasting, saved=saved_wait(*rows, link.lasting))

    def _rare(self, step: ChainStep, processor: Processor, sender: str) -> ChainStep:
        """The row that begins a release of a processor that a port releases.

        Values do not pile up where they come no sooner than the separation of the processor,
        and each release completes within this separation.
        """
        response = self.found.responses[processor.name].bound
        if step.hop is HopKind.SAMPLED:
            by = processor.released_by
            what = "an event for" if isinstance(by, Events) else "a value for"
            what = "the interrupt" if isinstance(by, InterruptLine) else what
            waits = f"{step.name} runs only when {what} {by} comes"
            return replace(step, waits=waits, keeps=waits)
        period = self.network.items()[sender].period
        if period < step.puts * processor.period:
            events = isinstance(processor.released_by, Events)
            verb, what = ("raise", "events") if events else ("send", "values")
            many = f"{step.puts} {what} " if step.puts > 1 else ""
            waits = (
                f"{sender} may {verb} {many}every {shown(Ns(period))}, but {processor.name} is "
                f"released every {shown(processor.period)} at most"
            )
            return replace(step, waits=waits)
        if response is None or response > processor.period:
            waits = f"{processor.name} may take longer than its least separation"
            return replace(step, waits=waits)
        return step

    def _senders(self, place: End) -> tuple[Region | Activity, ...]:
        """The rows that send to a port over a connection; a message has one."""
        for connection in self.system.connections:
            if connection.target == place:
                source = self.system.instance(connection.source.instance)
                return source.component.senders(connection.source.name)
        return ()


def handed(element: str) -> str:
    """The handing over of a received message, as an item."""
    return f"{element}.reception"


def _sending(system: System) -> set[str]:
    return {message.sending for message in system.messages}


def _of_message(
    message: Message,
    received: Reception | None,
    steps: Sequence[ChainStep],
    released: dict[str, str],
) -> list[ChainStep]:
    """The driver's work and the frame, then its reception where there is one."""
    names = [message.element]
    mode = message.transmission
    if message.source is not None:
        names.insert(0, message.sending)
        if steps:
            released[names[0]] = steps[-1].name
    if received is not None:
        names += [received.driver, handed(received.element)]
    keeps, longest = "", 0
    if mode is not None:
        keeps = "" if mode.longest is not None else f"{message.name} is sent {mode.words} only"
        longest = mode.longest or 0
    steps_made = [ChainStep(name, HopKind.RELEASED, longest=longest) for name in names]
    return [*steps_made[:-1], replace(steps_made[-1], keeps=keeps)]


def _item(name: str, period: int, wcet: int) -> Task:
    """A row or a handing over, as an item of chains."""
    return Task(name, 0, period, period, wcet)
