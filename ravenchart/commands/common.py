# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Shared parts of the commands on a model: how it is named, checked and written."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from ravenchart.building import variants
from ravenchart.building.garbage import without_collector
from ravenchart.failures import Unusable
from ravenchart.grammar import AS_LISTED
from ravenchart.terminal import progress

from .answer import Answer, say
from .build_results import GenerateResult

if TYPE_CHECKING:
    from ravenchart.building.checking import Checked
    from ravenchart.building.targets import Board
    from ravenchart.building.unchanged import Generation
    from ravenchart.building.written import Written
    from ravenchart.gen.model.system import System
    from ravenchart.hw_can.bench.interfaces import BusEnd
    from ravenchart.workbench.pages import Pages


def add_model(sub: argparse.ArgumentParser, other: str = "") -> None:
    """The model that the command is about; ``other`` names what it takes in place of one."""
    text = "the model's YAML file, or MODEL@NAME: a deployment of it"
    if other:
        text = f"the model's YAML file, MODEL@NAME (a deployment of it), {other}"
    sub.add_argument("model", type=Path, metavar="MODEL", help=text)


def add_driver(sub: argparse.ArgumentParser) -> None:
    """The CAN driver of the program."""
    sub.add_argument(
        "--driver", choices=variants.DRIVERS, metavar="NAME", help=f"the CAN driver{AS_LISTED}"
    )


def add_target(sub: argparse.ArgumentParser) -> None:
    """The target of the program, and its run-time library."""
    sub.add_argument(
        "--target", choices=variants.targets(), default=variants.NATIVE,
        help="what the program runs on (default: this machine)",
    )  # fmt: skip
    sub.add_argument(
        "--rts", type=Path, metavar="DIR",
        help=f"the target's Ada run-time library (default: {variants.RTS_VARIABLE})",
    )  # fmt: skip


def board(options: argparse.Namespace, found: Checked) -> Board | None:
    """The board that the program is built for, its warnings printed; None: this machine."""
    if options.target == variants.NATIVE:
        return None
    from ravenchart.building import targets

    made = targets.board(targets.target(options.target), options.rts)
    for text in targets.check_system(made, found.system):
        say(options.answer, text)
    return made


def add_interface(sub: argparse.ArgumentParser, use: str, *, builds: bool = True) -> None:
    """The end of a bus on which a controller runs already; ``use`` says what is done there.

    ``builds``: without it the command builds and starts something.
    """
    sub.add_argument(
        "--interface", metavar="NAME", action=_GivenOnce,
        help=f"{use} on an interface of python-can, such as socketcan, slcan or ravenchart, at "
        f"the bit rate of the model{'; nothing is built or started' if builds else ''}",
    )  # fmt: skip
    sub.add_argument(
        "--channel", action="append", default=[], metavar="[BUS=]CHANNEL",
        help="its channel, such as can0, /dev/ttyACM0 or socket://HOST:PORT; once for each of "
        "several buses, with its name",
    )  # fmt: skip


