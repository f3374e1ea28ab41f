# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Deployment resolved: nodes, buses, processors and chains."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from ravenchart.gen.derive.completion import table_deadline, table_period
from ravenchart.gen.files.schema_deployment import (
    ChainForm,
    InterruptForm,
    NodeForm,
    ProcessorForm,
    ShutdownForm,
    StreamForm,
    SupervisionForm,
)
from ravenchart.gen.files.schema_frames import (
    BusForm,
    DelayedForm,
    RequestedForm,
)
from ravenchart.gen.language.names import Findings, NameScope, meant
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import Bus, BusErrors, Message
from ravenchart.gen.model.component import PORTS
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.nodes import (
    SNAPSHOT_PERIOD,
    Interrupt,
    InterruptLine,
    MonitorStream,
    Node,
    Supervision,
    Tick,
)
from ravenchart.gen.model.statechart import Timing
from ravenchart.gen.model.system import (
    Carried,
    Chain,
    Processor,
    Shutdown,
    Slot,
    Stop,
    Work,
)
from ravenchart.gen.origins import Origin

from .components import timing_of
from .paths import DeploymentNames, event_at, member_of, split
from .releasers import releaser_of


def node_of(name: str, form: NodeForm, findings: Findings) -> Node:
    """A node, with the timing of its probe."""
    times = Ns(form.context_switch), Ns(form.critical_section)
    probe = None
    if form.probe is not None:
        probe = timing_of("the probe", form.probe, findings)
    tick = None
    if form.tick is not None:
        tick = Tick(Ns(form.tick.period), Ns(form.tick.wcet))
        if tick.wcet > tick.period:
            message = (
                f"the tick may take {shown(tick.wcet)}, longer than its period, "
                f"{shown(tick.period)}"
            )
            findings.error("RV-0703", form.tick.at("wcet"), message)
    return Node(
        name,
        form.origin,
        *times,
        form.trace,
        probe,
        Ns(form.release),
        tick,
        form.cores,
        _supervision(form.supervision, findings),
        _stream(form.stream, findings),
        tuple(_interrupt(key, one, findings) for key, one in (form.interrupts or {}).items()),
        form.database_name,
    )


def _interrupt(name: str, form: InterruptForm, findings: Findings) -> Interrupt:
    """An interrupt, which comes from somewhere on one target at least."""
    if form.signal is None and form.number is None and not form.damaged:
        message = f"the interrupt {name} has neither `signal` nor `number`"
        hint = "add `signal: SIGUSR1` for Linux, the `number` at a board, or both"
        findings.error("RV-0202", form.origin, message, hint=hint)
    return Interrupt(name, form.origin, form.signal, form.number, Ns(form.wcet))


def _stream(form: StreamForm | None, findings: Findings) -> MonitorStream | None:
    """The stream of a node; its work takes no longer than the period of the snapshots."""
    if form is None:
        return None
    if form.wcet > SNAPSHOT_PERIOD:
        message = (
            f"the stream may take {shown(Ns(form.wcet))}, longer than its period, "
            f"{shown(SNAPSHOT_PERIOD)}"
        )
        findings.error("RV-0703", form.at("wcet"), message)
    return MonitorStream(form.origin, Ns(form.wcet))


def _supervision(form: SupervisionForm | None, findings: Findings) -> Supervision | None:
    """The supervision of a node; a look takes no longer than its period."""
    if form is None:
        return None
    if form.wcet > form.period:
        message = (
            f"the supervision may take {shown(Ns(form.wcet))}, longer than its period, "
            f"{shown(Ns(form.period))}"
        )
        findings.error("RV-0703", form.at("wcet"), message)
    return Supervision(Ns(form.period), Ns(form.wcet), Ns(form.margin))


