# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One execution of a port region, a region or an activity: copy in, call, publish."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ravenchart.gen.emit.ada.declarations import Decl, Object, Param, Subprogram, UseType
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    Arg,
    Attribute,
    Expr,
    Indexed,
    OperatorChain,
    StringLiteral,
    arguments,
    call,
    equal,
    member,
    number,
    plain,
    up_to,
)
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import TRUTH, ada_case, scalar, type_name
from ravenchart.gen.emit.ada.statements import (
    Assign,
    Case,
    Do,
    ForLoop,
    IfStatement,
    Loop,
    Pragma,
    Stmt,
    do,
)
from ravenchart.gen.emit.charts.several_transitions import LIST
from ravenchart.gen.emit.charts.shape import RegionShape
from ravenchart.gen.emit.commands.device_calls import (
    asked_args,
    forwarded,
    request_objects,
    served,
)
from ravenchart.gen.emit.commands.gathered_calls import array_reads, read_array
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
from ravenchart.gen.emit.language.configurations import Configurations
from ravenchart.gen.emit.language.events import null_event
from ravenchart.gen.emit.language.terms import names_read
from ravenchart.gen.model.commands import (
    Binding,
    Device,
    Gathered,
    Poll,
    Provided,
    RemoteRead,
    Server,
)
from ravenchart.gen.model.component import Activity, Port
from ravenchart.gen.model.statechart import DONE, Region

from .instants import link_to, release_of, sends_visibly, visible_of
from .releasing import wakes
from .site import Site
from .transmission import flow_control, transmits


