"""Running gnatprove, reading what it found, and keeping the record of it.

A record is one TOML file per project: for each proved source its SHA-256, for
each subprogram its checks and the provers that discharged them. No date, host
or time stands in it, so a difference means a change.
"""

from __future__ import annotations

import hashlib
import json
import tomllib
from collections.abc import Iterable, Mapping
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
    bodies_off: int
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
            f"assumed {self.assumed}, bodies off {self.bodies_off}"
        )


def prove(project: Path, scenario: Mapping[str, str], results: Path) -> Proof:
    """Prove a project whose results land in ``results``.

    ToolFailed with gnatprove's messages when anything is left. The results of
    earlier runs go first: what is read then is of this run alone.
    """
    for old in results.glob("*.spark"):
        old.unlink()
    arguments = ["-P", project.name, "--output=oneline", "--warnings=error", "-q"]
    toolchain.run("gnatprove", arguments, project.parent, scenario)
    return read_results(results)


def read_results(folder: Path) -> Proof:
    """The results of the last run, from the .spark files in ``folder``."""
    checks = proved = justified = assumed = off = 0
    tallies: dict[str, tuple[int, set[str]]] = {}
    files: set[str] = set()
    for path in sorted(folder.glob("*.spark")):
        found = json.loads(path.read_text(encoding="utf-8"))
        assumed += len(found.get("pragma_assume", ()))
        for item in found["spark"]:
            files |= {place["file"] for place in item["sloc"]}
            off += item["spark"] == "spec"
        for check in (*found.get("proof", ()), *found.get("flow", ())):
            if "rule" not in check or check["severity"] in ("warning",):
                continue
            checks += 1
            justified += "suppressed" in check
            proved += check["severity"] == "info" and "suppressed" not in check
            count, provers = tallies.get(check["entity"]["name"], (0, set()))
            provers |= set(check.get("stats", ())) or {"flow"}
            tallies[check["entity"]["name"]] = (count + 1, provers)
    entities = tuple(
        Entity(name, count, tuple(sorted(provers)))
        for name, (count, provers) in sorted(tallies.items())
    )
    return Proof(checks, proved, justified, assumed, off, digests(files), entities)


def digests(names: Iterable[str]) -> tuple[tuple[str, str], ...]:
    """(path, SHA-256) of each project source among ``names``; others belong to the compiler."""
    known = {p.name: p for p in sources()}
    found = (known[name] for name in set(names) if name in known)
    return tuple(sorted((str(p.relative_to(toolchain.ROOT)), digest(p)) for p in found))


def sources() -> tuple[Path, ...]:
    """All Ada sources of the checkout that proof reads."""
    roots = ("spark_runtime", "hw_can", "proofs", "examples")
    return tuple(p for r in roots for p in sorted((toolchain.ROOT / r).rglob("*.ad[sb]")))


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
        f"bodies_off = {proof.bodies_off}",
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
