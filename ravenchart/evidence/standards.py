# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Objectives of standards, and how far the claims serve each."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from importlib import resources
from typing import Any

from .claim import Claim, ClaimKind, Shown
from .documents import KnownProblem, ObjectiveEntry, StandardEntry
from .tracing import Traceability

REQUIREMENTS = "REQUIREMENTS"
"""Stands for the traceability of requirements among the kinds of claims."""
PARTLY, USERS, NOT_MET, MET = "partly", "user's", "not met", "met"


def _data(name: str) -> dict[str, Any]:
    file = resources.files(__package__) / name
    return tomllib.loads(file.read_text(encoding="utf-8"))


def standards(claims: Sequence[Claim], trace: Traceability | None) -> list[StandardEntry]:
    """Every standard with its objectives."""
    return [
        StandardEntry(
            one["id"],
            one["title"],
            one["note"],
            [_objective(row, claims, trace) for row in one["rows"]],
        )
        for one in _data("objectives.toml")["standard"]
    ]


def _objective(
    row: dict[str, Any], claims: Sequence[Claim], trace: Traceability | None
) -> ObjectiveEntry:
    states = [state_of(name, claims, trace) for name in row["claims"]]
    told = ", ".join(
        f"{_shown(name)} ({state})" for name, state in zip(row["claims"], states, strict=True)
    )
    return ObjectiveEntry(row["ref"], row["text"], status(row["best"], states), told, row["rest"])


def status(best: str, states: Sequence[str]) -> str:
    """The worst of what serves an objective, and at most ``best``."""
    if best == USERS:
        return USERS
    if NOT_MET in states:
        return NOT_MET
    return PARTLY if best == PARTLY or {PARTLY, USERS} & {*states} else MET


def state_of(name: str, claims: Sequence[Claim], trace: Traceability | None) -> str:
    """How far the claims of a kind are shown, all together."""
    if name == REQUIREMENTS:
        if trace is None:
            return NOT_MET
        return NOT_MET if trace.findings else MET
    found = [claim.verdict for claim in claims if claim.kind is ClaimKind[name]]
    if not found or any(one in (Shown.NOT_MET, Shown.NOT_SHOWN) for one in found):
        return NOT_MET
    if all(one is Shown.USERS for one in found):
        return USERS
    return PARTLY if any(one is not Shown.MET for one in found) else MET


def _shown(name: str) -> str:
    return "traceability of requirements" if name == REQUIREMENTS else ClaimKind[name].value


def problems() -> list[KnownProblem]:
    """Known problems of compiler, prover and runtime."""
    return [KnownProblem(**one) for one in _data("known_problems.toml")["problem"]]
