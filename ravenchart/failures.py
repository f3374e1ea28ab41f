# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How a command fails: what it says, and its exit status."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

OK = 0
"""Done; every deadline and limit is kept, the proof or the run passed."""
WRONG = 1
"""The model, its proof, its timing or its run has errors."""
UNUSABLE = 2
"""The call is wrong, or something that it needs is missing."""
NOT_JUDGED = 3
"""The run passed, and its timing could not be judged (``run --strict``)."""
INTERNAL = 70
"""An exception that was not caught: a fault of Ravenchart (EX_SOFTWARE of sysexits.h)."""
INTERNAL_TEXT = "internal error: a fault of Ravenchart, not of the model"


class Failure(Exception):  # noqa: N818
    """A command cannot go on; the text is what is printed.

    ``found`` has the diagnostics that the text shows, where it shows diagnostics of a model.
    """

    status: ClassVar[int] = WRONG

    def __init__(self, text: str, found: Sequence[object] = ()) -> None:
        super().__init__(text)
        self.found = tuple(found)

    def shown(self) -> str:
        """The printed text."""
        return str(self).rstrip()


class Refused(Failure):
    """The input has errors; the text is the rendered diagnostics."""


class ToolFailed(Failure):
    """An outside program ended with an error; the text is what it printed."""


class Unusable(Failure):
    """Something that the command needs is missing, or cannot be used."""

    status = UNUSABLE

    def shown(self) -> str:
        """One line that names who says it."""
        return f"ravenchart: error: {self}"


def said_of(problem: OSError) -> str:
    """The operating system's message, with the name of the file and without a number."""
    reason = problem.strerror or str(problem)
    reason = f"{reason[:1].lower()}{reason[1:]}"
    return reason if problem.filename is None else f"{problem.filename}: {reason}"


MEANINGS: Mapping[str, str] = {
    "0": "done; every deadline and limit is kept, the proof or the run passed",
    "1": "the model cannot be read, or it, its proof, its timing or its run has errors",
    "2": "the call is wrong, or a file, program or bus that it needs is missing",
    "3": "`run --strict`: the run passed, but its timing could not be judged",
    "70": "internal error: a fault of Ravenchart, shown with its traceback",
    "129, 130, 143": "stopped by SIGHUP, SIGINT (Ctrl-C) or SIGTERM",
    "141": "the reader of the output has ended, as in `| head`",
}
"""Every exit status with its meaning, for `--help`, the manual page and docs/command-line.md."""

STATUSES = "exit status:\n" + "".join(
    f"  {status:<{5 if len(status) < 5 else 15}}{meaning}\n" for status, meaning in MEANINGS.items()
)
