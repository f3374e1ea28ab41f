# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The command dictionary, and the interfaces of components: their forms resolved."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ravenchart.gen.files.schema import ComponentForm
from ravenchart.gen.files.schema_devices import CommandForm, NeedForm, ProvidedForm, RequiredForm
from ravenchart.gen.language.names import Findings, NameScope
from ravenchart.gen.language.terms import BOOLEAN, Field, RecordType, Type, default
from ravenchart.gen.model.commands import (
    Command,
    CommandKind,
    Fallback,
    InterfaceEvent,
    Need,
    Provided,
    Published,
    Request,
)
from ravenchart.gen.model.component import Activity, Component, Data, Direction, Event, Port
from ravenchart.gen.origins import Origin

from .members import Members, Namespace
from .protocols import protocol_of

NOTHING = "nothing"
"""The fallback of a call that may be lost."""


# --- The dictionary ----------------------------------------------------------------


def command_of(
    name: str, form: CommandForm, types: NameScope[Type], findings: Findings
) -> Command | None:
    """An entry of the dictionary whose types fit its kind."""
    kind = CommandKind(form.kind)
    before = findings.count()
    sides: dict[str, Type | None] = {}
    for key, text, needed, allowed in (
        ("argument", form.argument, kind.takes, kind.takes),
        ("reply", form.reply, kind.gives, kind is not CommandKind.EVENT),
    ):
        sides[key] = None if text is None else types.look_up(text, form.at(key), findings)
        if text is None and needed and not form.lost(key):
            message = f"the {_words(kind)} {name} needs the key `{key}`"
            findings.error("RV-1201", form.origin, message, hint=f"give the type: `{key}: ...`")
        elif text is not None and not allowed:
            message = f"a {_words(kind)} has no {key}"
            other = "write" if kind is CommandKind.VOID else "qualified_read"
            hint = f"make it `kind: {other}`, or remove `{key}`"
            if kind is CommandKind.EVENT:
                message, hint = "an event cannot declare `reply`", "remove `reply`"
            findings.error("RV-1201", form.at_key(key), message, hint=hint)
    kinds = [type_ for type_ in sides.values() if type_ is not None]
    if form.per_axis and findings.count() == before:
        if not kinds:
            message = f"`per_axis` has no meaning for {name}, which has neither argument nor reply"
            findings.error("RV-1202", form.at_key("per_axis"), message, hint="remove `per_axis`")
        for record in (type_ for type_ in kinds if isinstance(type_, RecordType)):
            message = f"{name} is per axis, but {record.name} is a record"
            hint = "name the type of one axis's value: a range or an enumeration"
            findings.error("RV-1202", form.at_key("per_axis"), message, hint=hint)
    if findings.count() > before or form.damaged:
        return None
    return Command(name, form.origin, kind, sides["argument"], sides["reply"], form.per_axis)


def _words(kind: CommandKind) -> str:
    return "event" if kind is CommandKind.EVENT else f"{kind.value.replace('_', ' ')} command"


def declare_vectors(
    dictionary: NameScope[Command], counts: Iterable[int], types: NameScope[Type]
) -> None:
    """The records of one value per axis, for the numbers of axes that are used."""
    for command in dictionary.sound():
        for count in sorted(set(counts)):
            at_axes(command, count, types)
    types.open = types.open or dictionary.has_lost()


def at_axes(command: Command, axes: int, types: NameScope[Type]) -> tuple[Type | None, Type | None]:
    """Argument and reply of a command in an interface of so many axes."""
    return _vector(command, command.argument, axes, types), _vector(
        command, command.reply, axes, types
    )


