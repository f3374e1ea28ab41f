# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The comparisons, the disagreements, and the facts that were not derived again."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

CLASSES = {
    "digest": "digest of the model",
    "platform": "platform figures of nodes",
    "tasks": "tasks: priority, period, deadline, offset, jitter",
    "rows": "rows: WCET, divisor, phase",
    "sums": "sums of WCETs, blocking",
    "responses": "response times of tasks",
    "buses": "buses: bit rates, bit times, errors",
    "messages": "messages: identifier, length, period, deadline, jitter, bits",
    "arbitration": "response times of messages",
    "receptions": "receptions: wait of frames, time until they are handed over",
    "transfers": "values in several frames: round trips, transfer times, time-outs",
    "checks": "conditions that the certificate states",
    "names": "numbers of the certificate, known by their names",
    "states": "states of charts",
    "transitions": "transitions: presence, order of precedence",
    "sources": "transitions: source",
    "triggers": "transitions: trigger, presence of a guard; events",
    "guards": "transitions: names and numbers of the guard",
    "targets": "transitions: target",
    "domains": "transitions: region that holds what is left and entered",
    "timers": "time-outs: executions, state",
}
"""Each class of comparisons, in the order of the output."""


class UnusableError(Exception):
    """The check cannot be made: a file is missing, or the model is beyond this checker."""


@dataclass(frozen=True, slots=True)
class Disagreement:
    """One thing that the model and a generated file say differently."""

    kind: str
    file: str
    line: int
    text: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.text}"


@dataclass(slots=True)
class Report:
    """The outcome of a check."""

    counts: dict[str, int] = field(default_factory=lambda: dict.fromkeys(CLASSES, 0))
    disagreements: list[Disagreement] = field(default_factory=list)
    not_derived: dict[str, int] = field(default_factory=dict)
    """The facts that are not derived again, each with its count of numbers; 0: no numbers."""

    def agree(self, kind: str, file: Path, line: int, holds: bool, text: str) -> bool:
        """Count one comparison, and keep it where it fails."""
        self.counts[kind] += 1
        if not holds:
            self.disagreements.append(Disagreement(kind, str(file), line, text))
        return holds

    def skip(self, what: str, count: int = 1) -> None:
        """Say that something is not derived again; 0 where it has no number."""
        self.not_derived[what] = self.not_derived.get(what, 0) + count

    @property
    def agrees(self) -> bool:
        """Whether all comparisons agree."""
        return not self.disagreements

    def lines(self) -> list[str]:
        """One line for each class of comparisons, then what is not derived, and the verdict."""
        found = []
        for kind, words in CLASSES.items():
            wrong = sum(one.kind == kind for one in self.disagreements)
            verdict = f"{wrong} DISAGREE" if wrong else "agree"
            count = self.counts[kind]
            text = f"{count} compared, {verdict}" if count else "none in this model"
            found.append(f"{words}: {text}")
        for what, number in self.not_derived.items():
            found.append(f"not derived: {what}{f': {number} numbers' if number else ''}")
        wrong, total = len(self.disagreements), sum(self.counts.values())
        if wrong:
            found.append(f"{wrong} of {total} comparisons disagree")
        else:
            found.append(f"model, charts and certificate agree in {total} comparisons")
        return found

    def data(self) -> dict[str, Any]:
        """The report as JSON values."""
        return {
            "agrees": self.agrees,
            "compared": dict(self.counts),
            "disagreements": [asdict(one) for one in self.disagreements],
            "not_derived": dict(self.not_derived),
        }
