# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Parameters, registers and lifecycle of device types, and what devices say of them."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

from ravenchart.gen.files.schema_devices import DeviceForm, DeviceTypeForm
from ravenchart.gen.language.names import Findings, NameScope, meant
from ravenchart.gen.language.terms import Ns, Scalar, Type
from ravenchart.gen.model.commands import (
    Access,
    Device,
    DeviceParameter,
    DeviceType,
    Lifecycle,
    Register,
)

from .values import constant, parameter

REGISTERS = "RV-1216"
"""Registers or addresses that do not fit."""

PARAMETERS = "RV-1217"
"""A parameter of a device without a value, or a value without a parameter."""

LARGEST_SPAN = 2**16
"""Bytes that the registers of a device take at most."""

ALIGNMENT = 4
"""Of the address of a device, in bytes."""


def parameters_of(
    form: DeviceTypeForm, types: NameScope[Type], findings: Findings
) -> tuple[DeviceParameter, ...] | None:
    """The parameters of a device type; None when one of them is wrong."""
    found: NameScope[DeviceParameter] = NameScope("parameter")
    for name, at in (form.parameters or {}).items():
        given = parameter(name, at, types, findings)
        made = None if given is None else DeviceParameter(name, at.origin, *given)
        found.declare(name, at.origin, made, findings)
    whole = len(found.sound()) == len(form.parameters or {}) and not form.dropped("parameters")
    return found.sound() if whole else None


def registers_of(form: DeviceTypeForm, findings: Findings) -> tuple[Register, ...] | None:
    """The registers of a device type, apart from each other; None when one of them is wrong."""
    before = findings.count()
    found: NameScope[Register] = NameScope("register")
    for name, at in (form.registers or {}).items():
        made = Register(name, at.origin, at.offset, at.width, Access(at.access))
        size = made.width // 8
        if made.offset % size:
            message = (
                f"the register {name} has {made.width} bits, but its offset {made.offset} is no "
                f"multiple of {size} bytes"
            )
            hint = f"`offset: {made.offset - made.offset % size}`?"
            findings.error(REGISTERS, at.at("offset"), message, hint=hint)
        elif made.end > LARGEST_SPAN:
            message = f"the register {name} ends at byte {made.end}; the limit is {LARGEST_SPAN}"
            hint = "let another device have the registers behind the limit"
            findings.error(REGISTERS, at.at("offset"), message, hint=hint)
        found.declare(name, at.origin, made, findings)
    ordered = sorted(found.sound(), key=lambda one: one.offset)
    for first, second in pairwise(ordered):
        if second.offset < first.end:
            message = (
                f"the register {second.name} begins at byte {second.offset}, but {first.name} "
                f"ends at byte {first.end}"
            )
            notes = [(first.origin, f"{first.name} is here")]
            hint = "registers cannot overlap: correct an offset or a width"
            findings.error(REGISTERS, second.origin, message, notes=notes, hint=hint)
    if findings.count() > before or form.dropped("registers"):
        return None
    return found.sound()


def lifecycle_of(form: DeviceTypeForm) -> Lifecycle:
    """The operations of a driver at start and end."""
    spans = (form.initialise, form.self_test, form.make_safe)
    return Lifecycle(*(None if span is None else Ns(span) for span in spans))


def values_of(
    name: str, form: DeviceForm, kind: DeviceType, findings: Findings
) -> tuple[tuple[DeviceParameter, Scalar], ...] | None:
    """The value of each parameter of a device; None when one is wrong or missing."""
    given = {text.lower(): text for text in form.parameters or {}}
    lost = {text.lower() for text in form.dropped("parameters")}
    found: list[tuple[DeviceParameter, Scalar]] = []
    for one in kind.parameters:
        text = given.pop(one.name.lower(), None)
        if text is not None:
            place = form.place("parameters", text)
            value = constant((form.parameters or {})[text], place, one.name, one.type, findings)
            if value is not None:
                found.append((one, value))
        elif one.default is not None:
            found.append((one, one.default))
        elif one.name.lower() not in lost:
            message = f"the device {name} gives no value for the parameter {one.name}"
            notes = [(one.origin, f"{one.name} is declared here, without `default`")]
            hint = f"`parameters: {{{one.name}: ...}}`"
            findings.error(PARAMETERS, form.origin, message, notes=notes, hint=hint)
    for text in given.values():
        message = f"{kind.name}, the type of {name}, has no parameter `{text}`"
        near = meant(text, (one.name for one in kind.parameters))
        findings.error(PARAMETERS, form.entry_at("parameters", text), message, hint=near)
    return tuple(found) if len(found) == len(kind.parameters) and not given else None


def address_of(name: str, form: DeviceForm, kind: DeviceType, findings: Findings) -> bool:
    """Whether the address of a device fits its type."""
    address = form.address
    if address is None:
        return True
    at = form.at("address")
    if not kind.registers and not kind.simulated:
        message = f"the device {name} has an address, but {kind.name} has no registers"
        hint = f"remove `address`, or give {kind.name} `registers`"
        findings.error(REGISTERS, form.at_key("address"), message, hint=hint)
    elif address % ALIGNMENT:
        message = f"the address 16#{address:X}# of {name} is no multiple of {ALIGNMENT} bytes"
        findings.error(REGISTERS, at, message, hint="correct the address")
    elif address + kind.span > 2**64:
        message = f"the registers of {name} end behind the last address of 64 bits"
        findings.error(REGISTERS, at, message, hint="correct the address")
    else:
        return True
    return False


def apart(devices: Iterable[Device], findings: Findings) -> None:
    """Report devices whose registers overlap."""
    placed = sorted(
        (one for one in devices if one.address is not None and one.type is not None),
        key=lambda one: one.address or 0,
    )
    for first, second in pairwise(placed):
        assert first.address is not None and second.address is not None and first.type is not None
        if second.address < first.address + first.type.span:
            last = first.address + first.type.span - 1
            message = (
                f"the address 16#{second.address:X}# of {second.name} lies inside {first.name}, "
                f"which reaches to 16#{last:X}#"
            )
            notes = [(first.origin, f"{first.name} is here")]
            hint = "each device has registers of its own: correct an address"
            findings.error(REGISTERS, second.origin, message, notes=notes, hint=hint)