class _GivenOnce(argparse.Action):
    """An option that is given once: a second one would silently take the place of the first."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: object,
        option_string: str | None = None,
    ) -> None:
        if getattr(namespace, self.dest) is not None:
            raise argparse.ArgumentError(self, "is given twice")
        setattr(namespace, self.dest, values)


def interfaces(options: argparse.Namespace, system: System) -> dict[str, BusEnd]:
    """The interface of each bus that was named; Unusable where half of it is, or it has no bus."""
    from ravenchart.running.attaching import interfaces_of

    named = named_interface(options)
    return {} if named is None else interfaces_of(system, *named)


def named_interface(options: argparse.Namespace) -> tuple[str, list[str]] | None:
    """The interface and its channels, where they are named; Unusable where one of both is."""
    if (options.interface is None) != (not options.channel):
        raise Unusable("--interface and --channel go together")
    return None if options.interface is None else (options.interface, options.channel)


def add_snapshots(sub: argparse.ArgumentParser, use: str) -> None:
    """The files of the snapshots of controllers; ``use`` is a sentence: what for, for example."""
    from ravenchart.running.snapshots import VARIABLE

    sub.add_argument(
        "--file", action="append", default=[], metavar="[NODE=]FILE",
        help=f"the file that {VARIABLE} named to a controller, or the serial line of a board, "
        f"PORT[@RATE]; once for each of several nodes, with its name. {use}",
    )  # fmt: skip


def add_log(sub: argparse.ArgumentParser) -> None:
    """Where what is on the bus is written."""
    from ravenchart.running import bus_log

    known = bus_log.suffixes()

    def file(text: str) -> Path:
        if Path(text).suffix not in known.split(", "):
            raise argparse.ArgumentTypeError(f"{text!r} has no suffix of {known}")
        return Path(text)

    sub.add_argument(
        "--log", type=file, metavar="FILE",
        help=f"write all frames and error frames there, as its suffix says: {known}",
    )  # fmt: skip


def add_port(sub: argparse.ArgumentParser) -> None:
    """Where a local page is served."""
    sub.add_argument(
        "--port", type=_port, default=0, metavar="PORT",
        help="TCP port of the page, on this machine alone (default: a free one)",
    )  # fmt: skip


def add_scheduler(sub: argparse.ArgumentParser) -> None:
    """Who helps a search for tables."""
    sub.add_argument(
        "--scheduler", metavar="ADDRESS",
        help="search with the workers of a Dask scheduler, such as tcp://host:8786; needs the "
        "package distributed",
    )  # fmt: skip


def _port(text: str) -> int:
    if not (text.isascii() and text.isdigit() and int(text[:6]) <= 65_535):
        raise argparse.ArgumentTypeError(f"{text!r} is not 0 .. 65535")
    return int(text)


def serve(
    options: argparse.Namespace, made: Callable[[], Pages], *, browser: bool, what: str, remark: str
) -> None:
    """Serve a local page until it is stopped: at once the answer, or two lines for people."""
    from ravenchart.workbench import serving

    from .results import PageResult

    def serves(address: str) -> None:
        options.answer.serves(PageResult(address))
        say_at_once(f"{options.model}: {what} {address}")
        say_at_once(remark)

    serving.serve(made, options.port, browser=browser, say=say_at_once, serves=serves)


def say_at_once(text: str) -> None:
    """Print a line that a command says while it goes on."""
    print(text, flush=True)


def checked(
    options: argparse.Namespace,
    *,
    deadlines: bool = True,
    finish: bool = False,
    library: bool = False,
) -> Checked:
    """The model, with its warnings printed; Refused with its errors.

    ``library``: it may be a library.
    """
    with without_collector():
        from ravenchart.building import checking

    with progress(f"check {options.model.name}"):
        found = checking.check(options.model, deadlines=deadlines, finish=finish, library=library)
    tell_warnings(found.warnings)
    options.answer.add(found.diagnostics)
    return found


def tell_warnings(warnings: str) -> None:
    """Print the warnings of a model."""
    if warnings:
        print(warnings, file=sys.stderr, flush=True)


def generated_before(found: Generation, answer: Answer) -> GenerateResult:
    """Print the messages of a generation that has nothing to do."""
    tell_warnings(found.warnings)
    answer.add(found.found)
    return tell_written(found.written, answer)


def several(count: int, what: str) -> str:
    """A count in words: `1 file`, `2 files`."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def verdict(found: Checked) -> str:
    """One line on a model without errors."""
    system = found.system
    if system.is_library:
        types = [one for one in system.types if system.library_of(one) is None]
        parts = several(len(types), "type"), several(len(system.own_components), "component")
        return f"{system.name} {system.version}: a library of {' and '.join(parts)}"
    instances = several(len(system.instances), "instance")
    processors = several(len(system.processors), "processor")
    messages = several(len(system.messages), "message")
    return f"{system.name}: {instances} on {processors}, {messages}; every deadline is met"


def write(checked: Checked, answer: Answer) -> tuple[Written, GenerateResult]:
    """Write the program of a model, and print the result."""
    from ravenchart.building import generation  # only here: it imports all that writes Ada

    with progress("generate"):
        written = generation.write_program(checked)
    return written, tell_written(written, answer)


def tell_written(written: Written, answer: Answer) -> GenerateResult:
    """Print the result of a generation and the bodies that are still to write; the answer."""
    from ravenchart.building.written import EDITED

    print(f"{written.folder}: {several(written.files, 'file')}, {written.changed} changed")
    for name in written.edited:
        say(
            answer,
            f"warning: {written.folder / name} was edited by hand and is generated again; "
            f"your version is kept as {name}{EDITED}",
        )
    for path in written.untouched:
        state = (
            "new; its bodies do nothing yet"
            if path in written.first
            else "its bodies do nothing yet"
        )
        say(answer, f"note: {path}: {state}. Write them: the file is yours")
    return GenerateResult(
        str(written.folder),
        written.files,
        written.changed,
        list(written.edited),
        [str(path) for path in written.first],
        [str(path) for path in written.untouched],
    )
