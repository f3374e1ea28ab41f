# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The provider of each required command, and its consequences for the system.

Everything is decided here: the program does not test which providers there are. A fallback that
no binding needs is left out, with its row and its data.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from ravenchart.gen.derive.calls import awaited
from ravenchart.gen.derive.completion import table_period
from ravenchart.gen.files.schema_devices import AnyBindingForm, BindingForm
from ravenchart.gen.language.names import Findings, NameScope, meant
from ravenchart.gen.language.quantities import LONGEST
from ravenchart.gen.language.terms import Ns, Type
from ravenchart.gen.model.commands import (
    Binding,
    Device,
    DriverCommand,
    Gathered,
    Need,
    Poll,
    Server,
    wcet_of,
)
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.instances import Connection, End, Instance
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Processor, Slot, System

from .devices import (
    Array,
    Devices,
    Provider,
    Report,
    found_in,
    has_tasks,
    lacking,
    offered,
    provided_axes,
    provider_name,
    tells,
    told_by,
    ungathered,
)
from .interfaces import at_axes
from .paths import DeploymentNames, outermost, owner_at, reached, split
from .placing import bus_between


@dataclass(frozen=True, slots=True)
class GivenBinding:
    """A binding as the model gives it."""

    form: AnyBindingForm
    provider: Provider | None
    """None: it was wrong."""
    bus: str | None = None
    """The bus that it names for what travels between nodes, of several."""


Given = dict[tuple[str, str], GivenBinding]
"""The binding of (instance, interface), in lower case."""


def given_bindings(forms: Iterable[BindingForm], devices: Devices, site: DeploymentNames) -> Given:
    """The bindings of a model, by what they bind."""
    findings, found = devices.findings, Given()
    for form in forms:
        at = form.at("from")
        pair = split(form.from_, "instance.interface", at, devices.owners, findings)
        if pair is None:
            continue
        owner = owner_at(pair[0], at, devices.owners, findings)
        provider = devices.bound_to(form)
        bus = bus_between(form, site)
        if owner is None or not reached(owner, at, "interface", findings):
            continue
        required = devices.required(owner).look_up(pair[1], at, findings)
        if required is None:
            continue
        for instance, name in required.requirers:
            key = (instance.lower(), name.lower())
            if key in found:
                message = f"{owner.name}.{required.name} is bound twice"
                notes = [(found[key].form.origin, "the first is here")]
                hint = "several devices are joined to one by `facade` or `array`"
                findings.error("RV-1203", form.origin, message, notes=notes, hint=hint)
            found.setdefault(key, GivenBinding(form, provider, bus))
    for one in outermost(devices.owners):
        for inner in (binding.under(one.name) for binding in one.composite.bindings):
            key = (inner.instance.lower(), inner.interface.lower())
            found.setdefault(key, GivenBinding(inner.form, Server(*inner.server)))
    return found


def bindings_of(
    instances: Iterable[Instance],
    given: Given,
    known: Sequence[str],
    types: NameScope[Type],
    findings: Findings,
) -> tuple[Binding, ...]:
    """The binding of each command that an instance requires."""
    made: list[Binding] = []
    for one in given.values():
        form, provider = one.form, one.provider
        if provider is not None and form.has("time_limit") and not has_tasks(provider):
            message = (
                f"`time_limit` has no meaning for {provider_name(provider)}, which has no task"
            )
            hint = "remove it: a device is called directly"
            findings.error("RV-1214", form.at_key("time_limit"), message, hint=hint)
    for instance in instances:
        unbound: set[str] = set()
        uneven: set[tuple[str, str]] = set()
        for need in instance.component.needs:
            key = (instance.name.lower(), need.interface.lower())
            if key in given:
                one = given[key]
                if one.provider is not None:
                    found = _provider_of(instance, need, one, one.provider, uneven, findings)
                    made += _bound(instance, need, one, found, types)
            elif need.optional:
                made.append(Binding(instance.name, need.origin, need, None))
            elif need.interface not in unbound:
                unbound.add(need.interface)
                wanted, at = instance.outside(need.interface)
                message = f"nothing provides {wanted}, which needs {need.name}"
                notes = [(need.origin, f"{need.name} is required here")]
                hint = _binding(wanted)
                if near := meant(need.interface, known):
                    hint += f"; {near}"
                findings.error("RV-1203", at, message, notes=notes, hint=hint)
    return tuple(made)


