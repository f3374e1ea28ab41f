"""Start and end of devices: initialised and tested before the first release, made safe at the end.

The main program leads both. A supervisor, or the last-chance handler of the runtime, makes devices
safe where the main program cannot.
"""

from __future__ import annotations

from ravenchart.gen.derive.calls import started
from ravenchart.gen.emit.ada.naming import ada_case, root_package
from ravenchart.gen.emit.ada.syntax import (
    FALSE,
    SPARK,
    TRUE,
    Arg,
    Aspect,
    Assign,
    Comment,
    Decl,
    Do,
    IfStatement,
    Object,
    OperatorChain,
    Package,
    Param,
    Prefix,
    Ref,
    Stmt,
    Subprogram,
    Unit,
    UseType,
    arguments,
    number,
)
from ravenchart.gen.model.commands import Device
from ravenchart.gen.model.system import System

UNIT = "Device_Lifecycle"
"""The package below the root that starts and ends all devices."""

LAST_CHANCE = (
    Aspect("Export"),
    Aspect("Convention", Ref("C")),
    Aspect("External_Name", Ref('"ravenchart_make_safe"')),
)
"""By this name the runtime finds it when the main program ends by an exception."""

FAILURES = "Ravenchart.Device_Failures"
RUNTIME_FOLDER = "spark_runtime/devices"
"""Where `FAILURES` is; only programs that start devices have it among their sources."""


def has_lifecycle(system: System) -> bool:
    """Whether the program of a system starts or ends any device."""
    return bool(started(system))


def ends_devices(system: System) -> bool:
    """Whether the program of a system makes any device safe."""
    return bool(_ended(system))


def _ended(system: System) -> tuple[Device, ...]:
    return tuple(d for d in started(system) if d.type and d.type.lifecycle.make_safe is not None)


def emit_lifecycle(system: System, header: str) -> list[Unit]:
    """The package that starts and ends all devices of a program, where it has such."""
    devices, ended = started(system), _ended(system)
    if not devices:
        return []
    root = root_package(system)
    start = (Param("Passed", "out", "Boolean"),)
    spec: list[Decl] = [
        Subprogram("Start_All", start),
        Comment(
            "Initialise and test each device. Where one fails, or where this ends behind the "
            "first release, Passed is False and all devices are safe."
        ),
    ]
    steps: list[Stmt] = [Assign("Passed", TRUE)]
    for device in devices:
        failed = (
            Do(f"{FAILURES}.Note", arguments(Ref(f'"{device.name}"'))),
            Assign("Passed", FALSE),
        )
        steps.append(Do(f"{ada_case(device.name)}.Start", arguments(Ref("Started"))))
        steps.append(IfStatement(((Prefix("not", Ref("Started")), failed),)))
    late = (Do(f"{FAILURES}.Note_Late"), Assign("Passed", FALSE))
    steps.append(Do("Ravenchart.Epochs.Since_Start", arguments(Ref("Elapsed"))))
    steps.append(IfStatement(((OperatorChain(">", (Ref("Elapsed"), number(0))), late),)))
    if ended:
        spec += [
            Subprogram("Make_All_Safe", aspects=LAST_CHANCE),
            Comment("Make each device safe."),
        ]
        steps.append(IfStatement(((Prefix("not", Ref("Passed")), (Do("Make_All_Safe"),)),)))
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
        safe = tuple(Do(f"{ada_case(device.name)}.Make_Safe") for device in ended)
        bodies.append(Subprogram("Make_All_Safe", body=safe))
    withs = {f"{root}.{ada_case(device.name)}" for device in devices}
    withs |= {"Ravenchart.Epochs", FAILURES}
    name = f"{root}.{UNIT}"
    return [
        Unit(header, (), Package(name, tuple(spec), (SPARK,))),
        Unit(header, tuple(sorted(withs)), Package(name, tuple(bodies), (SPARK,), is_body=True)),
    ]


# --- One device --------------------------------------------------------------------


def lifecycle_specs(device: Device) -> tuple[Decl, ...]:
    """What a device's package has besides its commands."""
    if device.type is None or not device.type.lifecycle.given:
        return ()
    life = device.type.lifecycle
    items: list[Decl] = [
        Subprogram("Start", (Param("Passed", "out", "Boolean"),)),
        Comment(f"[{device.name}] before the first release; WCET {life.start:_} ns"),
    ]
    if life.make_safe is not None:
        items.append(Subprogram("Make_Safe"))
        items.append(Comment(f"[{device.name}] at the end; WCET {life.make_safe:_} ns"))
    return tuple(items)


def lifecycle_bodies(device: Device, driver: str, own: tuple[Arg, ...]) -> list[Subprogram]:
    """The operations of a device that work on what it remembers; ``own`` goes to the driver."""
    assert device.type is not None
    life = device.type.lifecycle
    if not life.given:
        return []
    passed = Arg(None, Ref("Passed"))
    steps: list[Stmt] = []
    tested = Do(f"{driver}.Self_Test", (*own, passed))
    if life.initialise is not None:
        steps.append(Do(f"{driver}.Initialise", (*own, passed)))
        if life.self_test is not None:
            steps.append(IfStatement(((Ref("Passed"), (tested,)),)))
    else:
        steps.append(tested if life.self_test is not None else Assign("Passed", TRUE))
    steps.append(Assign("Is_Ready", Ref("Passed")))
    made = [Subprogram("Start", (Param("Passed", "out", "Boolean"),), body=tuple(steps))]
    if life.make_safe is not None:
        safe = (Do(f"{driver}.Make_Safe", own), Assign("Is_Ready", FALSE))
        made.append(Subprogram("Make_Safe", body=safe))
    return made
