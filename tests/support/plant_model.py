# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A hand-built system with two components, a bus and every kind of edge."""

from __future__ import annotations

from ravenchart.gen.derive.completion import completed
from ravenchart.gen.language.terms import IntegerType, Ns
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.component import (
    Activity,
    Component,
    Data,
    Direction,
    Event,
    Parameter,
    Port,
)
from ravenchart.gen.model.instances import Connection, End, Instance
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.model.statechart import (
    Initial,
    OnEvent,
    Region,
    State,
    Timing,
    Transition,
    TransitionKind,
)
from ravenchart.gen.model.statechart import Overflow as Full
from ravenchart.gen.model.system import (
    Processor,
    Shutdown,
    Slot,
    System,
    Work,
)
from ravenchart.gen.origins import Origin

HERE = Origin("plant.yaml", 1, 1)
LEVEL = IntegerType("Level", HERE, 0, 100, "mm")
MS = 1_000_000


def _timing(period: int, wcet: int) -> Timing:
    return Timing(Ns(period), Ns(wcet), Ns(period))


def _port(name: str, direction: Direction) -> Port:
    return Port(name, HERE, direction, LEVEL)


def _activity(
    name: str, reads: tuple[str, ...], writes: tuple[str, ...], sends: tuple[str, ...]
) -> Activity:
    return Activity(name, HERE, _timing(10 * MS, MS), reads, writes, sends, (), None, None)


def _sensor() -> Component:
    return Component(
        "Sensor",
        HERE,
        (Parameter("gain", HERE, LEVEL, 1),),
        (_port("raw", Direction.IN), _port("level", Direction.OUT)),
        (),
        (Data("filtered", HERE, LEVEL, 0),),
        _timing(10 * MS, 100_000),
        (),
        (
            _activity("filter", ("raw", "gain"), ("filtered",), ()),
            _activity("publish", ("filtered",), (), ("level",)),
        ),
    )


def _pump() -> Component:
    states = (State("Off", HERE, None, "", (), (), ()), State("On", HERE, None, "", (), (), ()))
    start = Transition("start", HERE, "Off", "On", TransitionKind.EXTERNAL, OnEvent("Go"), None, ())
    mode = Region(
        "Mode",
        HERE,
        _timing(10 * MS, MS),
        4,
        Full.REJECT_NEWEST,
        None,
        1,
        Initial("Off"),
        None,
        states,
        (start,),
        ("level",),
        (),
        (),
        (),
    )
    return Component(
        "Pump",
        HERE,
        (),
        (_port("level", Direction.IN), _port("valve", Direction.OUT)),
        (Event("Go", HERE),),
        (),
        _timing(10 * MS, 100_000),
        (mode,),
        (_activity("drive", ("level", "Mode"), (), ("valve",)),),
    )


def plant() -> System:
    """A sensor that feeds a pump; raw values arrive and valve positions leave over the bus."""
    sensor, pump = _sensor(), _pump()
    rows = (
        ("sensor", Work.PORT_REGION, "ports"),
        ("sensor", Work.ACTIVITY, "filter"),
        ("sensor", Work.ACTIVITY, "publish"),
        ("pump", Work.PORT_REGION, "ports"),
        ("pump", Work.REGION, "Mode"),
        ("pump", Work.ACTIVITY, "drive"),
    )
    slots = tuple(Slot(HERE, o, w, n, _timing(10 * MS, MS), 1, 0) for o, w, n in rows)
    receive = Slot(HERE, "field", Work.BUS_RECEIVE, "receive", _timing(MS, 60_000), 1, 0)
    made = System(
        name="Plant",
        origin=HERE,
        digest="5" * 64,
        types=(LEVEL,),
        components=(sensor, pump),
        nodes=(Node("cpu", HERE, Ns(10_000), Ns(5_000), 0),),
        buses=(Bus("field", HERE, 500_000, 8, 8, Ns(60_000)),),
        instances=(
            Instance("sensor", HERE, sensor, "cpu", (("gain", 1),)),
            Instance("pump", HERE, pump, "cpu", ()),
        ),
        connections=(Connection(HERE, End("sensor", "level"), End("pump", "level")),),
        messages=(
            Message(
                "raw_level",
                HERE,
                "field",
                0x100,
                False,
                LEVEL,
                (),
                1,
                None,
                (End("sensor", "raw"),),
                Ns(5 * MS),
            ),
            Message(
                "valve_position",
                HERE,
                "field",
                0x101,
                True,
                LEVEL,
                (),
                2,
                End("pump", "valve"),
                (),
                Ns(10 * MS),
            ),
        ),
        processors=(
            Processor(
                "reception", HERE, "cpu", Ns(MS), Ns(0), Ns(MS), 2, 0, "field", (receive,), ()
            ),
            Processor(
                "control", HERE, "cpu", Ns(10 * MS), Ns(0), Ns(10 * MS), 1, 0, None, slots, ()
            ),
        ),
        shutdown=Shutdown((), Ns(0)),
    )
    return completed(made)
