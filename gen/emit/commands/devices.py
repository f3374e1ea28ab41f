# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Devices: the specs of drivers, a package for each device, and simulated drivers."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.calls import called, callers, device_types
from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    ModularDefinition,
    Object,
    Package,
    Param,
    Protected,
    RecordComponent,
    RecordDeclaration,
    Subprogram,
    TypeDeclaration,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    NOTHING,
    TRUE,
    Aggregate,
    Arg,
    Expr,
    OperatorChain,
    arguments,
    number,
    record,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import (
    ada_case,
    default_value,
    priority,
    root_package,
    type_name,
)
from ravenchart.gen.emit.ada.statements import Assign, Comment, Do, IfStatement, Pragma, Stmt, do
from ravenchart.gen.language.terms import RecordType, Type
from ravenchart.gen.model.commands import CommandKind, Device, DeviceType, DriverCommand
from ravenchart.gen.model.system import System

from .lifecycle import emit_lifecycle, lifecycle_bodies, lifecycle_specs
from .registers import (
    chosen,
    emit_units,
    registers_package,
    registers_state,
    told_apart,
    units_package,
)

INLINE = Aspect("Inline_Always")
"""A direct call costs what a call of the driver costs."""


def emit_devices(system: System, header: str) -> tuple[Unit, ...]:
    """The specs of the drivers, then the devices, pieces before what is made of them."""
    units: list[Unit] = []
    for kind in device_types(system):
        units += (*emit_units(system, kind, header), _driver(system, kind, header))
    for device in system.devices:
        units += (
            _array(system, device, header)
            if device.type is None
            else _piece(system, device, device.type, header)
        )
    units += emit_lifecycle(system, header)
    return tuple(units)


def device_states_package(system: System, kind: DeviceType) -> DottedName:
    """The package of what a device of a type remembers, which the driver's author writes."""
    return ref(root_package(system), f"{ada_case(kind.name)}_States")


def _state(kind: DeviceType) -> DottedName:
    return ref(f"{ada_case(kind.name)}_States", "State")


def _params(system: System, command: DriverCommand) -> tuple[Param, ...]:
    params = []
    if command.is_event:
        assert command.argument is not None
        of_type = type_name(system, command.argument)
        return (Param("Is_Raised", "out", "Boolean"), Param("Argument", "out", of_type))
    if command.argument is not None:
        params.append(Param("Argument", "in", type_name(system, command.argument)))
    if command.reply is not None:
        params.append(Param("Reply", "out", type_name(system, command.reply)))
    return tuple(params)


def _passed(command: DriverCommand) -> tuple[Arg, ...]:
    if command.is_event:
        return arguments(ref("Is_Raised"), ref("Argument"))
    argument = arguments(ref("Argument")) if command.argument is not None else ()
    return (*argument, *(arguments(ref("Reply")) if command.reply is not None else ()))


# --- Drivers -----------------------------------------------------------------------


def _driver(system: System, kind: DeviceType, header: str) -> Unit:
    """The spec of a driver; its body is the user's, or a simulated one."""
    items: list[Decl] = []
    used = record({"In_Out": registers_state(kind)}) if kind.registers else NOTHING
    uses = (Aspect("Global", used),)
    for operation, what, wcet in _operations(system, kind):
        items.append(Subprogram(operation.name, operation.params, aspects=uses))
        items.append(Comment(f"[{kind.name}{what}] WCET {wcet:_} ns"))
    root = root_package(system)
    withs = {device_states_package(system, kind)}
    withs |= {ref(root, units_package(kind))} if kind.tells_apart else set()
    withs |= {ref(root, registers_package(kind))} if kind.registers else set()
    name = ref(root, ada_case(kind.name))
    return Unit(header, tuple(sorted(withs)), Package(name, tuple(items), (SPARK,)))


def _operations(system: System, kind: DeviceType) -> Iterator[tuple[Subprogram, str, int]]:
    """Each procedure of a driver without its body, what it is in the model, and its time."""
    own: tuple[Param, ...] = (*told_apart(kind), Param("Device", "in out", _state(kind)))
    life = kind.lifecycle
    passed = Param("Passed", "out", "Boolean")
    for name, wcet in (("Initialise", life.initialise), ("Self_Test", life.self_test)):
        if wcet is not None:
            yield Subprogram(name, (*own, passed)), "", wcet
    if life.make_safe is not None:
        yield Subprogram("Make_Safe", own), "", life.make_safe
    for one in kind.provides:
        params = (*own, *_params(system, one))
        yield Subprogram(ada_case(one.name), params), f".{one.name}", one.wcet


