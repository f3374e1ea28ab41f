# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The file format of ports, and of what handles input ports. Part of `schema`."""

from typing import Annotated, Literal

from pydantic import Field as PydanticField
from pydantic import Tag

from .schema_base import Element, Name, PositiveSpan, Reference, by_key, key, optional


class InputForm(Element):
    """An input port."""

    in_: Reference = key("The type of what arrives.", alias="in")
    kind: Literal["sampled", "queued"] = PydanticField(
        default="sampled",
        description="`sampled` keeps the last value, `queued` the last `depth` ones.",
    )
    depth: int | None = optional(
        "Values that wait at most, 1 to 1024; `queued` needs it.", ge=1, le=1024
    )
    overflow: Literal["reject_newest", "drop_oldest"] | None = optional(
        "The value that a full queue loses; only for `queued`; `reject_newest` unless given."
    )
    max_age: PositiveSpan | None = optional("A value older than this is stale.")
    on_arrival: Reference | None = optional("Event raised when a value arrives.")
    on_stale: Reference | None = optional("Event raised when the value becomes stale.")
    on_overflow: Reference | None = optional("Event raised when values were lost; only `queued`.")


class OutputForm(Element):
    """An output port."""

    out: Reference = key("The type of what is sent.")


PortForm = Annotated[
    Annotated[InputForm, Tag("<in>")] | Annotated[OutputForm, Tag("<out>")],
    by_key("a port", "in", "out"),
]


class PortGroupForm(Element):
    """Input ports that a row of their own handles, which tables name as they name an activity."""

    period: PositiveSpan = key("Period of the handlers.")
    wcet: PositiveSpan = key("Worst-case execution time of all handlers together.")
    deadline: PositiveSpan | None = optional("Relative deadline; the period unless given.")
    ports: list[Reference] = key("The input ports, each in one group at most.", min_length=1)


class PortRegionForm(Element):
    """When the handlers of the input ports run."""

    period: PositiveSpan = key("Period of the handlers.")
    wcet: PositiveSpan = key("Worst-case execution time of all handlers together.")
    deadline: PositiveSpan | None = optional("Relative deadline; the period unless given.")
    groups: dict[Name, PortGroupForm] | None = optional(
        "Ports with a row of their own; the port region handles all others.", min_length=1
    )
