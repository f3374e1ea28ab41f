# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The liveness supervision of a node, and its safe state before the program ends."""

from __future__ import annotations

from ravenchart.gen.derive.instants import has_offset
from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Decl,
    EnumType,
    GenericInstance,
    Object,
    Package,
    Param,
    Subprogram,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    Aggregate,
    Arg,
    StringLiteral,
    arguments,
    call,
    number,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import (
    ada_case,
    component_name,
    priority,
    processor_package,
    root_package,
)
from ravenchart.gen.emit.ada.statements import Assign, Case, Comment, Stmt, do
from ravenchart.gen.emit.certificate.certified import agrees, fact
from ravenchart.gen.emit.commands.lifecycle import UNIT, ends_devices
from ravenchart.gen.emit.language.own_names import event_literal
from ravenchart.gen.emit.tables.trace_calls import fault, fault_units
from ravenchart.gen.model.nodes import SUPERVISOR, Node, Supervision
from ravenchart.gen.model.system import Processor, System

STACK = 32_768
"""Bytes of stack for the supervisor."""

END_MARGIN = 1_000_000_000
"""Time in ns beyond the grace of the shutdown in which the main program ends a node."""


def supervised(system: System) -> tuple[tuple[Node, Supervision], ...]:
    """The nodes with a supervision, and that."""
    return tuple((n, n.supervision) for n in system.nodes if n.supervision is not None)


def safe_state(system: System) -> tuple[Stmt, ...]:
    """The statements that make a node safe at its program's end: after the grace, before reports.

    The main program executes them on every way to its end: a request to stop, a task that has
    ended, a silent processor. Where it does not come that far, the supervisor does the same.
    """
    if not ends_devices(system):
        return ()
    return (do(ref(root_package(system), UNIT, "Make_All_Safe")),)


def emit_supervision(system: System, header: str) -> list[Unit]:
    """The supervisor of each node that has one: spec and body."""
    return [unit for node, _ in supervised(system) for unit in _supervisor(system, node, header)]


def _literal(processor: Processor) -> str:
    """A processor among those watched."""
    return f"{ada_case(processor.name)}_Watch"


def _supervisor(system: System, node: Node, header: str) -> list[Unit]:
    root = root_package(system)
    name = ref(root, "Liveness_Supervision")
    element = f"{node.name}.{SUPERVISOR}"
    watched = sorted(
        (p for p in system.processors if p.node == node.name), key=lambda p: -p.priority
    )
    look = (
        Param("Item", "in", "Watched"),
        Param("Elapsed", "in", "Ravenchart.Nanoseconds"),
        Param("Is_Silent", "out", "Boolean"),
    )
    args = arguments(
        Processor_Id=ref("Watched"),
        Name=StringLiteral(element),
        Period=fact(element, "T"),
        Patience=number(system.shutdown.grace + END_MARGIN),
        Task_Priority=fact(element, "Priority"),
        Ceiling=priority(system.object(f"{element}.board").ceiling),
        Stack_Bytes=number(STACK),
        Look=ref("Look"),
        On_Silence=ref("On_Silence"),
        Feed_Watchdog=ref("Ravenchart.Failures.Feed_Watchdog"),
        Give_Up=ref("Give_Up" if ends_devices(system) else "Ravenchart.Failures.Give_Up"),
    )
    spec: tuple[Decl, ...] = (
        Comment(f"[{node.name}] the processors, the most urgent first"),
        EnumType("Watched", tuple(_literal(p) for p in watched)),
        Subprogram("Look", look),
        Comment("Set Is_Silent when a release has not completed by its deadline plus the margin."),
        Subprogram("On_Silence", (Param("Item", "in", "Watched"),)),
        Comment("Count the silence, raise the events of the processor, and shut down."),
        *_given_up(system),
        Comment(f"[{element}]"),
        GenericInstance("Supervisor", "Ravenchart.Supervisors", args),
        UseType("Ravenchart.Nanoseconds"),
        agrees("Supervisor.Given_Period", fact(element, "T"), element, "period"),
        agrees("Supervisor.Given_Priority", fact(element, "Priority"), element, "priority"),
    )
    seen = Object("Seen", "Ravenchart.Liveness.Progress")
    looks = tuple((_literal(p), _look(system, p)) for p in watched)
    events = tuple((_literal(p), _silence(system, p)) for p in watched)
    body: tuple[Decl, ...] = (
        Subprogram("Look", look, declarations=(seen,), body=(Case(ref("Item"), looks),)),
        Subprogram(
            "On_Silence",
            (Param("Item", "in", "Watched"),),
            body=(Case(ref("Item"), events),),
        ),
    )
    if ends_devices(system):
        ends = (*safe_state(system), do("Ravenchart.Failures.Give_Up"))
        body += (Subprogram("Give_Up", body=ends),)
    devices = {ref(root, UNIT)} if ends_devices(system) else set()
    raised = [i for p in watched for i, _ in p.on_silence]
    context = fault_units(root) | {ref("Ravenchart.Liveness")}
    context |= {ref(root, "Timing_Certificate"), *devices}
    context |= {processor_package(system, p) for p in watched}
    context |= {ref(root, ada_case(i)) for i in raised}
    context |= {ref(root, component_name(system.instance(i).component)) for i in raised}
    withs = {
        ref("Ravenchart.Failures"),
        ref("Ravenchart.Supervisors"),
        ref("System"),
        ref(root, "Timing_Certificate"),
    }
    return [
        Unit(header, tuple(sorted(withs)), Package(name, spec, (SPARK,))),
        Unit(
            header,
            tuple(sorted(context - withs)),
            Package(name, body, (SPARK,), is_body=True),
        ),
    ]


def _given_up(system: System) -> tuple[Decl, ...]:
    """The spec of what ends the program in place of the main program, where devices need it."""
    text = "Make the devices safe and end the controller: the main program has not ended it."
    return (Subprogram("Give_Up"), Comment(text)) if ends_devices(system) else ()


def _look(system: System, processor: Processor) -> tuple[Stmt, ...]:
    """Ask one processor how far it has come, and judge."""
    name = ada_case(processor.name)
    limit = fact(processor.name, "L")
    seen, elapsed = ref("Seen"), ref("Elapsed")
    if processor.released_by is not None:
        judged = call("Ravenchart.Liveness.Is_Stuck", limit, seen, elapsed)
    else:
        shifted = any(has_offset(system, t) for t in system.tasks if t.element == processor.name)
        offset = fact(processor.name, "O") if shifted else number(0)
        rhythm = Aggregate(
            (
                Arg("Offset", offset),
                Arg("Period", fact(processor.name, "T")),
                Arg("Limit", limit),
            )
        )
        judged = call("Ravenchart.Liveness.Is_Silent", rhythm, seen, elapsed)
    return (
        do(ref(name, "Processor.Observe_Progress"), seen),
        Assign("Is_Silent", judged),
    )


def _silence(system: System, processor: Processor) -> tuple[Stmt, ...]:
    """Report the silence of a processor, raise its events, and let the program stop."""
    return (
        fault("Silence", processor.name, "processor"),
        *(offer_from_outside(system, instance, event) for instance, event in processor.on_silence),
        do("Ravenchart.Failures.Note_Silence", StringLiteral(processor.name)),
    )


def offer_from_outside(system: System, instance: str, event: str) -> Stmt:
    """Raise an event of an instance from outside it."""
    component = component_name(system.instance(instance).component)
    return do(ref(ada_case(instance), "Offer"), ref(component, event_literal(event)))
