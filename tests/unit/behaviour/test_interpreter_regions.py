# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""History, orthogonal regions, fork and join, on charts of their own."""

from __future__ import annotations

from tests.support.interpreted import steps

# --- History ---------------------------------------------------------------------------


HISTORY = """
initial: Away
states:
  Away: {{}}
  M:
    initial: A
    states:
      A: {{}}
      B: {{initial: B1, states: {{B1: {{}}, B2: {{}}, B_End: {{kind: final}}}}}}
      M_End: {{kind: final}}
      H: {{kind: {kind}}}
transitions:
  back: {{from: Away, to: H, on: Back}}
  afresh: {{from: Away, to: M, on: Afresh}}
  leave: {{from: M, to: Away, on: Leave}}
  to_b: {{from: A, to: B2, on: Go}}
  b_ends: {{from: B2, to: B_End, on: Go}}
  m_ends: {{from: B, to: M_End, on: Finish}}
  {more}
"""


def last_of(kind: str, *events: str, more: str = "") -> str:
    """The last step of the history chart under events that come every 10 ms."""
    timed = [f"{10 * index + 5} {event}" for index, event in enumerate(events)]
    return steps(HISTORY.format(kind=kind, more=more), *timed)[-1].partition(" ")[2]


def test_history_without_a_past_enters_by_default() -> None:
    assert last_of("history", "Back") == "Away.exit, back.effect, M.entry, A.entry"


def test_history_without_a_past_takes_its_default_segment() -> None:
    default = "recall: {from: H, to: B}"
    entered = "Away.exit, back.effect, M.entry, recall.effect, B.entry, B1.entry"
    assert last_of("deep_history", "Back", more=default) == entered


def test_deep_history_restores_the_leaf_and_shallow_the_state_around_it() -> None:
    events = ("Back", "Go", "Leave", "Back")
    entered = "Away.exit, back.effect, M.entry, B.entry"
    assert last_of("deep_history", *events) == f"{entered}, B2.entry"
    assert last_of("history", *events) == f"{entered}, B1.entry"


def test_a_composite_that_was_final_is_restored_by_default() -> None:
    events = ("Back", "Go", "Go", "Leave", "Back")
    assert last_of("deep_history", *events).endswith("M.entry, B.entry, B1.entry")


def test_a_region_that_was_final_has_no_history() -> None:
    events = ("Back", "Go", "Finish", "Leave", "Back")
    assert last_of("deep_history", *events).endswith("M.entry, A.entry")


# --- Orthogonal regions -----------------------------------------------------------------


ORTHOGONAL = """
initial: O
data: {{x: 0}}
events: {{Other: {{}}}}
states:
  Z: {{}}
  O:
    regions:
      Left: {{initial: L1, states: {{L1: {{}}, L2: {{}}{left}}}}}
      Right: {{initial: R1, states: {{R1: {{}}, R2: {{}}}}}}
  {more}
transitions:
  {transitions}
  to_z: {{from: O, to: Z, on: Reach}}
  to_l2: {{from: L1, to: L2, on: Reach}}
  to_r2: {{from: R1, to: R2, on: Reach}}
"""


def beside(*transitions: str, left: str = "", more: str = "") -> str:
    """A chart of an orthogonal state O (L1, L2 beside R1, R2) and a state Z."""
    lines = "\n  ".join(transitions)
    return ORTHOGONAL.format(left=left, more=more, transitions=lines)


def test_each_region_fires_once_in_model_order() -> None:
    chart = beside(
        "right: {from: R1, to: R2, on: Go}",
        "left: {from: L1, to: L2, on: Go}",
        "around: {from: O, to: Z, on: Go}",
    )
    assert steps(chart, "5 Go", "15 Go")[1:] == [
        "10 L1.exit, left.effect, L2.entry, R1.exit, right.effect, R2.entry",
        "20 L2.exit, R2.exit, O.exit, around.effect, Z.entry",
    ]


def test_of_two_in_conflict_the_first_fires() -> None:
    chart = beside(
        "leave: {from: L1, to: Z, on: Go}",
        "right: {from: R1, to: R2, on: Go}",
    )
    assert steps(chart, "5 Go")[1:] == ["10 L1.exit, R1.exit, O.exit, leave.effect, Z.entry"]


