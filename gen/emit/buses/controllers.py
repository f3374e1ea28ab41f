# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The controller of a bus: how it is configured, and that it runs as certified."""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import Decl, UseType
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    TRUE,
    Expr,
    StringLiteral,
    both,
    equal,
    number,
    record,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.statements import Pragma, Stmt, do
from ravenchart.gen.emit.certificate.certified import agrees, driver_element, fact
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.system import System

ORDERS = "Ravenchart.Can.Transmit_Orders"
"""The package of the runtime by which a driver knows the order of a bus."""


def controller_checks(bus: Bus) -> list[Decl]:
    """The controller runs as the certificate says."""
    same = [
        equal(ref("Controller.Given_Setting", what), rate) for what, rate in _rates(bus).items()
    ]
    level = fact(driver_element(bus.name), "Priority")
    return [
        UseType("Ravenchart.Can.Bits_Per_Second"),
        agrees("Controller.Given_Priority", level, bus.name, "priority of its driver"),
        Pragma("Assert", (both(*same),)),
    ]


def _rates(bus: Bus) -> dict[str, Expr]:
    """The bit rates as certified; 0 for one that the bus does not have."""
    return {
        "Bit_Rate": fact(bus.name, "Bit_Rate"),
        "Data_Rate": fact(bus.name, "Data_Rate") if bus.data_rate else number(0),
    }


def bus_number(system: System, bus: Bus) -> Expr:
    """The place of a bus among those of the program."""
    return number([one.name for one in system.buses].index(bus.name) + 1)


def orders_by_priority(system: System) -> list[Stmt]:
    """The calls that set the buses whose transmit buffers are by priority."""
    return [
        do(ref(ORDERS, "Set_By_Priority"), bus_number(system, bus))
        for bus in system.buses
        if bus.by_priority
    ]


def bus_place(system: System, bus: Bus) -> dict[str, Expr]:
    """The place of a bus among those of the program, and its name in the environment."""
    return {
        "Bus_Number": bus_number(system, bus),
        "Bus_Name": StringLiteral(bus.name.upper()),
    }


def controller_setting(bus: Bus) -> Expr:
    """How the controller is configured."""
    settings = {
        **_rates(bus),
        "Takes_Fd": TRUE if bus.takes_fd else FALSE,
        "Recovery": ref("Ravenchart.Can", "On_Request" if bus.recovers_by_request else "Automatic"),
    }
    return record(settings)
