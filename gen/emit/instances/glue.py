# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One package per component instance: its protected objects, and the glue.

The glue copies in what a region or activity reads, calls the component's
logic, and publishes what came out. Logic stays in the component's packages.
"""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.calls import answered_at_once
from ravenchart.gen.derive.crossing import core_of
from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Decl,
    GenericInstance,
    Object,
    Package,
    Param,
    Subprogram,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    BOX,
    Expr,
    all_else,
    arguments,
    number,
)
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import (
    RUNTIME,
    ada_case,
    default_value,
    instance_package,
    type_name,
    value,
)
from ravenchart.gen.emit.ada.statements import (
    Comment,
    Pragma,
    Stmt,
    do,
)
from ravenchart.gen.emit.charts.shape import RegionShape
from ravenchart.gen.emit.commands.device_calls import (
    providers,
    reply_boards,
    request_queue,
)
from ravenchart.gen.emit.commands.gathered_answers import (
    ANSWERS,
    gathered,
    gathering_objects,
)
from ravenchart.gen.emit.commands.remote_calls import (
    call_objects,
    heard_objects,
    units_of,
)
from ravenchart.gen.emit.commands.remote_reads import copy_objects, read_units
from ravenchart.gen.emit.components.contracts import stored_type
from ravenchart.gen.emit.components.packages import activity_package, published_type
from ravenchart.gen.emit.language.configurations import Configurations
from ravenchart.gen.emit.language.events import null_event
from ravenchart.gen.emit.tables.core_units import at_core
from ravenchart.gen.emit.tables.executions import ELEMENT_ID, executing, run_spec
from ravenchart.gen.emit.tables.port_calls import CROSSINGS, VISIBLE, put_of
from ravenchart.gen.emit.tables.trace_calls import fault_units
from ravenchart.gen.emit.tables.value_calls import UNIT, recording
from ravenchart.gen.model.component import Activity, Port, PortKind
from ravenchart.gen.model.logical import links_by_port
from ravenchart.gen.model.statechart import Overflow
from ravenchart.gen.model.system import System, Work

from .commands import Commands
from .fills import fill_bodies, fill_specs, queued_regions
from .instants import instant_objects, next_instants, units_of_instants
from .offering import asked, offer_steps
from .offers import ANSWERED, OFFERS, offers_of_port, offers_of_region, overflowed, put
from .releasing import (
    by_events,
    call_spec,
    call_wait,
    event_spec,
    event_wait,
    queue_units,
    releases,
    wait_body,
    wait_spec,
)
from .rows import Rows
from .transmission import answering

_UNUSED = "Unused"
"""A variable that nothing reads; compiler and gnatprove know names with this word."""


class Glue(Commands):
    """Builds the package of one instance."""

    def units(self, header: str) -> tuple[Unit, ...]:
        """Spec and body."""
        spec = Package(instance_package(self.system, self.instance), self._spec(), (SPARK,))
        body = Package(
            instance_package(self.system, self.instance), self._body(), (SPARK,), is_body=True
        )
        return Unit(header, self._spec_withs(), spec), Unit(header, self._body_withs(), body)

    # --- contexts

    def _spec_withs(self) -> tuple[DottedName, ...]:
        component = self.instance.component
        own = (ref(ada_case(self.system.name), self.component),)
        queueing = self._served() or queued_regions(component)
        asked = (ref("Ravenchart.Queueing"),) if queueing else ()
        rows = (ref(ada_case(self.system.name), "Elements"),) if self._slots() else ()
        return (*asked, *(own if component.events or asked else ()), *rows)

    def _body_withs(self) -> tuple[DottedName, ...]:
        root = ada_case(self.system.name)
        component = self.instance.component
        names = {ref("System")}
        queued = bool(component.inputs()) or any(r.events() for r in component.regions)
        if queued or self._served():
            names |= {ref("Ravenchart.Queueing"), OFFERS, ANSWERED, *fault_units(root)}
        if not component.events and not self._served():
            names.add(ref(root, self.component))
        if any(n.trace_depth for n in self.system.nodes):
            names |= {ref(root, "Trace"), ref(root, "Elements"), ref("Ravenchart.Traces")}
        if recording(self.system):
            names.add(ref(root, UNIT))
        names |= queue_units(self, self._served())
        if any(b.instance == self.instance.name for b in self.system.bindings):
            names.add(ref("Ravenchart.Queueing"))
        if any(gathered(self.system, self.instance)):
            names |= {ANSWERS, ref("Ravenchart.Gatherings"), *fault_units(root)}
        names |= set(units_of(self.system, self.instance))
        names |= set(read_units(self.system, self.instance))
        names.add(ref("Ravenchart.Blackboards"))
        if self.noted:
            names.add(ref("Ravenchart.Steps"))
        names |= {ref(root, self.component, ada_case(r.name)) for r in component.regions}
        for activity in component.activities:
            names.add(ref(root, self.component, activity_package(component, activity)))
        names |= {ref(root, unit) for unit in providers(self.system, self.instance)}
        for event in component.events:
            names |= {ref(root, ada_case(bus)) for bus in asked(self, event.name)}
        names |= {ref(root, unit) for unit in self._units_of_ports()}
        names |= answering(self.system, self.instance)
        names |= set(units_of_instants(self))
        names -= {instance_package(self.system, self.instance), *self._spec_withs()}
        return tuple(sorted(names))

    def _units_of_ports(self) -> Iterator[str]:
        """Where the values of its ports go, and come from another core."""
        component = self.instance.component
        if any(self._crosses(port) for port in component.inputs()):
            yield CROSSINGS
        for port in component.outputs():
            ends, messages = self._targets(port.name)
            for unit in {put_of(self.system, end).first for end in ends}:
                if unit != ada_case(self.instance.name):
                    yield unit
            for message in self.system.messages:
                if message.name in messages:
                    yield ada_case(message.bus)

    # --- spec

    def _spec(self) -> tuple[Decl, ...]:
        items: list[Decl] = []
        for port in self._connected_inputs():
            items.append(self._put_spec(port))
            items.append(
                Comment(f"[{self._element(port.name)}.mailbox] called by senders; never blocks.")
            )
            items += wait_spec(self, port)
        if self.instance.component.events:
            items.append(self._offer_spec())
            items.append(
                Comment(
                    f"[{self.instance.name}.events] offer Item to each region that names the "
                    "event; never blocks."
                )
            )
        items += self._command_specs()
        items += [spec for one in self._served() for spec in call_spec(self, one)]
        items += [spec for one in self.instance.component.regions for spec in event_spec(self, one)]
        items += fill_specs(self)
        if self._slots():
            items.insert(0, UseType(ELEMENT_ID))
        for slot in self._slots():
            items.append(run_spec(ada_case(slot.name), slot))
            items.append(Comment(f"[{slot.element}] one execution; called by its processor only."))
        return tuple(items)

    def _put_spec(self, port: Port) -> Subprogram:
        param = Param("Item", "in", type_name(self.system, port.type))
        return Subprogram(f"Put_{ada_case(port.name)}", (param,))

    def _offer_spec(self) -> Subprogram:
        return Subprogram("Offer", (Param("Item", "in", ref(self.component, "Event")),))

    # --- body: objects

    def _body(self) -> tuple[Decl, ...]:
        items: list[Decl] = [*instant_objects(self), *self._port_objects()]
        items += [*self._data_objects(), *self._region_objects()]
        items += [request_queue(self.system, self.instance, one) for one in self._served()]
        items += reply_boards(self.system, self.instance)
        items += gathering_objects(self.system, self.instance)
        items += call_objects(self.system, self.instance)
        items += copy_objects(self.system, self.instance)
        items += heard_objects(self.system, self.instance)
        items += overflowed(self.instance.component)
        component = self.instance.component
        items += [self._put_body(p) for p in self._connected_inputs()]
        items += [body for p in self._connected_inputs() for body in wait_body(self, p)]
        if component.events:
            items.append(Subprogram("Offer", self._offer_spec().params, body=offer_steps(self)))
        items += self._command_bodies()
        items += [body for one in self._served() for body in call_wait(self, one)]
        items += [body for one in component.regions for body in event_wait(self, one)]
        items += fill_bodies(self)
        used = {n for r in component.regions for n in r.sends}
        for activity in component.activities:
            used |= {*activity.sends} - {*answered_at_once(component, activity)}
        items += [
            body
            for p in component.outputs()
            if p.name in used and not self._is_idle(p)
            for body in (self._call_bodies(p) if p.is_command else (self._send_body(p),))
        ]
        rows = Rows(self.system, self.instance, self.noted)
        items += rows.read_arrays()
        for slot in self._slots():
            match slot.work:
                case Work.PORT_REGION:
                    run = [rows.run_ports(slot.name)]
                case Work.REGION:
                    run = rows.run_region(component.region(slot.name))
                case _:
                    activity = next(a for a in component.activities if a.name == slot.name)
                    run = [rows.run_activity(activity)]
            items += [*run[:-1], executing(run[-1], slot, *next_instants(self, slot))]
        return tuple(items)

    def _board(self, name: str, of_type: Named, initial: Expr, element: str) -> GenericInstance:
        return GenericInstance(
            f"{name}_Board",
            "Ravenchart.Blackboards",
            arguments(Element_Type=ref(of_type), Initial=initial, Ceiling=self._ceiling(element)),
        )

    def _queue(
        self,
        name: str,
        of_type: Named,
        null: Expr,
        depth: int,
        policy: Overflow,
        element: str,
        generic: Named = "Ravenchart.Queues",
    ) -> GenericInstance:
        return GenericInstance(
            name,
            generic,
            arguments(
                Element_Type=ref(of_type),
                Null_Element=null,
                Capacity=number(depth),
                Ceiling=self._ceiling(element),
                Policy=ref("Ravenchart.Queueing", ada_case(policy.value)),
            ),
        )

    def _port_objects(self) -> list[Decl]:
        items: list[Decl] = []
        for port in self.instance.component.inputs():
            name = ada_case(port.name)
            sampled = port.kind is PortKind.SAMPLED
            policy = Overflow.DROP_OLDEST if sampled else port.overflow
            depth = 1 if sampled else port.depth
            null = default_value(self.system, port.type)
            of_type = type_name(self.system, port.type)
            items.append(Comment(f"[{self._element(port.name)}]"))
            if not self._crosses(port):
                kind = "Releasing_Queues" if releases(self, port) else "Queues"
                given = of_type, null, depth, policy, f"{port.name}.mailbox", ref(RUNTIME, kind)
                items.append(self._queue(f"{name}_Mailbox", *given))
            if not sampled and port in self._connected_inputs():
                items.append(offers_of_port(self, port, of_type))
            view = ref(self.component, f"{name}_View")
            items.append(Object(f"{name}_Port", view))
            if port.on_overflow:
                items.append(Object(f"{name}_Lost_Before", "Ravenchart.Event_Count", number(0)))
            if self._has_object(port.name):
                items.append(self._board(name, view, all_else(BOX), port.name))
        return items

    def _data_objects(self) -> list[Decl]:
        items: list[Decl] = []
        for data in self.instance.component.data:
            name = ada_case(data.name)
            initial = value(self.system, data.type, data.initial)
            of_type = stored_type(self.system, self.instance.component, data)
            writer = self._writer(data)
            if data.is_command or (writer is None and not self.instance.component.users(data.name)):
                continue
            if writer is None:
                items.append(Object(f"{name}_Own", of_type, initial, constant=True))
                continue
            if isinstance(writer, Activity):
                items.append(Comment(f"[{self._element(data.name)}] written by {writer.name}"))
                items.append(Object(f"{name}_Own", of_type, initial))
            if self._has_object(data.name):
                items.append(self._board(name, of_type, initial, data.name))
        return items

    def _region_objects(self) -> list[Decl]:
        items: list[Decl] = []
        component = self.instance.component
        for region in component.regions:
            name = ada_case(region.name)
            items.append(Comment(f"[{self._element(region.name)}]"))
            kept = RegionShape(self.system, component, region).kept_as
            items.append(Object(f"{name}_Region", ref(self.component, name, kept)))
            initial = Configurations(region).initial(self.component)
            of_type = published_type(component, region)
            items.append(self._board(name, of_type, initial, region.name))
            if region.events():
                event = ref(self.component, "Event")
                first = null_event(component)
                items.append(
                    self._queue(
                        f"{name}_Queue",
                        event,
                        first,
                        region.queue_depth,
                        region.overflow,
                        f"{region.name}.queue",
                        ref(RUNTIME, "Releasing_Events" if by_events(self, region) else "Queues"),
                    )
                )
                items += offers_of_region(self, region, event)
            for activity, state in component.completing(region.name):
                items.append(Comment(f"[{self._element(activity.name)}] completes {state}"))
                for kind in ("visit", "done"):
                    board = f"{ada_case(activity.name)}_{ada_case(kind)}"
                    element = f"{activity.name}.{kind}"
                    items.append(self._board(board, "Ravenchart.Event_Count", number(0), element))
        return items

    # --- body: arrivals, events, sending

    def _put_body(self, port: Port) -> Subprogram:
        name = ada_case(port.name)
        noted = self._note("Arrived", port.name, "port")
        if port.kind is PortKind.SAMPLED:
            mailed = do(ref(f"{name}_Mailbox", "Put"), ref("Item"), ref(_UNUSED))
            return Subprogram(
                f"Put_{name}",
                self._put_spec(port).params,
                declarations=(
                    Comment("A new sample replaces the old one."),
                    Object(_UNUSED, "Ravenchart.Queueing.Put_Status"),
                ),
                body=(mailed, *noted),
            )
        body = (*noted, put(port.name, ref("Item")))
        return Subprogram(f"Put_{name}", self._put_spec(port).params, body=body)

    def _send_body(self, port: Port) -> Subprogram:
        ends, messages = self._targets(port.name)
        visible = links_by_port(self.system)
        recorded = self._record(port.name, "Item")
        body: list[Stmt] = [*self._note("Sent", port.name, "port"), *recorded]
        for end in ends:
            target = put_of(self.system, end)
            own = target.first == ada_case(self.instance.name)
            given = [ref("Item"), *([ref(VISIBLE.name)] if end in visible else [])]
            body.append(do(ref(target.last) if own else target, *given))
        for message in self.system.messages:
            if message.name in messages:
                body.append(
                    do(ref(ada_case(message.bus), f"Send_{ada_case(message.name)}"), ref("Item"))
                )
        taken = ends or messages or recorded
        unused = () if taken else (Pragma("Unreferenced", (ref("Item"),)),)
        param = Param("Item", "in", type_name(self.system, port.type))
        params = (param, VISIBLE) if any(end in visible for end in ends) else (param,)
        return Subprogram(
            f"Send_{ada_case(port.name)}", params, declarations=unused, body=tuple(body)
        )


def emit_instances(system: System, header: str, *, noted: bool = False) -> tuple[Unit, ...]:
    """The packages of all instances."""
    return tuple(
        unit
        for instance in system.instances
        for unit in at_core(
            Glue(system, instance, noted).units(header), system, core_of(system, instance.name)
        )
    )
