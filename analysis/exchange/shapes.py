# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Shared parts of the exports: names for every tool, dense priorities, trees of releases."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.bus import Frame
from ravenchart.analysis.core.chains import TimedChain
from ravenchart.analysis.core.fixed_priority import NO_OVERHEAD
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.responses import release_time, switch_time
from ravenchart.analysis.core.tasks import Task

HOUR = 3600 * 10**9
"""The period of a job that hardly ever comes, in ns."""

EXACT = 2**53
"""Tools that calculate in doubles hold integers up to here."""


Item = TypeVar("Item", Task, Frame)


class Unfit(Exception):  # noqa: N818
    """The format cannot express the system; the text names the element and the reason."""


def names(given: Iterable[str], taken: Iterable[str] = ()) -> dict[str, str]:
    """A distinct name of letters, digits and underscores for each given one."""
    found: dict[str, str] = {}
    used = {name.lower() for name in taken}
    for name in dict.fromkeys(given):
        plain = re.sub(r"[^A-Za-z0-9_]+", "_", name).strip("_") or "core"
        if not plain[0].isalpha():
            plain = f"n_{plain}"
        plain = re.sub("__+", "_", plain)
        free, number = plain, 1
        while free.lower() in used:
            number += 1
            free = f"{plain}_{number}"
        used.add(free.lower())
        found[name] = free
    return found


def dense(levels: Iterable[int]) -> dict[int, int]:
    """The same order by the numbers from 1 up."""
    return {level: number for number, level in enumerate(sorted(set(levels)), 1)}


def need_exact_times(network: Network) -> None:
    """Refuse times that a double cannot hold."""
    for name, item in network.items().items():
        longest = item.plain_wcet if isinstance(item, Task) else item.transmission_time
        largest = max(item.period, item.deadline, item.jitter, longest)
        if largest >= EXACT:
            raise Unfit(f"the times of {name} must be below 2**53 ns, which is 104 days")


def no_errors(network: Network, tool: str) -> None:
    """Refuse errors on a bus, which only this analysis has."""
    for bus in network.frames:
        if network.buses[bus].errors is not None:
            raise Unfit(f"{tool} has no errors on a bus: leave out those of bus {bus}")


def no_given_blocking(network: Network, tool: str) -> None:
    """Refuse a blocking that is given as a number."""
    for task in network.tasks:
        if task.held:
            raise Unfit(f"{tool} computes blocking itself: give sections for task {task.name}")


def of_one_epoch(network: Network) -> Network:
    """The same without the offsets of cores that have several epochs: no bound is smaller."""
    several = _of_several_epochs(network)
    tasks = (t.at_any_time() if t.core in several else t for t in network.tasks)
    return replace(network, tasks=tuple(tasks))


def _of_several_epochs(network: Network) -> set[str]:
    """The cores with offsets from more than one epoch."""
    found: dict[str, set[str]] = {}
    for task in network.tasks:
        if task.offset is not None:
            found.setdefault(task.core, set()).add(task.epoch)
    return {core for core, epochs in found.items() if len(epochs) > 1}


def unqueued(network: Network) -> Network:
    """The same without first-in first-out queues, with bounds that are no smaller.

    A queue of one frame is none. Any other frame of a queue is no longer released by its
    sender. It has its inherited jitter, and the longest wait in its queue as further
    jitter. To others it is as late as before; for itself it waits for the frames of its
    queue once more.
    """
    cut = set(in_queues(network))
    if not cut:
        return _changed(network, lambda item: replace(item, queue=""), lambda item: item)
    found = holistic.analyse(network)

    def alone(frame: Frame) -> Frame:
        if frame.name not in cut:
            return replace(sooner(frame), queue="")
        bound = found.responses[frame.name].bound
        if bound is None:
            raise Unfit(f"{frame.name} has no bound in its queue, so there is none to export")
        return replace(sooner(frame), queue="", jitter=bound - frame.transmission_time)

    def sooner(item: Item) -> Item:
        """Its deadline from where the way to it was cut, which is later by the best case."""
        way = (item.name, *network.releasers(item.name))
        deadline = item.deadline - next((found.best[name] for name in way if name in cut), 0)
        if deadline <= 0:
            raise Unfit(f"the deadline of {item.name} must be above the best case of its chain")
        return replace(item, deadline=deadline)

    released = {name: by for name, by in network.released_by.items() if name not in cut}
    return replace(_changed(network, alone, sooner), released_by=released)


def _changed(
    network: Network, frame: Callable[[Frame], Frame], task: Callable[[Task], Task]
) -> Network:
    """The network with each frame and task changed."""
    return replace(
        network,
        tasks=tuple(map(task, network.tasks)),
        frames={bus: tuple(map(frame, frames)) for bus, frames in network.frames.items()},
    )


def in_queues(network: Network) -> list[str]:
    """The frames that share a first-in first-out queue with others."""
    found = []
    for frames in network.frames.values():
        counts = Counter(frame.queue for frame in frames if frame.queue)
        found += [frame.name for frame in frames if counts[frame.queue] > 1]
    return found


