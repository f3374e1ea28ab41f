# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`make mutate-runtime`: break the Ada that people wrote, runtime and HAL: who notices?

The facts of tests/ada are asked first, with every contract executed, then gnatprove. Only what
neither notices survives.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ravenchart.failures import ToolFailed
from ravenchart.paths import ROOT
from ravenchart.proof import proving
from ravenchart.tools import toolchain
from ravenchart.tools.toolchain import ToolMissing

from . import text_rules
from .mutants import Mutant, sampled
from .report import Explained, Outcome, explanations, reason_of, told
from .workbench import Verdict

UNITS = [
    path.relative_to(ROOT)
    for folder in ("spark_runtime/src", "hw_can/hal", "hw_can/drivers/serial")
    for path in sorted((ROOT / folder).glob("*.ad[bs]"))
]
"""What is broken."""
NEEDED = ("spark_runtime", "hw_can", "proofs", "tests/ada", "tests/feature/authenticated")
"""What the copy has of the checkout, with the projects beside them."""
SCENARIO = {"MODE": "checks", "CAN_DRIVER": "loopback", "RAVENCHART_WARNINGS": "shown"}
"""A warning that a break leaves behind would be no merit of the tests."""
HANGS = 60.0
"""Seconds after which a program of facts is given up, and the mutant noticed."""
PROVED_WITH = {"hw_can/drivers/serial": "slcan"}
"""The driver without which gnatprove would not read a folder; for all others any will do."""
NO_FACTS = ("bench_runtime", "bus_load", "float_lines", "iso_tp_line", "slcan_fuzz")
"""Programs of tests/ada that do not print facts."""
EXPLAINED = Path(__file__).parent / "explained_runtime.toml"


class Checkout:
    """A copy of runtime, HAL and their tests."""

    def __init__(self, folder: Path) -> None:
        """Copied, built, and clean; ToolFailed when it is not."""
        self.folder = folder
        for name in NEEDED:
            shutil.copytree(ROOT / name, folder / name)
        for project in ROOT.glob("*.gpr"):
            shutil.copy(project, folder)
        self._scenario = {**SCENARIO, "RAVENCHART_OBJECTS": str(folder / "obj")}
        self._build()
        if found := self._facts():
            raise ToolFailed(found)

    def judged(self, file: Path, mutant: Mutant) -> Verdict:
        """Break, ask the compiler, the facts and gnatprove in turn, restore."""
        path = self.folder / file
        text = path.read_text(encoding="utf-8")
        path.write_text(mutant.applied(text), encoding="utf-8")
        try:
            self._build()
        except ToolFailed as failed:
            return Verdict("compiler", str(failed).strip().splitlines()[0])
        else:
            if found := self._facts():
                return Verdict("tests", found)
            return self._proved(file)
        finally:
            path.write_text(text, encoding="utf-8")

    def _build(self) -> None:
        options = ["-p", "-q", "-j0", "-P", "tests.gpr"]
        toolchain.run("gprbuild", options, self.folder / "tests" / "ada", self._scenario)

    def _facts(self) -> str:
        """The first fact that does not hold; "" when all do."""
        for program in sorted((self.folder / "obj" / "tests-checks-loopback" / "bin").iterdir()):
            if program.name in NO_FACTS:
                continue
            try:
                done = subprocess.run(
                    [program], capture_output=True, text=True, timeout=HANGS, check=False
                )
            except subprocess.TimeoutExpired:
                return f"{program.name} does not end"
            wrong = [line for line in done.stdout.splitlines() if line.startswith("not ok ")]
            if wrong or done.returncode != 0:
                last = (done.stderr.strip().splitlines() or [f"status {done.returncode}"])[-1]
                return f"{program.name}: {wrong[0] if wrong else last}"
        return ""

    def _proved(self, file: Path) -> Verdict:
        """All that `make prove ONLY=runtime-loopback` proves, with the verdicts of earlier runs.

        Of a unit that needs another driver: the unit, and those of its folder.
        """
        objects = self.folder / "obj"
        home = file.parent.as_posix()
        driver = PROVED_WITH.get(home, SCENARIO["CAN_DRIVER"])
        beside = (path.name for path in (self.folder / home).glob("*.adb"))
        task = proving.ProofTask(
            self.folder / "proofs" / "proofs.gpr",
            {**self._scenario, "CAN_DRIVER": driver},
            tuple(
                objects / name / "gnatprove"
                for name in (f"proofs-checks-{driver}", f"checks-{driver}")
            ),
            tuple(
                p for p in self.folder.rglob("*") if p.is_dir() and objects not in (p, *p.parents)
            ),
            whole=True,
            units=tuple(sorted(beside)) if home in PROVED_WITH else (),
        )
        try:
            proving.prove(task)
        except ToolFailed as failed:
            return Verdict("gnatprove", str(failed).strip().splitlines()[0])
        return Verdict(None)


def tried(
    units: Sequence[str], limit: int | None, seed: int, known: Sequence[Explained]
) -> list[Outcome]:
    """At most ``limit`` mutants of each kind in each unit, judged one after the other."""
    outcomes = []
    with tempfile.TemporaryDirectory(prefix="ravenchart-mutate-") as place:
        checkout = Checkout(Path(place))
        for file in UNITS:
            if units and file.stem.removeprefix("ravenchart-") not in units:
                continue
            text = (ROOT / file).read_text(encoding="utf-8")
            for mutant in sampled(text_rules.mutants_of(file.name, text), limit, seed):
                diff = mutant.diff(text)
                verdict = checkout.judged(file, mutant)
                reason = "" if verdict.by else reason_of(known, file.name, mutant, diff)
                outcomes.append(Outcome(file.name, mutant, diff, verdict, reason))
                what = verdict.by or ("explained" if reason else "SURVIVED")
                print(f"{file.name}: {mutant.name}: {what}: {verdict.words}", flush=True)
    return outcomes


def main(arguments: Sequence[str] | None = None) -> int:
    """Break and report; 1 when a mutant survived, 2 when a tool is missing."""
    options = _parser().parse_args(arguments)
    limit = None if options.all else options.limit
    try:
        outcomes = tried(options.unit, limit, options.seed, explanations(EXPLAINED))
    except ToolMissing as missing:
        print(f"ravenchart: error: {missing}", file=sys.stderr)
        return 2
    except ToolFailed as failed:
        print(f"what is not broken is not clean:\n{str(failed).rstrip()}", file=sys.stderr)
        return 2
    return told(outcomes, "runtime", text_rules.KINDS)


def _parser() -> argparse.ArgumentParser:
    names = sorted({unit.stem.removeprefix("ravenchart-") for unit in UNITS})
    parser = argparse.ArgumentParser(prog="make mutate-runtime", description=__doc__)
    parser.add_argument("--unit", nargs="+", choices=names, default=[], metavar="UNIT")
    parser.add_argument("--limit", type=int, default=1, help="mutants of each kind in each unit")
    parser.add_argument("--all", action="store_true", help="every mutant")
    parser.add_argument("--seed", type=int, default=1, help="another sample")
    return parser


if __name__ == "__main__":
    raise SystemExit(main())
