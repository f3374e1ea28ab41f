# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Each rule of docs/semantics.md on a chart of its own."""

from __future__ import annotations

import pytest

from ravenchart.behaviour.interpreter.region import Stuck
from tests.support.interpreted import run_of, steps


def test_first_execution_enters_and_takes_no_event() -> None:
    chart = """
    initial: {to: B, effect: [{set: x, to: 1}]}
    data: {x: 0}
    states: {A: {initial: B, states: {B: {}}}, C: {}}
    transitions: {go: {from: B, to: C, on: Go}}
    """
    assert steps(chart, "0 Go") == [
        "0 initial(Main).effect, A.entry, B.entry",
        "10 B.exit, A.exit, go.effect, C.entry",
    ]


def test_at_most_so_many_steps_in_one_execution() -> None:
    chart = """
    steps: {steps}
    initial: A
    states: {{A: {{}}, B: {{}}}}
    transitions: {{go: {{from: A, to: B, on: Go}}, back: {{from: B, to: A, on: Back}}}}
    """
    events = ("5 Go", "5 Back")
    assert [one.split()[0] for one in steps(chart.format(steps=1), *events)] == ["0", "10", "20"]
    assert [one.split()[0] for one in steps(chart.format(steps=3), *events)] == ["0", "10", "10"]


def test_inner_source_wins_and_then_model_order() -> None:
    chart = """
    initial: A
    data: {x: 0}
    states: {A: {initial: B, states: {B: {}}}, C: {}}
    transitions:
      outer: {from: A, to: C, on: Go}
      first: {from: B, on: Go, guard: x > 0, effect: [{set: x, to: 0}]}
      second: {from: B, on: Go, guard: x = 0, effect: [{set: x, to: 1}]}
    """
    assert steps(chart, "5 Go", "15 Go")[1:] == ["10 second.effect", "20 first.effect"]


def test_event_that_enables_nothing_is_consumed() -> None:
    chart = """
    initial: A
    states: {A: {}, B: {}}
    transitions: {go: {from: B, to: A, on: Go}, on: {from: A, to: B, on: Next}}
    """
    assert steps(chart, "5 Go", "5 Next")[1:] == ["20 A.exit, on.effect, B.entry"]


def test_transition_to_an_enclosing_state_enters_it_again() -> None:
    chart = """
    initial: A
    states: {A: {initial: B, states: {B: {}, C: {}}}}
    transitions: {next: {from: B, to: C, on: Go}, up: {from: C, to: A, on: Go}}
    """
    assert steps(chart, "5 Go", "15 Go")[2:] == [
        "20 C.exit, A.exit, up.effect, A.entry, B.entry",
    ]


def test_internal_leaves_timers_alone_and_self_does_not() -> None:
    chart = """
    initial: A
    states: {A: {}, B: {}}
    transitions:
      quiet: {from: A, on: Quiet, effect: [{raise: Nothing}]}
      afresh: {from: A, to: A, on: Afresh}
      late: {from: A, to: B, after: 50 ms}
    events: {Nothing: {}}
    """
    assert steps(chart, "25 Quiet")[-1] == "50 A.exit, late.effect, B.entry"
    assert steps(chart, "25 Afresh")[-1] == "80 A.exit, late.effect, B.entry"


# --- Completion -----------------------------------------------------------------------


def test_completion_guard_is_read_once() -> None:
    chart = """
    initial: A
    data: {x: 0}
    states: {A: {}, B: {}}
    transitions:
      complete: {from: A, to: B, guard: x = 1}
      set: {from: A, on: Set, effect: [{set: x, to: 1}]}
      again: {from: A, to: A, on: Again}
    """
    assert steps(chart, "5 Set", "35 Again")[1:] == [
        "20 set.effect",
        "40 A.exit, again.effect, A.entry",
        "50 A.exit, complete.effect, B.entry",
    ]