def bus_of(name: str, form: BusForm, findings: Findings) -> Bus:
    """A bus."""
    if form.data_rate is not None and form.data_rate < form.bit_rate:
        message = f"the data rate of {name} is below its bit rate"
        findings.error("RV-0613", form.at("data_rate"), message, hint="leave it out, or raise it")
    watch = None if form.watch is None else timing_of(f"{name}.watch", form.watch, findings)
    delayed = form.recovery if isinstance(form.recovery, DelayedForm) else None
    for key in ("on_error_passive", "on_bus_off", "on_recovered", "recovery"):
        needs = form.has(key) if key != "recovery" else delayed is not None
        if needs and watch is None and not form.lost("watch"):
            message = f"`{key}` of {name} needs the key `watch`: nothing looks at the controllers"
            hint = "add `watch: {period: ..., wcet: ...}`, and the row "
            hint += f"`{name}.watch` to a table of each node"
            findings.error("RV-0618", form.at_key(key), message, hint=hint)
    return Bus(
        name,
        form.origin,
        form.bit_rate,
        form.receive_depth,
        form.transmit_depth,
        Ns(form.driver_wcet),
        None if form.errors is None else BusErrors(Ns(form.errors.period), form.errors.burst),
        form.data_rate,
        by_priority=form.buffers == "priority",
        audsley=form.identifiers == "audsley",
        watch=watch,
        recovers_after=None if delayed is None else Ns(delayed.after),
    )


def with_events(bus: Bus, form: BusForm, site: DeploymentNames) -> tuple[Bus, bool]:
    """The bus with the events that it raises and is asked by, and whether all of them are sound."""
    lists: list[tuple[str, BusForm | RequestedForm, str, list[str] | None]] = [
        ("on_error_passive", form, "on_error_passive", form.on_error_passive),
        ("on_bus_off", form, "on_bus_off", form.on_bus_off),
        ("on_recovered", form, "on_recovered", form.on_recovered),
    ]
    if isinstance(form.recovery, RequestedForm):
        lists.append(("recovers_on", form.recovery, "on", form.recovery.on))
    found: dict[str, tuple[tuple[str, str], ...]] = {}
    whole = not form.lost("recovery")
    for name, holder, key, texts in lists:
        made = [
            event_at(text, holder.item_at(key, index), site)
            for index, text in enumerate(texts or ())
        ]
        found[name] = tuple(pair for pair in made if pair is not None)
        lost = holder.lost(key) or holder.list_damaged(key) or None in made
        whole = whole and not lost
    return (
        replace(
            bus,
            on_error_passive=found["on_error_passive"],
            on_bus_off=found["on_bus_off"],
            on_recovered=found["on_recovered"],
            recovers_on=found.get("recovers_on", ()),
        ),
        whole,
    )


def processor_of(name: str, form: ProcessorForm, site: DeploymentNames) -> Processor | None:
    """A processor with its table; divisors and priority are left to `derive`."""
    findings = site.findings
    node = None
    if form.node is not None:
        node = site.nodes.look_up(form.node, form.at("node"), findings)
    releaser = None
    if form.released_by is not None:
        releaser = releaser_of(form.released_by, form.at("released_by"), site)
        if form.period is None and not form.lost("period"):
            message = f"the sporadic processor {name} needs the key `period`"
            hint = "give the least time between two of its releases"
            findings.error("RV-0202", form.origin, message, hint=hint)
        if form.offset and form.has("offset"):
            message = "`offset` has no meaning for a sporadic processor"
            findings.error("RV-0210", form.at_key("offset"), message, hint="remove it")
        for key in ("logical_execution_time", "schedule", "phases"):
            if form.has(key):
                message = f"{name} is sporadic: it has no `{key}`"
                hint = "only releases by time are known beforehand: remove it"
                findings.error("RV-0210", form.at_key(key), message, hint=hint)
    slots = [
        _slot(text, form.item_at("activities", index), form, site)
        for index, text in enumerate(form.activities)
    ]
    misses, overruns, silences = (
        tuple(
            found
            for index, text in enumerate(given or ())
            if (found := event_at(text, form.item_at(key, index), site)) is not None
        )
        for key, given in (
            ("on_deadline_miss", form.on_deadline_miss),
            ("on_overrun", form.on_overrun),
            ("on_silence", form.on_silence),
        )
    )
    sound = tuple(slot for slot in slots if slot is not None)
    sound = _phased(name, form, sound, site)
    whole = len(sound) == len(slots) and not form.list_damaged("activities")
    own = [slot for slot in sound if slot.work is not Work.BUS_RECEIVE]
    cyclic = form.schedule is not None and form.released_by is None
    period = table_period(own, cyclic=cyclic) if form.period is None else Ns(form.period)
    if (node is None) != (form.node is None) or period is None or not (node or sound):
        return None
    if form.lost("node") or form.lost("period") or form.lost("released_by"):
        return None
    if form.released_by is not None and releaser is None:
        return None
    if form.deadline is not None and form.deadline > period and whole:
        message = f"the deadline of {name} is longer than its period"
        findings.error("RV-0703", form.at("deadline"), message)
    shortest = table_deadline(sound, period)
    if form.logical_execution_time is not None and form.released_by is None and whole:
        shortest = min(shortest, _logical(name, form, period, findings))
    deadline = shortest if form.deadline is None else min(Ns(form.deadline), shortest)
    return Processor(
        name=name,
        origin=form.origin,
        node=_home(node, releaser),
        period=period,
        offset=Ns(form.offset),
        deadline=deadline,
        priority=form.priority or 0,
        stack_bytes=form.stack,
        released_by=releaser,
        slots=sound,
        on_deadline_miss=misses,
        on_overrun=overruns,
        core=form.core,
        on_silence=silences,
        released_at=None if releaser is None else form.at("released_by"),
        cyclic=cyclic,
        logical=None if form.logical_execution_time is None else Ns(form.logical_execution_time),
    )


