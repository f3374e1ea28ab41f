# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Whole runs: the bench, a stand-in controller, the verdict and the report."""

from __future__ import annotations

import io
import os
from pathlib import Path

import pytest
from rich.console import Console

import ravenchart.running.process as process
from ravenchart.analysis.present.report import Comparison, StepRow
from ravenchart.analysis.system.observed import TraceError, read_map, read_trace
from ravenchart.hw_can.bench.forms import TraceCheck
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.hw_can.bench.scenario import ScenarioError, parse_scenario
from ravenchart.running import expected, judge, summary
from ravenchart.running.controllers import Controller
from ravenchart.running.process import Ended
from ravenchart.running.result import RunOutcome
from ravenchart.running.runs import (
    RunRequest,
    print_summary,
    run_alone,
    run_controller,
    run_model,
    write_report,
)
from tests.support.bench_files import Files, scenario_text, write_files
from tests.support.robot_files import trace_map

pytestmark = pytest.mark.clock

SHORT = scenario_text("  - wait: 30 ms\n")

FULL = scenario_text(
    """\
  - wait: 50 ms
  - {send: robot_command, with: {kind: Home, x: 0}}
  - {wait_for: robot_status.condition, is: Homing, within: 1 s}
  - {wait_for: robot_status.condition, is: Ready, within: 4 s}
  - {send: robot_command, with: {kind: Move, x: 15000}}
  - {wait_for: robot_status.condition, is: Moving, within: 1 s}
  - {wait_for: robot_status.condition, is: Ready, within: 4 s}
  - {expect: {x: 15 mm}, tolerance: 1 mm, within: 300 ms}
  - {send: robot_command, with: {kind: Move, x: 70000}}
  - {wait_for: robot_status.condition, is: Moving, within: 1 s}
  - wait: 100 ms
  - {pull: x, switch: low}
  - {expect_stop: x, below: 1 mm/s, within: 300 ms}
  - {wait_for: robot_status.condition, is: Failed, within: 1 s}
  - {release: x}
""",
    "expect_trace:\n  - {region: joint_x.Motion, reaches: Limit}\n",
)

LOST = scenario_text(
    """\
  - {send: robot_command, with: {kind: Home, x: 0}}
  - {wait_for: robot_status.condition, is: Ready, within: 4 s}
  - {kill_bench: true}
  - {expect_stop: x, below: 1 mm/s, within: 1 s}
""",
    """\
expect_trace:
  - {region: joint_x.Motion, reaches: Drive, within: 2 s, after_last: joint_x.feedback}
""",
)


OTHER = (
    "trace.txt: error: the trace has the digest ffffffffffff, and the model has 000000000000: the "
    "program that wrote it was generated from another model; generate, build and run again"
)
PASSED = "verdict: PASS (timing not judged: the controller had no real-time priorities)"
BARE = "scenario: S\nsteps: [{wait: 1 s}]\n"


def run(files: Files, duration: float | None = 20.0) -> RunOutcome:
    return run_controller(
        files.executable,
        files.trace_json,
        files.dbc,
        files.scenario,
        duration,
        files.out,
        analysis=files.analysis,
    )


def printed(result: RunOutcome) -> str:
    out = io.StringIO()
    console = Console(file=out, width=80, highlight=False)
    print_summary(result, console)
    summary.print_verdict(console, result.verdict, result.failures)
    return out.getvalue()


def test_a_whole_scenario_passes_and_leaves_its_report(tmp_path: Path) -> None:
    files = write_files(tmp_path, FULL, "warn")
    result = run(files)
    assert result.failures == ()
    assert result.verdict == PASSED
    written = write_report(result, files.analysis, files.out)
    assert {path.name for path in written} == {"report.html", "positions.png"}
    page = written[0].read_text(encoding="utf-8")
    assert "<svg" in page
    assert "Run: PASS" in page
    text = printed(result)
    assert max(map(len, text.splitlines())) <= 80
    assert text.splitlines()[-1] == PASSED
    assert "note: the controller says: no real-time priorities" in text
    assert "Idle, Seeking, Backing_Off, Cruising, Limit" in text


def test_the_tracks_show_the_motion_and_the_clocks_agree(tmp_path: Path) -> None:
    result = run(write_files(tmp_path, FULL))
    assert result.scenario_result is not None
    track = result.scenario_result.tracks["x"]
    assert len(track.time) == len(track.position) == len(track.target) > 100
    assert min(track.position) < 8_000
    assert max(track.speed) > 50_000
    zero = result.scenario_result.zeros["x"]
    assert zero is not None
    assert 9_000 <= zero < 9_500
    assert track.target[-1] == pytest.approx(zero + 70_000)
    assert result.observation is not None
    assert result.clock_offset is not None
    end = result.observation.end / 1e9 - result.clock_offset
    assert abs(end - track.time[-1]) < 0.5