def test_composite_completes_when_all_its_regions_are_final() -> None:
    chart = """
    initial: O
    states:
      O:
        regions:
          Left: {initial: L, states: {L: {}, L_End: {kind: final}}}
          Right: {initial: R, states: {R: {}, R_End: {kind: final}}}
      Z: {}
    transitions:
      left: {from: L, to: L_End, on: Left_Ends}
      right: {from: R, to: R_End, on: Right_Ends}
      over: {from: O, to: Z}
    """
    assert steps(chart, "5 Left_Ends", "25 Right_Ends")[1:] == [
        "10 L.exit, left.effect",
        "30 R.exit, right.effect",
        "40 O.exit, over.effect, Z.entry",
    ]


def test_completion_is_cancelled_when_the_state_is_left() -> None:
    chart = """
    initial: O
    states:
      O:
        regions:
          Left: {initial: L, states: {L: {}}}
          Right: {initial: R, states: {R: {}}}
      Z: {}
    transitions:
      left: {from: L, to: Z}
      right: {from: R, to: Z}
      go: {from: Z, to: O, on: Go}
    """
    assert steps(chart, "5 Go", until=20)[1:] == [
        "10 L.exit, R.exit, O.exit, left.effect, Z.entry",
        "20 Z.exit, go.effect, O.entry, L.entry, R.entry",
    ]


# --- Time ------------------------------------------------------------------------------


def test_earliest_expiry_goes_first_and_a_false_guard_loses_it() -> None:
    chart = """
    initial: A
    data: {x: 0}
    states: {A: {}}
    transitions:
      never: {from: A, after: 25 ms, guard: x = 1, effect: [{set: x, to: 3}]}
      late: {from: A, after: 30 ms, effect: [{set: x, to: 1}]}
      early: {from: A, after: 20 ms, effect: [{set: x, to: 2}]}
    """
    assert steps(chart)[1:] == ["20 early.effect", "40 late.effect"]


def test_earliest_expiry_goes_before_model_order() -> None:
    chart = """
    initial: C
    data: {x: 0}
    states: {C: {initial: A, states: {A: {}, B: {}, D: {}}}}
    transitions:
      late: {from: C, after: 30 ms, effect: [{set: x, to: 1}]}
      early: {from: C, after: 20 ms, effect: [{set: x, to: 2}]}
      go: {from: A, to: B, on: Go}
      first: {from: B, to: D}
    """
    found = [one.split(", ")[-2 if "entry" in one else -1] for one in steps(chart, "5 Go")[1:]]
    assert found == ["go.effect", "first.effect", "30 early.effect", "40 late.effect"]


def test_every_repeats_without_drift_and_goes_on_after_a_false_guard() -> None:
    chart = """
    initial: A
    data: {x: 0}
    states: {A: {}}
    transitions:
      once: {from: A, after: 40 ms, effect: [{set: x, to: 1}]}
      beat: {from: A, every: 20 ms, guard: x = 0 or x = 1, effect: [{set: x, to: "min(x + 1, 9)"}]}
      reset: {from: A, after: 90 ms, effect: [{set: x, to: 0}]}
    """
    assert steps(chart, until=140)[1:] == [
        "20 beat.effect",
        "40 once.effect",
        "50 beat.effect",
        "90 reset.effect",
        "100 beat.effect",
        "120 beat.effect",
    ]


def test_time_out_ends_with_its_source() -> None:
    chart = """
    initial: A
    states: {A: {}, B: {}}
    transitions: {go: {from: A, to: B, on: Go}, late: {from: A, to: B, after: 30 ms}}
    """
    assert steps(chart, "15 Go")[1:] == ["20 A.exit, go.effect, B.entry"]
    assert run_of(chart, "15 Go", until=20).timers == {}


# --- Choice and junction ----------------------------------------------------------------


def test_junction_tries_another_path_when_one_leads_nowhere() -> None:
    chart = """
    initial: A
    data: {x: 1}
    states: {A: {}, B: {}, C: {}, J: {kind: junction}, K: {kind: junction}}
    transitions:
      go: {from: A, to: J, on: Go}
      dead: {from: J, to: K, guard: x = 1}
      rest: {from: J, to: C, guard: else}
      shut: {from: K, to: B, guard: x = 2}
    """
    assert steps(chart, "5 Go")[1:] == ["10 A.exit, go.effect, rest.effect, C.entry"]


