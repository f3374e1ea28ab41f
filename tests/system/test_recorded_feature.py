# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Recorded values: those of the running controller, the simulation and the interpreter agree."""

from __future__ import annotations

import csv
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

from ravenchart.analysis.system.observed import Observation, read_map, read_trace
from ravenchart.building import checking, generation, programs
from ravenchart.command_line import main
from ravenchart.commands.simulate import build_simulation, executed, interpreted
from ravenchart.running import monitoring
from ravenchart.running.monitored import WatchedNode
from ravenchart.running.process import ControllerProcess
from ravenchart.running.replaying import ReplayedRun
from ravenchart.running.snapshots import SnapshotFile, parsed
from ravenchart.running.traces.files import read_traces
from ravenchart.running.traces.formats import FORMATS
from ravenchart.running.traces.timeline import Timeline, of_run
from tests.support import recorded
from tests.support.interpreted import stimuli_of, system_of
from tests.support.recorded import FOLDER, MODEL, Values, read_back

SECONDS = 0.5
LIVE = "live"
"""The file of snapshots."""
PRINTED = pytest.CaptureFixture[str]


def _run(folder: Path, seconds: float) -> tuple[Observation, Timeline]:
    """What the controller of a model shows in so many seconds."""
    checked = checking.check(folder / "model.yaml")
    generation.write_program(checked)
    (program,) = programs.programs_of(checked)
    trace, built = folder / "trace.txt", program.build()
    snapshots = folder / LIVE
    snapshots.touch()
    files = {"RAVENCHART_TRACE": str(trace), "RAVENCHART_MONITOR": str(snapshots)}
    process = subprocess.Popen([built], env=files)
    time.sleep(seconds)
    process.send_signal(signal.SIGTERM)
    assert process.wait(5) == 0
    names = read_map((folder / "generated" / "trace.json").read_text(encoding="utf-8"))
    seen = read_trace(trace.read_text(encoding="ascii").splitlines(), names)
    return seen, of_run(checked.system, {program.node: seen})


def _values(timeline: Timeline) -> Values:
    """What was recorded, by element, as the CSV has it."""
    rows = [(row.element, row.detail) for row in timeline.rows if row.kind == "value"]
    return recorded.grouped(rows)


@pytest.mark.slow
@pytest.mark.live
def test_a_replay_shows_at_each_instant_what_a_monitor_had_seen(tmp_path: Path) -> None:
    folder = Path(shutil.copytree(FOLDER, tmp_path / "recorded"))
    checked = checking.check(folder / "model.yaml")
    generation.write_program(checked)
    (program,) = programs.programs_of(checked)
    trace, executable = folder / "trace.txt", program.build()
    process = ControllerProcess(executable, trace, 0)
    seen: list[WatchedNode] = []
    try:
        while not (files := monitoring.found(checked, lambda _: None)):
            time.sleep(monitoring.PERIOD / 4)
        with monitoring.watching(checked, files) as (controller,):
            while len(seen) < 6:
                if controller.is_new and controller.node.now > 0:  # several wait for the start
                    seen.append(controller.node)
                time.sleep(monitoring.PERIOD / 4)
                controller.look()
    finally:
        ended = process.stop(0.0)
    assert ended.exit_code == 0, ended.warnings
    (replayed,) = ReplayedRun(checked.analysis, read_traces(checked, [trace])).controllers
    for was in seen:
        now = replayed.node(was.now)
        assert (now.sequence, now.processors) == (was.sequence, was.processors)
        assert (now.rows[0].longest_execution, now.faults, now.lost) == (
            was.rows[0].longest_execution, was.faults, was.lost,
        )  # fmt: skip
        for mine, theirs in zip(now.values, was.values, strict=True):
            assert mine.name == theirs.name
            assert mine.count >= theirs.count, "a record may come between two snapshots"
            assert mine.count > theirs.count or mine == theirs


@pytest.mark.slow
@pytest.mark.live
def test_a_run_has_each_value_once_in_order(tmp_path: Path) -> None:
    folder = tmp_path / "recorded"
    shutil.copytree(FOLDER, folder)
    seen, timeline = _run(folder, SECONDS)
    found = _values(timeline)
    releases = seen.processors["all_rows"].releases
    executions = (releases + 1) // 2
    assert executions >= 10 and seen.values_lost == 0
    wanted = recorded.expected(executions)
    assert {name: found[name] for name in wanted} == wanted
    assert found["taker.count"] == recorded.counted(releases)
    assert [one.time for one in seen.values] == sorted(one.time for one in seen.values)
    text = SnapshotFile(folder / LIVE).text()
    assert text is not None
    shown = {t.last.element: t for t in parsed(text, seen.map, LIVE).tallies}
    for element in seen.map.of_kind("value"):
        points = [(one.time, one.value) for one in seen.values if one.element == element]
        last = shown[element].last
        assert (shown[element].count, last.time, last.value) == (len(points), *points[-1])


