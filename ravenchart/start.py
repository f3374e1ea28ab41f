# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The entry point: a light module that is ready for signals before anything else is imported.

It keeps the working folder off the module search path, turns a request to stop into an
orderly end, and gives every kind of end its own exit status.
"""

from __future__ import annotations

import datetime
import gc
import os
import select
import signal
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from types import FrameType

from .failures import INTERNAL
from .paths import ROOT

SIGNALLED = 128
"""Ended by signal n: the exit status is 128 + n, as a shell reports it."""

SOON = 0.002
"""Seconds until a request to stop that got lost is made again."""

PRESENT = (datetime,)
"""Modules that a library in Rust imports at its own import; it panics if a signal comes then."""

NO_PLUGINS = ("PYDANTIC_DISABLE_PLUGINS", "__all__")
"""Pydantic searches all installed packages else. A program that imports us decides itself."""

_asked: list[int] = []
"""The signals that asked the process to end, oldest first."""


class Stopped(BaseException):
    """A signal asks the process to end; every ``finally`` on the way out still runs."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the exit status. For the start of a process only."""
    try:
        _heed_signals()
        forget_working_folder()
        os.environ.setdefault(*NO_PLUGINS)
        return _command(arguments)
    except (Stopped, KeyboardInterrupt) as stopped:
        return _stopped(stopped.number if isinstance(stopped, Stopped) else signal.SIGINT)
    except Exception as fault:
        if _asked:  # a library has made an exception of its own of `Stopped`
            return _stopped(_asked[0])
        if isinstance(fault, BrokenPipeError) and _reader_is_gone():
            return _unread()
        _say(traceback.format_exc())
        _say("ravenchart: internal error (above): a fault of Ravenchart, not of the model")
        return INTERNAL
    finally:
        gc.freeze()  # Python ends, and does not search all that is left for garbage


def forget_working_folder() -> None:
    """Take the working folder off the module search path, unless it is the checkout.

    `python -m` puts it first: a file `yaml.py` of the user would be imported for PyYAML.
    """
    here = Path.cwd().resolve()
    if here != ROOT:
        sys.path[:] = [place for place in sys.path if Path(place or ".").resolve() != here]


def _command(arguments: Sequence[str] | None) -> int:
    """The command itself, imported only now; its output has been written when it returns."""
    from . import terminal
    from .command_line import main as command

    terminal.LINES.set()
    try:
        status = command(arguments)
    except SystemExit as ended:  # argparse: --help and wrong calls
        status = ended.code if isinstance(ended.code, int) else 2
    sys.stdout.flush()
    return status


def _heed_signals() -> None:
    """SIGINT, SIGTERM and SIGHUP raise `Stopped`; one that waited since the start does now."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        ignored = signal.getsignal(number) is signal.SIG_IGN
        if number == signal.SIGINT or not ignored:  # `nohup` ignores SIGHUP
            signal.signal(number, _stop)
    signal.signal(signal.SIGALRM, _stop_again)
    sys.unraisablehook = _unraised
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})


def _stopped(number: int) -> int:
    """Say that this signal ends the process; its exit status."""
    _say("ravenchart: interrupted" if number == signal.SIGINT else "ravenchart: stopped")
    return SIGNALLED + number


def _stop(number: int, frame: FrameType | None) -> None:
    _asked.append(number)
    raise Stopped(number)


def _unraised(found: sys.UnraisableHookArgs) -> None:
    """A `Stopped` that a callback of a foreign library swallowed is raised again soon after."""
    if isinstance(found.exc_value, Stopped):
        signal.setitimer(signal.ITIMER_REAL, SOON)
    else:
        sys.__unraisablehook__(found)


def _stop_again(number: int, frame: FrameType | None) -> None:
    if _asked:
        raise Stopped(_asked[-1])


def _reader_is_gone() -> bool:
    """Whether standard output or error is a pipe without a reader."""
    polled = select.poll()
    for number in (1, 2):
        polled.register(number, 0)
    return any(found & select.POLLERR for _, found in polled.poll(0))


def _unread() -> int:
    """End without a word: Python would complain once more when it flushes at its end."""
    null = os.open(os.devnull, os.O_WRONLY)
    for number in (1, 2):
        os.dup2(null, number)
    return SIGNALLED + signal.SIGPIPE


def _say(text: str) -> None:
    with suppress(OSError):
        print(text.rstrip(), file=sys.stderr, flush=True)


if __name__ == "__main__":
    raise SystemExit(main())
