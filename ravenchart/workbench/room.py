"""What takes longer than a change may: advice, and how far a WCET may grow. A process of its own.

It reads one question a line on standard input and writes one answer a line, both JSON. The
process that asks ends it where the question is no longer of use.
"""

from __future__ import annotations

import json
import sys
from base64 import b64decode
from pathlib import Path
from typing import Any

from ravenchart.analysis.findings import advice
from ravenchart.analysis.findings.growth import largest_wcet
from ravenchart.analysis.present.words import binding_lines, growth_line
from ravenchart.analysis.system.timing import Analysis
from ravenchart.analysis.units import duration
from ravenchart.editing.evaluation import evaluate


def main() -> None:
    """Answer until there are no more questions."""
    for line in sys.stdin:
        answer = answered(json.loads(line))
        print(json.dumps(answer), flush=True)


def answered(question: dict[str, Any]) -> dict[str, Any]:
    """The answer to a question about the files of a model."""
    texts = {name: b64decode(content) for name, content in question["texts"].items()}
    found = evaluate(Path(question["model"]), texts)
    if found.analysis is None:
        return {}
    if "rows" in question:
        return grown(found.analysis, question["rows"])
    return {"lines": list(room_lines(found.analysis))}


def room_lines(analysis: Analysis) -> tuple[str, ...]:
    """How far all times may grow, what limits that, and what to change: as `analyse` prints it."""
    told = advice.lines(advice.of_model(analysis))
    return (growth_line(analysis), *binding_lines(analysis), *told)


def grown(analysis: Analysis, rows: list[str]) -> dict[str, Any]:
    """The largest WCET of rows that have one, in ns and in words."""
    largest = largest_wcet(analysis, rows)
    text = "none, a deadline or limit is not kept now" if largest is None else duration(largest)
    return {"wcet": largest, "text": text}


if __name__ == "__main__":
    main()