def _home(node: Node | None, releaser: object) -> str:
    """The node of a processor: the given one, or that of the interrupt; else that of its rows."""
    if node is not None:
        return node.name
    return releaser.node if isinstance(releaser, InterruptLine) else ""


def _phased(
    name: str, form: ProcessorForm, slots: tuple[Slot, ...], site: DeploymentNames
) -> tuple[Slot, ...]:
    """The rows of a table with the phases that the processor gives."""
    if form.released_by is not None:
        return slots
    given: dict[str, tuple[Ns, Origin]] = {}
    rows = {slot.element for slot in slots}
    for text, phase in (form.phases or {}).items():
        at = form.entry_at("phases", text)
        named_row = _slot(text, at, form, site)
        if named_row is None:
            continue
        element = named_row.element
        if element in given:
            message = f"`phases` of {name} names {element} twice"
            notes = [(given[element][1], "the first is here")]
            site.findings.error("RV-0303", at, message, notes=notes, hint="remove one of them")
        elif element not in rows:
            message = f"`phases` of {name} names {element}, which is no row of its table"
            if not form.list_damaged("activities"):
                hint = meant(text, rows) or "name a row of its table as `instance.row`"
                site.findings.error("RV-0305", at, message, hint=hint)
        else:
            given[element] = Ns(phase), at
    return tuple(
        replace(slot, after=given[slot.element][0], placed_at=given[slot.element][1])
        if slot.element in given
        else slot
        for slot in slots
    )


def _logical(name: str, form: ProcessorForm, period: Ns, findings: Findings) -> Ns:
    """The logical execution time of a processor, which no deadline of it exceeds."""
    given = Ns(form.logical_execution_time or 0)
    if form.deadline is not None and form.deadline > given:
        message = f"the deadline of {name} is longer than its logical execution time"
        hint = "leave `deadline` out: values must be there when they become visible"
        findings.error("RV-0703", form.at("deadline"), message, hint=hint)
    if given > period:
        message = f"the logical execution time of {name} is longer than its period"
        findings.error("RV-0703", form.at("logical_execution_time"), message)
    return given


