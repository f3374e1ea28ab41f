# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Complete charts as models write them: what they mean, and what they may not say."""

from __future__ import annotations

import pytest

from ravenchart.gen.language.terms import InState, Name, Operation, Raise, Reading, Set
from ravenchart.gen.model.statechart import (
    DONE,
    TOP,
    After,
    Completion,
    Every,
    OnEvent,
    Overflow,
    PseudoKind,
    RegionId,
    Segment,
    TransitionKind,
)
from tests.support.chart_models import chart_text, component_of, found, region_of

BOTH = """\
A: {}
Both:
  entry: [{set: place, to: 1}]
  regions:
    Left:
      initial: {to: L1, effect: [{set: place, to: 2}]}
      states: {L1: {}, L2: {}, L_End: {kind: final}}
    Right:
      initial: R1
      states:
        R1: {}
        R2:
          initial: R21
          states: {R21: {}, R22: {}, R_Hist: {kind: deep_history}}
"""
MOVES = """\
go: {from: A, to: Both, on: Go}
left: {from: L1, to: L2, on: Go}
over: {from: L2, to: L_End, on: Go}
right: {from: R1, to: R2, on: Stop}
inner: {from: R21, to: R22, every: 25 ms}
back: {from: R1, to: R_Hist, after: 1 s}
home: {from: Both, to: A, after: 10 s}
"""


def test_states_and_pseudostates_stand_in_tree_order() -> None:
    region = region_of(chart_text(BOTH, MOVES))
    assert [(s.name, s.parent, s.region, s.final) for s in region.states] == [
        ("A", None, "", False),
        ("Both", None, "", False),
        ("L1", "Both", "Left", False),
        ("L2", "Both", "Left", False),
        ("L_End", "Both", "Left", True),
        ("R1", "Both", "Right", False),
        ("R2", "Both", "Right", False),
        ("R21", "R2", "", False),
        ("R22", "R2", "", False),
    ]
    pseudo = region.pseudostates[0]
    assert (pseudo.name, pseudo.kind) == ("R_Hist", PseudoKind.DEEP_HISTORY)
    assert (pseudo.parent, pseudo.region) == ("R2", "")
    assert [one.name for one in region.concurrent_regions()] == ["Left", "Right", ""]


def test_regions_begin_with_their_effects() -> None:
    both = region_of(chart_text(BOTH, MOVES)).state("Both")
    assert both.is_orthogonal
    assert [(n.name, n.initial.target, len(n.initial.effect)) for n in both.regions] == [
        ("Left", "L1", 1),
        ("Right", "R1", 0),
    ]
    region = region_of(
        chart_text(BOTH, MOVES, region="initial: {to: R22, effect: [raise: Go]}\nqueue: 4")
    )
    assert (region.initial.target, len(region.initial.effect)) == ("R22", 1)
    assert region.raises == ("Go",)


def test_effects_of_initial_transitions_count_as_writes() -> None:
    states = "A:\n  initial: {to: B, effect: [{set: place, to: pose.x}]}\n  states: {B: {}}\n"
    region = region_of(chart_text(states, "t: {from: B, on: Go, effect: [raise: Stop]}\n"))
    assert (region.reads, region.writes) == (("pose",), ("place",))


def test_one_region_in_regions_is_a_composite_state_with_a_named_region() -> None:
    states = "A: {regions: {Only: {initial: B, states: {B: {}, C: {}}}}}\n"
    region = region_of(
        chart_text(states, "t: {from: B, to: C, on: Go}\nu: {from: C, to: A, on: Stop}\n")
    )
    assert not region.state("A").is_orthogonal
    assert region.state("B").region == "Only"
    assert region.concurrent_regions() == (TOP,)


def test_triggers_are_told_by_their_keys() -> None:
    states = "A: {}\nB: {}\nPick: {kind: choice}\n"
    region = region_of(
        chart_text(
            states,
            "t: {from: A, to: Pick, on: Go}\n"
            "u: {from: Pick, to: B, guard: place > 1}\n"
            "v: {from: Pick, to: A, guard: else}\n"
            "w: {from: B, to: A}\n"
            "x: {from: B, every: 25 ms, effect: [raise: Stop]}\n"
            "y: {from: A, to: B, after: 1 s}\n",
            events="[Go, Stop]",
        )
    )
    triggers = [t.trigger for t in region.transitions]
    assert triggers == [
        OnEvent("Go"),
        Segment(),
        Segment(),
        Completion(),
        Every(25_000_000, 3),  # type: ignore[arg-type]
        After(1_000_000_000, 100),  # type: ignore[arg-type]
    ]
    assert [t.otherwise for t in region.transitions] == [False, False, True, False, False, False]
    assert region.transitions[2].guard is None


