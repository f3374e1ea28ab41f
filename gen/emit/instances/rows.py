"""One execution of a port region, a region or an activity: copy in, call, publish."""

from __future__ import annotations

from collections.abc import Mapping

from ravenchart.gen.emit.ada.naming import ada_case, scalar, type_name
from ravenchart.gen.emit.ada.syntax import (
    Arg,
    Assign,
    Call,
    Case,
    Decl,
    Do,
    Expr,
    IfStatement,
    Loop,
    Object,
    OperatorChain,
    Param,
    Pragma,
    Ref,
    Stmt,
    Subprogram,
    UseType,
    arguments,
    call,
    do,
    equal,
    number,
)
from ravenchart.gen.emit.charts.shape import RegionShape
from ravenchart.gen.emit.commands.device_calls import asked, asked_args, served
from ravenchart.gen.emit.commands.remote_calls import watched
from ravenchart.gen.emit.commands.remote_reads import copy_name, publishes
from ravenchart.gen.emit.components.packages import (
    activity_package,
    activity_params,
    has_flag,
    raise_flag,
    raise_value,
    raised_type,
    reading_type,
    send_flag,
)
from ravenchart.gen.emit.language.events import null_event
from ravenchart.gen.emit.language.places import Places
from ravenchart.gen.emit.language.terms import names_in
from ravenchart.gen.model.commands import Binding, Device, Poll, RemoteRead, Server
from ravenchart.gen.model.component import Activity, Port
from ravenchart.gen.model.statechart import DONE, Region

from .site import Site
from .transmission import answers, transmits


