# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Random networks of tasks, sections, tables, frames and chains, small enough to simulate."""

from __future__ import annotations

import random
from dataclasses import replace

from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.bus import Bus, Errors, Frame
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.tasks import TableRow, Task

PERIODS = (100, 150, 200, 300, 400, 600, 1_000)


def random_network(chance: random.Random, *, plain: bool = False) -> Network:
    """One or two cores, perhaps a bus, loads up to 1.1; ``plain``: one core, no tables."""
    cores = 1 if plain else chance.choice((1, 1, 2))
    tasks: list[Task] = []
    sections: list[Section] = []
    for core in range(cores):
        some = _tasks(chance, f"c{core}", plain)
        tasks += some
        sections += _sections(chance, some, f"c{core}", plain)
    if plain:
        return Network(tuple(tasks), sections=tuple(sections))
    frames, bus = _frames(chance)
    released: dict[str, str] = {}
    if frames and chance.random() < 0.7:
        tasks, frames, released = _chain(chance, tasks, frames)
    homes = {"can": tuple(frames)} if frames else {}
    return Network(tuple(tasks), homes, {"can": bus} if frames else {}, released, tuple(sections))


def with_epochs(network: Network, chance: random.Random) -> Network:
    """The same with each offset from one of three epochs of its core."""
    tasks = (
        task if task.offset is None else replace(task, epoch=chance.choice(("", "x", "y")))
        for task in network.tasks
    )
    return replace(network, tasks=tuple(tasks))


def with_offsets(network: Network, chance: random.Random) -> Network:
    """The network with offsets of most tasks that can have one, some beyond their period."""
    tasks = tuple(
        replace(task, offset=chance.randrange(2 * task.period))
        if not task.sporadic and task.name not in network.released_by and chance.random() < 0.8
        else task
        for task in network.tasks
    )
    return replace(network, tasks=tasks)


def _tasks(chance: random.Random, core: str, plain: bool) -> list[Task]:
    count = chance.randint(1, 5)
    load = chance.choice((0.5, 0.8, 0.95, 1.05))
    found = []
    for n in range(count):
        period = chance.choice(PERIODS) + chance.choice((0, 0, chance.randint(1, 50)))
        cost = max(2, int(period * load / count * chance.uniform(0.4, 1.4)))
        jitter = chance.choice((0, 0, chance.randint(0, period), 2 * period))
        priority = count - n if plain else chance.randint(1, count)
        task = Task(f"{core}.t{n}", priority, period, 3 * period, cost, jitter, core)
        if not plain and chance.random() < 0.4:
            task = _table(chance, task)
        found.append(task)
    return found


