# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Running gnatprove, and keeping the record of what it found.

A record is one TOML file per project: for each source that the proof read its SHA-256, for
each subprogram its checks and the provers that discharged them. A record has no date, host or
time, so a difference means a change.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from pathlib import Path

from ravenchart.failures import ToolFailed
from ravenchart.paths import ROOT
from ravenchart.tools import steps
from ravenchart.tools.kept import file_digest

from . import ages, code, spark_results, verdicts
from . import earlier as proof_cache
from .spark_results import Outside, Results
from .verdicts import Memcached

TERMINATION = "termination"
"""A record that every execution ends rests on the bodies of all that runs."""


@dataclass(frozen=True, slots=True)
class ProofTask:
    """One gnatprove run."""

    project: Path
    scenario: Mapping[str, str]
    results: tuple[Path, ...]
    """The folders that the results land in; emptied before."""
    sources: tuple[Path, ...]
    """Folders with all that the proof may read: Ada sources, projects, configuration pragmas."""
    warnings: str = "continue"
    """``error``: a warning of flow analysis fails the run."""
    whole: bool = False
    """Prove the projects that this one uses again."""
    units: tuple[str, ...] = ()
    """The source files to prove, when not all."""
    shows: str = ""
    """The kind of its record; empty for all checks of a project."""
    made: Path | None = None
    """A folder of sources that were made for this run alone: no record names them."""


@dataclass(frozen=True, slots=True)
class Proof:
    """The outcome of one gnatprove run, and the sources it speaks of."""

    results: Results
    sources: tuple[tuple[str, str], ...]
    """(path below the checkout, SHA-256), sorted."""
    tool: str
    """gnatprove and its provers with their versions (`ages.tool_text`)."""
    cached: bool = field(default=False, compare=False)
    """Whether the results are those of an earlier run on the same content."""
    shows: str = ""
    """As in its task."""

    @property
    def clean(self) -> bool:
        """Everything proved, nothing justified or assumed."""
        found = self.results
        return not (found.unproved or found.justified or found.assumed)

    def summary(self) -> str:
        """The one line that every proof run ends in."""
        found = self.results
        proved = found.checks - found.justified - found.unproved
        return (
            f"checks {found.checks}, proved {proved}, justified {found.justified}, "
            f"assumed {found.assumed}, outside SPARK {len(found.outside)}"
            + (f", NOT PROVED {found.unproved}" if found.unproved else "")
            + (" (proved before from the same content)" if self.cached else "")
        )


class NotProved(ToolFailed):
    """Checks are left that gnatprove could not prove; the text is its messages."""

    def __init__(self, text: str, proof: Proof) -> None:
        super().__init__(text)
        self.proof = proof


def prove(
    task: ProofTask,
    *,
    fresh: bool = False,
    memcached: Memcached | None = None,
    tell: Callable[[str], None] = lambda _: None,
) -> Proof:
    """Run gnatprove, or take the results of an earlier run on the same content.

    NotProved when anything is left, ToolFailed when gnatprove ended for another reason or a source
    was changed meanwhile. ``fresh`` runs it in any case, and each prover with it. Else a prover
    gets only formulas that were not proved before and that the ``memcached`` server of a team
    does not have. The result folders are emptied first, so the results are those of this run
    alone. ``tell`` gets the progress.
    """
    version = ages.version()
    inputs = _inputs(task.sources)
    key = proof_cache.key(version, task, inputs)
    results = None if fresh else proof_cache.load(key)
    cached = results is not None
    failed = None
    if results is None:
        for folder in task.results:
            shutil.rmtree(folder, ignore_errors=True)
        with nullcontext() if fresh else verdicts.served(version, memcached) as server:
            try:
                _run(task, server, tell)
            except ToolFailed as problem:
                failed = problem
        with_bodies = task.shows == TERMINATION
        results = spark_results.read_results(task.results, task.units, with_bodies=with_bodies)
        edited = sorted(path for path, _ in _inputs(task.sources).items() ^ inputs.items())
        if edited:
            raise ToolFailed(f"{edited[0]}: error: it was changed during the proof; prove again")
        if failed is None:
            proof_cache.store(key, results)
    results = replace(results, outside=_with_code(results.outside, inputs))
    read = {path: digest for path, digest in inputs.items() if _is_read(path, results)}
    if task.made is not None:
        made = task.made.resolve()
        read = {path: digest for path, digest in read.items() if not path.is_relative_to(made)}
    sources = tuple(sorted((_shown(path), digest) for path, digest in read.items()))
    proof = Proof(results, sources, ages.tool_text(version), cached, task.shows)
    if failed is not None:
        raise NotProved(str(failed), proof) if results.unproved else failed
    return proof