def test_a_lost_bench_is_found_in_the_trace(tmp_path: Path) -> None:
    result = run(write_files(tmp_path, LOST))
    assert result.failures == ()
    assert result.steps[-1].outcome.startswith("after ")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("option", "reason"),
    [
        ("exit=3", "the controller ended with exit code 3"),
        ("cut", "the trace is cut off: its END line is missing"),
        ("lose", "7 trace records were lost"),
        ("other", OTHER),
        ("miss", "control missed 1 deadline; the scenario does not expect it"),
    ],
)
def test_each_fault_of_the_controller_fails_the_run(
    tmp_path: Path, option: str, reason: str
) -> None:
    result = run(write_files(tmp_path, SHORT, option))
    assert len(result.failures) == 1
    assert result.failures[0].startswith(reason)
    assert printed(result).splitlines()[-1].startswith("verdict: FAIL: ")


def test_a_failed_step_ends_the_scenario_and_fails_the_run(tmp_path: Path) -> None:
    steps = "  - {wait_for: robot_status.condition, is: Ready, within: 50 ms}\n  - wait: 9 s\n"
    result = run(write_files(tmp_path, scenario_text(steps)))
    assert [step.passed for step in result.steps] == [False]
    assert result.failures[0].startswith(
        "wait for robot_status.condition = Ready: not within 0.05 s: "
    )
    assert "FAILED: not within" in printed(result).replace("\n      ", " ")


def test_a_scenario_that_takes_too_long_fails(tmp_path: Path) -> None:
    result = run(write_files(tmp_path, scenario_text("  - wait: 9 s\n")), duration=0.05)
    assert result.failures == ("wait 9 s: the run's 0.05 s were over",)


def test_a_controller_that_does_not_end_is_killed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(process, "STOP_MARGIN", 0.1)
    result = run(write_files(tmp_path, SHORT, "deaf"))
    assert "the controller did not end when asked to, and was killed" in result.failures
    assert result.ended.killed


@pytest.mark.slow
@pytest.mark.alone
def test_a_controller_that_says_no_port_fails_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(process, "START_LIMIT", 3.0)  # a loaded host starts Python late
    result = run(write_files(tmp_path, SHORT, "mute"))
    assert result.failures[0] == "the controller did not open its bus within 3 s"


def test_a_controller_that_dies_at_once_fails_the_run_with_its_last_words(tmp_path: Path) -> None:
    files = write_files(tmp_path, SHORT)
    files.executable.write_text("#!/bin/sh\necho out of luck >&2\nexit 4\n")
    result = run(files)
    assert result.failures[0] == (
        "the controller ended with exit code 4 before it opened its bus: out of luck"
    )
    assert printed(result)
    assert write_report(result, files.analysis, files.out)


def test_an_executable_that_is_none_fails_the_run(tmp_path: Path) -> None:
    files = write_files(tmp_path, SHORT)
    files.executable.unlink()
    result = run(files)
    assert result.failures[0].endswith("cannot be started: No such file or directory")
    assert printed(result)


def request(files: Files, scenario: Path | None) -> RunRequest:
    one = Controller("node", files.executable, files.dbc.parent / "trace.json")
    return RunRequest(files.analysis, (one,), files.dbc.parent, scenario, 0.8, files.out)


def test_one_call_runs_prints_and_reports(tmp_path: Path) -> None:
    files = write_files(tmp_path, SHORT)
    files.dbc.rename(tmp_path / "bus.dbc")
    shown = io.StringIO()
    console = Console(file=shown, width=80, highlight=False)
    files.executable.write_text(
        files.executable.read_text(encoding="utf-8").replace("robot.dbc", "bus.dbc")
    )
    assert run_model(request(files, files.scenario), console)
    lines = shown.getvalue().splitlines()
    assert (lines[0], lines[-1]) == ("A test", PASSED)
    assert f"report: {files.out / 'report.html'}" in lines
    assert (files.out / "positions.png").read_bytes().startswith(b"\x89PNG")
    files.scenario.write_text("{")
    assert not run_model(request(files, files.scenario), console)
    assert "scenario.yaml:1:2: error: " in shown.getvalue()


def test_a_controller_can_run_without_a_scenario(tmp_path: Path) -> None:
    files = write_files(tmp_path, SHORT)
    shown = io.StringIO()
    assert run_model(request(files, None), Console(file=shown, width=80))
    assert "0.8 s without a scenario" in shown.getvalue()
    files.executable.write_text("#!/bin/sh\nexit 0\n")
    result = run_alone(files.executable, files.trace_json, 5.0, files.out)
    assert result.failures == ("the controller ended by itself within 5 s",)


