# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The cases of a test of the drivers `socketcan` and `ctucanfd`: a program that echoes.

Program and python-can are on one interface of Linux, virtual (vcan) or real, or on two
controllers of one bus. Each case returns what it saw, or raises why not.
"""

from __future__ import annotations

import copy
import re
import subprocess
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import can

from ravenchart.hw_can.bench.bus_records import FD_LENGTHS
from ravenchart.hw_can.conformance.cases import (
    SETTLING,
    ConformanceCase,
    Failed,
    Skipped,
    exact,
    frame,
)
from ravenchart.hw_can.conformance.ends import Ends, Setup, opened
from tests.support.echo import Echo, Standing

INTERFACES = Path("/sys/class/net")
FD_UNIT = "72"
"""The transfer unit of an interface that is set up for CAN FD too, in bytes."""

BURST = 200
"""Frames of a burst: not more than the queue of a socket holds."""

RESTING = 0.5
"""Seconds without news after which the program has told everything."""

LIMIT = 10.0
"""Seconds within which the driver must have noticed something."""

COMMAND, MEMORY_SPACE = 4, 0x2
"""A register of the configuration space of PCI, and its bit that lets memory be read."""

# Classes and details of error reports, by linux/can/error.h.
BUS_OFF, RESTARTED, CONTROLLER, COUNTERS = 0x40, 0x100, 0x4, 0x200
WARNING, PASSIVE, ACTIVE = 0x08, 0x20, 0x40


VARIABLES = {"socketcan": "RAVENCHART_CAN_INTERFACE", "ctucanfd": "RAVENCHART_CTUCANFD"}
"""What tells each driver where its controller is."""


@dataclass(slots=True)
class Driver:
    """The program and its interface, or its file of registers, for the cases."""

    program: Path
    channel: str
    echo: Echo
    emulated: bool = False
    """There is an SJA1000 of QEMU on the bus, whose receive queue a remote frame disorders: it
    keeps as many bytes as the frame's length says, and releases none of them."""
    name: str = "socketcan"
    """Of the driver."""

    @property
    def virtual(self) -> bool:
        """Whether the interface has no device: a vcan."""
        return not (INTERFACES / self.channel / "device").exists()

    def settled(self) -> Standing:
        """How it stands, once it has said nothing new for a while."""
        last = None
        while (now := self.echo.now) != last:
            last = now
            time.sleep(RESTING)
        return now

    def stands(self, condition: Callable[[Standing], bool], wanted: str) -> Standing:
        """Wait until it stands so; Failed when it does not come to that."""
        if not self.echo.came(lambda: condition(self.echo.now), LIMIT):
            raise Failed(f"{wanted} was expected, but it stands {self.echo.now}")
        return self.echo.now

    def reports(self, state: str, transmit: int, receive: int) -> None:
        """Wait until it is in this state, with these error counters."""
        wanted = (state, transmit, receive)
        said = f"{state} tec={transmit} rec={receive}"
        self.stands(lambda now: (now.state, now.tec, now.rec) == wanted, said)

    def announced(self, times: int) -> None:
        """Wait until it has opened its interface so many times."""
        line = f"can: {self.name} on {self.channel}"
        if not self.echo.came(lambda: self.echo.said.count(line) >= times, LIMIT):
            raise Failed(f"{line!r} was expected, but it said {self.echo.said}")


@contextmanager
def started(
    program: Path,
    channel: str,
    *,
    emulated: bool = False,
    name: str = "socketcan",
    **environment: str,
) -> Iterator[Driver]:
    """The program on ``channel`` for the time of a block."""
    echo = Echo(program, {VARIABLES[name]: channel, **environment})
    try:
        yield Driver(program, channel, echo, emulated, name)
    finally:
        echo.close()


def _told(*words: str) -> str:
    """What a program for interfaces prints; Failed with its complaint."""
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Failed(f"{' '.join(words)}: {done.stderr.strip()}")
    return done.stdout


def _link(*words: str) -> None:
    """Change an interface."""
    _told("ip", "link", *words)


def _next(one: can.Message) -> can.Message:
    """What the program makes of a frame."""
    answer = copy.copy(one)
    answer.arbitration_id += 1
    return answer


def _answered(ends: Ends, frames: Sequence[can.Message]) -> str:
    """Each frame comes back, one by one."""
    got = [answer for one in frames for answer in ends.across([one])]
    return exact([_next(one) for one in frames], got)


def _lengths(ends: Ends, *, extended: bool, remote: bool = False) -> str:
    base = 0x18FF0000 if extended else 0x300
    return _answered(
        ends,
        [
            can.Message(
                arbitration_id=base + 4 * n,
                is_extended_id=extended,
                is_remote_frame=remote,
                dlc=n,
                data=None if remote else bytes(range(0xA0, 0xA0 + n)),
            )
            for n in range(9)
        ],
    )


def _empty_remotes(ends: Ends) -> str:
    return _answered(
        ends,
        [
            can.Message(arbitration_id=0x400, is_extended_id=extended, is_remote_frame=True)
            for extended in (False, True)
        ],
    )


