# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A running controller is watched: what monitors show is what it reports, and how they end."""

from __future__ import annotations

import json
import os
import pty
import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from ravenchart.analysis.system.observed import Observation, read_map, read_trace
from ravenchart.building import checking, generation, programs
from ravenchart.paths import ROOT
from ravenchart.running.held_files import is_held
from ravenchart.running.process import ControllerProcess
from ravenchart.running.snapshots import VARIABLE, SnapshotFile, parsed_snapshot
from tests.support.ada_programs import built
from tests.support.examples import becomes
from tests.support.faults import shows
from tests.support.processes import LAUNCHER, Marked

PUMP = ROOT / "examples" / "pump" / "model.yaml"
TWO_NODES = ROOT / "examples" / "two_nodes" / "model.yaml"
LIMIT = 120.0
"""Seconds after which a monitor hangs, however busy the machine is."""


@pytest.fixture(scope="module")
def pump() -> programs.Program:
    """The program of the pump, written; `build` compiles it."""
    checked = checking.check(PUMP)
    generation.write_program(checked)
    return programs.programs_of(checked)[0]


class Watched:
    """A controller that runs, its trace and the file of its snapshots."""

    def __init__(self, program: programs.Program, folder: Path) -> None:
        self.file = folder / "live"
        self.trace = folder / "trace.txt"
        self._map = program.generated / programs.TRACE_MAP
        self.process = ControllerProcess(
            program.build(), self.trace, 0, **{VARIABLE: str(self.file)}
        )
        assert becomes(lambda: self.file.exists() and self._text() is not None)

    def _text(self) -> str | None:
        file = SnapshotFile(self.file)
        try:
            return file.text()
        finally:
            file.close()

    def sequence(self) -> int:
        """The number of its last snapshot."""
        text = self._text()
        assert text is not None
        return parsed_snapshot(text, read_map(self._map.read_text("utf-8")), "live").sequence

    def report(self) -> Observation:
        """What its trace and report say."""
        with self.trace.open(encoding="ascii") as lines:
            return read_trace(lines, read_map(self._map.read_text("utf-8")))


@pytest.fixture
def watched(pump: programs.Program, tmp_path: Path) -> Iterator[Watched]:
    one = Watched(pump, tmp_path)
    try:
        yield one
    finally:
        one.process.stop(0.0)


@contextmanager
def monitoring(*words: str | Path) -> Iterator[Marked]:
    """A monitor of the pump, and at the end nothing of it."""
    one = Marked([LAUNCHER, "monitor", PUMP, *words])
    try:
        yield one
    finally:
        one.kill()
        one.process.communicate()


def objects(text: str) -> list[dict[str, Any]]:
    """The one node in each line of a monitor with `--json`."""
    return [json.loads(line)["nodes"][0] for line in text.splitlines()]


def first_line(one: Marked) -> str:
    """Wait for a line of a monitor."""
    assert one.process.stdout is not None
    line = one.process.stdout.readline()
    assert isinstance(line, str)
    return line


def rest_of(one: Marked) -> tuple[str, str]:
    """What a monitor prints until it ends, to its output and its errors.

    `communicate` would not have what the stream has read beyond the first line.
    """
    assert one.process.stdout is not None and one.process.stderr is not None
    rest, errors = one.process.stdout.read(), one.process.stderr.read()
    one.process.wait(LIMIT)
    return rest, errors


