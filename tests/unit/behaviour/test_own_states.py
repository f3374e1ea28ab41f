# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Guards that ask for states of their own region: which may be, and what they read in a step."""

from __future__ import annotations

import pytest

from ravenchart.behaviour.rules import findings
from ravenchart.gen.pipeline import Loaded
from tests.support.pump import loaded

MODEL = """
system: Own
components:
  Unit:
    events: {{Go: {{}}, Stop: {{}}}}
    regions:
      Main:
        period: 10 ms
        wcet: 1 us
        queue: 2
        initial: A
        states:
          A: {{}}
          C: {{initial: C1, states: {{C1: {{}}, C2: {{}}}}}}
          O:
            regions:
              P:
                initial: P1
                states:
                  P1: {{}}
                  {more}
                  P2: {{initial: P21, states: {{P21: {{}}, P22: {{}}}}}}
                  P3:
                    regions:
                      X: {{initial: X1, states: {{X1: {{}}, X2: {{}}}}}}
                      Y: {{initial: Y1, states: {{Y1: {{}}, Y2: {{}}}}}}
              Q: {{initial: Q1, states: {{Q1: {{}}, Q2: {{}}}}}}
        transitions:
          enter: {{from: A, to: O, on: Stop}}
          down: {{from: P1, to: P3, on: Stop}}
          over: {{from: P1, to: P2, after: 40 ms}}
          inner: {{from: P21, to: P22, on: Stop}}
          xs: {{from: X1, to: X2, on: Stop}}
          ys: {{from: Y1, to: Y2, on: Stop}}
          qs: {{from: Q1, to: Q2, on: Stop}}
          cs: {{from: C1, to: C2, on: Stop}}
          away: {{from: O, to: C, after: 1 s}}
          {lines}
nodes: {{board: {{context_switch: 1 us, critical_section: 1 us}}}}
instances: {{one: {{component: Unit, node: board}}}}
processors: {{work: {{node: board, stack: 16 KiB, activities: [one.Main]}}}}
shutdown: {{raises: [], grace: 0 ms}}
"""
IN_P = {"P1", "P2", "P21", "P22", "P3", "X1", "X2", "Y1", "Y2"}
STATES = ("A", "C", "C1", "C2", "O", *sorted(IN_P), "Q1", "Q2")
OPEN = {
    "A": set(),
    "C": set(),
    "C1": set(),
    "O": IN_P | {"Q1", "Q2"},
    "P1": {"Q1", "Q2"},
    "P22": {"Q1", "Q2"},
    "P3": {"X1", "X2", "Y1", "Y2", "Q1", "Q2"},
    "X1": {"Y1", "Y2", "Q1", "Q2"},
    "Y2": {"X1", "X2", "Q1", "Q2"},
    "Q1": IN_P,
}
"""For a source the states that it leaves open."""
CODE = "RV-0416"


def model(*lines: str, more: str = "") -> Loaded:
    """The model with these transitions as well, and perhaps a vertex beside P1."""
    return loaded(MODEL.format(lines="\n          ".join(lines), more=more))


def told(*lines: str, more: str = "") -> list[str]:
    """The codes of all its errors."""
    return [one.code for one in model(*lines, more=more).diagnostics if one.is_error]


@pytest.mark.parametrize("source", OPEN)
def test_a_guard_asks_for_what_its_source_leaves_open(source: str) -> None:
    for state in STATES:
        for key in ("on: Go, guard", "when"):
            line = f"asks: {{from: {source}, to: A, {key}: in(Main.{state})}}"
            assert told(line) == ([] if state in OPEN[source] else [CODE]), (state, key)


def test_nothing_is_asked_while_a_step_fires() -> None:
    asks = "[{if: in(Main.Q1), then: [{raise: Go}]}]"
    assert told(f"acts: {{from: P1, to: P2, on: Go, effect: {asks}}}") == [CODE]
    ways = (
        "start: {from: P1, to: J, on: Go}",
        "way: {from: J, to: P2, guard: in(Main.Q1)}",
        "rest: {from: J, to: P1, guard: else}",
    )
    assert told(*ways, more="J: {kind: choice}") == [CODE]
    assert told(*ways, more="J: {kind: junction}") == []


def test_what_is_refused_says_what_to_write_instead() -> None:
    def hint(line: str) -> str | None:
        (one,) = (d for d in model(line).diagnostics if d.code == CODE)
        return one.hint

    assert hint("asks: {from: P1, to: A, on: Go, guard: in(Main.P2)}") == (
        "write the transition `from` that state"
    )
    assert hint("asks: {from: P1, to: A, on: Go, effect: [{if: in(Main.Q1), then: []}]}") == (
        "set a data item in `entry` and `exit` of Q1, and read that"
    )


def found(*lines: str) -> list[str]:
    """What the rules of behaviour say of the model with these transitions, by code."""
    system = model(*lines).system
    assert system is not None
    return [one.code for one in findings(system)]


def test_what_no_configuration_allows_is_found() -> None:
    """All regions hear `Stop` at once: with X2 there is Y2, and neither Y1 nor P22."""
    line = "asks: {from: Q2, to: Q1, when: in(Main.%s) and in(Main.X2)}"
    assert [found(line % state) for state in ("Y2", "Y1", "P22")] == [[], ["RV-1102"], ["RV-1102"]]
