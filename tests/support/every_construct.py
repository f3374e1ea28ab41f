# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A hand-built component whose one region has every construct that a chart can have."""

from __future__ import annotations

from ravenchart.gen.language.terms import (
    BOOLEAN,
    Expression,
    Flow,
    If,
    InState,
    IntegerType,
    Literal,
    Name,
    Ns,
    Operation,
    PortTest,
    Raise,
    Reading,
    Send,
    Set,
)
from ravenchart.gen.model.component import (
    Activity,
    Component,
    Data,
    Direction,
    Event,
    Port,
    StateRef,
)
from ravenchart.gen.model.statechart import (
    After,
    Completion,
    Every,
    Initial,
    NestedRegion,
    OnEvent,
    Overflow,
    PseudoKind,
    Pseudostate,
    Region,
    Segment,
    State,
    Timing,
    Transition,
    TransitionKind,
    Trigger,
    When,
)
from ravenchart.gen.origins import Origin

HERE = Origin("every.yaml", 1, 1)
LEVEL = IntegerType("Level", HERE, 0, 100, "mm")
LEVEL_DATA = Name(Reading.DATA, "level", None, LEVEL)
EVENT_VALUE = Name(Reading.EVENT, "Go", None, LEVEL)
MS = 1_000_000


def _timing(period: int) -> Timing:
    return Timing(Ns(period * MS), Ns(MS), Ns(period * MS))


def number(value: int) -> Literal:
    """A bare number."""
    return Literal(value, None)


def compared(left: Expression, operator: str, right: Expression) -> Operation:
    """A comparison."""
    return Operation(operator, (left, right), BOOLEAN)


def _set(value: int) -> Set:
    return Set(HERE, "level", None, number(value))


def _state(
    name: str,
    parent: str | None = None,
    region: str = "",
    *,
    regions: tuple[NestedRegion, ...] = (),
    entry: Flow = (),
    exit_: Flow = (),
    defers: tuple[str, ...] = (),
    final: bool = False,
) -> State:
    return State(name, HERE, parent, region, regions, entry, exit_, defers, final)


def _nested(name: str, target: str, effect: Flow = ()) -> NestedRegion:
    return NestedRegion(name, HERE, Initial(target, effect))


def _pseudo(
    name: str, kind: PseudoKind, parent: str | None = None, region: str = ""
) -> Pseudostate:
    return Pseudostate(name, HERE, kind, parent, region)


def _transition(
    name: str,
    source: str,
    target: str,
    trigger: Trigger,
    guard: Expression | None = None,
    effect: Flow = (),
    *,
    kind: TransitionKind = TransitionKind.EXTERNAL,
    otherwise: bool = False,
) -> Transition:
    return Transition(name, HERE, source, target, kind, trigger, guard, effect, otherwise)


STATES = (
    _state("Idle", entry=(_set(0),), defers=("Go",)),
    _state("Work", regions=(_nested("", "First", (_set(7),)),), exit_=(Raise(HERE, "Left"),)),
    _state("First", "Work"),
    _state("Second", "Work"),
    _state("Inner", "Work", regions=(_nested("", "Deepest"),)),
    _state("Deepest", "Inner"),
    _state("Work_End", "Work", final=True),
    _state("Both", regions=(_nested("Left_Half", "L1"), _nested("Right_Half", "R1"))),
    _state("L1", "Both", "Left_Half"),
    _state("L_End", "Both", "Left_Half", final=True),
    _state("R1", "Both", "Right_Half"),
    _state("R2", "Both", "Right_Half"),
    _state("Failed"),
)

PSEUDOSTATES = (
    _pseudo("Recent", PseudoKind.HISTORY, "Work"),
    _pseudo("All_Of_It", PseudoKind.DEEP_HISTORY, "Work"),
    _pseudo("Pick", PseudoKind.CHOICE),
    _pseudo("Meet", PseudoKind.JUNCTION),
    _pseudo("Split", PseudoKind.FORK),
    _pseudo("Gather", PseudoKind.JOIN),
    _pseudo("Dead", PseudoKind.TERMINATE),
)

_CHECK = If(HERE, compared(LEVEL_DATA, ">", number(5)), (Raise(HERE, "Left"),), (_set(1),))