def simulated_driver(system: System, kind: DeviceType, header: str) -> tuple[Unit, Unit]:
    """The state of a simulated device, and a body that gives its values back: a starting point."""
    kept = [RecordComponent("Calls", "Call_Count", number(0))]
    bodies: list[Decl] = []
    given = {ada_case(one.name): one for one in kind.provides}
    for operation, what, _ in _operations(system, kind):
        name = operation.name
        steps: list[Stmt] = [
            Assign("Device.Calls", OperatorChain("+", (ref("Device.Calls"), number(1))))
        ]
        if not what:
            steps += [Assign("Passed", TRUE)] if name != "Make_Safe" else []
        else:
            command = given[name]
            for of_type, slot in ((command.argument, name), (command.reply, f"{name}_Reply")):
                if of_type is not None:
                    start = default_value(system, of_type)
                    kept.append(RecordComponent(slot, type_name(system, of_type), start))
            if command.is_event:
                assert command.argument is not None
                steps.append(Assign("Is_Raised", FALSE))
                steps.append(Assign("Argument", ref("Device", name)))
            elif command.argument is not None:
                steps.append(Assign(ref("Device", name), ref("Argument")))
            if command.reply is not None:
                steps.append(Assign("Reply", ref("Device", f"{name}_Reply")))
        declarations, touched = _first_access(kind)
        bodies.append(
            Subprogram(
                name,
                operation.params,
                declarations=declarations,
                body=(*touched, *steps),
            )
        )
    modulus = OperatorChain("**", (number(2), number(32)))
    items: tuple[Decl, ...] = (
        TypeDeclaration("Call_Count", ModularDefinition(modulus)),
        Comment("The arguments of the last calls, and the replies of the next ones."),
        RecordDeclaration("State", tuple(kept)),
    )
    spec = Package(device_states_package(system, kind), items, (SPARK,))
    driver = ref(root_package(system), ada_case(kind.name))
    uses = UseType(ref(f"{ada_case(kind.name)}_States", "Call_Count"))
    body = Package(driver, (uses, *bodies), (SPARK,), is_body=True)
    withs = (ref("Interfaces"),) if any(r.access.reads for r in kind.registers) else ()
    return Unit(header, (), spec), Unit(header, withs, body)


def _first_access(kind: DeviceType) -> tuple[tuple[Decl, ...], tuple[Stmt, ...]]:
    """One access to a register, by which a first version keeps its contract."""
    if not kind.registers:
        return ((Pragma("Unreferenced", (ref("Unit"),)),) if kind.tells_apart else ()), ()
    one = next((r for r in kind.registers if r.access.reads), kind.registers[0])
    name = ada_case(one.name)
    if not one.access.reads:
        write = ref(registers_package(kind), f"Write_{name}")
        return (), (do(write, ref("Unit"), number(0)),)
    seen = Object("Unused_Word", ref("Interfaces", f"Unsigned_{one.width}"))
    return (seen,), (do(ref(registers_package(kind), f"Read_{name}"), ref("Unit"), ref(seen.name)),)


# --- Pieces of equipment -----------------------------------------------------------


def _piece(system: System, device: Device, kind: DeviceType, header: str) -> list[Unit]:
    """A device with what it remembers; in a protected object where several tasks call it."""
    name = ref(root_package(system), ada_case(device.name))
    driver = ada_case(kind.name)
    to_driver = (*chosen(kind, device), Arg(None, ref("Own")))
    works = [
        *lifecycle_bodies(device, driver, to_driver),
        *(_work(system, kind, one, to_driver) for one in called(system, device)),
    ]
    rows = ", ".join(map(str, callers(system, device)))
    items: list[Decl] = [Comment(f"[{device.name}] called by {rows}")]
    withs = [ref(root_package(system), driver), device_states_package(system, kind)]
    if kind.tells_apart:
        withs.append(ref(root_package(system), units_package(kind)))
    if system.has_object(device.name):
        withs.append(ref("System"))
        ceiling = Aspect("Priority", priority(system.object(device.name).ceiling))
        specs = tuple(Subprogram(w.name, w.params) for w in works)
        kept: tuple[Object, ...] = (Object("Own", _state(kind)),)
        if kind.lifecycle.given:
            kept += (Object("Is_Ready", "Boolean", FALSE),)
        items.append(Protected("Guard", specs, kept, (ceiling,)))
        items.append(Protected("Guard", tuple(works)))
        items += [
            Subprogram(
                one.name,
                one.params,
                body=(
                    Do(ref("Guard", one.name), tuple(Arg(None, ref(p.name)) for p in one.params)),
                ),
            )
            for one in works
        ]
    else:
        items.append(Object("Own", _state(kind)))
        items += works
    body = Package(name, tuple(items), (SPARK,), is_body=True)
    return [_spec(system, device, name, header), Unit(header, tuple(sorted(withs)), body)]


