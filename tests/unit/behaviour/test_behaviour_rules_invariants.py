# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Declared invariants: proved, violated with a trace, or not inductive."""

from __future__ import annotations

import pytest

from ravenchart.gen.diagnostics import Severity
from tests.support.behaviour_models import model, only, region, said

LEFT = region(
    "Left",
    "{A: {}, B: {}}",
    "go: {from: A, to: B, on: Go}\nback: {from: B, to: A, on: Stop}",
)
RIGHT = region(
    "Right",
    "{A: {}, B: {}}",
    "go: {from: A, to: B, on: Go, guard: %s}\nback: {from: B, to: A, on: Stop}",
)
NEVER_BOTH = '{both: "in(Left.B) and in(Right.B)"}'


def test_regions_that_meet_violate_the_invariant_with_a_trace() -> None:
    found = only(model(LEFT, RIGHT % "true", never=NEVER_BOTH))
    assert (found.code, found.severity) == ("RV-1108", Severity.ERROR)
    assert found.message == (
        "the invariant both of Unit is violated: "
        "Left: A; Right: A; Left: A -Go-> B; Right: A -Go-> B"
    )


def test_data_set_on_entry_violate_the_invariant() -> None:
    states = '{A: {}, B: {entry: [{set: count, to: "min(level, 60)"}]}}'
    transitions = "go: {from: A, to: B, on: Go}\nback: {from: B, to: A, on: Stop}"
    never = '{full: "in(Main.B) and count > %s"}'
    found = only(model(region("Main", states, transitions), never=never % 59))
    assert found.code == "RV-1108"
    assert found.message == "the invariant full of Unit is violated: A -Go-> B"
    assert not said(model(region("Main", states, transitions), never=never % 60))


def test_time_out_comes_before_a_longer_one() -> None:
    """Each way is possible in some order of steps; only one keeps to the time."""
    slow = region("Slow", "{A: {}, B: {}}", "go: {from: A, to: B, after: 200 ms}")
    fast = region("Fast", "{A: {}, B: {}}", "go: {from: A, to: B, after: 100 ms}")
    found = only(model(slow, fast, never='{late: "in(Slow.A) and in(Fast.B)"}'))
    assert found.code == "RV-1108"
    assert found.message.endswith("Fast: A -after 100 ms-> B")
    found = only(model(slow, fast, never='{late: "in(Slow.B) and in(Fast.A)"}'))
    assert found.code == "RV-1109"


def test_deferred_event_is_taken_once_the_state_that_defers_it_was_left() -> None:
    main = region(
        "Main",
        "{A: {}, P: {defer: [Hit]}, Q: {}}",
        "begin_it: {from: A, to: P, on: Go, effect: [{raise: Hit}]}\n"
        "hit: {from: P, to: Q, on: Hit, guard: armed}\n"
        "again: {from: P, %son: Stop, effect: [{set: armed, to: true}]}",
        head="deferred: 1\n",
    )
    options = {"events": "[Go, Stop, Hit]", "never": '{hit: "in(Main.Q)"}'}
    found = said(model(main.replace("%s", "to: P, "), **options))
    assert found[-1].startswith("RV-1108") and found[-1].endswith("P -Stop-> P -Hit-> Q")
    assert not any(
        one.startswith("RV-1108") for one in said(model(main.replace("%s", ""), **options))
    )


def test_event_raised_by_another_region_leads_on() -> None:
    sender = region(
        "Sender", "{A: {}, B: {}}", "go: {from: A, to: B, on: Go, effect: [{raise: Hit}]}"
    )
    taker = region("Taker", "{A: {}, B: {}}", "hit: {from: A, to: B, on: Hit}")
    options = {"events": "[Go, Stop, Hit]", "never": '{hit: "in(Taker.B) and %s"}'}
    found = said(model(sender, taker, **{**options, "never": options["never"] % "in(Sender.B)"}))
    assert "Taker: A -Hit-> B" in found[-1] and found[-1].startswith("RV-1108")
    never = options["never"] % "in(Sender.A)"
    found = said(model(sender, taker, **{**options, "never": never}))
    assert [f for f in found if f.startswith("RV-1108")] == []


@pytest.mark.parametrize("step", ["1", "2"])
def test_counter_that_jumps_over_a_number_is_not_inductive_but_not_violated(step: str) -> None:
    transitions = (
        "more: {from: A, to: A, on: Go, "
        f'effect: [{{set: count, to: "min(count + {step}, 90)"}}]}}\n'
        "leave: {from: A, to: B, on: Stop}"
    )
    found = only(model(region("Main", "{A: {}, B: {}}", transitions), never='{odd: "count = 5"}'))
    assert found.code == {"1": "RV-1108", "2": "RV-1109"}[step]


def test_flag_that_goes_with_a_state_is_proved() -> None:
    states = "{A: {entry: [{set: armed, to: false}]}, B: {entry: [{set: armed, to: %s}]}}"
    transitions = "go: {from: A, to: B, on: Go}\nback: {from: B, to: A, on: Stop}"
    never = '{unarmed: "in(Main.B) and not armed"}'
    assert not said(model(region("Main", states % "true", transitions), never=never))
    found = only(model(region("Main", states % "level > 3", transitions), never=never))
    assert found.code == "RV-1108"


@pytest.mark.parametrize(("period", "code"), [("10 ms", "RV-1108"), ("40 ms", "RV-1109")])
def test_a_value_stays_for_the_period_of_the_group_that_has_its_port(
    period: str, code: str
) -> None:
    """`level` is another one 40 ms later at the earliest, when Watch has left A."""
    transitions = "up: {from: A, to: B, when: level = 1}\non: {from: B, to: C, when: level = 2}"
    main = region("Main", "{A: {}, B: {}, C: {}}", transitions)
    watch = region("Watch", "{A: {}, B: {}}", "go: {from: A, to: B, after: 30 ms}")
    system = model(
        main,
        watch,
        never='{soon: "in(Main.C) and in(Watch.A)"}',
        groups=f"{{slow: {{period: {period}, wcet: 20 us, ports: [level]}}}}",
        rows="one.ports, one.slow, one.Main, one.Watch",
    )
    assert only(system).code == code