def _remotes(ends: Ends, driver: Driver, *, extended: bool) -> str:
    if driver.emulated:
        raise Skipped("QEMU's SJA1000 loses its place behind a remote frame with a length")
    return _lengths(ends, extended=extended, remote=True)


def _identifiers(ends: Ends) -> str:
    standard = [frame(n) for n in (0, 0x554, 0x7FC)]
    extended = [frame(n, extended=True) for n in (0x100, 0x7F0, 0x800, 0x15555554, 0x1FFFFFFC)]
    return _answered(ends, standard + extended)


def _every_byte(ends: Ends) -> str:
    sent = [frame(0x120, bytes(range(n, n + 8))) for n in range(0, 256, 8)]
    return exact([_next(one) for one in sent], ends.across(sent))


def _burst(ends: Ends, driver: Driver) -> str:
    before = driver.settled().sent
    ends.near.send(frame(Echo.ORDER, BURST.to_bytes(2, "little")))
    expected = [frame(Echo.BURST, n.to_bytes(8, "little")) for n in range(1, BURST + 1)]
    got = [ends.near.recv(ends.patience) for _ in expected]
    exact(expected, [one for one in got if one is not None])
    driver.stands(lambda now: now.sent == before + BURST, f"sent={before + BURST}")
    return f"{BURST} frames in order, each counted"


def _full(ends: Ends, driver: Driver) -> str:
    if not driver.virtual:
        raise Skipped("only a virtual interface is slowed down here")
    place = ("dev", driver.channel, "root")
    _told("tc", "qdisc", "add", *place, "tbf", "rate", "64kbit", "burst", "160", "limit", "320")
    try:
        said = _burst(ends, driver)
        seen = _told("tc", "-s", "qdisc", "show", "dev", driver.channel)
    finally:
        _told("tc", "qdisc", "del", *place)
    refused = re.search(r"dropped (\d+)", seen)
    if refused is None or int(refused[1]) == 0:
        raise Failed(f"the interface refused nothing: {seen}")
    return f"{said}, though {refused[1]} were refused at first"


def _filter(ends: Ends, driver: Driver) -> str:
    before = driver.settled().received
    for refused in (0, 0x80, 0xFC):
        ends.near.send(frame(refused, extended=True))
    if (answer := ends.near.recv(SETTLING)) is not None:
        raise Failed(f"a refused frame was answered: {answer}")
    _answered(ends, [frame(0xFC), frame(0x100, extended=True)])
    driver.stands(lambda now: now.received == before + 2, f"received={before + 2}")
    return "3 frames refused, 2 accepted and counted"


def _fd(ends: Ends) -> str:
    near = ends.setup.channel
    if (INTERFACES / near / "mtu").read_text().strip() != FD_UNIT:
        raise Skipped("the interface is set up for classic CAN")
    setup = Setup("socketcan", near, "socketcan", near, fd=True)
    sent = [
        can.Message(
            arbitration_id=0x300 + 4 * length,
            is_extended_id=False,
            is_fd=True,
            bitrate_switch=switch,
            data=bytes(range(1, length + 1)),
        )
        for switch in (False, True)
        for length in sorted(FD_LENGTHS)
    ]
    with opened("socketcan", near, setup) as bus:
        got = []
        for one in sent:
            bus.send(one)
            got.append(bus.recv(ends.patience))
    said = exact([_next(one) for one in sent], [one for one in got if one is not None])
    return f"{said}; then " + _answered(ends, [frame(0x204)])


def _classic(ends: Ends, driver: Driver) -> str:
    near = ends.setup.channel
    if (INTERFACES / near / "mtu").read_text().strip() != FD_UNIT:
        raise Skipped("the interface is set up for classic CAN")
    setup = Setup("socketcan", near, "socketcan", near, fd=True)
    with (
        started(driver.program, driver.channel, name=driver.name, CAN_ECHO_CLASSIC="1") as other,
        opened("socketcan", near, setup) as bus,
    ):
        other.announced(1)
        before = other.settled().received
        bus.send(can.Message(arbitration_id=0x400, is_extended_id=False, is_fd=True, data=b"12"))
        bus.send(frame(0x404))
        # The program that runs beside it answers both, one of them by a classic frame.
        other.stands(lambda now: now.received == before + 2, f"received={before + 2}")
        if other.settled().received != before + 2:
            raise Failed("an FD frame was received on a classic bus")
    return "FD frames passed over, classic ones received"


def _reports(ends: Ends, driver: Driver) -> str:
    if not driver.virtual:
        raise Skipped("only a virtual interface passes on an error report that a program wrote")
    before = driver.settled().received
    steps = (
        (CONTROLLER | COUNTERS, WARNING, (96, 3), "ERROR_ACTIVE"),
        (CONTROLLER | COUNTERS, PASSIVE, (130, 5), "ERROR_PASSIVE"),
        (BUS_OFF | COUNTERS, 0, (248, 6), "BUS_OFF"),
        (RESTARTED | COUNTERS, 0, (0, 0), "ERROR_ACTIVE"),
        (CONTROLLER | COUNTERS, PASSIVE, (128, 127), "ERROR_PASSIVE"),
        (CONTROLLER | COUNTERS, ACTIVE, (127, 1), "ERROR_ACTIVE"),
    )
    for kind, detail, (transmit, receive), state in steps:
        data = bytes((0, detail, 0, 0, 0, 0, transmit, receive))
        ends.near.send(can.Message(arbitration_id=kind, is_error_frame=True, data=data))
        driver.reports(state, transmit, receive)
    if driver.settled().received != before:
        raise Failed("an error report was counted as a frame")
    return f"{len(steps)} reports, their states and counters"


