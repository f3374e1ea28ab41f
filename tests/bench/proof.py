# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`make bench-proof`: does the proof of a region grow linearly with its leaf states?

Random charts of growing size are generated and proved: selection, configuration and
order together. The time on two jobs is given for each leaf.
"""

from __future__ import annotations

import argparse
import json
import resource
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ravenchart.failures import ToolFailed
from ravenchart.proof.spark_results import entity_of
from ravenchart.tools.toolchain import ToolMissing
from tests.mutation.mutants import text_of
from tests.mutation.nodes import body_of
from tests.mutation.observing import Observer
from tests.mutation.workbench import Workbench

from .random_models import random_model

SIZES = (15, 30, 60, 120)
MOST = 2.0
"""Seconds that a leaf state may take on two cores."""
JOBS = 2


@dataclass(frozen=True, slots=True)
class Figures:
    """One proof: leaf states, seconds of processor and wall, where they were spent."""

    leaves: int
    processor: float
    wall: float
    phases: dict[str, float]
    subprograms: int
    lines: int

    @property
    def per_leaf(self) -> float:
        """Seconds on the clock for each leaf state."""
        return self.wall / self.leaves

    def line(self) -> str:
        """For people."""
        parts = ", ".join(f"{name} {spent:.0f} s" for name, spent in self.phases.items())
        return (
            f"{self.leaves:>4} leaves: {self.wall:.1f} s ({self.per_leaf:.2f} s a leaf), "
            f"processor {self.processor:.1f} s; {self.lines} lines, "
            f"{self.subprograms} subprograms; {parts}"
        )


def _processor_time() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measure(leaves: int, seed: int) -> Figures:
    """Generate and prove one chart; ToolFailed when something of it is not proved."""
    with tempfile.TemporaryDirectory(prefix="ravenchart-proof-") as place:
        model = Path(place) / "model.yaml"
        model.write_text(random_model(leaves, seed), encoding="utf-8")
        bench = Workbench(model, Path(place), Observer)
        unit = next(n for n, one in bench.units.items() if body_of(one, "Fire") is not None)
        text = text_of(bench.units[unit])
        processor, wall = _processor_time(), time.perf_counter()
        bench.prove([unit], jobs=JOBS)
        processor, wall = _processor_time() - processor, time.perf_counter() - wall
        found = next(Path(place).rglob(f"{Path(unit).stem}.spark"))
        result = json.loads(found.read_text(encoding="utf-8"))
        names = {entity_of(result, check["entity"])["name"] for check in result["proof"]}
        phases = _phases(_timings(result.get("timings", {})), processor)
        return Figures(leaves, processor, wall, phases, len(names), len(text.splitlines()))


def _timings(found: Mapping[str, Any]) -> dict[str, float]:
    """Sums by name: the younger age has a table for each entity."""
    sums: dict[str, float] = {}
    for name, value in found.items():
        for key, spent in value.items() if isinstance(value, dict) else [(name, value)]:
            sums[key] = sums.get(key, 0.0) + spent
    return sums


def _phases(timings: dict[str, float], processor: float) -> dict[str, float]:
    """gnatprove's times by phase; what is left is for the provers and the units around."""
    found = dict.fromkeys(("reading theories", "transformations", "flow"), 0.0)
    for name, spent in timings.items():
        if name == "gnatwhy3.init":
            found["reading theories"] += spent
        elif name.startswith("gnatwhy3.transformations"):
            found["transformations"] += spent
        elif name == "flow analysis":
            found["flow"] += spent
    found["provers and the rest"] = processor - sum(found.values())
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure every size; 1 when one takes too long or is not proved."""
    parser = argparse.ArgumentParser(prog="make bench-proof", description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="+", default=list(SIZES))
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(arguments)
    slow = []
    try:
        for leaves in options.sizes:
            found = measure(leaves, options.seed)
            print(found.line(), flush=True)
            if found.per_leaf > MOST:
                slow.append(leaves)
    except ToolMissing as missing:
        print(f"ravenchart: error: {missing}", file=sys.stderr)
        return 2
    except ToolFailed as failed:
        print(str(failed).rstrip(), file=sys.stderr)
        return 1
    verdict = f"NOT at {', '.join(map(str, slow))} leaves" if slow else "holds"
    print(f"at most {MOST:g} s a leaf state on {JOBS} cores at every size: {verdict}")
    return 1 if slow else 0


if __name__ == "__main__":
    raise SystemExit(main())
