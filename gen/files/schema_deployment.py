# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Nodes, what runs on them, and how it is connected, in the file format."""

from typing import Annotated, Any, Literal

from pydantic import Field as PydanticField
from pydantic import Tag

from ravenchart.gen.model.nodes import TRACE_LIMIT

from .schema_base import (
    Constant,
    DatabaseName,
    Element,
    Name,
    PathReference,
    PositiveSpan,
    Reference,
    Span,
    StackSize,
    StarredPath,
    StarredReference,
    key,
    optional,
    shaped,
)

PRIORITIES = range(1, 31)
"""Those that a model may give."""


class ProbeForm(Element):
    """The host probe of a node: it wakes once per period and notes how late it is."""

    period: PositiveSpan = key("Time from one wake-up to the next.")
    wcet: PositiveSpan = key("Worst-case execution time of one wake-up; at most the period.")


class SupervisionForm(Element):
    """The liveness supervision of a node: one task that looks at every processor."""

    period: PositiveSpan = key("Time from one look at the processors to the next.")
    wcet: PositiveSpan = key(
        "Worst-case execution time of one look, the events of `on_silence` included; at most the "
        "period."
    )
    margin: PositiveSpan = key(
        "Time beyond its deadline within which a release must have completed, or its processor is "
        "silent; on a workstation longer than the host withholds the core."
    )


class InterruptForm(Element):
    """An interrupt of a node, which releases one sporadic processor."""

    signal: Literal["SIGUSR1", "SIGUSR2"] | None = optional(
        "The signal that stands for it where the program runs under Linux."
    )
    number: int | None = optional(
        "Its number at the interrupt controller of a board.", ge=1, le=1019
    )
    wcet: PositiveSpan = key(
        "Worst-case execution time of taking it: the entry into its handler, the handler, and the "
        "task above all others that wakes the processor."
    )


class StreamForm(Element):
    """The main program of a node while a monitor watches: the task of the lowest priority.

    Every 5 ms it empties the trace, and every 100 ms it writes a snapshot.
    """

    wcet: PositiveSpan = key(
        "Worst-case execution time of one snapshot and of 20 drains of the trace; at most 100 ms."
    )


class TickForm(Element):
    """A timer that interrupts periodically: timed releases wait for it."""

    period: PositiveSpan = key("Time from one interrupt to the next.")
    wcet: Span = key("Longest time of one interrupt; at most the period.")


class NodeForm(Element):
    """A processor core, or several alike, and its platform figures, all of them worst cases."""

    context_switch: Span = key("Time of one context switch.")
    critical_section: Span = key("Longest time inside any protected operation.")
    trace: int = PydanticField(
        default=0,
        ge=0,
        le=TRACE_LIMIT,
        description="Records the trace holds, 0 to 65536; 0: none.",
    )
    probe: ProbeForm | None = optional(
        "A task above all others that measures how long a host withholds the processor."
    )
    supervision: SupervisionForm | None = optional(
        "A task above all processors and drivers that finds processors which no longer complete "
        "their releases; none unless given."
    )
    interrupts: dict[Name, InterruptForm] | None = optional(
        "Interrupts that release processors of the node (`released_by: node.interrupt`).",
        min_length=1,
    )
    stream: StreamForm | None = optional(
        "The main program at the lowest priority, which hands the trace and ten snapshots a second "
        "to a monitor; analysed where given, and the same program is generated with it and without."
    )
    release: Span = PydanticField(
        default=0,
        description="Longest work of one release outside its rows: making the job ready, above all "
        "tasks, and its bookkeeping (record, check of the deadline). Counted above all tasks.",
    )
    tick: TickForm | None = optional(
        "The timer's periodic interrupt, where it has one; exact time-outs unless given."
    )
    cores: int = PydanticField(
        default=1,
        ge=1,
        le=64,
        description="How many cores; each processor is on one of them, and only values of ports go "
        "from core to core.",
    )
    database_name: DatabaseName | None = optional(
        "Its name in the databases of its buses (DBC): an identifier of C, of up to 128 "
        "characters, that no other node has; the node's name unless given."
    )


LARGEST_ARRAY = 64
"""Elements of an array of instances at most."""

Passed = Annotated[
    Annotated[Constant, Tag("<one>")] | Annotated[list[Constant], Tag("<list>")],
    shaped("a value, or a list with a value for each element of an array"),
]
"""The value of a parameter; that of each element of an array."""


def _count() -> Any:
    return optional(
        "Makes it an array of so many instances, 2 to 64: `name_1`, `name_2` and so on. `name_*` "
        "in a reference stands for all of them, in order. One instance unless given.",
        ge=2,
        le=LARGEST_ARRAY,
    )


def plain_parameters(form: "InstanceForm | InnerInstanceForm") -> dict[str, int | bool | str]:
    """The parameters that an instance gives, which is no array."""
    given = form.parameters or {}
    return {name: value for name, value in given.items() if not isinstance(value, list)}


