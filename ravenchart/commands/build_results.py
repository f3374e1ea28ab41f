# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The answers of `check`, `generate` and `build` with `--json`.

They are apart from `results`, for they are imported more often than all others together.
"""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.described import Described, Result
from ravenchart.stacks.report import Memory


@dataclass(slots=True)
class CheckResult(Result):
    """A model without errors."""

    system: str
    """The name of the system."""
    digest: str
    """SHA-256 of the model's files."""
    instances: int
    """How many instances of components it has."""
    processors: int
    """How many command processors."""
    messages: int
    """How many messages of buses."""
    contracts: dict[str, list[str]]
    """The invariants that are contracts of the code, each with the facts that its proof uses."""


@dataclass(slots=True)
class GenerateResult(Result):
    """A program, written beside its model."""

    folder: str
    """Where it was written."""
    files: int
    """How many files it has."""
    changed: int
    """How many of these differ from those before."""
    edited: list[str]
    """Files that had been edited by hand: their copies end in `.edited`."""
    first: list[str]
    """Files of the user that were not there, and got a first version."""
    untouched: list[str]
    """Files of the user that are as first written, and do nothing."""


@dataclass(slots=True)
class Built(Described):
    """The program of one node."""

    node: str
    """The name of the node."""
    program: str
    """The executable."""
    memory: Memory
    """Its stacks and its memory."""


@dataclass(slots=True)
class BuildResult(Result):
    """Programs, generated and compiled."""

    generated: GenerateResult
    """The generation."""
    programs: list[Built]
    """One for each node that runs something."""
