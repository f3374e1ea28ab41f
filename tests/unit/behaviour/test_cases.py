# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Test cases that are found for charts: what counts as shown, and that a search shows it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from ravenchart.behaviour.cases.goals import GoalCoverage, GoalKind, goals
from ravenchart.behaviour.cases.possible import Outlook
from ravenchart.behaviour.cases.search import CaseSearch, SearchResult
from ravenchart.behaviour.cases.watched import watched_machine
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.stimuli import read_stimuli, written_stimuli
from ravenchart.behaviour.interpreter.traces import StepRecord
from ravenchart.command_line import main
from ravenchart.commands import simulate
from ravenchart.commands import tests as command
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from tests.support.interpreted import component_system, stimuli_of

PART = """
ports:
  level: {in: Small, max_age: 30 ms}
port_region: {period: 10 ms, wcet: 1 us}
events: {Go: {external: true}, Dial: {type: Small, external: true}, Later: {external: true}}
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 4
    deferred: 2
    initial: A
    states: {A: {defer: [Later]}, B: {}, C: {}}
    transitions:
      dial: {from: A, to: B, on: Dial, guard: event > 3 and (fresh(level) or level = 7)}
      back: {from: B, to: A, when: level > 5}
      late: {from: B, to: C, after: 200 ms}
      home: {from: C, to: A, on: Later}
"""
BUS = """
buses:
  can: {bit_rate: 500 kbit/s, driver_wcet: 1 us, receive_depth: 4, transmit_depth: 4}
messages:
  level_in: {bus: can, id: 0x100, to: unit.level, period: 10 ms}
processors:
  reception: {node: board, released_by: can, period: 10 ms, stack: 8 KiB,
              activities: [can.receive]}
  runner: {node: board, stack: 8 KiB, activities: [unit.ports, unit.Main]}
"""


@pytest.fixture(scope="module")
def system() -> System:
    """One chart with decisions of several conditions."""
    return component_system(PART, more=BUS)


@pytest.fixture(scope="module")
def found(system: System) -> SearchResult:
    """What a search finds for it."""
    return CaseSearch(system, 60_000).found()


def _shown(system: System, events: str) -> set[str]:
    coverage = GoalCoverage()
    for _ in watched_machine(system, coverage).run(stimuli_of(events, system)):
        pass
    return {g.text() for g in goals(system.instances[0].component) if coverage.shows(g)}


def test_every_goal_is_named_once(system: System) -> None:
    every = list(goals(system.instances[0].component))
    kinds = [goal.kind for goal in every]
    assert len(set(every)) == len(every)
    assert [kinds.count(kind) for kind in GoalKind] == [4, 2, 2, 3, 1, 0]


NESTED = """
events: {Stop: {external: true}, Go: {external: true}, Hold: {external: true}}
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 4
    deferred: 2
    initial: Off
    states:
      Off: {}
      On:
        initial: Slow
        states: {Slow: {}, Fast: {}, Held: {defer: [Hold]}, Done: {kind: final}}
    transitions:
      start: {from: Off, to: On, on: Go}
      stop: {from: On, to: Off, on: Stop}
      hold: {from: On, to: Held, on: Hold}
      stay: {from: On, on: Go, internal: true}
      faster: {from: Slow, to: Fast, on: Go}
      brake: {from: Fast, to: Slow, on: Stop}
      late: {from: On, to: Off, after: 100 ms}
      ended: {from: Fast, to: Done, after: 50 ms}
      done: {from: On, to: Off}
"""


