# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The situation of a play as the page gets it: one JSON object, complete each time."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Any

from ravenchart.behaviour.interpreter.machine import InstanceRun
from ravenchart.behaviour.interpreter.observed import FiringReason, ObservedStep
from ravenchart.behaviour.interpreter.region import RegionRun
from ravenchart.behaviour.interpreter.traces import seconds
from ravenchart.behaviour.rules.outside import external_events
from ravenchart.gen.draw.picture import label
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import IntegerType, Ns, RecordType, Type, Value
from ravenchart.gen.model.instances import End

from .. import pictures
from .explained import occurrence, reason, value_text, with_value
from .session import Executed, Play

Json = dict[str, Any]

MOST_LINES = 200
"""Of the trace, the last ones."""


def play_view(play: Play) -> Json:
    """All that the page shows."""
    now, records = play.now, list(play.records())
    return {
        "number": play.number,
        "model": str(play.path),
        "system": play.system.name,
        "now": None if now.at is None else _time(now.at),
        "next": _time(play.next_release),
        "undo": play.undo_label,
        "redo": play.redo_label,
        "remark": now.remark,
        "warning": play.warning,
        "waiting": play.waiting(),
        "file": play.event_file(),
        "charts": list(_charts(play)),
        "instances": list(_instances(play)),
        "trace": [one.text() for one in islice(records, max(0, len(records) - MOST_LINES), None)],
        "left_out": max(0, len(records) - MOST_LINES),
    }


def _time(at: Ns) -> str:
    return f"{seconds(at)} s"


# --- Charts


def _charts(play: Play) -> Iterator[Json]:
    executed = dict(play.now.executed)
    for name, chart in play.charts.items():
        own = play.now.machine.instances[chart[0]]
        run = own.regions[chart[1]]
        last = executed.get(chart)
        yield {
            "name": name,
            "instance": chart[0],
            "drawing": f"{own.component.name}.{chart[1]}",
            "period": shown(run.region.timing.period),
            "active": [one for one in (*run.tree.states, *run.tree.kinds) if run.is_active(one)],
            "stopped": run.stopped,
            "queue": [with_value(one.event, one.value) for one in run.queue],
            "depth": run.region.queue_depth,
            "deferred": [with_value(k.happened.event, k.happened.value) for k in run.deferred],
            "timers": list(_timers(run)),
            "last": None if last is None else _last(last, run),
        }


def _timers(run: RegionRun) -> Iterator[Json]:
    """The running time-outs, the next one first."""
    for name, due in sorted(run.timers.items(), key=lambda one: one[1]):
        yield {
            "transition": name,
            "left": shown(max(0, due - run.executions) * run.region.timing.period),
        }


def _last(executed: Executed, run: RegionRun) -> Json:
    """The last execution of a chart, and the transitions and segments that it took."""
    ends = ".effect"
    taken = {one for step in executed.steps for one in step.behaviours if one.endswith(ends)}
    names = [t.name for t in run.region.transitions if f"{t.name}{ends}" in taken]
    return {
        "at": _time(executed.at),
        "taken": names,
        "steps": [_step(step, run) for step in executed.steps],
    }


def _step(step: ObservedStep, run: RegionRun) -> Json:
    return {
        "occurrence": occurrence(step),
        "behaviours": list(step.behaviours),
        "deferring": list(step.deferring),
        "sent": [f"{port} = {value_text(value)}" for port, value in step.sent],
        "raised": [with_value(event, value) for event, value in step.raised],
        "lost": step.lost,
        "verdicts": [
            {
                "transition": one.transition.name,
                "source": one.transition.source,
                "target": one.transition.target,
                "label": label(one.transition).text,
                "fired": one.reason is FiringReason.FIRED,
                "reason": reason(one, run.region.timing.period),
            }
            for one in step.verdicts
        ],
    }


def arrows(play: Play, drawing: str) -> Json:
    """Of each transition of a chart, which groups of its drawing show it, with their lines."""
    for name, region in play.charts.values():
        own = play.now.machine.instances[name]
        if f"{own.component.name}.{region}" == drawing:
            return pictures.arrows(own.regions[region].region)
    return {}


# --- Instances


def _instances(play: Play) -> Iterator[Json]:
    fed = {connection.target for connection in play.system.connections}
    for name, run in play.now.machine.instances.items():
        component = run.component
        told = external_events(component, play.system)
        outside = {event for event, row in told if row not in component.handlers()}
        yield {
            "name": name,
            "component": component.name,
            "events": [
                {"name": one.name, "type": _type(one.type), "outside": one.name in outside}
                for one in component.events
            ],
            "ports": [
                {
                    "name": one.name,
                    "type": _type(one.type),
                    "outside": End(name, one.name) not in fed,
                    **_port(run, one.name),
                }
                for one in component.inputs()
            ],
            "data": [{"name": one, "value": value_text(value)} for one, value in run.data.items()],
            "parameters": [
                {"name": one, "value": value_text(value)} for one, value in run.parameters.items()
            ],
        }


def _port(run: InstanceRun, name: str) -> Json:
    """The reading of a port, and the values that wait in its mailbox."""
    reading, box = run.ports[name], run.mailboxes[name]
    waiting: list[Value] = box.coming()
    return {
        "state": reading.state.replace("_", " "),
        "value": value_text(reading.value),
        "age": reading.age,
        "waiting": [value_text(one) for one in waiting],
    }


def _type(of: Type | None) -> Json | None:
    """The values that a type allows."""
    if of is None:
        return None
    if isinstance(of, RecordType):
        fields = [{"name": one.name, "type": _type(one.type)} for one in of.fields]
        return {"kind": "record", "name": of.name, "fields": fields}
    if isinstance(of, IntegerType):
        numbers = {"first": of.first, "last": of.last, "unit": of.unit}
        return {"kind": "integer", "name": of.name} | numbers
    return {"kind": "enumeration", "name": of.name, "literals": list(of.literals)}