def test_junction_without_a_way_disables_the_transition() -> None:
    chart = """
    initial: A
    data: {x: 1}
    states: {A: {initial: B, states: {B: {}}}, C: {}, J: {kind: junction}}
    transitions:
      inner: {from: B, to: J, on: Go}
      outer: {from: A, to: C, on: Go}
      shut: {from: J, to: C, guard: x = 2}
    """
    assert steps(chart, "5 Go")[1:] == ["10 B.exit, A.exit, outer.effect, C.entry"]


def test_choice_enters_the_states_around_it_first() -> None:
    chart = """
    initial: A
    data: {x: 0}
    states:
      A: {}
      B:
        entry: [{set: x, to: 1}]
        initial: C
        states: {C: {}, D: {}, P: {kind: choice}}
    transitions:
      go: {from: A, to: P, on: Go}
      one: {from: P, to: D, guard: x = 1}
      other: {from: P, to: A, guard: else}
      next: {from: D, to: C, on: Next}
    """
    assert steps(chart, "5 Go")[1:] == [
        "10 A.exit, go.effect, B.entry, one.effect, D.entry",
    ]


def test_choice_that_leads_out_again_leaves_what_was_entered() -> None:
    chart = """
    initial: A
    data: {x: 0}
    states: {A: {}, B: {initial: C, states: {C: {}, P: {kind: choice}}}}
    transitions:
      go: {from: A, to: P, on: Go}
      one: {from: P, to: C, guard: x = 1}
      other: {from: P, to: A, guard: else}
    """
    assert steps(chart, "5 Go")[1:] == [
        "10 A.exit, go.effect, B.entry, B.exit, other.effect, A.entry",
    ]


def test_stuck_choice_is_told_with_its_place() -> None:
    chart = """
    initial: A
    data: {x: 0}
    states: {A: {}, P: {kind: choice}}
    transitions: {go: {from: A, to: P, on: Go}, only: {from: P, to: A, guard: x = 1}}
    """
    with pytest.raises(Stuck, match="P has no way out") as stuck:
        steps(chart, "5 Go")
    assert stuck.value.origin.line > 1


# --- Events ----------------------------------------------------------------------------


DEFERRING = """
initial: A
deferred: 1
states:
  A: {defer: [Go], initial: A1, states: {A1: {}, A2: {}}}
  B: {}
transitions:
  leave: {from: A, to: B, on: Leave}
  inner: {from: A1, to: A2, on: Go, guard: x = 1}
  set: {from: A, on: Set, effect: [{set: x, to: 1}]}
  go: {from: B, on: Go, effect: [{set: x, to: 2}]}
data: {x: 0}
"""


def test_deferral_loses_to_transitions_inside_only_when_they_are_enabled() -> None:
    assert steps(DEFERRING, "5 Go", "15 Set", "25 Go")[1:] == [
        "20 set.effect",
        "30 A1.exit, inner.effect, A2.entry",
    ]


def test_deferred_event_waits_until_no_active_state_defers_it() -> None:
    assert steps(DEFERRING, "5 Go", "15 Leave")[1:] == [
        "20 A1.exit, A.exit, leave.effect, B.entry",
        "30 go.effect",
    ]


AGAIN = """
initial: P
deferred: 2
states: {P: {defer: [Order]}, Q: {}}
transitions:
  order: {from: P, to: Q, on: Order, guard: x = 1}
  again: {from: P, to: P, on: Again, effect: [{set: x, to: 1}]}
  back: {from: Q, to: P, on: Order}
data: {x: 0}
"""


def test_exit_of_the_state_that_defers_gives_the_event_back_though_it_is_entered_again() -> None:
    assert steps(AGAIN, "5 Order", "15 Again", "15 Order")[1:] == [
        "20 P.exit, again.effect, P.entry",
        "30 P.exit, order.effect, Q.entry",  # the first, and then the second
        "40 Q.exit, back.effect, P.entry",
    ]


def test_event_that_came_back_is_deferred_again_where_nothing_takes_it() -> None:
    chart = AGAIN.replace("to: 1}]", "to: x}]").replace("set: x, to: x", "set: x, to: 0")
    assert steps(chart, "5 Order", "15 Again", "25 Order")[1:] == [
        "20 P.exit, again.effect, P.entry"
    ]


