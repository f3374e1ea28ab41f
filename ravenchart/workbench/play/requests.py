# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The requests of the page of the charts: each has one form, and nothing else is accepted."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictBool, StrictInt, StrictStr, TypeAdapter

from ..requests import Duration, Name, PageRequest, Rewind, validated

Text = Annotated[StrictStr, Field(max_length=200)]
Given = StrictBool | StrictInt | Text | dict[Name, StrictBool | StrictInt | Text]
"""A value as an event file has it."""


class RaiseWish(PageRequest):
    """Raise an event of an instance; without ``value`` where it carries none."""

    kind: Literal["raise"]
    instance: Name
    event: Name
    value: Given | None = None


class PutWish(PageRequest):
    """Give a value to an input port."""

    kind: Literal["put"]
    instance: Name
    port: Name
    value: Given


class AdvanceWish(PageRequest):
    """Let time go on: for one execution of a chart, to its next transition, or to a time-out."""

    kind: Literal["execution", "firing", "time_out"]
    chart: Name


class WaitWish(PageRequest):
    """Let time go on for a duration."""

    kind: Literal["wait"]
    duration: Duration


PLAY_REQUESTS = (RaiseWish, PutWish, AdvanceWish, WaitWish, Rewind)
PlayRequest = RaiseWish | PutWish | AdvanceWish | WaitWish | Rewind
_READER: TypeAdapter[PlayRequest] = TypeAdapter(Annotated[PlayRequest, Field(discriminator="kind")])


def read(body: bytes) -> PlayRequest:
    """The message of a request, or `MalformedError`."""
    return validated(_READER, body)
