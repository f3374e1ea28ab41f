# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""MAST models (1.7), for `mast_analysis holistic`. The unit of time is the nanosecond.

Features that MAST does not have are replaced so that its bounds are no smaller. A table of
rows becomes their sum. A frame counts in time rather than bits. A frame of a first-in
first-out queue has jitter. MAST's rule for CAN has no additional bit
in which a frame still takes part in arbitration, so its bounds can be a frame smaller there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ravenchart.analysis.core.blocking import Section, ceilings
from ravenchart.analysis.core.bus import Frame
from ravenchart.analysis.core.chains import TimedChain
from ravenchart.analysis.core.fixed_priority import NO_OVERHEAD
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.responses import release_time, switch_time
from ravenchart.analysis.core.tasks import Task

from .mast_text import Attributes, MastObject, Value, printed_model
from .shapes import (
    ReleaseTree,
    background,
    dense,
    last_bit,
    names,
    need_exact_times,
    no_errors,
    no_given_blocking,
    of_one_epoch,
    remarks,
    spelled_out,
    trees,
    unqueued,
    urgency,
)

INTERRUPT = 32_767
"""The priority of the work that makes jobs ready: above those of all tasks."""

NAMES = ("Activity_Operation", "Activity_Server", "Composite_Operation_List", "Host",
         "Input_Event", "Model_Name", "Name", "Output_Event", "Output_Events_List",
         "Referenced_Event", "Scheduler", "Shared_Resources_List")  # fmt: skip
"""Attributes whose values are names: in quotes, for MAST has keywords by the hundred."""


def export(network: Network, chains: Sequence[TimedChain], title: str) -> str:
    """The model of ``network``; MAST does not analyse ``chains`` that sample."""
    need_exact_times(network)
    no_errors(network, "MAST")
    no_given_blocking(network, "MAST")
    head = ["Times in ns.", *remarks(network, chains), *last_bit(network, "MAST")]
    network = background(unqueued(of_one_epoch(network)))
    if _linked_releases(network):
        network = spelled_out(network)
    writer = _Writer(network)
    name = names([title])[title]
    model = MastObject(
        "Model",
        _attributes(Model_Name=name, Model_Date="2000-01-01", System_PiP_Behaviour="Strict"),
    )
    comments = "".join(f"-- {line}\n" for line in head)
    return f"{comments}\n" + printed_model((model, *writer.objects()))


def _linked_releases(network: Network) -> bool:
    """A release takes time, and is no event of its own: a tick or another task makes it."""
    return any(
        task.core in network.platforms
        and network.platforms[task.core].release > 0
        and (task.name in network.released_by or task.timed)
        for task in network.tasks
    )


def _quoted(value: Value) -> Value:
    """A name, or each of several, in quotes."""
    return tuple(map(_quoted, value)) if isinstance(value, tuple) else f'"{value}"'


def _attributes(**pairs: Value | int | None) -> Attributes:
    """Attributes in the order given; integers become reals, and None is left out."""
    found: list[tuple[str, Value]] = []
    for key, value in pairs.items():
        if value is None:
            continue
        text = f"{value}.0" if isinstance(value, int) else value
        found.append((key, _quoted(text) if key in NAMES else text))
    return Attributes(tuple(found))


