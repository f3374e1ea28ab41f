# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures: what runtime, codecs and buses cost, and how generator and analysis grow.

Everything is measured in one run, and what matters are the ratios: absolute
times depend on the machine.
"""

from __future__ import annotations

import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from ravenchart.behaviour import rules as behaviour_rules
from ravenchart.building import checking, generation
from ravenchart.gen.emit.program import generate
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from tests.support.ada_programs import built

from . import buses as bench_buses
from . import changes as bench_changes
from . import charts as bench_charts
from . import codecs as bench_codecs
from . import commands as bench_commands
from . import generated as bench_generated
from . import timing as bench_timing
from . import viewed as bench_viewed
from . import waiting as bench_waiting
from .large_models import large_model

ROUNDS = 5
MOST_SECONDS = 10.0
"""What the program of 1,000 regions may take."""


def median_ms(work: Callable[[], object]) -> float:
    """Median time of `ROUNDS` calls, in ms."""
    spent = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        work()
        spent.append(1e3 * (time.perf_counter() - start))
    return statistics.median(spent)


def runtime_operations() -> None:
    """The Ada bench, built with -O2 and checks off."""
    program = built("release", "loopback", "bench_runtime") / "bench_runtime"
    print("runtime (-O2, ceiling locking; medians):")
    done = subprocess.run([program], capture_output=True, text=True, timeout=60, check=True)
    for line in done.stdout.splitlines():
        print(f"  {line}")


def generator() -> None:
    """Load, analyse and generate the robot."""
    path = ROOT / "examples" / "cartesian_robot" / "model.yaml"
    checked = checking.check(path)
    claims = generation.claims(checked)
    print("the Cartesian robot (medians):")
    print(f"  load and check the model: {median_ms(lambda: load(path)):.0f} ms")
    print(f"  generate its program: {median_ms(lambda: generate(checked.system, claims)):.0f} ms")


def large_models() -> None:
    """Check, generate and write models of 1,000 regions; the rules of behaviour apart."""
    print("a model of 1,000 regions:")
    for components, regions in ((1000, 1), (100, 10)):
        with tempfile.TemporaryDirectory(prefix="ravenchart-large-") as place:
            path = Path(place) / "model.yaml"
            path.write_text(large_model(components, regions), encoding="utf-8")
            start = time.perf_counter()
            checked = checking.check(path, effort=0)
            written = generation.write_program(checked)
            spent = time.perf_counter() - start
            start = time.perf_counter()
            behaviour_rules.findings(checked.system)
            rules = time.perf_counter() - start
        verdict = "" if spent <= MOST_SECONDS else f" (more than {MOST_SECONDS:g} s)"
        print(
            f"  {components} components of {regions}: {written.files} files in {spent:.1f} s"
            f"{verdict}; the rules of behaviour {rules:.1f} s more"
        )


def main() -> None:
    """All figures."""
    bench_waiting.main()
    bench_generated.main()
    runtime_operations()
    bench_commands.main()
    bench_codecs.main()
    bench_buses.main()
    bench_charts.main()
    generator()
    large_models()
    bench_timing.main()
    bench_changes.main()
    bench_viewed.main()


if __name__ == "__main__":
    main()
