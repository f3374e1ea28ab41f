# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The python-can backend and python-can's tools, over the bus server."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import can
import pytest

from ravenchart.command_line import main
from ravenchart.hw_can.bench.bus_client import RavenchartBus
from tests.support.can_bus import started
from tests.support.can_frames import WAIT, mixed_frames, taken

pytestmark = pytest.mark.clock

ROOT = Path(__file__).parents[2]


@pytest.fixture
def channel() -> Iterator[str]:
    with started() as one:
        yield one


@pytest.fixture
def pair(channel: str) -> Iterator[tuple[RavenchartBus, RavenchartBus]]:
    with RavenchartBus(channel, fd=True) as a, RavenchartBus(channel, fd=True) as b:
        yield a, b


def same(sent: list[can.Message], received: list[can.Message], *, direction: bool = True) -> bool:
    return len(sent) == len(received) and all(
        a.equals(b, timestamp_delta=None, check_channel=False, check_direction=direction)
        for a, b in zip(sent, received, strict=True)
    )


def test_a_thousand_mixed_frames_are_exact_both_ways(
    pair: tuple[RavenchartBus, RavenchartBus],
) -> None:
    frames = mixed_frames(1_000)
    for sender, receiver in (pair, pair[::-1]):
        feeding = threading.Thread(target=lambda s=sender: [s.send(frame) for frame in frames])
        feeding.start()
        got = taken(receiver, len(frames))
        feeding.join()
        assert same(frames, got)
        assert [m.timestamp for m in got] == sorted(m.timestamp for m in got)
        assert abs(got[-1].timestamp - time.time()) < 60


def test_who_only_sends_need_not_receive(
    pair: tuple[RavenchartBus, RavenchartBus],
) -> None:
    sender, receiver = pair
    got: list[can.Message] = []
    taking = threading.Thread(target=lambda: got.extend(taken(receiver, 20_000)))
    taking.start()
    for number in range(20_000):
        sender.send(can.Message(arbitration_id=number % 0x7FF, is_extended_id=False))
    taking.join()
    assert [m.arbitration_id for m in got] == [number % 0x7FF for number in range(20_000)]


def test_three_nodes_hear_each_other_and_not_themselves(channel: str) -> None:
    with (
        RavenchartBus(channel, receive_own_messages=True) as a,
        RavenchartBus(channel) as b,
        RavenchartBus(channel) as c,
    ):
        frame = can.Message(arbitration_id=5, data=b"x")
        a.send(frame, timeout=WAIT)
        others = [b.recv(WAIT), c.recv(WAIT)]
        own = a.recv(WAIT)
        assert own is not None and not own.is_rx and own.data == b"x"
        for other in others:
            assert other is not None and other.is_rx and other.timestamp == own.timestamp
        b.send(frame, timeout=WAIT)
        assert b.recv(0.05) is None
        assert len({bus.channel_info for bus in (a, b, c)}) == 3


def test_an_fd_frame_needs_an_fd_bus_and_spares_the_classic_node(channel: str) -> None:
    frame = can.Message(arbitration_id=1, is_fd=True, data=bytes(64))
    with RavenchartBus(channel, fd=True) as a, RavenchartBus(channel) as b:
        assert (a.protocol, b.protocol) == (can.CanProtocol.CAN_FD, can.CanProtocol.CAN_20)
        a.send(frame, timeout=WAIT)
        assert b.recv(0.05) is None
        with pytest.raises(can.CanOperationError, match="not opened for FD"):
            b.send(frame)


def test_the_notifier_and_periodic_sending(pair: tuple[RavenchartBus, RavenchartBus]) -> None:
    a, b = pair
    reader = can.BufferedReader()
    notifier = can.Notifier(b, [reader], timeout=0.1)
    task = a.send_periodic(can.Message(arbitration_id=0x55, data=b"p"), 0.01)
    got = [reader.get_message(WAIT) for _ in range(10)]
    task.stop()
    b.send(can.Message(arbitration_id=7), timeout=WAIT)
    notifier.stop()
    assert all(message is not None and message.arbitration_id == 0x55 for message in got)


def test_a_waiting_sender_and_a_receiver_in_another_thread(
    pair: tuple[RavenchartBus, RavenchartBus],
) -> None:
    a, b = pair
    got: list[can.Message] = []
    receiving = threading.Thread(target=lambda: got.extend(taken(a, 100)))
    receiving.start()
    for number in range(100):
        b.send(can.Message(arbitration_id=number))
        a.send(can.Message(arbitration_id=0x100 + number), timeout=WAIT)
    receiving.join()
    assert [m.arbitration_id for m in got] == list(range(100))


def test_a_log_in_blf_is_played_back_exactly(
    pair: tuple[RavenchartBus, RavenchartBus], tmp_path: Path
) -> None:
    a, b = pair
    frames = mixed_frames(200, seed=3)
    path = tmp_path / "bus.blf"
    with can.Logger(path) as logger:
        for frame in frames:
            a.send(frame)
        logged = taken(b, len(frames))
        for message in logged:
            logger(message)
    with can.LogReader(path) as reader:
        read = list(reader)
    assert same(logged, read)
    for message in can.MessageSync(read, timestamps=False):
        b.send(message)
    assert same(frames, taken(a, len(frames)))


