# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A bus database and a trace map for the stand-in controller, without the generator."""

from __future__ import annotations

import json
from collections.abc import Sequence

LEAVES = ("Idle", "Seeking", "Backing_Off", "Accelerating", "Cruising", "Braking", "Limit", "Drive")
MISSION = ("Waiting", "Homing", "Ready", "Departing", "Under_Way", "Failed", "Shut_Down")
CONDITIONS = ("Waiting", "Homing", "Ready", "Moving", "Failed", "Stopped")
ORDERS = ("Halt", "Home", "Move", "Reset")

_HEAD = """VERSION ""

BU_: Controller Outside Any

"""


def dbc(axes: Sequence[str]) -> str:
    """Commands, status, and set point and feedback of each axis."""
    positions = [(axis, 19, -20000, -20000, 500000) for axis in axes]
    messages = [
        (0x080, "robot_command", [("kind", 2, 0, 0, 3), *positions]),
        (0x180, "robot_status", [("condition", 3, 0, 0, 5), *positions[:2]]),
    ]
    choices = [(0x080, "kind", ORDERS), (0x180, "condition", CONDITIONS)]
    for index, axis in enumerate(axes):
        set_point, feedback = 0x110 + index, 0x120 + index
        speed = ("speed", 20, -400000, -400000, 400000)
        messages.append((set_point, f"{axis}_set_point", [("mode", 1, 0, 0, 1), speed]))
        count = ("count", 21, -1000000, -1000000, 1000000)
        rest = [("limit", 2, 0, 0, 2), ("condition", 1, 0, 0, 1)]
        messages.append((feedback, f"{axis}_feedback", [count, speed, *rest]))
        choices += [
            (set_point, "mode", ("Disabled", "Enabled")),
            (feedback, "limit", ("Clear", "Low_End", "High_End")),
            (feedback, "condition", ("Ready", "Faulted")),
        ]
    text = _HEAD
    for identifier, name, signals in messages:
        sender = "Outside" if name.endswith(("command", "feedback")) else "Controller"
        text += f"BO_ {identifier} {name}: 8 {sender}\n"
        start = 0
        for signal, width, offset, low, high in signals:
            text += f' SG_ {signal} : {start}|{width}@1+ (1,{offset}) [{low}|{high}] "" Any\n'
            start += width
        text += "\n"
    for identifier, signal, names in choices:
        values = " ".join(f'{i} "{name}"' for i, name in enumerate(names))
        text += f"VAL_ {identifier} {signal} {values} ;\n"
    return text


def trace_map(axes: Sequence[str]) -> str:
    """Elements 1 and 2 are the processor and its row, 3 and 4 the coordinator's.

    Each axis then has its region and its feedback port, from 10 in steps of 2.
    """
    elements: list[dict[str, object]] = [
        {"id": 1, "element": "control", "kind": "processor", "origin": "model.yaml:1:1"},
        {"id": 2, "element": "joint_x.position_control", "kind": "row", "origin": "joint.yaml:1:1"},
        {
            "id": 3,
            "element": "coordinator.Mission",
            "kind": "region",
            "origin": "c.yaml:1:1",
            "leaves": MISSION,
            "transitions": ["home", "homed", "move", "arrived", "failed", "lost"],
        },
        {"id": 4, "element": "coordinator.command", "kind": "port", "origin": "c.yaml:2:1"},
    ]
    for index, axis in enumerate(axes):
        elements.append(
            {
                "id": 10 + 2 * index,
                "element": f"joint_{axis}.Motion",
                "kind": "region",
                "origin": "joint.yaml:43:7",
                "leaves": LEAVES,
                "transitions": ["start_homing"],
            }
        )
        elements.append(
            {
                "id": 11 + 2 * index,
                "element": f"joint_{axis}.feedback",
                "kind": "port",
                "origin": "joint.yaml:12:7",
            }
        )
    return json.dumps({"system": "Robot", "digest": "0" * 64, "elements": elements})
