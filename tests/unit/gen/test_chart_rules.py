# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules of complete charts: what a step sends, what is reached, what is in another's way."""

from __future__ import annotations

import pytest

from tests.support.chart_models import chart_text, found
from tests.support.pump import loaded

# --- What one step sends -----------------------------------------------------------

TOLD = "ports:\n  told: {out: Distance}\n"
SEND = "[{send: told, with: 1}]"
SIDES = """\
A: {}
Both:
  regions:
    Left: {initial: L1, states: {L1: {}, L2: {}}}
    Right: {initial: R1, states: {R1: {}, R2: {}}}
"""
GO = "go: {from: A, to: Both, on: Go}\n"


def sends_twice(states: str, transitions: str) -> bool:
    """Whether a step of the chart may send twice; nothing else is wrong with it."""
    text = chart_text(states, transitions, more=TOLD)
    errors = [item for item in loaded(text).diagnostics if item.is_error]
    assert {item.code for item in errors} <= {"RV-0413"}, errors
    return bool(errors)


def test_regions_that_fire_on_one_event_send_together() -> None:
    right = "right: {from: R1, to: R2, on: Stop, effect: %s}\nback: {from: Both, to: A, on: Go}\n"
    left = "left: {from: L1, to: L2, on: %s, effect: %s}\n"
    assert sends_twice(SIDES, GO + right % SEND + left % ("Stop", SEND))
    assert not sends_twice(SIDES, GO + right % SEND + left % ("Go", SEND))


def test_firing_that_leaves_the_state_excludes_those_inside() -> None:
    right = f"right: {{from: R1, to: R2, on: Stop, effect: {SEND}}}\n"
    leave = f"leave: {{from: L1, to: A, on: Stop, effect: {SEND}}}\n"
    assert not sends_twice(SIDES, GO + right + leave + "turn: {from: L1, to: L2, on: Go}\n")


def test_transition_of_a_state_is_not_counted_with_those_inside() -> None:
    inner = f"left: {{from: L1, to: L2, on: Stop, effect: {SEND}}}\n"
    inner += "right: {from: R1, to: R2, on: Stop}\n"
    outer = f"leave: {{from: Both, to: A, on: Stop, effect: {SEND}}}\n"
    assert not sends_twice(SIDES, GO + inner + outer)


def test_exits_of_the_regions_beside_are_counted() -> None:
    states = SIDES.replace("R2: {}", f"R2: {{exit: {SEND}}}")
    moves = "right: {from: R1, to: R2, on: Go}\nturn: {from: L1, to: L2, on: Go}\n"
    leave = "leave: {from: L1, to: A, on: Stop, effect: %s}\n"
    assert sends_twice(states, GO + moves + leave % SEND)
    assert not sends_twice(states, GO + moves + leave % "[]")


@pytest.mark.parametrize("kind", ["history", "deep_history"])
def test_what_a_history_restores_is_counted(kind: str) -> None:
    inside = f"D: {{}}, E: {{entry: {SEND}}}, H: {{kind: {kind}}}"
    states = f"A: {{}}\nC: {{initial: D, states: {{{inside}}}}}\n"
    moves = "inner: {from: D, to: E, on: Go}\nleave: {from: C, to: A, on: Stop}\n"
    back = "back: {from: A, to: H, on: Go, effect: %s}\n"
    assert sends_twice(states, moves + back % SEND)
    assert not sends_twice(states, moves + back % "[]")


def test_what_is_behind_a_choice_is_counted() -> None:
    states = f"A: {{}}\nP: {{kind: choice}}\nB: {{entry: {SEND}}}\n"
    moves = "t: {from: A, to: P, on: Go, effect: %s}\nu: {from: P, to: A, guard: place > 3}\n"
    moves += "v: {from: P, to: B, guard: else}\nback: {from: B, to: A, on: Stop}\n"
    assert sends_twice(states, moves % SEND)
    assert not sends_twice(states, moves % "[]")


def test_branches_of_a_choice_are_not_added() -> None:
    states = f"A: {{}}\nP: {{kind: choice}}\nB: {{entry: {SEND}}}\n"
    moves = (
        f"t: {{from: A, to: P, on: Go}}\nu: {{from: P, to: A, guard: place > 3, effect: {SEND}}}\n"
    )
    moves += "v: {from: P, to: B, guard: else}\nback: {from: B, to: A, on: Stop}\n"
    assert not sends_twice(states, moves)


def test_segments_of_forks_and_joins_are_counted() -> None:
    states = SIDES + "F: {kind: fork}\nJ: {kind: join}\n"
    fork = "f_0: {from: A, to: F, on: Go, effect: %s}\nf_1: {from: F, to: L2, effect: %s}\n"
    join = "j_1: {from: L2, to: J, effect: %s}\nj_2: {from: R2, to: J, effect: %s}\n"
    more = (
        "f_2: {from: F, to: R2}\nj_3: {from: J, to: A}\nagain: {from: Both, to: Both, on: Stop}\n"
    )
    more += "left: {from: L1, to: L2, on: Go}\nright: {from: R1, to: R2, on: Go}\n"
    assert sends_twice(states, fork % (SEND, SEND) + join % ("[]", "[]") + more)
    assert sends_twice(states, fork % ("[]", "[]") + join % (SEND, SEND) + more)
    assert not sends_twice(states, fork % (SEND, "[]") + join % (SEND, "[]") + more)


