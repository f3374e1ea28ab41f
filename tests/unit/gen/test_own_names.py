# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names that generated code has of its own are free for what a model names."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from ravenchart.gen.diagnostics import Severity
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.program import program
from ravenchart.gen.language.names import RESERVED
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.pipeline import load
from tests.support.compiled import complaints
from tests.support.interpreted import system_of
from tests.support.modes import MODES

Written = Callable[[tuple[str, ...]], str]

MODEL = """\
system: Named
types:
  Count: {range: [0, 1_000]}
components:
  Part:
    events: [Go_On, Bye, Back, Order, Ready]
    data:
      level: {type: Count, initial: 0}
      turns: {type: Count, initial: 0}
    activities:
      work: {period: 10 ms, wcet: 10 us, while: Plain.Second, body: [{raise: done}]}
    regions:
      Subject:
        period: 10 ms
        wcet: 10 us
        queue: 4
        deferred: 2
        initial: Idle
        states:
          Idle: {defer: [Order]}
          Both:
            regions:
              Left:
                initial: L1
                states:
                  L1: {}
                  L2: {entry: [{set: level, to: "min(level + 1, 100)"}], exit: [{raise: Ready}]}
              Right:
                initial: R1
                states:
                  R1: {}
                  R2: {initial: R3, states: {R3: {}, R4: {}, Deeply: {kind: deep_history}}}
          Pick: {kind: choice}
          Ended: {kind: terminate}
          # more states
        transitions:
          leave: {from: Idle, to: Both, on: Go_On}
          left_on: {from: L1, to: L2, on: Order}
          right_on: {from: R1, to: Deeply, on: Order, guard: turns < 5}
          inner: {from: R3, to: R4, on: Go_On}
          away: {from: R2, to: R1, on: Back}
          turn: {from: Both, to: Pick, on: Bye}
          low: {from: Pick, to: Idle, guard: level > 3}
          high: {from: Pick, to: Both, guard: else}
          finish: {from: Both, to: Ended, on: Back}
          slow: {from: L2, to: L1, after: 50 ms}
          # more transitions
      Plain:
        period: 10 ms
        wcet: 10 us
        queue: 4
        initial: First
        states:
          First: {}
          Second: {}
          # more states
        transitions:
          forth: {from: First, to: Second, on: Ready, effect: [{set: turns, to: "9"}]}
          readily: {from: Second, to: First}
          # more transitions
nodes: {board: {context_switch: 1 us, critical_section: 1 us}}
instances: {unit: {component: Part, node: board}}
processors:
  runner: {node: board, stack: 32 KiB, activities: [unit.Subject, unit.Plain, unit.work]}
shutdown: {raises: [unit.Go_On, unit.Bye, unit.Back, unit.Order], grace: 0 ms}
"""


@cache
def own_names() -> tuple[str, ...]:
    """Every name in the generated code of both regions that the model has not."""
    system = system_of(MODEL)
    text = "\n".join(print_unit(m.unit, m.item) for m in program(system, Claims(), system))
    found = set(re.findall(r"\b[A-Za-z]\w*", re.sub('--.*|"[^"]*"', "", text)))
    given = {ada_case(word) for name in re.findall(r"\w+", MODEL) for word in name.split("_")}
    given -= {"After", "Of", "In", "On", "Data", "Initial", "To", "Order"}
    by_key = {n.lower(): n for n in sorted(found) if given.isdisjoint(ada_case(n).split("_"))}
    return tuple(name for key, name in by_key.items() if key not in RESERVED)


def with_states(names: tuple[str, ...]) -> str:
    rows = "".join(f"          {name}: {{}}\n" for name in names)
    text = MODEL.replace("          # more states\n", rows)
    for source in ("Idle", "First"):
        ways = "".join(
            f"          reach_{n}: {{from: {source}, to: {name}, on: Bye, guard: turns = {n}}}\n"
            for n, name in enumerate(names, 1)
        )
        text = text.replace("          # more transitions\n", ways, 1)
    return text


