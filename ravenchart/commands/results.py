# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""``result`` of the object that `--json` prints, one class for each command.

Times are whole ns. A change of these classes changes docs/answer.schema.json (`make docs`).
"""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.described import Described, Result
from ravenchart.running.measured import Measurement

from .build_results import BuildResult, CheckResult, GenerateResult
from .run_results import MonitorResult, RunResult, ShellResult


@dataclass(slots=True)
class Unproved(Described):
    """A check that gnatprove could not prove."""

    file: str
    """As seen from the model's folder."""
    line: int
    """Of the file, from 1."""
    column: int
    """Of the line, from 1."""
    check: str
    """The check, in the words of gnatprove."""
    example: str
    """Values for which it fails; empty where the prover found none."""
    element: str
    """The element of the model that the code belongs to; empty where there is none."""
    origin: str
    """The location of that element in the model: file, line and column."""
    help: str
    """A change that usually helps."""


@dataclass(slots=True)
class Proved(Described):
    """The proof of one program."""

    node: str
    """The name of the node."""
    checks: int
    """How many checks gnatprove made."""
    proved: int
    """How many of these are proved."""
    justified: int
    """How many are justified by hand."""
    assumed: int
    """How many statements `pragma Assume` there are."""
    outside: list[str]
    """The units and subprograms outside SPARK."""
    unproved: list[Unproved]
    """The checks that are not proved."""
    clean: bool
    """Whether everything is proved, and nothing justified or assumed."""
    cached: bool
    """Whether the results are those of an earlier run on the same content."""
    ends: bool
    """Whether each execution of a row is proved to end; true of a library, which runs nothing."""


@dataclass(slots=True)
class ProveResult(Result):
    """Programs, generated and given to gnatprove."""

    generated: GenerateResult
    """The generation."""
    programs: list[Proved]
    """One for each node that runs something."""


@dataclass(slots=True)
class ActivityRow(Described):
    """An activity of a processor."""

    activity: str
    """Its name."""
    period: int
    """In ns."""
    deadline: int
    """In ns."""
    wcet: int
    """Worst-case execution time in ns."""
    response: int | None
    """Response-time bound in ns; null where there is none."""


@dataclass(slots=True)
class Allocated(Described):
    """A processor of the proposal."""

    processor: str
    """Its name."""
    node: str
    """The node on which it is."""
    core: int
    """The core of the node, from 1."""
    stays: bool
    """Whether it was left as it is."""
    priority: int
    """Its priority."""
    period: int
    """In ns."""
    offset: int
    """In ns."""
    deadline: int
    """In ns."""
    wcet: int
    """Worst-case execution time in ns."""
    response: int | None
    """Response-time bound in ns; null where there is none."""
    activities: list[ActivityRow]
    """Its table, first to last."""


@dataclass(slots=True)
class AllocateResult(Result):
    """A proposal for the processors of a model."""

    strategy: str
    """As the call had it."""
    met: bool
    """Whether every deadline and limit is kept."""
    processors: list[Allocated]
    """Highest priority first."""
    yaml: str
    """`processors:` for the model."""


@dataclass(slots=True)
class DrawResult(Result):
    """Drawings, written."""

    folder: str
    """Where they are."""
    form: str
    """`svg`, `plantuml` or `mermaid`."""
    files: list[str]
    """Their names."""


@dataclass(slots=True)
class Tool(Described):
    """A program, folder or right that Ravenchart needs."""

    name: str
    """Its name."""
    state: str
    """`ok`; `missing`: no program can be built; `absent`: only some commands need it."""
    text: str
    """Version and path, or the command that installs it."""


@dataclass(slots=True)
class DoctorResult(Result):
    """The programs, folders and rights that Ravenchart needs."""

    tools: list[Tool]
    """In the order of the printed list."""


@dataclass(slots=True)
class ExampleResult(Described):
    """Files, and what is called beside them."""

    commands: list[str]
    """The last one reports the code where the files are wrong."""
    files: dict[str, str]
    """Each file by its name, with its text."""


@dataclass(slots=True)
class ExplainResult(Result):
    """The explanation of a code."""

    code: str
    """The code."""
    meaning: str
    """One sentence."""
    reason: str
    """Why it matters."""
    wrong: ExampleResult
    """A whole model, and the files that it needs, with the error."""
    corrected: ExampleResult
    """The same without it."""
    text: str
    """The text that is printed without `--json`."""


@dataclass(slots=True)
class BusResult(Result):
    """A bus that processes can join from now on."""

    channel: str
    """Where they join it: `HOST:PORT`."""


@dataclass(slots=True)
class PageResult(Result):
    """A local page that can be opened from now on."""

    address: str
    """Its URL, with the token that gives access to all that the page can do."""


@dataclass(slots=True)
class CompletionResult(Result):
    """The script by which a shell completes commands."""

    shell: str
    """The shell that reads it."""
    script: str
    """The script."""


@dataclass(slots=True)
class CleanResult(Result):
    """The folders that were deleted."""

    folders: list[str]
    """The folders."""
    bytes: int
    """Their size."""


@dataclass(slots=True)
class NewResult(Result):
    """A project, written."""

    folder: str
    """Where it is."""
    files: list[str]
    """Below that folder."""


@dataclass(slots=True)
class LoopbackCase(Described):
    """A case of the suite."""

    name: str
    """Its name."""
    verdict: str
    """`passed`, `failed` or `skipped`."""
    seconds: float
    """How long it took."""
    detail: str
    """The observation, or the reason."""


