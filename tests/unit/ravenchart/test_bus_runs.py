# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`run --interface`: a scenario played to a controller that runs already, and its verdict."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import can
import pytest

from ravenchart.command_line import main
from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.hw_can.bench.peer import FrameValues
from ravenchart.paths import ROOT
from tests.support.answers import answered
from tests.support.bus_server import BusServer
from tests.support.far_end import ROBOT, Answer, FarEnd, obedient, robot

MODEL = ROBOT / "model.yaml"
PRINTED = pytest.CaptureFixture[str]

HOMES = """\
scenario: It homes
steps:
  - {send: robot_command, with: {kind: Home, x: 0, y: 0, z: 0}}
  - {wait_for: robot_status.condition, is: Ready, within: 5 s}
"""
EXPECTS = """\
expect_trace:
  - {region: coordinator.Mission, reaches: Ready}
expect:
  - {fault: Stale_Input, times: 3, because: nobody is there}
"""


@pytest.fixture
def far(server: BusServer) -> Iterator[FarEnd]:
    """A robot on that bus that obeys."""
    one = FarEnd(RavenchartBus(server.channel, fd=True), robot(), obedient)
    yield one
    one.close()


def words(tmp_path: Path, server: BusServer, scenario: str, *more: str) -> list[str]:
    """A call of `run`, with its report in a folder of its own."""
    plan = tmp_path / "scenario.yaml"
    plan.write_text(scenario)
    bus = ("--interface", "ravenchart", "--channel", server.channel)
    report = ("--report", str(tmp_path / "report"))
    return ["run", str(MODEL), "--scenario", str(plan), *bus, *report, *more]


@pytest.mark.slow
def test_a_scenario_is_played_and_nothing_is_started(
    tmp_path: Path, server: BusServer, far: FarEnd, capsys: PRINTED
) -> None:
    log = tmp_path / "run.asc"
    assert main(words(tmp_path, server, HOMES, "--log", str(log))) == 0
    out, errors = capsys.readouterr()
    assert far.hears("robot_command")["kind"] == "Home"
    assert "built" not in out and errors == ""
    assert out.splitlines()[-1] == (
        "verdict: PASS (timing not judged: only the frames on the bus are seen)"
    )
    page = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    assert "timing not judged: only the frames on the bus are seen" in page
    with can.LogReader(log) as frames:
        assert {frame.arbitration_id for frame in frames} == {0x080, 0x180}


@pytest.mark.slow
def test_what_cannot_be_seen_is_named_and_not_judged(
    tmp_path: Path, server: BusServer, far: FarEnd, capsys: PRINTED
) -> None:
    call = words(tmp_path, server, HOMES + EXPECTS)
    assert main([*call, "--strict"]) == 3
    out = capsys.readouterr().out
    assert "note: not judged: trace: coordinator.Mission in Ready\n" in out
    assert "note: not judged: 3 Stale_Input\n" in out
    assert out.splitlines()[-1] == (
        "verdict: PASS (timing, expect_trace, expect not judged: only the frames on the bus are "
        "seen)"
    )
    result = answered(capsys, *call)["result"]
    assert result["passed"] and result["not_judged"] == "only the frames on the bus are seen"
    assert result["processors"] == result["chains"] == []
    assert [one for one in result["notes"] if one.startswith("not judged: ")] == [
        "not judged: trace: coordinator.Mission in Ready", "not judged: 3 Stale_Input",
    ]  # fmt: skip


@pytest.mark.slow
def test_a_bus_without_the_controller_fails_even_where_no_step_does(
    tmp_path: Path, server: BusServer, capsys: PRINTED
) -> None:
    text = "scenario: Nobody is there\nsteps:\n  - wait: 50 ms\n"
    assert main(words(tmp_path, server, text)) == 1
    assert capsys.readouterr().out.splitlines()[-1] == (
        f"verdict: FAIL: no frame of the controller came from ravenchart '{server.channel}': does "
        "it run there, at 500000 bit/s?"
    )


@pytest.mark.slow
def test_a_step_that_fails_fails_the_run(
    tmp_path: Path, server: BusServer, far: FarEnd, capsys: PRINTED
) -> None:
    text = HOMES.replace("is: Ready, within: 5 s", "is: Failed, within: 50 ms")
    assert main(words(tmp_path, server, text)) == 1
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.startswith("verdict: FAIL: wait for robot_status.condition = Failed: not within ")


@pytest.mark.slow
def test_a_bus_that_goes_away_fails_the_run_and_is_named(
    tmp_path: Path, server: BusServer, capsys: PRINTED
) -> None:
    def leave(_name: str, _values: FrameValues) -> list[Answer]:
        threading.Thread(target=server.cut).start()
        return []

    far = FarEnd(RavenchartBus(server.channel, fd=True), robot(), leave)
    assert main(words(tmp_path, server, HOMES)) == 1
    assert f"ravenchart '{server.channel}': the bus server" in capsys.readouterr().out
    far.close()


@pytest.mark.slow
def test_a_file_of_frames_is_replayed_to_it(
    tmp_path: Path, server: BusServer, far: FarEnd, capsys: PRINTED
) -> None:
    with can.BLFWriter(tmp_path / "kept.blf") as log:
        for kind in ("Home", "Move"):
            values = {"kind": kind, "x": 5, "y": 0, "z": 0}
            log.on_message_received(far.words.codec.encode("robot_command", values))
    text = "scenario: As kept\nsteps:\n  - replay: kept.blf\n  - wait: 100 ms\n"
    assert main(words(tmp_path, server, text)) == 0
    assert [values["kind"] for _, values in far.heard] == ["Home", "Move"]
    assert "2 of 2 frames sent" in capsys.readouterr().out


def test_events_on_the_bus_are_refused_with_their_line(
    tmp_path: Path, server: BusServer, capsys: PRINTED
) -> None:
    two_nodes = ROOT / "examples" / "two_nodes" / "model.yaml"
    plan = ROOT / "examples" / "two_nodes" / "cut_bus.yaml"
    bus = ("--interface", "ravenchart", "--channel", server.channel)
    assert main(["run", str(two_nodes), "--scenario", str(plan), *bus]) == 1
    errors = capsys.readouterr().err
    assert "error: `bus` is for the simulated bus, not for one at `--interface` [RV-1306]" in errors
    assert f"{plan}:" in errors and " | bus:\n      | ^\n" in errors
    assert "hint: remove `bus`, or run it without" in errors


@pytest.mark.parametrize(
    ("told", "text"),
    [
        (("--interface", "ravenchart", "--channel", "127.0.0.1:1"),
         "--interface needs --scenario: what is to be played there"),
        (("--interface", "ravenchart"), "--interface and --channel go together"),
        (("--interface", "ravenchart", "--channel", "x", "--target", "zynqmp"),
         "--interface and --target exclude each other: nothing is built"),
        (("--scenario", str(ROBOT / "scenario.yaml"), "--interface", "none", "--channel", "x"),
         "python-can has no interface 'none'; it has "),
        (("--scenario", str(ROBOT / "scenario.yaml"), "--interface", "ravenchart", "--channel",
          "127.0.0.1:1"), "ravenchart '127.0.0.1:1' cannot be opened: "),
    ],
)  # fmt: skip
def test_what_cannot_be_played_is_status_2(
    told: tuple[str, ...], text: str, capsys: PRINTED
) -> None:
    assert main(["run", str(MODEL), *told]) == 2
    assert f"ravenchart: error: {text}" in capsys.readouterr().err