@pytest.mark.slow
@pytest.mark.live
def test_mdf_has_each_value_of_a_run(tmp_path: Path) -> None:
    recorded.asammdf()
    folder = tmp_path / "recorded"
    shutil.copytree(FOLDER, folder)
    seen, timeline = _run(folder, SECONDS)
    path = tmp_path / "run.mf4"
    path.write_bytes(FORMATS[".mf4"](timeline))
    for element in seen.map.of_kind("value"):
        points = [(one.time, one.value) for one in seen.values if one.element == element]
        assert read_back(path, element.name) == points


@pytest.mark.slow
@pytest.mark.live
def test_each_value_is_in_the_trace_or_counted_as_lost(tmp_path: Path) -> None:
    folder = tmp_path / "recorded"
    shutil.copytree(FOLDER, folder)
    model = folder / "model.yaml"
    model.write_text(MODEL.read_text(encoding="utf-8").replace("trace: 1024", "trace: 1"))
    seen, _ = _run(folder, SECONDS)
    releases = seen.processors["all_rows"].releases
    recorded_in_all = 8 * ((releases + 1) // 2) + 2 * releases
    assert seen.values and seen.values_lost > 0
    assert len(seen.values) + seen.values_lost == recorded_in_all


@pytest.mark.slow
def test_program_and_interpreter_record_the_same(tmp_path: Path) -> None:
    system = system_of(MODEL.read_text(encoding="utf-8"))
    stimuli = stimuli_of((FOLDER / "events.yaml").read_text(encoding="utf-8"), system)
    program = build_simulation(system, tmp_path, tmp_path / "simulation")
    played = executed(system, program, stimuli)
    assert played == interpreted(system, stimuli)
    assert len(played.values) == 8 * 11 + 2 * 21
    assert max(one.at for one in played.values) == 200_000_000


@pytest.mark.parametrize("form", ["text", "json"])
def test_a_simulation_has_the_values_of_a_run(form: str, tmp_path: Path, capsys: PRINTED) -> None:
    words = ["simulate", str(MODEL), "--interpreter", "--events", str(FOLDER / "events.yaml")]
    assert main([*words, *(["--json"] if form == "json" else [])]) == 0
    trace, out = tmp_path / "simulated.txt", tmp_path / "simulated.csv"
    trace.write_text(capsys.readouterr().out)
    assert main(["trace", str(MODEL), str(trace), "--out", str(out)]) == 0
    with out.open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] == "value"]
    found = recorded.grouped([(row["element"], row["detail"]) for row in rows])
    wanted = recorded.expected(11)
    assert {name: found[name] for name in wanted} == wanted
    assert found["taker.count"] == recorded.counted(21)
    assert {(r["element"], r["unit"]) for r in rows} >= {
        ("taker.heat", "degC"), ("giver.height", "mm"), ("giver.hue", ""),
    }  # fmt: skip


@pytest.mark.parametrize(("text", "problem"), [
    ("0.000 giver.weight = 1\n", ":1: error: the model does not record giver.weight"),
    ("0.000 giver.height = Red\n", ":1: error: giver.height has no value Red"),
    ("0.000 giver.hue = 1\n", ":1: error: giver.hue has no value 1"),
    ("0.020 giver.hue = Red\n0.010 giver.hue = Red\n", ":2: error: the time is before"),
    ('{"at_ns": 0, "value": 1}\n', ":1: error: not a line of `ravenchart simulate`"),
])  # fmt: skip
def test_a_value_that_the_model_does_not_record_is_refused(
    text: str, problem: str, tmp_path: Path, capsys: PRINTED
) -> None:
    trace, out = tmp_path / "simulated.txt", tmp_path / "simulated.csv"
    trace.write_text(text)
    assert main(["trace", str(MODEL), str(trace), "--out", str(out)]) == 1
    assert problem in capsys.readouterr().err
    assert not out.exists()
