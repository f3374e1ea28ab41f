# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules of behaviour: for each a model that shows it, and a near twin that does not."""

from __future__ import annotations

import pytest

from ravenchart.gen.diagnostics import Severity
from tests.support.behaviour_models import model, only, region, said

BOTH = "{A: {}, B: {}}"


# --- Guards ------------------------------------------------------------------------


def test_guards_that_can_both_hold_are_told_with_data_and_a_way() -> None:
    found = only(
        model(
            region(
                "Main",
                BOTH,
                "low: {from: A, to: B, on: Go, guard: level < 50}\n"
                "high: {from: A, to: A, on: Go, guard: level > 40}\n"
                "back: {from: B, to: A, on: Stop}",
            )
        )
    )
    assert (found.code, found.severity) == ("RV-1103", Severity.WARNING)
    value = int(found.message.partition("level = ")[2].partition(":")[0])
    assert 40 < value < 50
    assert [text for _, text in found.notes] == ["low is here", "the way begins with A"]


def test_guards_that_exclude_each_other_are_well() -> None:
    assert not said(
        model(
            region(
                "Main",
                BOTH,
                "low: {from: A, to: B, on: Go, guard: level <= 40}\n"
                "high: {from: A, to: A, on: Go, guard: level > 40}\n"
                "back: {from: B, to: A, on: Stop}",
            )
        )
    )


def test_transition_without_guard_after_another_is_the_rest() -> None:
    assert not said(
        model(
            region(
                "Main",
                BOTH,
                "low: {from: A, to: B, on: Go, guard: level < 50}\n"
                "rest: {from: A, to: A, on: Go}\n"
                "back: {from: B, to: A, on: Stop}",
            )
        )
    )


def test_guards_of_different_events_may_both_hold() -> None:
    assert not said(
        model(
            region(
                "Main",
                BOTH,
                "low: {from: A, to: B, on: Go, guard: level < 50}\n"
                "high: {from: A, to: B, on: Stop, guard: level > 40}\n"
                "back: {from: B, to: A, on: Stop}",
            )
        )
    )


def test_guards_that_only_unreachable_data_let_both_hold_are_well() -> None:
    assert not said(
        model(
            region(
                "Main",
                "{A: {entry: [{set: armed, to: false}]}, B: {entry: [{set: armed, to: true}]}}",
                "arm: {from: A, to: B, on: Go, guard: not armed}\n"
                "late: {from: A, to: B, on: Stop}\n"
                "off: {from: B, to: A, on: Go, guard: armed}\n"
                "keep: {from: B, on: Stop, guard: armed}",
            )
        )
    )


def test_second_transition_that_never_gets_its_turn_is_an_error() -> None:
    found = only(
        model(
            region(
                "Main",
                BOTH,
                "low: {from: A, to: B, on: Go, guard: level < 50}\n"
                "lower: {from: A, to: A, on: Go, guard: level < 10}\n"
                "back: {from: B, to: A, on: Stop}",
            )
        )
    )
    assert (found.code, found.severity) == ("RV-1102", Severity.ERROR)
    assert found.message == "lower is never taken: low always comes before it"


def test_guard_that_no_data_meet_is_an_error() -> None:
    transitions = (
        "go: {from: A, to: B, on: Go, guard: level > %s and level / 2 < 30}\n"
        "back: {from: B, to: A, on: Stop}\n"
        "there: {from: A, to: B, on: Stop}"
    )
    found = only(model(region("Main", BOTH, transitions % 60)))
    assert found.code == "RV-1102"
    assert found.message == "go is never taken: its guard never holds in A"
    assert not said(model(region("Main", BOTH, transitions % 58)))


def test_division_rounds_towards_zero() -> None:
    guard = "(level - 50) / 7 = -7 and level %s 1"
    twin = "go: {from: A, to: B, on: Go, guard: %s}\nback: {from: [B], to: A, on: Stop}"
    twin = twin.replace("[B]", "B") + "\nthere: {from: A, to: B, on: Stop}"
    assert not said(model(region("Main", BOTH, twin % (guard % "="))))
    assert said(model(region("Main", BOTH, twin % (guard % ">"))))


