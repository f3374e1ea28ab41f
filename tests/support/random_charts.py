# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Random charts as models, valid by construction, and random stimuli for them.

A chart is drawn from its seed alone, so it is the same in every model that holds
it: many charts can be compiled as the components of one system.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from random import Random

import yaml

from tests.support.random_regions import (
    MOST,
    PLAIN_EVENTS,
    RANGES,
    SMALL,
    VALUED_EVENTS,
    Chart,
    Json,
)

REGIONS = ("Alpha", "Beta", "Gamma")


def component_name(seed: int) -> str:
    """The component of a seed."""
    return f"Chart_{seed}"


def instance_name(seed: int) -> str:
    """Its one instance."""
    return f"unit_{seed}"


def component_of(seed: int) -> Json:
    """A component of one to three charts, and perhaps a do activity."""
    rng = Random(seed)
    charts = []
    for name in REGIONS[: rng.choice((1, 1, 1, 2, 3))]:
        letter = name[0].lower()
        charts.append(Chart(name, rng, (f"{letter}_one", f"{letter}_two"), f"{letter}_flag"))
    for chart in charts:
        chart.readable = [item for other in charts for item in other.data]
        chart.elsewhere = [
            f"{other.name}.{vertex.name}"
            for other in charts
            if other is not chart
            for vertex in other.states()
        ]
        chart.connect()
    events: Json = {name: {} for name in PLAIN_EVENTS}
    events |= {name: {"type": of_type} for name, of_type in VALUED_EVENTS.items()}
    events["Ring"] = {"overflow": "drop_oldest"}
    data: Json = {}
    for chart in charts:
        data |= {item: {"type": SMALL, "initial": rng.randint(0, MOST)} for item in chart.data}
        data[chart.flag] = {"type": "Boolean", "initial": rng.random() < 0.5}
    component: Json = {"events": events, "data": data}
    component["regions"] = {chart.name: chart.form() for chart in charts}
    workers = dict(_do_activities(charts, rng))
    if workers:
        component["activities"] = workers
    return component


def _do_activities(charts: Sequence[Chart], rng: Random) -> Iterator[tuple[str, Json]]:
    """A do activity that completes its state, for some states that have a completion transition."""
    for chart in charts:
        names = sorted(chart.completing & set(chart.vertices))
        if names and rng.random() < 0.4:
            reads = rng.choice(chart.data)
            yield (
                f"work_{chart.name.lower()}",
                {
                    "period": "10 ms",
                    "wcet": "1 us",
                    "while": f"{chart.name}.{rng.choice(names)}",
                    "body": [{"if": f"{reads} > 2", "then": [{"raise": "done"}]}],
                },
            )


def model_of(seeds: Sequence[int]) -> str:
    """A system of the charts of these seeds, all in two tables."""
    components = {component_name(seed): component_of(seed) for seed in seeds}
    rows: dict[str, list[str]] = {"slow": [], "fast": []}
    for seed in seeds:
        component = components[component_name(seed)]
        for name, form in (component["regions"] | component.get("activities", {})).items():
            speed = "fast" if form["period"] == "5 ms" else "slow"
            rows[speed].append(f"{instance_name(seed)}.{name}")
    node = {"context_switch": "1 us", "critical_section": "1 us"}
    model = {
        "system": "Random_Charts",
        "types": {name: {"range": list(ends)} for name, ends in RANGES.items()},
        "components": components,
        "nodes": {"board": node},
        "instances": {
            instance_name(seed): {"component": component_name(seed), "node": "board"}
            for seed in seeds
        },
        "processors": {
            name: {"node": "board", "stack": "32 KiB", "activities": activities}
            for name, activities in rows.items()
            if activities
        },
    }
    return yaml.safe_dump(model, sort_keys=False)


def events_of(seed: int, seeds: Sequence[int], milliseconds: int = 400) -> str:
    """Random events for the instances of a system of charts, as an events file."""
    rng = Random(seed)
    entries: list[tuple[int, int, Json]] = []
    for index, chart in enumerate(seeds):
        for _ in range(milliseconds // 8):
            event = rng.choice((*PLAIN_EVENTS, *VALUED_EVENTS))
            at = rng.randrange(0, milliseconds)
            entry: Json = {"at": f"{at} ms", "raise": f"{instance_name(chart)}.{event}"}
            if event in VALUED_EVENTS:
                entry["with"] = rng.randint(*RANGES[VALUED_EVENTS[event]])
            entries.append((at, index, entry))
    entries.sort(key=lambda one: one[:2])
    made = [entry for _, _, entry in entries]
    return yaml.safe_dump([*made, {"until": f"{milliseconds} ms"}], sort_keys=False)
