# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Labels broken into lines where a reader would break them."""

from __future__ import annotations

import re
from collections.abc import Iterator

from .picture import Label

LINE, CONDITION, ACTION = 36, 36, 56
"""Characters of a whole label in one line, of a condition's lines, of an action's, where words
allow."""
INDENT = "   "
BREAKS = (r" (?=(?:and|or) )|(?<!and) (?=then:? )|(?<!or) (?=else:? )", r"(?<=,) ", " ")
"""Where a line may end, the best places first."""


def wrapped(label: Label) -> tuple[str, ...]:
    """The lines of a label: one when it fits, else the condition's, then each action's."""
    return tuple(_lines(label))


def _lines(label: Label) -> Iterator[str]:
    if len(label.text) <= LINE:
        if label.text:
            yield label.text
        return
    guard = f"[{label.guard}]" if label.guard else ""
    head = f"{label.trigger} {guard}".strip()
    parts = (head,) if len(head) <= CONDITION else (label.trigger, guard)
    lines = [line for part in filter(None, parts) for line in _fill(part, CONDITION)]
    if not label.effect:
        yield from lines
        return
    yield from lines[:-1]
    yield f"{lines[-1]} /" if lines else "/"
    for action in label.effect:
        yield from (INDENT + line for line in _fill(action, ACTION))


def _fill(text: str, width: int) -> Iterator[str]:
    """Lines of one part, none longer than that where there is a place to break it."""
    line = ""
    for chunk in _chunks(text, width):
        if line and len(line) + 1 + len(chunk) > width:
            yield line
            line = INDENT + chunk
        else:
            line = f"{line} {chunk}" if line else chunk
    yield line


def _chunks(text: str, width: int, breaks: tuple[str, ...] = BREAKS) -> list[str]:
    if len(text) <= width or not breaks:
        return [text]
    parts = re.split(breaks[0], text)
    return [chunk for part in parts for chunk in _chunks(part, width, breaks[1:])]