def _table(chance: random.Random, task: Task) -> Task:
    """The task with its cost in rows of different periods."""
    rows = tuple(
        TableRow(f"r{n}", max(1, task.wcet // 2), every, chance.randrange(every))
        for n, every in enumerate(chance.choices((1, 2, 3, 4), k=chance.randint(1, 3)))
    )
    own, sporadic = chance.randint(0, 2), chance.random() < 0.3
    return Task(
        task.name, task.priority, task.period, task.deadline, own, task.jitter, task.core,
        rows, sporadic=sporadic,
    )  # fmt: skip


def _sections(chance: random.Random, tasks: list[Task], core: str, plain: bool) -> list[Section]:
    """At most one section a task; a plain one is no longer than its job's beginning."""
    found = []
    for task in tasks:
        if chance.random() < 0.4:
            longest = task.wcet - 1 if plain else task.plain_wcet
            length = chance.randint(1, max(1, longest))
            found.append(Section(f"{core}.o{chance.randint(0, 1)}", task.name, length))
    return found


def _frames(chance: random.Random) -> tuple[list[Frame], Bus]:
    count = chance.randint(0, 5)
    queues = ("", "", "node") if chance.random() < 0.5 else ("",)
    frames = []
    for n in range(count):
        period = chance.choice(PERIODS) * 2
        cost = max(5, int(period * 0.8 / count * chance.uniform(0.3, 1.2)))
        jitter = chance.choice((0, 0, chance.randint(0, period)))
        queue = chance.choice(queues)
        frames.append(Frame(f"m{n}", n, period, 3 * period, cost, jitter, queue))
    errors = Errors(4_000, chance.choice((1, 2)), bits=31) if chance.random() < 0.3 else None
    return frames, Bus(1, errors=errors)


def _chain(
    chance: random.Random, tasks: list[Task], frames: list[Frame]
) -> tuple[list[Task], list[Frame], dict[str, str]]:
    """A task that releases a frame that releases a task of its own, on the last core."""
    sender, number = chance.choice(tasks), chance.randrange(len(frames))
    old = frames[number]
    frame = Frame(
        old.name,
        old.rank,
        sender.period,
        sender.deadline,
        old.transmission_time,
        chance.choice((0, 7)),
        old.queue,
    )
    core = tasks[-1].core
    taker = Task("taker", chance.randint(0, 9), sender.period, sender.deadline, 3, core=core)
    frames = [*frames[:number], frame, *frames[number + 1 :]]
    return [*tasks, taker], frames, {frame.name: sender.name, taker.name: frame.name}


def random_distribution(chance: random.Random) -> Network:
    """Two to four cores, two or three buses, and chains over gateways between them."""
    cores = [f"c{n}" for n in range(chance.randint(2, 4))]
    buses = {f"b{n}": Bus(1) for n in range(chance.randint(2, 3))}
    tasks = [task for core in cores for task in _tasks(chance, core, plain=False)[:3]]
    sections = [
        section
        for core in cores
        for section in _sections(chance, [t for t in tasks if t.core == core], core, plain=False)
    ]
    frames: dict[str, list[Frame]] = {bus: [] for bus in buses}
    released: dict[str, str] = {}
    for number in range(chance.randint(1, 3)):
        period = chance.choice(PERIODS)
        way = chance.sample([*buses], chance.randint(1, len(buses)))
        before = ""
        for hop, bus in enumerate((*way, None)):
            name, core = f"x{number}.{hop}", chance.choice(cores)
            task = Task(name, chance.randint(0, 9), period, 9 * period, max(1, period // 40))
            tasks.append(replace(task, core=core))
            if before:
                released[name] = before
            before = name
            if bus is not None:
                sent = f"f{number}.{hop}"
                queue = chance.choice(("", core))
                rank, cost = 10 * number + hop, max(5, period // 25)
                jitter = chance.choice((0, 0, 7))
                frames[bus].append(Frame(sent, rank, period, 9 * period, cost, jitter, queue))
                released[sent] = before
                before = sent
    others = random.Random(chance.random())
    for bus, some in frames.items():
        for n in range(others.randint(0, 2)):
            period = 2 * others.choice(PERIODS)
            some.append(Frame(f"{bus}.o{n}", 100 + n, period, 3 * period, max(5, period // 10)))
    homes = {bus: tuple(some) for bus, some in frames.items() if some}
    used = {bus: one for bus, one in buses.items() if bus in homes}
    return Network(tuple(tasks), homes, used, released, tuple(sections))


def random_transactions(chance: random.Random) -> Network:
    """Two cores, perhaps a bus, and chains that come back to them; other tasks between."""
    names = ["c0", "c1", *["can"] * chance.randint(0, 1)]
    tasks: list[Task] = []
    frames: list[Frame] = []
    released: dict[str, str] = {}
    share = chance.choice((0.04, 0.08, 0.14))
    for number in range(chance.randint(1, 3)):
        period = chance.choice(PERIODS)
        before, sporadic = "", chance.random() < 0.3
        for step in range(chance.randint(1, 5)):
            name, cost = f"x{number}.{step}", max(2, int(period * share * chance.uniform(0.3, 1.7)))
            best = chance.choice((0, cost, chance.randint(0, cost)))
            jitter = chance.choice((0, 0, chance.randint(0, period // 2)))
            home, deadline = chance.choice(names), 9 * period
            if home == "can":
                rank = chance.randint(0, 9)
                frames.append(
                    Frame(name, rank, period, deadline, cost, jitter, best=best,
                          sporadic=sporadic and not before)
                )  # fmt: skip
            else:
                tasks.append(
                    Task(name, chance.randint(0, 5), period, deadline, cost, jitter, home,
                         best=best, sporadic=sporadic and not before)
                )  # fmt: skip
            if before:
                released[name] = before
            before = name
    errors = Errors(4_000, bits=31) if chance.random() < 0.2 else None
    buses = {"can": Bus(1, errors=errors)} if frames else {}
    homes = {"can": tuple(frames)} if frames else {}
    return Network(tuple(tasks), homes, buses, released, together=True)
