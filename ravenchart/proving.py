"""Running gnatprove, reading what it found, and keeping the record of it.

A record is one TOML file per project: for each proved source its SHA-256, for
each subprogram its checks and the provers that discharged them. No date, host
or time stands in it, so a difference means a change.
"""

from __future__ import annotations

import hashlib
import json
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from . import toolchain


@dataclass(frozen=True, slots=True)
class Entity:
    """One subprogram, task or package, and what was proved of it."""

    path: str
    checks: int
    provers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Proof:
    """The outcome of one gnatprove run."""

    checks: int
    proved: int
    justified: int
    assumed: int
    bodies_off: tuple[str, ...]
    """Units whose bodies are outside SPARK."""
    sources: tuple[tuple[str, str], ...]
    """(path below the checkout, SHA-256), sorted."""
    entities: tuple[Entity, ...]

    @property
    def clean(self) -> bool:
        """Everything proved, nothing justified or assumed."""
        return self.proved == self.checks and not self.justified and not self.assumed

    def summary(self) -> str:
        """The one line that every proof run ends in."""
        return (
            f"checks {self.checks}, proved {self.proved}, justified {self.justified}, "
            f"assumed {self.assumed}, bodies off {len(self.bodies_off)}"
        )


def prove(
    project: Path,
    scenario: Mapping[str, str],
    results: Sequence[Path],
    roots: Sequence[Path],
    *,
    warnings: str = "continue",
    whole: bool = False,
    units: Sequence[str] = (),
) -> Proof:
    """Prove a project; ``results`` are the folders its results land in, its own first.

    The record names every source below ``roots``. ToolFailed with gnatprove's
    messages when anything is left, and with ``warnings="error"`` also for a warning
    of flow analysis, such as a value that is set and never used. The results of
    earlier runs go first: what is read then is of this run alone. Of the projects that
    it uses, which are proved by themselves, it takes what their sources say, or with
    ``whole`` proves them again. ``units`` are source files, when not all shall be proved.
    """
    for old in (path for folder in results for path in folder.glob("*.spark")):
        old.unlink()
    arguments = ["-P", project.name, "-f", "-q", "--output=oneline"]
    arguments.append(f"--warnings={warnings}")
    if not whole:
        arguments.append("--no-subprojects")
    if units:
        arguments += ["-u", *units]
    toolchain.run("gnatprove", arguments, project.parent, scenario)
    return read_results(results, roots)


def read_results(folders: Sequence[Path], roots: Sequence[Path]) -> Proof:
    """The results of the last run: gnatprove.out for the totals, .spark files for the rest."""
    assumed = 0
    off: set[str] = set()
    tallies: dict[str, tuple[int, set[str]]] = {}
    for path in sorted(path for folder in folders for path in folder.glob("*.spark")):
        found = json.loads(path.read_text(encoding="utf-8"))
        assumed += len(found.get("pragma_assume", ()))
        off |= {path.stem for item in found["spark"] if item["spark"] == "spec"}
        for check in found.get("proof", ()):
            count, provers = tallies.get(check["entity"]["name"], (0, set()))
            provers |= set(check.get("stats", ()))
            tallies[check["entity"]["name"]] = (count + 1, provers)
    entities = tuple(
        Entity(name, count, tuple(sorted(provers)))
        for name, (count, provers) in sorted(tallies.items())
    )
    checks, justified, unproved = _totals((folders[0] / "gnatprove.out").read_text("utf-8"))
    proved = checks - justified - unproved
    bodies = tuple(sorted(off))
    return Proof(checks, proved, justified, assumed, bodies, _digests(roots), entities)


def _totals(summary: str) -> tuple[int, int, int]:
    """Checks in all, justified, unproved: the last row of gnatprove's summary."""
    row = re.search(r"^Total(.*)$", summary, re.M)
    if row is None:
        raise toolchain.ToolFailed("gnatprove's summary has no row of totals")
    cells = re.findall(r"(\d+|\.)(?: \([^)]*\))?", row.group(1))
    numbers = [0 if cell == "." else int(cell) for cell in cells]
    return numbers[0], numbers[-2], numbers[-1]


def _digests(roots: Sequence[Path]) -> tuple[tuple[str, str], ...]:
    """(path below the checkout, SHA-256) of every Ada source below ``roots``, sorted."""
    found = {p.resolve() for root in roots for p in root.rglob("*.ad[sb]")}
    base = toolchain.ROOT
    return tuple(
        sorted(
            (str(p.relative_to(base) if p.is_relative_to(base) else p), digest(p)) for p in found
        )
    )


def digest(path: Path) -> str:
    """SHA-256 of a file's bytes, in hexadecimal."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def record_text(proof: Proof) -> str:
    """The record of a proof as TOML."""
    lines = [
        "# Written by `make prove`. Checked against the sources by `make test`.",
        f"checks = {proof.checks}",
        f"proved = {proof.proved}",
        f"justified = {proof.justified}",
        f"assumed = {proof.assumed}",
        f"bodies_off = {json.dumps(proof.bodies_off)}",
        "",
        "[sources]",
        *(f'"{path}" = "{digest}"' for path, digest in proof.sources),
        "",
        "[entities]",
        *(
            f'"{e.path}" = {{ checks = {e.checks}, provers = {json.dumps(e.provers)} }}'
            for e in proof.entities
        ),
    ]
    return "\n".join(lines) + "\n"


def stale_sources(record: Path) -> tuple[str, ...]:
    """The sources that differ from what the record says was proved."""
    found = tomllib.loads(record.read_text(encoding="utf-8"))
    stale = []
    for name, wanted in found["sources"].items():
        path = toolchain.ROOT / name
        if not path.is_file() or digest(path) != wanted:
            stale.append(name)
    return tuple(stale)
