# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Controllers as processes on the simulated buses of this machine: one server for each bus."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from itertools import cycle
from pathlib import Path

from ravenchart.building import stacks
from ravenchart.building.programs import TRACE_MAP, Program, to_standard_error
from ravenchart.building.targets import Board
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.system import System
from ravenchart.hw_can.bench.bus_records import NAME_LENGTH
from ravenchart.hw_can.bench.forms import Cut, Hold, Mend
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.hw_can.bench.scenario import Scenario, ScenarioError
from ravenchart.stacks.report import Memory

from . import bus_log, server
from .process import ControllerProcess


@dataclass(frozen=True, slots=True)
class Controller:
    """The program of a node, and the map of its trace."""

    node: str
    executable: Path
    trace_json: Path
    memory: Memory | None = None
    """Its stacks and memory."""


def controller(
    made: Program,
    warn: Callable[[str], None] = to_standard_error,
    board: Board | None = None,
    mode: str = "checks",
    tell: Callable[[str], None] = lambda _: None,
) -> Controller:
    """A program built, to be run. ToolFailed with the compiler's words."""
    executable = made.build(mode, warn=warn, board=board, tell=tell)
    return Controller(made.node, executable, made.generated / TRACE_MAP, stacks.kept(executable))


def joins_a_server(system: System, programs: int) -> bool:
    """Do that many programs of the system run on bus servers?"""
    return max(programs, len(system.buses)) > 1 or any(one.by_priority for one in system.buses)


@contextmanager
def bus_servers(
    system: System, controllers: Sequence[Controller], plan: Scenario | None, log: Path | None
) -> Iterator[dict[str, str]]:
    """A server for each bus, for the time of a block; the channel of each, by bus.

    Raises as `bus_words` before one is started.
    """
    names = [bus.name for bus in system.buses]
    words = {bus.name: bus_words(system, bus, controllers, plan) for bus in system.buses}
    channels: dict[str, str] = {}
    with ExitStack() as stack:
        for bus in names:
            made = server.running(
                "port=0",
                *words[bus],
                log=bus_log.log_of(log, bus, names),
                beside=controllers[0].executable,
                bus=bus if len(names) > 1 else "",
            )
            _, channels[bus] = stack.enter_context(made)
        yield channels


def joining(
    system: System,
    controllers: Sequence[Controller],
    traces: Sequence[Path],
    channels: Mapping[str, str],
    cores: Sequence[int],
) -> Iterator[tuple[ControllerProcess, int]]:
    """Start one process after the other, to join its buses; how many these are. StartError."""
    for one, trace, core in zip(controllers, traces, cycle(cores), strict=False):
        told = {"RAVENCHART_BUS_NAME": one.node[:NAME_LENGTH]}
        for bus, channel in channels.items():
            told[f"RAVENCHART_BUS_PORT_{bus.upper()}"] = channel.rpartition(":")[2]
        joined = sum(system.joins(bus, one.node) for bus in channels)
        yield ControllerProcess(one.executable, trace, core, **told), joined


def bus_words(
    system: System, line: Bus, controllers: Sequence[Controller], plan: Scenario | None
) -> list[str]:
    """The settings of the server of a bus: its bit rates, and the events on it with their times.

    Raises BenchError for a rate that the server cannot have, and ScenarioError where the scenario
    cuts off a node that is not on the bus.
    """
    data_rate = (line.data_rate or line.bit_rate) if line.takes_fd else 0
    for rate in (line.bit_rate, data_rate):
        if rate and server.SECOND % rate:
            raise BenchError(f"error: {line.name}: {server.uneven(rate)}")
    words = [f"bitrate={line.bit_rate}", f"data_bitrate={data_rate}"]
    if line.by_priority:
        words.append("buffer=priority")
    here = [one.node for one in controllers if system.joins(line.name, one.node)]
    numbers = {node.lower(): n for n, node in enumerate(here, 1)}
    for event in plan.bus_events if plan else ():
        if event.on is not None and event.on.lower() != line.name.lower():
            continue
        at = round(event.at * 1e9)
        if isinstance(event, Mend):
            words.append(f"event={at}:mend")
        elif isinstance(event, Hold):
            words.append(f"event={at}:hold_{event.hold}")
        elif not isinstance(event, Cut):
            words.append(f"event={at}:let_go")
        elif numbers.get(event.cut.lower(), 1) > 1:
            words.append(f"event={at}:cut:{numbers[event.cut.lower()]}")
        else:
            known = ", ".join(here[1:])
            raise ScenarioError(f"error: bus: cut takes one of {known}, not {event.cut}")
    return words
