# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Programs with the CAN driver `ctucanfd`, on a file in place of the registers of a card."""

from __future__ import annotations

import mmap
import struct
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from ravenchart.tools import toolchain
from tests.hardware.driver_cases import LIMIT, Driver, started
from tests.support.ada_programs import built
from tests.support.modes import MODES

pytestmark = pytest.mark.clock

SPAN = 0x4000
"""Bytes from one core of a card to the next."""

DEVICE_ID, MODE, STATUS, COMMAND, BTR, BTR_FD = 0x00, 0x04, 0x08, 0x0C, 0x24, 0x28
FAULT_STATE, REC_TEC, RX_STATUS, RX_DATA = 0x2C, 0x30, 0x68, 0x6C
TX_STATUS, TX_COMMAND, TX_PRIORITY, TRV_DELAY, TXTB1 = 0x70, 0x74, 0x78, 0x80, 0x100
CORE, EMPTY, SENT, READY = 0x0202CAFD, 0x8888, 0x4444, 0x1111
ACTIVE, PASSIVE, OFF = 1 << 16, 1 << 17, 1 << 18
SET_READY = {n: 0x2 | 0x100 << n for n in range(4)}


class Card:
    """The words of the second core of a card: they do nothing by themselves."""

    def __init__(self, path: Path) -> None:
        path.write_bytes(bytes(2 * SPAN))
        self.path = path
        with path.open("r+b") as file:
            self._words = mmap.mmap(file.fileno(), 2 * SPAN)

    def __getitem__(self, offset: int) -> int:
        return int(struct.unpack_from("<I", self._words, SPAN + offset)[0])

    def __setitem__(self, offset: int, word: int) -> None:
        struct.pack_into("<I", self._words, SPAN + offset, word)


@pytest.fixture(scope="module", params=MODES)
def program(request: pytest.FixtureRequest) -> Path:
    """It echoes, in both builds."""
    return built(request.param, "ctucanfd", "can_echo") / "can_echo"


@pytest.fixture
def card(tmp_path: Path) -> Card:
    """A core with four empty buffers, which is error-active."""
    card = Card(tmp_path / "resource1")
    card[DEVICE_ID], card[TX_STATUS], card[FAULT_STATE] = CORE, EMPTY, ACTIVE
    return card


@contextmanager
def running(program: Path, card: Card) -> Iterator[Driver]:
    """The program, with the core of the card."""
    with started(program, f"{card.path}:1", name="ctucanfd") as driver:
        driver.announced(1)
        yield driver


def came(driver: Driver, card: Card, offset: int, word: int) -> bool:
    """Whether a register comes to hold a word."""
    return driver.echo.came(lambda: card[offset] == word, LIMIT)


def test_the_core_is_given_its_bit_rates_and_enabled(program: Path, card: Card) -> None:
    with running(program, card) as driver:
        driver.stands(lambda now: now.state == "ERROR_ACTIVE", "ERROR_ACTIVE")
        assert card[BTR] == 0xA012_8A3B
        assert card[BTR_FD] == 10 << 27 | 1 << 19 | 10 << 13 | 10 << 7 | 29
        assert card[TRV_DELAY] == 40 << 16
        assert card[MODE] == 1 << 22 | 1 << 9 | 1 << 4