def _binding(wanted: str) -> str:
    """How to bind an unbound interface, in the model or in the composite around it."""
    *around, instance, interface = wanted.split(".")
    where = f" of the component of {'.'.join(around)}" if around else ""
    return f"add `- {{from: {instance}.{interface}, to: ...}}` under `bindings:`{where}"


def event_wires(
    instances: Iterable[Instance], given: Given, findings: Findings
) -> tuple[tuple[Connection, ...], tuple[Poll, ...]]:
    """The connections and polls that bring the events of required interfaces.

    An event of a task comes by a connection of the ports on both sides; a device is polled.
    """
    made: list[Connection] = []
    polls: list[Poll] = []
    for instance in instances:
        for heard in instance.component.hears:
            wanted, at = instance.outside(heard.interface)
            one = given.get((instance.name.lower(), heard.interface.lower()))
            needed = any(
                need.interface == heard.interface and not need.optional
                for need in instance.component.needs
            )
            if one is None and not needed:
                message = f"nothing provides {wanted}, which requires the event {heard.name}"
                notes = [(heard.origin, f"{heard.name} is required here")]
                hint = _binding(wanted)
                findings.error("RV-1203", at, message, notes=notes, hint=hint)
            elif one is not None and one.provider is not None:
                form, provider = one.form, one.provider
                told = tells(provider, heard.name)
                notes = [(heard.origin, f"{heard.name} is required here")]
                if not told:
                    message = (
                        f"{provider_name(provider)} does not provide the event {heard.name}, which "
                        f"{instance.name} requires"
                    )
                    near = meant(heard.name, told_by(provider))
                    near = near or "provide it by `events`, or by `provides` of a device type"
                    findings.error("RV-1204", form.at("to"), message, notes=notes, hint=near)
                elif len(told) > 1:
                    first, second = (provider_name(teller) for teller, _ in told[:2])
                    message = (
                        f"{first} and {second} of {provider_name(provider)} both raise {heard.name}"
                    )
                    hint = f"say which is meant: `choose: {{{heard.name}: {first}}}`"
                    findings.error("RV-1212", form.at("to"), message, notes=notes, hint=hint)
                else:
                    ((teller, event),) = told
                    at = form.origin
                    if isinstance(event, DriverCommand):
                        assert isinstance(teller, Device)
                        poll = Poll(at, teller, event.name, instance.name, heard.port)
                        polls.append(poll)
                        _check_type(poll, event, instance, form, findings)
                    else:
                        assert isinstance(teller, Server)
                        source = End(teller.instance, event.port)
                        made.append(Connection(at, source, End(instance.name, heard.port), one.bus))
    return tuple(made), tuple(polls)


def _check_type(
    poll: Poll, event: DriverCommand, instance: Instance, form: AnyBindingForm, findings: Findings
) -> None:
    """Report an event of a device that has another number of axes than who hears it."""
    taken = instance.component.port(poll.port).type
    if event.argument is not None and event.argument != taken:
        message = (
            f"{event.name} of {poll.device.name} carries {event.argument.name}, but "
            f"{instance.name}.{poll.port} takes {taken.name}"
        )
        findings.error("RV-1205", form.at("to"), message, hint="change `axes` of one of them")