def is_kept(task: ProofTask) -> bool:
    """Whether results of an earlier run on the same content are there, so `prove` takes no time."""
    key = proof_cache.key(ages.version(), task, _inputs(task.sources))
    return proof_cache.load(key) is not None


def examples(task: ProofTask, proof: Proof, tell: Callable[[str], None] = lambda _: None) -> str:
    """The messages about what is not proved, with values for which it fails where there are some.

    Each unit with such a check is proved again, for the provers look for values only then.
    """
    bodies = {one.file: f"{one.file[:-1]}b" for one in proof.results.open}
    read = proof.results.files
    units = tuple(sorted({body if body in read else file for file, body in bodies.items()}))
    try:
        _run(replace(task, units=units), None, tell, "--counterexamples=on")
    except ToolFailed as problem:
        return str(problem)
    return ""


def _run(task: ProofTask, server: str | None, tell: Callable[[str], None], *more: str) -> None:
    arguments = ["-P", task.project.name, "-f", "-q", "--output=oneline", *more]
    arguments.append(steps.OF_GNATPROVE)
    arguments.append(f"--warnings={task.warnings}")
    if not task.whole:
        arguments.append("--no-subprojects")
    if server is not None:
        arguments.append(f"--memcached-server={server}")
    if task.units:
        arguments += ["-u", *task.units]
    taken = steps.Announced(steps.PROVING, tell).takes
    ages.run(arguments, task.project.parent, task.scenario, taken)


SOURCES = (".ads", ".adb", ".gpr", ".adc")
"""Endings of the files that a proof may depend on."""


def _inputs(folders: Sequence[Path]) -> dict[Path, str]:
    """Every file that the proof may read, with its SHA-256."""
    found = {path.resolve() for folder in folders for path in folder.glob("*")}
    return {p: file_digest(p) for p in sorted(found) if p.suffix in SOURCES and p.is_file()}


def _is_read(path: Path, results: Results) -> bool:
    """Ada sources by what gnatprove says it read; projects and configuration always."""
    return path.suffix not in (".ads", ".adb") or path.name in results.files


def _with_code(outside: Sequence[Outside], inputs: Mapping[Path, str]) -> tuple[Outside, ...]:
    """The same without units that rename a package: there is nothing to prove in these."""
    files = {path.name: path for path in inputs}
    places = ((one, files.get(one.location)) for one in outside)
    return tuple(
        one
        for one, path in places
        if path is None or not code.is_package_renaming(path.read_bytes())
    )


def _shown(path: Path) -> str:
    base = ROOT
    return path.relative_to(base).as_posix() if path.is_relative_to(base) else str(path)


def record_text(proof: Proof) -> str:
    """The record of a proof as TOML."""
    found = proof.results
    lines = [
        "# Written by `make prove`. Checked against the sources by `make test`.",
        f"checks = {found.checks}",
        f"proved = {found.checks - found.justified - found.unproved}",
        f"justified = {found.justified}",
        f"assumed = {found.assumed}",
        f"outside = {json.dumps([o.name for o in found.outside])}",
        f"tool = {json.dumps(proof.tool)}",
        *([f"shows = {json.dumps(proof.shows)}"] if proof.shows else []),
        "",
        "[sources]",
        *(f'"{path}" = "{digest}"' for path, digest in proof.sources),
        "",
        "[entities]",
        *(
            f'"{e.path}" = {{ checks = {e.checks}, provers = {json.dumps(e.provers)} }}'
            for e in found.entities
        ),
    ]
    return "\n".join(lines) + "\n"