TRANSITIONS = (
    _transition("start", "Idle", "Work", OnEvent("Go"), compared(EVENT_VALUE, "<", number(9))),
    _transition("again", "Idle", "Idle", OnEvent("Again"), None, (_CHECK,)),
    _transition("resume", "Idle", "Recent", OnEvent("Resume")),
    _transition("resume_all", "Idle", "All_Of_It", OnEvent("Resume_All")),
    _transition("recent_default", "Recent", "Second", Segment()),
    _transition("decide", "First", "Pick", After(Ns(50 * MS), 5)),
    _transition(
        "little", "Pick", "Second", Segment(), compared(LEVEL_DATA, "<=", number(3)), (_set(4),)
    ),
    _transition("much", "Pick", "Split", Segment(), otherwise=True),
    _transition("fork_left", "Split", "L1", Segment()),
    _transition("fork_right", "Split", "R2", Segment()),
    _transition("beat", "Second", "Inner", Every(Ns(10 * MS), 1)),
    _transition("inner_out", "Inner", "Work_End", When(PortTest("probe", "stale"))),
    _transition("work_done", "Work", "Meet", Completion()),
    _transition("meet_idle", "Meet", "Idle", Segment(), InState("Other", "Calm")),
    _transition("meet_fail", "Meet", "Failed", Segment(), otherwise=True),
    _transition("left_done", "L1", "L_End", OnEvent("Go")),
    _transition("right_step", "R1", "R2", OnEvent("Again")),
    _transition("right_join", "R2", "Gather", Completion()),
    _transition("left_join", "L1", "Gather", Completion()),
    _transition(
        "joined", "Gather", "Idle", Segment(), effect=(Send(HERE, "told", ((None, number(1)),)),)
    ),
    _transition("restart", "Work", "First", OnEvent("Restart")),
    _transition("inside", "Work", "Second", OnEvent("Inside"), kind=TransitionKind.LOCAL),
    _transition("climb", "Deepest", "Work", OnEvent("Climb")),
    _transition("self_work", "Work", "Work", OnEvent("Self")),
    _transition(
        "note", "Work", "Work", OnEvent("Note"), None, (_set(2),), kind=TransitionKind.INTERNAL
    ),
    _transition("kill", "Failed", "Dead", OnEvent("Kill")),
    _transition("fail", "Both", "Failed", OnEvent("Left")),
)

EVENTS = (
    "Go", "Again", "Resume", "Resume_All", "Restart", "Inside", "Climb", "Self", "Note", "Kill",
    "Left",
)  # fmt: skip


def _region(
    name: str,
    initial: str,
    states: tuple[State, ...],
    transitions: tuple[Transition, ...],
    pseudostates: tuple[Pseudostate, ...] = (),
    *,
    reads: tuple[str, ...] = (),
    writes: tuple[str, ...] = (),
    sends: tuple[str, ...] = (),
    raises: tuple[str, ...] = (),
) -> Region:
    return Region(
        name,
        HERE,
        _timing(10),
        4,
        Overflow.REJECT_NEWEST,
        None,
        1,
        Initial(initial),
        None,
        states,
        transitions,
        reads,
        writes,
        sends,
        raises,
        pseudostates,
        2,
    )


def every_construct() -> Component:
    """The component ``Every``: its region ``Life`` has all, and asks its region ``Other``."""
    life = _region(
        "Life",
        "Idle",
        STATES,
        TRANSITIONS,
        PSEUDOSTATES,
        reads=("level", "probe", "Other"),
        writes=("level",),
        sends=("told",),
        raises=("Left",),
    )
    calm = (_state("Calm"), _state("Storm"))
    blow = _transition("blow", "Calm", "Storm", OnEvent("Again"))
    feed = Activity("feed", HERE, _timing(20), (), (), (), (), StateRef("Life", "First"), None)
    return Component(
        "Every",
        HERE,
        (),
        (Port("probe", HERE, Direction.IN, LEVEL), Port("told", HERE, Direction.OUT, LEVEL)),
        tuple(Event(name, HERE, LEVEL if name == "Go" else None) for name in EVENTS),
        (Data("level", HERE, LEVEL, 0),),
        _timing(10),
        (life, _region("Other", "Calm", calm, (blow,))),
        (feed,),
    )