def _provider_of(
    instance: Instance,
    need: Need,
    given: GivenBinding,
    provider: Provider,
    uneven: set[tuple[str, str]],
    findings: Findings,
) -> Device | Server | Array | None:
    """The provider of one command; an error where it has neither provider nor fallback.

    ``uneven`` has the interfaces and providers whose different axes were reported.
    """
    at, notes = given.form.at("to"), [(need.origin, f"{need.name} is required here")]

    def report(code: str, message: str, hint: str | None) -> None:
        findings.error(code, at, message, notes=notes, hint=hint)

    found = found_in(provider, need.name, report)
    own = provider_name(provider)
    array = ungathered(provider, need.name)
    if isinstance(found, Array) and need.reply is not None and not need.command.per_axis:
        found, array = None, found
    if found is None and not need.optional:
        if array is not None:
            message = f"{array.name} cannot give {need.name} as one: its reply is not per axis"
            hint = "bind to one of its members, or join them by `facade`"
            if isinstance(array, Array):
                hint = f"declare {need.name} with `per_axis: true`, or bind to one of its elements"
            report("RV-1213", message, hint)
        elif without := lacking(provider, need.name):
            message = f"{without[0]}, an element of {own}, does not provide {need.name}"
            hint = f"provide it there, or take {without[0]} out of the array"
            report("RV-1204", message, hint)
        else:
            message = f"{own} does not provide {need.name}, which {instance.name} requires"
            near = meant(need.name, offered(provider))
            hint = near or "provide it, or name a fallback: `else: ...`"
            report("RV-1204", message, hint)
    if found is not None and need.command.per_axis:
        axes = provided_axes(found)
        name, user = provider_name(found), f"{instance.name}.{need.interface}"
        if axes != need.axes and (need.interface, name) not in uneven:
            uneven.add((need.interface, name))
            message = f"{name} has {_axes(axes)}, but {user} works on {need.axes}"
            hint = "join devices by `array`, or change `axes`"
            if isinstance(found, Array):
                hint = "let the array have an element for each axis, or change `axes`"
            report("RV-1205", message, hint)
    if isinstance(found, Array):
        _check_parts(instance, need, found, report)
    return found


def _check_parts(instance: Instance, need: Need, array: Array, report: Report) -> None:
    """The calls of the elements have names of their own, and replies of one type."""
    component = instance.component
    known = {port.name.lower() for port in component.ports}
    known |= {item.name.lower() for item in component.data}
    clash = next((name for name in _parts_of(need, array) if name.lower() in known), None)
    if clash is not None:
        message = f"`{clash}`, a call of one element of {array.name}, is a name of {component.name}"
        report("RV-0303", message, "rename it there")
    axes = sorted({provided_axes(part) for part in array.members})
    waits = not need.is_read and need.reply is not None and awaited(component, need)
    if waits and len(axes) > 1:
        message = (
            f"{array.name} cannot give the reply of {need.name} as one: it has elements with "
            f"{_axes(axes[0])} and elements with {_axes(axes[-1])}"
        )
        report("RV-1213", message, "join elements with the same number of axes")


def _parts_of(need: Need, array: Array) -> tuple[str, ...]:
    """The names of a command for each element of an array."""
    return tuple(f"{need.name}_{number}" for number in range(1, len(array.members) + 1))


def _bound(
    instance: Instance,
    need: Need,
    given: GivenBinding,
    found: Device | Server | Array | None,
    types: NameScope[Type],
) -> Iterator[Binding]:
    """The binding of one command; where an array provides it, those of its elements follow."""
    form = given.form
    limit = LONGEST if form.lost("time_limit") else form.time_limit
    made = Binding(
        instance.name,
        form.origin,
        need,
        None if isinstance(found, Array) else found,
        None if limit is None else Ns(limit),
        given.bus,
    )
    if not isinstance(found, Array):
        yield made
        return
    names = _parts_of(need, found)
    yield replace(made, provider=Gathered(found.name, names))
    for name, part in zip(names, found.members, strict=True):
        assert isinstance(part, Device | Server)
        axes = provided_axes(part)
        argument, reply = at_axes(need.command, axes, types)
        own = replace(need, name=name, axes=axes, argument=argument, reply=reply, fallback=None)
        yield replace(made, need=own, provider=part)


def _axes(count: int) -> str:
    return "1 axis" if count == 1 else f"{count} axes"


# --- What follows ------------------------------------------------------------------


