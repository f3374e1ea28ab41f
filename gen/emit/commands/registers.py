# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Registers of devices: which devices a type has, access to their registers, and what is behind.

A driver reads and writes registers by procedures of one package for its type. That has two bodies:
a generated one with the registers at their addresses, in `hardware/`, and the user's, in
`simulated/`, of which a first version is written. The project file chooses.
"""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.calls import called_devices, device_types
from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    AbstractState,
    ArrayDefinition,
    Aspect,
    Decl,
    EnumType,
    Object,
    Package,
    Param,
    Subprogram,
    TypeDeclaration,
    Unit,
)
from ravenchart.gen.emit.ada.expressions import (
    Aggregate,
    Arg,
    Indexed,
    IntegerLiteral,
    StringLiteral,
    all_else,
    arguments,
    call,
    number,
    record,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case, root_package, scalar, type_name
from ravenchart.gen.emit.ada.statements import Assign, Case, Comment, Pragma, Stmt
from ravenchart.gen.language.terms import named
from ravenchart.gen.model.commands import Device, DeviceType, Register
from ravenchart.gen.model.system import System

HARDWARE = "hardware"
"""The folder below generated/ of the bodies with the registers at their addresses."""

STATE = "Registers"
_OF_ADDRESSES = (
    "writing to * is assumed to have no effects on other*",
    "address specification on * is imprecisely supported*",
)
"""The warnings of gnatprove about an object at an address, in the words of its versions."""


def types_with_registers(system: System) -> tuple[DeviceType, ...]:
    """The types of the devices that are called whose drivers use registers."""
    return tuple(kind for kind in device_types(system) if kind.registers)


def units_package(kind: DeviceType) -> str:
    """Below the root: the devices of a type, and the parameters of each."""
    return f"{ada_case(kind.name)}_Units"


def registers_package(kind: DeviceType) -> str:
    """Below the root: access to the registers of all devices of a type."""
    return f"{ada_case(kind.name)}_Registers"


def registers_state(kind: DeviceType) -> DottedName:
    """The abstract state of the registers of a type, as its driver names it."""
    return ref(registers_package(kind), STATE)


def unit_of(device: Device) -> str:
    """The literal of a device, among those of its type."""
    return f"{ada_case(device.name)}_Unit"


def told_apart(kind: DeviceType) -> tuple[Param, ...]:
    """The parameter by which a driver knows for which device it works."""
    unit = Param("Unit", "in", ref(units_package(kind), "Unit"))
    return (unit,) if kind.tells_apart else ()


def chosen(kind: DeviceType, device: Device) -> tuple[Arg, ...]:
    """That parameter, for a device."""
    unit = ref(units_package(kind), unit_of(device))
    return arguments(unit) if kind.tells_apart else ()


# --- Specs -------------------------------------------------------------------------


def emit_units(system: System, kind: DeviceType, header: str) -> Iterator[Unit]:
    """The devices of a type with their parameters, and the access to their registers."""
    if kind.tells_apart:
        yield _units(system, kind, header)
    if kind.registers:
        yield _access(system, kind, header)


def _units(system: System, kind: DeviceType, header: str) -> Unit:
    devices = called_devices(system, kind)
    items: list[Decl] = [
        Comment(f"[{kind.name}] the devices of this type"),
        EnumType("Unit", tuple(unit_of(device) for device in devices)),
    ]
    for one in kind.parameters:
        rows = tuple(
            Arg(ref(unit_of(device)), scalar(system, one.type, named_value(device, one.name)))
            for device in devices
        )
        items.append(Comment(f"[{kind.name}.{one.name}]"))
        array = ArrayDefinition("Unit", type_name(system, one.type))
        items.append(Object(ada_case(one.name), array, Aggregate(rows), constant=True))
    name = ref(root_package(system), units_package(kind))
    return Unit(header, (), Package(name, tuple(items), (SPARK,)))


def named_value(device: Device, parameter: str) -> int | bool | str:
    """The value of a parameter of a device; KeyError where it has none."""
    return {one.name: value for one, value in device.values}[parameter]


def _word(register: Register) -> DottedName:
    return ref("Interfaces", f"Unsigned_{register.width}")


def _reading(kind: DeviceType, one: Register) -> Subprogram:
    params = (*told_apart(kind), Param("Value", "out", _word(one)))
    return Subprogram(f"Read_{ada_case(one.name)}", params)


def _writing(kind: DeviceType, one: Register) -> Subprogram:
    params = (*told_apart(kind), Param("Value", "in", _word(one)))
    return Subprogram(f"Write_{ada_case(one.name)}", params)


def _access(system: System, kind: DeviceType, header: str) -> Unit:
    root = root_package(system)
    items: list[Decl] = []
    changes = (Aspect("Global", record({"In_Out": ref(STATE)})),)
    for one in kind.registers:
        for made in _procedures(kind, one):
            items.append(Subprogram(made.name, made.params, aspects=changes))
        items.append(Comment(f"[{kind.name}.{one.name}] offset 16#{one.offset:X}#"))
    aspects = (
        SPARK,
        Aspect("Elaborate_Body"),
        Aspect("Abstract_State", AbstractState(STATE, ("Synchronous", "External"))),
        Aspect("Initializes", ref(STATE)),
    )
    withs = (ref("Interfaces"), ref(root, units_package(kind)))
    name = ref(root, registers_package(kind))
    return Unit(header, withs, Package(name, tuple(items), aspects))


def _procedures(kind: DeviceType, one: Register) -> Iterator[Subprogram]:
    if one.access.reads:
        yield _reading(kind, one)
    if one.access.writes:
        yield _writing(kind, one)


# --- Bodies ------------------------------------------------------------------------


def hardware_bodies(system: System, header: str) -> Iterator[Unit]:
    """The registers of each type at their addresses; in memory where a device has none."""
    for kind in types_with_registers(system):
        yield _at_addresses(system, kind, header)


def _object(device: Device, one: Register) -> str:
    return f"{ada_case(device.name)}_{ada_case(one.name)}"


def _at_addresses(system: System, kind: DeviceType, header: str) -> Unit:
    root = root_package(system)
    devices = called_devices(system, kind)
    every = [ref(_object(device, one)) for device in devices for one in kind.registers]
    constituents = every[0] if len(every) == 1 else Aggregate(arguments(*every))
    items: list[Decl] = []
    placed = any(device.address is not None for device in devices)
    if placed:
        items += [
            Pragma(
                "Warnings",
                (
                    ref("GNATprove"),
                    ref("Off"),
                    StringLiteral(text),
                    Arg("Reason", StringLiteral("ASM-018, registers are where the model says")),
                ),
            )
            for text in _OF_ADDRESSES
        ]
    given = not all(one.access.writes for one in kind.registers)
    if given and any(device.address is None for device in devices):
        pattern = StringLiteral("* is not modified, consider pragma Export *")
        items.append(Pragma("Warnings", (ref("Off"), pattern)))
    for device in devices:
        items.append(Comment(f"[{device.name}]"))
        items += [_placed(device, one) for one in kind.registers]
    for one in kind.registers:
        for made in _procedures(kind, one):
            rows = tuple(
                (ref(units_package(kind), unit_of(d)), (_moved(made, ref(_object(d, one))),))
                for d in devices
            )
            items.append(Subprogram(made.name, made.params, body=(Case(ref("Unit"), rows),)))
    withs = (ref("System.Storage_Elements"),) if placed else ()
    refined = Aspect("Refined_State", Aggregate((Arg(STATE, constituents),)))
    name = ref(root, registers_package(kind))
    return Unit(header, withs, Package(name, tuple(items), (SPARK, refined), is_body=True))


def _moved(made: Subprogram, place: DottedName | Indexed) -> Stmt:
    """The value out of a register, or into it."""
    if named(made.params, "Value").mode == "out":
        return Assign("Value", place)
    return Assign(place, ref("Value"))


def _placed(device: Device, one: Register) -> Object:
    if device.address is None:
        return Object(_object(device, one), _word(one), number(0), aspects=(Aspect("Atomic"),))
    at = IntegerLiteral(device.address + one.offset, base=16)
    aspects = (
        Aspect("Atomic"),
        Aspect("Import"),
        Aspect("Address", call("System.Storage_Elements.To_Address", at)),
    )
    return Object(_object(device, one), _word(one), aspects=aspects)


def simulated_registers(system: System, kind: DeviceType, header: str) -> Unit:
    """Registers that keep what was written, and 0 without that: a starting point.

    A model of the equipment takes its place.
    """
    items: list[Decl] = []
    for one in kind.registers:
        if not one.access.writes:
            continue
        words = f"{ada_case(one.name)}_Words"
        array = ArrayDefinition(ref(units_package(kind), "Unit"), _word(one))
        items.append(TypeDeclaration(words, array))
        start = all_else(number(0))
        kept = (Aspect("Volatile"),)
        items.append(Object(f"{ada_case(one.name)}_Kept", words, start, aspects=kept))
    for one in kind.registers:
        for made in _procedures(kind, one):
            unused: tuple[Decl, ...] = ()
            moved = _moved(made, Indexed(f"{ada_case(one.name)}_Kept", ref("Unit")))
            if not one.access.writes:
                unused = (Pragma("Unreferenced", (ref("Unit"),)),)
                moved = Assign("Value", number(0))
            items.append(Subprogram(made.name, made.params, declarations=unused, body=(moved,)))
    name = ref(root_package(system), registers_package(kind))
    off = Aspect("SPARK_Mode", ref("Off"))
    return Unit(header, (), Package(name, tuple(items), (off,), is_body=True))