def _work(
    system: System, kind: DeviceType, command: DriverCommand, own: tuple[Arg, ...]
) -> Subprogram:
    """A command of a device: of one that is not ready, only what reads is executed."""
    does = Do(ref(ada_case(kind.name), ada_case(command.name)), (*own, *_passed(command)))
    steps: tuple[Stmt, ...] = (does,)
    if kind.lifecycle.given and command.command.kind is not CommandKind.READ:
        steps = (IfStatement(((ref("Is_Ready"), steps),)),)
        if command.reply is not None:
            steps = (Assign("Reply", default_value(system, command.reply)), *steps)
        if command.is_event:
            assert command.argument is not None
            nothing = default_value(system, command.argument)
            steps = (Assign("Is_Raised", FALSE), Assign("Argument", nothing), *steps)
    return Subprogram(ada_case(command.name), _params(system, command), body=steps)


def _spec(system: System, device: Device, name: DottedName, header: str) -> Unit:
    items: list[Decl] = [*lifecycle_specs(device)]
    for one in called(system, device):
        items.append(Subprogram(ada_case(one.name), _params(system, one), aspects=(INLINE,)))
        items.append(Comment(f"[{device.name}.{one.name}] WCET {one.wcet:_} ns"))
    return Unit(header, (), Package(name, tuple(items), (SPARK,)))


# --- Arrays ------------------------------------------------------------------------


def _array(system: System, device: Device, header: str) -> list[Unit]:
    """Each command to all members in order; arguments cut up, replies put together."""
    root = root_package(system)
    name = ref(root, ada_case(device.name))
    works = tuple(_to_all(system, device, one) for one in called(system, device))
    withs = tuple(sorted(ref(root, ada_case(member.name)) for member in device.members))
    body = Package(name, works, (SPARK,), is_body=True)
    return [_spec(system, device, name, header), Unit(header, withs, body)]


def _to_all(system: System, device: Device, command: DriverCommand) -> Subprogram:
    declarations: list[Decl] = []
    calls: list[Stmt] = []
    gathered: list[Arg] = []
    first = 1
    for place, member in enumerate(device.members, 1):
        one = member.command(command.name)
        args: list[Arg] = []
        if one.argument is not None:
            args.append(Arg(None, _cut(one, first, member.axes)))
        if one.reply is not None:
            part = f"Part_{place}"
            declarations.append(Object(part, type_name(system, one.reply)))
            args.append(Arg(None, ref(part)))
            gathered += _fields(part, one.reply, first, member.axes)
        calls.append(Do(ref(ada_case(member.name), ada_case(command.name)), tuple(args)))
        first += member.axes
    if gathered:
        calls.append(Assign("Reply", Aggregate(tuple(gathered))))
    return Subprogram(
        ada_case(command.name),
        _params(system, command),
        declarations=tuple(declarations),
        body=tuple(calls),
    )


def _cut(command: DriverCommand, first: int, axes: int) -> Expr:
    """The part of an argument that is for a member, whose first axis has that number."""
    assert command.argument is not None
    if not command.command.per_axis:
        return ref("Argument")
    if axes == 1:
        return ref("Argument", f"Axis_{first}")
    own = range(1, axes + 1)
    rows = tuple(Arg(f"Axis_{n}", ref("Argument", f"Axis_{first + n - 1}")) for n in own)
    return Aggregate(rows)


def _fields(part: str, of_type: Type, first: int, axes: int) -> list[Arg]:
    """The axes of a member's reply in the reply of the array."""
    if not isinstance(of_type, RecordType):
        return [Arg(f"Axis_{first}", ref(part))]
    return [Arg(f"Axis_{first + n - 1}", ref(part, f"Axis_{n}")) for n in range(1, axes + 1)]
