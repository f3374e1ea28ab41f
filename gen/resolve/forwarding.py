# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Activities that forward: each request of their interface becomes a call of a required command.

So a task stands before a device, or before another task, under an interface of its own.
"""

from __future__ import annotations

from dataclasses import replace

from ravenchart.gen.files.schema import ActivityForm, ComponentForm
from ravenchart.gen.language.names import Findings
from ravenchart.gen.model.commands import Provided, Request
from ravenchart.gen.model.component import Activity, Component

TIMES = ("period", "wcet", "deadline", "body")
"""The keys of an activity that forwards: its interface says all else."""

INCOMPLETE = "RV-1209"
"""A provided interface is incomplete, or answers a command in the wrong way."""


def only_forwards(name: str, form: ActivityForm, findings: Findings) -> None:
    """An activity that forwards has no keys of its own beside its times."""
    for field, info in type(form).model_fields.items():
        key = info.alias or field
        if key not in TIMES and form.has(field):
            message = f"{name} forwards requests, so `{key}` has no meaning"
            hint = "remove it; its calls are those of the interface that it serves"
            findings.error("RV-0210", form.at_key(key), message, hint=hint)


def forwarding(form: ComponentForm, component: Component, findings: Findings) -> Component:
    """The component with the calls of the activities that forward."""
    if form.lost("provides") or form.dropped("provides"):
        return component  # who serves what was lost is not known
    made = (_calling(component, one, findings) for one in component.activities)
    return replace(component, activities=tuple(made))


def _calling(component: Component, activity: Activity, findings: Findings) -> Activity:
    if not activity.forwards:
        return activity
    served = component.served_by(activity.name)
    if served is None:
        message = f"{activity.name} forwards requests, but serves no interface"
        hint = f"give an interface under `provides` the key `served_by: {activity.name}`"
        findings.error(INCOMPLETE, activity.origin, message, hint=hint)
        return activity
    for request in served.requests:
        _has_a_need(component, activity, served, request, findings)
    return replace(activity, sends=tuple(request.name for request in served.requests))


def _has_a_need(
    component: Component,
    activity: Activity,
    served: Provided,
    request: Request,
    findings: Findings,
) -> None:
    """The component requires the command of a request, for as many axes."""
    told = f"{activity.name} forwards {request.name} of {served.name}"
    need = next((one for one in component.needs if one.name == request.name), None)
    if need is None:
        message = f"{told}, but {component.name} requires no {request.name}"
        hint = "name it under `commands` of a required interface"
        findings.error(INCOMPLETE, served.origin, message, hint=hint)
        return
    notes = [(need.origin, f"{need.interface} requires it here")]
    if need.optional:
        message = f"{told}, which it may not have"
        hint = "remove `else`: what is forwarded has a provider"
        findings.error(INCOMPLETE, served.origin, message, notes=notes, hint=hint)
    ends = ((need.argument, request.argument), (need.reply, request.reply))
    if any(theirs is not own for theirs, own in ends):
        here, there = _axes(served.axes), _axes(need.axes)
        message = f"{told}, which has {here}, to {need.interface}, which has {there}"
        hint = "give both interfaces the same `axes`"
        findings.error(INCOMPLETE, served.origin, message, notes=notes, hint=hint)


def _axes(count: int) -> str:
    return "one axis" if count == 1 else f"{count} axes"
