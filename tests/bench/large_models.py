# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Models of many regions, one like the other: what the growth of generation is measured on.

A region has a composite state, a guard, actions and a time-out: four leaf states and
six transitions.
"""

from __future__ import annotations

import yaml

Json = dict[str, object]


def large_model(components: int, regions: int = 1) -> str:
    """A system of so many component types of so many regions each, with one instance of each."""
    names = [f"Region_{n}" for n in range(1, regions + 1)]
    types = {f"unit_{n}": f"Unit_{n}_Type" for n in range(1, components + 1)}
    model = {
        "system": "Large",
        "types": {"Count": {"range": [0, 100]}},
        "components": {name: _component(names) for name in types.values()},
        "nodes": {"board": {"context_switch": "1 us", "critical_section": "1 us"}},
        "instances": {n: {"component": t, "node": "board"} for n, t in types.items()},
        "processors": {
            "runner": {
                "node": "board",
                "stack": "32 KiB",
                "activities": [f"{unit}.{name}" for unit in types for name in names],
            }
        },
    }
    return yaml.safe_dump(model, sort_keys=False)


def _component(regions: list[str]) -> Json:
    return {
        "events": ["Fault", "Reset"],
        "data": {_count(name): {"type": "Count", "initial": 0} for name in regions},
        "regions": {name: _region(_count(name)) for name in regions},
    }


def _count(region: str) -> str:
    return f"count_of_{region.lower()}"


def _region(count: str) -> Json:
    return {
        "period": "1 s",
        "wcet": "100 us",
        "queue": 4,
        "initial": "Idle",
        "states": {
            "Idle": {"exit": [{"set": count, "to": 0}]},
            "Working": {"initial": "Slow", "states": {"Slow": {}, "Fast": {}}},
            "Failed": {"entry": [{"raise": "Reset"}]},
        },
        "transitions": {
            "start": {"from": "Idle", "to": "Working", "after": "2 s"},
            "hurry": {
                "from": "Slow",
                "to": "Fast",
                "after": "1 s",
                "guard": f"{count} < 90",
                "effect": [{"set": count, "to": f"min({count} + 1, 100)"}],
            },
            "calm": {"from": "Fast", "to": "Slow", "when": f"{count} < 50"},
            "worry": {
                "from": "Fast",
                "to": "Slow",
                "after": "3 s",
                "effect": [{"raise": "Fault"}],
            },
            "fail": {"from": "Working", "to": "Failed", "on": "Fault"},
            "reset": {"from": "Failed", "to": "Idle", "on": "Reset"},
        },
    }
