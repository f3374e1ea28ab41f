# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart import`: the messages of a CAN database as types, ports and messages of a model.

Parts of the database that models have no words for are changed or left out. The text lists them
at its top.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

import cantools
import yaml
from cantools.database import Database
from cantools.database.can import Message, Signal
from cantools.database.errors import Error as DatabaseFault

from ravenchart.failures import Refused
from ravenchart.gen.language.names import database_problem_of, meant
from ravenchart.gen.language.quantities import parsed_duration
from ravenchart.gen.model.signals import FD_SIZES
from ravenchart.gen.resolve.layouts import SIGNED_BITS

from .fields import Fields, ImportedField, fields_of, raw_fields
from .names import HIDDEN, Names
from .signals import Unsayable, Words, named_values
from .whole import Frames, SentMessage, behaviour, bit_rate, deadline, sections

FORMATS = (".dbc", ".kcd", ".sym", ".arxml")
"""Databases by the ending of their files; a file with another one is read as DBC."""
CLASSIC = 8
"""Bytes of a classic frame at most."""
SHOWN = 16
"""Names of raw values that a line of the text shows at most."""
MONITOR = "monitor"
"""The node that receives every message."""


@dataclass(slots=True)
class Imported:
    """Part of a model, and what of the database is not in it."""

    text: str
    problems: list[str] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Periods:
    """Least times between frames that a database does not say, as models write durations."""

    default: str | None = None
    """Of each message without a cycle time and without a row."""
    rows: Mapping[str, str] = field(default_factory=dict)
    """Of messages by name; they stand before the cycle time of the database."""

    def of(self, message: Message) -> str | None:
        """The period of a message; None where none is given."""
        return self.rows.get(message.name) or _cycle(message) or self.default


def periods(default: str | None, path: Path | None) -> Periods:
    """The periods of a call: ``path`` is YAML, ``message: 20 ms``. Refused when wrong."""
    rows: object = {}
    if path is not None:
        try:
            rows = yaml.safe_load(path.read_text(encoding="utf-8")) or {}
        except (OSError, UnicodeDecodeError, yaml.YAMLError) as fault:
            raise Refused(f"{path}: error: {fault}") from None
    if not isinstance(rows, dict):
        raise Refused(f"{path}: error: expected rows `message: 20 ms`")
    found = Periods(default, {str(name): str(text) for name, text in rows.items()})
    given = [("--period", default)] if default is not None else []
    for place, text in (*given, *((f"{path}: {name}", one) for name, one in found.rows.items())):
        time = parsed_duration(text)
        if time is None or time <= 0:
            raise Refused(f"{place}: error: `{text}` is no duration such as `20 ms`")
    return found


def imported(
    path: Path,
    node: str | None,
    given: Periods | None = None,
    *,
    lenient: bool = False,
    bus: str | None = None,
    parts: bool = False,
) -> Imported:
    """A model of the messages of a database, as seen from one of its nodes.

    Refused when the database cannot be read.

    ``node`` None: seen by a node that receives all of them. A signal that a model cannot express
    is left out; sent messages have constants for its bits. ``lenient``: signals that share bits or
    reach beyond their frame are left out, too. ``bus``: only the messages of that bus of the
    database. ``parts``: only the sections for a model that includes them.
    """
    given = given or Periods()
    database = read_database(path, lenient=lenient)
    buses = list(dict.fromkeys(m.bus_name for m in database.messages if m.bus_name))
    if bus is not None and bus not in buses:
        hint = meant(bus, buses) if buses else "it has no buses: leave `--bus` out"
        raise Refused(f"{path}: error: no bus is called {bus}" + (f": {hint}" if hint else ""))
    messages = [m for m in database.messages if bus is None or m.bus_name == bus]
    names = [one.name for one in database.nodes]
    if node is not None and node not in names:
        hint = meant(node, names) if names else "it has no nodes: use `--all`"
        raise Refused(f"{path}: error: no node is called {node}" + (f": {hint}" if hint else ""))
    unknown = [name for name in given.rows if name not in {m.name for m in database.messages}]
    if unknown:
        hint = meant(unknown[0], [m.name for m in database.messages])
        told = f"no message is called {unknown[0]}" + (f": {hint}" if hint else "")
        raise Refused(f"{path}: error: {told}")
    names = Names.of_each([m.name for m in messages])
    writer = _Writer(node, given, dict(zip(messages, names, strict=True)))
    problems: list[str] = []
    for message in messages:
        try:
            writer.add(message)
        except Unsayable as problem:
            problems.append(f"{path}: error: {message.name} is left out: {problem}")
    problems += [f"{path}: error: {left}" for left in writer.left_out]
    rates = {one.name: one.baudrate for one in database.buses}
    rate = rates.get(bus) if bus is not None else next(iter(rates.values()), None)
    return Imported(writer.text(path, rate, parts=parts), problems)


