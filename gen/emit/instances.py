"""One package per component instance: its protected objects, and the glue.

The glue copies in what a region or activity reads, calls the component's
logic, and publishes what came out. Logic stays in the component's packages.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..model import (
    Activity,
    Data,
    End,
    Instance,
    Overflow,
    Port,
    PortKind,
    Region,
    Slot,
    System,
    Work,
)
from .ada import (
    SPARK,
    Arg,
    Assign,
    Call,
    Case,
    Chain,
    Comment,
    Decl,
    Do,
    Expr,
    If,
    Loop,
    Object,
    Package,
    Param,
    Pragma,
    Ref,
    Stmt,
    Subprogram,
    Unit,
    UseType,
    arguments,
    call,
    equal,
    number,
)
from .ada import Instance as Instantiation
from .components import activity_params, raise_flag, reading_type, send_flag
from .naming import (
    ada_case,
    default_value,
    instance_package,
    priority,
    scalar,
    states_package,
    type_name,
    value,
)
from .regions import RegionShape
from .trace_calls import note


@dataclass(frozen=True, slots=True)
class Glue:
    """Builds the package of one instance."""

    system: System
    instance: Instance

    @property
    def component(self) -> str:
        """The component's package, as seen from the instance's."""
        return ada_case(self.instance.component.name)

    def units(self, header: str) -> tuple[Unit, ...]:
        """Spec and body."""
        spec = Package(instance_package(self.system, self.instance), self._spec(), (SPARK,))
        body = Package(
            instance_package(self.system, self.instance), self._body(), (SPARK,), is_body=True
        )
        return Unit(header, self._spec_withs(), spec), Unit(header, self._body_withs(), body)

    # --- what stands where

    def _slots(self) -> tuple[Slot, ...]:
        return tuple(
            s
            for p in self.system.processors
            for s in p.slots
            if s.owner == self.instance.name and s.work is not Work.BUS_RECEIVE
        )

    def _element(self, name: str) -> str:
        return f"{self.instance.name}.{name}"

    def _ceiling(self, name: str) -> Expr:
        return priority(self.system.object(self._element(name)).ceiling)

    def _has_object(self, name: str) -> bool:
        return any(o.element == self._element(name) for o in self.system.objects)

    def _writer(self, data: Data) -> Region | Activity | None:
        component = self.instance.component
        runnables: tuple[Region | Activity, ...] = (*component.regions, *component.activities)
        return next((r for r in runnables if data.name in r.writes), None)

    def _targets(self, port: str) -> tuple[list[End], list[str]]:
        """Input ports of the same node, and messages, that an output port feeds."""
        end = End(self.instance.name, port)
        ports = [c.target for c in self.system.connections if c.source == end]
        messages = [m for m in self.system.messages if m.source == end]
        return ports, [m.name for m in messages]

    def _connected_inputs(self) -> tuple[Port, ...]:
        targets = [c.target for c in self.system.connections]
        targets += [t for m in self.system.messages for t in m.targets]
        names = {t.port for t in targets if t.instance == self.instance.name}
        return tuple(p for p in self.instance.component.inputs() if p.name in names)

    def _note(
        self, kind: str, name: str, element_kind: str, item: Expr | None = None
    ) -> tuple[Stmt, ...]:
        return note(self.system, kind, self._element(name), element_kind, item)

    # --- contexts

    def _spec_withs(self) -> tuple[str, ...]:
        return (
            (f"{ada_case(self.system.name)}.{self.component}",)
            if self.instance.component.events
            else ()
        )

    def _body_withs(self) -> tuple[str, ...]:
        root = ada_case(self.system.name)
        component = self.instance.component
        names = {"Ravenchart.Queueing", "Ravenchart.Health", "System", f"{root}.Health_Counts"}
        if not component.inputs() and not any(r.events() for r in component.regions):
            names -= {"Ravenchart.Queueing", "Ravenchart.Health", f"{root}.Health_Counts"}
        if not component.events:
            names.add(f"{root}.{self.component}")
        if any(n.trace_depth for n in self.system.nodes):
            names |= {f"{root}.Trace", f"{root}.Elements", "Ravenchart.Traces"}
        if component.inputs() or any(r.events() for r in component.regions):
            names.add("Ravenchart.Queues")
        names.add("Ravenchart.Blackboards")
        names |= {f"{root}.{self.component}.{ada_case(r.name)}" for r in component.regions}
        if any(a.flow is None for a in component.activities):
            names.add(f"{root}.{self.component}.Activities")
        if any(a.flow is not None for a in component.activities):
            names.add(f"{root}.{self.component}.Flows")
        for port in component.outputs():
            ends, messages = self._targets(port.name)
            names |= {
                f"{root}.{ada_case(e.instance)}" for e in ends if e.instance != self.instance.name
            }
            for message in self.system.messages:
                if message.name in messages:
                    names.add(f"{root}.{ada_case(message.bus)}")
        return tuple(sorted(names - {instance_package(self.system, self.instance)}))

    # --- spec

    def _spec(self) -> tuple[Decl, ...]:
        items: list[Decl] = []
        for port in self._connected_inputs():
            items.append(self._put_spec(port))
            items.append(
                Comment(f"[{self._element(port.name)}.mailbox] by its senders; never blocks.")
            )
        if self.instance.component.events:
            items.append(self._offer_spec())
            items.append(
                Comment(
                    f"[{self.instance.name}.events] offer Item to every region that names it; "
                    "never blocks."
                )
            )
        for slot in self._slots():
            items.append(Subprogram(f"Run_{ada_case(slot.name)}"))
            items.append(Comment(f"[{slot.element}] one execution, by its processor alone."))
        return tuple(items)

    def _put_spec(self, port: Port) -> Subprogram:
        param = Param("Item", "in", type_name(self.system, port.type))
        return Subprogram(f"Put_{ada_case(port.name)}", (param,))

    def _offer_spec(self) -> Subprogram:
        return Subprogram("Offer", (Param("Item", "in", f"{self.component}.Event"),))

    # --- body: objects

    def _body(self) -> tuple[Decl, ...]:
        items: list[Decl] = [*self._port_objects(), *self._data_objects(), *self._region_objects()]
        component = self.instance.component
        items += [self._put_body(p) for p in self._connected_inputs()]
        if component.events:
            items.append(self._offer_body())
        used = {n for r in component.regions for n in r.sends}
        used |= {n for a in component.activities for n in a.sends}
        items += [self._send_body(p) for p in component.outputs() if p.name in used]
        for slot in self._slots():
            match slot.work:
                case Work.PORT_REGION:
                    items.append(self._run_ports())
                case Work.REGION:
                    items += self._run_region(component.region(slot.name))
                case _:
                    activity = next(a for a in component.activities if a.name == slot.name)
                    items.append(self._run_activity(activity))
        return tuple(items)

    def _board(self, name: str, of_type: str, initial: Expr, element: str) -> Instantiation:
        return Instantiation(
            f"{name}_Board",
            "Ravenchart.Blackboards",
            arguments(Element_Type=Ref(of_type), Initial=initial, Ceiling=self._ceiling(element)),
        )

    def _queue(
        self, name: str, of_type: str, null: Expr, depth: int, policy: Overflow, element: str
    ) -> Instantiation:
        return Instantiation(
            name,
            "Ravenchart.Queues",
            arguments(
                Element_Type=Ref(of_type),
                Null_Element=null,
                Capacity=number(depth),
                Ceiling=self._ceiling(element),
                Policy=Ref(f"Ravenchart.Queueing.{ada_case(policy.value)}"),
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
            items.append(
                self._queue(f"{name}_Mailbox", of_type, null, depth, policy, f"{port.name}.mailbox")
            )
            view = f"{self.component}.{name}_View"
            items.append(Object(f"{name}_Port", view))
            if port.on_overflow:
                items.append(Object(f"{name}_Lost_Before", "Ravenchart.Event_Count", number(0)))
            if self._has_object(port.name):
                items.append(self._board(name, view, Ref("(others => <>)"), port.name))
        return items

    def _data_objects(self) -> list[Decl]:
        items: list[Decl] = []
        for data in self.instance.component.data:
            name = ada_case(data.name)
            initial = value(self.system, data.type, data.initial)
            of_type = type_name(self.system, data.type)
            writer = self._writer(data)
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
        for region in self.instance.component.regions:
            name = ada_case(region.name)
            states = f"{self.component}.{states_package(region)}"
            initial = f"{states}.{ada_case(region.default_leaf(region.initial))}"
            items.append(Comment(f"[{self._element(region.name)}]"))
            items.append(Object(f"{name}_Region", f"{self.component}.{name}.Region"))
            items.append(self._board(name, f"{states}.Leaf", Ref(initial), region.name))
            if region.events():
                event = f"{self.component}.Event"
                first = Ref(f"{self.component}.{ada_case(region.events()[0])}")
                items.append(
                    self._queue(
                        f"{name}_Queue",
                        event,
                        first,
                        region.queue_depth,
                        region.overflow,
                        f"{region.name}.queue",
                    )
                )
        return items

    # --- body: arrivals, events, sending

    def _put_body(self, port: Port) -> Subprogram:
        name = ada_case(port.name)
        body: list[Stmt] = [
            Do(f"{name}_Mailbox.Put", arguments(Ref("Item"), Ref("Status"))),
            *self._note("Arrived", port.name, "port"),
        ]
        if port.kind is PortKind.SAMPLED:
            #  a new sample replaces the old one: nothing is lost
            return Subprogram(
                f"Put_{name}",
                self._put_spec(port).params,
                declarations=(Object("Status", "Ravenchart.Queueing.Put_Status"),),
                body=tuple(body),
            )
        lost: list[Stmt] = [self._fault("Queue_Overflow")]
        lost += self._note("Fault", port.name, "port", self._fault_number("Queue_Overflow"))
        condition = Chain("/=", (Ref("Status"), Ref("Ravenchart.Queueing.Queued")))
        body.append(If(((condition, tuple(lost)),)))
        return Subprogram(
            f"Put_{name}",
            self._put_spec(port).params,
            declarations=(
                Object("Status", "Ravenchart.Queueing.Put_Status"),
                UseType("Ravenchart.Queueing.Put_Status"),
            ),
            body=tuple(body),
        )

    def _fault(self, kind: str) -> Stmt:
        return Do("Health_Counts.Record_Fault", arguments(Ref(f"Ravenchart.Health.{kind}")))

    def _fault_number(self, kind: str) -> Expr:
        return Call("Ravenchart.Health.Fault_Kind'Pos", arguments(Ref(f"Ravenchart.Health.{kind}")))

    def _raise(self, event: str) -> Stmt:
        return Do("Offer", arguments(Ref(f"{self.component}.{ada_case(event)}")))

    def _offer_body(self) -> Subprogram:
        component = self.instance.component
        regions = [r for r in component.regions if r.events()]
        rows: list[tuple[str, tuple[Stmt, ...]]] = []
        for event in component.events:
            steps: list[Stmt] = []
            for region in regions:
                if event.name in region.events():
                    steps += self._enqueue(region)
            steps += self._note("Raised", event.name, "event") if steps else ()
            rows.append((f"{self.component}.{ada_case(event.name)}", tuple(steps)))
        declarations: tuple[Decl, ...] = ()
        if regions:
            declarations = (
                Object("Status", "Ravenchart.Queueing.Put_Status"),
                UseType("Ravenchart.Queueing.Put_Status"),
            )
        return Subprogram(
            "Offer",
            self._offer_spec().params,
            declarations=declarations,
            body=(Case(Ref("Item"), tuple(rows)),),
        )

    def _enqueue(self, region: Region) -> list[Stmt]:
        queue = f"{ada_case(region.name)}_Queue"
        full: list[Stmt] = [self._fault("Queue_Overflow")]
        full += self._note("Fault", region.name, "region", self._fault_number("Queue_Overflow"))
        condition = Chain("/=", (Ref("Status"), Ref("Ravenchart.Queueing.Queued")))
        return [
            Do(f"{queue}.Put", arguments(Ref("Item"), Ref("Status"))),
            If(((condition, tuple(full)),)),
        ]

    def _send_body(self, port: Port) -> Subprogram:
        ends, messages = self._targets(port.name)
        body: list[Stmt] = [*self._note("Sent", port.name, "port")]
        for end in ends:
            name = f"Put_{ada_case(end.port)}"
            target = (
                name if end.instance == self.instance.name else f"{ada_case(end.instance)}.{name}"
            )
            body.append(Do(target, arguments(Ref("Item"))))
        for message in self.system.messages:
            if message.name in messages:
                body.append(
                    Do(
                        f"{ada_case(message.bus)}.Send_{ada_case(message.name)}",
                        arguments(Ref("Item")),
                    )
                )
        unused = (Pragma("Unreferenced", (Ref("Item"),)),) if not ends and not messages else ()
        param = Param("Item", "in", type_name(self.system, port.type))
        return Subprogram(
            f"Send_{ada_case(port.name)}", (param,), declarations=unused, body=tuple(body)
        )

    # --- body: the port region

    def _run_ports(self) -> Subprogram:
        component = self.instance.component
        period = component.port_region.period if component.port_region else 1
        declarations: list[Decl] = [
            Object("Status", "Ravenchart.Queueing.Take_Status"),
            UseType("Ravenchart.Queueing.Take_Status"),
        ]
        if any(p.on_overflow for p in component.inputs()):
            declarations.append(UseType("Ravenchart.Event_Count"))
        body: list[Stmt] = []
        for port in component.inputs():
            name = ada_case(port.name)
            declarations.append(Object(f"{name}_Item", type_name(self.system, port.type)))
            declarations.append(Object(f"{name}_Change", f"{self.component}.{name}_Port.Change"))
            limit: Expr = Ref(f"{self.component}.{name}_Port.Never_Stale")
            if port.max_age is not None:
                limit = number(port.max_age // period)
            body.append(Do(f"{name}_Mailbox.Take", arguments(Ref(f"{name}_Item"), Ref("Status"))))
            body.append(
                Do(
                    f"{self.component}.{name}_Port.Handle",
                    arguments(
                        Ref(f"{name}_Port"),
                        Arrived=equal(Ref("Status"), Ref("Ravenchart.Queueing.Taken")),
                        Item=Ref(f"{name}_Item"),
                        Limit=limit,
                        Outcome=Ref(f"{name}_Change"),
                    ),
                )
            )
            if self._has_object(port.name):
                body.append(Do(f"{name}_Board.Write", arguments(Ref(f"{name}_Port"))))
            if port.on_overflow:
                declarations.append(Object(f"{name}_Losses", "Ravenchart.Event_Count"))
                body += self._watch_losses(port, port.on_overflow)
            body.append(self._react(port))
        return Subprogram("Run_Ports", declarations=tuple(declarations), body=tuple(body))

    def _watch_losses(self, port: Port, event: str) -> list[Stmt]:
        """Raise the overflow event when the mailbox has lost more than last time."""
        name = ada_case(port.name)
        grown = Chain("/=", (Ref(f"{name}_Losses"), Ref(f"{name}_Lost_Before")))
        return [
            Assign(f"{name}_Losses", Ref(f"{name}_Mailbox.Lost")),
            If(((grown, (self._raise(event),)),)),
            Assign(f"{name}_Lost_Before", Ref(f"{name}_Losses")),
        ]

    def _react(self, port: Port) -> Stmt:
        name = ada_case(port.name)
        package = f"{self.component}.{name}_Port"
        arrived: list[Stmt] = [*self._note("Handled", port.name, "port")]
        if port.on_arrival:
            arrived.append(self._raise(port.on_arrival))
        stale: list[Stmt] = [self._fault("Stale_Input")]
        stale += self._note("Fault", port.name, "port", self._fault_number("Stale_Input"))
        if port.on_stale:
            stale.append(self._raise(port.on_stale))
        rows = (
            (f"{package}.Nothing", ()),
            (f"{package}.Arrival", tuple(arrived)),
            (f"{package}.Became_Stale", tuple(stale)),
        )
        return Case(Ref(f"{name}_Change"), rows)

    # --- body: regions

    def _run_region(self, region: Region) -> list[Decl]:
        shape = RegionShape(self.system, self.instance.component, region)
        name = ada_case(region.name)
        package = f"{self.component}.{name}"
        step = self._step_region(shape, package)
        declarations: list[Decl] = []
        body: list[Stmt] = []
        step_args: tuple[Arg, ...] = ()
        if shape.inputs:
            declarations.append(Object("Ins", f"{package}.Inputs"))
            body += [self._copy_in(n, f"Ins.{ada_case(n)}") for n in shape.inputs]
            step_args = arguments(Ref("Ins"))
        if shape.timers:
            body.append(Do(f"{package}.Tick", arguments(Ref(f"{name}_Region"))))
        one: Stmt = Do(f"Step_{name}", step_args)
        if region.steps_per_execution > 1:
            one = Loop(f"for Unused in 1 .. {region.steps_per_execution}", (one,))
        body.append(one)
        body.append(Do(f"{name}_Board.Write", arguments(Ref(f"{name}_Region.Leaf"))))
        for data in self.instance.component.data:
            if data.name in region.writes and self._has_object(data.name):
                field = f"{name}_Region.Data.{ada_case(data.name)}"
                body.append(Do(f"{ada_case(data.name)}_Board.Write", arguments(Ref(field))))
        run = Subprogram(f"Run_{name}", declarations=tuple(declarations), body=tuple(body))
        return [step, run]

    def _copy_in(self, name: str, target: str) -> Stmt:
        """Read what ``name`` denotes into ``target``."""
        component = self.instance.component
        for parameter, given in self.instance.parameters:
            if parameter == name:
                of_type = next(p.type for p in component.parameters if p.name == name)
                return Assign(target, scalar(self.system, of_type, given))
        if any(d.name == name for d in component.data) and not self._has_object(name):
            return Assign(target, Ref(f"{ada_case(name)}_Own"))
        return Do(f"{ada_case(name)}_Board.Read", arguments(Ref(target)))

    def _step_region(self, shape: RegionShape, package: str) -> Subprogram:
        region = shape.region
        name = ada_case(region.name)
        declarations: list[Decl] = [
            Object("Now", f"{package}.Occurrence"),
            Object("Fired", f"{package}.Selection"),
            UseType(f"{package}.Selection"),
        ]
        body: list[Stmt] = [Do(f"{package}.Poll", arguments(Ref(f"{name}_Region"), Ref("Now")))]
        if region.events():
            declarations += [
                UseType(f"{package}.Occurrence"),
                Object("Event", f"{self.component}.Event"),
                Object("Status", "Ravenchart.Queueing.Take_Status"),
                UseType("Ravenchart.Queueing.Take_Status"),
            ]
            taken = equal(Ref("Status"), Ref("Ravenchart.Queueing.Taken"))
            convert = Assign("Now", call(f"{package}.To_Occurrence", Ref("Event")))
            idle = equal(Ref("Now"), Ref(f"{package}.Conditions"))
            take = Do(f"{name}_Queue.Take", arguments(Ref("Event"), Ref("Status")))
            body.append(If(((idle, (take, If(((taken, (convert,)),)))),)))
        args = [Ref(f"{name}_Region"), Ref("Now")]
        args += [Ref("Ins")] if shape.inputs else []
        if shape.has_box:
            declarations.append(Object("Box", f"{package}.Outbox"))
            args.append(Ref("Box"))
        body.append(Do(f"{package}.Step", arguments(*args, Ref("Fired"))))
        body += self._after_step(shape, package)
        params = (Param("Ins", "in", f"{package}.Inputs"),) if shape.inputs else ()
        return Subprogram(
            f"Step_{name}", params, declarations=tuple(declarations), body=tuple(body)
        )

    def _after_step(self, shape: RegionShape, package: str) -> list[Stmt]:
        """Report what fired; then send and raise what the step asked for."""
        region = shape.region
        name = ada_case(region.name)
        moved: list[Stmt] = []
        position = Chain(
            "-",
            (
                Call(f"{package}.Selection'Pos", arguments(Ref("Fired"))),
                Call(f"{package}.Selection'Pos", arguments(Ref(f"{package}.Transition'First"))),
            ),
        )
        taken = self._note("Transition", region.name, "region", position)
        if taken:
            is_transition = Chain("in", (Ref("Fired"), Ref(f"{package}.Transition")))
            moved.append(If(((is_transition, taken),)))
        leaf = f"{self.component}.{states_package(region)}.Leaf"
        moved += self._note(
            "State",
            region.name,
            "region",
            Call(f"{leaf}'Pos", arguments(Ref(f"{name}_Region.Leaf"))),
        )
        for port in self.instance.component.outputs():
            if port.name in region.sends:
                box = f"Box.{ada_case(port.name)}"
                send = Do(f"Send_{ada_case(port.name)}", arguments(Ref(box)))
                moved.append(If(((Ref(f"{box}_Sent"), (send,)),)))
        if region.raises:
            lists = f"{self.component}.Event_Lists"
            offer = Do("Offer", arguments(call(f"{lists}.Element", Ref("Box.Raised"), Ref("I"))))
            moved.append(Loop(f"for I in 1 .. {lists}.Count (Box.Raised)", (offer,)))
        if not moved:
            return [Pragma("Unreferenced", (Ref("Fired"),))]
        return [If(((Chain("/=", (Ref("Fired"), Ref(f"{package}.None"))), tuple(moved)),))]

    # --- body: activities

    def _run_activity(self, activity: Activity) -> Subprogram:
        component = self.instance.component
        declarations: list[Decl] = []
        before: list[Stmt] = []
        args: list[Arg] = []
        after: list[Stmt] = []
        reads = [n for n in activity.reads if n not in activity.writes]
        guard: Expr | None = None
        if activity.while_in is not None:
            region = component.region(activity.while_in.region)
            guard = self._active_in(region, activity.while_in.state, declarations)
        for name in reads:
            local = f"{ada_case(name)}_Value"
            declarations.append(Object(local, reading_type(self.system, component, name)))
            before.append(self._copy_in(name, local))
            args.append(Arg(ada_case(name), Ref(local)))
        for name in activity.writes:
            own = f"{ada_case(name)}_Own"
            args.append(Arg(ada_case(name), Ref(own)))
            if self._has_object(name):
                after.append(Do(f"{ada_case(name)}_Board.Write", arguments(Ref(own))))
        for port in component.outputs():
            if port.name in activity.sends:
                local = f"{ada_case(port.name)}_Value"
                declarations.append(Object(local, type_name(self.system, port.type)))
                args.append(Arg(ada_case(port.name), Ref(local)))
                send: Stmt = Do(f"Send_{ada_case(port.name)}", arguments(Ref(local)))
                if activity.flow is not None:
                    flag = send_flag(port.name)
                    declarations.append(Object(f"{flag}_Asked", "Boolean"))
                    args.append(Arg(flag, Ref(f"{flag}_Asked")))
                    send = If(((Ref(f"{flag}_Asked"), (send,)),))
                after.append(send)
        for event in activity.raises:
            flag = raise_flag(event)
            declarations.append(Object(flag, "Boolean"))
            args.append(Arg(flag, Ref(flag)))
            after.append(If(((Ref(flag), (self._raise(event),)),)))
        home = "Activities" if activity.flow is None else "Flows"
        work = Do(f"{self.component}.{home}.{ada_case(activity.name)}", tuple(args))
        expected = [p.name for p in activity_params(self.system, component, activity)]
        assert expected == [a.name for a in args], (expected, args)
        body: tuple[Stmt, ...] = (*before, work, *after)
        if guard is not None:
            region_name = ada_case(activity.while_in.region)  # type: ignore[union-attr]
            read = Do(f"{region_name}_Board.Read", arguments(Ref(f"{region_name}_Now")))
            body = (read, If(((guard, body),)))
        return Subprogram(
            f"Run_{ada_case(activity.name)}", declarations=tuple(declarations), body=body
        )

    def _active_in(self, region: Region, state: str, declarations: list[Decl]) -> Expr:
        now = f"{ada_case(region.name)}_Now"
        states = f"{self.component}.{states_package(region)}"
        declarations.append(Object(now, f"{states}.Leaf"))
        qualified = f"{states}.{ada_case(state)}"
        if region.state(state).is_leaf:
            declarations.append(UseType(f"{states}.Leaf"))
            return equal(Ref(now), Ref(qualified))
        return Chain("in", (Ref(now), Ref(qualified)))


def emit_instances(system: System, header: str) -> tuple[Unit, ...]:
    """The packages of all instances."""
    return tuple(u for i in system.instances for u in Glue(system, i).units(header))