def test_inputs_that_cannot_be_used_are_refused_before_anything_runs(tmp_path: Path) -> None:
    files = write_files(tmp_path, SHORT)
    files.trace_json.write_text("{")
    with pytest.raises(TraceError):
        run(files)
    files.dbc.unlink()
    with pytest.raises(BenchError):
        run(files)
    files.scenario.write_text("{")
    with pytest.raises(ScenarioError):
        run(files)


def test_real_time_priorities_are_noticed_and_make_the_bounds_count(tmp_path: Path) -> None:
    result = run(write_files(tmp_path, SHORT, "fifo", "late=600000"))
    if "Operation not permitted" in "".join(result.ended.warnings):
        pytest.skip("this user may not take real-time priorities")
    assert result.ended.real_time
    assert result.failures == ("control was observed to take 600 us, above its bound of 500 us",)


def test_without_real_time_priorities_nothing_is_compared(tmp_path: Path) -> None:
    result = run(write_files(tmp_path, SHORT, "late=600000"))
    assert not result.ended.real_time
    assert result.failures == ()
    assert "not comparable: the controller had no real-time priorities" in printed(result)


def test_the_bench_keeps_off_the_controllers_core_and_comes_back() -> None:
    before, policy = os.sched_getaffinity(0), os.sched_getscheduler(0)
    with process.separate_cores() as cores:
        inside = os.sched_getaffinity(0)
        assert before.issuperset(cores)
        assert inside.isdisjoint(cores) or inside == before
    assert os.sched_getaffinity(0) == before
    assert os.sched_getscheduler(0) == policy


# --- The verdict on its own ----------------------------------------------------

ABOVE = (Comparison("control", 100, 0, 600_000, 500_000),)


def reasons(*, real_time: bool) -> list[str]:
    ended = Ended(0, False, real_time, ())
    return list(judge.failures(ended, None, None, (), ABOVE))


def test_an_observation_above_the_bound_fails_with_real_time_priorities_only() -> None:
    assert reasons(real_time=True) == [
        "control was observed to take 600 us, above its bound of 500 us"
    ]
    assert reasons(real_time=False) == []


@pytest.mark.parametrize(
    ("withheld", "misses", "said"),
    [
        (99_999, 0, ["control was observed to take 600 us, above its bound of 500 us"]),
        (100_000, 0, []),
        (100_000, 1, []),
        (
            99_999,
            1,
            [
                "control was observed to take 600 us, above its bound of 500 us",
                "control missed 1 deadline; the scenario does not expect it",
            ],
        ),
    ],
)
def test_what_the_host_is_known_to_have_withheld_is_not_held_against_the_controller(
    withheld: int, misses: int, said: list[str]
) -> None:
    lines = [f"P 1 100 {misses} 600000", f"W {withheld}", "END"]
    seen = read_trace(lines, read_map(trace_map(["x"])))
    rows = (Comparison("control", 100, misses, 600_000, 500_000, withheld),)
    ended = Ended(0, False, True, ())
    found = [
        *judge.failures(ended, None, seen, (), rows),
        *expected.judged(parse_scenario(BARE), None, expected.counted(seen, rows, (), ended)),
    ]
    assert found == said
    assert (rows[0].word == "host") == (not said)


@pytest.mark.parametrize(
    ("region", "state", "limit", "row"),
    [
        ("joint_x.Motion", "Drive", 0.1, (True, "after 60 ms", 0.1)),
        ("joint_x.Motion", "Drive", 0.05, (False, "after 60 ms", 0.1)),
        ("joint_x.Motion", "Drive", None, (True, "at 0.100 s", 0.1)),
        ("joint_x.Motion", "Limit", None, (False, "never: it visited Idle, Drive", 0.0)),
        ("a.B", "C", None, (False, "the trace map has no region a.B", 0.0)),
    ],
)
def test_expectations_about_the_trace(
    region: str, state: str, limit: float | None, row: tuple[bool, str, float]
) -> None:
    lines = ["T 0 STATE 10 0", "T 40000000 ARRIVED 11 0", "T 100000000 STATE 10 7"]
    seen = read_trace(lines, read_map(trace_map(["x"])))
    after = None if limit is None else "joint_x.feedback"
    words = None if limit is None else f"{limit * 1e3:g} ms"
    check = TraceCheck.model_validate(
        {"region": region, "reaches": state, "within": words, "after_last": after}
        if limit
        else {"region": region, "reaches": state}
    )
    (found,) = judge.check_trace([check], seen)
    assert (found.passed, found.outcome, found.at) == row
    assert isinstance(found, StepRow)
