"""The shell and scenarios on real buses: the robot's controller in a process of its own."""

from __future__ import annotations

import asyncio
import os
import pty
import select
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import pytest

from ravenchart.building import checking, programs
from ravenchart.running import server
from ravenchart.running.process import ControllerProcess
from ravenchart.running.remote import connect
from tests.support.processes import LAUNCHER
from tests.support.serial_bus import SerialBus

pytestmark = pytest.mark.live

ROBOT = Path("examples/cartesian_robot")
MODEL, SCENARIO = ROBOT / "model.yaml", ROBOT / "scenario.yaml"

MOVES = """\
send Home x=0 y=0 z=0
wait_for condition Ready 8 s
send Move x=100_000
wait_for condition Moving 2 s
wait_for condition Ready 8 s
status robot_status
"""

Robot = tuple[checking.Checked, Path]


def called(*words: object, given: str = "", status: int = 0) -> str:
    """What a command prints to standard output."""
    done = subprocess.run(
        [LAUNCHER, *map(str, words)], input=given, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == status, (done.stdout, done.stderr)
    return done.stdout


@contextmanager
def controller(program: Path, folder: Path, **environment: str) -> Iterator[ControllerProcess]:
    """The controller, which ends in order."""
    process = ControllerProcess(program, folder / "trace.txt", 0, **environment)
    try:
        yield process
    finally:
        ended = process.stop(1.0)
    assert (ended.exit_code, ended.killed) == (0, False)


@pytest.fixture(scope="module")
def on_bus(robot: Robot) -> Path:
    """The controller as a node of a bus server."""
    return programs.programs_of(robot[0])[0].build(driver="bus")


@pytest.fixture
def channel(on_bus: Path, tmp_path: Path) -> Iterator[str]:
    """A bus server with the controller on it, two processes of their own."""
    with server.running("port=0") as (_, place):
        named = {"RAVENCHART_BUS_PORT": place.rpartition(":")[2], "RAVENCHART_BUS_NAME": "robot"}
        with controller(on_bus, tmp_path, **named) as process:
            process.wait_until_joined()
            yield place


def test_a_script_leads_the_controller_that_the_shell_starts(robot: Robot, tmp_path: Path) -> None:
    log = tmp_path / "shell.blf"
    out = called("shell", MODEL, "--drives", SCENARIO, "--log", log, given=MOVES).splitlines()
    first = next(n for n, line in enumerate(out) if line.startswith("sent robot_command: "))
    assert out[first] == "sent robot_command: kind Home, x 0, y 0, z 0"
    assert out[first + 2] == "sent robot_command: kind Move, x 100000, y 0, z 0"
    told = out[-1].split("condition ")[1].split(", ")
    assert told[0] == "Ready" and abs(int(told[1].split()[1]) - 100_000) < 5_000
    assert max(map(len, out[first:])) <= 80
    with can.LogReader(log) as frames:
        assert {0x080, 0x120, 0x180} <= {frame.arbitration_id for frame in frames}


def test_the_shell_joins_a_controller_on_a_bus_server(channel: str) -> None:
    bus = ("--interface", "ravenchart", "--channel", channel, "--drives", SCENARIO)
    out = called("shell", MODEL, *bus, given=MOVES)
    assert "built" not in out and "condition Ready" in out.splitlines()[-1]
    out = called("shell", MODEL, *bus, given="wait_for x_set_point.mode Enabled 5 s\n")
    assert out.startswith("x_set_point.mode is Enabled after ")


def test_a_program_in_python_does_the_same(channel: str) -> None:
    with connect(MODEL, interface="ravenchart", channel=channel, drives=SCENARIO) as robot:
        robot.send("Home", x=0, y=0, z=0)
        asyncio.run(robot.state("robot_status.condition", "Ready", timeout=8))
        assert robot.status["robot_status"]["condition"] == "Ready"
        robot.pull("x", "low")
        robot.send("Move", x=50_000)
        robot.wait_for("condition", "Failed", 5)


def test_a_scenario_is_played_on_a_bus_server(channel: str, tmp_path: Path) -> None:
    bus = ("--interface", "ravenchart", "--channel", channel, "--report", tmp_path / "report")
    out = called("run", MODEL, "--scenario", SCENARIO, *bus)
    assert out.splitlines()[-1] == (
        "verdict: PASS (timing, expect_trace, expect not judged: only the frames on the bus are "
        "seen)"
    )


def test_a_scenario_is_played_by_slcan_over_tcp(robot: Robot, tmp_path: Path) -> None:
    with controller(robot[1], tmp_path) as process:
        place = f"socket://127.0.0.1:{process.wait_for_port()}"
        bus = ("--interface", "slcan", "--channel", place, "--report", tmp_path / "report")
        out = called("run", MODEL, "--scenario", SCENARIO, *bus)
    assert "verdict: PASS (timing, " in out.splitlines()[-1]


def test_a_scenario_is_played_by_slcan_over_a_serial_line(robot: Robot, tmp_path: Path) -> None:
    """Two adapters on one bus: the controller has one, and the bench the other."""
    with (
        SerialBus(tmp_path / "own", tmp_path / "bench") as (own, bench),
        controller(robot[1], tmp_path, RAVENCHART_CAN_DEVICE=str(own)),
    ):
        bus = ("--interface", "slcan", "--channel", bench, "--report", tmp_path / "report")
        out = called("run", MODEL, "--scenario", SCENARIO, *bus)
    assert "verdict: PASS (timing, " in out.splitlines()[-1]


def test_a_terminal_completes_names_and_goes_on_after_a_mistake(channel: str) -> None:
    master, slave = pty.openpty()
    words = [str(LAUNCHER), "shell", str(MODEL), "--interface", "ravenchart", "--channel", channel]
    with subprocess.Popen(
        words, stdin=slave, stdout=slave, stderr=slave, env={**os.environ, "TERM": "xterm"}
    ) as process:
        os.close(slave)
        assert "> " in expected(master, "Ctrl-D ends\r\n> ")
        os.write(master, b"sen\tHom\tx=0 y=0\n")
        assert "`Home` needs `z`" in expected(master, "from -20000 to 500000, in um\r\n")
        os.write(master, b"wait_for condition Mov\t60 s\n")
        assert "Moving 60 s\r\n" in expected(master, "Moving 60 s\r\n")
        os.write(master, b"\x03")
        expected(master, "> ")
        os.write(master, b"\x04")
        assert process.wait(30) == 0
        os.close(master)


def expected(master: int, text: str) -> str:
    """What the terminal shows until a text has come."""
    shown, end = "", time.monotonic() + 60
    while text not in shown and time.monotonic() < end:
        if select.select([master], [], [], 0.2)[0]:
            shown += os.read(master, 1024).decode()
    return shown
