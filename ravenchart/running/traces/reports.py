# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The report of a controller as a file holds it: written by the controller, or by a terminal.

A terminal program that keeps the lines of a board keeps more: lines from before the start of the
controller, and the reason of its end. The file may stop anywhere in a line.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from ravenchart.analysis.system.observed import TraceError

SAID = ("error: ", "warning: ")
"""How lines begin that a controller says besides its report."""

BEGIN = re.compile(r"E \d{1,19}\s*")
"""The first line of a report."""

NOTHING = "\n"
"""In place of a line that is no part of the report, so that all others keep their numbers."""


def report_lines(lines: Iterable[str], said: list[str], file: str) -> Iterator[str]:
    """The lines of the report alone; ``said`` takes what the controller says besides.

    Left out are the lines before the report, and lines that were cut off: the last one without
    its end, and one that the end of the controller has interrupted. TraceError where a second
    report begins. A file without the beginning of a report stays as it is.
    """
    before: list[str] = []
    begun = False
    held = NOTHING
    for number, line in enumerate(lines, 1):
        if not begun:
            begun = BEGIN.fullmatch(line) is not None
            before.append(NOTHING if begun else line)
            if begun:
                yield from (NOTHING for _ in before[1:])
                held = line
            continue
        if BEGIN.fullmatch(line):
            problem = "the controller has started again: cut the file here, it holds two runs"
            raise TraceError(f"{file}:{number}: error: {problem}")
        if line.startswith(SAID):
            said.append(line.rstrip())
            yield held if _is_end(held) else NOTHING
            held = NOTHING
        else:
            yield held
            held = line
    if begun:
        yield held if held.endswith("\n") or _is_end(held) else NOTHING
    else:
        yield from before


def _is_end(line: str) -> bool:
    return line.strip() == "END"
