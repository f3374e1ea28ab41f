"""The score: by kind who caught how many, the survivors, and the explained ones."""

from __future__ import annotations

import json
import tomllib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from .catalogue import KINDS
from .mutants import Mutant
from .workbench import Verdict

CATCHERS = ("compiler", "gnatprove", "model rules", "tests")


@dataclass(frozen=True, slots=True)
class Outcome:
    """One mutant, judged."""

    subject: str
    mutant: Mutant
    diff: str
    verdict: Verdict
    reason: str = ""
    """Why it is equivalent, when nobody caught it and somebody explained it."""

    @property
    def survived(self) -> bool:
        """Neither caught nor explained."""
        return self.verdict.by is None and not self.reason

    @property
    def part(self) -> str:
        """Kind, and whether the declared form was broken."""
        return f"{self.mutant.kind}, declared" if self.mutant.declared else self.mutant.kind


@dataclass(frozen=True, slots=True)
class Explained:
    """A mutant that is equivalent, named by its place and its diff."""

    subject: str
    place: str
    diff: str
    reason: str


def explanations(path: Path) -> list[Explained]:
    """The file of explained mutants."""
    found = tomllib.loads(path.read_text(encoding="utf-8"))
    return [
        Explained(e["subject"], e["place"], e["diff"].strip("\n"), e["reason"])
        for e in found.get("equivalent", ())
    ]


def reason_of(known: Sequence[Explained], subject: str, mutant: Mutant, diff: str) -> str:
    """The reason, as long as the mutant's text is the one that was explained."""
    for one in known:
        if (one.subject, one.place, one.diff) == (subject, mutant.place, diff.strip("\n")):
            return one.reason
    return ""


def table(outcomes: Sequence[Outcome]) -> str:
    """Rows of kinds, columns of catchers."""
    columns = ("made", *CATCHERS, "explained", "survived")
    rows = [f"{'kind':<26}" + "".join(f"{c:>13}" for c in columns)]
    parts = [p for k in KINDS for p in (k, f"{k}, declared")]
    known = {o.part for o in outcomes}
    for part in [*(p for p in parts if p in known), *sorted(known - set(parts)), "all"]:
        own = [o for o in outcomes if part in (o.part, "all")]
        rows.append(f"{part:<26}" + "".join(f"{n:>13}" for n in _counts(own).values()))
    return "\n".join(rows)


def _counts(outcomes: Sequence[Outcome]) -> dict[str, int]:
    caught = Counter(o.verdict.by for o in outcomes)
    return {
        "made": len(outcomes),
        **{c: caught[c] for c in CATCHERS},
        "explained": sum(bool(o.reason) for o in outcomes),
        "survived": sum(o.survived for o in outcomes),
    }


def survivors(outcomes: Sequence[Outcome]) -> str:
    """Each survivor with its diff."""
    lines: list[str] = []
    for one in outcomes:
        if one.survived:
            lines += [f"{one.subject}: {one.part}: {one.mutant.file}: {one.mutant.name}", one.diff]
    return "\n".join(lines)


def as_json(outcomes: Sequence[Outcome]) -> str:
    """Everything, for machines."""
    return json.dumps(
        {
            "kinds": {
                part: _counts([o for o in outcomes if o.part == part])
                for part in dict.fromkeys(o.part for o in outcomes)
            },
            "mutants": [
                {
                    "subject": o.subject,
                    "kind": o.mutant.kind,
                    "declared": o.mutant.declared,
                    "file": o.mutant.file,
                    "place": o.mutant.place,
                    "rule": f"{o.mutant.rule} {o.mutant.ordinal}",
                    "caught_by": o.verdict.by,
                    "words": o.verdict.words,
                    "explained": o.reason,
                    "diff": o.diff.splitlines(),
                }
                for o in outcomes
            ],
        },
        indent=1,
    )