def background(network: Network) -> Network:
    """Users of resources that are no tasks as tasks below all, which come once an hour.

    There is one on each core that they can block. Other tasks wait for them only while they
    are inside a section.
    """
    cores = {task.name: task.core for task in network.tasks}
    home = {s.resource: cores[s.user] for s in network.sections if s.user in cores}
    lowest = min((task.priority for task in network.tasks), default=0) - 1
    tasks: dict[str, Task] = {}
    sections = []
    for section in network.sections:
        if section.user not in cores:
            core = home.get(section.resource)
            if core is None:
                raise Unfit(f"no task uses {section.resource}: leave it out")
            name = f"{section.user} on {core}" if core else section.user
            held = tasks.get(name)
            wcet = section.length + (held.wcet if held else 0)
            tasks[name] = Task(name, lowest, HOUR, HOUR, wcet, core=core, sporadic=True)
            section = replace(section, user=name)
        sections.append(section)
    return replace(network, tasks=(*network.tasks, *tasks.values()), sections=tuple(sections))


def remarks(network: Network, chains: Iterable[TimedChain]) -> Iterator[str]:
    """Notes on the differences of an export from the system: lines for its head."""
    for task in network.tasks:
        if task.frame_count > 1:
            yield f"Of table {task.name} every row counts in every job."
    if any(task.offset for task in of_one_epoch(network).tasks):
        yield "Offsets: bounds that make no use of them hold for any."
    for core in sorted(_of_several_epochs(network)):
        yield f"Left out: offsets on {core or 'the core'}, which count from several epochs."
    for name in in_queues(network):
        yield f"{name} shares a first-in first-out queue: its turn there is jitter."
    for chain in chains:
        yield f"Left out: chain {chain.name}, through {', '.join(s.name for s in chain.steps)}."


def seldom(network: Network) -> Iterator[str]:
    """Notes on sporadic items, for a format that has no word for them: responses are the same."""
    for name, item in network.items().items():
        if item.sporadic and name not in network.released_by:
            yield f"{name} is sporadic: its period is the least distance."


def last_bit(network: Network, tool: str) -> Iterator[str]:
    """A note on the frames that ``tool`` does not count on a bus: lines for its export's head.

    A frame that is queued before the arbitration is over still takes part in it (Davis, Burns,
    Bril and Lukkien 2007, equation 7), which neither MAST 1.7 nor pyCPA 1.2 counts.
    """
    if any(network.frames.values()):
        yield f"{tool} counts no frame that is queued in the last bit before a transmission:"
        yield "its bounds on a bus can be a frame smaller."


def spelled_out(network: Network) -> Network:
    """The same bounds without platforms: overheads as WCET, jitter and tasks above all others.

    A table of rows becomes its sum, which can only make bounds larger.
    """
    tasks: list[Task] = []
    released = dict(network.released_by)
    for task in network.tasks:
        platform = network.platforms.get(task.core, NO_OVERHEAD)
        late = task.jitter + (platform.tick_period if task.timed else 0)
        wcet = task.plain_wcet + switch_time(task, platform)
        tasks.append(replace(task, wcet=wcet, jitter=late, rows=(), timed=False))
        if platform.release:
            extra = _above_all(
                network, f"{task.name}_release", task.core, release_time(task, platform)
            )
            tasks.append(
                replace(extra, period=task.period, deadline=task.period + late, jitter=late)
            )
            if task.name in released:
                released[extra.name] = released[task.name]
    for core in dict.fromkeys(task.core for task in network.tasks):
        platform = network.platforms.get(core, NO_OVERHEAD)
        if platform.tick_wcet:
            tick = _above_all(network, f"{core}_tick", core, platform.tick_wcet)
            tasks.append(replace(tick, period=platform.tick_period, deadline=platform.tick_period))
    try:
        return replace(network, tasks=tuple(tasks), released_by=released, platforms={})
    except ValueError as fault:
        raise Unfit(f"overheads become tasks of their own, and {fault}") from None


def _above_all(network: Network, name: str, core: str, wcet: int) -> Task:
    """A task that all others of its core wait for."""
    highest = max(
        [task.priority for task in network.tasks if task.core == core]
        + list(network.ceilings.values())
    )
    return Task(name, highest + 1, 1, 1, wcet, core=core)


@dataclass(frozen=True, slots=True)
class ReleaseTree:
    """An item, and the items that its completion releases."""

    item: Task | Frame
    followers: tuple[ReleaseTree, ...]

    def walk(self) -> list[ReleaseTree]:
        """This tree and all in it, each before those that it releases."""
        found = [self]
        for one in self.followers:
            found += one.walk()
        return found


def trees(network: Network, tool: str) -> list[ReleaseTree]:
    """The items that events release, each with all that follows it.

    `Unfit` where an item that follows has jitter of its own.
    """
    items = network.items()
    followers: dict[str, list[str]] = {}
    for name, by in network.released_by.items():
        if items[name].jitter:
            raise Unfit(f"{tool} has no jitter of what is released by another: {name} has")
        followers.setdefault(by, []).append(name)

    def tree(name: str) -> ReleaseTree:
        return ReleaseTree(items[name], tuple(tree(one) for one in followers.get(name, ())))

    return [tree(name) for name in items if name not in network.released_by]


def urgency(frames: Sequence[Frame]) -> dict[str, int]:
    """A larger number for a more urgent frame, from 1 up; the same for those of one rank."""
    levels = dense(-frame.rank for frame in frames)
    return {frame.name: levels[-frame.rank] for frame in frames}