def _vector(
    command: Command, of_type: Type | None, axes: int, types: NameScope[Type]
) -> Type | None:
    """The record of one value of a type for each axis, declared when it is asked for first."""
    if not command.per_axis or axes == 1 or of_type is None or isinstance(of_type, RecordType):
        return of_type
    name, here = f"{of_type.name}_X{axes}", command.origin
    fields = (Field(f"axis_{number}", here, of_type) for number in range(1, axes + 1))
    if name.lower() not in types.items:
        types.declare(name, here, RecordType(name, here, tuple(fields)))
    return types.find(name)


# --- Required interfaces -----------------------------------------------------------


def needs_of(
    form: ComponentForm,
    dictionary: NameScope[Command],
    types: NameScope[Type],
    members: Members,
    space: Namespace,
) -> tuple[Need, ...]:
    """The commands that a component requires; each becomes something to read or to send on."""
    found: NameScope[Need] = NameScope("required command")
    if form.lost("requires") or form.dropped("requires"):
        members.data_types.open = True
    for interface, at in (form.requires or {}).items():
        space.claim("required interface", interface, at.origin)
        if at.lost("commands") or at.list_damaged("commands") or at.dropped("commands"):
            members.data_types.open = True
        if at.commands is None and at.events is None and not at.damaged:
            message = f"{interface} needs the key `commands`, or `events`"
            space.findings.error("RV-0202", at.origin, message)
        for name, origin, said in named_commands(at):
            command = dictionary.look_up(name, origin, space.findings)
            made = None
            lost = command is None or _is_event(command, origin, space.findings)
            if command is not None and not lost and not at.lost("axes"):
                made = _need(interface, at.axes, command, origin, said, types, members, space)
            declared = name if command is None else command.name
            if found.declare(declared, origin, made, space.findings):
                space.claim("required command", declared, origin)
                _declare(declared, origin, command, made, members)
    return found.sound()


def named_commands(
    form: RequiredForm | ProvidedForm,
) -> list[tuple[str, Origin, NeedForm | None]]:
    """The commands of an interface, each with where it is named and its properties."""
    given = form.commands or ()
    if isinstance(given, Mapping):
        return [(n, form.entry_at("commands", n), said) for n, said in given.items()]
    return [(n, form.item_at("commands", i), None) for i, n in enumerate(given)]


def _need(
    interface: str,
    axes: int,
    command: Command,
    origin: Origin,
    form: NeedForm | None,
    types: NameScope[Type],
    members: Members,
    space: Namespace,
) -> Need | None:
    argument, reply = at_axes(command, axes, types)
    if form is None:
        return Need(command.name, origin, interface, axes, command, argument, reply)
    before = space.findings.count()
    is_read = command.kind is CommandKind.READ
    fallback = None
    if form.else_ is not None:
        fallback = _fallback(command, form, reply, members, space.findings)
    events: dict[str, Event | None] = {}
    for key, text in (
        ("on_reply", form.on_reply),
        ("on_full", form.on_full),
        ("on_timeout", form.on_timeout),
    ):
        at = form.at(key)
        events[key] = None if text is None else members.events.look_up(text, at, space.findings)
        has_meaning = key == "on_timeout" if is_read else key == "on_full" or reply is not None
        if text is not None and not has_meaning:
            why = "is read" if is_read else "gives no reply"
            message = f"`{key}` has no meaning for {command.name}, which {why}"
            space.findings.error("RV-1208", form.at_key(key), message, hint=f"remove `{key}`")
    _check_carried("on_reply", events["on_reply"], reply, command, form, space.findings)
    for key in ("on_full", "on_timeout"):
        _check_carried(key, events[key], None, command, form, space.findings)
    if space.findings.count() > before or form.damaged:
        return None
    raised = {key: None if event is None else event.name for key, event in events.items()}
    return Need(
        command.name,
        origin,
        interface,
        axes,
        command,
        argument,
        reply,
        optional=form.else_ is not None,
        fallback=fallback,
        on_reply=raised["on_reply"],
        on_full=raised["on_full"],
        on_timeout=raised["on_timeout"],
    )