def _recovered(ends: Ends, driver: Driver, one: can.Message) -> str:
    """The interface is up again: python-can's end anew, and a frame that is answered."""
    setup = ends.setup
    ends.near.shutdown()
    ends.near = ends.far = opened(setup.interface, setup.channel, setup)
    said = _answered(ends, [one])
    driver.stands(lambda now: now.state == "ERROR_ACTIVE", "ERROR_ACTIVE with the first frame")
    return said


def _down(ends: Ends, driver: Driver) -> str:
    _link("set", driver.channel, "down")
    driver.stands(lambda now: now.state == "STOPPED", "STOPPED while the interface is down")
    _link("set", driver.channel, "up")
    return "stopped; active again; then " + _recovered(ends, driver, frame(0x208))


def _gone(ends: Ends, driver: Driver) -> str:
    if not driver.virtual:
        raise Skipped("a real interface cannot be taken away by a program")
    _link("del", driver.channel)
    driver.stands(lambda now: now.state == "STOPPED", "STOPPED without an interface")
    _link("add", driver.channel, "mtu", FD_UNIT, "type", "vcan")
    _link("set", driver.channel, "up")
    driver.announced(2)
    return "opened anew; then " + _recovered(ends, driver, frame(0x20C))


def _nowhere(driver: Driver) -> str:
    place, words = {
        "socketcan": ("nocan9", "there is no CAN interface nocan9"),
        "ctucanfd": ("/none:1", "there are no registers in /none"),
    }[driver.name]
    words = f"error: can: {words}; trying again"
    with started(driver.program, place, name=driver.name) as other:
        if not other.echo.came(lambda: words in other.echo.said, LIMIT):
            raise Failed(f"it said {other.echo.said}")
    return words


def _decodes(card: Path, *, memory: bool) -> None:
    """Let a card on PCI answer to reads of its memory, or not: the COMMAND register."""
    with (card / "config").open("r+b", buffering=0) as config:
        config.seek(COMMAND)
        now = int.from_bytes(config.read(2), "little")
        config.seek(COMMAND)
        wanted = now | MEMORY_SPACE if memory else now & ~MEMORY_SPACE
        config.write(wanted.to_bytes(2, "little"))


def _deaf(ends: Ends, driver: Driver) -> str:
    card = Path(driver.channel).parent
    if not (card / "config").exists():
        raise Skipped("only a card on PCI can be made deaf by a program")
    _decodes(card, memory=False)
    try:
        driver.stands(lambda now: now.state == "STOPPED", "STOPPED with a deaf card")
    finally:
        _decodes(card, memory=True)
    driver.announced(2)
    return "stopped; opened anew; then " + _answered(ends, [frame(0x20C)])


def cases(driver: Driver) -> tuple[ConformanceCase, ...]:
    """All cases of its driver, for a program that has been started."""
    own = _of_socketcan if driver.name == "socketcan" else _of_ctucanfd
    return _of_all(driver) + own(driver)


def _of_ctucanfd(driver: Driver) -> tuple[ConformanceCase, ...]:
    return (ConformanceCase("card deaf and there again", lambda ends: _deaf(ends, driver)),)


def _of_all(driver: Driver) -> tuple[ConformanceCase, ...]:
    return (
        ConformanceCase("an interface that is not there", lambda ends: _nowhere(driver)),
        ConformanceCase("standard data frames", lambda ends: _lengths(ends, extended=False)),
        ConformanceCase("extended data frames", lambda ends: _lengths(ends, extended=True)),
        ConformanceCase("remote frames that ask for nothing", _empty_remotes),
        ConformanceCase(
            "standard remote frames", lambda ends: _remotes(ends, driver, extended=False)
        ),
        ConformanceCase(
            "extended remote frames", lambda ends: _remotes(ends, driver, extended=True)
        ),
        ConformanceCase("identifiers at their limits", _identifiers),
        ConformanceCase("every byte value", _every_byte),
        ConformanceCase("burst", lambda ends: _burst(ends, driver)),
        ConformanceCase("acceptance filter", lambda ends: _filter(ends, driver)),
        ConformanceCase("FD frames", lambda ends: _fd(ends)),
    )


def _of_socketcan(driver: Driver) -> tuple[ConformanceCase, ...]:
    return (
        ConformanceCase("interface without room", lambda ends: _full(ends, driver)),
        ConformanceCase("error reports", lambda ends: _reports(ends, driver)),
        ConformanceCase("FD frames on a classic bus", lambda ends: _classic(ends, driver)),
        ConformanceCase("interface down and up", lambda ends: _down(ends, driver)),
        ConformanceCase("interface gone and there again", lambda ends: _gone(ends, driver)),
    )
