# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Charts of many leaf states: what the growth of check, code and proof is measured on.

`large_chart` is a chain of blocks, one like the other. A block has ten leaf states: a
composite state, an orthogonal state of two regions, a deep history, a choice, guards over data,
and time-outs.
"""

from __future__ import annotations

import yaml

Json = dict[str, object]

BLOCK = 10
"""Leaf states of a block."""


def large_chart(blocks: int) -> str:
    """A system with one instance, of one region of so many blocks."""
    states: Json = {}
    transitions: Json = {}
    for number in range(1, blocks + 1):
        states |= _states(number)
        transitions |= _transitions(number, number % blocks + 1)
    events = ["Go", "Stop", "Turn", "Next", "Again"]
    return _system(f"Chart_{BLOCK * blocks}", "Block_1", states, transitions, events)


def _system(name: str, initial: str, states: Json, transitions: Json, events: list[str]) -> str:
    """One instance of one component with one region."""
    region = {
        "period": "10 ms",
        "wcet": "100 us",
        "queue": 4,
        "initial": initial,
        "states": states,
        "transitions": transitions,
    }
    model = {
        "system": name,
        "types": {"Count": {"range": [0, 100]}},
        "components": {
            "Unit": {
                "events": events,
                "data": {name: {"type": "Count", "initial": 0} for name in ("count", "level")},
                "regions": {"Motion": region},
            }
        },
        "nodes": {"board": {"context_switch": "1 us", "critical_section": "1 us"}},
        "instances": {"one": {"component": "Unit", "node": "board"}},
        "processors": {
            "runner": {"node": "board", "stack": "32 KiB", "activities": ["one.Motion"]}
        },
        "shutdown": {"raises": [], "grace": "0 ms"},
    }
    return yaml.safe_dump(model, sort_keys=False)


def _states(n: int) -> Json:
    return {
        f"Block_{n}": {
            "initial": f"Rest_{n}",
            "states": {
                f"Rest_{n}": {"exit": _counting()},
                f"Pair_{n}": {
                    "regions": {
                        f"{side}_{n}": {
                            "initial": f"{side}_A_{n}",
                            "states": {
                                f"{side}_A_{n}": {},
                                f"{side}_B_{n}": {"entry": _counting()},
                                f"{side}_C_{n}": {},
                            },
                        }
                        for side in ("Left", "Right")
                    }
                },
                f"Work_{n}": {
                    "initial": f"Slow_{n}",
                    "states": {f"Slow_{n}": {}, f"Fast_{n}": {"exit": _counting()}},
                },
                f"Done_{n}": {},
                f"Which_{n}": {"kind": "choice"},
                f"Last_{n}": {"kind": "deep_history"},
            },
        }
    }


def _counting() -> list[Json]:
    return [{"set": "count", "to": "min(count + 1, 100)"}]


def _transitions(n: int, following: int) -> Json:
    found: list[Json] = [
        {"from": f"Rest_{n}", "to": f"Pair_{n}", "on": "Go"},
        {"from": f"Rest_{n}", "to": f"Work_{n}", "on": "Turn", "guard": "count < 50"},
        {"from": f"Pair_{n}", "to": f"Which_{n}", "on": "Stop"},
        {"from": f"Which_{n}", "to": f"Work_{n}", "guard": "level > 20"},
        {"from": f"Which_{n}", "to": f"Done_{n}", "guard": "else"},
        {"from": f"Slow_{n}", "to": f"Fast_{n}", "after": "1 s", "effect": _level(n)},
        {"from": f"Fast_{n}", "to": f"Slow_{n}", "on": "Turn"},
        {"from": f"Work_{n}", "to": f"Done_{n}", "on": "Stop"},
        {"from": f"Done_{n}", "to": f"Rest_{n}", "after": "2 s"},
        {"from": f"Block_{n}", "to": f"Block_{following}", "on": "Next"},
        {"from": f"Block_{n}", "to": f"Last_{following}", "on": "Again"},
    ]
    for side, event in (("Left", "Turn"), ("Right", "Go")):
        found += [
            {"from": f"{side}_A_{n}", "to": f"{side}_B_{n}", "on": event},
            {"from": f"{side}_B_{n}", "to": f"{side}_C_{n}", "after": "500 ms"},
            {"from": f"{side}_C_{n}", "to": f"{side}_A_{n}", "on": event, "guard": "level < 90"},
        ]
    return {f"t{index}_of_{n}": form for index, form in enumerate(found, 1)}


def _level(n: int) -> list[Json]:
    return [{"set": "level", "to": f"max(count - {n % 10}, 0)"}]


def orthogonal_chart(count: int, leaves: int) -> str:
    """A system of one region: an orthogonal state of so many regions, each a ring of leaves.

    It has ``(leaves / count) ** count`` configurations.
    """
    regions: Json = {}
    transitions: Json = {}
    each = leaves // count
    for number in range(1, count + 1):
        names = [f"S{index}_of_{number}" for index in range(1, each + 1)]
        regions[f"Region_{number}"] = {"initial": names[0], "states": {name: {} for name in names}}
        for index, name in enumerate(names):
            following = names[(index + 1) % each]
            row: Json = {"from": name, "to": following, "on": f"Go_{number}"}
            if index % 3 == 2:
                row |= {"guard": f"count < {10 * number}", "effect": _counting()}
            transitions[f"go_{name}"] = row
            transitions[f"back_{name}"] = {"from": name, "to": names[0], "on": f"Back_{number}"}
    transitions["start"] = {"from": "Idle", "to": "Running", "on": "Start"}
    reset = [{"set": "count", "to": 0}]
    transitions["stop"] = {"from": "Running", "to": "Idle", "on": "Halt", "effect": reset}
    states: Json = {"Idle": {}, "Running": {"regions": regions}}
    events = ["Start", "Halt"]
    events += [f"{word}_{number}" for number in range(1, count + 1) for word in ("Go", "Back")]
    return _system(f"Regions_{leaves}", "Idle", states, transitions, events)