# --- Reachability ------------------------------------------------------------------


def test_state_behind_data_that_never_come_is_an_error() -> None:
    states = "{A: {entry: [{set: count, to: %s}]}, B: {}, C: {}}"
    transitions = (
        "go: {from: A, to: B, on: Go}\n"
        "onward: {from: B, to: C, on: Go, guard: count = 7}\n"
        "back: {from: B, to: A, on: Stop}\n"
        "home: {from: C, to: A, on: Stop}"
    )
    assert said(model(region("Main", states % 6, transitions))) == [
        "RV-1101 error: the state C of Main is never entered, whatever the data",
    ]
    assert not said(model(region("Main", states % 7, transitions)))


def test_state_waits_for_a_state_that_another_region_never_has() -> None:
    other = region("Other", BOTH, "go: {from: A, to: B, on: Go, guard: level %s 100}")
    main = region("Main", BOTH, "see: {from: A, to: B, when: in(Other.B)}")
    assert [d[:7] for d in said(model(main, other % ">"))] == ["RV-1101", "RV-1101"]
    assert not said(model(main, other % "="))


def test_event_of_a_completed_state_never_comes() -> None:
    transitions = "done: {from: A, to: B%s}\nback: {from: B, to: A, on: Stop}\n"
    transitions += "late: {from: A, to: A, on: Go}"
    found = only(model(region("Main", BOTH, transitions % "")))
    assert found.code == "RV-1102"
    assert found.message == "late is never taken: A is left at once, as it is complete when entered"
    assert not said(model(region("Main", BOTH, transitions % ", guard: level > 3")))


# --- Choices -----------------------------------------------------------------------

CHOICE = "{A: {}, P: {kind: choice}, B: {}}"


def test_choice_that_can_get_stuck_is_an_error_with_data() -> None:
    transitions = (
        "go: {from: A, to: P, on: Go}\n"
        "high: {from: P, to: B, guard: level > 5}\n"
        "low: {from: P, to: A, guard: level < %s}\n"
        "back: {from: B, to: A, on: Stop}"
    )
    found = only(model(region("Main", CHOICE, transitions % 5)))
    assert (found.code, found.severity) == ("RV-1104", Severity.ERROR)
    assert found.message == "Main may get stuck in P: no segment leaves it with level = 5"
    assert [text for _, text in found.notes] == ["the way begins with A", "then A -Go-> P"]
    assert not said(model(region("Main", CHOICE, transitions % 6)))


def test_choice_reads_what_the_effect_before_it_has_set() -> None:
    transitions = (
        "go: {from: A, to: P, on: Go, effect: [{set: count, to: %s}]}\n"
        "high: {from: P, to: B, guard: count > 5}\n"
        "back: {from: B, to: A, on: Stop}"
    )
    assert not said(model(region("Main", CHOICE, transitions % 6)))
    assert only(model(region("Main", CHOICE, transitions % '"min(level, 9)"'))).code == "RV-1104"


def test_junction_without_way_out_disables_its_transition() -> None:
    states = CHOICE.replace("choice", "junction")
    assert not said(
        model(
            region(
                "Main",
                states,
                "go: {from: A, to: P, on: Go}\n"
                "high: {from: P, to: B, guard: level > 5}\n"
                "back: {from: B, to: A, on: Stop}",
            )
        )
    )


# --- Livelock ----------------------------------------------------------------------


def test_completions_in_a_circle_are_an_error() -> None:
    transitions = "there: {from: A, to: B}\nback: {from: B, to: A%s}"
    found = only(model(region("Main", BOTH, transitions % "")))
    assert (found.code, found.severity) == ("RV-1107", Severity.ERROR)
    assert found.message == (
        "livelock in Main: a cycle without event or time-out: A -there-> B -back-> A"
    )
    assert not said(model(region("Main", BOTH, transitions % ", on: Stop")))