def read_database(path: Path, *, lenient: bool) -> Database:
    """A database of any of the formats. Refused when cantools cannot read it."""
    ending = path.suffix.lower()
    form = ending.removeprefix(".") if ending in FORMATS else "dbc"
    try:
        database = cantools.database.load_file(path, database_format=form, strict=not lenient)
    except (OSError, ValueError, DatabaseFault, ElementTree.ParseError) as fault:
        room = not lenient and ("overlapping" in str(fault) or "does not fit" in str(fault))
        hint = f"\n{path}: hint: `--lenient` leaves such signals out" if room else ""
        raise Refused(f"{path}: error: {fault}{hint}") from None
    if not isinstance(database, Database):
        raise Refused(f"{path}: error: it has diagnostics, and no messages")
    return database


@dataclass(slots=True)
class _Writer:
    """The sections of the model, line by line."""

    node: str | None
    periods: Periods
    names: Mapping[Message, str]
    """Of the messages, in the model."""
    known: dict[str, str] = field(default_factory=dict)
    """Definition to name of the types, in the order in which they are needed."""
    type_names: Names = field(default_factory=Names)
    literals: set[str] = field(default_factory=set)
    """In lower case: no type has such a name."""
    records: list[str] = field(default_factory=list)
    ports: list[str] = field(default_factory=list)
    messages: list[tuple[list[str], Frames]] = field(default_factory=list)
    """The lines of each, and its frames."""
    changes: list[tuple[str, str]] = field(default_factory=list)
    """Differences from the database: where, and how."""
    left_out: list[str] = field(default_factory=list)
    """Signals that are not in the model, each with its message and the reason."""

    frames: list[Frames] = field(default_factory=list)
    """All on the bus."""
    sent: list[SentMessage] = field(default_factory=list)
    """The messages that the node sends."""
    received: list[Frames] = field(default_factory=list)
    """The frames that it receives with a port."""
    originals: set[str] = field(default_factory=set)
    """Names of messages in the database that are in the model."""
    identifiers: dict[tuple[int, bool], str] = field(default_factory=dict)
    """Of the messages, and whether they are extended, with their names."""

    def __post_init__(self) -> None:
        """No type has a name that it would hide."""
        self.type_names.avoid(HIDDEN)

    @property
    def own_name(self) -> str:
        """The node's name as a model can have it."""
        return Names().new(self.node or MONITOR)

    @property
    def component(self) -> str:
        """The component that has the ports."""
        return f"{self.own_name[:1].upper()}{self.own_name[1:]}_Ports"

    @property
    def instance(self) -> str:
        """The name of the component's instance in the text."""
        return self.own_name.lower()

    def text(self, source: Path, known_rate: int | None, *, parts: bool) -> str:
        """All of it, or the parts of it that the database has."""
        seen = self.node or "a node that receives everything"
        if parts:
            told = [
                f"# From {source.name}, as seen by {seen}. Add what the ports do, "
                f"`{self.instance}:` under",
                "# `instances:`, and a bus called `bus`.",
            ]
        else:
            told = [
                f"# From {source.name}, as seen by {seen}. Set what a database does not know:",
                "# periods of the node, execution times (wcet), stacks, queues of the bus.",
            ]
        rate = bit_rate(self.frames, known_rate)
        if not parts and known_rate not in (None, rate):
            why = "its frames do not fit in it with these periods"
            self.changes.append(("bus", f"has {rate} bit/s, not {known_rate}: {why}"))
        lines = [
            *told,
            *self._table(),
            *([] if parts else [f"system: {self._system(source.stem)}"]),
            "types:" if self.known or self.records else "types: {}",
            *(f"  {name}: {definition}" for definition, name in self.known.items()),
            *self.records,
            "components:",
            f"  {self.component}:",
            "    ports:" if self.ports else "    ports: {}",
            *self.ports,
        ]
        if not parts:
            lines += behaviour(self.sent, receives=bool(self.received))
            lines += sections(
                self.instance,
                self.component,
                self.sent,
                received=self.received,
                rate=rate,
                flexible=any(one.flexible for one in self.frames),
                database_name=self._node_name(),
            )
        lines.append("messages:" if self.messages else "messages: {}")
        for own, frames in self.messages:
            lines += own
            if not parts:
                lines += deadline(frames, self.frames, rate)
        return "\n".join(lines) + "\n"

    def _node_name(self) -> str | None:
        """The node's name in the database, where a DBC can have it and the model has another."""
        own = self.node
        if own is None or own == self.instance or database_problem_of(own) is not None:
            return None
        return own

    def _system(self, stem: str) -> str:
        """A name for the model, which no type has."""
        name = Names().new(stem)
        return self.type_names.new(f"{name[:1].upper()}{name[1:]}_Bus", self.literals)

    def _table(self) -> list[str]:
        """Comments that list the differences from the database."""
        if not self.changes:
            return []
        width = max(len(where) for where, _ in self.changes)
        return [
            "#",
            "# Otherwise than in the database:",
            *(f"# {where:{width}}  {' '.join(how.split())}" for where, how in self.changes),
        ]

    def add(self, message: Message) -> None:
        """A message, or `Unsayable`."""
        period = self.periods.of(message)
        sends = self.node is not None and self.node in message.senders
        takes = self.node is None or self.node in message.receivers
        if not sends and period is None:
            raise Unsayable(
                "it has no cycle time, which a message from outside needs; `--period` gives one"
            )
        self._claim(message)
        extended, flexible = message.is_extended_frame, _is_flexible(message)
        size = _size(message)
        self.frames.append(Frames(message.frame_id, extended, size, flexible, period))
        lines = self._head(message)
        if not sends and not takes:
            self.messages.append(([*lines, f"    period: {period}"], self.frames[-1]))
            return
        found = fields_of(message, taken=self.type_names.taken, sends=sends)
        self.left_out += [
            f"{message.name}.{signal.name} is left out: {why}" for signal, why in found.left_out
        ]
        if sends and not found.fields:
            found.fields = raw_fields(message)
        if not found.fields:
            if period is None:
                raise Unsayable("its frame has no data, and a port has a value")
            self.changes.append((message.name, "is on the bus alone: no port has its value"))
            self.messages.append(([*lines, f"    period: {period}"], self.frames[-1]))
            return
        name = self.names[message]
        own = self._named(message, found)
        typed = ((own[f.signal], self._type(message, f.signal, f.words)) for f in found.fields)
        fields = ", ".join(f"{field}: {of}" for field, of in typed)
        record = self.type_names.new(f"{name}_Data", self.literals)
        self.records.append(f"  {record}: {{fields: {{{fields}}}}}")
        way = "out" if sends else "in"
        often = f"  # every {period}" if sends and period is not None else ""
        self.ports.append(f"      {name}: {{{way}: {record}}}{often}")
        if sends:
            self.sent.append(SentMessage(name, period))
        else:
            self.received.append(self.frames[-1])
        end = f"{self.instance}.{name}"
        lines += [f"    from: {end}"] if sends else [f"    to: {end}", f"    period: {period}"]
        if found.selector is not None:
            lines.append(f"    multiplexor: {own[found.selector.signal]}")
        lines.append("    signals:")
        originals: set[str] = set()
        for one in found.fields:
            keys = [*one.words.keys, *_pages(one, found.selector)]
            if one.signal in message.signals:
                keys += _kept(own[one.signal], one.signal.name, originals)
            lines.append(f"      {own[one.signal]}: {{{', '.join(keys)}}}")
        self.messages.append((lines, self.frames[-1]))

    def _claim(self, message: Message) -> None:
        """The message's identifier, which no other one has; else `Unsayable`."""
        if message.length > FD_SIZES[-1]:
            raise Unsayable(
                f"it has {message.length} bytes, and a frame has {FD_SIZES[-1]} at most"
            )
        key = (message.frame_id, message.is_extended_frame)
        other = self.identifiers.get(key)
        self.identifiers.setdefault(key, message.name)
        if other is not None:
            hint = "; `--bus` imports one bus" if message.bus_name else ""
            raise Unsayable(f"{other} has its identifier {message.frame_id:#x}{hint}")

    def _head(self, message: Message) -> list[str]:
        name = self.names[message]
        if name != message.name:
            self.changes.append((message.name, f"is named {name}"))
        lines = [f"  {name}:", "    bus: bus", f"    id: {message.frame_id:#x}"]
        lines += [f"    {one}" for one in _kept(name, message.name, self.originals)]
        lines += ["    extended: true"] if message.is_extended_frame else []
        if message.length > CLASSIC and not message.is_fd:
            self.changes.append((message.name, f"is a CAN FD frame: it has {message.length} bytes"))
        lines += ["    format: fd"] if _is_flexible(message) else []
        size = _size(message)
        if size != message.length:
            told = f"has {size} bytes: there is no frame of {message.length}"
            self.changes.append((message.name, told))
        return [*lines, f"    bytes: {size}"]

    def _named(self, message: Message, found: Fields) -> dict[Signal, str]:
        """The names of the signals; notes what is changed in them."""
        names = Names.of_each([one.signal.name for one in found.fields])
        for one, name in zip(found.fields, names, strict=True):
            signal, words = one.signal, one.words
            where = f"{message.name}.{signal.name}"
            if name != signal.name:
                self.changes.append((where, f"is named {name}"))
            if one.told is not None:
                self.changes.append((where, one.told))
            elif signal not in message.signals:
                self.changes.append((where, f"is part of a signal of more than {SIGNED_BITS} bits"))
            if words.raw is not None:
                how = f"counts raw values: {words.raw}{_formula(signal)}{_values(signal)}"
                self.changes.append((where, how))
            if words.named:
                named = _shown(words.named)
                self.changes.append((where, f"is a number, of which some have names: {named}"))
            if words.other is not None and words.literals:
                told = f"has {words.literals[-1]} for values without a name"
                self.changes.append((where, f"{told}, which is sent as {words.other}"))
            for old, new in words.renamed:
                self.changes.append((where, f"its value `{old}` is named {new}"))
        return {one.signal: name for one, name in zip(found.fields, names, strict=True)}

    def _type(self, message: Message, signal: Signal, words: Words) -> str:
        """The name of the type, which is added where there is none like it."""
        if words.literals == ():
            return "Boolean"
        definition = words.range
        if words.literals:
            definition = f"{{values: [{', '.join(words.literals)}]}}"
            self.literals |= {name.lower() for name in words.literals}
        if definition not in self.known:
            wanted = f"{self.names[message]}_{signal.name}"
            self.known[definition] = self.type_names.new(wanted, self.literals)
        return self.known[definition]


