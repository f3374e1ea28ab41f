# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`make mutate`: break the generated programs of the subjects and report who notices."""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue

from ravenchart.failures import ToolFailed
from ravenchart.paths import ROOT
from ravenchart.tools.toolchain import ToolMissing

from .catalogue import KINDS, mutants_of
from .mutants import Mutant, sampled
from .observing import Observer, Played, PlayedTogether, Simulated
from .report import Explained, Outcome, explanations, reason_of, told
from .workbench import PATIENCE, Verdict, Workbench


@dataclass(frozen=True, slots=True)
class Subject:
    """A model whose program is broken, and what observes it."""

    name: str
    model: Path
    observer: type[Observer]
    node: str = ""
    """The node whose program is broken, where there are several."""


SUBJECTS = (
    Subject("rich", ROOT / "tests" / "feature" / "rich" / "model.yaml", Simulated),
    Subject("three_components", ROOT / "examples" / "three_components" / "model.yaml", Simulated),
    Subject("cartesian_robot", ROOT / "examples" / "cartesian_robot" / "model.yaml", Played),
    Subject(
        "two_nodes", ROOT / "examples" / "two_nodes" / "model.yaml", PlayedTogether, node="drive"
    ),
)
EXPLAINED = Path(__file__).parent / "explained.toml"


def tried(
    subject: Subject, chosen: Sequence[Mutant], jobs: int, known: Sequence[Explained]
) -> list[Outcome]:
    """Every chosen mutant of a subject judged, in order; each job has a copy of its own."""
    with tempfile.TemporaryDirectory(prefix="ravenchart-mutate-") as place:
        free: SimpleQueue[Workbench] = SimpleQueue()
        for number in range(min(jobs, len(chosen))):
            bench = Workbench(
                subject.model, Path(place) / str(number), subject.observer, subject.node
            )
            units = {u: None for m in chosen for u in bench.units_of(m)}
            if number == 0 and units:
                bench.prove(list(units), jobs=jobs, patience=PATIENCE)
            bench.prepare()
            free.put(bench)

        def judged(mutant: Mutant) -> Outcome:
            bench = free.get()
            try:
                verdict: Verdict = bench.try_mutant(mutant)
            finally:
                free.put(bench)
            diff = mutant.diff(bench.files[mutant.file])
            reason = "" if verdict.by else reason_of(known, subject.name, mutant, diff)
            outcome = Outcome(subject.name, mutant, diff, verdict, reason)
            what = verdict.by or ("explained" if reason else "SURVIVED")
            print(f"{subject.name}: {mutant.row}: {mutant.name}: {what}", flush=True)
            return outcome

        with ThreadPoolExecutor(jobs) as pool:
            return list(pool.map(judged, chosen))


def mutants(subject: Subject, limit: int | None, seed: int, kinds: Sequence[str]) -> list[Mutant]:
    """The chosen mutants of a subject; of its model only where the interpreter can run it."""
    with tempfile.TemporaryDirectory(prefix="ravenchart-mutate-") as place:
        files = Workbench(subject.model, Path(place), Observer, subject.node).files
    wanted = [
        m
        for m in mutants_of(files)
        if m.kind in kinds and (m.part != "model" or subject.observer is Simulated)
    ]
    return sampled(wanted, limit, seed)


def main(arguments: Sequence[str] | None = None) -> int:
    """Break and report; 1 when a mutant survived, 2 when a tool is missing."""
    options = _parser().parse_args(arguments)
    known = explanations(EXPLAINED)
    outcomes: list[Outcome] = []
    limit = None if options.all else options.limit
    try:
        for subject in SUBJECTS:
            if subject.name in options.subject:
                chosen = mutants(subject, limit, options.seed, options.kind)
                print(f"{subject.name}: {len(chosen)} mutants", flush=True)
                outcomes += tried(subject, chosen, options.jobs, known)
    except ToolMissing as missing:
        print(f"ravenchart: error: {missing}", file=sys.stderr)
        return 2
    except ToolFailed as failed:
        print(f"the unbroken program is not clean:\n{str(failed).rstrip()}", file=sys.stderr)
        return 2
    return told(outcomes, "score", KINDS)


def _parser() -> argparse.ArgumentParser:
    names = [s.name for s in SUBJECTS]
    parser = argparse.ArgumentParser(prog="make mutate", description=__doc__)
    parser.add_argument("--subject", nargs="+", choices=names, default=names)
    parser.add_argument("--kind", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--limit", type=int, default=3, help="mutants of each kind and part")
    parser.add_argument("--all", action="store_true", help="every mutant")
    parser.add_argument("--seed", type=int, default=1, help="another sample")
    parser.add_argument("--jobs", type=int, default=2)
    return parser


if __name__ == "__main__":
    raise SystemExit(main())