def test_leaves_are_left_by_what_can_leave_them() -> None:
    """Not by what a state inside takes or defers always, an internal transition or a completion."""
    nested = component_system(NESTED)
    every = [g for g in goals(nested.instances[0].component) if g.kind is GoalKind.LEFT]
    texts = {goal.text().removeprefix("Part.Main.") for goal in every}
    assert texts == {
        *(f"stop leaves {leaf}" for leaf in ("Slow", "Held")),
        *(f"hold leaves {leaf}" for leaf in ("Slow", "Fast")),
        *(f"late leaves {leaf}" for leaf in ("Slow", "Fast", "Held")),
    }
    shown = _shown(
        nested,
        "- {at: 20 ms, raise: unit.Go}\n- {at: 40 ms, raise: unit.Stop}\n- {until: 90 ms}\n",
    )
    left = {text for text in shown if "leaves" in text}
    assert left == {"Part.Main.stop leaves Slow"}


def test_one_execution_shows_what_it_executes_and_nothing_else(system: System) -> None:
    shown = _shown(system, "- {at: 20 ms, raise: unit.Dial, with: 3}\n- {until: 50 ms}\n")
    assert shown == {"the guard of Part.Main.dial is false"}


def test_a_condition_decides_only_where_nothing_else_differs(system: System) -> None:
    """The third condition is never true here."""
    events = """
- {at: 20 ms, raise: unit.Dial, with: 9}
- {at: 30 ms, put: unit.level, value: 7}
- {at: 40 ms, raise: unit.Dial, with: 3}
- {at: 50 ms, raise: unit.Dial, with: 4}
- {until: 100 ms}
"""
    decided = {text for text in _shown(system, events) if "decides" in text}
    assert decided == {
        "condition 1 of the guard of Part.Main.dial decides it",
        "condition 2 of the guard of Part.Main.dial decides it",
    }


def test_a_search_shows_every_goal(found: SearchResult) -> None:
    assert [goal.text() for goal in found.open] == []
    assert not found.stuck
    assert len(found.cases) < len(found.goals)


def test_each_case_shows_what_it_says(system: System, found: SearchResult) -> None:
    coverage = GoalCoverage()
    for case in found.cases:
        before = {goal for goal in found.goals if coverage.shows(goal)}
        for _ in watched_machine(system, coverage).run(case.stimuli):
            pass
        now = {goal for goal in found.goals if coverage.shows(goal)}
        assert set(case.shows) == now - before


def test_to_be_watched_changes_nothing(system: System, found: SearchResult) -> None:
    for case in found.cases:
        seen = list(watched_machine(system, GoalCoverage()).run(case.stimuli))
        assert seen == list(Machine(system).run(case.stimuli))


def test_the_same_effort_finds_the_same_cases(system: System, found: SearchResult) -> None:
    assert CaseSearch(system, 60_000).found() == found


def test_what_cannot_be_is_unreachable() -> None:
    """The second of two complementary guards is only looked at where it is true."""
    part = PART.replace(
        "      home: {from: C, to: A, on: Later}\n",
        "      home: {from: C, to: A, on: Go, guard: level > 5}\n"
        "      stay: {from: C, to: B, on: Go, guard: level <= 5}\n",
    )
    search = CaseSearch(component_system(part, more=BUS), 2_000)
    never = ["the guard of Part.Main.stay is false"]
    assert [goal.text() for goal in search.unreachable] == never
    found = search.found()
    assert [goal.text() for goal in found.unreachable] == never
    assert not {*found.unreachable} & {*found.open}
    assert not {goal for case in found.cases for goal in case.shows} & {*found.unreachable}


LOCK = """
events: {Key: {type: Code, external: true}}
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 1
    initial: Shut
    states: {Shut: {}, Open: {}}
    transitions:
      open: {from: Shut, to: Open, on: Key, guard: 3 * event.left + event.right = 1234567}
      shut: {from: Open, to: Shut, on: Key}
"""
CODE = "types: {Wide: {range: [0, 1000000]}, Code: {fields: {left: Wide, right: Wide}}}"


def test_a_value_that_chance_would_not_find_is_computed() -> None:
    system = component_system(LOCK, more=CODE)
    assert CaseSearch(system, 2_000).found().open == []
    search = CaseSearch(system, 2_000, ahead=Outlook())
    assert "Part.Main.open is taken" in [goal.text() for goal in search.found().open]


