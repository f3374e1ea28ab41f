# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Small systems for the tests of the interpreter, told in as few words as possible."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import yaml

from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.region import RegionRun
from ravenchart.behaviour.interpreter.stimuli import Stimuli, read_stimuli
from ravenchart.behaviour.interpreter.traces import StepRecord
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Shutdown, System
from tests.support.pump import loaded

Json = dict[str, Any]


class Plain(yaml.SafeLoader):
    """YAML as the model language has it: of the words, only true and false are no text."""


Plain.yaml_implicit_resolvers = {
    first: [rule for rule in rules if rule[0] != "tag:yaml.org,2002:bool"]
    for first, rules in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
Plain.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("(?:true|false)$"), ["t", "f"])


def plain(text: str) -> Any:
    """What a piece of a model says."""
    return yaml.load(text, Plain)


def system_of(text: str) -> System:
    """The system of a model, which must be valid."""
    result = loaded(text)
    assert result.system is not None, [f"{d.origin}: {d.message}" for d in result.diagnostics]
    return result.system


def raised_outside(system: System) -> System:
    """The system, told that any of its events may come from outside."""
    pairs = ((one.name, event.name) for one in system.instances for event in one.component.events)
    return replace(system, shutdown=Shutdown(tuple(pairs), Ns(0)))


def stimuli_of(text: str, system: System) -> Stimuli:
    """The stimuli of a file of events, which must be right."""
    stimuli, found = read_stimuli(text, "events.yaml", system)
    assert stimuli is not None, [f"{d.origin}: {d.message}" for d in found]
    return stimuli


def component_system(component: str, rows: str = "[unit.Main]", more: str = "{}") -> System:
    """A system with one instance ``unit`` of a component, all in one processor.

    Its types are Small (0 .. 9), Pair (left, right: Small) and Hue (Red, Green).
    ``more`` are further sections.
    """
    model: Json = {
        "system": "Interpreted",
        "types": {
            "Small": {"range": [0, 9]},
            "Pair": {"fields": {"left": "Small", "right": "Small"}},
            "Hue": {"values": ["Red", "Green"]},
        },
        "components": {"Part": plain(component)},
        "nodes": {"board": {"context_switch": "1 us", "critical_section": "1 us"}},
        "instances": {"unit": {"component": "Part", "node": "board"}},
        "processors": {"runner": {"node": "board", "stack": "8 KiB", "activities": plain(rows)}},
    }
    return system_of(yaml.safe_dump(model | plain(more), sort_keys=False))


def chart_system(chart: str) -> System:
    """A system of one region ``Main``, run every 10 ms.

    ``chart`` is the region; under ``data`` and ``events`` in it stand what the component
    declares, ``events`` only where there is more to say than a name.
    """
    region: Json = {"period": "10 ms", "wcet": "1 us", "queue": 4} | plain(chart)
    triggers = [t["on"] for t in region.get("transitions", {}).values() if "on" in t]
    events: Json = {name: {} for name in triggers} | region.pop("events", {})
    data = {
        name: {"type": "Small", "initial": value} for name, value in region.pop("data", {}).items()
    }
    if not triggers:
        del region["queue"]
    component = {"events": events, "data": data, "regions": {"Main": region}}
    return component_system(yaml.safe_dump(component, sort_keys=False))


def events_text(*events: str, until: int) -> str:
    """Events such as ``10 Go`` or ``10 Go 5`` (at 10 ms, with the value 5) as a file."""
    entries: list[Json] = []
    for event in events:
        at, name, *value = event.split()
        entry: Json = {"at": f"{at} ms", "raise": f"unit.{name}"}
        entries.append(entry | ({"with": int(value[0])} if value else {}))
    return yaml.safe_dump([*entries, {"until": f"{until} ms"}])


def records(system: System, *events: str, until: int = 100) -> Iterator[StepRecord]:
    """The steps of a system under some events."""
    return Machine(system).run(stimuli_of(events_text(*events, until=until), system))


def steps(chart: str, *events: str, until: int = 100) -> list[str]:
    """The steps of a chart as ``10 A.exit, go.effect, B.entry``; the number is the time in ms."""
    found = records(chart_system(chart), *events, until=until)
    return [f"{one.at // 10**6} {', '.join(one.behaviours)}" for one in found]


def run_of(chart: str, *events: str, until: int = 100) -> RegionRun:
    """The region of a chart after some events."""
    system = chart_system(chart)
    machine = Machine(system)
    list(machine.run(stimuli_of(events_text(*events, until=until), system)))
    return machine.instances["unit"].regions["Main"]
