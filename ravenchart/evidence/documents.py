# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""evidence.json: what the folder says, for programs. docs/evidence.schema.json is made of it."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.described import Described
from ravenchart.stacks.report import Memory

FORMAT = 1
"""The version of the file: raised when a key goes or changes its meaning."""


@dataclass(slots=True)
class Lack(Described):
    """Something that is not shown."""

    kind: str
    """`claim`, `assumption`, `outside`, `given`, `test` or `limit`."""
    what: str
    """Its subject: the id of a claim or assumption, an element, or a topic."""
    why: str
    """Why it is not shown, or the fact that is taken as given."""


@dataclass(slots=True)
class Input(Described):
    """A file or record that a verdict was made of."""

    name: str
    """From the checkout, or from the folder of the model."""
    sha256: str
    """Its digest."""


@dataclass(slots=True)
class ClaimEntry(Described):
    """A claim."""

    id: str
    """Its id: stable as long as the element keeps its name."""
    about: str
    """The goal that it belongs to."""
    elements: list[str]
    """Elements of the model."""
    requirements: list[str]
    """Ids of the requirements that these elements name."""
    statement: str
    """The claim in a sentence."""
    theorem: str
    """The exact fact that is shown, and how."""
    method: str
    """`proof`, `analysis ...`, `model checking`, `comparison`, `declaration` or `test`."""
    tool: str
    """Tool and version."""
    verdict: str
    """`met`, `partly`, `not met`, `not shown` or `user's`."""
    reasons: list[str]
    """Why it is not met, or only partly."""
    digest: str
    """SHA-256 over the inputs: equal inputs have equal digests."""
    inputs: list[Input]
    """The files and records that the verdict was made of."""


@dataclass(slots=True)
class ProbeEntry(Described):
    """Something that tests."""

    name: str
    """Test, or file and place of a scenario."""
    outcome: str
    """`passed`, `failed`, `skipped` or `result not at hand`."""


@dataclass(slots=True)
class RequirementEntry(Described):
    """A requirement with all that belongs to it."""

    id: str
    """Its id in the list."""
    text: str
    """Its text."""
    elements: list[str]
    """Elements of the model that name it."""
    code: list[str]
    """Generated files of these elements."""
    claims: list[str]
    """Ids of the claims about these elements."""
    tests: list[ProbeEntry]
    """Tests and scenarios that name it."""


@dataclass(slots=True)
class ElementEntry(Described):
    """An element of the model that names requirements."""

    element: str
    """Its name."""
    kind: str
    """Its kind."""
    at: str
    """File, line and column."""
    requirements: list[str]
    """The ids."""
    code: list[str]
    """Its generated files."""
    claims: list[str]
    """Ids of the claims about it."""


@dataclass(slots=True)
class Finding(Described):
    """A finding about the model or its traceability."""

    code: str
    """Its code; docs/errors.md explains it."""
    severity: str
    """`error` or `warning`."""
    at: str
    """File, line and column."""
    message: str
    """The problem."""


@dataclass(slots=True)
class ObjectiveEntry(Described):
    """An objective of a standard."""

    ref: str
    """Where the standard has it."""
    text: str
    """The objective in our words."""
    status: str
    """`met`, `partly`, `not met` or `user's`."""
    claims: str
    """The claims that serve it, by kind."""
    rest: str
    """The work that remains."""


@dataclass(slots=True)
class StandardEntry(Described):
    """A standard."""

    id: str
    """Its id."""
    title: str
    """Its name."""
    note: str
    """A note on the whole table."""
    objectives: list[ObjectiveEntry]
    """In the order of the standard."""


@dataclass(slots=True)
class KnownProblem(Described):
    """A known problem of a tool or of the runtime."""

    of: str
    """The tool, or the runtime."""
    what: str
    """The problem."""
    consequence: str
    """The consequence for a program."""


@dataclass(slots=True)
class Fault(Described):
    """A row of the fault matrix."""

    fault: str
    """The fault."""
    found_by: str
    """The check that finds it."""
    follows: str
    """The reaction."""
    within: str
    """The time limit of the test for the reaction; empty where it measures none."""
    test: str
    """The test."""


@dataclass(slots=True)
class Evidence(Described):
    """The whole file."""

    format: int
    """The version of this format."""
    tool: str
    """The tool that made it, with its version."""
    system: str
    """The name of the system."""
    model: list[Input]
    """The files of the model."""
    model_digest: str
    """SHA-256 over the model's files, as the timing certificate has it."""
    driver: str
    """The CAN driver."""
    not_shown: list[Lack]
    """The facts that are not shown: read these first."""
    claims: list[ClaimEntry]
    """Every claim."""
    requirements: list[RequirementEntry] | None
    """Traceability from requirements; null where no list was given."""
    elements: list[ElementEntry]
    """Traceability back from elements."""
    findings: list[Finding]
    """Warnings about the model, and findings of traceability."""
    standards: list[StandardEntry]
    """Objectives of standards."""
    known_problems: list[KnownProblem]
    """Of compiler, prover and runtime."""
    faults: list[Fault]
    """The fault matrix; empty where the page is missing."""
    memory: list[Memory]
    """Stacks and memory of each build whose record is given."""
    files: list[str]
    """The other files of the folder."""
