# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The file format of models: every key, what it means, its units and its range.

The one source for the validation of files, for docs/model.schema.json and for
docs/model-reference.md. Checks that need more than one element are in `resolve` and `rules`.
"""

from typing import Annotated, Literal

from pydantic import Field as PydanticField
from pydantic import Tag

from .schema_base import (
    Constant,
    Element,
    ExpressionText,
    Name,
    OwnedReference,
    PositiveSpan,
    Reference,
    StarredReference,
    Version,
    by_key,
    key,
    optional,
    shaped,
)
from .schema_deployment import (
    ChainForm,
    ConnectionForm,
    InnerConnectionForm,
    InnerInstanceForm,
    InstanceForm,
    NodeForm,
    ProcessorForm,
    ShutdownForm,
)
from .schema_devices import (
    BindingForm,
    CommandForm,
    DeviceForm,
    DeviceTypeForm,
    InnerBindingForm,
    ProvidedForm,
    RequiredForm,
)
from .schema_frames import BusForm, MessageForm
from .schema_ports import PortForm, PortRegionForm

# --- Types -----------------------------------------------------------------------


class RangeType(Element):
    """An integer range."""

    range: list[int] = key(
        "First and last value, both included, within -2^62 .. 2^62 - 1.", min_length=2, max_length=2
    )
    unit: str | None = optional(
        "The unit of the values, for example `um/s`. It has an Ada type of its own, here "
        "`Unit_Um_Per_S`; where only case or signs differ, the later unit is numbered.",
        max_length=20,
    )


class ValuesType(Element):
    """An enumeration."""

    values: list[Name] = key("The literals, in order; 1 to 256.", min_length=1, max_length=256)


class FieldsType(Element):
    """A record of scalars."""

    fields: dict[Name, Reference] = key(
        "Field names with their scalar types, in order; 1 to 64.", min_length=1, max_length=64
    )


TypeForm = Annotated[
    Annotated[RangeType, Tag("<range>")]
    | Annotated[ValuesType, Tag("<values>")]
    | Annotated[FieldsType, Tag("<fields>")],
    by_key("a type", "range", "values", "fields"),
]


# --- Flows -----------------------------------------------------------------------


class SetForm(Element):
    """Give a data item, or one field of it, a value."""

    set: str = key("The data item `item`, or a field of it: `item.field`.")
    to: ExpressionText = key(
        "Expression that provably fits the target's range; for a whole record a name of its type."
    )


Carried = Annotated[
    Annotated[ExpressionText, Tag("<one>")] | Annotated[dict[str, ExpressionText], Tag("<map>")],
    shaped("an expression, or a mapping from fields to expressions"),
]
"""A value that is sent, or that an event carries."""


class SendForm(Element):
    """Send one value on an output port."""

    send: Reference = key("The output port.")
    with_: Carried = key(
        "Expression for a scalar port; for a record one expression for each field.", alias="with"
    )


class CallForm(Element):
    """Call a required command."""

    call: Reference = key("The command: `void`, `write` or `qualified_read`.")
    with_: Carried | None = optional(
        "Its argument: an expression, or for a record one for each field.", alias="with"
    )


class RaiseForm(Element):
    """Raise an event of the component; in a do activity also `done`."""

    raise_: Reference = key(
        "The event; `done` in a do activity completes its state.", alias="raise"
    )
    with_: Carried | None = optional(
        "The value that an event with a type carries: an expression, or for a record one for each "
        "field.",
        alias="with",
    )


class IfForm(Element):
    """Do one flow or another."""

    if_: ExpressionText = key("Boolean expression.", alias="if")
    then: "list[ActionForm]" = key("Actions when it is true.")
    else_: "list[ActionForm] | None" = optional("Actions when it is false.", alias="else")


ActionForm = Annotated[
    Annotated[SetForm, Tag("<set>")]
    | Annotated[SendForm, Tag("<send>")]
    | Annotated[CallForm, Tag("<call>")]
    | Annotated[RaiseForm, Tag("<raise>")]
    | Annotated[IfForm, Tag("<if>")],
    by_key("an action", "set", "send", "call", "raise", "if"),
]


# --- Components ------------------------------------------------------------------


class ParameterForm(Element):
    """A constant that each instance may set."""

    type: Reference = key("A scalar type.")
    default: Constant | None = optional("Value for instances that set none; without it all must.")


class DataForm(Element):
    """A data item: one writer, any number of readers."""

    type: Reference = key("Any type.")
    initial: Annotated[
        Annotated[Constant, Tag("<one>")] | Annotated[dict[str, Constant], Tag("<map>")],
        shaped("a value, or a mapping from fields to values"),
    ] = key("Initial value; for a record a value for each field.")


class InitialForm(Element):
    """Default entry of a region, with actions."""

    to: Reference = key("The state entered by default, at any depth in the region.")
    effect: list[ActionForm] | None = optional(
        "Actions after the entry of the state around and before that of the target."
    )


InitialState = Annotated[
    Annotated[Reference, Tag("<one>")] | Annotated[InitialForm, Tag("<map>")],
    shaped("a state, or a mapping with the keys `to` and `effect`"),
]
"""Where a region begins."""


class StateForm(Element):
    """A state or, with `kind`, another vertex of the chart.

    With `states` it is composite, with several `regions` orthogonal.
    """

    kind: (
        Literal[
            "final",
            "choice",
            "junction",
            "history",
            "deep_history",
            "fork",
            "join",
            "terminate",
        ]
        | None
    ) = optional("A final state or a pseudostate, which has no other key; a state unless given.")
    entry: list[ActionForm] | None = optional("Actions on entry.")
    exit: list[ActionForm] | None = optional("Actions on exit.")
    defer: list[Reference] | None = optional(
        "Events kept for later while it is active and nothing inside takes them."
    )
    initial: InitialState | None = optional(
        "State inside it entered by default; needed with `states`."
    )
    states: "dict[Name, StateForm] | None" = optional("Substates.", min_length=1)
    regions: "dict[Name, NestedRegionForm] | None" = optional(
        "Regions side by side, instead of `states`.", min_length=1
    )


class NestedRegionForm(Element):
    """A region of a state, active while the state is."""

    initial: InitialState = key("State inside it entered by default.")
    states: dict[Name, StateForm] = key("Its states.", min_length=1)


class TransitionForm(Element):
    """A transition, with at most one of `on`, `after`, `every` and `when`.

    Without a trigger it is taken when its source completes; from a pseudostate it is the next
    segment of what led there.
    """

    from_: Reference = key("Source: a state or pseudostate.", alias="from")
    to: Reference | None = optional(
        "Target: a state or pseudostate; without it the transition is internal."
    )
    on: Reference | None = optional("Trigger: this event from the region's queue.")
    after: PositiveSpan | None = optional(
        "Trigger: this long after the source was entered, in whole executions, rounded up."
    )
    every: PositiveSpan | None = optional(
        "Trigger: like `after`, again and again while the source is active."
    )
    when: ExpressionText | None = optional("Trigger: a condition, read when nothing else waits.")
    guard: ExpressionText | None = optional(
        "Condition without which the transition is disabled; `else` from a choice or junction."
    )
    effect: list[ActionForm] | None = optional("Actions between exits and entries.")
    local: bool | None = optional(
        "`true`: from a composite state to one inside it, without leaving the composite."
    )
    internal: bool | None = optional("`true`: no state is left; `to` may then be left out.")


class RegionForm(Element):
    """A top-level region: one state machine."""

    period: PositiveSpan = key("Period of the region's executions.")
    wcet: PositiveSpan = key("Worst-case execution time of one execution.")
    deadline: PositiveSpan | None = optional("Relative deadline; the period unless given.")
    queue: int | None = optional(
        "Events that wait at most, 1 to 1024; needed when a transition has `on`.", ge=1, le=1024
    )
    deferred: int | None = optional(
        "Deferred events that wait at most, 1 to 1024; needed when a state has `defer`.",
        ge=1,
        le=1024,
    )
    overflow: Literal["reject_newest", "drop_oldest"] | None = optional(
        "The event that a full queue loses; `reject_newest` unless given."
    )
    on_overflow: Reference | None = optional("Event raised when the queue lost one.")
    steps: int = PydanticField(
        default=1, ge=1, le=16, description="Steps in one execution at most, 1 to 16."
    )
    initial: InitialState = key("State entered first; any state of the region.")
    safe_state: Reference | None = optional("State that must be reachable from every other.")
    states: dict[Name, StateForm] = key("The top states and pseudostates.", min_length=1)
    transitions: dict[Name, TransitionForm] = PydanticField(
        default={}, description="Transitions by name; the earlier goes before the later."
    )


Conditions = Annotated[
    Annotated[ExpressionText, Tag("<one>")] | Annotated[list[ExpressionText], Tag("<list>")],
    shaped("a condition or a list of conditions"),
]
"""One side of a contract."""


class ActivityForm(Element):
    """A named, bounded piece of work."""

    period: PositiveSpan = key("Period of its executions.")
    wcet: PositiveSpan = key("Worst-case execution time of one execution.")
    deadline: PositiveSpan | None = optional("Relative deadline; the period unless given.")
    while_: OwnedReference | None = optional(
        "`Region.State`: it works only while that state is active.", alias="while"
    )
    reads: list[Reference] | None = optional(
        "Data, parameters, input ports, regions and read commands it reads."
    )
    writes: list[Reference] | None = optional("Data items it writes.")
    sends: list[Reference] | None = optional(
        "Output ports it sends on; a body of the user on each of them in every execution."
    )
    may_send: list[Reference] | None = optional(
        "Of a body of the user: output ports it sends on where it sets `Send_<Port>` to true."
    )
    calls: list[Reference] | None = optional("Required commands it calls.")
    raises: list[Reference] | None = optional(
        "Events it raises; with `while` also `done`, which completes the state."
    )
    requires: Conditions | None = optional(
        "Contract: conditions on what it reads, which hold whenever an execution begins."
    )
    ensures: Conditions | None = optional(
        "Contract: conditions on what it reads, writes and sends, which hold when an execution "
        "ends; `old(item)` is a data item before it, `sent(port)` whether it sends."
    )
    body: Annotated[
        Annotated[Literal["user", "forward"], Tag("<one>")]
        | Annotated[list[ActionForm], Tag("<list>")],
        shaped("`user`, `forward` or a list of actions"),
    ] = key(
        "`user` for a procedure written by hand, or a list of actions; the lists above may then "
        "be left out. `forward`: each request of the interface that it serves is a call of the "
        "required command of the same name."
    )


class EventForm(Element):
    """An event with a value, a rule of its own for full queues, or a source outside."""

    type: Reference | None = optional("The type of the value it carries; none unless given.")
    overflow: Literal["reject_newest", "drop_oldest"] | None = optional(
        "The event that a full queue loses when this one arrives; that of the region unless given."
    )
    external: bool | None = optional(
        "`true`: the event may also come from outside at any time, though the component raises it."
    )


class InvariantForm(Element):
    """An invariant of `never` with more than its condition."""

    condition: ExpressionText = key("The condition that shall never hold.")


NeverForm = Annotated[
    Annotated[ExpressionText, Tag("<one>")] | Annotated[InvariantForm, Tag("<map>")],
    shaped("a condition, or a mapping with the keys `condition` and `req`"),
]
"""An invariant: a condition that shall never hold."""


class ComponentForm(Element):
    """A component: what its instances have in common."""

    parameters: dict[Name, ParameterForm] | None = optional("Constants that instances set.")
    ports: dict[Name, PortForm] | None = optional("Input and output ports.")
    port_region: PortRegionForm | None = optional(
        "When input ports are handled; required with an input port, refused without."
    )
    events: (
        Annotated[
            Annotated[list[Name], Tag("<list>")] | Annotated[dict[Name, EventForm], Tag("<map>")],
            shaped("a list of names, or a mapping from names to events"),
        ]
        | None
    ) = optional("Events, each offered to every region that names it.")
    requires: dict[Name, RequiredForm] | None = optional("Interfaces it calls the commands of.")
    provides: dict[Name, ProvidedForm] | None = optional("Interfaces whose commands it executes.")
    data: dict[Name, DataForm] | None = optional("Data items.")
    regions: dict[Name, RegionForm] | None = optional("State machines, run side by side.")
    activities: dict[Name, ActivityForm] | None = optional("Activities.")
    never: dict[Name, NeverForm] | None = optional(
        "Invariants: conditions over states of any region and data that shall never hold."
    )
    instances: dict[Name, InnerInstanceForm] | None = optional(
        "Instances of other components inside it. Then it is composite: beside them it has "
        "parameters, ports, interfaces, `connections` and `bindings` only.",
        min_length=1,
    )
    connections: list[InnerConnectionForm] | None = optional(
        "Connections of the instances inside it, and of its own ports with theirs."
    )
    bindings: list[InnerBindingForm] | None = optional(
        "Providers of the required interfaces inside it."
    )


class ModelFile(Element):
    """A model file. Every section may stand in any file, `system` in one only."""

    system: Name | None = optional("Name of the system; in the main file, and only there.")
    library: Name | None = optional(
        "Name of a library, in its main file: in place of `system`. Its types, commands and "
        "components are the same in each system that includes the file."
    )
    version: Version | None = optional("Version of the library, for example `1.2.0`.")
    include: list[str] | None = optional(
        "Files whose sections belong to the model, relative to this file, and main files of "
        "libraries that it uses."
    )
    deployments: dict[Name, str] | None = optional(
        "In the main file: alternatives by their names, each with a file that is included where it "
        "is chosen: `MODEL.yaml@NAME` on the command line. The path is relative to this file."
    )
    types: dict[Name, TypeForm] | None = optional("Types of data, ports and parameters.")
    commands: dict[Name, CommandForm] | None = optional("The command dictionary.")
    device_types: dict[Name, DeviceTypeForm] | None = optional("Types of devices.")
    devices: dict[Name, DeviceForm] | None = optional("Devices, and composites of them.")
    bindings: list[BindingForm] | None = optional("Providers of the required interfaces.")
    components: dict[Name, ComponentForm] | None = optional("Components.")
    nodes: dict[Name, NodeForm] | None = optional("Nodes: one or several, and a program for each.")
    buses: dict[Name, BusForm] | None = optional("The CAN buses, at most eight.")
    instances: dict[Name, InstanceForm] | None = optional("Instances of components.")
    connections: list[ConnectionForm] | None = optional(
        "Connections of ports, on one node or between two."
    )
    messages: dict[Name, MessageForm] | None = optional("Messages on buses.")
    processors: dict[Name, ProcessorForm] | None = optional("Processors: the tasks.")
    chains: dict[Name, ChainForm] | None = optional("Limits of latencies from end to end.")
    shutdown: ShutdownForm | None = optional("Reaction to a request to stop; none unless given.")
    record: list[StarredReference] | None = optional(
        "Ports, data items and regions whose values enter the trace: `instance.port`, "
        "`instance.data_item` or `instance.Region`; `instance.item.field` is one field of a "
        "record. Their node needs `trace`."
    )
