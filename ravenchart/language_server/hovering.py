# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The text that an editor shows of a name: kind, declaration, and bounds of the analysis."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart import rounded
from ravenchart.analysis.system.timing import Analysis
from ravenchart.editing.evaluation import Evaluation

from .model import OpenModel
from .symbols import ModelSymbol

MOST_LINES = 8
"""Lines of a declaration that are shown."""


def described(symbol: ModelSymbol, now: OpenModel, evaluation: Evaluation) -> str:
    """The text for people, in Markdown."""
    parts = [f"**{symbol.kind}** `{symbol.name}`"]
    if symbol.declared is not None:
        file, start, _ = symbol.declared
        text = now.texts[file].text
        parts.append(f"```yaml\n{_declaration(text, start)}\n```")
    if evaluation.analysis is not None and symbol.declared is not None:
        bounds = list(_bounds(symbol.name, evaluation.analysis))
        if bounds:
            parts.append("\n".join(f"- {line}" for line in bounds))
    return "\n\n".join(parts)


def _declaration(text: str, start: int) -> str:
    """The line of a declaration and the lines inside it."""
    begin = text.rfind("\n", 0, start) + 1
    lines = text[begin:].splitlines()
    margin = _margin(lines[0])
    inside = [lines[0]]
    for line in lines[1:]:
        if line.strip() and _margin(line) <= margin:
            break
        inside.append(line)
    shown = inside[:MOST_LINES] + ([" " * margin + "  ..."] if len(inside) > MOST_LINES else [])
    return "\n".join(line[margin:] for line in shown).rstrip()


def _margin(line: str) -> int:
    return len(line) - len(line.lstrip(" "))


def _bounds(name: str, analysis: Analysis) -> Iterator[str]:
    """R and D of the processor, message or rows of that name."""
    for element in analysis.found.responses:
        message = analysis.messages.get(element)
        if (element if message is None else message.name).lower() == name.lower():
            yield _said(
                element, analysis.found.from_event(element), analysis.found.deadline(element)
            )
    for response in analysis.responses:
        processor = response.task.name
        for row in response.rows:
            if row.row.name.rpartition(".")[2].lower() == name.lower():
                deadline = analysis.found.deadline(processor)
                yield _said(f"{row.row.name} on {processor}", row.bound, deadline)


def _said(name: str, bound: int | None, deadline: int) -> str:
    if bound is None:
        return f"{name}: R has no bound, D = {rounded.down(deadline)}"
    needed, allowed = rounded.against(bound, deadline)
    return f"{name}: R = {needed}, D = {allowed}"
