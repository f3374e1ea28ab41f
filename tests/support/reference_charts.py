# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The charts of tests/reference/charts as models, and their traces as behaviours.

A label of a JSON chart stands for the behaviour that holds it: what the model
executes is told in labels again, so that it can be held against the trace.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

FOLDER = Path(__file__).parent.parent / "reference" / "charts"
NAMES = tuple(sorted(path.stem for path in FOLDER.glob("*.json")))

INSTANCE, REGION = "unit", "Subject"
SEEN = "seen"
"""A data item that an initial effect sets when it has labels only: it has to do something."""

Json = dict[str, Any]
NEVER = "on_never"
"""An event that does not come."""


def chart_of(name: str) -> Json:
    """One JSON file."""
    loaded: Json = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    return loaded


def event_name(name: str) -> str:
    """The event as the model calls it; some JSON events are reserved words."""
    return f"on_{name}"


# --- The model -----------------------------------------------------------------------


def model_of(case: Json) -> str:
    """The chart as a model with one instance; time counts in ms, executions too."""
    (top,) = case["chart"]["regions"]
    data = {name: {"type": "Number", "initial": v} for name, v in _variables(case).items()}
    region = {
        "period": "1 ms",
        "wcet": "10 us",
        "queue": 8,
        **({"deferred": 4} if "deferral" in case["features"] else {}),
        "steps": 16,
        **_region(top),
        "transitions": dict([*_transitions(top), *_ways(top)]),
    }
    component = {
        "events": [*(event_name(event) for event in case["chart"]["events"]), NEVER],
        "data": data,
        "regions": {REGION: region},
    }
    model = {
        "system": "Reference_Chart",
        "types": {"Number": {"range": [0, 1000]}},
        "components": {"Part": component},
        "nodes": {"board": {"context_switch": "1 us", "critical_section": "1 us"}},
        "instances": {INSTANCE: {"component": "Part", "node": "board"}},
        "processors": {
            "runner": {
                "node": "board",
                "stack": "32 KiB",
                "activities": [f"{INSTANCE}.{REGION}"],
            }
        },
    }
    return yaml.safe_dump(model, sort_keys=False)


def _variables(case: Json) -> Mapping[str, int]:
    return {**case["chart"].get("variables", {}), SEEN: 0}


def _region(region: Json) -> Json:
    states = {state["id"]: _state(state) for state in region["states"]}
    return {"initial": _initial(region["initial"]), "states": states}


def _initial(initial: Json) -> object:
    if not initial.get("effect"):
        return initial["target"]
    actions = _actions(initial["effect"]) or [{"set": SEEN, "to": f"min({SEEN} + 1, 1000)"}]
    return {"to": initial["target"], "effect": actions}


def _state(state: Json) -> Json:
    kind = state.get("kind", "state")
    if kind != "state":
        return {"kind": {"shallow_history": "history"}.get(kind, kind)}
    made: Json = {key: _actions(state[key]) for key in ("entry", "exit") if key in state}
    made = {key: actions for key, actions in made.items() if actions}
    if "defer" in state:
        made["defer"] = [event_name(event) for event in state["defer"]]
    regions = state.get("regions", [])
    if len(regions) == 1:
        made |= _region(regions[0])
    elif regions:
        made["regions"] = {region["name"]: _region(region) for region in regions}
    return made


def _actions(behaviour: Iterable[str | Json]) -> list[Json]:
    """The actions of a behaviour without its labels."""
    made: list[Json] = []
    for item in behaviour:
        match item:
            case {"set": name, "to": value}:
                made.append({"set": name, "to": value})
            case {"raise": event}:
                made.append({"raise": event_name(event)})
    return made


def _transitions(region: Json) -> Iterator[tuple[str, Json]]:
    for transition in _all(region):
        made: Json = {"from": transition["source"], "to": transition["target"]}
        if transition["kind"] == "internal":
            del made["to"]
        if transition["kind"] == "local":
            made["local"] = True
        if transition["event"] is not None:
            made["on"] = event_name(transition["event"])
        if "after" in transition:
            made["after"] = f"{transition['after']} ms"
        if "guard" in transition:
            made["guard"] = transition["guard"].replace("==", "=").replace("!=", "/=")
        if actions := _actions(transition.get("effect", [])):
            made["effect"] = actions
        yield transition["id"], made


def _ways(top: Json) -> Iterator[tuple[str, Json]]:
    """A way to every state: a model may hold none that is never reached."""
    reached = {transition["target"] for transition in _all(top)}
    for region in (top, *_nested(top)):
        plain = [s["id"] for s in region["states"] if s.get("kind", "state") == "state"]
        for name in plain:
            others = [other for other in plain if other != name]
            if name not in reached and others:
                yield f"to_{name}", {"from": others[0], "to": name, "on": NEVER}


def _nested(region: Json) -> Iterator[Json]:
    for state in region["states"]:
        for nested in state.get("regions", []):
            yield nested
            yield from _nested(nested)


def _all(region: Json) -> Iterator[Json]:
    """The transitions of a region and of those inside it."""
    for one in (region, *_nested(region)):
        yield from one["transitions"]


# --- Events and traces -----------------------------------------------------------------


def events_of(case: Json) -> str:
    """The events as an events file: an ``advance`` of n is n ms, an event takes 1 ms."""
    now = 0
    entries: list[Json] = []
    for item in case["events"]:
        if isinstance(item, dict):
            now += item["advance"]
        else:
            now += 1
            entries.append({"at": f"{now} ms", "raise": f"{INSTANCE}.{event_name(item)}"})
    return yaml.safe_dump([*entries, {"until": f"{now} ms"}], sort_keys=False)


def labels_of(case: Json, behaviours: Sequence[str]) -> list[str]:
    """What the executed behaviours append to the trace of the JSON chart."""
    labels = dict(_labels(case["chart"]["regions"]))
    return [label for name in behaviours for label in labels.get(name, ())]


def _labels(regions: Iterable[Json], owner: str = REGION) -> Iterator[tuple[str, list[str]]]:
    """The labels of every behaviour, by the name that executions show it by."""
    several = list(regions)
    for region in several:
        shown = region["name"] if len(several) > 1 else owner
        yield f"initial({shown}).effect", _text(region["initial"].get("effect", []))
        for state in region["states"]:
            yield f"{state['id']}.entry", _text(state.get("entry", []))
            yield f"{state['id']}.exit", _text(state.get("exit", []))
            yield from _labels(state.get("regions", []), state["id"])
        for transition in region["transitions"]:
            yield f"{transition['id']}.effect", _text(transition.get("effect", []))


def _text(behaviour: Iterable[str | Json]) -> list[str]:
    return [item for item in behaviour if isinstance(item, str)]
