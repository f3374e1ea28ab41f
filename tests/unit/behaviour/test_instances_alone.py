# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""An instance alone: what stands in for the user and for others, and cases of it."""

from __future__ import annotations

import random
import shutil
from contextlib import suppress
from pathlib import Path

import pytest

from ravenchart.behaviour.cases.finding import found_cases
from ravenchart.behaviour.cases.stimulation import choices
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.region import Stuck
from ravenchart.behaviour.interpreter.stimuli import Stimuli
from ravenchart.building import checking
from ravenchart.command_line import main
from ravenchart.commands.simulate import build_simulation, run_simulation, simulated_by_interpreter
from ravenchart.gen.derive.alone import alone, given_by, unit_instances
from ravenchart.gen.emit.program import simulation
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from tests.support.interpreted import component_system, stimuli_of

MODELS = sorted(
    [*(ROOT / "examples").glob("*/model.yaml"), *(ROOT / "tests" / "feature").glob("*/model.yaml")]
)
COMPILED = {"surgical_robot", "cartesian_robot", "devices", "requests", "contracts", "done"}
"""Models of which each kind of stub is compiled."""

WORKER = """
ports: {out_port: {out: Small}}
events: [Ready]
data:
  found: {type: Small, initial: 5}
  pair: {type: Pair, initial: {one: 1, two: 2}}
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 4
    initial: A
    states: {A: {}, B: {}}
    transitions:
      up: {from: A, to: B, when: found = 7 and pair.two = 4}
      down: {from: B, to: A, on: Ready}
activities:
  work:
    period: 10 ms
    wcet: 1 us
    writes: [found, pair]
    sends: [out_port]
    raises: [Ready]
    ensures: [found > 3]
    body: user
"""
TYPES = """
types:
  Small: {range: [0, 10]}
  Pair: {fields: {one: Small, two: Small}}
processors:
  runner: {node: board, stack: 8 KiB, activities: [unit.Main, unit.work]}
"""


@pytest.fixture(scope="module")
def worker() -> System:
    """A chart that waits for what a body of the user writes."""
    return alone(component_system(WORKER, more=TYPES), "unit")


def steps(system: System, events: str) -> list[str]:
    """The executed steps as text."""
    return [one.text() for one in Machine(system).run(stimuli_of(events, system))]


def test_what_arrives_is_written_and_events_come_from_outside(worker: System) -> None:
    events = """
    - {at: 20 ms, put: unit.found_given, value: 7}
    - {at: 20 ms, put: unit.pair_given, value: {one: 3, two: 4}}
    - {at: 60 ms, raise: unit.Ready}
    - {until: 80 ms}
    """
    system = worker
    found = steps(system, events)
    assert [line.split(": ")[1] for line in found][-1] != found[0].split(": ")[1]
    machine = Machine(system)
    list(machine.run(stimuli_of(events, system)))
    assert machine.instances["unit"].data["found"] == 7


def test_before_anything_arrives_the_initial_values_stay(worker: System) -> None:
    machine = Machine(worker)
    list(machine.run(stimuli_of("- {until: 100 ms}", worker)))
    assert machine.instances["unit"].data["found"] == 5


def test_what_the_body_ensures_is_kept(worker: System) -> None:
    machine = Machine(worker)
    events = "- {at: 0, put: unit.found_given, value: 2}\n- {until: 100 ms}"
    list(machine.run(stimuli_of(events, worker)))
    assert machine.instances["unit"].data["found"] == 5


def test_a_name_that_is_taken_gets_a_number() -> None:
    part = WORKER.replace("  pair:", "  found_given: {type: Small, initial: 0}\n  pair:")
    system = component_system(part, more=TYPES)
    assert given_by(system.instances[0].component)["found"] == "found_given_2"


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.parent.name)
def test_every_instance_runs_alone_and_has_a_program(path: Path) -> None:
    system = checking.check(path).system
    chance = random.Random(path.parent.name)
    for instance in unit_instances(system):
        one = alone(system, instance.name)
        entries = []
        for at in range(0, 200_000_000, 10_000_000):
            entries += [c.drawn(Ns(at), chance) for c in choices(one) if chance.random() < 0.3]
        with suppress(Stuck):
            list(Machine(one).run(Stimuli(tuple(entries), Ns(300_000_000))))
        assert simulation(one)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(COMPILED))