def test_on_a_classic_bus_the_core_passes_over_fd_frames(
    program: Path, card: Card, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CAN_ECHO_CLASSIC", "1")
    with running(program, card) as driver:
        assert card[MODE] == 1 << 22 | 1 << 24 | 1 << 9
        assert card[BTR_FD] == 0
        card[RX_DATA] = 4 << 18 | 3 << 11 | 1 << 7
        card[RX_STATUS] = 1 << 4
        assert driver.settled().received == 0


@pytest.mark.parametrize("clock", ["33333333", "5000000"])
def test_bit_rates_that_the_clock_does_not_give_are_refused(
    clock: str, program: Path, card: Card, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RAVENCHART_CTUCANFD_CLOCK", clock)
    words = "error: can: the bit rate cannot be had from the clock; trying again"
    with started(program, f"{card.path}:1", name="ctucanfd") as driver:
        assert driver.echo.came(lambda: words in driver.echo.said, LIMIT)
        assert card[MODE] == 1
        assert driver.echo.now.state == "STOPPED"


def test_state_and_counters_follow_the_registers(program: Path, card: Card) -> None:
    with running(program, card) as driver:
        for word, counts, state, transmit, receive in (
            (PASSIVE, 0x0082_0005, "ERROR_PASSIVE", 130, 5),
            (ACTIVE, 0x007F_0006, "ERROR_ACTIVE", 127, 6),
            (OFF, 0x0100_0007, "BUS_OFF", 256, 7),
        ):
            card[COMMAND] = 0
            card[REC_TEC], card[FAULT_STATE] = counts, word
            driver.reports(state, transmit, receive)
        assert came(driver, card, COMMAND, 1 << 4)
        card[REC_TEC], card[FAULT_STATE] = 0, ACTIVE
        driver.reports("ERROR_ACTIVE", 0, 0)


@pytest.mark.parametrize(("wait_ms", "asked"), [("0", False), ("200", True)])
def test_a_core_that_recovers_on_request_is_asked_when_that_comes(
    wait_ms: str, program: Path, card: Card, monkeypatch: pytest.MonkeyPatch, *, asked: bool
) -> None:
    monkeypatch.setenv("CAN_ECHO_ON_REQUEST", wait_ms)
    with running(program, card) as driver:
        driver.stands(lambda now: now.state == "ERROR_ACTIVE", "ERROR_ACTIVE")
        card[COMMAND] = 0
        card[REC_TEC], card[FAULT_STATE] = 0x0100_0000, OFF
        driver.reports("BUS_OFF", 256, 0)
        assert driver.echo.came(lambda: card[COMMAND] == 1 << 4, 2.0) == asked
        card[REC_TEC], card[FAULT_STATE] = 0, ACTIVE
        driver.reports("ERROR_ACTIVE", 0, 0)
        now = driver.settled()
        assert (now.passive, now.off, now.back) == (0, 1, 1)


def test_a_core_that_joins_the_bus_is_stopped_until_then(program: Path, card: Card) -> None:
    card[FAULT_STATE] = OFF
    with running(program, card) as driver:
        assert driver.settled().state == "STOPPED"
        card[FAULT_STATE] = ACTIVE
        driver.stands(lambda now: now.state == "ERROR_ACTIVE", "ERROR_ACTIVE")
    assert "BUS_OFF" not in {standing.state for standing in driver.echo.standings}


def receive(driver: Driver, card: Card, word: int) -> None:
    """Let the core have received frames whose words are all alike, some of them read."""
    card[RX_DATA] = word
    before = driver.echo.now.received
    card[RX_STATUS] = 1 << 4
    driver.stands(lambda now: now.received > before, "a frame received")
    card[RX_STATUS] = 0
    driver.settled()


def test_frames_are_answered_in_the_order_of_the_ring(program: Path, card: Card) -> None:
    with running(program, card) as driver:
        receive(driver, card, 4 << 18 | 3 << 11)
        assert card[TX_PRIORITY] in (0x1234, 0x2341, 0x3412, 0x4123)
        assert card[TX_COMMAND] in SET_READY.values()
        for n in range(4):
            words = [card[TXTB1 + 0x100 * n + 4 * word] for word in range(4)]
            assert words == [3 << 11, 5 << 18, 0, 0]


def test_what_was_sent_and_what_was_not_is_counted(program: Path, card: Card) -> None:
    with running(program, card) as driver:
        card[TX_STATUS] = READY
        receive(driver, card, 4 << 18 | 3 << 11)
        waiting = driver.settled()
        assert (waiting.sent, waiting.lost_out) == (0, 0)
        card[TX_STATUS] = SENT
        driver.stands(lambda now: now.sent >= 8, "frames sent")
        card[TX_STATUS] = 0x6666
        driver.stands(lambda now: now.lost_out >= 4, "frames lost")


def test_any_words_in_the_receive_buffer_are_taken(program: Path, card: Card) -> None:
    with running(program, card) as driver:
        card[RX_STATUS] = 1 << 4
        for shift in range(32):
            for word in (1 << shift, 0xFFFF_FFFF ^ 1 << shift):
                card[RX_DATA] = word
                driver.echo.came(lambda: False, 0.005)
        card[RX_STATUS] = 0
        assert driver.settled().state == "ERROR_ACTIVE"


def test_fd_frames_are_answered_with_all_their_bytes(program: Path, card: Card) -> None:
    layout = 19 << 11 | 1 << 9 | 1 << 7 | 15
    with running(program, card) as driver:
        receive(driver, card, layout)
        words = [card[TXTB1 + 4 * word] for word in range(20)]
        assert words == [layout, 1 << 18, 0, 0] + 16 * [layout]


def test_an_overrun_is_counted_and_cleared(program: Path, card: Card) -> None:
    with running(program, card) as driver:
        card[STATUS] = 1 << 1
        assert came(driver, card, COMMAND, 1 << 3)
        card[STATUS] = 0
        assert driver.settled().lost_in > 0


@pytest.mark.parametrize("word", [0, 0xFFFF_FFFF])
def test_a_core_that_answers_no_more_is_looked_for(word: int, program: Path, card: Card) -> None:
    with running(program, card) as driver:
        card[TX_STATUS] = READY
        receive(driver, card, 4 << 18 | 3 << 11)
        card[DEVICE_ID] = word
        driver.stands(lambda now: now.state == "STOPPED", "STOPPED without a core")
        driver.stands(lambda now: now.lost_out >= now.received, "all given up")
        card[TX_STATUS], card[DEVICE_ID] = EMPTY, CORE
        driver.announced(2)
        driver.stands(lambda now: now.state == "ERROR_ACTIVE", "ERROR_ACTIVE")


def test_registers_that_are_cut_off_end_nothing(program: Path, card: Card) -> None:
    with running(program, card) as driver:
        driver.stands(lambda now: now.state == "ERROR_ACTIVE", "ERROR_ACTIVE")
        with card.path.open("r+b") as file:
            file.truncate(0)
        driver.stands(lambda now: now.state == "STOPPED", "STOPPED without registers")
        with card.path.open("r+b") as file:
            file.truncate(2 * SPAN)
        card[TX_STATUS], card[FAULT_STATE], card[DEVICE_ID] = EMPTY, ACTIVE, CORE
        driver.announced(2)


def test_no_registers_are_told_once(program: Path, tmp_path: Path) -> None:
    words = f"error: can: there are no registers in {tmp_path / 'none'}; trying again"
    with started(program, str(tmp_path / "none"), name="ctucanfd") as driver:
        assert driver.echo.came(lambda: words in driver.echo.said, LIMIT)
        assert not driver.echo.came(lambda: driver.echo.said.count(words) > 1, 1.5)


@pytest.mark.parametrize(("order", "facts"), [("priority", 7), ("fifo", 6)])
@pytest.mark.parametrize("mode", MODES)
def test_frames_leave_a_model_of_the_core_in_the_order_of_the_bus(
    mode: str, order: str, facts: int
) -> None:
    where = ROOT / "tests" / "ada" / "ctu"
    toolchain.run("gprbuild", ["-p", "-q", "-P", "ctu.gpr"], where, {"MODE": mode})
    program = ROOT / "obj" / f"tests-ctu-{mode}" / "test_ctu_order"
    done = subprocess.run([program, order], capture_output=True, text=True, timeout=120)
    lines = done.stdout.splitlines()
    assert (done.returncode, len([line for line in lines if line.startswith("ok ")])) == (0, facts)
