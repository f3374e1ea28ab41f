# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The facts about a model: it is checked, generated anew, and compared with the files on disk.

File names count from the checkout or from the model's folder, wherever that is. So equal inputs
give equal facts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ravenchart.analysis.findings.deadlines import findings
from ravenchart.behaviour.limits import TO_THE_END
from ravenchart.building import checking, generation, programs
from ravenchart.building.checking import Checked
from ravenchart.building.programs import Program
from ravenchart.building.stacks import read_record
from ravenchart.failures import Refused
from ravenchart.gen.files.links import Link, links
from ravenchart.gen.files.load import read_file, read_model
from ravenchart.paths import ROOT
from ravenchart.proof import outside_spark
from ravenchart.proof.proving import TERMINATION
from ravenchart.stacks.report import Memory
from ravenchart.tools.kept import file_digest

from . import records, tracefile
from .records import BelievedRecord
from .results import Test, junit
from .tracefile import CountedBody

FIRST_DRIVER = "loopback"
"""With it all of the runtime is proved; with another only what differs."""
OUTSIDE = ROOT / "proofs" / "outside_spark.toml"
"""Names that may be outside SPARK in the runtime, with the entry of the ledger."""


@dataclass(frozen=True, slots=True)
class NodeFacts:
    """The program of a node: its record, and what of its files is not what the model gives."""

    program: Program
    record: BelievedRecord | None
    ending: BelievedRecord | None
    """The record that each execution ends."""
    differences: tuple[str, ...]
    files: tuple[tuple[str, str], ...]
    """(name, SHA-256) of each of its files on disk."""

    @property
    def name(self) -> str:
        """The name of the node, or of the library."""
        return self.program.node or self.program.checked.system.name


@dataclass(frozen=True, slots=True)
class Facts:
    """All that the claims are made of."""

    checked: Checked
    """The model as it is here, names of files from its own folder."""
    driver: str
    nodes: tuple[NodeFacts, ...]
    libraries: tuple[NodeFacts, ...]
    """The code of each library that the system uses."""
    runtime: tuple[BelievedRecord, ...]
    """Of the runtime and the HAL with this driver; empty where they are missing."""
    reasons: tuple[tuple[str, str], ...]
    """Names that may be outside SPARK by the user's list, with the reason."""
    runtime_reasons: tuple[tuple[str, str], ...]
    ungenerated: str
    """Why no program can be generated of the model; "" where one can."""
    sources: tuple[tuple[str, str], ...]
    """(name, SHA-256) of the files of the model."""
    links: tuple[Link, ...]
    tests: tuple[Test, ...] | None
    """Results of tests, where some were given."""
    memory: tuple[Memory, ...] = ()
    """Records of builds: stacks and memory."""
    coverage: tuple[CountedBody, ...] | None = None
    """The counts of test cases, where a tracefile is given."""

    @property
    def programs(self) -> tuple[NodeFacts, ...]:
        """All that is generated: the libraries, and the program of each node."""
        return (*self.libraries, *self.nodes)


def gather(
    model: Path,
    driver: str | None = None,
    given: Sequence[Path] = (),
    tests: Path | None = None,
    effort: int = TO_THE_END,
    memory: Sequence[Path] = (),
    coverage: Path | None = None,
) -> Facts:
    """The facts about a model; Refused where it has errors other than missed deadlines."""
    folder = model.parent

    def read(path: Path, limit: int) -> bytes:
        return read_file(folder / path, limit)

    main = Path(model.name)
    found = checking.check(main, deadlines=False, effort=effort, finish=True, read=read)
    checked = replace(found, path=model)
    chosen = driver or programs.default_driver(checked)
    programs.check_driver(checked, chosen)
    files, why = _generated(checked)
    made = programs.programs_of(checked)
    libraries = [one for used in checked.libraries for one in programs.programs_of(used)]
    _refuse_foreign(given, [*libraries, *made])
    nodes = tuple(_node(program, chosen, files, why, given) for program in made)
    runtime, reasons = _runtime(chosen, folder)
    sources = tuple((name, file_digest(folder / name)) for name in found.sources)
    return Facts(
        checked,
        chosen,
        nodes,
        tuple(
            _node(one, chosen, generation.texts_of(one.checked), why, given) for one in libraries
        ),
        runtime,
        tuple(outside_spark.reasons_of(checked.system, folder).items()),
        reasons,
        why,
        sources,
        links(read_model(main, read).written),
        None if tests is None else junit(tests),
        tuple(read_record(one) for one in memory),
        None if coverage is None else tracefile.read(coverage),
    )