def test_the_program_of_an_instance_alone_does_the_same(name: str, tmp_path: Path) -> None:
    (path,) = (one for one in MODELS if one.parent.name == name)
    checked = checking.check(path)
    chance = random.Random(name)
    for number, instance in enumerate(unit_instances(checked.system)):
        one = alone(checked.system, instance.name)
        program = build_simulation(one, checked.folder, tmp_path / str(number))
        for _ in range(10):
            entries = []
            for at in range(0, 900_000_000, 10_000_000):
                entries += [c.drawn(Ns(at), chance) for c in choices(one) if chance.random() < 0.2]
            stimuli = Stimuli(tuple(entries), Ns(1_000_000_000))
            assert run_simulation(one, program, stimuli) == simulated_by_interpreter(one, stimuli)


def test_what_only_a_lost_value_shows_is_shown_by_an_instance_alone() -> None:
    system = checking.check(ROOT / "examples" / "two_nodes" / "model.yaml").system
    found = found_cases(system, 100_000)
    assert found.open == [] and found.unreachable == []
    lost = "Traveller.Mission.lost is taken"
    (case,) = (c for c in found.cases if lost in [goal.text() for goal in c.shows])
    assert case.instance == "supervisor"


def test_a_model_with_drivers_has_cases_of_its_components() -> None:
    system = checking.check(ROOT / "examples" / "surgical_robot" / "model.yaml").system
    found = found_cases(system, 20_000)
    assert found.open == [] and found.goals
    assert {case.instance for case in found.cases} == {"supervisor_1"}


def test_without_a_case_of_the_system_there_is_no_coverage(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = Path(shutil.copytree(ROOT / "examples" / "surgical_robot", tmp_path / "robot"))
    words = ["tests", str(model / "model.yaml"), "--no-run", "--coverage", str(tmp_path / "x")]
    assert main([*words, "--effort", "2000"]) == 2
    assert "no case is of the system" in capsys.readouterr().err


@pytest.fixture
def nodes(tmp_path: Path) -> Path:
    """A copy of an example."""
    copy = Path(shutil.copytree(ROOT / "examples" / "two_nodes", tmp_path / "two_nodes"))
    return copy / "model.yaml"


@pytest.mark.slow
def test_the_cases_of_an_instance_are_files_that_simulate_takes(
    nodes: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["tests", str(nodes), "--effort", "100000"]) == 0
    said = capsys.readouterr().out
    assert "alone\n" in said and "not shown" not in said
    file = next(iter((nodes.parent / "cases").glob("case-*-supervisor.yaml")))
    assert "simulate --alone supervisor" in file.read_text()
    words = ["simulate", str(nodes), "--events", str(file), "--alone", "Supervisor"]
    assert main(words) == 0
    by_program = capsys.readouterr().out
    assert main([*words, "--interpreter"]) == 0
    assert capsys.readouterr().out == by_program != ""


def test_an_instance_that_is_not_there_is_told(
    nodes: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["simulate", str(nodes), "--events", "events.yaml", "--alone", "nobody"]
    assert main(words) == 2
    assert "there is no instance `nobody`; there are: " in capsys.readouterr().err


def test_a_server_that_the_user_writes_does_not_stand_alone(
    capsys: pytest.CaptureFixture[str],
) -> None:
    model = ROOT / "examples" / "surgical_robot" / "model.yaml"
    words = ["simulate", str(model), "--events", "events.yaml", "--alone", "servo_1"]
    assert main(words) == 2
    assert "servo_1 cannot be executed alone: the user's " in capsys.readouterr().err
