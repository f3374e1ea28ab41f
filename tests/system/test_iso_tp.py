# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Both ends of ISO-TP against an independent implementation, the package `can-isotp`."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import isotp
import pytest

from tests.support.ada_programs import built

pytestmark = pytest.mark.clock

LENGTHS = (1, 7, 8, 13, 14, 19, 20, 62, 63, 64)


@pytest.fixture(scope="module")
def program() -> Path:
    """Both ends, as a program."""
    return built("checks", "loopback", "iso_tp_line") / "iso_tp_line"


class Ends:
    """Our ends, and those of the package: frames go from one to the other at once."""

    def __init__(self, process: subprocess.Popen[str], **params: object) -> None:
        """The package with these parameters; it takes part when it is asked to."""
        self.process = process
        self.values: list[bytes] = []
        self.faults: list[str] = []
        self.lengths: set[int] = set()
        """Bytes of the package's frames."""
        self.waiting: list[isotp.CanMessage] = []
        self.errors: list[Exception] = []
        address = isotp.Address(isotp.AddressingMode.Normal_11bits, txid=0x321, rxid=0x123)
        self.layer = isotp.TransportLayerLogic(
            rxfn=self._receive,
            txfn=self._send,
            address=address,
            error_handler=self.errors.append,
            params={"blocking_send": False, **params},
        )

    def ask(self, command: str) -> None:
        """Give our ends a command, and the package what they send."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(f"{command}\n")
        self.process.stdin.flush()
        while (line := self.process.stdout.readline().strip()) != ".":
            kind, _, rest = line.partition(" ")
            if kind == "S":
                data = bytes.fromhex(rest)
                self.waiting.append(isotp.CanMessage(arbitration_id=0x123, dlc=8, data=data))
            elif kind == "V":
                self.values.append(bytes.fromhex(rest))
            else:
                assert kind == "E", line
                self.faults.append(rest)

    def turn(self) -> None:
        """A millisecond for both."""
        self.ask("T")
        self.layer.process()
        time.sleep(0.001)

    def _receive(self, timeout: float) -> isotp.CanMessage | None:
        return self.waiting.pop(0) if self.waiting else None

    def _send(self, frame: isotp.CanMessage) -> None:
        self.lengths.add(len(frame.data))
        self.ask(f"R {bytes(frame.data).hex()}")


@contextmanager
def _ends(program: Path, length: int, block: int, **params: object) -> Iterator[Ends]:
    command = [str(program), str(length), str(block)]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as process:
        yield Ends(process, **params)
        assert process.stdin is not None
        process.stdin.close()
        assert process.wait(10) == 0


def _value(length: int) -> bytes:
    return bytes((7 * n + length) % 256 for n in range(length))


@pytest.mark.parametrize("block", [0, 1, 3])
@pytest.mark.parametrize("length", LENGTHS)
def test_the_package_receives_our_values(program: Path, length: int, block: int) -> None:
    with _ends(program, length, 0, blocksize=block, stmin=1) as ends:
        ends.ask(f"G {_value(length).hex()}")
        for _ in range(100):
            ends.turn()
            if ends.layer.available():
                break
        received = ends.layer.recv()
        assert received is not None
        assert bytes(received) == _value(length)
        assert ends.faults == []
        assert ends.errors == []


@pytest.mark.parametrize("padding", [None, 0x55])
@pytest.mark.parametrize("block", [0, 1, 3])
@pytest.mark.parametrize("length", LENGTHS)
def test_we_receive_the_values_of_the_package(
    program: Path, length: int, block: int, padding: int | None
) -> None:
    with _ends(program, length, block, tx_padding=padding) as ends:
        ends.layer.send(_value(length))
        for _ in range(300):
            ends.turn()
            if ends.values:
                break
        assert ends.values == [_value(length)]
        assert ends.faults == []
        assert ends.errors == []
        assert (8 in ends.lengths) or padding is None


def test_we_wait_as_often_as_we_may(program: Path) -> None:
    with _ends(program, 19, 0, wftmax=2) as ends:
        ends.ask(f"G {_value(19).hex()}")
        ends.ask("T")
        ends.waiting.clear()
        for _ in range(2):
            ends.ask("R 310000")
            ends.ask("T")
        assert ends.faults == []
        ends.ask("R 310000")
        ends.ask("T")
        assert ends.faults == ["WAITED_TOO_OFTEN"]


def test_a_silent_receiver_ends_the_transfer(program: Path) -> None:
    with _ends(program, 19, 0) as ends:
        ends.ask(f"G {_value(19).hex()}")
        turns = 0
        while not ends.faults:
            ends.ask("T")
            turns += 1
            assert turns < 200
        assert ends.faults == ["TIMED_OUT"]
        assert len(ends.waiting) == 1
        #  the first segment, then 100 executions in which flow control may come
        assert turns == 102


def test_the_package_gives_up_a_value_that_is_too_long_for_us(program: Path) -> None:
    with _ends(program, 19, 0) as ends:
        ends.layer.send(_value(64))
        for _ in range(20):
            ends.turn()
        assert ends.values == []
        assert ends.faults == ["WRONG_LENGTH"]
        assert [type(one) for one in ends.errors] == [isotp.OverflowError]