def test_exit_of_one_state_leaves_alone_what_another_defers() -> None:
    chart = """
    initial: O
    deferred: 2
    states:
      O:
        regions:
          Left: {initial: L, states: {L: {defer: [Go]}, M: {}}}
          Right: {initial: R, states: {R: {defer: [Stop]}}}
    transitions:
      ready: {from: L, on: Stop, guard: x = 1}
      go: {from: L, to: M, on: Go, guard: x = 1}
      again: {from: R, to: R, on: Again, effect: [{set: x, to: 1}]}
    data: {x: 0}
    """
    assert steps(chart, "5 Go", "15 Again")[1:] == ["20 R.exit, again.effect, R.entry"]


def test_full_deferral_list_loses_the_event() -> None:
    assert steps(DEFERRING, "5 Go", "5 Go", "25 Leave")[1:] == [
        "30 A1.exit, A.exit, leave.effect, B.entry",
        "40 go.effect",
    ]


@pytest.mark.parametrize(("keeps", "goes"), [("Left", "Right"), ("Right", "Left")])
def test_one_region_that_defers_keeps_the_event_from_all(keeps: str, goes: str) -> None:
    chart = f"""
    initial: O
    deferred: 1
    states:
      O:
        regions:
          Left: {{initial: Left_1, states: {{Left_1: {{}}, Left_2: {{}}}}}}
          Right: {{initial: Right_1, states: {{Right_1: {{}}, Right_2: {{}}}}}}
    transitions:
      keep: {{from: {keeps}_1, to: {keeps}_2, on: Stop}}
      go: {{from: {goes}_1, to: {goes}_2, on: Go}}
    """
    chart = chart.replace(f"{keeps}_1: {{}}", f"{keeps}_1: {{defer: [Go]}}")
    assert [one.split(", ")[1] for one in steps(chart, "5 Go", "15 Stop")[1:]] == [
        "keep.effect",
        "go.effect",
    ]


def test_event_carries_its_value_to_guard_and_effect() -> None:
    chart = """
    initial: A
    events: {Go: {type: Small}}
    data: {x: 0}
    states: {A: {}, B: {}}
    transitions:
      big: {from: A, to: B, on: Go, guard: event > 5, effect: [{set: x, to: event}]}
      small: {from: A, on: Go, effect: [{raise: Go, with: "min(event + 4, 9)"}]}
      seen: {from: B, on: See, guard: x = 7}
    """
    assert steps(chart, "5 Go 3", "25 See")[1:] == [
        "10 small.effect",
        "20 A.exit, big.effect, B.entry",
        "30 seen.effect",
    ]


@pytest.mark.parametrize(
    ("region", "own", "left"),
    [
        ("reject_newest", "reject_newest", ["A", "B"]),
        ("drop_oldest", "drop_oldest", ["B", "C"]),
        ("drop_oldest", "reject_newest", ["A", "B"]),
        ("reject_newest", "drop_oldest", ["B", "C"]),
    ],
)
def test_a_full_queue_follows_the_policy_of_the_event(
    region: str, own: str, left: list[str]
) -> None:
    chart = f"""
    queue: 2
    overflow: {region}
    initial: S
    events: {{C: {{overflow: {own}}}, Other: {{}}}}
    states: {{S: {{}}}}
    transitions:
      A: {{from: S, on: A, effect: [{{raise: Other}}]}}
      B: {{from: S, on: B, effect: [{{raise: Other}}]}}
      C: {{from: S, on: C, effect: [{{raise: Other}}]}}
    """
    found = steps(chart, "5 A", "5 B", "5 C")[1:]
    assert [one.split()[1].removesuffix(".effect") for one in found] == left


def test_when_is_read_after_everything_else() -> None:
    chart = """
    initial: A
    data: {x: 0}
    states: {A: {}, B: {}}
    transitions:
      cond: {from: A, to: B, when: x = 0}
      go: {from: A, on: Go, effect: [{set: x, to: 0}]}
    """
    assert steps(chart, "5 Go")[1:] == ["10 go.effect", "20 A.exit, cond.effect, B.entry"]