class InstanceForm(Element):
    """An instance of a component on a node, or an array of them."""

    component: Reference = key("The component.")
    node: Reference = key("The node it runs on.")
    count: int | None = _count()
    parameters: dict[str, Passed] | None = optional(
        "Values of the component's parameters; of an array one for all elements, or a list of one "
        "for each."
    )


class InnerInstanceForm(Element):
    """An instance of a component inside another component, on the node of that one."""

    component: Reference = key("The component, itself with `instances` or not.")
    count: int | None = _count()
    parameters: dict[str, Passed] | None = optional(
        "Values of the component's parameters; a parameter of the component around it is passed by "
        "its name. Of an array one for all elements, or a list of one for each."
    )


class ConnectionForm(Element):
    """An output port wired to an input port; between nodes it is a message of a bus."""

    from_: StarredReference = key("`instance.port`, an output port.", alias="from")
    to: StarredReference = key("`instance.port`, an input port.")
    bus: Reference | None = optional(
        "The bus that carries it between nodes, where the model has several; without effect inside "
        "a node."
    )


class InnerConnectionForm(Element):
    """A connection inside a component; one with a port of the component itself delegates it."""

    from_: StarredPath = key(
        "`instance.port`, an output port, or `port`, an input port of the component itself.",
        alias="from",
    )
    to: StarredPath = key(
        "`instance.port`, an input port, or `port`, an output port of the component itself."
    )


class ProcessorForm(Element):
    """A processor: one task with a fixed table of activities."""

    node: Reference | None = optional(
        "The node it runs on; unless given, that of what it runs. A reception without it is on "
        "every node that receives from its bus."
    )
    released_by: PathReference | None = optional(
        "The bus, the queued input port `instance.port`, the provided interface "
        "`instance.Interface`, the region `instance.Region`, or the interrupt `node.interrupt` "
        "that releases it: then it is sporadic. It handles the reception of the bus, the values "
        "of the port, the calls of the interface, the events of the region, or each interrupt."
    )
    core: int = PydanticField(
        default=1, ge=1, description="The core of the node that runs it, counted from 1."
    )
    period: PositiveSpan | None = optional(
        "Shortest period in the table unless given; the least separation of a sporadic processor, "
        "which needs it."
    )
    offset: Span = PydanticField(default=0, description="Time of the first release after start.")
    deadline: PositiveSpan | None = optional("Relative deadline; the shortest of its table if none")
    logical_execution_time: PositiveSpan | None = optional(
        "Values that it sends to sampled ports on other processors of the node become visible so "
        "long after each release, and not before; from the deadline to the period."
    )
    priority: int | None = optional(
        "1 to 30, larger is more urgent; deadline-monotonic unless given.",
        ge=PRIORITIES[0],
        le=PRIORITIES[-1],
    )
    stack: StackSize = key("Stack of the task, 1 KiB to 64 MiB.")
    activities: list[StarredReference] = key(
        "The table, in order: `instance.activity`, `instance.Region`, `instance.ports`, "
        "`bus.receive`, `bus.watch`.",
        min_length=1,
        max_length=1024,
    )
    schedule: Literal["table"] | None = optional(
        "`table`: a cyclic executive. Its period is the minor cycle, which divides the periods of "
        "all rows, and phases that are not given are chosen so that no release has much more work "
        "than another one."
    )
    phases: dict[StarredReference, Span] | None = optional(
        "Of rows with a longer period than the processor's: the time of the first execution, after "
        "the first release of the processor. A multiple of its period, below that of the row."
    )
    on_deadline_miss: list[StarredReference] | None = optional(
        "`instance.Event`s raised when a release completes after the deadline."
    )
    on_overrun: list[StarredReference] | None = optional(
        "`instance.Event`s raised when an activity used more processor time than its `wcet`; each "
        "one is then compared with it as it ends.",
        min_length=1,
    )
    on_silence: list[StarredReference] | None = optional(
        "`instance.Event`s that the supervision of the node raises, once, when a release has not "
        "completed by its deadline and the margin.",
        min_length=1,
    )


class ShutdownForm(Element):
    """The reaction to a request to stop."""

    raises: list[StarredReference] = key("`instance.Event`s raised.")
    grace: Span = key("Time between these events and the end.")


class ChainForm(Element):
    """A way from inputs to outputs, and how long values may be under way."""

    path: list[StarredPath] = key(
        "Messages and rows (`instance.activity`, `instance.Region`) on the way; "
        "between two of them the shortest way is meant.",
        min_length=2,
    )
    reaction: PositiveSpan | None = optional(
        "Longest time from an input to the first output that knows it."
    )
    age: PositiveSpan | None = optional(
        "Longest time from the sampling of an input to an output made of it."
    )
    logical_execution_time: Literal[True] | None = optional(
        "`true`: what goes from one processor of a node to another on the way becomes visible at "
        "the end of the period of its sender, and not before."
    )