def _check_carried(
    key: str,
    event: Event | None,
    given: Type | None,
    command: Command,
    form: NeedForm,
    findings: Findings,
) -> None:
    """An event that carries a value carries what there is."""
    if event is None or event.type is None or event.type is given:
        return
    told = "no value" if given is None else given.name
    message = f"{event.name} carries {event.type.name}, but `{key}` of {command.name} gives {told}"
    hint = "name an event without a type" + ("" if given is None else ", or of that one")
    findings.error("RV-0528", form.at(key), message, hint=hint)


def _fallback(
    command: Command,
    form: NeedForm,
    reply: Type | None,
    members: Members,
    findings: Findings,
) -> Fallback | None:
    """The activity and item that `else` names; None for `nothing`, or when it is wrong."""
    text, at = form.else_ or "", form.at("else")
    is_read = command.kind is CommandKind.READ
    if text == NOTHING:
        if is_read or reply is not None:
            message = f"{command.name} gives a reply, so its fallback cannot be `{NOTHING}`"
            hint = (
                "name the data item that holds the value: `else: activity.item`"
                if is_read
                else None
            )
            findings.error("RV-1207", at, message, hint=hint)
        return None
    if not is_read:
        message = f"`{text}` cannot be the fallback of {command.name}, which is called and not read"
        hint = f"write `else: {NOTHING}`: then a call does nothing"
        findings.error("RV-1207", at, message, hint=hint)
        return None
    activity, dot, item = text.partition(".")
    if not (dot and activity and item) or "." in item:
        findings.error("RV-0306", at, f"`{text}` must have the form activity.item")
        return None
    data = members.data.look_up(item, at, findings)
    if data is None:
        return None
    if data.type is not reply:
        expected = "" if reply is None else reply.name
        message = f"{data.name} is of type {data.type.name}, but {command.name} gives {expected}"
        notes = [(data.origin, f"`{data.name}` is declared here")]
        findings.error("RV-1207", at, message, notes=notes, hint=f"make it `type: {expected}`")
    return Fallback(activity, data.name)


def _declare(
    name: str, origin: Origin, command: Command | None, need: Need | None, members: Members
) -> None:
    """A required command as activities and flows see it: data to read, or a port to send on."""
    if command is None or command.kind is CommandKind.READ:
        made = None
        if need is not None and need.reply is not None:
            made = Data(name, origin, need.reply, default(need.reply), is_command=True)
        members.data.declare(name, origin, made)
    if command is None or command.kind is not CommandKind.READ:
        port = None
        if need is not None:
            carried = BOOLEAN if need.argument is None else need.argument
            port = Port(
                name,
                origin,
                Direction.OUT,
                carried,
                is_command=True,
                is_void=need.argument is None,
            )
        members.ports.declare(name, origin, port)
        item, last = f"{name}_Reply", None
        if need is not None and need.reply is not None:
            last = Data(item, origin, need.reply, default(need.reply), is_command=True)
        if need is None or last is not None:
            members.data.declare(item, origin, last)


def fallbacks_agree(form: ComponentForm, component: Component, findings: Findings) -> None:
    """The named activity writes the item of a fallback, and does nothing else for others."""
    for need in component.needs:
        if need.fallback is None:
            continue
        at = _else_at((form.requires or {})[need.interface], need.name)
        activities: NameScope[Activity] = NameScope("activity", open=form.lost("activities"))
        for one in component.activities:
            activities.declare(one.name, one.origin, one)
        for gone in form.dropped("activities"):
            activities.declare(gone, None, None)
        activity = activities.look_up(need.fallback.activity, at, findings)
        if activity is None:
            continue
        own, item = activity.name, need.fallback.item
        notes = [(activity.origin, f"{own} is declared here")]
        if item not in activity.writes:
            message = f"{own} does not write {item}"
            hint = "name the activity that writes the item"
            findings.error("RV-1207", at, message, notes=notes, hint=hint)
        for reader in component.runnables():
            taken = [name for name in activity.writes if name in reader.reads]
            if taken and reader.name != own:
                message = (
                    f"{own} writes {taken[0]}, which {reader.name} reads: it cannot be left out "
                    f"where {need.name} is provided"
                )
                hint = f"let {reader.name} read {need.name}, and write all else elsewhere"
                findings.error("RV-1207", at, message, notes=notes, hint=hint)
        for does in (*activity.sends, *activity.raises)[:1]:
            message = f"{own} does more than the fallback of {need.name} needs: {does}"
            hint = "let another activity send, call and raise"
            findings.error("RV-1207", at, message, notes=notes, hint=hint)


