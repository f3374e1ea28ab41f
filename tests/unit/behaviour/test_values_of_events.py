# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Events with values of several types: each value has the range of its own event."""

from __future__ import annotations

import pytest

from tests.support.behaviour_models import model, region, said

EVENTS = "{Chosen: {type: Mode, external: true}, Given: {type: Level, external: true}}"
MODES = 3
"""Values of `Mode`: fewer than a `Level` has."""


def _counted(never: str, guard: str = "true") -> list[str]:
    transitions = (
        "choose: {from: A, to: A, on: Chosen, guard: event = Automatic}\n"
        f"give: {{from: A, to: B, on: Given, guard: {guard}, effect: [{{set: count, to: event}}]}}"
    )
    main = region("Main", "{A: {}, B: {}}", transitions)
    return said(model(main, events=EVENTS, never=f'{{large: "{never}"}}', outside=""))


@pytest.mark.parametrize("value", [0, MODES - 1, MODES, 100])
def test_a_value_out_of_the_range_of_another_event_is_found(value: int) -> None:
    (found,) = _counted(f"count = {value} and in(Main.B)")
    assert found.startswith("RV-1108"), found


def test_a_value_out_of_its_own_range_is_excluded() -> None:
    assert not _counted("in(Main.B) and count > 40", guard="event <= 40")


def test_a_guard_beyond_the_range_of_another_event_can_hold() -> None:
    transitions = (
        "choose: {from: A, to: A, on: Chosen, guard: event = Automatic}\n"
        "give: {from: A, to: B, on: Given, guard: event > %s}"
    )
    for limit, reached in ((MODES, True), (99, True), (100, False)):
        text = region("Main", "{A: {}, B: {}}", transitions % limit)
        findings = said(model(text, events=EVENTS, outside=""))
        assert any(one.startswith("RV-1101") for one in findings) is not reached, findings