class Rows(Site):
    """The rows of processors' tables that belong to one instance."""

    # --- body: the port region

    def run_ports(self) -> Subprogram:
        component = self.instance.component
        period = component.port_region.period if component.port_region else 1
        declarations: list[Decl] = [
            Object("Status", "Ravenchart.Queueing.Take_Status"),
            UseType("Ravenchart.Queueing.Take_Status"),
        ]
        if any(p.on_overflow for p in component.inputs()):
            declarations.append(UseType("Ravenchart.Event_Count"))
        body: list[Stmt] = []
        for poll in self.system.polls:
            if poll.instance == self.instance.name:
                asked = f"{ada_case(poll.port)}_Told"
                told = self.instance.component.port(poll.port).type
                declarations.append(Object(asked, type_name(self.system, told)))
                declarations.append(Object(f"{asked}_Now", "Boolean"))
                body += self._asked_for(poll, asked)
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
        body += answers(self.system, self.instance)
        return Subprogram("Run_Ports", declarations=tuple(declarations), body=tuple(body))

    def _asked_for(self, poll: Poll, told: str) -> list[Stmt]:
        """Ask a device for an event, and take it like a value that has arrived."""
        asked = f"{ada_case(poll.device.name)}.{ada_case(poll.event)}"
        arrived = Do(f"Put_{ada_case(poll.port)}", arguments(Ref(told)))
        return [
            Do(asked, arguments(Ref(f"{told}_Now"), Ref(told))),
            IfStatement(((Ref(f"{told}_Now"), (arrived,)),)),
        ]

    def _watch_losses(self, port: Port, event: str) -> list[Stmt]:
        """Raise the overflow event when the mailbox has lost more than last time."""
        name = ada_case(port.name)
        grown = OperatorChain("/=", (Ref(f"{name}_Losses"), Ref(f"{name}_Lost_Before")))
        return [
            Assign(f"{name}_Losses", Ref(f"{name}_Mailbox.Lost")),
            IfStatement(((grown, (self._raise(event),)),)),
            Assign(f"{name}_Lost_Before", Ref(f"{name}_Losses")),
        ]

    def _react(self, port: Port) -> Stmt:
        name = ada_case(port.name)
        package = f"{self.component}.{name}_Port"
        arrived: list[Stmt] = [*self._note("Handled", port.name, "port")]
        arrived += self._record(port.name, f"{name}_Port.Value")
        if port.on_arrival:
            arrived.append(self._raise(port.on_arrival, Ref(f"{name}_Port.Value")))
        stale: list[Stmt] = [self._fault("Stale_Input", port.name, "port")]
        if port.on_stale:
            stale.append(self._raise(port.on_stale))
        rows = (
            (f"{package}.Nothing", ()),
            (f"{package}.Arrival", tuple(arrived)),
            (f"{package}.Became_Stale", tuple(stale)),
        )
        return Case(Ref(f"{name}_Change"), rows)

    # --- body: regions

    def run_region(self, region: Region) -> list[Subprogram]:
        shape = RegionShape(self.system, self.instance.component, region, noted=self.noted)
        name = ada_case(region.name)
        package = f"{self.component}.{name}"
        step = self._step_region(shape, package)
        declarations: list[Decl] = []
        body: list[Stmt] = [*watched(self.system, self.instance, region)]
        step_args: tuple[Arg, ...] = ()
        if shape.inputs:
            declarations.append(Object("Ins", f"{package}.Inputs"))
            body += [self._copy_in(n, f"Ins.{ada_case(n)}") for n in shape.inputs]
            step_args = arguments(Ref("Ins"))
        completing = self.instance.component.completing(region.name)
        if completing:
            declarations.append(Object("Visit", "Ravenchart.Event_Count"))
        for activity, state in completing:
            notice = f"{package}.Notice_{ada_case(state)}"
            body.append(do(f"{ada_case(activity.name)}_Done_Board.Read", Ref("Visit")))
            body.append(do(notice, Ref(f"{name}_Region"), Ref("Visit")))
        if shape.timers:
            body.append(Do(f"{package}.Tick", arguments(Ref(f"{name}_Region"))))
        one: Stmt = Do(f"Step_{name}", step_args)
        if region.steps_per_execution > 1:
            one = Loop(f"for Unused in 1 .. {region.steps_per_execution}", (one,))
        body.append(one)
        #  visits before states: who sees a state entered sees that visit, or a later one
        for activity, state in completing:
            visits = Ref(f"{name}_Region.{shape.visits(state)}")
            body.append(do(f"{ada_case(activity.name)}_Visit_Board.Write", visits))
        body.append(Do(f"{name}_Board.Write", arguments(Ref(f"{name}_Region.{shape.place}"))))
        for data in self.instance.component.data:
            if data.name not in region.writes:
                continue
            field = f"{name}_Region.Data.{ada_case(data.name)}"
            if self._has_object(data.name):
                body.append(Do(f"{ada_case(data.name)}_Board.Write", arguments(Ref(field))))
            body += self._record(data.name, field)
        body += publishes(self.system, self.instance, region, declarations)
        body += transmits(self.system, self.instance, region)
        run = Subprogram(f"Run_{name}", declarations=tuple(declarations), body=tuple(body))
        return [step, run]

    def _parameter(self, name: str) -> Expr | None:
        """The value that the instance gives a parameter; None for what is none."""
        for parameter, given in self.instance.parameters:
            if parameter == name:
                component = self.instance.component
                of_type = next(p.type for p in component.parameters if p.name == name)
                return scalar(self.system, of_type, given)
        return None

    def _copy_in(self, name: str, target: str) -> Stmt:
        """Read what ``name`` denotes into ``target``."""
        component = self.instance.component
        if (given := self._parameter(name)) is not None:
            return Assign(target, given)
        binding = self.system.bound.get((self.instance.name, name))
        if binding is not None and binding.need.is_read:
            return self._read_command(binding, target)
        if any(d.name == name for d in component.data) and not self._has_object(name):
            return Assign(target, Ref(f"{ada_case(name)}_Own"))
        return Do(f"{ada_case(name)}_Board.Read", arguments(Ref(target)))

    def _read_command(self, binding: Binding, target: str) -> Stmt:
        """Read what a required command gives: of a device or task, or what stands in."""
        need, provider = binding.need, binding.provider
        if need.stand_in is not None and provider is None:
            return self._copy_in(need.stand_in.item, target)
        if isinstance(provider, RemoteRead):
            return Do(f"{copy_name(need)}.Read", arguments(Ref(target)))
        assert isinstance(provider, Device | Server)
        owner = provider.instance if isinstance(provider, Server) else provider.name
        return Do(f"{ada_case(owner)}.{ada_case(need.name)}", arguments(Ref(target)))

    def _step_region(self, shape: RegionShape, package: str) -> Subprogram:
        region = shape.region
        name = ada_case(region.name)
        declarations: list[Decl] = [
            Object("Now", f"{package}.Occurrence"),
            Object("Fired", f"{package}.{'Firings.List' if shape.listed else 'Selection'}"),
        ]
        if len(shape.lanes) > 1 and self._note("State", region.name, "region"):
            states = f"{self.component}.{shape.states}"
            owners = {t for n in shape.lanes if n.owner for t in shape.compared_types(n.owner)}
            declarations += [UseType(f"{states}.{t}") for t in sorted(owners)]
        after = self._after_step(shape, package)
        if not shape.listed and not isinstance(after[0], Pragma):
            declarations.append(UseType(f"{package}.Selection"))
        polled = [Ref(f"{name}_Region"), Ref("Now")]
        polls_event = len(shape.poll_params()) > len(polled)
        polled += [Ref("Event")] if polls_event else []
        body: list[Stmt] = [Do(f"{package}.Poll", arguments(*polled))]
        if region.events():
            begins = shape.takes_item and not polls_event
            start = null_event(self.instance.component) if begins else None
            declarations += [
                UseType(f"{package}.Occurrence"),
                Object("Event", f"{self.component}.Event", start),
                Object("Status", "Ravenchart.Queueing.Take_Status"),
                UseType("Ravenchart.Queueing.Take_Status"),
            ]
            taken = equal(Ref("Status"), Ref("Ravenchart.Queueing.Taken"))
            convert = Assign("Now", call(f"{package}.To_Occurrence", Ref("Event")))
            idle = equal(Ref("Now"), Ref(f"{package}.Conditions"))
            take = Do(f"{name}_Queue.Take", arguments(Ref("Event"), Ref("Status")))
            body.append(IfStatement(((idle, (take, IfStatement(((taken, (convert,)),)))),)))
        args = [Ref(f"{name}_Region"), Ref("Now")]
        args += [Ref("Ins")] if shape.inputs else []
        args += [Ref("Event")] if shape.takes_item else []
        if shape.has_box:
            declarations.append(Object("Box", f"{package}.Outbox"))
            args.append(Ref("Box"))
        body.append(Do(f"{package}.Step", arguments(*args, Ref("Fired"))))
        if self.noted:
            body.append(do("Ravenchart.Steps.Finish", Ref(f'"{self._element(region.name)}"')))
        body += after
        if shape.deferring:
            lost = f"{name}_Region.Deferred.Lost"
            told = [self._fault("Queue_Overflow", region.name, "region")]
            told += [self._raise(region.on_overflow)] if region.on_overflow is not None else []
            body.append(IfStatement(((Ref(lost), (*told, Assign(lost, Ref("False")))),)))
        params = (Param("Ins", "in", f"{package}.Inputs"),) if shape.inputs else ()
        return Subprogram(
            f"Step_{name}", params, declarations=tuple(declarations), body=tuple(body)
        )

    def _after_step(self, shape: RegionShape, package: str) -> list[Stmt]:
        """Report what fired; then send and raise what the step asked for."""
        region = shape.region
        moved = self._report_firings(shape, package)
        moved += self._report_leaves(shape)
        for port in self.instance.component.outputs():
            if port.name in region.sends and not self._is_idle(port):
                box = f"Box.{ada_case(port.name)}"
                item = () if port.is_void else arguments(Ref(box))
                send = Do(send_flag(port), item)
                moved.append(IfStatement(((Ref(f"{box}_Sent"), (send,)),)))
        if region.raises:
            lists = f"{self.component}.Event_Lists"
            offer = Do("Offer", arguments(call(f"{lists}.Element", Ref("Box.Raised"), Ref("I"))))
            moved.append(Loop(f"for I in 1 .. {lists}.Count (Box.Raised)", (offer,)))
        if not moved:
            return [Pragma("Unreferenced", (Ref("Fired"),))]
        any_fired = OperatorChain("/=", (Ref("Fired"), Ref(f"{package}.None")))
        if shape.listed:
            any_fired = OperatorChain(">", (Ref("Fired.Count"), number(0)))
        return [IfStatement(((any_fired, tuple(moved)),))]

    def _report_firings(self, shape: RegionShape, package: str) -> list[Stmt]:
        fired = Ref("Fired.Items (I)" if shape.listed else "Fired")
        first = Call(f"{package}.Selection'Pos", arguments(Ref(f"{package}.Transition'First")))
        position = OperatorChain("-", (Call(f"{package}.Selection'Pos", arguments(fired)), first))
        taken = self._note("Transition", shape.region.name, "region", position)
        if not taken:
            return []
        report = IfStatement(((OperatorChain("in", (fired, Ref(f"{package}.Transition"))), taken),))
        return [Loop("for I in 1 .. Fired.Count", (report,)) if shape.listed else report]

    def _report_leaves(self, shape: RegionShape) -> list[Stmt]:
        """The leaf of each lane; that of a lane inside a state only while that is active."""
        found: list[Stmt] = []
        held = f"{ada_case(shape.region.name)}_Region.{shape.place}"
        prefix = f"{self.component}."
        for lane in reversed(shape.lanes):
            of_type = f"{prefix}{shape.states}.{shape.lane_type(lane)}"
            leaf = Call(f"{of_type}'Pos", arguments(Ref(shape.at(held, lane))))
            note = self._note("State", shape.traced(lane), "region", leaf)
            if lane.owner is not None and note:
                note = (IfStatement(((shape.in_state(held, lane.owner, prefix), note),)),)
            found += note
        return found

    # --- body: activities

    def run_activity(self, activity: Activity) -> Subprogram:
        component = self.instance.component
        declarations: list[Decl] = []
        before: list[Stmt] = []
        args: list[Arg] = []
        after: list[Stmt] = []
        reads = [n for n in activity.reads if n not in activity.writes]
        provided = component.served_by(activity.name)
        if provided is not None:
            declarations += asked(self.system, self.instance, provided)
            args += asked_args(self.system, self.instance, provided)
        guard: Expr | None = None
        if activity.while_in is not None:
            region = component.region(activity.while_in.region)
            guard = self._active_in(region, activity.while_in.state, declarations)
        if activity.completes is not None:
            declarations.append(Object("Visit", "Ravenchart.Event_Count"))
            before.append(do(f"{ada_case(activity.name)}_Visit_Board.Read", Ref("Visit")))
        self._take_in(reads, _told(activity), declarations, before, args)
        for name in activity.writes:
            own = f"{ada_case(name)}_Own"
            args.append(Arg(ada_case(name), Ref(own)))
            if self._has_object(name):
                after.append(Do(f"{ada_case(name)}_Board.Write", arguments(Ref(own))))
            after += self._record(name, own)
        for port in component.outputs():
            if port.name in activity.sends:
                after += self._send_from(activity, port, declarations, args)
        for event in activity.raises:
            flag = raise_flag(event)
            declarations.append(Object(flag, "Boolean"))
            args.append(Arg(flag, Ref(flag)))
            if event == DONE:
                done = do(f"{ada_case(activity.name)}_Done_Board.Write", Ref("Visit"))
                after.append(IfStatement(((Ref(flag), (done,)),)))
                continue
            given: Expr | None = None
            if (carried := raised_type(component, event)) is not None:
                given = Ref(raise_value(event))
                declarations.append(Object(raise_value(event), type_name(self.system, carried)))
                args.append(Arg(raise_value(event), given))
            after.append(IfStatement(((Ref(flag), (self._raise(event, given),)),)))
        home = activity_package(component, activity)
        work = Do(f"{self.component}.{home}.{ada_case(activity.name)}", tuple(args))
        expected = [p.name for p in activity_params(self.system, component, activity)]
        assert expected == [a.name for a in args], (expected, args)
        body: tuple[Stmt, ...] = (*before, work, *after)
        if provided is not None:
            loop = served(self.system, self.instance, provided, body)
            body = (Loop(f"for Unused in 1 .. {provided.depth}", loop),)
        if guard is not None:
            region_name = ada_case(activity.while_in.region)  # type: ignore[union-attr]
            read = Do(f"{region_name}_Board.Read", arguments(Ref(f"{region_name}_Now")))
            body = (read, IfStatement(((guard, body),)))
        sent = publishes(self.system, self.instance, activity, declarations)
        body = (*watched(self.system, self.instance, activity), *body, *sent)
        body = (*body, *transmits(self.system, self.instance, activity))
        return Subprogram(
            f"Run_{ada_case(activity.name)}", declarations=tuple(declarations), body=body
        )

    def _take_in(
        self,
        reads: list[str],
        known: Mapping[str, str],
        declarations: list[Decl],
        before: list[Stmt],
        args: list[Arg],
    ) -> None:
        """Copies of what an activity reads, except of what is ``known``."""
        component = self.instance.component
        for name in reads:
            read_as = reading_type(self.system, component, name)
            if name in known:
                args.append(Arg(ada_case(name), Ref(known[name])))
                continue
            constant = self._parameter(name)
            if constant is not None and read_as == "Boolean":
                #  the compiler warns of a variable that it knows to be true
                args.append(Arg(ada_case(name), constant))
                continue
            local = f"{ada_case(name)}_Value"
            declarations.append(Object(local, read_as))
            before.append(self._copy_in(name, local))
            args.append(Arg(ada_case(name), Ref(local)))

    def _send_from(
        self, activity: Activity, port: Port, declarations: list[Decl], args: list[Arg]
    ) -> list[Stmt]:
        """Take a value to send from an activity, and send it; nothing where nobody takes it."""
        name, idle = ada_case(port.name), "Unused_" if self._is_idle(port) else ""
        send: Stmt = Do(send_flag(port))
        if not port.is_void:
            local = f"{idle}{name}_Value"
            declarations.append(Object(local, type_name(self.system, port.type)))
            args.append(Arg(name, Ref(local)))
            send = Do(send_flag(port), arguments(Ref(local)))
        if has_flag(activity, port):
            flag, asked = send_flag(port), f"{idle}{send_flag(port)}_Asked"
            declarations.append(Object(asked, "Boolean"))
            args.append(Arg(flag, Ref(asked)))
            send = IfStatement(((Ref(asked), (send,)),))
        return [] if idle else [send]

    def _active_in(self, region: Region, state: str, declarations: list[Decl]) -> Expr:
        now = f"{ada_case(region.name)}_Now"
        places = Places(region)
        declarations.append(Object(now, f"{self.component}.{places.place_type}"))
        states = f"{self.component}.{places.states}"
        declarations += [UseType(f"{states}.{t}") for t in places.compared_types(state)]
        return places.in_state(now, state, f"{self.component}.")


def _told(activity: Activity) -> dict[str, str]:
    """What the test of a do activity's state has read, where the contract requires that state."""
    if activity.while_in is None:
        return {}
    region = activity.while_in.region
    required = {name for clause in activity.requires for name in names_in(clause.condition)}
    return {region: f"{ada_case(region)}_Now"} if region in required else {}
