# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The watch of a bus: one look at the controller, and the events that its faults raise."""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Decl,
    Object,
    Package,
    Subprogram,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import Attribute, Expr, OperatorChain, call, number
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case, root_package
from ravenchart.gen.emit.ada.statements import Assign, Comment, IfStatement, Stmt, do
from ravenchart.gen.emit.language.events import event_value
from ravenchart.gen.emit.tables.executions import ELEMENT_ID, EXECUTED, bus_row, executed, run_spec
from ravenchart.gen.emit.tables.trace_calls import fault_number, note, traced
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.system import Slot, System, Work

NOTICES = ref("Ravenchart.Can.Fault_Notices")


def emit_watch(system: System, bus: Bus, header: str) -> list[Unit]:
    """The unit that looks at the controller; none where nobody wants to know."""
    if bus.watch is None:
        return []
    root = root_package(system)
    name = ref(root, ada_case(bus.name), "Watch")
    slot = bus_row(system, bus, Work.BUS_WATCH)
    spec: tuple[Decl, ...] = (
        UseType(ELEMENT_ID),
        run_spec("Watch", slot),
        Comment(
            f"[{bus.name}.watch] look at the controller, and raise the events of its faults "
            "since the last look."
        ),
    )
    context = {NOTICES}
    owners = {instance for instance, _ in bus.raises}
    context |= {ref(root, ada_case(i)) for i in owners}
    context |= {ref(root, ada_case(system.instance(i).component.name)) for i in owners}
    if traced(system):
        context |= {ref(root, "Trace"), ref("Ravenchart.Traces"), ref("Ravenchart.Health")}
    return [
        Unit(header, (ref(root, "Elements"),), Package(name, spec, (SPARK,))),
        Unit(
            header,
            tuple(sorted(context)),
            Package(name, _body(system, bus, slot), (SPARK,), is_body=True),
        ),
    ]


def _body(system: System, bus: Bus, slot: Slot) -> tuple[Decl, ...]:
    items: list[Decl] = [
        Comment(f"[{bus.name}.watch] the state of the controller at the last look"),
        Object("Seen", ref(NOTICES, "Fault_Log")),
    ]
    looks = bus.recovery_looks
    locals_: list[Decl] = [
        Object("Now", ref(NOTICES, "Fault_Log")),
        Object("Found", ref(NOTICES, "Notices")),
    ]
    steps: list[Stmt] = [
        do("Controller.Read_Faults", ref("Now")),
        Assign("Found", call(ref(NOTICES, "Between"), ref("Seen"), ref("Now"))),
    ]
    element = f"{system.nodes[0].name}.{bus.name}"
    if traced(system):
        locals_.insert(0, UseType("Ravenchart.Can.Controller_State"))
        position = call(Attribute("Ravenchart.Can.Controller_State", "Pos"), ref("Now.State"))
        changed = OperatorChain("/=", (ref("Now.State"), ref("Seen.State")))
        steps.append(IfStatement(((changed, note(system, "State", element, "bus", position)),)))
    steps.append(Assign("Seen", ref("Now")))
    for field, fault, events in (
        ("Error_Passive", "Can_Error_Passive", bus.on_error_passive),
        ("Bus_Off", "Can_Bus_Off", bus.on_bus_off),
        ("Recovered", None, bus.on_recovered),
    ):
        told: tuple[Stmt, ...] = ()
        if fault is not None:
            told = note(system, "Fault", element, "bus", fault_number(fault))
        told += tuple(offer(system, instance, event) for instance, event in events)
        if told:
            steps.append(IfStatement(((ref("Found", field), told),)))
    if looks:
        items += [
            Comment("looks until recovery from bus-off is requested"),
            Object("Left", ref(NOTICES, "Look_Count"), number(looks)),
        ]
        locals_.append(Object("Is_Due", "Boolean"))
        counted: list[Expr] = [
            ref("Left"), ref("Found"), ref("Now.State"), number(looks), ref("Is_Due")
        ]  # fmt: skip
        steps.append(do(ref(NOTICES, "Count_Off"), *counted))
        steps.append(IfStatement(((ref("Is_Due"), (do("Controller.Request_Recovery"),)),)))
    steps.append(executed(slot))
    items.append(
        Subprogram("Run_Watch", (EXECUTED,), declarations=tuple(locals_), body=tuple(steps))
    )
    return tuple(items)


def offer(system: System, instance: str, event: str) -> Stmt:
    """Raise an event of an instance."""
    root = root_package(system)
    value = event_value(system.instance(instance).component, event, root=root)
    return do(ref(root, ada_case(instance), "Offer"), value)
