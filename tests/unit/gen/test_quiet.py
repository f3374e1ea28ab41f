# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Which models have conditions that the compiler decides, and warns of."""

from __future__ import annotations

import pytest

from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.system import System
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
GUARDED = """
events: [Go]
data: {count: {type: Small, initial: 3}}
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 2
    initial: A
    states: {A: {}, B: {}}
    transitions:
      go: {from: A, to: B, on: Go, guard: "GUARD"}
      back: {from: B, to: A, on: Go, effect: [{set: count, to: "min(count + 1, 9)"}]}
"""
OUTSIDE = ("\n      Rest: {}", "\n      rest: {from: Whole, to: Rest, after: 1 s}")


def _silent(system: System, unit: str) -> str:
    """The lines of a unit that switch warnings off."""
    text = generate(system, Claims())[unit]
    return "\n".join(line for line in text.splitlines() if "pragma Warnings (Off" in line)


@pytest.mark.parametrize(
    ("more", "state", "decided"),
    [(("", ""), "Whole", True), (("", ""), "A", False), (OUTSIDE, "Whole", False)],
)
def test_who_asks_for_a_state_around_everything_is_silenced(
    more: tuple[str, str], state: str, decided: bool
) -> None:
    system = component_system(PART % (*more, state), "[unit.Main, unit.work]")
    assert ("membership" in _silent(system, "interpreted-unit.adb")) == decided


@pytest.mark.parametrize(
    ("guard", "words"),
    [
        ("count > 0", ""),
        ("count >= 0", "can * be"),
        ("count > 9", "can * be"),
        ("count <= 0", "can * be"),
        ("count = 9", ""),
        ("count + 1 > 0", "can * be"),
        ("max(count, 3) > 2", ""),
        ("abs(count - 5) > -1", "always"),
    ],
)
def test_a_guard_that_ranges_decide_silences_the_spec_alone(guard: str, words: str) -> None:
    text = GUARDED.replace("GUARD", guard)
    system = component_system(text, "[unit.Main]")
    spec = _silent(system, "interpreted-part-main.ads")
    assert (words in spec) if words else not spec
    assert not _silent(system, "interpreted-part-main.adb")
