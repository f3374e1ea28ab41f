# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The score: by kind who caught how many, the survivors, and the explained ones."""

from __future__ import annotations

import json
import tomllib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ravenchart.paths import ROOT

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
        Explained(e["subject"], e["place"], _trimmed(e["diff"]), e["reason"].strip())
        for e in found.get("equivalent", ())
    ]


def reason_of(known: Sequence[Explained], subject: str, mutant: Mutant, diff: str) -> str:
    """The reason, as long as the mutant's text is the one that was explained."""
    for one in known:
        if (one.subject, one.place, one.diff) == (subject, mutant.place, _trimmed(diff)):
            return one.reason
    return ""


def _trimmed(diff: str) -> str:
    """Without space at the ends of lines."""
    return "\n".join(line.rstrip() for line in diff.splitlines()).strip("\n")


def told(outcomes: Sequence[Outcome], name: str, kinds: Sequence[str]) -> int:
    """Print the score, and write it below build/mutate/; 1 when a mutant survived."""
    folder = ROOT / "build" / "mutate"
    folder.mkdir(parents=True, exist_ok=True)
    score, left = table(outcomes, kinds), survivors(outcomes)
    (folder / f"{name}.json").write_text(as_json(outcomes), encoding="utf-8")
    (folder / f"{name}.txt").write_text(score + "\n", encoding="utf-8")
    print(score)
    if left:
        print(f"\nsurvived:\n{left}")
    return 1 if left else 0


def table(outcomes: Sequence[Outcome], kinds: Sequence[str] = KINDS) -> str:
    """Rows of kinds, columns of catchers."""
    columns = ("made", *CATCHERS, "explained", "survived")
    rows = [f"{'kind':<26}" + "".join(f"{c:>13}" for c in columns)]
    order = [row for k in kinds for row in (k, f"{k}, declared", f"{k}, model")]
    known = {o.mutant.row for o in outcomes}
    for row in [*(r for r in order if r in known), "all"]:
        own = [o for o in outcomes if row in (o.mutant.row, "all")]
        rows.append(f"{row:<26}" + "".join(f"{n:>13}" for n in _counts(own).values()))
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
            lines += [
                f"{one.subject}: {one.mutant.row}: {one.mutant.file}: {one.mutant.name}",
                one.diff,
            ]
    return "\n".join(lines)


def as_json(outcomes: Sequence[Outcome]) -> str:
    """Everything, for machines."""
    return json.dumps(
        {
            "kinds": {
                row: _counts([o for o in outcomes if o.mutant.row == row])
                for row in dict.fromkeys(o.mutant.row for o in outcomes)
            },
            "mutants": [
                {
                    "subject": o.subject,
                    "kind": o.mutant.kind,
                    "part": o.mutant.part,
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
