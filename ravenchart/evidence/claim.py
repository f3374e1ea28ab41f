# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One claim: what it says, what shows it, and the verdict."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from ravenchart.paths import version

Pairs = tuple[tuple[str, str], ...]


class Shown(Enum):
    """How far a claim is shown."""

    MET = "met"
    PARTLY = "partly"
    NOT_MET = "not met"
    NOT_SHOWN = "not shown"
    USERS = "user's"


class ClaimKind(Enum):
    """The subject of a claim; the goals of the argument, in its order."""

    TRANSLATION = "The program is what the model gives"
    PROGRAM = "The program is free of run-time errors and data races"
    CHARTS = "The code of each chart does what its declared form says"
    BUS = "Frames carry what the layout tables say"
    BEHAVIOUR = "The charts keep the rules of behaviour and the invariants"
    TIMING = "Every deadline and limit is kept"
    RUNTIME = "The runtime and the CAN layer keep their contracts"
    MEMORY = "Memory is sufficient"
    TESTS = "The tests pass"
    COVERAGE = "The tests execute the code"


@dataclass(frozen=True, slots=True)
class Claim:
    """One claim."""

    id: str
    kind: ClaimKind
    elements: tuple[str, ...]
    """The elements of the model that it is about."""
    statement: str
    theorem: str
    """The exact fact that is shown, and how."""
    method: str
    tool: str
    verdict: Shown
    reasons: tuple[str, ...]
    """Why it is not met, or only partly."""
    inputs: Pairs
    """(name, SHA-256) of what the verdict was made of."""

    @property
    def digest(self) -> str:
        """SHA-256 over the inputs."""
        text = "".join(f"{digest}  {name}\n" for name, digest in self.inputs)
        return hashlib.sha256(text.encode("utf-8")).hexdigest()


OURS = "ravenchart"


def own_tool() -> str:
    """This program and its version."""
    return f"{OURS} {version()}"


def verdict_of(problems: Sequence[str], *, shown: bool = True) -> Shown:
    if not shown:
        return Shown.NOT_SHOWN
    return Shown.NOT_MET if problems else Shown.MET


NO_RECORD = "no proof record is given: write one with `ravenchart prove MODEL --record FILE`"
