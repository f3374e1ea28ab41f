# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Start and end of devices: initialised and tested before the first release, made safe at the end.

The main program leads both. A supervisor, or the last-chance handler of the runtime, makes devices
safe where the main program cannot.
"""

from __future__ import annotations

from ravenchart.gen.derive.calls import devices_with_ends
from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    Object,
    Package,
    Param,
    Subprogram,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    TRUE,
    Arg,
    OperatorChain,
    Prefix,
    StringLiteral,
    number,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case, root_package
from ravenchart.gen.emit.ada.statements import Assign, Comment, Do, IfStatement, Stmt, do
from ravenchart.gen.model.commands import Device
from ravenchart.gen.model.system import System

UNIT = "Device_Lifecycle"
"""The package below the root that starts and ends all devices."""

LAST_CHANCE = (
    Aspect("Export"),
    Aspect("Convention", ref("C")),
    Aspect("External_Name", StringLiteral("ravenchart_make_safe")),
)
"""By this name the runtime finds it when the main program ends by an exception."""

FAILURES = ref("Ravenchart.Device_Failures")
RUNTIME_FOLDER = "spark_runtime/devices"
"""Where `FAILURES` is; only programs that start devices have it among their sources."""


def has_lifecycle(system: System) -> bool:
    """Whether the program of a system starts or ends any device."""
    return bool(devices_with_ends(system))


def ends_devices(system: System) -> bool:
    """Whether the program of a system makes any device safe."""
    return bool(_ended(system))


def _ended(system: System) -> tuple[Device, ...]:
    return tuple(
        d for d in devices_with_ends(system) if d.type and d.type.lifecycle.make_safe is not None
    )


def emit_lifecycle(system: System, header: str) -> list[Unit]:
    """The package that starts and ends all devices of a program, where it has such."""
    devices, ended = devices_with_ends(system), _ended(system)
    if not devices:
        return []
    root = root_package(system)
    start = (Param("Passed", "out", "Boolean"),)
    spec: list[Decl] = [
        Subprogram("Start_All", start),
        Comment(
            "Initialise and test each device. If one fails, or all this ends after the first "
            "release, Passed is False and all devices are safe."
        ),
    ]
    steps: list[Stmt] = [Assign("Passed", TRUE)]
    for device in devices:
        failed = (
            do(ref(FAILURES, "Note"), StringLiteral(device.name)),
            Assign("Passed", FALSE),
        )
        steps.append(do(ref(ada_case(device.name), "Start"), ref("Started")))
        steps.append(IfStatement(((Prefix("not", ref("Started")), failed),)))
    late = (do(ref(FAILURES, "Note_Late")), Assign("Passed", FALSE))
    steps.append(do("Ravenchart.Epochs.Since_Start", ref("Elapsed")))
    steps.append(IfStatement(((OperatorChain(">", (ref("Elapsed"), number(0))), late),)))
    if ended:
        spec += [
            Subprogram("Make_All_Safe", aspects=LAST_CHANCE),
            Comment("Make each device safe."),
        ]
        steps.append(IfStatement(((Prefix("not", ref("Passed")), (do("Make_All_Safe"),)),)))
    bodies: list[Decl] = [
        Subprogram(
            "Start_All",
            start,
            declarations=(
                UseType("Ravenchart.Nanoseconds"),
                Object("Started", "Boolean"),
                Object("Elapsed", "Ravenchart.Nanoseconds"),
            ),
            body=tuple(steps),
        )
    ]
    if ended:
        safe = tuple(do(ref(ada_case(device.name), "Make_Safe")) for device in ended)
        bodies.append(Subprogram("Make_All_Safe", body=safe))
    withs = {ref(root, ada_case(device.name)) for device in devices}
    withs |= {ref("Ravenchart.Epochs"), FAILURES}
    name = ref(root, UNIT)
    return [
        Unit(header, (), Package(name, tuple(spec), (SPARK,))),
        Unit(header, tuple(sorted(withs)), Package(name, tuple(bodies), (SPARK,), is_body=True)),
    ]


# --- One device --------------------------------------------------------------------


def lifecycle_specs(device: Device) -> tuple[Decl, ...]:
    """The operations of a device's package besides its commands: start and end."""
    if device.type is None or not device.type.lifecycle.given:
        return ()
    life = device.type.lifecycle
    items: list[Decl] = [
        Subprogram("Start", (Param("Passed", "out", "Boolean"),)),
        Comment(f"[{device.name}] called before the first release; WCET {life.start:_} ns"),
    ]
    if life.make_safe is not None:
        items.append(Subprogram("Make_Safe"))
        items.append(Comment(f"[{device.name}] called at the end; WCET {life.make_safe:_} ns"))
    return tuple(items)


def lifecycle_bodies(device: Device, driver: str, own: tuple[Arg, ...]) -> list[Subprogram]:
    """The operations of a device that work on what it remembers; ``own`` goes to the driver."""
    assert device.type is not None
    life = device.type.lifecycle
    if not life.given:
        return []
    passed = Arg(None, ref("Passed"))
    steps: list[Stmt] = []
    tested = Do(ref(driver, "Self_Test"), (*own, passed))
    if life.initialise is not None:
        steps.append(Do(ref(driver, "Initialise"), (*own, passed)))
        if life.self_test is not None:
            steps.append(IfStatement(((ref("Passed"), (tested,)),)))
    else:
        steps.append(tested if life.self_test is not None else Assign("Passed", TRUE))
    steps.append(Assign("Is_Ready", ref("Passed")))
    made = [Subprogram("Start", (Param("Passed", "out", "Boolean"),), body=tuple(steps))]
    if life.make_safe is not None:
        safe = (Do(ref(driver, "Make_Safe"), own), Assign("Is_Ready", FALSE))
        made.append(Subprogram("Make_Safe", body=safe))
    return made
