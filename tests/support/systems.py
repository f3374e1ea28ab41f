# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Small systems for the tests of the analysis, built without a model file."""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.language.terms import IntegerType, Ns
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.instances import End, Instance
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.model.system import Carried, SharedObject, Shutdown, Stop, System, Task
from ravenchart.gen.origins import Origin

HERE = Origin("model.yaml", 1, 1)


def stops_of(*places: str) -> tuple[Stop, ...]:
    """The stops of a way: each is ``instance.name``, or the name of a message."""
    return tuple(End(*one.split(".")) if "." in one else Carried(one) for one in places)


def task(
    name: str,
    priority: int,
    wcet: int,
    period: int,
    deadline: int | None = None,
    jitter: int = 0,
    line: int = 1,
) -> Task:
    """A task of the node ``cpu``; the deadline is the period unless given."""
    return Task(
        element=name,
        origin=Origin("model.yaml", line, 3),
        node="cpu",
        period=Ns(period),
        offset=Ns(0),
        deadline=Ns(period if deadline is None else deadline),
        wcet=Ns(wcet),
        priority=priority,
        jitter=Ns(jitter),
    )


def shared(name: str, ceiling: int, section: int, *users: str) -> SharedObject:
    """A protected object of the node ``cpu``."""
    return SharedObject(name, "cpu", users, ceiling, Ns(section))


def bus(name: str = "bus", bit_rate: int = 500_000) -> Bus:
    """A bus."""
    return Bus(name, HERE, bit_rate, 8, 8, Ns(0))


def message(
    name: str,
    identifier: int = 0x100,
    *,
    length: int = 8,
    period: int = 10_000_000,
    extended: bool = False,
    source: str | None = None,
    target: str | None = None,
) -> Message:
    """A message of ``bus``; the ends are ``instance.port``, None for the outside."""
    ends = [None if end is None else End(*end.split(".")) for end in (source, target)]
    return Message(
        name=name,
        origin=HERE,
        bus="bus",
        identifier=identifier,
        extended=extended,
        type=IntegerType("Word", HERE, 0, 1),
        signals=(),
        length=length,
        source=ends[0],
        targets=() if ends[1] is None else (ends[1],),
        period=Ns(period),
    )


def system(
    tasks: Sequence[Task],
    objects: Sequence[SharedObject] = (),
    buses: Sequence[Bus] = (),
    messages: Sequence[Message] = (),
) -> System:
    """A system that holds nothing but these, and the instances that the messages name."""
    ends = [end for m in messages for end in (m.source, *m.targets) if end is not None]
    names = dict.fromkeys(end.instance for end in ends)
    component = Component("Part", HERE, (), (), (), (), None, (), ())
    return System(
        name="Sample",
        origin=HERE,
        digest="0" * 64,
        types=(),
        components=(component,),
        nodes=(Node("cpu", HERE, Ns(0), Ns(0), 0),),
        buses=tuple(buses),
        instances=tuple(Instance(name, HERE, component, "cpu", ()) for name in names),
        connections=(),
        messages=tuple(messages),
        processors=(),
        shutdown=Shutdown((), Ns(0)),
        tasks=tuple(tasks),
        objects=tuple(objects),
    )
