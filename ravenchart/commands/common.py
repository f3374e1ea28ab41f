"""What commands on a model share: how it is named, checked and written."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from ravenchart.failures import Unusable
from ravenchart.terminal import progress

from .answer import Answer, say
from .results import GenerateResult

if TYPE_CHECKING:
    from ravenchart.building.checking import Checked
    from ravenchart.building.targets import Board
    from ravenchart.gen.model.system import System
    from ravenchart.hw_can.bench.interfaces import Interface


def add_model(sub: argparse.ArgumentParser) -> None:
    """The model that the command is about."""
    sub.add_argument("model", type=Path, metavar="MODEL", help="the model's YAML file")


def add_target(sub: argparse.ArgumentParser) -> None:
    """What the program is built for."""
    from ravenchart.building import targets

    sub.add_argument(
        "--target", choices=targets.names(), default=targets.NATIVE,
        help="what the program runs on (default: this machine)",
    )  # fmt: skip
    sub.add_argument(
        "--rts", type=Path, metavar="DIR",
        help=f"the target's Ada run-time library (default: {targets.RTS_VARIABLE})",
    )  # fmt: skip


def board(options: argparse.Namespace, found: Checked) -> Board | None:
    """The board that the program is built for, its warnings printed; None: this machine."""
    from ravenchart.building import targets

    if options.target == targets.NATIVE:
        return None
    made = targets.board(targets.target(options.target), options.rts)
    for text in targets.check_system(made, found.system):
        say(options.answer, text)
    return made


def add_interface(sub: argparse.ArgumentParser, use: str) -> None:
    """The end of a bus on which a controller runs already; ``use`` says what is done there."""
    sub.add_argument(
        "--interface", metavar="NAME",
        help=f"{use} on an interface of python-can, such as socketcan, slcan or ravenchart, at "
        "the bit rate of the model; nothing is built or started",
    )  # fmt: skip
    sub.add_argument(
        "--channel", help="its channel, such as can0, /dev/ttyACM0 or socket://HOST:PORT"
    )


def interface(options: argparse.Namespace, system: System) -> Interface | None:
    """The interface that was named; Unusable where half of it is, or the model has no bus."""
    from ravenchart.running.attaching import interface_of

    if (options.interface is None) != (options.channel is None):
        raise Unusable("--interface and --channel go together")
    if options.interface is None:
        return None
    return interface_of(system, options.interface, options.channel)


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


def checked(
    options: argparse.Namespace, *, deadlines: bool = True, finish: bool = False
) -> Checked:
    """The model, with its warnings printed; Refused with its errors."""
    from ravenchart.building import checking

    with progress(f"check {options.model.name}"):
        found = checking.check(options.model, deadlines=deadlines, finish=finish)
    tell_warnings(found)
    options.answer.add(found.diagnostics)
    return found


def tell_warnings(found: Checked) -> None:
    """Print the warnings of a model."""
    if found.warnings:
        print(found.warnings, file=sys.stderr, flush=True)


def several(count: int, what: str) -> str:
    """A count in words: `1 file`, `2 files`."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def verdict(found: Checked) -> str:
    """One line on a model without errors."""
    system = found.system
    instances = several(len(system.instances), "instance")
    processors = several(len(system.processors), "processor")
    messages = several(len(system.messages), "message")
    return f"{system.name}: {instances} on {processors}, {messages}; every deadline is met"


def generated(checked: Checked, answer: Answer) -> GenerateResult:
    """The program written; what that did, and what is still to write, is printed too."""
    from ravenchart.building.generation import EDITED, write_program

    with progress("generate"):
        written = write_program(checked)
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