class Rows(Site):
    """The rows of processors' tables that belong to one instance."""

    # --- body: the port region and its groups

    def run_ports(self, handler: str) -> Subprogram:
        component = self.instance.component
        period, ports = component.handlers()[handler].period, component.handled(handler)
        declarations: list[Decl] = [
            Object("Status", "Ravenchart.Queueing.Take_Status"),
            UseType("Ravenchart.Queueing.Take_Status"),
        ]
        if any(p.on_overflow for p in ports):
            declarations.append(UseType("Ravenchart.Event_Count"))
        body: list[Stmt] = []
        for poll in self.system.polls:
            if poll.instance == self.instance.name and component.handler(poll.port) == handler:
                asked = f"{ada_case(poll.port)}_Told"
                told = self.instance.component.port(poll.port).type
                declarations.append(Object(asked, type_name(self.system, told)))
                declarations.append(Object(f"{asked}_Now", "Boolean"))
                body += self._asked_for(poll, asked)
        for port in ports:
            name = ada_case(port.name)
            declarations.append(Object(f"{name}_Item", type_name(self.system, port.type)))
            declarations.append(
                Object(f"{name}_Change", ref(self.component, f"{name}_Port", "Change"))
            )
            limit: Expr = ref(self.component, f"{name}_Port", "Never_Stale")
            if port.max_age is not None:
                limit = number(port.max_age // period)
            now = () if link_to(self, port) is None else (release_of(handler),)
            taken = ref(f"{name}_Item"), ref("Status")
            body.append(do(ref(self._mailbox(port), "Take"), *now, *taken))
            body.append(
                do(
                    ref(self.component, f"{name}_Port", "Handle"),
                    ref(f"{name}_Port"),
                    Arrived=equal(ref("Status"), ref("Ravenchart.Queueing.Taken")),
                    Item=ref(f"{name}_Item"),
                    Limit=limit,
                    Outcome=ref(f"{name}_Change"),
                )
            )
            if self._has_object(port.name):
                body.append(do(ref(f"{name}_Board", "Write"), ref(f"{name}_Port")))
            if port.on_overflow:
                declarations.append(Object(f"{name}_Losses", "Ravenchart.Event_Count"))
                body += self._watch_losses(port, port.on_overflow)
            body.append(self._react(port))
        body += flow_control(self.system, self.instance, handler)
        run = f"Run_{ada_case(handler)}"
        return Subprogram(run, declarations=tuple(declarations), body=tuple(body))

    def _asked_for(self, poll: Poll, told: str) -> list[Stmt]:
        """Ask a device for an event, and take it like a value that has arrived."""
        asked = ref(ada_case(poll.device.name), ada_case(poll.event))
        arrived = do(ref(f"Put_{ada_case(poll.port)}"), ref(told))
        return [
            do(asked, ref(f"{told}_Now"), ref(told)),
            IfStatement(((ref(f"{told}_Now"), (arrived,)),)),
        ]

    def _watch_losses(self, port: Port, event: str) -> list[Stmt]:
        """Raise the overflow event when the mailbox has lost more than last time."""
        name = ada_case(port.name)
        grown = OperatorChain("/=", (ref(f"{name}_Losses"), ref(f"{name}_Lost_Before")))
        return [
            Assign(f"{name}_Losses", ref(self._mailbox(port), "Lost")),
            IfStatement(((grown, (self._raise(event),)),)),
            Assign(f"{name}_Lost_Before", ref(f"{name}_Losses")),
        ]

    def _react(self, port: Port) -> Stmt:
        name = ada_case(port.name)
        package = ref(self.component, f"{name}_Port")
        arrived: list[Stmt] = [*self._note("Handled", port.name, "port")]
        arrived += self._record(port.name, f"{name}_Port.Value")
        if port.on_arrival:
            arrived.append(self._raise(port.on_arrival, ref(f"{name}_Port", "Value")))
        stale: list[Stmt] = [self._fault("Stale_Input", port.name, "port")]
        if port.on_stale:
            stale.append(self._raise(port.on_stale))
        rows = (
            (ref(package, "Nothing"), ()),
            (ref(package, "Arrival"), tuple(arrived)),
            (ref(package, "Became_Stale"), tuple(stale)),
        )
        return Case(ref(f"{name}_Change"), rows)

    # --- body: regions

    def run_region(self, region: Region) -> list[Subprogram]:
        shape = RegionShape(self.system, self.instance.component, region, noted=self.noted)
        name = ada_case(region.name)
        package = ref(self.component, name)
        step = self._step_region(shape, package)
        declarations: list[Decl] = []
        body: list[Stmt] = [*watched(self.system, self.instance, region)]
        step_args: tuple[Arg, ...] = ()
        if shape.inputs:
            declarations.append(Object("Ins", ref(package, "Inputs")))
            body += [self._copy_in(n, ref("Ins", ada_case(n))) for n in shape.inputs]
            step_args = arguments(ref("Ins"))
        completing = self.instance.component.completing(region.name)
        if completing:
            declarations.append(Object("Visit", "Ravenchart.Event_Count"))
        for activity, state in completing:
            notice = ref(package, f"Notice_{ada_case(state)}")
            body.append(do(ref(f"{ada_case(activity.name)}_Done_Board", "Read"), ref("Visit")))
            body.append(do(notice, ref(f"{name}_Region"), ref("Visit")))
        if shape.timers:
            body.append(do(ref(package, "Tick"), ref(f"{name}_Region")))
        one: Stmt = Do(f"Step_{name}", step_args)
        if region.steps_per_execution > 1:
            one = Loop(_times(region.steps_per_execution), (one,))
        body.append(one)
        #  visits before states: who sees a state entered sees that visit, or a later one
        for activity, state in completing:
            visits = ref(f"{name}_Region", shape.visits(state))
            body.append(do(ref(f"{ada_case(activity.name)}_Visit_Board", "Write"), visits))
        held = ref(f"{name}_Region", shape.configuration_name)
        body.append(do(ref(f"{name}_Board", "Write"), held))
        for data in self.instance.component.data:
            if data.name not in region.writes:
                continue
            field = ref(f"{name}_Region", "Data", ada_case(data.name))
            if self._has_object(data.name):
                body.append(do(ref(f"{ada_case(data.name)}_Board", "Write"), field))
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

    def _copy_in(self, name: str, target: Named) -> Stmt:
        """Read what ``name`` denotes into ``target``."""
        component = self.instance.component
        if (given := self._parameter(name)) is not None:
            return Assign(ref(target), given)
        binding = self.system.bound.get((self.instance.name, name))
        if binding is not None and binding.need.is_read:
            return self._read_command(binding, target)
        if any(d.name == name for d in component.data) and not self._has_object(name):
            return Assign(ref(target), ref(f"{ada_case(name)}_Own"))
        return do(ref(f"{ada_case(name)}_Board", "Read"), ref(target))

    def _read_command(self, binding: Binding, target: Named) -> Stmt:
        """Read the reply of a required command: of a device, of a task, or of the fallback."""
        need, provider = binding.need, binding.provider
        if need.fallback is not None and provider is None:
            return self._copy_in(need.fallback.item, target)
        if isinstance(provider, Gathered):
            return read_array(binding, ref(target))
        if isinstance(provider, RemoteRead):
            return do(ref(copy_name(need), "Read"), ref(target))
        assert isinstance(provider, Device | Server)
        owner = provider.instance if isinstance(provider, Server) else provider.name
        return do(ref(ada_case(owner), ada_case(need.command.name)), ref(target))

    def read_arrays(self) -> Iterator[Subprogram]:
        """How the rows read arrays."""
        yield from array_reads(self.system, self.instance, self._read_command)

    def _step_region(self, shape: RegionShape, package: Named) -> Subprogram:
        region = shape.region
        name = ada_case(region.name)
        declarations: list[Decl] = [
            Object("Now", ref(package, "Occurrence")),
            Object("Fired", ref(package, LIST if shape.listed else "Selection")),
        ]
        if len(shape.concurrent) > 1 and self._note("State", region.name, "region"):
            states = ref(self.component, shape.states)
            owners = {t for r in shape.concurrent if r.owner for t in shape.compared_types(r.owner)}
            declarations += [UseType(ref(states, t)) for t in sorted(owners)]
        after = self._after_step(shape, package)
        if not shape.listed and not isinstance(after[0], Pragma):
            declarations.append(UseType(ref(package, "Selection")))
        polled = [ref(f"{name}_Region"), ref("Now")]
        polls_event = len(shape.poll_params()) > len(polled)
        polled += [ref("Event")] if polls_event else []
        body: list[Stmt] = [do(ref(package, "Poll"), *polled)]
        if region.events():
            begins = shape.takes_item and not polls_event
            start = null_event(self.instance.component) if begins else None
            declarations += [
                UseType(ref(package, "Occurrence")),
                Object("Event", ref(self.component, "Event"), start),
                Object("Status", "Ravenchart.Queueing.Take_Status"),
                UseType("Ravenchart.Queueing.Take_Status"),
            ]
            taken = equal(ref("Status"), ref("Ravenchart.Queueing.Taken"))
            convert = Assign("Now", call(ref(package, "To_Occurrence"), ref("Event")))
            idle = equal(ref("Now"), ref(package, "Conditions"))
            take = do(ref(f"{name}_Queue", "Take"), ref("Event"), ref("Status"))
            body.append(IfStatement(((idle, (take, IfStatement(((taken, (convert,)),)))),)))
        args = [ref(f"{name}_Region"), ref("Now")]
        args += [ref("Ins")] if shape.inputs else []
        args += [ref("Event")] if shape.takes_item else []
        if shape.has_box:
            declarations.append(Object("Box", ref(package, "Outbox")))
            args.append(ref("Box"))
        body.append(do(ref(package, "Step"), *args, ref("Fired")))
        if self.noted:
            body.append(do("Ravenchart.Steps.Finish", StringLiteral(self._element(region.name))))
        body += after
        if shape.deferring:
            lost = ref(f"{name}_Region", "Deferred.Lost")
            told = [self._fault("Queue_Overflow", region.name, "region")]
            told += [self._raise(region.on_overflow)] if region.on_overflow is not None else []
            body.append(IfStatement(((lost, (*told, Assign(lost, FALSE))),)))
        params = (Param("Ins", "in", ref(package, "Inputs")),) if shape.inputs else ()
        return Subprogram(
            f"Step_{name}", params, declarations=tuple(declarations), body=tuple(body)
        )

    def _after_step(self, shape: RegionShape, package: Named) -> list[Stmt]:
        """Report what fired; then send and raise what the step asked for."""
        region = shape.region
        moved = self._report_firings(shape, package)
        moved += self._report_leaves(shape)
        for port in self.instance.component.outputs():
            if port.name in region.sends and not self._is_idle(port):
                box = ref("Box", ada_case(port.name))
                item = () if port.is_void else arguments(box, *self._visible(region.name, port))
                send = Do(send_flag(port), item)
                moved.append(IfStatement(((ref("Box", f"{ada_case(port.name)}_Sent"), (send,)),)))
        if region.raises:
            lists = ref(self.component, "Event_Lists")
            each = up_to(call(ref(lists, "Count"), ref("Box.Raised")))
            offer = do("Offer", call(ref(lists, "Element"), ref("Box.Raised"), ref("I")))
            moved.append(Loop(ForLoop("I", each), (offer,)))
        if not moved:
            return [Pragma("Unreferenced", (ref("Fired"),))]
        any_fired = OperatorChain("/=", (ref("Fired"), ref(package, "None")))
        if shape.listed:
            any_fired = OperatorChain(">", (ref("Fired.Count"), number(0)))
        return [IfStatement(((any_fired, tuple(moved)),))]

    def _report_firings(self, shape: RegionShape, package: Named) -> list[Stmt]:
        fired = Indexed("Fired.Items", ref("I")) if shape.listed else ref("Fired")
        position_of = Attribute(ref(package, "Selection"), "Pos")
        first = Attribute(ref(package, "Transition"), "First")
        position = OperatorChain("-", (call(position_of, fired), call(position_of, first)))
        taken = self._note("Transition", shape.region.name, "region", position)
        if not taken:
            return []
        report = IfStatement(((member(fired, ref(package, "Transition")), taken),))
        each = ForLoop("I", up_to(ref("Fired.Count")))
        return [Loop(each, (report,)) if shape.listed else report]

    def _report_leaves(self, shape: RegionShape) -> list[Stmt]:
        """The leaf of each region; that of an orthogonal region only while its state is active."""
        found: list[Stmt] = []
        held = ref(f"{ada_case(shape.region.name)}_Region", shape.configuration_name)
        for region in reversed(shape.concurrent):
            of_type = ref(self.component, shape.states, shape.leaves_type(region))
            leaf = call(Attribute(of_type, "Pos"), shape.at(held, region))
            note = self._note("State", shape.traced(region), "region", leaf)
            if region.owner is not None and note:
                active = shape.in_state(held, region.owner, self.component)
                note = (IfStatement(((active, note),)),)
            found += note
        return found

    # --- body: activities

    def run_activity(self, activity: Activity) -> Subprogram:
        component = self.instance.component
        if activity.forwards:
            return self._run_forwarding(activity)
        declarations: list[Decl] = []
        before: list[Stmt] = []
        args: list[Arg] = []
        after: list[Stmt] = []
        reads = [n for n in activity.reads if n not in activity.writes]
        provided = component.served_by(activity.name)
        if provided is not None:
            declarations += request_objects(self.system, self.instance, provided)
            args += asked_args(self.system, self.instance, provided)
        guard: Expr | None = None
        if activity.while_in is not None:
            region = component.region(activity.while_in.region)
            guard = self._active_in(region, activity.while_in.state, declarations)
        if activity.completes is not None:
            declarations.append(Object("Visit", "Ravenchart.Event_Count"))
            before.append(do(ref(f"{ada_case(activity.name)}_Visit_Board", "Read"), ref("Visit")))
        self._take_in(reads, _told(activity), declarations, before, args)
        for name in activity.writes:
            own = f"{ada_case(name)}_Own"
            args.append(Arg(ada_case(name), ref(own)))
            if self._has_object(name):
                after.append(do(ref(f"{ada_case(name)}_Board", "Write"), ref(own)))
            after += self._record(name, own)
        for port in component.outputs():
            if port.name in activity.sends:
                after += self._send_from(activity, port, declarations, args)
        for event in activity.raises:
            flag = raise_flag(event)
            declarations.append(Object(flag, "Boolean"))
            args.append(Arg(flag, ref(flag)))
            if event == DONE:
                done = do(ref(f"{ada_case(activity.name)}_Done_Board", "Write"), ref("Visit"))
                after.append(IfStatement(((ref(flag), (done,)),)))
                continue
            given: Expr | None = None
            if (carried := raised_type(component, event)) is not None:
                given = ref(raise_value(event))
                declarations.append(Object(raise_value(event), type_name(self.system, carried)))
                args.append(Arg(raise_value(event), given))
            after.append(IfStatement(((ref(flag), (self._raise(event, given),)),)))
        body: tuple[Stmt, ...] = (*before, self._work(activity, args), *after)
        if provided is not None:
            body = (self._serving(provided, body),)
        if guard is not None:
            region_name = ada_case(activity.while_in.region)  # type: ignore[union-attr]
            read = do(ref(f"{region_name}_Board", "Read"), ref(f"{region_name}_Now"))
            body = (read, IfStatement(((guard, body),)))
        return self._execution(activity, declarations, body)

    def _run_forwarding(self, activity: Activity) -> Subprogram:
        """Each request is a call: no procedure of the component stands between."""
        provided = self.instance.component.served_by(activity.name)
        assert provided is not None
        declarations = request_objects(self.system, self.instance, provided)
        calls = forwarded(self.system, self.instance, provided)
        return self._execution(activity, declarations, (self._serving(provided, calls),))

    def _serving(self, provided: Provided, work: tuple[Stmt, ...]) -> Loop:
        """The requests of one execution."""
        many = 1 if wakes(self, provided) else provided.depth  # one call in a release
        return Loop(_times(many), served(self.system, self.instance, provided, work))

    def _execution(
        self, activity: Activity, declarations: list[Decl], body: tuple[Stmt, ...]
    ) -> Subprogram:
        """An execution: what other nodes wait for stands before and behind its work."""
        sent = publishes(self.system, self.instance, activity, declarations)
        body = (*watched(self.system, self.instance, activity), *body, *sent)
        body = (*body, *transmits(self.system, self.instance, activity))
        return Subprogram(
            f"Run_{ada_case(activity.name)}", declarations=tuple(declarations), body=body
        )

    def _work(self, activity: Activity, args: list[Arg]) -> Do:
        """The call of an activity's procedure, with all its parameters."""
        home = activity_package(self.instance.component, activity)
        expected = [p.name for p in activity_params(self.system, self.instance.component, activity)]
        assert expected == [a.name for a in args], (expected, args)
        return Do(ref(self.component, home, ada_case(activity.name)), tuple(args))

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
                args.append(Arg(ada_case(name), ref(known[name])))
                continue
            constant = self._parameter(name)
            if constant is not None and read_as == TRUTH:
                #  the compiler warns of a variable that it knows to be true
                args.append(Arg(ada_case(name), constant))
                continue
            local = f"{ada_case(name)}_Value"
            declarations.append(Object(local, read_as))
            before.append(self._copy_in(name, local))
            args.append(Arg(ada_case(name), ref(local)))

    def _send_from(
        self, activity: Activity, port: Port, declarations: list[Decl], args: list[Arg]
    ) -> list[Stmt]:
        """Take a value to send from an activity, and send it; nothing where nobody takes it."""
        name, idle = ada_case(port.name), "Unused_" if self._is_idle(port) else ""
        send: Stmt = do(send_flag(port))
        if not port.is_void:
            local = f"{idle}{name}_Value"
            declarations.append(Object(local, type_name(self.system, port.type)))
            args.append(Arg(name, ref(local)))
            send = do(send_flag(port), ref(local), *self._visible(activity.name, port))
        if has_flag(activity, port):
            flag, asked = send_flag(port), f"{idle}{send_flag(port)}_Asked"
            declarations.append(Object(asked, "Boolean"))
            args.append(Arg(flag, ref(asked)))
            send = IfStatement(((ref(asked), (send,)),))
        return [] if idle else [send]

    def _visible(self, row: str, port: Port) -> tuple[DottedName, ...]:
        """From when on what a row sends is visible, where its port has to be told."""
        return (visible_of(row),) if sends_visibly(self, port.name) else ()

    def _active_in(self, region: Region, state: str, declarations: list[Decl]) -> Expr:
        now = f"{ada_case(region.name)}_Now"
        chart = Configurations(region)
        declarations.append(Object(now, ref(self.component, chart.configuration_type)))
        states = ref(self.component, chart.states)
        declarations += [UseType(ref(states, t)) for t in chart.compared_types(state)]
        return chart.in_state(now, state, self.component)


def _times(count: int) -> ForLoop:
    return ForLoop("Unused", up_to(plain(count)))


def _told(activity: Activity) -> dict[str, str]:
    """The state that the test of a do activity has read, where the contract requires it."""
    if activity.while_in is None:
        return {}
    region = activity.while_in.region
    required = {name for clause in activity.requires for name in names_read(clause.condition)}
    return {region: f"{ada_case(region)}_Now"} if region in required else {}