def with_transitions(names: tuple[str, ...]) -> str:
    text = MODEL
    for state in ("Idle", "First"):
        rows = "".join(
            f"          {name}: {{from: {state}, to: {state}, on: Bye, guard: turns = {n}}}\n"
            for n, name in enumerate(names, 1)
        )
        text = text.replace("          # more transitions\n", rows, 1)
    return text


def with_events(names: tuple[str, ...]) -> str:
    """Each event is taken and raised."""
    free = tuple(name for name in names if name.lower() not in ("done", "order"))
    more = "".join(f", {name}" for name in free)
    text = MODEL.replace("Order, Ready]", f"Order, Ready{more}]")
    for state in ("Idle", "First"):
        rows = "".join(
            f"          reach_{n}: {{from: {state}, to: {state}, on: {name}, guard: turns = {n}, "
            f"effect: [{{raise: {free[n - 2]}}}]}}\n"
            for n, name in enumerate(free, 1)
        )
        text = text.replace("          # more transitions\n", rows, 1)
    return text.replace("Idle: {defer: [Order]}", "Idle: {defer: [Order, Event, T, None]}")


def with_values(names: tuple[str, ...]) -> str:
    """The same where an event carries a value, so that events are records."""
    del names
    few = with_events(("Event", "Event_Name", "No_Event", "Event_Lists", "T", "None"))
    start, rest = few.split("events: [", 1)
    inside, end = rest.split("]", 1)
    forms = ", ".join(f"{name.strip()}: {{}}" for name in inside.split(","))
    return f"{start}events: {{{forms}, Amount: {{type: Count}}}}{end}"


def with_components(names: tuple[str, ...]) -> str:
    """A component of each of a few names, in an instance of its own."""
    del names
    start, rest = MODEL.split("  Part:\n", 1)
    part, end = rest.split("nodes: ", 1)
    kinds = ("T", "None", "Item", "Event", "Event_Lists", "Memory", "Poll", "Chart")
    rows = [f"of_{k}.{row}" for k in kinds for row in ("Subject", "Plain", "work")]
    text = start + "".join(f"  {k}:\n{part}" for k in kinds) + f"nodes: {end}"
    instances = ", ".join(f"of_{k}: {{component: {k}, node: board}}" for k in kinds)
    text = text.replace("unit: {component: Part, node: board}", instances)
    text = text.replace("unit.Subject, unit.Plain, unit.work", ", ".join(rows))
    events = ("Go_On", "Bye", "Back", "Order")
    raised = ", ".join(f"of_{k}.{event}" for k in kinds for event in events)
    return text.replace("unit.Go_On, unit.Bye, unit.Back, unit.Order", raised)


def with_regions(names: tuple[str, ...]) -> str:
    """Regions of an orthogonal state."""
    del names
    return MODEL.replace("Left:", "None:").replace("Right:", "Top:")


WRITTEN = [with_transitions, with_states, with_events, with_values, with_components, with_regions]


def test_own_names_are_found() -> None:
    assert {"T", "None", "Selection", "Leaf", "Domain_Of", "Step", "Chart"} <= set(own_names())


@pytest.mark.parametrize("written", WRITTEN)
def test_no_name_is_reserved(written: Written, tmp_path: Path) -> None:
    (tmp_path / "model.yaml").write_text(written(own_names()))
    result = load(tmp_path / "model.yaml")
    assert [d.message for d in result.diagnostics if d.severity is Severity.ERROR] == []


@pytest.mark.slow
@pytest.mark.parametrize("written", WRITTEN)
@pytest.mark.parametrize("mode", MODES)
def test_code_with_own_names_compiles(written: Written, mode: str, tmp_path: Path) -> None:
    assert complaints({"Named": written(own_names())}, tmp_path, mode) == ""