@dataclass(slots=True)
class LoopbackResult(Result):
    """The suite over two ends of one bus."""

    passed: bool
    """Whether nothing failed, and something passed."""
    cases: list[LoopbackCase]
    """In the order in which they ran."""
    latencies: list[int]
    """From sending to receiving, in ns."""
    rate: float | None
    """Frames per second."""


@dataclass(slots=True)
class ImportResult(Result):
    """The messages of a database."""

    yaml: str
    """Types, ports and messages for a model."""


@dataclass(slots=True)
class ExportResult(Result):
    """The database of a bus."""

    bus: str
    """The name of the bus."""
    dbc: str
    """The database."""


@dataclass(slots=True)
class CertificateResult(Result):
    """A generated program, compared with its model by independent code."""

    agrees: bool
    """Whether all comparisons agree; the diagnostics are those that do not."""
    compared: dict[str, int]
    """How many comparisons of each class were made."""
    not_derived: dict[str, int]
    """The facts that were not derived again, each with its count of numbers; 0: no numbers."""


@dataclass(slots=True)
class TracedRequirement(Described):
    """A requirement with all that belongs to it."""

    id: str
    """Its id in the list."""
    text: str
    """Its text."""
    elements: list[str]
    """Elements of the model that name it."""
    code: list[str]
    """Generated files of these elements."""
    claims: dict[str, str]
    """Claims about these elements, each with its verdict."""
    tests: dict[str, str]
    """Tests and scenarios that name it, each with its outcome."""


@dataclass(slots=True)
class TracedElement(Described):
    """An element of the model that names requirements."""

    element: str
    """Its name."""
    kind: str
    """Its kind."""
    requirements: list[str]
    """The ids."""
    code: list[str]
    """Its generated files."""
    claims: list[str]
    """Claims about it."""


@dataclass(slots=True)
class RequirementsResult(Result):
    """Traceability both ways; its findings are the diagnostics."""

    requirements: list[TracedRequirement]
    """In the order of the list."""
    elements: list[TracedElement]
    """In the order of the model."""


@dataclass(slots=True)
class EvidenceResult(Result):
    """A folder of evidence, written."""

    folder: str
    """Where it is."""
    files: list[str]
    """Below that folder."""
    claims: dict[str, int]
    """How many claims have each verdict."""


@dataclass(slots=True)
class TestCase(Described):
    """An event file."""

    file: str
    """Where it is."""
    shows: list[str]
    """The goals that it is the first of all to show."""
    instance: str | None = None
    """The instance that it is played on alone; null: it is played on the system."""


@dataclass(slots=True)
class TestGoals(Described):
    """The goals of one kind."""

    kind: str
    """The kind."""
    shown: int
    """How many of them the cases show."""
    goals: int
    """How many there are."""
    unreachable: int
    """How many of them no execution can show."""


@dataclass(slots=True)
class BodyCoverage(Described):
    """The coverage of a body by the cases."""

    file: str
    """The source."""
    origin: str
    """`generated`, `user` or `runtime`."""
    lines: int
    """Lines with code."""
    executed: int
    """How many of them were executed."""
    branches: int
    """Branches of the compiled conditions."""
    taken: int
    """How many of them were taken."""
    not_executed: list[int]
    """The lines that were not executed."""


@dataclass(slots=True)
class TestsResult(Result):
    """Test cases, found and written."""

    cases: list[TestCase]
    """The files."""
    goals: list[TestGoals]
    """The goals of the charts by kind, and how many the cases show."""
    open: list[str]
    """The goals that no case shows, and some execution may."""
    unreachable: list[str]
    """The goals that no execution can show."""
    different: list[str]
    """The files under which program and interpreter executed different behaviours."""
    coverage: list[BodyCoverage]
    """The coverage of the bodies by the cases; empty without `--coverage`."""


@dataclass(slots=True)
class MeasureResult(Result):
    """A run whose execution times were measured."""

    measurement: Measurement
    """The times, and what they leave out."""


@dataclass(slots=True)
class TraceResult(Result):
    """A trace, written in another format."""

    file: str
    """Where it is."""
    records: int
    """How many records the trace has."""
    slices: int
    """How many stays in states it has."""
    lost: dict[str, int]
    """The losses of the run, by the name of the count."""
    complete: bool
    """Whether the run ended by itself; else the counts of its end are missing."""


RESULTS: dict[str, type[Result]] = {
    "check": CheckResult,
    "generate": GenerateResult,
    "build": BuildResult,
    "prove": ProveResult,
    "allocate": AllocateResult,
    "run": RunResult,
    "shell": ShellResult,
    "monitor": MonitorResult,
    "trace": TraceResult,
    "measure": MeasureResult,
    "draw": DrawResult,
    "doctor": DoctorResult,
    "explain": ExplainResult,
    "clean": CleanResult,
    "new": NewResult,
    "loopback": LoopbackResult,
    "import": ImportResult,
    "export-dbc": ExportResult,
    "check-certificate": CertificateResult,
    "requirements": RequirementsResult,
    "evidence": EvidenceResult,
    "tests": TestsResult,
    "bus": BusResult,
    "workbench": PageResult,
    "simulate": PageResult,
    "completion": CompletionResult,
}
"""Of each command with such an object, `simulate` with a page; `analyse` has its own form."""