def test_every_kind_of_pseudostate_has_its_form() -> None:
    region = region_of(chart_text(FULL_STATES, FULL_MOVES, region=FULL_REGION))
    assert {p.name: p.kind for p in region.pseudostates} == {
        "Pick": PseudoKind.CHOICE,
        "Meet": PseudoKind.JUNCTION,
        "Split": PseudoKind.FORK,
        "Unite": PseudoKind.JOIN,
        "Shallow": PseudoKind.HISTORY,
        "Deep": PseudoKind.DEEP_HISTORY,
        "Halt": PseudoKind.TERMINATE,
    }
    assert {t.name: t.kind for t in region.transitions if t.name in ("near", "stay")} == {
        "near": TransitionKind.LOCAL,
        "stay": TransitionKind.INTERNAL,
    }
    joined = [t.trigger for t in region.transitions if t.target == "Unite"]
    assert joined == [Completion(), Completion()]
    assert (region.deferral_depth, region.state("A").defers) == (3, ("Stop",))


FULL_REGION = "initial: A\nqueue: 4\ndeferred: 3\nsafe_state: A"
FULL_STATES = """\
A: {defer: [Stop]}
Pick: {kind: choice}
Meet: {kind: junction}
Split: {kind: fork}
Unite: {kind: join}
Halt: {kind: terminate}
C:
  initial: C1
  states: {C1: {}, C2: {}, Shallow: {kind: history}, Deep: {kind: deep_history}}
O:
  regions:
    Left: {initial: L1, states: {L1: {}, L2: {}}}
    Right: {initial: R1, states: {R1: {}, R2: {}}}
"""
FULL_MOVES = """\
go: {from: A, to: Pick, on: Go}
pick_1: {from: Pick, to: Meet, guard: place > 5}
pick_2: {from: Pick, to: Split, guard: else}
meet_1: {from: Meet, to: Shallow, guard: place > 6}
meet_2: {from: Meet, to: Deep, guard: place > 7}
meet_3: {from: Meet, to: Halt, guard: place = 100}
meet_4: {from: Meet, to: C, guard: else}
first: {from: Shallow, to: C2}
split_1: {from: Split, to: L2}
split_2: {from: Split, to: R2}
unite_1: {from: L2, to: Unite}
unite_2: {from: R2, to: Unite}
united: {from: Unite, to: A}
turn_left: {from: L1, to: L2, on: Go}
turn_right: {from: R1, to: R2, on: Go}
start_over: {from: O, to: O, on: Stop}
near: {from: C, to: C1, on: Go, local: true}
stay: {from: C2, on: Go, effect: [{set: place, to: 3}]}
leave: {from: C, to: A, on: Stop}
"""


# --- Events with values ------------------------------------------------------------

CARRYING = "{Go: {type: Distance, overflow: drop_oldest}, Turn: {type: Pose}, Stop: {}}"


def carrying(effect: str, on: str = "Go", guard: str = "place > 1") -> str:
    """A chart of which one transition takes an event that carries a value."""
    return chart_text(
        "A: {}\n",
        f"t: {{from: A, on: {on}, guard: {guard}, effect: [{effect}]}}\n"
        "u: {from: A, after: 1 s, effect: [{raise: Go, with: 7}, "
        "{raise: Turn, with: {turn: 90, x: place}}]}\n"
        "v: {from: A, on: Turn, guard: place > 3, effect: []}\n",
        events=CARRYING,
        raised="plant.Stop",
    )


def test_events_have_types_and_rules_of_their_own() -> None:
    component = component_of(carrying("{set: place, to: event}"))
    go, turn, stop = component.events
    assert (go.type and go.type.name, go.overflow) == ("Distance", Overflow.DROP_OLDEST)
    assert (turn.type and turn.type.name, turn.overflow) == ("Pose", None)
    assert (stop.type, stop.overflow) == (None, None)


def test_event_is_the_value_of_the_triggering_event() -> None:
    region = component_of(carrying("{set: place, to: event}", guard="event > place")).regions[0]
    taken = region.transitions[0]
    assert isinstance(taken.guard, Operation)
    value = taken.guard.operands[0]
    assert isinstance(value, Name)
    assert (value.kind, value.name, value.field) == (Reading.EVENT, "Go", None)
    assert isinstance(taken.effect[0], Set) and taken.effect[0].value == value
    assert region.reads == ("place",)


