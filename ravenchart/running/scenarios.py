# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A scenario compared with its model, before anything is built.

Messages and fields are those of the bus's CAN database, which the bench uses; regions, states and
ports are those of the model.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from cantools.database.can import Message as DbcMessage
from cantools.database.can import Signal as DbcSignal

from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.emit.tables.trace_map import CONTROLLER_STATES, elements
from ravenchart.gen.files.located import FormPath
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System
from ravenchart.hw_can.bench.drives import FEEDBACK_FIELDS, SET_POINT_FIELDS
from ravenchart.hw_can.bench.forms import BusEvent, Cut, Expected, Lost, Missed, Overran, TraceCheck
from ravenchart.hw_can.bench.peer import BenchError, Value
from ravenchart.hw_can.bench.reading import MISFIT, UNKNOWN, Source, rendered
from ravenchart.hw_can.bench.replay import from_outside, log_for
from ravenchart.hw_can.bench.scenario import Scenario, ScenarioError, load_scenario
from ravenchart.hw_can.bench.steps import Replay, SendStep, WaitFor

from .controllers import joins_a_server
from .scenario_plants import check_plants
from .vocabulary import BusVocabulary

LOSSES = ("lost_out", "lost_in", "rejected_lines")
"""The losses that the controller of a bus counts."""
VALUE = "RV-1305"
"""A value that the field of a message does not have."""


def checked(path: Path, system: System, buses: Sequence[str] | None = None) -> Scenario:
    """The scenario in a file; Refused with everything that does not fit it or the model.

    ``buses`` are those that have an interface; without them all are simulated, so that events on
    them can be had.
    """
    try:
        scenario = load_scenario(path)
    except ScenarioError as fault:
        raise Refused(str(fault)) from None
    source = scenario.source
    assert source is not None
    found = problems(scenario, system, buses)
    if scenario.bus_events and buses is not None and not found:
        told = "`bus` is for the simulated bus, not for one at `--interface`"
        source.wrong(MISFIT, ("bus",), told, "remove `bus`, or run it without", key=True)
        found = source.found
    if found:
        raise Refused(rendered(found, source.file, source.text), found)
    return scenario


def problems(
    scenario: Scenario, system: System, buses: Sequence[str] | None = None
) -> list[Diagnostic]:
    """Errors of a scenario: names that the model does not have, and values that do not fit."""
    source = scenario.source
    assert source is not None
    if not system.buses:
        message = f"{system.name} has no bus for a scenario to play on"
        return [error(UNKNOWN, source.tree.origin, message, hint="run it without `--scenario`")]
    there = [bus for bus in system.buses if buses is None or bus.name in buses]
    check = _Check(source, system, BusVocabulary.of(system, there))
    check.drives(scenario)
    check_plants(scenario, source, check.signal, tuple(check.vocabulary.outside()))
    for index, step in enumerate(scenario.steps):
        if isinstance(step, SendStep):
            check.send(step, ("steps", index))
        elif isinstance(step, WaitFor):
            check.wait_for(step, ("steps", index))
        elif isinstance(step, Replay):
            check.replay(step, scenario, ("steps", index, "replay"))
    for index, one in enumerate(scenario.trace_checks):
        check.trace(one, ("expect_trace", index))
    check.bus(scenario)
    for index, fault in enumerate(scenario.expected):
        check.expected(fault, ("expect", index))
    return source.found


