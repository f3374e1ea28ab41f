# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The requests of the page: each message has one form, and nothing else is accepted."""

from __future__ import annotations

from typing import Annotated, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

R = TypeVar("R")

Name = Annotated[str, Field(min_length=1, max_length=200)]
Duration = Annotated[str, Field(min_length=1, max_length=40)]


class PageRequest(BaseModel):
    """A message; ``number`` is the state that the page showed when it was asked for."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    number: int = Field(ge=0)


class Move(PageRequest):
    """Put a row into a table, where it then has the number ``place``, counted from 0."""

    kind: Literal["move"]
    row: Name
    to: Name
    place: int = Field(ge=0, le=1024)


class SetTime(PageRequest):
    """Change what a row takes: for all instances of its component. None: the key is removed."""

    kind: Literal["time"]
    row: Name
    key: Literal["period", "wcet", "deadline"]
    value: Duration | None


class SetProcessor(PageRequest):
    """Change a processor. None: the key is removed, and the value follows from the table."""

    kind: Literal["processor"]
    processor: Name
    key: Literal["period", "deadline", "priority"]
    value: Duration | int | None


class Rewind(PageRequest):
    """Go back by one change, or forward again."""

    kind: Literal["undo", "redo"]


class Save(PageRequest):
    """Write the files; with ``late`` also where a deadline or limit is not kept."""

    kind: Literal["save"]
    late: bool


class Settle(PageRequest):
    """After files have changed outside: take them, or keep the changes made here."""

    kind: Literal["take", "keep"]


class SearchTables(PageRequest):
    """Look for better tables of all periodic rows, by a strategy of `allocate`."""

    kind: Literal["search"]
    strategy: Literal["period", "locality", "fewest", "slack"]


class TakeTables(PageRequest):
    """End the search, or make the best tables so far a change of the model."""

    kind: Literal["stop", "adopt"]


class PlayOrPause(PageRequest):
    """Let the time of a replay go on, or rest."""

    kind: Literal["play", "pause"]


class SetSpeed(PageRequest):
    """Let the time of a replay go on so many times as fast as it did."""

    kind: Literal["speed"]
    speed: float = Field(ge=0.01, le=100)


class Seek(PageRequest):
    """Go to an instant of a replay, in ns."""

    kind: Literal["seek"]
    at: int = Field(ge=0)


class StepTo(PageRequest):
    """Go to the next instant of a replay that has such a record, or to the one before."""

    kind: Literal["next", "previous"]
    what: Literal["event", "value", "record"]


ReplayRequest = PlayOrPause | SetSpeed | Seek | StepTo
AnyRequest = (
    Move | SetTime | SetProcessor | Rewind | Save | Settle | SearchTables | TakeTables
    | ReplayRequest
)  # fmt: skip
_READER: TypeAdapter[AnyRequest] = TypeAdapter(Annotated[AnyRequest, Field(discriminator="kind")])


class MalformedError(Exception):
    """A message has none of the forms above; the text says where it differs."""


def read(body: bytes) -> AnyRequest:
    """The message of a request, or `MalformedError`."""
    return validated(_READER, body)


def validated(reader: TypeAdapter[R], body: bytes) -> R:
    """The message that a reader makes of a body, or `MalformedError`."""
    try:
        return reader.validate_json(body)
    except ValidationError as problem:
        first = problem.errors(include_url=False, include_context=False, include_input=False)[0]
        where = ".".join(str(step) for step in first["loc"])
        what = first["msg"][:1].lower() + first["msg"][1:]
        raise MalformedError(f"malformed message: {where + ': ' if where else ''}{what}") from None