STUCK = """
events: {Go: {external: true}}
data: {x: {type: Small, initial: 0}}
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 4
    initial: A
    states: {A: {}, P: {kind: choice}}
    transitions: {go: {from: A, to: P, on: Go}, only: {from: P, to: A, guard: x = 1}}
"""


def test_a_choice_without_a_way_out_is_told_once_and_ends_no_search() -> None:
    found = CaseSearch(component_system(STUCK), 20_000).found()
    assert [str(one) for one in found.stuck] == ["P has no way out: no guard holds"]
    #  what ends so is no case
    assert "Part.Main.go is taken" in [goal.text() for goal in found.open]


def test_a_chart_that_only_time_moves_is_searched() -> None:
    part = """
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 1
    initial: A
    states: {A: {}, B: {}}
    transitions: {late: {from: A, to: B, after: 2 s}, back: {from: B, to: A, after: 10 ms}}
"""
    assert CaseSearch(component_system(part), 20_000).found().open == []


def test_an_effort_is_a_whole_number_from_1(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["tests", "model.yaml", "--effort", "0"])
    assert ended.value.code == 2
    assert "'0' is not a whole number from 1" in capsys.readouterr().err


def test_a_written_file_is_read_back(system: System, found: SearchResult) -> None:
    for case in found.cases:
        text = written_stimuli(case.stimuli, ["one comment"])
        assert text.startswith("# one comment\n")
        assert read_stimuli(text, "case.yaml", system) == (case.stimuli, ())


@pytest.fixture
def crossing(tmp_path: Path) -> Path:
    """A copy of an example without bodies of a user."""
    copy = Path(shutil.copytree(ROOT / "examples" / "crossing", tmp_path / "crossing"))
    return copy / "model.yaml"


@pytest.mark.slow
def test_the_program_plays_the_cases_as_the_interpreter_does(
    crossing: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert main(["tests", str(crossing)]) == 0
    said = capsys.readouterr().out
    assert "transitions taken                        13 of 13\n" in said
    assert "states left by transitions around them   11 of 12, 1 unreachable\n" in said
    #  `last_call` takes 6 s there, and `gone` 10 s
    assert "not shown" not in said
    assert said.count("unreachable: Crossing.Lights.gone leaves Walking\n") == 1
    count = len(list((crossing.parent / "cases").glob("*.yaml")))
    assert f"in {count} of {count} cases" in said
    #  a program that leaves one step out
    honest = simulate.simulated_by_interpreter

    def more(*given: object) -> list[StepRecord]:
        return honest(*given)[:-1]  # type: ignore[arg-type]

    monkeypatch.setattr(command, "simulated_by_interpreter", more)
    assert main(["tests", str(crossing)]) == 1
    assert "execute different behaviours" in capsys.readouterr().out


@pytest.mark.slow
def test_old_cases_are_replaced_and_other_files_stay(crossing: Path) -> None:
    folder = crossing.parent / "cases"
    folder.mkdir()
    (folder / "case-77.yaml").write_text("- {until: 1 s}\n")
    (folder / "mine.yaml").write_text("- {until: 1 s}\n")
    assert main(["tests", str(crossing), "--effort", "500", "--no-run"]) == 0
    names = {path.name for path in folder.iterdir()}
    assert "case-01.yaml" in names and "mine.yaml" in names and "case-77.yaml" not in names


PAIR = """
ports:
  level: {in: Small}
port_region: {period: 10 ms, wcet: 1 us}
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    initial: A
    states: {A: {}, B: {}}
    transitions:
      go: {from: A, to: B, when: level = 3 or level = 7}
"""


def test_two_executions_that_show_a_goal_together_are_both_cases() -> None:
    system = component_system(PAIR, more=BUS)
    found = CaseSearch(system, 20_000).found()
    assert found.open == []
    shown = GoalCoverage()
    for case in found.cases:
        for _ in watched_machine(system, shown).run(case.stimuli):
            pass
    assert all(shown.shows(goal) for goal in found.goals)