def _else_at(form: RequiredForm, name: str) -> Origin:
    said = form.commands[name] if isinstance(form.commands, Mapping) else None
    return form.origin if said is None else said.at("else")


# --- Events ------------------------------------------------------------------------


def _is_event(command: Command, origin: Origin, findings: Findings) -> bool:
    """Whether what stands among commands is an event, which is reported."""
    if command.kind is CommandKind.EVENT:
        message = f"expected a command, found the event {command.name}"
        hint = f"write `events: {{{command.name}: <port>}}`"
        findings.error("RV-1215", origin, message, hint=hint)
    return command.kind is CommandKind.EVENT


def heard_of(
    form: ComponentForm,
    dictionary: NameScope[Command],
    types: NameScope[Type],
    members: Members,
    findings: Findings,
) -> tuple[InterfaceEvent, ...]:
    """The events of the required interfaces."""
    return tuple(
        one
        for name, at in (form.requires or {}).items()
        for one in _events(name, at, Direction.IN, dictionary, types, members, findings)
    )


def _events(
    interface: str,
    form: RequiredForm | ProvidedForm,
    direction: Direction,
    dictionary: NameScope[Command],
    types: NameScope[Type],
    members: Members,
    findings: Findings,
) -> tuple[InterfaceEvent, ...]:
    """The events of an interface whose ports have the direction and type."""
    found: list[InterfaceEvent] = []
    for text, name in (form.events or {}).items():
        at, value = form.entry_at("events", text), form.place("events", text).origin
        command = dictionary.look_up(text, at, findings)
        port = members.ports.look_up(name, value, findings)
        if command is None or port is None:
            continue
        argument, _ = at_axes(command, form.axes, types)
        notes = [(port.origin, f"`{port.name}` is declared here")]
        if command.kind is not CommandKind.EVENT:
            message = f"{command.name} is a {_words(command.kind)} and no event"
            hint = "put it under `commands`, or make it `kind: event` where it is declared"
            findings.error("RV-1215", at, message, hint=hint)
        elif port.direction is not direction or port.is_command:
            way = "comes to an input" if direction is Direction.IN else "is sent on an output"
            message = f"{command.name} {way} port, but {port.name} is not one"
            findings.error("RV-1215", value, message, notes=notes)
        elif port.type is not argument:
            told = "" if argument is None else argument.name
            message = f"{port.name} is of type {port.type.name}, but {command.name} carries {told}"
            hint = f"make it `type: {told}`"
            findings.error("RV-1215", value, message, notes=notes, hint=hint)
        else:
            found.append(InterfaceEvent(command.name, at, interface, port.name))
    return tuple(found)


# --- Provided interfaces -----------------------------------------------------------


def _check_served(
    name: str, form: ProvidedForm, server: Activity | None, findings: Findings
) -> None:
    """Queued commands have a queue, and an activity that can execute them."""
    given = bool(form.commands)
    for key, value in (("queue", form.queue), ("served_by", form.served_by)):
        if given and value is None and not form.lost(key):
            message = f"{name} has queued commands and needs the key `{key}`"
            findings.error("RV-1209", form.origin, message)
        elif not (given or value is None or form.lost("commands") or form.list_damaged("commands")):
            message = f"`{key}` has no meaning without `commands`"
            findings.error("RV-1209", form.at_key(key), message, hint="name what is queued")
    if server is not None and (server.flow is not None or server.while_in is not None):
        message = f"{server.name} cannot serve {name}: it is a flow, or works in one state only"
        hint = f"give {server.name} `body: user` or `body: forward`, and no `while`"
        findings.error("RV-1209", form.at("served_by"), message, hint=hint)