def test_a_later_one_may_not_leave_what_an_internal_one_fired_in() -> None:
    chart = beside(
        "stay: {from: L1, on: Go, effect: [{raise: Other}]}",
        "leave: {from: R1, to: Z, on: Go}",
    )
    assert steps(chart, "5 Go")[1:] == ["10 stay.effect"]


def test_what_a_choice_leaves_fires_no_more_even_when_it_is_active_again() -> None:
    chart = beside(
        "left: {from: L1, to: P, on: Go}",
        "right: {from: R1, to: R2, on: Go}",
        "again: {from: P, to: O, guard: x = 0}",
        "on: {from: P, to: L2, guard: else}",
        left=", P: {kind: choice}",
    )
    assert steps(chart, "5 Go")[1:] == [
        "10 L1.exit, left.effect, R1.exit, O.exit, again.effect, O.entry, L1.entry, R1.entry",
    ]


def test_fork_enters_its_targets_and_the_rest_by_default() -> None:
    chart = beside(
        "leave: {from: O, to: Z, on: Leave}",
        "go: {from: Z, to: K, on: Go}",
        "right: {from: K, to: R2}",
        "left: {from: K, to: L2}",
        more="K: {kind: fork}",
    )
    assert steps(chart, "5 Leave", "15 Go")[2:] == [
        "20 Z.exit, go.effect, O.entry, left.effect, L2.entry, right.effect, R2.entry",
    ]


def test_join_waits_for_all_its_sources() -> None:
    chart = beside(
        "left: {from: L1, to: L2, on: Left}",
        "right: {from: R1, to: R2, on: Right}",
        "from_right: {from: R2, to: N}",
        "from_left: {from: L2, to: N}",
        "joined: {from: N, to: Z}",
        more="N: {kind: join}",
    )
    assert steps(chart, "5 Right", "35 Left")[2:] == [
        "40 L1.exit, left.effect, L2.entry",
        "50 L2.exit, R2.exit, O.exit, from_right.effect, from_left.effect, joined.effect, Z.entry",
    ]


def test_choice_in_one_region_is_left_after_all_regions_are_entered() -> None:
    chart = beside(
        "leave: {from: O, to: Z, on: Leave}",
        "go: {from: Z, to: P, on: Go}",
        "one: {from: P, to: L2, guard: x = 0}",
        "other: {from: P, to: L1, guard: else}",
        left=", P: {kind: choice}",
    )
    assert steps(chart, "5 Leave", "15 Go")[2:] == [
        "20 Z.exit, go.effect, O.entry, R1.entry, one.effect, L2.entry",
    ]


def test_local_transition_leaves_one_region_only() -> None:
    chart = beside(
        "inside: {from: O, to: R2, on: Go, local: true}",
        "left: {from: L1, to: L2, on: Left}",
    )
    assert steps(chart, "5 Left", "15 Go")[2:] == ["20 R1.exit, inside.effect, R2.entry"]


def test_terminate_stops_without_further_exits() -> None:
    chart = """
    initial: A
    states: {A: {initial: B, states: {B: {}, X: {kind: terminate}}}, C: {}}
    transitions: {stop: {from: B, to: X, on: Go}, leave: {from: A, to: C, on: Leave}}
    """
    assert steps(chart, "5 Go", "15 Leave")[1:] == ["10 B.exit, stop.effect"]


def test_deep_history_restores_every_region_that_has_a_past() -> None:
    chart = """
    initial: M
    states:
      Away: {}
      M:
        initial: O
        states:
          O:
            regions:
              Left: {initial: L1, states: {L1: {}, L2: {}}}
              Right: {initial: R1, states: {R1: {}, R_End: {kind: final}}}
          H: {kind: deep_history}
    transitions:
      left: {from: L1, to: L2, on: Go}
      right: {from: R1, to: R_End, on: Go}
      leave: {from: M, to: Away, on: Leave}
      back: {from: Away, to: H, on: Back}
    """
    assert steps(chart, "5 Go", "15 Leave", "25 Back")[-1] == (
        "30 Away.exit, back.effect, M.entry, O.entry, L2.entry, R1.entry"
    )