def test_conditions_in_a_circle_are_a_warning() -> None:
    transitions = "up: {from: A, to: B, when: level > 5}\ndown: {from: B, to: A, when: level < %s}"
    found = only(model(region("Main", BOTH, transitions % 10)))
    assert (found.code, found.severity) == ("RV-1107", Severity.WARNING)
    assert "A -up-> B -down-> A" in found.message
    assert not said(model(region("Main", BOTH, transitions % 6)))


def test_condition_that_its_effect_ends_does_not_go_on() -> None:
    transitions = (
        "beat: {from: A, to: A, when: count < 50, effect: [{set: count, to: %s}]}\n"
        "leave: {from: A, to: B, on: Go}"
    )
    assert only(model(region("Main", BOTH, transitions % "0"))).code == "RV-1107"
    assert not said(model(region("Main", BOTH, transitions % '"min(count + 1, 50)"')))


# --- Events and the safe state -------------------------------------------------------


def test_state_that_alone_ignores_an_event_is_told() -> None:
    states = "{A: {}, B: {%s}, C: {}, D: {}}"
    transitions = (
        "ab: {from: A, to: B, on: Stop}\nbc: {from: B, to: C, after: 1 s}\n"
        "cd: {from: C, to: D, on: Go}\nda: {from: D, to: A, on: Go}\nstay: {from: A, on: Go}"
    )
    assert said(model(region("Main", states % "", transitions))) == [
        "RV-1105 warning: B ignores Go, which A, C and D expect"
    ]
    deferring = region("Main", states % "defer: [Go]", transitions, head="deferred: 2\n")
    assert not said(model(deferring))


def test_safe_state_behind_a_guard_that_never_holds_is_an_error() -> None:
    states = "{A: {entry: [{set: count, to: 1}]}, B: {entry: [{set: count, to: %s}]}, C: {}}"
    transitions = (
        "ab: {from: A, to: B, on: Go}\n"
        "ac: {from: A, to: C, on: Stop}\n"
        "bc: {from: B, to: C, on: Stop, guard: count = 1}"
    )
    safe = "safe_state: C\n"
    found = said(model(region("Main", states % 2, transitions, head=safe)))
    assert found == [
        "RV-1106 error: no way leads from B to C, the safe state of Main",
        "RV-1102 error: bc is never taken: its guard never holds in B",
    ]
    assert not said(model(region("Main", states % 1, transitions, head=safe)))


# --- Regions without a plain state -------------------------------------------------


@pytest.mark.parametrize(
    "inside",
    [
        "initial: F, states: {F: {kind: final}}",
        "initial: C, states: {C: {initial: F, states: {F: {kind: final}}}}",
        "initial: F, states: {F: {kind: final}, E: {kind: terminate}}",
        "regions: {L: {initial: F, states: {F: {kind: final}}}, R: {initial: Q, states: {Q: {}}}}",
    ],
)
def test_region_without_a_plain_state_is_looked_at(inside: str) -> None:
    leads = "go: {from: A, to: B, on: Go}\nback: {from: B, to: A, on: Stop}"
    if "terminate" in inside:
        leads += "\nstop: {from: A, to: E, on: Stop}"
    assert not said(model(region("Main", f"{{A: {{}}, B: {{{inside}}}}}", leads)))


# --- What another region keeps from firing -----------------------------------------


def test_deferral_in_another_region_is_the_reason_that_is_named() -> None:
    states = (
        "{O: {regions: {Left: {initial: L, states: {L: {}, M: {}}}, "
        "Right: {initial: R, states: {R: {%s}}}}}}"
    )
    transitions = (
        "go: {from: L, to: M, on: Go}\nover: {from: L, to: M, on: Stop}\n"
        "back: {from: M, to: L, on: Stop}"
    )
    defers = model(
        region("Main", states % "defer: [Go]", transitions, head="deferred: 1\n", initial="O")
    )
    found = only(defers)
    assert found.code == "RV-1102"
    assert found.message == "go is never taken: while L is active, R defers the event"
    assert not said(model(region("Main", states % "", transitions, initial="O")))