def with_bindings(system: System, bindings: tuple[Binding, ...], polls: tuple[Poll, ...]) -> System:
    """The system with its bindings: without idle fallbacks, with calls in the WCETs."""
    of: defaultdict[str, list[Binding]] = defaultdict(list)
    for binding in bindings:
        of[binding.instance].append(binding)
    if not of and not polls:
        return system
    instances = tuple(
        replace(one, component=_pruned(one.component, of[one.name])) for one in system.instances
    )
    kept = {i.name: {*_rows(i.component)} for i in instances}
    added = {i.name: _times_of_calls(i.component, of[i.name]) for i in instances}
    for poll in polls:
        row = system.instance(poll.instance).component.handler(poll.port)
        added[poll.instance][row] = Ns(added[poll.instance].get(row, Ns(0)) + poll.wcet)
    processors = (_of_kept(one, kept, added) for one in system.processors)
    used = [b.provider for b in bindings if isinstance(b.provider, Device)]
    used += [poll.device for poll in polls]
    return replace(
        system,
        components=tuple(_in_use(one, instances) for one in system.components),
        instances=instances,
        processors=tuple(one for one in processors if one.slots),
        devices=tuple(dict.fromkeys(part for device in used for part in _parts(device))),
        bindings=bindings,
        polls=polls,
    )


def _rows(component: Component) -> Iterator[str]:
    yield from (*component.handlers(), *(row.name for row in component.runnables()))


def _parts(device: Device) -> tuple[Device, ...]:
    """A device behind the pieces that it is made of."""
    return (*(part for member in device.members for part in _parts(member)), device)


def _pruned(component: Component, bindings: Iterable[Binding]) -> Component:
    """A component as an instance has it: without the fallbacks that no binding needs."""
    idle = {
        b.need.fallback.activity for b in bindings if b.need.fallback and b.provider is not None
    }
    idle -= {b.need.fallback.activity for b in bindings if b.need.fallback and b.provider is None}
    gone = {item for a in component.activities if a.name in idle for item in a.writes}
    return replace(
        component,
        activities=tuple(a for a in component.activities if a.name not in idle),
        data=tuple(data for data in component.data if data.name not in gone),
    )


def _in_use(component: Component, instances: Iterable[Instance]) -> Component:
    """A component with what any of its instances has."""
    own = [i.component for i in instances if i.component.name == component.name]
    if not own:
        return component
    activities = {a.name for one in own for a in one.activities}
    data = {item.name for one in own for item in one.data}
    return replace(
        component,
        activities=tuple(a for a in component.activities if a.name in activities),
        data=tuple(item for item in component.data if item.name in data),
    )


def _times_of_calls(component: Component, bindings: Sequence[Binding]) -> dict[str, Ns]:
    """The time that calls of devices add to the WCET of each row.

    A region reads once in an execution, and calls once in each of its steps; an activity that
    serves requests does both for each request.
    """
    found: dict[str, Ns] = {}
    for row in component.runnables():
        served = component.served_by(row.name)
        times = served.depth if served is not None else 1
        steps = row.steps_per_execution if isinstance(row, Region) else times
        found[row.name] = Ns(
            sum(
                wcet_of(b) * (times if b.need.is_read else steps)
                for b in bindings
                if b.need.command.name in (row.reads if b.need.is_read else row.sends)
            )
        )
    return found


def _of_kept(
    processor: Processor, kept: dict[str, set[str]], added: dict[str, dict[str, Ns]]
) -> Processor:
    """A processor with the rows that are left, and their calls in their WCETs."""
    left = [s for s in processor.slots if s.owner not in kept or s.name in kept[s.owner]]
    period = processor.period
    if left and period == table_period(processor.slots):
        period = table_period(left) or period
    slots = tuple(_with_calls(slot, added.get(slot.owner, {})) for slot in left)
    return replace(processor, period=period, slots=slots)


def _with_calls(slot: Slot, added: dict[str, Ns]) -> Slot:
    calls = added.get(slot.name, Ns(0))
    if not calls:
        return slot
    return replace(slot, timing=replace(slot.timing, wcet=Ns(slot.timing.wcet + calls)))
