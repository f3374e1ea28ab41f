# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Random charts of a given size, as models: what the proof's growth is measured on.

Hierarchy, events, entry and exit actions; valid by construction, from the seed alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from random import Random

import yaml

Json = dict[str, object]

DEEPEST = 5
TRANSITIONS_PER_LEAF = 2.5
EVENTS = 8
"""Leaves and composites have events of their own: nothing is hidden by an inner transition."""


@dataclass(slots=True)
class _Chart:
    """The states drawn so far."""

    rng: Random
    leaves: list[str] = field(default_factory=list)
    composites: list[str] = field(default_factory=list)

    def grow(self, leaves: int, depth: int) -> Json:
        """States below one parent that hold so many leaves."""
        states: Json = {}
        while leaves:
            size = self._size(leaves, depth)
            leaves -= size
            if size == 1:
                name = f"L{len(self.leaves) + 1}"
                self.leaves.append(name)
                states[name] = self._actions()
            else:
                name = f"C{len(self.composites) + 1}"
                self.composites.append(name)
                inside = self.grow(size, depth + 1)
                states[name] = {**self._actions(), "initial": next(iter(inside)), "states": inside}
        return states

    def _size(self, leaves: int, depth: int) -> int:
        """Leaves of the next child: one, or a composite with a part of them."""
        if depth == DEEPEST or leaves < 3 or self.rng.random() < 0.3:
            return 1
        return self.rng.randint(2, max(2, leaves // 2))

    def _actions(self) -> Json:
        count = [{"set": "count", "to": "min(count + 1, 100)"}]
        kind = self.rng.choice(("entry", "exit", None))
        return {kind: count} if kind else {}

    def transitions(self) -> Json:
        """Every leaf is reached from an earlier one; the rest is drawn freely."""
        taken: set[tuple[str, str]] = set()
        found: Json = {}
        wanted = round(TRANSITIONS_PER_LEAF * len(self.leaves))
        for index in range(1, len(self.leaves)):
            early = self.leaves[max(0, index - 4) : index]
            self._add(found, taken, early, self.leaves[index])
        while len(found) < wanted:
            sources = self.leaves if self.rng.random() < 0.7 else self.composites or self.leaves
            self._add(found, taken, sources, self.rng.choice(self.leaves + self.composites))
        return found

    def _add(
        self, found: Json, taken: set[tuple[str, str]], sources: list[str], target: str
    ) -> None:
        """One more transition from one of these states, on an event that it does not have yet."""
        letter = "E" if sources[0].startswith("L") else "F"
        free = [
            (s, f"{letter}{n}")
            for s in sources
            for n in range(1, EVENTS + 1)
            if (s, f"{letter}{n}") not in taken
        ]
        if not free:
            return
        source, event = self.rng.choice(free)
        taken.add((source, event))
        found[f"T{len(found) + 1}"] = {"from": source, "to": target, "on": event}


def random_model(leaves: int, seed: int) -> str:
    """A system of one region of so many leaf states."""
    chart = _Chart(Random(f"{seed} {leaves}"))
    states = chart.grow(leaves, 1)
    transitions = chart.transitions()
    used = {str(t["on"]) for t in transitions.values() if isinstance(t, dict)}
    region = {
        "period": "10 ms",
        "wcet": "100 us",
        "queue": 4,
        "initial": next(iter(states)),
        "states": states,
        "transitions": transitions,
    }
    model = {
        "system": f"Random_{leaves}",
        "types": {"Count": {"range": [0, 100]}},
        "components": {
            "Unit": {
                "events": sorted(used),
                "data": {"count": {"type": "Count", "initial": 0}},
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
