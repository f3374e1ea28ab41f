# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Registers of devices: which devices a type has, access to their registers, and what is behind.

A driver reads and writes registers by procedures of one package for its type. That has two bodies:
a generated one with the registers at their addresses, in `hardware/`, and the user's, in
`simulated/`, of which a first version is written. The project file chooses.
"""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.calls import device_types, units_of
from ravenchart.gen.emit.ada.naming import ada_case, root_package, scalar, type_name
from ravenchart.gen.emit.ada.syntax import (
    SPARK,
    Aggregate,
    Arg,
    Aspect,
    Assign,
    Case,
    Comment,
    Decl,
    EnumType,
    Object,
    Package,
    Param,
    PlainType,
    Pragma,
    Ref,
    Stmt,
    Subprogram,
    Unit,
    arguments,
    call,
    number,
)
from ravenchart.gen.language.terms import named
from ravenchart.gen.model.commands import Device, DeviceType, Register
from ravenchart.gen.model.system import System

HARDWARE = "hardware"
"""The folder below generated/ of the bodies with the registers at their addresses."""

STATE = "Registers"


def types_with_registers(system: System) -> tuple[DeviceType, ...]:
    """The types of the devices that are called whose drivers use registers."""
    return tuple(kind for kind in device_types(system) if kind.registers)


def units_package(kind: DeviceType) -> str:
    """Below the root: the devices of a type, and the parameters of each."""
    return f"{ada_case(kind.name)}_Units"


def registers_package(kind: DeviceType) -> str:
    """Below the root: access to the registers of all devices of a type."""
    return f"{ada_case(kind.name)}_Registers"


def registers_state(kind: DeviceType) -> str:
    """The abstract state of the registers of a type, as its driver names it."""
    return f"{registers_package(kind)}.{STATE}"


def unit_of(device: Device) -> str:
    """The literal of a device, among those of its type."""
    return f"{ada_case(device.name)}_Unit"


def told_apart(kind: DeviceType) -> tuple[Param, ...]:
    """The parameter by which a driver knows for which device it works."""
    unit = Param("Unit", "in", f"{units_package(kind)}.Unit")
    return (unit,) if kind.tells_apart else ()


def chosen(kind: DeviceType, device: Device) -> tuple[Arg, ...]:
    """That parameter, for a device."""
    unit = Ref(f"{units_package(kind)}.{unit_of(device)}")
    return arguments(unit) if kind.tells_apart else ()


# --- Specs -------------------------------------------------------------------------


def emit_units(system: System, kind: DeviceType, header: str) -> Iterator[Unit]:
    """The devices of a type with their parameters, and the access to their registers."""
    if kind.tells_apart:
        yield _units(system, kind, header)
    if kind.registers:
        yield _access(system, kind, header)


def _units(system: System, kind: DeviceType, header: str) -> Unit:
    devices = units_of(system, kind)
    items: list[Decl] = [
        Comment(f"[{kind.name}] its devices"),
        EnumType("Unit", tuple(unit_of(device) for device in devices)),
    ]
    for one in kind.parameters:
        rows = tuple(
            Arg(unit_of(device), scalar(system, one.type, named_value(device, one.name)))
            for device in devices
        )
        items.append(Comment(f"[{kind.name}.{one.name}]"))
        array = f"array (Unit) of {type_name(system, one.type)}"
        items.append(Object(ada_case(one.name), array, Aggregate(rows), constant=True))
    name = f"{root_package(system)}.{units_package(kind)}"
    return Unit(header, (), Package(name, tuple(items), (SPARK,)))


def named_value(device: Device, parameter: str) -> int | bool | str:
    """The value of a parameter of a device; KeyError where it has none."""
    return {one.name: value for one, value in device.values}[parameter]


def _word(register: Register) -> str:
    return f"Interfaces.Unsigned_{register.width}"


def _reading(kind: DeviceType, one: Register) -> Subprogram:
    params = (*told_apart(kind), Param("Value", "out", _word(one)))
    return Subprogram(f"Read_{ada_case(one.name)}", params)


def _writing(kind: DeviceType, one: Register) -> Subprogram:
    params = (*told_apart(kind), Param("Value", "in", _word(one)))
    return Subprogram(f"Write_{ada_case(one.name)}", params)


def _access(system: System, kind: DeviceType, header: str) -> Unit:
    root = root_package(system)
    items: list[Decl] = []
    changes = (Aspect("Global", Ref(f"(In_Out => {STATE})")),)
    for one in kind.registers:
        for made in _procedures(kind, one):
            items.append(Subprogram(made.name, made.params, aspects=changes))
        items.append(Comment(f"[{kind.name}.{one.name}] offset 16#{one.offset:X}#"))
    aspects = (
        SPARK,
        Aspect("Elaborate_Body"),
        Aspect("Abstract_State", Ref(f"({STATE} with Synchronous, External)")),
        Aspect("Initializes", Ref(STATE)),
    )
    withs = ("Interfaces", f"{root}.{units_package(kind)}")
    name = f"{root}.{registers_package(kind)}"
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
    devices = units_of(system, kind)
    every = [Ref(_object(device, one)) for device in devices for one in kind.registers]
    constituents = every[0] if len(every) == 1 else Aggregate(arguments(*every))
    items: list[Decl] = []
    placed = any(device.address is not None for device in devices)
    if placed:
        items.append(
            Pragma(
                "Warnings",
                (
                    Ref("GNATprove"),
                    Ref("Off"),
                    Ref('"writing to * is assumed to have no effects on other*"'),
                    Ref('Reason => "ASM-018, registers are where the model says"'),
                ),
            )
        )
    given = not all(one.access.writes for one in kind.registers)
    if given and any(device.address is None for device in devices):
        pattern = Ref('"* is not modified, consider pragma Export *"')
        items.append(Pragma("Warnings", (Ref("Off"), pattern)))
    for device in devices:
        items.append(Comment(f"[{device.name}]"))
        items += [_placed(device, one) for one in kind.registers]
    for one in kind.registers:
        for made in _procedures(kind, one):
            rows = tuple(
                (f"{units_package(kind)}.{unit_of(d)}", (_moved(made, _object(d, one)),))
                for d in devices
            )
            items.append(Subprogram(made.name, made.params, body=(Case(Ref("Unit"), rows),)))
    withs = ("System.Storage_Elements",) if placed else ()
    refined = Aspect("Refined_State", Aggregate((Arg(STATE, constituents),)))
    name = f"{root}.{registers_package(kind)}"
    return Unit(header, withs, Package(name, tuple(items), (SPARK, refined), is_body=True))


def _moved(made: Subprogram, place: str) -> Stmt:
    """The value out of a register, or into it."""
    if named(made.params, "Value").mode == "out":
        return Assign("Value", Ref(place))
    return Assign(place, Ref("Value"))


def _placed(device: Device, one: Register) -> Object:
    if device.address is None:
        return Object(_object(device, one), _word(one), number(0), aspects=(Aspect("Atomic"),))
    at = Ref(f"16#{device.address + one.offset:_X}#")
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
        items.append(PlainType(words, f"array ({units_package(kind)}.Unit) of {_word(one)}"))
        start = Aggregate((Arg("others", number(0)),))
        kept = (Aspect("Volatile"),)
        items.append(Object(f"{ada_case(one.name)}_Kept", words, start, aspects=kept))
    for one in kind.registers:
        for made in _procedures(kind, one):
            unused: tuple[Decl, ...] = ()
            moved = _moved(made, f"{ada_case(one.name)}_Kept (Unit)")
            if not one.access.writes:
                unused = (Pragma("Unreferenced", (Ref("Unit"),)),)
                moved = Assign("Value", number(0))
            items.append(Subprogram(made.name, made.params, declarations=unused, body=(moved,)))
    name = f"{root_package(system)}.{registers_package(kind)}"
    off = Aspect("SPARK_Mode", Ref("Off"))
    return Unit(header, (), Package(name, tuple(items), (off,), is_body=True))