def test_initial_effects_are_counted() -> None:
    states = f"A: {{initial: {{to: B, effect: {SEND}}}, states: {{B: {{entry: %s}}}}}}\n"
    moves = "t: {from: B, on: Go, effect: []}\nu: {from: B, on: Stop, effect: []}\n"
    assert sends_twice(states % SEND, moves)
    assert not sends_twice(states % "[]", moves)


def test_raises_of_all_regions_count_together() -> None:
    many = "[" + ", ".join(["raise: Stop"] * 9) + "]"
    moves = GO + f"left: {{from: L1, to: L2, on: Stop, effect: {many}}}\n"
    moves += "back: {from: Both, to: A, on: Go}\nright: {from: R1, to: R2, on: %s, effect: %s}\n"
    assert [code for code, _ in found(chart_text(SIDES, moves % ("Stop", many)))] == ["RV-0530"]
    assert found(chart_text(SIDES, moves % ("Go", many))) == []


# --- What is reached ---------------------------------------------------------------


def unreached(states: str, transitions: str, **more: str) -> list[str]:
    """The vertices that nothing leads to."""
    text = chart_text(states, transitions, **more)
    errors = [item for item in loaded(text).diagnostics if item.is_error]
    assert {item.code for item in errors} <= {"RV-0505"}, errors
    return [item.message.split(" of Motion")[0].split()[-1] for item in errors]


def test_fork_enters_a_region_beside_its_initial_state() -> None:
    states = SIDES + "F: {kind: fork}\n"
    moves = "f_0: {from: A, to: F, on: Go}\nf_1: {from: F, to: L2}\nf_2: {from: F, to: R2}\n"
    moves += "left: {from: L1, to: L2, on: Go}\nright: {from: R2, to: R1, on: Stop}\n"
    assert unreached(states, moves) == ["L1"]


def test_join_leads_on_only_when_all_its_sources_are_reached() -> None:
    states = SIDES + "J: {kind: join}\nZ: {}\n"
    join = "j_1: {from: L2, to: J}\nj_2: {from: R2, to: J}\nj_3: {from: J, to: Z}\n"
    left = "left: {from: L1, to: L2, on: Stop}\n"
    right = "right: {from: R1, to: R2, on: Stop}\n"
    assert unreached(states, GO + join + left + right) == []
    assert unreached(states, GO + join + left) == ["R2", "Z"]


def test_deep_history_enters_by_default_what_had_ended() -> None:
    states = """\
A: {}
C:
  initial: {to: D2}
  states:
    D: {initial: D1, states: {D1: {}, D2: {}, Over: {kind: final}}}
    H: {kind: %s}
"""
    moves = "t: {from: D2, to: Over, on: Go}\nu: {from: C, to: A, on: Stop}\n"
    moves += "v: {from: A, to: %s, on: Go}\n"
    assert unreached(states % "deep_history", moves % "H") == []
    assert unreached(states % "history", moves % "H") == []
    assert unreached(states % "history", moves % "C") == ["D1", "H"]


def test_completion_comes_only_when_a_final_state_is_reached() -> None:
    states = "A: {initial: B, states: {B: {}, C: {}, Over: {kind: final}}}\nZ: {}\n"
    moves = "t: {from: A, to: Z}\nu: {from: C, to: Over, on: Go}\nv: {from: Z, to: %s, on: Stop}\n"
    assert unreached(states, moves % "C") == ["C", "Z"]
    assert unreached(states, moves % "C" + "w: {from: B, to: C, on: Go}\n") == []


def test_safe_state_may_be_reached_by_a_region_beside() -> None:
    leave = "leave: {from: R2, to: A, on: Stop}\n"
    moves = GO + "left: {from: L1, to: L2, on: Go}\nright: {from: R1, to: R2, on: Go}\n"
    region = "initial: A\nqueue: 4\nsafe_state: A"
    assert found(chart_text(SIDES, moves + leave, region=region)) == []
    stuck = found(
        chart_text(SIDES, moves + "on_stop: {from: L1, on: Stop, effect: []}\n", region=region)
    )
    assert [message for _, message in stuck] == ["no way leads from L1 to A, the safe state"]


def test_regions_agree_when_only_their_state_leaves() -> None:
    moves = GO + "left: {from: L1, to: L2, on: Stop}\nright: {from: R1, to: R2, on: Stop}\n"
    assert found(chart_text(SIDES, moves + "back: {from: Both, to: A, on: Stop}\n")) == []
    conflict = found(chart_text(SIDES, moves + "back: {from: R2, to: A, on: Stop}\n"))
    assert conflict == [("RV-0529", "on Stop, back leaves Both while left is taken in it")]
