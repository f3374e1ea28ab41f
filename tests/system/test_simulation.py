# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The generated code in virtual time against the reference traces and the interpreter."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Sequence
from pathlib import Path

import pytest
import yaml

from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.traces import StepRecord
from ravenchart.command_line import main
from ravenchart.commands.simulate import build_simulation, run_simulation
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from tests.support import random_charts, reference_charts
from tests.support.interpreted import plain, stimuli_of, system_of
from tests.support.reference_charts import NAMES, chart_of, labels_of

LONG = "RAVENCHART_LONG_TESTS" in os.environ
"""`make test-long`: all of the random charts, in batches of one compilation each."""

EXAMPLES = sorted(p.parent.name for p in (ROOT / "examples").glob("*/events.yaml"))

BATCH = 12 if LONG else 4
FIRST = 1_000
CHARTS = 167 * 12 if LONG else BATCH


def _program(system: System, home: Path) -> Path:
    return build_simulation(system, home, home / "simulation")


def _instance(case: str) -> str:
    return f"unit_{NAMES.index(case)}"


def _all_references() -> str:
    """One system of all reference charts, an instance each."""
    parts = {case: plain(reference_charts.model_of(chart_of(case))) for case in NAMES}
    whole = dict(next(iter(parts.values())))
    whole["components"] = {
        f"Part_{k}": next(iter(part["components"].values()))
        for k, part in enumerate(parts.values())
    }
    whole["instances"] = {
        f"unit_{k}": {"component": f"Part_{k}", "node": "board"} for k in range(len(parts))
    }
    (processor,) = whole["processors"].values()
    (row,) = processor["activities"]
    processor["activities"] = [f"unit_{k}.{row.partition('.')[2]}" for k in range(len(parts))]
    return yaml.safe_dump(whole, sort_keys=False)


def _events_for(case: str) -> str:
    entries = plain(reference_charts.events_of(chart_of(case)))
    for entry in entries:
        if "raise" in entry:
            entry["raise"] = f"{_instance(case)}.{entry['raise'].partition('.')[2]}"
    return yaml.safe_dump(entries, sort_keys=False)


@pytest.mark.slow
def test_the_generated_code_gives_every_reference_trace(tmp_path: Path) -> None:
    system = system_of(_all_references())
    program = _program(system, tmp_path)
    for name in NAMES:
        case = chart_of(name)
        records = run_simulation(system, program, stimuli_of(_events_for(name), system))
        own = [b for r in records if r.instance == _instance(name) for b in r.behaviours]
        assert labels_of(case, own) in case["expected_traces"], name


@pytest.mark.slow
@pytest.mark.parametrize("name", EXAMPLES)
def test_the_command_says_the_same_of_an_example_both_ways(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = ROOT / "examples" / name
    call = ["simulate", str(folder / "model.yaml"), "--events", str(folder / "events.yaml")]
    assert main(call) == 0
    executed = capsys.readouterr().out
    assert main([*call, "--interpreter"]) == 0
    assert capsys.readouterr().out == executed
    assert executed.count("\n") > 10
    assert main([*call, "--json"]) == 0
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert len(lines) == executed.count("\n")


def _times(folder: Path, region: str, capsys: pytest.CaptureFixture[str]) -> dict[str, str]:
    """When each transition of a region was first taken in a second without stimuli, in s."""
    events = folder / "events.yaml"
    events.write_text("- {until: 1 s}\n")
    assert main(["simulate", str(folder / "model.yaml"), "--events", str(events)]) == 0
    found: dict[str, str] = {}
    for line in capsys.readouterr().out.splitlines():
        time, where, *behaviours = line.replace(",", "").split(" ")
        if where == f"{region}:":
            for one in behaviours:
                found.setdefault(one.removesuffix(".effect"), time)
    return found


@pytest.mark.slow
def test_devices_and_tasks_execute_commands_in_virtual_time(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "gripper"
    shutil.copytree(ROOT / "tests" / "nodes" / "gripper", folder)
    grasp = _times(folder, "grasp_1.Life", capsys)
    # a reply by event, one looked at, a queued command, and what both fingers of the array give
    taken = {name: grasp[name] for name in ("calibrated", "known", "close", "has")}
    assert taken == {"calibrated": "0.020", "known": "0.060", "close": "0.120", "has": "0.140"}
    # a command of the other node with its reply, and an event of the interface
    boss = _times(folder, "boss_1.Plan", capsys)
    taken = {name: boss[name] for name in ("begin_it", "taken", "held")}
    assert taken == {"begin_it": "0.100", "taken": "0.120", "held": "0.140"}


def test_a_simulated_device_is_written_and_then_run_as_the_user_left_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "gripper"
    shutil.copytree(ROOT / "tests" / "nodes" / "gripper", folder)
    shutil.rmtree(folder / "simulated")
    assert "has" in _times(folder, "grasp_1.Life", capsys)
    driver = folder / "simulated" / "memory" / "gripper_cell-memory.adb"
    text = driver.read_text()
    kept = (ROOT / "tests/nodes/gripper/simulated/memory" / driver.name).read_text()
    ours, _, rest = kept.partition("\n\n")
    assert ours.count("SPDX") == 2 and text.split() == rest.split()
    driver.write_text(
        text.replace("Reply := Device.Calibrate_Reply", "Reply := Gripper_Cell.Badly")
    )
    stuck = _times(folder, "grasp_1.Life", capsys)
    assert "Starting.entry" in stuck and "calibrated" not in stuck
    assert "Badly" in driver.read_text()


@pytest.mark.slow
def test_the_arm_of_the_surgical_robot_moves_in_virtual_time(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "robot"
    shutil.copytree(ROOT / "examples" / "surgical_robot", folder)
    taken = _times(folder, "supervisor_1.Task_Of_Arm", capsys)
    assert "there" in taken and "too_late" not in taken


def _by_chart(records: Sequence[StepRecord], seeds: Sequence[int]) -> dict[int, list[str]]:
    own = {random_charts.instance_name(seed): seed for seed in seeds}
    found: dict[int, list[str]] = {seed: [] for seed in seeds}
    for record in records:
        found[own[record.instance]].append(record.text())
    return found


@pytest.mark.slow
@pytest.mark.parametrize("start", range(FIRST, FIRST + CHARTS, BATCH))
def test_program_and_interpreter_agree_on_random_charts(start: int, tmp_path: Path) -> None:
    seeds = range(start, start + BATCH)
    system = system_of(random_charts.model_of(seeds))
    program = _program(system, tmp_path)
    for run in range(2):
        stimuli = stimuli_of(random_charts.events_of(start + run, seeds), system)
        executed = _by_chart(run_simulation(system, program, stimuli), seeds)
        interpreted = _by_chart(list(Machine(system).run(stimuli)), seeds)
        for seed in seeds:
            assert executed[seed] == interpreted[seed], f"seed {seed}, run {run}"
        assert sum(map(len, executed.values())) > 5 * BATCH  # they do something