def test_field_of_an_event_is_read_by_its_name() -> None:
    region = component_of(carrying("{set: place, to: event.x}", on="Turn")).regions[0]
    action = region.transitions[0].effect[0]
    assert isinstance(action, Set) and isinstance(action.value, Name)
    assert (action.value.name, action.value.field) == ("Turn", "x")


def test_event_is_raised_with_its_value_in_field_order() -> None:
    effect = component_of(carrying("{set: place, to: event}")).regions[0].transitions[1].effect
    assert all(isinstance(action, Raise) for action in effect)
    values = [action.values for action in effect if isinstance(action, Raise)]
    assert [field for field, _ in values[0]] == [None]
    assert [field for field, _ in values[1]] == ["x", "turn"]


def test_event_may_be_passed_on_as_a_whole() -> None:
    effect = component_of(carrying("{raise: Turn, with: event}", on="Turn"))
    action = effect.regions[0].transitions[0].effect[0]
    assert isinstance(action, Raise)
    assert all(isinstance(v, Name) and v.kind is Reading.EVENT for _, v in action.values)


@pytest.mark.parametrize(
    ("effect", "on", "message"),
    [
        ("{set: place, to: event}", "Stop", "`event` has no value: the event Stop carries none"),
        ("{raise: Go}", "Go", "the event Go needs a value of type Distance"),
        ("{raise: Stop, with: 3}", "Go", "the event Stop carries no value"),
        (
            "{raise: Turn, with: 3}",
            "Go",
            "`Turn` carries Pose: give its fields, or a name of that type",
        ),
        ("{raise: Turn, with: {x: 3}}", "Go", "`with` gives no value for the field `turn` of Pose"),
        (
            "{raise: Go, with: event + 1}",
            "Go",
            "`Go` takes 0 .. 100 mm, but this may be 1 .. 101",
        ),
    ],
)
def test_wrong_value_of_an_event_is_refused(effect: str, on: str, message: str) -> None:
    assert [text for _, text in found(carrying(effect, on))] == [message]


def test_unknown_event_is_told_once() -> None:
    assert [code for code, _ in found(carrying("{set: place, to: event}", on="Gone"))] == [
        "RV-0305"
    ]


def test_event_has_no_value_behind_a_pseudostate_or_in_an_entry() -> None:
    states = "A: {entry: [{set: place, to: event}]}\nP: {kind: choice}\n"
    moves = "t: {from: A, to: P, on: Go}\nu: {from: P, to: A, effect: [{set: place, to: event}]}\n"
    text = chart_text(states, moves, events=CARRYING, raised="plant.Stop")
    assert [text for code, text in found(text) if code == "RV-0403"] == [
        "`event` has no value: there is no triggering event here",
        "`event` has no value: what leaves a choice has no trigger of its own",
    ]


# --- Do activities and invariants --------------------------------------------------

WORK = """\
activities:
  work:
    period: 10 ms
    wcet: 1 ms
    while: Motion.A
    body: [{raise: done}]
"""


DONE_STATES = "A: {}\nB: {}\n"
DONE_MOVES = """\
t: {from: A, to: B}
u: {from: B, to: A, on: Go}
v: {from: B, on: Stop, effect: []}
"""


@pytest.mark.parametrize("body", ["[{raise: done}]", "user\n    raises: [Done]"])
def test_do_activity_completes_its_state(body: str) -> None:
    more = WORK.replace("[{raise: done}]", body)
    text = chart_text(DONE_STATES, DONE_MOVES, more=more, rows="plant.Motion, plant.work")
    assert component_of(text).activities[0].raises == (DONE,)


def test_invariants_speak_of_states_and_data() -> None:
    more = 'never: {too_far: "in(Motion.R21) and place > 50"}'
    invariant = component_of(chart_text(BOTH, MOVES, more=more)).invariants[0]
    assert invariant.name == "too_far"
    assert isinstance(invariant.condition, Operation)
    assert invariant.condition.operands[0] == InState("Motion", "R21")
    refused = found(chart_text(BOTH, MOVES, more="never: {far: place + 1}"))
    assert refused == [("RV-0404", "`far` takes a condition, but this is a number")]


def test_a_region_begins_in_the_orthogonal_state_around_its_initial_target() -> None:
    region = region_of(chart_text(BOTH, MOVES, region="initial: R22\nqueue: 4"))
    assert region.default_of(TOP) == "Both"
    assert region.default_of(RegionId("Both", "Right")) == "R1"
    assert region.default_leaf("R2") == "R21"
