# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart bus`: the bus server, built when it is first needed, and started."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from functools import partial

from ravenchart.hw_can.bench.bus_records import NAME_LENGTH, RESTART_LAST
from ravenchart.running import server

from . import common
from .answer import say
from .results import BusResult

FAULTS = (
    "disturbed_bit",
    "disturbed_end",
    "overload",
    "lost_acknowledgement",
    "dropped",
    "delayed",
    "duplicated",
    "corrupted",
)
EVENTS = ("cut", "mend", "hold_dominant", "hold_recessive", "let_go", "babble", "hush")


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    sub.add_argument(
        "--port",
        type=_number(0, 65535),
        default=29536,
        help="TCP port (default 29536); 0: a free one",
    )
    sub.add_argument("--name", type=_name, default="can0", help="name of the bus (default can0)")
    sub.add_argument(
        "--bitrate", type=_rate(1, 1_000_000), default=500_000, metavar="BIT/S",
        help="bit rate (default 500000)",
    )  # fmt: skip
    sub.add_argument(
        "--data-bitrate", type=_rate(0, 20_000_000), default=2_000_000, metavar="BIT/S",
        help="bit rate of the data phase; 0: no CAN FD (default 2000000)",
    )  # fmt: skip
    for name, bit in (("--sample-point", "nominal"), ("--data-sample-point", "data")):
        sub.add_argument(
            name, type=_percent, default=80.0, metavar="PERCENT",
            help=f"sample point of a {bit} bit: there an FD frame switches its rate (default 80)",
        )  # fmt: skip
    sub.add_argument(
        "--restart-ms", type=_number(0, RESTART_LAST), default=0, metavar="MS",
        help="time from bus-off to the request for recovery, of nodes that give none; 0 (default): "
        "a node requests it itself",
    )  # fmt: skip
    sub.add_argument(
        "--virtual", action="store_true",
        help="run in virtual time, which advances with the events on the bus, not with the clock",
    )  # fmt: skip
    sub.add_argument(
        "--buffers", choices=("fifo", "priority"), default="fifo",
        help="the frame that a node offers: its oldest (default), or its most urgent",
    )  # fmt: skip
    sub.add_argument(
        "--disturb", type=_words(2), metavar="SEED:NS",
        help="disturb random bits, at least NS ns apart, with the random numbers of SEED",
    )  # fmt: skip
    sub.add_argument(
        "--fault", type=_words(5, FAULTS), action="append", default=[],
        metavar="FRAME:KIND[:NODE[:FIGURE[:MASK]]]",
        help=f"inject KIND into frame FRAME (counted from 1) at NODE (0: all nodes): "
        f"{', '.join(FAULTS)}; FIGURE is the bit that is disturbed (of disturbed_end: 1 .. 7 the "
        "end of frame, 8 .. 10 the intermission), the number of overload frames, the delay in ns, "
        "or the byte that MASK changes",
    )  # fmt: skip
    common.add_log(sub)
    sub.add_argument(
        "--event", type=_words(4, EVENTS), action="append", default=[],
        metavar="NS:KIND[:NODE[:ID]]",
        help=f"an event on the bus at that time, in order of time: {', '.join(EVENTS)}",
    )  # fmt: skip


def server_settings(options: argparse.Namespace) -> list[str]:
    """The settings of the server, NAME=VALUE each."""
    told = [
        f"port={options.port}",
        f"name={options.name}",
        f"bitrate={options.bitrate}",
        f"data_bitrate={options.data_bitrate}",
        f"sample_point={round(10 * options.sample_point)}",
        f"data_sample_point={round(10 * options.data_sample_point)}",
        f"restart_ms={options.restart_ms}",
        f"time={'virtual' if options.virtual else 'paced'}",
        f"buffer={options.buffers}",
    ]
    if options.disturb is not None:
        told.append(f"seed={options.disturb}")
    told += [f"fault={fault}" for fault in options.fault]
    return told + [f"event={event}" for event in options.event]


def _number(first: int, last: int) -> Callable[[str], int]:
    def read(text: str) -> int:
        if not (text.isascii() and text.isdigit() and first <= int(text) <= last):
            raise argparse.ArgumentTypeError(f"{text!r} is not {first} .. {last}")
        return int(text)

    return read


def _rate(first: int, last: int) -> Callable[[str], int]:
    def read(text: str) -> int:
        rate = _number(first, last)(text)
        if rate and server.SECOND % rate:
            raise argparse.ArgumentTypeError(server.uneven(rate))
        return rate

    return read


def _percent(text: str) -> float:
    try:
        found = float(text)
    except ValueError:
        found = -1.0
    if not 0 <= found <= 100:
        raise argparse.ArgumentTypeError(f"{text!r} is not 0 .. 100")
    return found


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


def execute(options: argparse.Namespace) -> int:
    """Serve until it is stopped; the exit status."""
    if not options.json:
        return server.serve(server_settings(options), options.log)

    def serves(channel: str) -> None:
        options.answer.serves(BusResult(channel))

    return server.announced(
        server_settings(options), options.log, serves, partial(say, options.answer)
    )