@pytest.mark.slow
@pytest.mark.live
def test_two_monitors_show_the_counts_of_the_report(watched: Watched) -> None:
    with (
        monitoring("--json", "--file", watched.file) as first,
        monitoring("--json", "--file", watched.file) as second,
    ):
        begun = [first_line(one) for one in (first, second)]
        ended = watched.process.stop(0.0)
        texts = [rest_of(one) for one in (first, second)]
        assert [one.process.returncode for one in (first, second)] == [0, 0], texts
    assert ended.exit_code == 0, ended.warnings
    report = watched.report()
    assert report.complete and report.records
    for start, (rest, errors) in zip(begun, texts, strict=True):
        nodes = objects(start + rest)
        last = nodes[-1]
        assert "error" not in errors
        assert last["ended"] and last["process"] is None
        counts = {one["name"]: one for one in last["processors"]}
        assert counts.keys() == report.processors.keys()
        for name, one in report.processors.items():
            found = counts[name]
            assert found["completed"] == one.releases
            assert found["misses"] == one.misses
            assert found["worst_response"] == one.worst_response
            assert found["last_response"] == one.last_response
            assert 0 < found["last_response"] <= found["worst_response"] or not one.releases
        assert last["lost"] == {what: n for what, n in report.losses.items() if n}
        assert last["faults"] == {what: n for what, n in report.faults.items() if n}
        fills = {one["name"]: one for one in last["queues"] if one["highest"] is not None}
        assert fills.keys() == report.queues.keys() != set()
        for name, fill in report.queues.items():
            found = fills[name]
            assert (found["waiting"], found["highest"]) == (fill.waiting, fill.highest)
            assert fill.waiting <= fill.highest <= found["depth"]
        for one in last["rows"]:
            assert one["executions"] == len(report.of("activity", one["name"])), one["name"]
            assert one["longest_execution"] == report.executions[one["name"]]
        for chart in last["charts"]:
            assert chart["transitions"] == len(report.of("transition", chart["name"]))
            if chart["state"] is not None:
                assert chart["state"] == report.visits(chart["name"])[-1].state
        for one in last["traffic"]:
            assert one["count"] == len(report.of(one["what"], one["name"])), one["name"]
        sequences = [one["sequence"] for one in nodes]
        assert sequences == sorted(sequences)


@pytest.mark.live
@pytest.mark.slow
@shows(
    "a controller is killed while a monitor watches it",
    found_by="its lock, which the kernel takes back",
    reaction="`monitor` ends with status 1",
)
def test_a_controller_that_is_killed_ends_its_monitor(watched: Watched) -> None:
    with monitoring("--json", "--file", watched.file) as one:
        process = objects(first_line(one))[0]["process"]
        os.kill(process, signal.SIGKILL)
        rest, errors = rest_of(one)
        assert one.process.returncode == 1
    last = objects(rest)[-1]
    assert last["process"] is None and not last["ended"]
    assert "the controller of board has ended without its report" in errors


@pytest.mark.live
@pytest.mark.slow
def test_a_monitor_that_is_interrupted_leaves_the_controller_alone(watched: Watched) -> None:
    with monitoring("--file", watched.file) as one:
        assert first_line(one)
        before = watched.sequence()
        one.process.send_signal(signal.SIGINT)
        _, errors = rest_of(one)
        assert one.process.returncode == 130
        assert "Traceback" not in errors
    assert becomes(lambda: watched.sequence() > before + 3)
    assert watched.process.stop(0.0).exit_code == 0


@pytest.mark.live
@pytest.mark.slow
@pytest.mark.parametrize("more", [{}, {"NO_COLOR": "1"}], ids=["colour", "NO_COLOR"])
def test_a_terminal_is_drawn_over_and_given_back(watched: Watched, more: dict[str, str]) -> None:
    leader, follower = pty.openpty()
    environment = {name: value for name, value in os.environ.items() if "_COLOR" not in name}
    process = subprocess.Popen(
        [LAUNCHER, "monitor", PUMP, "--file", watched.file],
        stdin=subprocess.DEVNULL, stdout=follower, stderr=subprocess.PIPE,
        env={**environment, "TERM": "xterm-256color", **more},
    )  # fmt: skip
    os.close(follower)
    shown = b""
    while b"snapshot" not in shown:
        shown += os.read(leader, 65_536)
    watched.process.stop(0.0)
    try:
        while part := os.read(leader, 65_536):
            shown += part
    except OSError:  # the terminal is closed
        pass
    finally:
        os.close(leader)
    assert process.wait(LIMIT) == 0
    assert process.stderr is not None
    process.stderr.close()
    text = shown.decode()
    assert "ended in order" in text
    assert ("\x1b[1m" in text) == (not more)
    assert text.count("\x1b[?25l") == text.count("\x1b[?25h") > 0  # the cursor is there again


