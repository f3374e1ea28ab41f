# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The slcan driver by TCP, and as the host of an adapter on a serial line: one end of a pty."""

from __future__ import annotations

import os
import select
import subprocess
import time
import tty
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import pytest

from tests.support.ada_programs import built
from tests.support.can_frames import FD_LENGTHS, WAIT

pytestmark = pytest.mark.clock

LIMIT = 20.0
"""Seconds within which something must have happened."""


class Adapter:
    """An slcan adapter behind a device file that stays where it is when it is plugged in again."""

    def __init__(self, device: Path) -> None:
        self.device = device
        self.master = -1
        self.plug_in()

    def plug_in(self) -> None:
        """A new line, under the same name."""
        self.master, slave = os.openpty()
        tty.setraw(slave)
        self.device.unlink(missing_ok=True)
        self.device.symlink_to(os.ttyname(slave))
        self._slave = slave

    def unplug(self) -> None:
        """The line is gone."""
        self.device.unlink()
        os.close(self._slave)
        os.close(self.master)

    def heard(self, text: str) -> None:
        """Wait until exactly this has been written by the host."""
        found, end = "", time.monotonic() + LIMIT
        while len(found) < len(text) and time.monotonic() < end:
            if select.select([self.master], [], [], 0.1)[0]:
                found += os.read(self.master, len(text) - len(found)).decode()
        assert found == text

    def say(self, text: str) -> None:
        """Write to the host."""
        os.write(self.master, text.encode())


@pytest.fixture(scope="module")
def program() -> Path:
    return built("checks", "slcan", "can_echo") / "can_echo"


@contextmanager
def running(program: Path, device: Path, **environment: str) -> Iterator[subprocess.Popen[str]]:
    """The echo, number 3: it answers frames whose identifier leaves 3 when divided by 4."""
    with subprocess.Popen(
        [program, "3"],
        env={**os.environ, "RAVENCHART_CAN_DEVICE": str(device), **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def test_it_opens_the_channel_and_speaks_with_the_adapter(program: Path, tmp_path: Path) -> None:
    adapter = Adapter(tmp_path / "adapter")
    with running(program, adapter.device, RAVENCHART_CAN_SPEED="4"):
        adapter.heard("C\rS4\rY2\rO\r")
        adapter.say("\r\r")
        adapter.say("t1233AABBCC\r")
        adapter.heard("t1243AABBCC\r")
        adapter.say("b1239" + 24 * "A" + "\r")
        adapter.heard("b1249" + 24 * "A" + "\r")
        adapter.say("z\rT000000070\rT000012330\r")  # the filter refuses the first
        adapter.heard("T000012340\r")
        adapter.say("Z\r\x07r1232\r")
        adapter.heard("r1242\r")


def test_on_a_classic_bus_a_line_of_can_fd_is_refused(program: Path, tmp_path: Path) -> None:
    adapter = Adapter(tmp_path / "adapter")
    with running(program, adapter.device, CAN_ECHO_CLASSIC="1"):
        adapter.heard("C\rS6\rO\r")
        adapter.say("d1230\rt1230\r")
        adapter.heard("t1240\r")


def test_python_can_exchanges_frames_of_both_families_by_tcp(program: Path) -> None:
    sent = [
        can.Message(
            arbitration_id=identifier,
            is_extended_id=identifier > 0x7FF,
            is_fd=fd,
            bitrate_switch=switch,
            data=bytes(range(length)),
        )
        for identifier in (0x123, 0x1FFFFFFB)
        for fd, switch in ((False, False), (True, False), (True, True))
        for length in FD_LENGTHS
        if fd or length <= 8
    ]
    environment = {**os.environ, "RAVENCHART_CAN_PORT": "0"}
    with subprocess.Popen(
        [program, "3"], env=environment, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        place = next(line for line in process.stdout if line.startswith("can: slcan on ")).split()
        with can.Bus(interface="slcan", channel=f"socket://{place[-1]}", sleep_after_open=0) as bus:
            got = []
            for message in sent:
                bus.send(message)
                got.append(bus.recv(WAIT))
        process.kill()
    assert [(m.arbitration_id, m.is_fd, m.bitrate_switch, bytes(m.data)) for m in got if m] == [
        (m.arbitration_id + 1, m.is_fd, m.bitrate_switch, bytes(m.data)) for m in sent
    ]


def test_a_refusal_is_counted_and_no_frame_is_lost_by_it(program: Path, tmp_path: Path) -> None:
    adapter = Adapter(tmp_path / "adapter")
    with running(program, adapter.device) as process:
        adapter.heard("C\rS6\rY2\rO\r")
        adapter.say("\x07t1230\r")
        adapter.heard("t1240\r")
        assert process.stdout is not None
        for line in process.stdout:
            if "received= 1" in line and "sent= 1" in line:
                assert "rejected= 1" in line
                return
        pytest.fail("it never said so")


def test_an_adapter_that_is_plugged_in_again_is_opened_again(program: Path, tmp_path: Path) -> None:
    adapter = Adapter(tmp_path / "adapter")
    with running(program, adapter.device):
        adapter.heard("C\rS6\rY2\rO\r")
        adapter.unplug()
        time.sleep(0.5)
        adapter.plug_in()
        adapter.heard("C\rS6\rY2\rO\r")
        adapter.say("t0071FF\r")
        adapter.heard("t0081FF\r")


@pytest.mark.parametrize(
    ("device", "speed", "message"),
    [
        ("nowhere", "6", "nowhere cannot be opened: trying again"),
        ("file", "6", "file is no serial line: trying again"),
        ("file", "9", "RAVENCHART_CAN_SPEED must be a digit, 0 to 8"),
    ],
)
def test_what_cannot_be_opened_is_said_once(
    program: Path, tmp_path: Path, device: str, speed: str, message: str
) -> None:
    (tmp_path / "file").write_text("")
    with running(program, tmp_path / device, RAVENCHART_CAN_SPEED=speed) as process:
        time.sleep(1.0)
        process.kill()
        assert process.stderr is not None
        told = [line for line in process.stderr.read().splitlines() if "error" in line]
    assert len(told) == 1
    assert told[0].endswith(message)