REGIONS = (
    "{O: {regions: {Left: {initial: L, states: {L: {%s}%s}}, "
    "Right: {initial: R, states: {R: {}, S: {}}}}}, Away: {}}"
)
"""Two regions; what L has besides, and what is beside it."""
ROUND = "leave: {from: O, to: Away, on: Stop}\nenter: {from: Away, to: O, on: Stop}\n"


def test_reason_is_named_where_a_transition_would_lead_to_a_state_that_is_never_entered() -> None:
    moves = ROUND + "go: {from: R, to: S, on: Go}\n"
    states = REGIONS % ("defer: [Go]", "")
    found = only(model(region("Main", states, moves, head="deferred: 1\n", initial="O")))
    assert found.code == "RV-1101"
    reason = "go leads to it, but is never taken: while R is active, L defers the event"
    assert [text for _, text in found.notes] == [reason, "L is here"]
    assert found.hint == "remove `defer` from L, or remove S"
    assert not said(model(region("Main", REGIONS % ("", ""), moves, initial="O")))


@pytest.mark.parametrize(
    ("beside", "to", "reason"),
    [
        (", T: {kind: terminate}", "T", "stop_it is taken before it and ends the region"),
        (", C: {kind: choice}", "C", "it conflicts with stop_it"),
    ],
)
def test_region_that_ends_or_is_left_behind_a_choice_is_the_reason(
    beside: str, to: str, reason: str
) -> None:
    moves = f"stop_it: {{from: L, to: {to}, on: Go}}\nturn: {{from: R, on: Go}}\n"
    moves += "on_again: {from: R, to: S, on: Stop}\nback: {from: S, to: R, on: Stop}\n"
    moves += "away: {from: O, to: Away, after: 1 s}\n"
    if to == "C":
        moves += "lead: {from: C, to: Away, guard: else}\n"
    found = only(model(region("Main", REGIONS % ("", beside), moves, initial="O")))
    assert found.message == f"turn is never taken: {reason}"
    assert [text for _, text in found.notes] == ["stop_it of an earlier region is taken"]


@pytest.mark.parametrize(
    ("inside", "moves", "reason", "hint"),
    [
        ("defer: [Go]", "", "S defers the event", "remove `defer` from S, or remove go"),
        ("", "stay: {from: S, on: Go}\n", "stay is taken first", "change the guard of stay"),
    ],
)
def test_state_inside_that_takes_the_event_is_the_reason(
    inside: str, moves: str, reason: str, hint: str
) -> None:
    states = f"{{A: {{initial: S, states: {{S: {{{inside}}}}}}}, Away: {{}}}}"
    moves += "go: {from: A, to: Away, on: Go}\nleave: {from: A, to: Away, on: Stop}\n"
    moves += "back: {from: Away, to: A, on: Go}\n"
    found = only(model(region("Main", states, moves, head="deferred: 1\n" if inside else "")))
    assert found.message == f"go is never taken: while A is active, {reason}"
    assert found.hint is not None and found.hint.startswith(hint)


def test_lost_conflict_is_named_with_what_removal_would_do() -> None:
    states = (
        "{O: {regions: {Left: {initial: L, states: {L: {}, M: {}}}, "
        "Right: {initial: R, states: {R: {}, S: {}}}}}, Away: {}}"
    )
    transitions = (
        "turn: {from: L, to: L, on: Go}\nleave: {from: R, to: Away, on: Go}\n"
        "other: {from: R, to: S, on: Stop}\nback: {from: S, to: R, on: Stop}\n"
        "on_again: {from: L, to: M, on: Stop}\nhome: {from: M, to: L, on: Go}\n"
        "away: {from: O, to: Away, after: 20 ms}"
    )
    found = only(model(region("Main", states, transitions, initial="O")))
    assert found.code == "RV-1102"
    assert found.message == "leave is never taken: it conflicts with turn and home"
    assert found.hint is not None and "takes its place" in found.hint