class _Check:
    """Checks the names and values of a scenario; errors go to its source."""

    def __init__(self, source: Source, system: System, vocabulary: BusVocabulary) -> None:
        self.source = source
        self.system = system
        self.vocabulary = vocabulary
        self.messages = vocabulary.messages
        self.codec = vocabulary.codec

    # --- messages

    def drives(self, scenario: Scenario) -> None:
        """Messages and fields of the drives, and what their plots show."""
        for name, drive in scenario.drives.items():
            path = ("drives", name)
            for key, text, wanted in (
                ("set_point", drive.set_point, SET_POINT_FIELDS),
                ("feedback", drive.feedback, FEEDBACK_FIELDS),
            ):
                message = self.message(text, (*path, key))
                fields = {signal.name for signal in message.signals} if message else set(wanted)
                missing = [one for one in wanted if one not in fields]
                if missing:
                    told = f"{text} has no field `{missing[0]}`, which a simulated drive needs"
                    hint = f"the fields of a `{key}` are {', '.join(wanted)}"
                    self.source.wrong(UNKNOWN, (*path, key), told, hint)
            if drive.target is not None:
                self.signal(drive.target, (*path, "target"))
            if drive.states is not None:
                self.region(drive.states, (*path, "states"))

    def send(self, step: SendStep, path: FormPath) -> None:
        """A message with all of its fields, each with a value that it has."""
        message = self.message(step.send, (*path, "send"))
        if message is None:
            return
        before = len(self.source.found)
        for name, value in step.fields.items():
            signal = self.field(message, name, (*path, "with", name), key=True)
            if signal is not None:
                self.value(message, signal, value, (*path, "with", name))
        if len(self.source.found) == before:
            try:
                self.codec.encode(step.send, step.fields)
            except BenchError as fault:  # a field that is missing, or of another page
                hint = f"the fields are {_names(message.signals)}"
                self.source.wrong(VALUE, (*path, "with"), str(fault), hint)

    def replay(self, step: Replay, scenario: Scenario, path: FormPath) -> None:
        """A log with a frame that the bench can send."""
        drives = scenario.simulated()
        if not from_outside(log_for(scenario.file_of(step), self.codec), self.codec, drives):
            told = f"no frame of {step.replay} is a message that comes from outside the model"
            outside = self.vocabulary.outside()
            names = ", ".join(name for name in outside if name not in drives) or "none"
            self.source.wrong(MISFIT, path, told, f"the messages from outside: {names}")

    def wait_for(self, step: WaitFor, path: FormPath) -> None:
        """A field, and a value that it can have."""
        found = self.signal(step.wait_for, (*path, "wait_for"))
        if found is not None:
            self.value(*found, step.value, (*path, "is"), by_name=True)

    def signal(self, text: str, path: FormPath) -> tuple[DbcMessage, DbcSignal] | None:
        """The message and the field of ``message.field``."""
        owner, _, name = text.partition(".")
        message = self.message(owner, path)
        signal = None if message is None else self.field(message, name, path)
        return None if message is None or signal is None else (message, signal)

    def message(self, name: str, path: FormPath) -> DbcMessage | None:
        """A message of the bus."""
        if name not in self.messages:
            told = f"there is no message `{name}` on {self.vocabulary.where}"
            hint = f"the messages are {', '.join(self.messages)}"
            away = next((m.bus for m in self.system.messages if m.name == name), None)
            if away is not None:
                told = f"`{name}` is on {away}, which has no channel"
                hint = f"add `--channel {away}=...`"
            self.source.wrong(UNKNOWN, path, told, hint)
        return self.messages.get(name)

    def field(
        self, message: DbcMessage, name: str, path: FormPath, *, key: bool = False
    ) -> DbcSignal | None:
        """A field of a message."""
        for signal in message.signals:
            if signal.name == name:
                return signal
        told = f"{message.name} has no field `{name}`"
        self.source.wrong(UNKNOWN, path, told, f"the fields are {_names(message.signals)}", key=key)
        return None

    def value(
        self,
        message: DbcMessage,
        signal: DbcSignal,
        value: Value,
        path: FormPath,
        *,
        by_name: bool = False,
    ) -> None:
        """A value that the field has."""
        told = self.vocabulary.misfit(message.name, signal, value, by_name=by_name)
        if told is not None:
            self.source.wrong(VALUE, path, told)

    # --- regions, states, ports, nodes

    def trace(self, check: TraceCheck, path: FormPath) -> None:
        """A region or a controller with its states, and the ports that times count from."""
        controllers = {one.element for one in elements(self.system) if one.kind == "bus"}
        if check.region in controllers:
            for key, state in (("reaches", check.reaches), ("then", check.then)):
                if state is not None and state not in CONTROLLER_STATES:
                    told = f"the controller of {check.region} has no state `{state}`"
                    hint = f"name one of {', '.join(CONTROLLER_STATES)}"
                    self.source.wrong(UNKNOWN, (*path, key), told, hint)
        else:
            region = self.region(check.region, (*path, "region"))
            for key, state in (("reaches", check.reaches), ("then", check.then)):
                if region is not None and state is not None:
                    self.state(region, check.region, state, (*path, key))
        for key, port in (
            ("after_last", check.after_last),
            ("after_silence", check.after_silence),
        ):
            if port is not None:
                self.port(port, (*path, key))

    def state(self, region: Region, shown: str, name: str, path: FormPath) -> None:
        """A state that a trace can show: one without states inside."""
        leaves = [state.name for state in region.states if state.is_leaf]
        if name not in leaves:
            known = any(state.name == name for state in region.states)
            told = f"{shown} has no state `{name}`"
            told = f"`{name}` has states inside; a trace records those" if known else told
            self.source.wrong(UNKNOWN, path, told, f"name one of {', '.join(leaves)}")

    def region(self, text: str, path: FormPath) -> Region | None:
        """The region ``instance.region``."""
        found = self.owner(text, path)
        if found is None:
            return None
        instance, name = found
        for region in instance.component.regions:
            if region.name == name:
                return region
        regions = ", ".join(region.name for region in instance.component.regions) or "none"
        told = f"{instance.name} has no region `{name}`"
        self.source.wrong(UNKNOWN, path, told, f"its regions: {regions}")
        return None

    def port(self, text: str, path: FormPath) -> None:
        """An input port, ``instance.port``."""
        found = self.owner(text, path)
        if found is None:
            return
        instance, name = found
        ports = [port.name for port in instance.component.inputs()]
        if name not in ports:
            told = f"{instance.name} has no input port `{name}`"
            self.source.wrong(UNKNOWN, path, told, f"its input ports: {', '.join(ports) or 'none'}")

    def owner(self, text: str, path: FormPath) -> tuple[Instance, str] | None:
        """The instance of ``instance.name``, and the name."""
        owner, _, name = text.rpartition(".")
        for instance in self.system.instances:
            if instance.name == owner:
                return instance, name
        hint = f"the instances are {', '.join(one.name for one in self.system.instances)}"
        self.source.wrong(UNKNOWN, path, f"there is no instance `{owner}`", hint)
        return None

    def bus(self, scenario: Scenario) -> None:
        """Buses that there are, and nodes that can be cut off: all but the first on a bus."""
        if scenario.bus_events and not joins_a_server(self.system, len(self.system.nodes)):
            told = f"`bus` is for a system with several nodes, and {self.system.name} has one"
            self.source.wrong(MISFIT, ("bus",), told, "remove `bus`", key=True)
            return
        for index, event in enumerate(scenario.bus_events):
            bus = self._bus_of(event, index)
            if not bus or not isinstance(event, Cut):
                continue
            homes = self.system.joining(bus)
            if event.cut.lower() not in map(str.lower, homes[1:]):
                told = f"`{event.cut}` cannot be cut off"
                hint = f"{bus} has one node"
                if homes[1:]:
                    hint = f"name one of {', '.join(homes[1:])}: it and those behind it are cut off"
                self.source.wrong(UNKNOWN, ("bus", index, "cut"), told, hint)

    def _bus_of(self, event: BusEvent, index: int) -> str:
        """The bus of an event; empty where it names none of several, or one that is not there."""
        buses = {bus.name.lower(): bus.name for bus in self.system.buses}
        known = " or ".join(f"`on: {name}`" for name in buses.values())
        if event.on is None and len(buses) > 1:
            told = f"{self.system.name} has {len(buses)} buses, and the event names none"
            self.source.wrong(MISFIT, ("bus", index), told, f"add {known}")
            return ""
        name = buses.get((event.on or next(iter(buses))).lower(), "")
        if not name:
            told = f"there is no bus `{event.on}`"
            self.source.wrong(UNKNOWN, ("bus", index, "on"), told, f"write {known}")
        return name

    def expected(self, fault: Expected, path: FormPath) -> None:
        """A fault of something that the model has, once."""
        kinds: dict[type[Expected], tuple[str, str, list[str]]] = {
            Lost: ("lost", "counts of losses", self.losses()),
            Missed: ("missed", "processors", [one.name for one in self.system.processors]),
            Overran: (
                "overran",
                "rows",
                [slot.element for one in self.system.processors for slot in one.slots],
            ),
        }
        if type(fault) not in kinds:
            return
        key, kind, names = kinds[type(fault)]
        if fault.name.lower() not in map(str.lower, names):
            told = f"there is no `{fault.name}` among the {kind}"
            self.source.wrong(UNKNOWN, (*path, key), told, f"one of {', '.join(names)}")

    def losses(self) -> list[str]:
        """The names of what a run may lose."""
        nodes = [node.name for node in self.system.nodes]
        named = joins_a_server(self.system, len(nodes))
        return [
            f"{f'{node}.' if named else ''}{bus.name}.{count}"
            for node in nodes
            for bus in self.system.buses
            if self.system.joins(bus.name, node)
            for count in LOSSES
        ]


def _names(signals: Iterable[DbcSignal]) -> str:
    return ", ".join(signal.name for signal in signals)
