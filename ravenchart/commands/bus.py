"""`ravenchart bus`: the bus server, built when it is first needed, and started."""

from __future__ import annotations

import argparse
import subprocess
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from ravenchart.building import children, toolchain
from ravenchart.hw_can.bench.bus_records import NAME_LENGTH
from ravenchart.paths import ROOT, work

PROJECT = ROOT / "hw_can" / "bus" / "can_bus.gpr"
SECOND = 10**9
"""Of the simulated bus, in its own ticks: a bit must be a number of them."""

FAULTS = (
    "disturbed_bit",
    "lost_acknowledgement",
    "dropped",
    "delayed",
    "duplicated",
    "corrupted",
)
EVENTS = ("cut", "mend", "hold_dominant", "hold_recessive", "let_go", "babble", "hush")


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    sub.add_argument("--port", type=_number(0, 65535), default=29536, help="0: a free one")
    sub.add_argument("--name", type=_name, default="can0", help="of the bus (default can0)")
    sub.add_argument(
        "--bitrate", type=_rate(1, 1_000_000), default=500_000, metavar="BIT/S",
        help="default 500000",
    )  # fmt: skip
    sub.add_argument(
        "--data-bitrate", type=_rate(0, 20_000_000), default=2_000_000, metavar="BIT/S",
        help="of the data phase; 0: no CAN FD (default 2000000)",
    )  # fmt: skip
    sub.add_argument(
        "--virtual", action="store_true",
        help="time goes on with what happens on the bus, not with the clock",
    )  # fmt: skip
    sub.add_argument(
        "--buffers", choices=("fifo", "priority"), default="fifo",
        help="which of its frames a node offers: the oldest (default), or the most urgent",
    )  # fmt: skip
    sub.add_argument(
        "--disturb", type=_words(2), metavar="SEED:NS",
        help="bits are disturbed by chance, at least so many ns apart",
    )  # fmt: skip
    sub.add_argument(
        "--fault", type=_words(5, FAULTS), action="append", default=[],
        metavar="FRAME:KIND[:NODE[:FIGURE[:MASK]]]",
        help=f"what frame FRAME, from 1, meets at NODE (0: at all): {', '.join(FAULTS)}; FIGURE "
        "is the bit that is disturbed, the delay in ns, or the byte that MASK changes",
    )  # fmt: skip
    sub.add_argument(
        "--event", type=_words(4, EVENTS), action="append", default=[],
        metavar="NS:KIND[:NODE[:ID]]",
        help=f"what happens then, in the order of time: {', '.join(EVENTS)}",
    )  # fmt: skip


def words(options: argparse.Namespace) -> list[str]:
    """What the server is told, NAME=VALUE each."""
    told = [
        f"port={options.port}",
        f"name={options.name}",
        f"bitrate={options.bitrate}",
        f"data_bitrate={options.data_bitrate}",
        f"time={'virtual' if options.virtual else 'paced'}",
        f"buffer={options.buffers}",
    ]
    if options.disturb is not None:
        told.append(f"seed={options.disturb}")
    told += [f"fault={fault}" for fault in options.fault]
    return told + [f"event={event}" for event in options.event]


@cache
def built() -> Path:
    """The server's program, compiled if need be, and once; ToolMissing or ToolFailed."""
    options = ["-p", "-q", "-j0", "-P", PROJECT.name]
    toolchain.run("gprbuild", options, PROJECT.parent, {"MODE": "release"})
    return work() / "obj" / "bus-release" / "can_bus"


@contextmanager
def running(*told: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A bus server for the time of a block, and its channel, ``host:port``."""
    with children.running(
        [built(), *told], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True
    ) as server:
        assert server.stdout is not None
        yield server, server.stdout.readline().split()[-1]


def serve(told: Sequence[str]) -> int:
    """Run the server until it is interrupted; its exit status."""
    with children.running([built(), *told], stdin=subprocess.DEVNULL) as server:
        return server.wait()


def uneven(rate: int) -> str:
    """Why the server refuses a bit rate."""
    return f"a bit at {rate} bit/s is no whole number of ns"


def _number(first: int, last: int) -> Callable[[str], int]:
    def read(text: str) -> int:
        if not (text.isascii() and text.isdigit() and first <= int(text) <= last):
            raise argparse.ArgumentTypeError(f"{text!r} is not {first} .. {last}")
        return int(text)

    return read


def _rate(first: int, last: int) -> Callable[[str], int]:
    def read(text: str) -> int:
        rate = _number(first, last)(text)
        if rate and SECOND % rate:
            raise argparse.ArgumentTypeError(uneven(rate))
        return rate

    return read


def _name(text: str) -> str:
    if not (0 < len(text) <= NAME_LENGTH and all("!" <= letter <= "~" for letter in text)):
        raise argparse.ArgumentTypeError(f"{text!r} is not 1 .. {NAME_LENGTH} characters ! .. ~")
    return text


def _words(most: int, kinds: Sequence[str] = ()) -> Callable[[str], str]:
    """Numbers between colons, the second a kind where there are kinds."""

    def read(text: str) -> str:
        parts = text.split(":")
        figures = [part for n, part in enumerate(parts) if not (kinds and n == 1)]
        if not 2 <= len(parts) <= most or not all(p.isascii() and p.isdigit() for p in figures):
            raise argparse.ArgumentTypeError(f"{text!r} is not of that form")
        if kinds and parts[1] not in kinds:
            raise argparse.ArgumentTypeError(f"{parts[1]!r} is none of {', '.join(kinds)}")
        return text

    return read