def _slot(text: str, origin: Origin, form: ProcessorForm, site: DeploymentNames) -> Slot | None:
    """One row of a table."""
    shape = "instance.name or bus.receive"
    pair = split(text, shape, origin, site.owners, site.findings)
    if pair is None:
        return None
    owner, name = pair
    if site.buses.knows(owner) and not site.owners.knows(owner):
        return _bus_slot(text, name, owner, origin, form, site)
    found = member_of(text, shape, origin, site)
    if found is None:
        return None
    instance, parts, name = found
    if name.lower() == PORTS and not parts.rows.knows(name):
        message = f"{instance.component.name} has no input ports, so no row `{text}`"
        site.findings.error("RV-0305", origin, message, hint="remove the row")
        return None
    row = parts.rows.look_up(name, origin, site.findings)
    if row is None:
        return None
    component = instance.component
    handler = component.handlers().get(row)
    if handler is not None:
        timing, work = handler, Work.PORT_REGION
    elif any(region.name == row for region in component.regions):
        timing, work = component.region(row).timing, Work.REGION
    else:
        activity = next(one for one in component.activities if one.name == row)
        timing, work = activity.timing, Work.ACTIVITY
    return Slot(origin, instance.name, work, row, timing, 1, 0)


def _bus_slot(
    text: str, name: str, owner: str, origin: Origin, form: ProcessorForm, site: DeploymentNames
) -> Slot | None:
    """The row ``bus.receive``, the driver's time for one frame, or ``bus.watch``."""
    site.buses.used(owner, origin, site.findings)
    bus = site.buses.find(owner)
    if name.lower() not in ("receive", "watch"):
        message = f"`{text}` is no row: a bus has the rows `{owner}.receive` and `{owner}.watch`"
        site.findings.error("RV-0305", origin, message)
        return None
    if bus is not None and name.lower() == "watch":
        if bus.watch is None:
            message = f"`{text}` is no row: {owner} has no `watch`"
            hint = f"add `watch: {{period: ..., wcet: ...}}` to {owner}"
            site.findings.error("RV-0305", origin, message, hint=hint)
            return None
        return Slot(origin, bus.name, Work.BUS_WATCH, "watch", bus.watch, 1, 0)
    if bus is not None and form.released_by is None and not form.damaged:
        message = f"{bus.name}.receive needs a processor that is released by {bus.name}"
        hint = f"move it to one with `released_by: {bus.name}`"
        site.findings.error("RV-0705", origin, message, hint=hint)
    if bus is None or form.period is None:
        return None
    deadline = form.period if form.deadline is None else form.deadline
    timing = Timing(Ns(form.period), bus.driver_wcet, Ns(deadline))
    return Slot(origin, bus.name, Work.BUS_RECEIVE, "receive", timing, 1, 0)


def chain_of(
    name: str, form: ChainForm, messages: NameScope[Message], site: DeploymentNames
) -> Chain | None:
    """A chain whose messages and rows exist."""
    places: list[Stop | None] = []
    for index, text in enumerate(form.path):
        origin = form.item_at("path", index)
        if "." in text:
            places.append(_row_at(text, origin, site))
        else:
            message = messages.look_up(text, origin, site.findings)
            places.append(None if message is None else Carried(message.name))
    if form.reaction is None and form.age is None and not form.damaged:
        message_text = f"the chain {name} has no limit"
        hint = "add `reaction:`, `age:`, or both"
        site.findings.error("RV-0612", form.origin, message_text, hint=hint)
    if None in places or form.list_damaged("path"):
        return None
    reaction = None if form.reaction is None else Ns(form.reaction)
    age = None if form.age is None else Ns(form.age)
    path = tuple(place for place in places if place)
    logical = form.logical_execution_time is not None
    return Chain(name, form.origin, path, reaction, age, logical=logical)


def _row_at(text: str, origin: Origin, site: DeploymentNames) -> End | None:
    """The row ``instance.name``."""
    found = member_of(text, "a message or instance.row", origin, site)
    if found is None:
        return None
    instance, parts, own = found
    row = parts.rows.look_up(own, origin, site.findings)
    return None if row is None else End(instance.name, row)


def shutdown_of(form: ShutdownForm | None, site: DeploymentNames) -> Shutdown:
    """The events that a request to stop raises, and the grace."""
    if form is None:
        return Shutdown((), Ns(0))
    raised: Iterable[tuple[str, str] | None] = (
        event_at(text, form.item_at("raises", index), site)
        for index, text in enumerate(form.raises)
    )
    return Shutdown(tuple(pair for pair in raised if pair is not None), Ns(form.grace))
