# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Which models have conditions that the compiler decides, and warns of."""

from __future__ import annotations

import pytest

from ravenchart.gen.emit.language.quiet import words_of_system
from tests.support.interpreted import component_system

PART = """
events: [Go]
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 2
    initial: Whole
    states:
      Whole: {initial: A, states: {A: {}, B: {}}}%s
    transitions:
      go: {from: A, to: B, on: Go}
      back: {from: B, to: A, on: Go}%s
activities:
  work: {period: 10 ms, wcet: 1 us, while: Main.%s, body: [{raise: Go}]}
"""
OUTSIDE = ("\n      Rest: {}", "\n      rest: {from: Whole, to: Rest, after: 1 s}")


@pytest.mark.parametrize(
    ("more", "state", "decided"),
    [(("", ""), "Whole", True), (("", ""), "A", True), (OUTSIDE, "Whole", False)],
)
def test_state_around_everything_is_always_active(
    more: tuple[str, str], state: str, decided: bool
) -> None:
    system = component_system(PART % (*more, state), "[unit.Main, unit.work]")
    assert ("'Valid attribute" in words_of_system(system)) == decided
