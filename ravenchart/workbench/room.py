# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A process for longer work than a change may take: advice, growth of a WCET, tables.

It reads one question a line on standard input and writes one answer a line, both JSON. An answer
with ``more`` is the best so far, and another follows. The process that asks ends this one where
the question is no longer of use.
"""

from __future__ import annotations

import json
import os
import sys
from base64 import b64decode
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from time import monotonic
from typing import Any

from ravenchart.allocation.helpers import helped
from ravenchart.allocation.proposals import Proposal, propose, tables
from ravenchart.analysis.findings import advice
from ravenchart.analysis.findings.growth import largest_wcet
from ravenchart.analysis.present.sentences import binding_lines, growth_line, verdict_line
from ravenchart.analysis.system.timing import Analysis
from ravenchart.analysis.units import duration
from ravenchart.editing.evaluation import evaluate
from ravenchart.editing.places import ModelPlaces
from ravenchart.editing.tables import processors_for
from ravenchart.failures import Unusable

PAUSE = 0.2
"""Seconds that lie at least between two answers to one question."""

LESS_URGENT = 10
"""Added to the niceness: a change in the page is analysed first where cores are few."""

Say = Callable[[dict[str, Any]], None]


def main() -> None:
    """Answer until there are no more questions, when nothing more urgent has to be done."""
    os.nice(LESS_URGENT)
    for line in sys.stdin:
        answer(json.loads(line), lambda told: print(json.dumps(told), flush=True))


def answer(question: dict[str, Any], say: Say) -> None:
    """Answer a question about the files of a model; the last answer is without ``more``."""
    texts = {name: b64decode(content) for name, content in question["texts"].items()}
    found = evaluate(Path(question["model"]), texts)
    if found.analysis is None:
        say({})
    elif "rows" in question:
        say(grown(found.analysis, question["rows"]))
    elif "strategy" in question:
        say(allocated(found.analysis, found.places, question, say))
    else:
        say({"lines": list(room_lines(found.analysis))})


def room_lines(analysis: Analysis) -> tuple[str, ...]:
    """How far all times may grow, what limits that, and what to change: as `analyse` prints it."""
    told = advice.lines(advice.of_model(analysis))
    return (growth_line(analysis), *binding_lines(analysis), *told)


def grown(analysis: Analysis, rows: list[str]) -> dict[str, Any]:
    """The largest WCET of rows that have one, in ns and in words."""
    largest = largest_wcet(analysis, rows)
    text = "none, a deadline or limit is not kept now" if largest is None else duration(largest)
    return {"wcet": largest, "text": text}


def allocated(
    analysis: Analysis, places: ModelPlaces, question: dict[str, Any], say: Say
) -> dict[str, Any]:
    """The best tables that a strategy finds; says the best so far meanwhile.

    ``fault`` says why the workers of ``scheduler`` cannot help.
    """
    last = -PAUSE

    def better(proposal: Proposal) -> None:
        nonlocal last
        if monotonic() - last >= PAUSE:
            last = monotonic()
            say(outcome(proposal, places) | {"more": True})

    try:
        with helped(question.get("scheduler")) as helpers:
            return outcome(propose(analysis, question["strategy"], better, helpers), places)
    except Unusable as fault:
        return {"fault": str(fault)}


def outcome(proposal: Proposal, places: ModelPlaces) -> dict[str, Any]:
    """Tables with the names that they get and what the analysis says of them, times in ns."""
    analysis, found = proposal.analysis, tables(proposal)
    homes = processors_for(places, found)
    return {
        "verdict": verdict_line(analysis),
        "met": analysis.schedulable,
        "tables": [
            asdict(table) | {"name": home or table.name}
            for table, home in zip(found, homes, strict=True)
        ],
        "bounds": {row.row.name: row.bound for _, row in analysis.rows()},
        "deadlines": {slot.element: slot.timing.deadline for slot in analysis.system.slots},
    }


if __name__ == "__main__":
    main()