def _is_flexible(message: Message) -> bool:
    """Is it CAN FD, as it says or by its length?"""
    return message.is_fd or message.length > CLASSIC


def _size(message: Message) -> int:
    """The bytes of its frames: the next number that there is."""
    size: int = next(one for one in (0, *FD_SIZES) if one >= message.length)
    return size


def _kept(name: str, original: str, known: set[str]) -> list[str]:
    """The key for the name in the database, where that is another one; adds it to the ``known``.

    A name that no DBC can have is not kept, nor that of an earlier message or signal.
    """
    if original in known:
        return []
    known.add(original)
    told = name != original and database_problem_of(original) is None
    return [f'database_name: "{original}"'] if told else []


def _pages(one: ImportedField, selector: ImportedField | None) -> list[str]:
    """The key that says with which values of the multiplexor a signal is there."""
    if selector is None or not one.pages:
        return []
    return [f"when: [{', '.join(selector.words.literal(page) for page in sorted(one.pages))}]"]


def _formula(signal: Signal) -> str:
    """How a value comes of the raw one."""
    if signal.conversion.is_float:
        return ""
    scale, offset = signal.conversion.scale, signal.conversion.offset
    unit = f" {signal.unit}" if signal.unit else ""
    return f" (value = {scale:g} * raw + {offset:g}{unit})"


def _values(signal: Signal) -> str:
    """The names of some of its raw values."""
    choices = tuple(named_values(signal).items())
    return f"; {_shown(choices)}" if choices else ""


def _shown(named: Sequence[tuple[int, str]]) -> str:
    """Values with their names, the first ones."""
    more = f", and {len(named) - SHOWN} more" if len(named) > SHOWN else ""
    return ", ".join(f"{code} {name}" for code, name in named[:SHOWN]) + more


def _cycle(message: Message) -> str | None:
    return f"{message.cycle_time} ms" if message.cycle_time else None