@pytest.mark.live
@pytest.mark.slow
def test_nodes_that_run_has_started_are_found_and_so_is_their_bus(tmp_path: Path) -> None:
    run = Marked([LAUNCHER, "run", TWO_NODES, "--seconds", "600", "--report", tmp_path])
    try:
        found = _of_both_nodes(run)
        assert len({one["node"] for one in found["nodes"]}) == 2
        assert all(one["processors"] and one["process"] for one in found["nodes"])
        (bus,) = found["buses"]
        assert (bus["interface"], bus["gone"], bus["ended"]) == ("bus of a run", None, False)
        assert 0 < bus["load"] <= bus["bound"]
        assert sum(one["frames"] for one in bus["messages"]) == bus["frames"] > 10
        assert bus["missed"] == bus["unknown"] == bus["malformed"] == 0
        run.process.send_signal(signal.SIGINT)
        run.process.wait(LIMIT)
        assert run.gone(LIMIT)
    finally:
        run.kill()
        run.process.communicate()
    done = _once()
    assert done.returncode == 2
    assert "no controller of" in done.stderr


def _of_both_nodes(run: Marked) -> dict[str, Any]:
    """The result of a monitor, once both nodes run."""
    result: dict[str, Any] = {"nodes": [], "buses": []}

    def both() -> bool:
        assert run.process.poll() is None
        done = _once()
        if done.returncode == 0:
            result.update(json.loads(done.stdout)["result"])
        return len(result["nodes"]) == 2

    for _ in range(5):
        if becomes(both):
            break
    return result


def _once() -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [LAUNCHER, "monitor", TWO_NODES, "--once", "--json"],
        capture_output=True, text=True, timeout=LIMIT, check=False,
    )  # fmt: skip


# --- The runtime alone ------------------------------------------------------------


@pytest.fixture(scope="module")
def host() -> Callable[..., subprocess.CompletedProcess[str]]:
    """Executes `tests/ada/test_host.adb`, which no generated report belongs to."""
    program = built("checks", "loopback") / "test_host"

    def executed(file: Path | str) -> subprocess.CompletedProcess[str]:
        environment = {**os.environ, VARIABLE: str(file)}
        return subprocess.run(
            [program], env=environment, capture_output=True, text=True, timeout=LIMIT, check=False
        )

    return executed


Host = Callable[..., subprocess.CompletedProcess[str]]


@pytest.mark.slow
def test_a_hand_written_program_has_snapshots_too(host: Host, tmp_path: Path) -> None:
    file = tmp_path / "live"
    file.write_text("x" * 100_000)
    assert host(file).returncode == 0
    text = SnapshotFile(file).text()
    assert text is not None
    lines = text.splitlines()
    assert len(text) == file.stat().st_size
    assert not is_held(file)
    assert "C TRANSITION 17 2000 1000 -2000" in lines
    listed = [line for line in lines if line.startswith("T ")]
    assert listed == [f"T 1000 Transition 17 {-n}" for n in range(1969, 2001)]
    assert {"L snapshot 0", "END"} <= set(lines)
    assert len([line for line in lines if line.startswith("N ")]) == 1


def test_what_cannot_be_watched_runs_all_the_same(host: Host, tmp_path: Path) -> None:
    for file in ("/dev/full", tmp_path / "none" / "live"):
        done = host(file)
        assert done.returncode == 0
        assert "no monitor can watch this run" in done.stderr


@shows(
    "two controllers are told the same file of snapshots",
    found_by="the lock of the first",
    reaction="the second one warns and runs unwatched",
)
def test_a_file_belongs_to_one_controller(host: Host, tmp_path: Path) -> None:
    from tests.support.snapshot_files import held

    file = tmp_path / "live"
    file.write_text("of the first")
    with held(file):
        done = host(file)
    assert done.returncode == 0
    assert "cannot be locked: no monitor can watch this run" in done.stderr
    assert file.read_text() == "of the first"
