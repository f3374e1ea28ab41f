# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The deployment by the model: tasks with their rows, messages with their frames.

Follows docs/semantics.md ("Processors") and docs/architecture.md ("Several nodes"). Priorities
that the model leaves open are deadline-monotonic (Leung and Whitehead 1982), and so are
identifiers.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from .equipment import Equipment
from .findings import UnusableError
from .frames import Frame, length_of
from .messages import Message, transfer_of
from .model import Mapping, Model, Text, handler_of, handlers_of
from .tasks import Row, Task


class Deployment:
    """The tasks and messages of a model."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.nodes = model.section("nodes")
        self.buses = model.section("buses")
        self.instances = model.section("instances")
        self.equipment = Equipment(model, self.component_of)
        self._refuse_calls()
        self.messages = self._messages()
        self.messages += self._flows()
        self._identify()
        self.processors = self._processors()
        self._prioritise()
        self.tasks = [*self.processors, *self._drivers(), *self._watchers()]

    # --- look-ups

    def component_of(self, instance: str) -> Mapping:
        """The component of an instance."""
        name = self.instance(instance)
        kind = self.instances.map(name).text("component") or ""
        components = self.model.section("components")
        own = components.name(kind)
        if own is None:
            raise UnusableError(f"{instance} has no component that is declared")
        return components.map(own)

    def instance(self, text: str) -> str:
        """An instance as it is declared."""
        name = self.instances.name(text)
        if name is None:
            raise UnusableError(f"`{text}` is no instance")
        return name

    def home(self, instance: str) -> str:
        """The node of an instance."""
        if len(self.nodes) == 1:
            return next(iter(self.nodes))
        text = self.instances.map(self.instance(instance)).text("node") or ""
        return self.nodes.name(text) or text

    def node_of(self, end: str) -> str:
        """The node of `instance.port`."""
        return self.home(end.rpartition(".")[0])

    def receivers(self, message: Message) -> list[str]:
        """The nodes that receive a message, in the order of its targets."""
        return list(dict.fromkeys(self.node_of(end) for end in message.targets))

    def heard(self, bus: str, node: str) -> list[tuple[Message, str]]:
        """The messages that a node receives from a bus, each with the driver's work on it."""
        found = []
        for message in self.messages:
            homes = self.receivers(message)
            if message.bus == bus and node in homes:
                tail = f"{message.name}.{node}" if len(homes) > 1 else message.name
                found.append((message, f"{bus}.driver_rx.{tail}"))
        return found

    def joins(self, bus: str, node: str) -> bool:
        """Whether a node sends or receives on a bus."""
        sends = any(m.bus == bus and m.node == node for m in self.messages)
        return sends or bool(self.heard(bus, node))

    def _refuse_calls(self) -> None:
        """Commands between nodes become messages, which are not derived again."""
        for binding in self.model.bindings:
            own = binding.text("from") or ""
            bound = (self.equipment.members(text) for text in binding.texts("to"))
            for other in (one for members in bound for one in members):
                if "." in other and self.node_of(own) != self.node_of(other):
                    where = f"{binding.file}:{binding.line}"
                    raise UnusableError(f"{where}: commands between nodes are not derived again")

    # --- messages

    def _messages(self) -> list[Message]:
        found = [self._message(name, form) for name, form in self.model.section("messages").maps()]
        declared = list(found)
        for wire in self.model.connections:
            source, target = wire.text("from") or "", wire.text("to") or ""
            source, target = self._end(source), self._end(target)
            if self.node_of(source) == self.node_of(target):
                continue
            sent = [m for m in found if (m.source or "").lower() == source.lower()]
            on = [m.bus for m in sent if m in declared] or [*self.buses, ""]
            bus = self.buses.name(wire.text("bus") or "") or on[0]
            own = next((m for m in sent if m.bus == bus), None)
            if own is None:
                own = self._carried(source, bus)
                if any(m.name.lower() == own.name.lower() for m in sent):
                    own.name += f"_{own.bus}"
                found.append(own)
            own.targets.append(target)
        return found

    def _end(self, text: str) -> str:
        """`instance.port` as both are declared."""
        owner, _, port = text.rpartition(".")
        ports = self.component_of(owner).map("ports")
        return f"{self.instance(owner)}.{ports.name(port) or port}"

    def _message(self, name: str, form: Mapping) -> Message:
        bus = self.buses.name(form.text("bus") or "") or ""
        source = form.text("from")
        source = None if source is None else self._end(source)
        targets = [self._end(text) for text in form.texts("to")]
        period = form.time("period") if source is None else self._send_period(source)
        if form.map("send"):
            period = form.map("send").time("minimum_delay", period)
        fd = form.text("format") == "fd"
        ends = [*([] if source is None else [source]), *targets]
        kind = self._type_of(ends[0]) if ends else None
        given = form.text("bytes")
        length = length_of(self.model, kind, form, fd) if given is None else form.number("bytes", 0)
        transfer = transfer_of(form, length, period)
        if transfer is not None:
            length, period = 8, transfer.apart
        extended = form.true("extended")
        identifier = None if form.text("id") is None else form.number("id", 0)
        return Message(
            name=name,
            bus=bus,
            period=period,
            deadline=form.time("deadline", period),
            length=length,
            frame=Frame(length, extended, fd),
            source=source,
            node=None if source is None else self.node_of(source),
            targets=targets,
            identifier=identifier,
            extended=extended,
            mac=form.map("authentication").time("mac_wcet", 0),
            renewal=form.map("send").time("period", 0),
            transfer=transfer,
        )

    def _flows(self) -> list[Message]:
        """Flow control of values in several frames: the port region that receives sends it."""
        for message in (m for m in self.messages if m.transfer is not None and m.source):
            owner, _, port = message.targets[0].rpartition(".")
            component = self.component_of(owner)
            period = dict(handlers_of(component))[handler_of(component, port)].time("period")
            message.flow = Message(
                name=f"{message.name}_Flow",
                bus=message.bus,
                period=period,
                deadline=period,
                length=8,
                frame=Frame(8, message.extended, False),
                source=message.targets[0],
                node=self.node_of(message.targets[0]),
                targets=[message.source or ""],
                identifier=message.transfer.flow_id if message.transfer else None,
                extended=message.extended,
                controls=True,
            )
        return [m.flow for m in self.messages if m.flow is not None]

    def rows_of(self, message: Message) -> set[str]:
        """The rows that send a message."""
        source = message.source or ""
        if message.controls:
            owner, _, port = source.rpartition(".")
            return {f"{owner}.{handler_of(self.component_of(owner), port)}"}
        return {row for row, _ in self.rows_that_send(source)}

    def _carried(self, source: str, bus: str) -> Message:
        """The message of a bus that a connection between nodes becomes."""
        kind, period = self._type_of(source), self._send_period(source)
        form = Mapping()
        length = length_of(self.model, kind, form, fd=False)
        fd = "data_rate" in self.buses.map(bus) and length > 8
        length = length_of(self.model, kind, form, fd=True) if fd else length
        name = source.replace(".", "_")
        frame = Frame(length, False, fd)
        return Message(name, bus, period, period, length, frame, source, self.node_of(source))

    def _type_of(self, end: str) -> str:
        owner, _, port = end.rpartition(".")
        form = self.component_of(owner).map("ports").map(port)
        return form.text("in") or form.text("out") or ""

    def rows_that_send(self, end: str) -> list[tuple[str, Mapping]]:
        """The regions and activities that send on an output port."""
        owner, _, port = end.rpartition(".")
        component = self.component_of(owner)
        rows = [*component.map("regions").maps(), *component.map("activities").maps()]
        return [
            (f"{self.instance(owner)}.{name}", row)
            for name, row in rows
            if _sends(row, port.lower())
            or port.lower() in (t.lower() for k in ("sends", "may_send") for t in row.texts(k))
        ]

    def _send_period(self, end: str) -> int:
        periods = [row.time("period") for _, row in self.rows_that_send(end)]
        if not periods:
            raise UnusableError(f"nothing sends on {end}")
        return min(periods)

    def _identify(self) -> None:
        """Identifiers that the model leaves open: counted from 1 by deadline, on each bus."""
        taken = {(m.bus, m.leading) for m in self.messages if m.identifier is not None}
        free = [m for m in self.messages if m.identifier is None]
        for message in sorted(free, key=lambda m: m.deadline):
            if self.buses.map(message.bus).text("identifiers") == "audsley":
                continue
            place = 1
            while (message.bus, place) in taken:
                place += 1
            taken.add((message.bus, place))
            message.identifier = place << 18 if message.extended else place

    # --- tasks

    def _processors(self) -> list[Task]:
        found: list[Task] = []
        for name, form in self.model.section("processors").maps():
            homes = self._homes(form)
            for node in homes:
                task = self._processor(name, form, node, len(homes) > 1)
                if task.rows:
                    found.append(task)
        return found

    def _homes(self, form: Mapping) -> list[str]:
        """The nodes of a processor."""
        given = form.text("node")
        if given is not None:
            return [self.nodes.name(given) or given]
        owners = [text.rpartition(".")[0] for text in form.texts("activities")]
        own = next((o for o in owners if self.instances.name(o)), None)
        if own is not None:
            return [self.home(own)]
        if (bus := form.text("released_by")) is not None:
            bus = self.buses.name(bus) or bus
            return [node for node in self.nodes if self.heard(bus, node)]
        bus = self.buses.name(owners[0]) or owners[0]
        return [node for node in self.nodes if self.joins(bus, node)]

    def _processor(self, name: str, form: Mapping, node: str, several: bool) -> Task:
        rows: list[Row] = []
        ends: list[int] = []
        periods: list[int] = []
        for text in form.texts("activities"):
            row = self._row(text, form, node)
            owner, _, name_of = row.element.rpartition(".")
            mine = self.instances.name(owner) is not None
            watch = name_of == "watch" and not mine
            ends.append(row.deadline)
            if mine and name_of.lower() in self.equipment.idle(owner):
                continue
            row.wcet += self.equipment.time(owner, name_of) if mine else 0
            if mine or watch:
                periods.append(row.period)
            joining = [n for n in self.nodes if self.joins(owner, n)]
            if watch and not joining:
                continue
            if watch and len(joining) > 1:
                row.element += f"_{node}"
            hearing = [n for n in self.nodes if self.heard(owner, n)]
            if len(hearing) > 1 and name_of == "receive" and not mine:
                row.element += f"_{node}"
            rows.append(row)
        if not rows:
            return Task(name, node, 1, 1, 0)
        cyclic = form.text("schedule") == "table"
        shared = math.gcd if cyclic else min
        period = form.time("period") if form.text("period") else shared(*periods, periods[0])
        shortest = min(ends, default=period)
        lasting = form.time("logical_execution_time", 0)
        deadline = min(form.time("deadline", shortest), shortest, period, lasting or period)
        phases = form.map("phases")
        for row in rows:
            row.divisor = row.period // period
            given = phases.name(row.element)
            row.phase = phases.time(given or "", 0) // period
            row.is_open = cyclic and given is None
        by = form.text("released_by") or ""
        return Task(
            element=f"{name}_{node}" if several else name,
            node=node,
            period=period,
            deadline=deadline,
            wcet=sum(row.wcet for row in rows),
            priority=form.number("priority", 0),
            offset=form.time("offset", 0),
            rows=rows,
            bus=self.buses.name(by),
            port=self._releasing(by) if "." in by else None,
            core=form.number("core", 1),
            lasting=lasting,
        )

    def _releasing(self, end: str) -> str:
        """A queued port, an interface, or a region whose events release a processor."""
        owner, _, port = end.rpartition(".")
        if self._interrupt(end) is not None:
            return end
        parts = self.component_of(owner)
        if parts.map("provides").name(port) or parts.map("regions").name(port):
            return end
        ports = self.component_of(owner).map("ports")
        if ports.map(ports.name(port) or "").text("kind") != "queued":
            raise UnusableError(f"`{end}` is no queued port")
        return end

    def _interrupt(self, end: str) -> tuple[str, str, Mapping] | None:
        """Node, name and form of an interrupt; None for another end."""
        owner, _, name = end.rpartition(".")
        node = None if self.instances.name(owner) else self.nodes.name(owner)
        if node is None:
            return None
        lines = self.nodes.map(node).map("interrupts")
        own = lines.name(name) or name
        return node, own, lines.map(own)

    def _row(self, text: str, form: Mapping, node: str) -> Row:
        owner, _, name = text.rpartition(".")
        if not self.instances.name(owner):
            bus = self.buses.name(owner) or owner
            own = self.buses.map(bus)
            if name.lower() == "receive":
                period = form.time("period")
                deadline = form.time("deadline", period)
                macs = [message.mac for message, _ in self.heard(bus, node)]
                wcet = own.time("driver_wcet") + max(macs, default=0)
                return Row(f"{bus}.receive", period, wcet, deadline)
            watch = own.map("watch")
            return _timed(f"{bus}.watch", watch)
        component = self.component_of(owner)
        for handler, own in handlers_of(component):
            if handler.lower() == name.lower():
                return _timed(f"{self.instance(owner)}.{handler}", own)
        for section in ("regions", "activities"):
            rows = component.map(section)
            own_name = rows.name(name)
            if own_name is not None:
                row = _timed(f"{self.instance(owner)}.{own_name}", rows.map(own_name))
                return replace(row, wcet=row.wcet + self._macs(row.element))
        raise UnusableError(f"{form.file}:{form.line}: `{text}` is no row")

    def _macs(self, row: str) -> int:
        """The time for the MACs of all that a row sends."""
        return sum(
            message.mac
            for message in self.messages
            if message.mac
            and message.source is not None
            and row in (sender for sender, _ in self.rows_that_send(message.source))
        )

    def _prioritise(self) -> None:
        """Open priorities: the shorter the deadline, the more urgent; of two, the earlier."""
        taken = {task.priority for task in self.processors if task.priority}
        order = list(enumerate(self.processors))
        level = 0
        for _, task in sorted(order, key=lambda one: (-one[1].deadline, -one[0])):
            if task.priority:
                continue
            level += 1
            while level in taken:
                level += 1
            task.priority = level

    @property
    def top(self) -> int:
        """The highest priority of a processor; the drivers have one more."""
        return max((task.priority for task in self.processors), default=0)

    def _drivers(self) -> list[Task]:
        found: list[Task] = []
        for message in self.messages:
            ways: list[tuple[str, str, str]] = []
            if message.source is not None and message.node is not None:
                rows = self.rows_of(message)
                sender = next(
                    (t.element for t in self.processors for r in t.rows if r.element in rows), None
                )
                if sender is None:
                    raise UnusableError(f"no table has the row that sends {message.element}")
                ways.append((message.sending, message.node, sender))
            for node in self.receivers(message):
                driver = next(d for m, d in self.heard(message.bus, node) if m is message)
                ways.append((driver, node, message.element))
            wcet = self.buses.map(message.bus).time("driver_wcet")
            found += [
                Task(element, node, message.period, message.deadline, wcet, self.top + 1, after=by)
                for element, node, by in ways
            ]
        return found

    def _watchers(self) -> list[Task]:
        """The supervisor, the probe and the interrupts of each node."""
        above = self.top + (2 if any(m.source or m.targets for m in self.messages) else 1)
        found: list[Task] = []
        for name, node in self.nodes.maps():
            level = above
            for key, kind in (("supervision", "supervisor"), ("probe", "probe")):
                form = node.map(key)
                if form:
                    row = _timed("", form)
                    timing = row.period, row.deadline, row.wcet
                    found.append(Task(f"{name}.{kind}", name, *timing, level))
                    level += 1
            for task in self.processors:
                line = None if task.port is None else self._interrupt(task.port)
                if line is not None and line[0] == name:
                    times = task.period, task.period, line[2].time("wcet")
                    found.append(Task(f"{name}.{line[1]}", name, *times, level, port=task.port))
        return found

    def blocking(self, task: Task) -> int:
        """The longest section of a lower task, or of the main program, that may delay a task.

        One is always as long as a critical section. The main program, processors and supervisors
        share the count of faults. Drivers share a queue with the processors that they serve. A
        probe shares its result with the main program. On another core than the first, a task below
        all others shares the counts with all of them. Sections of devices may be longer.
        """
        least = self.nodes.map(task.node).time("critical_section")
        longest = least
        for device in self.equipment.devices:
            users = [
                one.priority
                for one in self.processors
                if one.place == task.place
                and any(
                    device in self.equipment.called(*row.element.rsplit(".", 1)) for row in one.rows
                )
            ]
            if not users:
                continue
            if self.equipment.begun(device):
                users.append(0)  # the main program; in its place a supervisor makes it safe
                if "make_safe" in self.equipment.kind(device):
                    element = f"{task.node}.supervisor"
                    users += [one.priority for one in self.tasks if one.element == element]
            if len(users) > 1 and min(users) < task.priority <= max(users):
                longest = max(longest, self.equipment.section(device, least))
        return longest

    def programs(self, generated: Path) -> list[tuple[Path, list[str]]]:
        """The folder of each program, with the instances in it."""
        if len(self.nodes) == 1:
            return [(generated, list(self.instances))]
        busy = dict.fromkeys(task.node for task in self.processors)
        return [
            (generated / node, [i for i in self.instances if self.home(i) == node])
            for node in self.nodes
            if node in busy
        ]


def _timed(element: str, form: Mapping) -> Row:
    period = form.time("period")
    return Row(element, period, form.time("wcet"), form.time("deadline", period))


def _sends(value: object, port: str) -> bool:
    """Whether an action below sends on a port."""
    if isinstance(value, Mapping):
        sent = value.get("send")
        if isinstance(sent, Text) and sent.lower() == port:
            return True
        return any(_sends(one, port) for one in value.values())
    return isinstance(value, list) and any(_sends(one, port) for one in value)