def provided_of(
    name: str,
    form: ProvidedForm,
    dictionary: NameScope[Command],
    types: NameScope[Type],
    members: Members,
    activities: NameScope[Activity],
    findings: Findings,
) -> Provided | None:
    """A provided interface whose server and data exist and fit."""
    before = findings.count()
    server = None
    if form.served_by is not None:
        server = activities.look_up(form.served_by, form.at("served_by"), findings)
    _check_served(name, form, server, findings)
    requests: NameScope[Request | Published] = NameScope(f"command of {name}")
    for index, text in enumerate(form.commands or ()):
        at = form.item_at("commands", index)
        command = dictionary.look_up(text, at, findings)
        if command is not None and command.kind is CommandKind.READ:
            message = f"{command.name} is a read command: nothing is queued for it"
            hint = f"write `published: {{{command.name}: <data item>}}`"
            findings.error("RV-1209", at, message, hint=hint)
        elif command is not None and not _is_event(command, at, findings):
            made = Request(command, *at_axes(command, form.axes, types))
            requests.declare(command.name, at, made, findings)
    for text, item in (form.published or {}).items():
        at = form.entry_at("published", text)
        command = dictionary.look_up(text, at, findings)
        data = members.data.look_up(item, form.place("published", text).origin, findings)
        if command is None or data is None:
            continue
        _, reply = at_axes(command, form.axes, types)
        if _is_event(command, at, findings):
            continue
        if command.kind is not CommandKind.READ:
            message = f"{command.name} is no read command: it cannot be answered from data"
            findings.error("RV-1209", at, message, hint="put it under `commands`")
        elif data.type is not reply:
            expected = "" if reply is None else reply.name
            message = (
                f"{data.name} is of type {data.type.name}, but {command.name} gives {expected}"
            )
            notes = [(data.origin, f"`{data.name}` is declared here")]
            findings.error("RV-1209", at, message, notes=notes)
        requests.declare(command.name, at, Published(command, data.name), findings)
    events = _events(name, form, Direction.OUT, dictionary, types, members, findings)
    sound = requests.sound()
    commands = (one.command for one in sound)
    lost = findings.count() > before or form.damaged
    protocol = protocol_of(name, form.protocol, commands, findings, damaged=lost)
    if findings.count() > before or form.damaged:
        return None
    return Provided(
        name,
        form.origin,
        form.axes,
        form.queue or 0,
        None if server is None else server.name,
        tuple(one for one in sound if isinstance(one, Request)),
        tuple(one for one in sound if isinstance(one, Published)),
        events,
        protocol,
    )


def servers_serve_once(component: Component, findings: Findings) -> None:
    """An activity executes the requests of one interface."""
    first: dict[str, Provided] = {}
    for provided in component.provides:
        if provided.server is None:
            continue
        server = next(a for a in component.activities if a.name == provided.server)
        for name in server.sends:
            if not component.port(name).is_command:
                message = f"{server.name} serves {provided.name} and sends on {name}"
                notes = [(server.origin, f"{server.name} is declared here")]
                hint = "a port has one value in an execution: let another activity send it"
                findings.error("RV-1209", provided.origin, message, notes=notes, hint=hint)
        other = first.setdefault(provided.server, provided)
        if other is not provided:
            message = f"{provided.server} serves {other.name} and {provided.name}"
            notes = [(other.origin, f"{other.name} is here")]
            hint = "give each interface an activity of its own"
            findings.error("RV-1209", provided.origin, message, notes=notes, hint=hint)