def tool_environment(folder: Path) -> dict[str, str]:
    """Where python-can finds the entry points of pyproject.toml, installed or not."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    (target,) = project["entry-points"]["can.interface"].items()
    info = folder / "backend-1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: backend\nVersion: 1\n")
    (info / "entry_points.txt").write_text("[can.interface]\n{} = {}\n".format(*target))
    return {**os.environ, "PYTHONPATH": f"{folder}{os.pathsep}{ROOT}"}


def heed_interrupts() -> None:
    """What runs in the background may have inherited that they are ignored."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@contextmanager
def ended(process: subprocess.Popen[Any]) -> Iterator[None]:
    """Whatever happens, the process does not go on."""
    try:
        yield
    finally:
        process.kill()


def test_the_tools_of_python_can_log_and_play(channel: str, tmp_path: Path) -> None:
    environment, log = tool_environment(tmp_path), tmp_path / "tool.blf"
    common = ["-i", "ravenchart", "-c", channel, "--fd"]
    frames = mixed_frames(40, seed=4, errors=False)
    with (
        RavenchartBus(channel, fd=True) as bus,
        subprocess.Popen(
            [sys.executable, "-m", "can.logger", *common, "-f", str(log)],
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            preexec_fn=heed_interrupts,
        ) as logger,
        ended(logger),
    ):
        for frame in frames:
            bus.send(frame, timeout=WAIT)
        time.sleep(0.5)
        logger.send_signal(signal.SIGINT)
        logger.communicate(timeout=30)
        with can.LogReader(log) as reader:
            assert same(frames, list(reader))
        played = subprocess.run(
            [sys.executable, "-m", "can.player", *common, "--ignore-timestamps", str(log)],
            env=environment, capture_output=True, timeout=60,
        )  # fmt: skip
        assert played.returncode == 0, played.stderr
        heard = iter(lambda: bus.recv(1.0), None)
        assert same(frames, [m for m in heard if not m.is_error_frame])


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".blf", ".asc", ".log", ".csv"])
def test_a_bus_writes_its_log_in_the_formats_of_python_can(tmp_path: Path, suffix: str) -> None:
    """Every frame in the order of the bus, although nobody reads it but the other node."""
    log = tmp_path / f"bus{suffix}"
    frames = [f for f in mixed_frames(300, seed=5, errors=False) if not f.is_remote_frame]
    if suffix == ".csv":  # the format has no FD
        frames = [f for f in frames if not f.is_fd]
    if suffix == ".asc":  # python-can reads an FD frame without data as a remote frame
        frames = [f for f in frames if f.dlc or not f.is_fd]
    command = [sys.executable, "-P", "-m", "ravenchart", "bus", "--port", "0", "--log", str(log)]
    with subprocess.Popen(
        [*command, "--fault", "3:disturbed_bit:0:20"], stdout=subprocess.PIPE, text=True,
        cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}, preexec_fn=heed_interrupts,
    ) as server, ended(server):  # fmt: skip
        assert server.stdout is not None
        one = server.stdout.readline().split()[-1]
        with RavenchartBus(one, fd=True) as a, RavenchartBus(one, fd=True) as b:
            for frame in frames:
                a.send(frame)
            heard = [m for m in taken(b, len(frames) + 1) if not m.is_error_frame]
        server.send_signal(signal.SIGINT)
        server.wait(20)
    with can.LogReader(log) as reader:
        read = list(reader)
    assert [m.is_error_frame for m in read[:4]] == [False, False, True, False]
    del read[2]
    assert same(frames, read, direction=False)
    begun = read[0].timestamp, heard[0].timestamp
    for logged, message in zip(read, heard, strict=True):
        spent = logged.timestamp - begun[0], message.timestamp - begun[1]
        assert spent[0] == pytest.approx(spent[1], abs=2e-5)


def test_a_log_of_no_known_format_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as over:
        main(["bus", "--log", "bus.txt2"])
    assert over.value.code == 2
    assert "'bus.txt2' has no suffix of .asc, .blf" in capsys.readouterr().err


KILLED = """
import can, sys
from hw_can.bench.bus_client import RavenchartBus
bus = RavenchartBus(sys.argv[1])
while True:
    bus.send(can.Message(arbitration_id=9, data=bytes(8)), timeout=10)
"""


def test_a_client_killed_in_the_middle_leaves_the_others_alone(channel: str) -> None:
    with RavenchartBus(channel) as a, RavenchartBus(channel) as b:
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        with (
            subprocess.Popen([sys.executable, "-c", KILLED, channel], env=environment) as p,
            ended(p),
        ):
            assert a.recv(30) is not None
        a.send(can.Message(arbitration_id=1), timeout=WAIT)
        assert any(m.arbitration_id == 1 for m in iter(lambda: b.recv(WAIT), None))