class _Writer:
    """One network, with the names and priorities that it has in MAST."""

    def __init__(self, network: Network) -> None:
        self.network = network
        items = network.items()
        self.trees = trees(network, "MAST")
        self.cores = list(dict.fromkeys(task.core for task in network.tasks))
        self.item = names(items)
        self.place = names([*self.cores, *network.buses])
        self.resource = names([section.resource for section in network.sections])
        self.ceilings = ceilings(network.tasks, network.sections, network.ceilings)
        self.levels = {core: self._levels(core) for core in self.cores}

    def _levels(self, core: str) -> dict[int, int]:
        """The priorities of a core, from 1 up, its ceilings among them."""
        users = {task.name: task for task in self.network.tasks if task.core == core}
        reached = [self.ceilings[s.resource] for s in self.network.sections if s.user in users]
        return dense([task.priority for task in users.values()] + reached)

    def objects(self) -> Iterator[MastObject]:
        """All objects but the model itself, in the usual order."""
        yield from self._resources()
        yield from self._schedulers()
        yield from self._servers()
        seen = dict.fromkeys(section.resource for section in self.network.sections)
        cores = {task.name: task.core for task in self.network.tasks}
        for resource in seen:
            user = next(s.user for s in self.network.sections if s.resource == resource)
            ceiling = self.levels[cores[user]][self.ceilings[resource]]
            yield MastObject(
                "Shared_Resource",
                _attributes(
                    Type="Immediate_Ceiling_Resource",
                    Name=self.resource[resource],
                    Ceiling=str(ceiling),
                    Preassigned="YES",
                ),
            )
        yield from self._operations()
        for tree in self.trees:
            yield self._transaction(tree)
        yield from self._releases()

    def _resources(self) -> Iterator[MastObject]:
        for core in self.cores:
            platform = self.network.platforms.get(core)
            timer = None
            if platform is not None and platform.tick_period:
                timer = _attributes(
                    Type="Ticker", Worst_Overhead=platform.tick_wcet, Period=platform.tick_period
                )
            yield MastObject(
                "Processing_Resource",
                _attributes(
                    Type="Regular_Processor",
                    Name=self.place[core],
                    Max_Interrupt_Priority=str(INTERRUPT),
                    Min_Interrupt_Priority=str(INTERRUPT),
                    System_Timer=timer,
                ),
            )
        for bus, frames in self.network.frames.items():
            yield MastObject(
                "Processing_Resource",
                _attributes(
                    Type="Packet_Based_Network",
                    Name=self.place[bus],
                    Transmission="Half_Duplex",
                    Throughput=1,
                    Max_Blocking=self.network.buses[bus].unknown,
                    Max_Packet_Size=max(frame.transmission_time for frame in frames),
                    Min_Packet_Size=min(frame.transmission_time for frame in frames),
                ),
            )

    def _schedulers(self) -> Iterator[MastObject]:
        for core in self.cores:
            platform = self.network.platforms.get(core)
            policy = _attributes(
                Type="Fixed_Priority",
                Worst_Context_Switch=platform.context_switch if platform else 0,
                Max_Priority=str(INTERRUPT - 1),
                Min_Priority="1",
            )
            yield self._scheduler(core, policy)
        for bus, frames in self.network.frames.items():
            policy = _attributes(
                Type="FP_Packet_Based",
                Packet_Overhead_Max_Size=0,
                Packet_Overhead_Avg_Size=0,
                Packet_Overhead_Min_Size=0,
                Max_Priority=str(max(2, len(frames))),
                Min_Priority="1",
            )
            yield self._scheduler(bus, policy)

    def _scheduler(self, place: str, policy: Attributes) -> MastObject:
        name = self.place[place]
        return MastObject(
            "Scheduler",
            _attributes(
                Type="Primary_Scheduler", Name=f"{name}_scheduler", Host=name, Policy=policy
            ),
        )

    def _servers(self) -> Iterator[MastObject]:
        for task in self.network.tasks:
            level = self.levels[task.core][task.priority]
            yield self._server(self.item[task.name], task.core, "Fixed_Priority_Policy", level)
            if self._release(task):
                name = f"{self.item[task.name]}_release"
                yield self._server(name, task.core, "Interrupt_FP_Policy", INTERRUPT)
        for bus, frames in self.network.frames.items():
            levels = urgency(frames)
            for frame in frames:
                name = self.item[frame.name]
                yield self._server(name, bus, "Non_Preemptible_FP_Policy", levels[frame.name])

    def _server(self, name: str, place: str, policy: str, level: int) -> MastObject:
        parameters = _attributes(Type=policy, The_Priority=str(level), Preassigned="YES")
        return MastObject(
            "Scheduling_Server",
            _attributes(
                Type="Regular",
                Name=f"{name}_server",
                Server_Sched_Parameters=parameters,
                Scheduler=f"{self.place[place]}_scheduler",
            ),
        )

    def _operations(self) -> Iterator[MastObject]:
        for task in self.network.tasks:
            name = self.item[task.name]
            sections = [s for s in self.network.sections if s.user == task.name]
            parts = []
            for number, section in enumerate(sections, 1):
                parts.append(f"{name}_section_{number}")
                yield self._section(parts[-1], section)
            yield MastObject(
                "Operation",
                _attributes(
                    Type="Enclosing" if parts else "Simple",
                    Name=f"{name}_job",
                    Worst_Case_Execution_Time=task.plain_wcet + self._further(task),
                    Best_Case_Execution_Time=task.best or None,
                    Composite_Operation_List=tuple(parts) or None,
                ),
            )
            if wcet := self._release(task):
                yield MastObject(
                    "Operation",
                    _attributes(
                        Type="Simple", Name=f"{name}_release_job", Worst_Case_Execution_Time=wcet
                    ),
                )
        for frames in self.network.frames.values():
            for frame in frames:
                yield MastObject(
                    "Operation",
                    _attributes(
                        Type="Message_Transmission",
                        Name=f"{self.item[frame.name]}_job",
                        Max_Message_Size=frame.transmission_time,
                        Avg_Message_Size=frame.transmission_time,
                        Min_Message_Size=self.network.least()[frame.name],
                    ),
                )

    def _section(self, name: str, section: Section) -> MastObject:
        return MastObject(
            "Operation",
            _attributes(
                Type="Simple",
                Name=name,
                Worst_Case_Execution_Time=section.length,
                Shared_Resources_List=(self.resource[section.resource],),
            ),
        )

    def _further(self, task: Task) -> int:
        """The switches of a job that suspends itself more often than MAST counts: once."""
        platform = self.network.platforms.get(task.core, NO_OVERHEAD)
        return switch_time(task, platform) - switch_time(replace(task, suspensions=1), platform)

    def _release(self, task: Task) -> int:
        """The time to make a job of the task ready; the task needs an event for it."""
        platform = self.network.platforms.get(task.core)
        return release_time(task, platform) if platform else 0

    def _transaction(self, tree: ReleaseTree) -> MastObject:
        """The steps that one event releases; every step has its deadline from the event."""
        root = self.item[tree.item.name]
        internal, handlers = [], []
        inputs = {tree.item.name: f"{root}_event"}
        for one in tree.walk():
            name = self.item[one.item.name]
            deadline = _attributes(
                Type="Hard_Global_Deadline",
                Deadline=one.item.deadline,
                Referenced_Event=f"{root}_event",
            )
            done = f"{name}_done"
            internal.append(_attributes(Type="Regular", Name=done, Timing_Requirements=deadline))
            handlers.append(
                _attributes(
                    Type=self._activity(one.item),
                    Input_Event=inputs[one.item.name],
                    Output_Event=done,
                    Activity_Operation=f"{name}_job",
                    Activity_Server=f"{name}_server",
                )
            )
            after = [follower.item.name for follower in one.followers]
            inputs |= dict.fromkeys(after, done)
            if len(after) > 1:
                inputs |= {follower: f"{self.item[follower]}_begin" for follower in after}
                events = tuple(inputs[follower] for follower in after)
                internal += [_attributes(Type="Regular", Name=event) for event in events]
                handlers.append(
                    _attributes(Type="Multicast", Input_Event=done, Output_Events_List=events)
                )
        return MastObject(
            "Transaction",
            _attributes(
                Type="Regular",
                Name=f"{root}_transaction",
                External_Events=(self._event(tree.item, f"{root}_event"),),
                Internal_Events=tuple(internal),
                Event_Handlers=tuple(handlers),
            ),
        )

    def _activity(self, item: Task | Frame) -> str:
        if isinstance(item, Task) and item.timed:
            platform = self.network.platforms.get(item.core)
            if platform is not None and platform.tick_period:
                return "System_Timed_Activity"
        return "Activity"

    def _event(self, item: Task | Frame, name: str) -> Attributes:
        if item.sporadic and not item.jitter:
            return _attributes(Type="Sporadic", Name=name, Min_Interarrival=item.period)
        phase = item.offset if isinstance(item, Task) else None
        return _attributes(
            Type="Periodic",
            Name=name,
            Period=item.period,
            Max_Jitter=item.jitter,
            Phase=phase or None,
        )

    def _releases(self) -> Iterator[MastObject]:
        """For each task whose releases take time, that work as a transaction of its own."""
        for task in self.network.tasks:
            if self._release(task):
                name = f"{self.item[task.name]}_release"
                handler = _attributes(
                    Type="Activity",
                    Input_Event=f"{name}_event",
                    Output_Event=f"{name}_done",
                    Activity_Operation=f"{name}_job",
                    Activity_Server=f"{name}_server",
                )
                yield MastObject(
                    "Transaction",
                    _attributes(
                        Type="Regular",
                        Name=f"{name}_transaction",
                        External_Events=(self._event(task, f"{name}_event"),),
                        Internal_Events=(_attributes(Type="Regular", Name=f"{name}_done"),),
                        Event_Handlers=(handler,),
                    ),
                )