def _generated(checked: Checked) -> tuple[dict[str, str], str]:
    """The files that the model gives; none and the reason where it gives none."""
    late = next((one for one in findings(checked.analysis) if one.is_error), None)
    if late is not None:
        return {}, late.message
    try:
        generation.without_clashes(checked)
        return generation.texts_of(checked), ""
    except Refused as refused:
        found = [str(getattr(one, "message", "")) for one in refused.found]
        return {}, next(iter(found), "") or "the model cannot be certified"


def _refuse_foreign(given: Sequence[Path], made: Sequence[Program]) -> None:
    """Refused where a record that is given is that of no program of the model."""
    for path in given:
        if not path.is_file():
            raise Refused(f"{path}: error: there is no such record")
        if len(made) > 1 and not any(records.belongs(path, program) for program in made):
            raise Refused(
                f"{path}: error: this is the record of no program of the model\n"
                f"{path}: hint: write one with `ravenchart prove MODEL --record FILE`"
            )


def _node(
    program: Program, driver: str, files: dict[str, str], why: str, given: Sequence[Path]
) -> NodeFacts:
    """The facts of one program; ``why`` there are no files, where there are none."""
    folder = program.checked.folder
    path = next((one for one in given if records.belongs(one, program)), None)
    if path is None and given and program.node:
        path = given[0]  # of another place, or damaged: its problems say so
    if path is None:
        path = records.of_example(program)
    record = ending = None
    if path is not None:
        record = records.read(path, path.name, folder)
        record = records.judged(record, records.missing(program, record, driver))
        beside = records.of_termination(path)
        if beside.is_file():
            ending = records.read(beside, beside.name, folder, TERMINATION)
    within = f"{program.folder}/" if program.folder else ""
    wanted = {
        name.removeprefix(within): text
        for name, text in files.items()
        if not program.folder or name.startswith(within)
    }
    there = {
        path.relative_to(program.generated).as_posix(): path
        for path in sorted(program.generated.rglob("*"))
        if path.is_file() and path.suffix in (*records.ADA, ".gpr", ".adc", ".json", ".dbc")
    }
    differences = [] if files else [f"it gives none: {why}"]
    differences += [f"{name} is not there" for name in wanted if name not in there]
    for name, path in there.items():
        if name not in wanted and files:
            differences.append(f"{name} is not generated of this model")
        elif files and path.read_bytes() != wanted[name].encode("utf-8"):
            differences.append(f"{name} is not what the model gives")
    pairs = tuple((records.shown(path, folder), file_digest(path)) for path in there.values())
    return NodeFacts(program, record, ending, tuple(differences), pairs)


def _runtime(
    driver: str, folder: Path
) -> tuple[tuple[BelievedRecord, ...], tuple[tuple[str, str], ...]]:
    """The records of runtime and HAL, and what may be outside SPARK in them."""
    found: list[BelievedRecord] = []
    reasons: dict[str, str] = {}
    for name in dict.fromkeys((FIRST_DRIVER, driver)):
        target = f"runtime-{name}"
        path = records.of_target(target)
        if path is not None:
            found.append(records.read(path, path.name, folder))
        if OUTSIDE.is_file():
            reasons |= outside_spark.reasons_for_target(OUTSIDE, target)
    return tuple(found), tuple(reasons.items())
