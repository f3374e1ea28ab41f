# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The shell and scenarios on real buses: the robot's controller in a process of its own."""

from __future__ import annotations

import asyncio
import os
import pty
import select
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import pytest

from ravenchart.building import checking, programs
from ravenchart.running import server
from ravenchart.running.process import ControllerProcess
from ravenchart.running.remote import NoAnswerError, connect
from tests.support import live
from tests.support.processes import LAUNCHER
from tests.support.serial_bus import SerialBus

pytestmark = pytest.mark.alone

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

OWN_MOVES = """\
send Home x=0 y=0 z=0
wait_for Mission Homing 2 s
wait_for Mission Ready 8 s
send Move x=100_000
wait_for joint_x.Motion Cruising 4 s
wait_for Mission Ready 8 s
status robot_status Mission
"""

Robot = tuple[checking.Checked, Path]


HELD_UP = "the host held the bench up"


def called(*words: object, given: str = "") -> str:
    """What a command prints to standard output; it ends with status 0, or the host had no time."""
    done = subprocess.run(
        [LAUNCHER, *map(str, words)], input=given, capture_output=True, text=True, timeout=120
    )
    if done.returncode and HELD_UP in done.stdout + done.stderr:
        return HELD_UP
    assert done.returncode == 0, (done.stdout, done.stderr)
    return done.stdout


def played(play: Callable[[], str]) -> list[str]:
    """The lines of a call; where the host held up its bench, of another one."""
    out = HELD_UP
    for _ in range(live.TIMES):
        if out == HELD_UP:
            out = play()
    return out.splitlines()


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


@contextmanager
def bus_of(on_bus: Path, folder: Path, **environment: str) -> Iterator[str]:
    """A bus server with the controller on it, two processes of their own; the channel."""
    with server.running("port=0") as (_, place):
        named = {"RAVENCHART_BUS_PORT": place.rpartition(":")[2], "RAVENCHART_BUS_NAME": "robot"}
        with controller(on_bus, folder, **named, **environment) as process:
            process.wait_until_joined()
            yield place


@pytest.mark.slow
def test_a_script_leads_the_controller_that_the_shell_starts(robot: Robot, tmp_path: Path) -> None:
    log = tmp_path / "shell.blf"
    words = ("shell", MODEL, "--drives", SCENARIO, "--log", log)
    out = played(lambda: called(*words, given=OWN_MOVES))
    first = next(n for n, line in enumerate(out) if line.startswith("sent robot_command: "))
    assert out[first] == "sent robot_command: kind Home, x 0, y 0, z 0"
    assert out[first + 3] == "sent robot_command: kind Move, x 100000, y 0, z 0"
    told = out[-3].split("condition ")[1].split(", ")
    assert told[0] == "Ready" and abs(int(told[1].split()[1]) - 100_000) < 5_000
    name, age, state, *_ = out[-1].split()
    assert (name, state) == ("coordinator.Mission", "Ready") and float(age) < 1
    assert max(map(len, out[first:])) <= 80
    with can.LogReader(log) as frames:
        assert {0x080, 0x120, 0x180} <= {frame.arbitration_id for frame in frames}


@pytest.mark.slow
def test_the_shell_joins_a_controller_on_a_bus_server(on_bus: Path, tmp_path: Path) -> None:
    def play() -> str:
        with bus_of(on_bus, tmp_path) as channel:
            words = ("shell", MODEL, "--interface", "ravenchart", "--channel", channel)
            out = called(*words, "--drives", SCENARIO, given=MOVES)
            #  the drives have left with the first shell
            return out + called(*words, given="wait_for condition Failed 5 s\n")

    out = played(play)
    assert "built" not in out[0] and "condition Ready" in out[-2]
    assert out[-1].startswith("condition is Failed after ")


@pytest.mark.slow
def test_a_program_in_python_does_the_same(on_bus: Path, tmp_path: Path) -> None:
    live = tmp_path / "live"

    def play() -> str:
        live.write_text("")
        with (
            bus_of(on_bus, tmp_path, RAVENCHART_MONITOR=str(live)) as channel,
            connect(
                MODEL, interface="ravenchart", channel=channel, drives=SCENARIO, files=[live]
            ) as robot,
        ):
            try:
                robot.send("Home", x=0, y=0, z=0)
                asyncio.run(robot.state("robot_status.condition", "Ready", timeout=8))
                asyncio.run(robot.state("Mission", "Ready", timeout=2))
                assert robot.status["robot_status"]["condition"] == "Ready"
                assert robot.charts["joint_x.Motion"].state == "Idle"
                robot.pull("x", "low")
                robot.send("Move", x=50_000)
                robot.wait_for("condition", "Failed", 5)
                assert robot.wait_for("Mission", "Failed", 5) < 1
            except NoAnswerError:
                if robot.skipped:
                    return HELD_UP
                raise
        return "done"

    assert played(play) == ["done"]


SEEN = (
    "verdict: PASS (timing, expect_trace, expect not judged: only the frames on the bus are seen)"
)


def scenario(tmp_path: Path, interface: str, channel: object) -> str:
    """Play the robot's scenario there."""
    bus = ("--interface", interface, "--channel", channel, "--report", tmp_path / "report")
    return called("run", MODEL, "--scenario", SCENARIO, *bus)


@pytest.mark.slow
def test_a_scenario_is_played_on_a_bus_server(on_bus: Path, tmp_path: Path) -> None:
    def play() -> str:
        with bus_of(on_bus, tmp_path) as channel:
            return scenario(tmp_path, "ravenchart", channel)

    assert played(play)[-1] == SEEN


@pytest.mark.slow
def test_a_scenario_is_played_by_slcan_over_tcp(robot: Robot, tmp_path: Path) -> None:
    def play() -> str:
        with controller(robot[1], tmp_path) as process:
            return scenario(tmp_path, "slcan", f"socket://127.0.0.1:{process.wait_for_port()}")

    assert played(play)[-1] == SEEN


@pytest.mark.slow
def test_a_scenario_is_played_by_slcan_over_a_serial_line(robot: Robot, tmp_path: Path) -> None:
    """Two adapters on one bus: the controller has one, and the bench the other."""

    def play() -> str:
        with (
            SerialBus(tmp_path / "own", tmp_path / "bench") as (own, bench),
            controller(robot[1], tmp_path, RAVENCHART_CAN_DEVICE=str(own)),
        ):
            return scenario(tmp_path, "slcan", bench)

    assert played(play)[-1] == SEEN


@pytest.mark.slow
def test_a_terminal_completes_names_and_goes_on_after_a_mistake(
    on_bus: Path, tmp_path: Path
) -> None:
    with bus_of(on_bus, tmp_path) as channel:
        master, slave = pty.openpty()
        words = [str(LAUNCHER), "shell", str(MODEL)]
        with subprocess.Popen(
            [*words, "--interface", "ravenchart", "--channel", channel],
            stdin=slave, stdout=slave, stderr=slave, env={**os.environ, "TERM": "xterm"},
        ) as process:  # fmt: skip
            os.close(slave)
            assert "> " in expected(master, "Ctrl-D ends\r\n> ")
            os.write(master, b"sen\tHom\tx=0 y=0\n")
            assert "`Home` needs `z`" in expected(master, "from -20000 to 500000, in um\r\n")
            os.write(master, b"wait_for condition Mov\t60 s\n")
            assert "Moving 60 s\r\n" in expected(master, "Moving 60 s\r\n")
            process.send_signal(signal.SIGINT)  # as Ctrl-C does in the terminal that it has
            assert "\r\n> " in expected(master, "\r\n> ")
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
