"""`ravenchart import`: the messages of a CAN database as types, ports and messages of a model.

A value counts the scale of its signal: 0.1 degC is a unit. Whatever has no place in a
model is said, and the message that has it is left out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from pathlib import Path
from xml.etree import ElementTree

import cantools
import yaml
from cantools.database import Database
from cantools.database.can import Message, Signal
from cantools.database.errors import Error as DatabaseFault

from gen.layouts import RAW_LIMIT, SIGNED_BITS
from gen.names import meant, problem_of
from gen.quantities import duration

from .steps import Refused

FORMATS = (".dbc", ".kcd", ".sym", ".arxml")
"""Databases by the ending of their files; a file with another one is read as DBC."""
MONITOR = "monitor"
"""The node that receives every message."""
LONGEST_UNIT = 20
"""Characters of a unit at most."""


class Unsayable(Exception):  # noqa: N818
    """A message has something that models have no words for; the text says what."""


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
        """That of a message; None where nobody says."""
        return self.rows.get(message.name) or _cycle(message) or self.default


def periods(default: str | None, path: Path | None) -> Periods:
    """What the call says of periods: ``path`` is YAML, ``message: 20 ms``. Refused when wrong."""
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
        time = duration(text)
        if time is None or time <= 0:
            raise Refused(f"{place}: error: `{text}` is no duration such as `20 ms`")
    return found


def imported(path: Path, node: str | None, given: Periods | None = None) -> Imported:
    """The messages of a database as seen from one of its nodes. Refused when it cannot be read.

    None: seen by a node that receives all of them.

    A signal that models have no words for is left out of what the node receives; what it
    sends is left out as a whole, for its bytes would be others.
    """
    given = given or Periods()
    ending = path.suffix.lower()
    form = ending.removeprefix(".") if ending in FORMATS else "dbc"
    try:
        database = cantools.database.load_file(path, database_format=form, strict=True)
    except (OSError, ValueError, DatabaseFault, ElementTree.ParseError) as fault:
        raise Refused(f"{path}: error: {fault}") from None
    if not isinstance(database, Database):
        raise Refused(f"{path}: error: it has diagnostics, and no messages")
    names = [one.name for one in database.nodes]
    if node is not None and node not in names:
        hint = meant(node, names) if names else "it has no nodes: use `--all`"
        raise Refused(f"{path}: error: no node is called {node}" + (f": {hint}" if hint else ""))
    unknown = [name for name in given.rows if name not in {m.name for m in database.messages}]
    if unknown:
        hint = meant(unknown[0], [m.name for m in database.messages])
        told = f"no message is called {unknown[0]}" + (f": {hint}" if hint else "")
        raise Refused(f"{path}: error: {told}")
    writer = _Writer(node or MONITOR, given, takes_all=node is None)
    problems: list[str] = []
    for message in database.messages:
        try:
            writer.add(message)
        except Unsayable as problem:
            problems.append(f"{path}: error: {message.name} is left out: {problem}")
    problems += [f"{path}: error: {left}" for left in writer.left_out]
    return Imported(writer.text(path.name), problems)


@dataclass(slots=True)
class _Writer:
    """The sections of the model, line by line."""

    node: str
    periods: Periods
    takes_all: bool
    types: dict[str, str] = field(default_factory=dict)
    """Definition to name, in the order in which they are needed."""
    records: list[str] = field(default_factory=list)
    ports: list[str] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    """Signals that are not in the model, each with its message and the reason."""

    @property
    def component(self) -> str:
        """The component that has the ports."""
        return f"{self.node[:1].upper()}{self.node[1:]}_Ports"

    def text(self, source: str) -> str:
        """All of it; what a database cannot know is left to the reader."""
        instance = self.node.lower()
        lines = [
            f"# From {source}, as seen by {self.node}. Add what the ports do, `{instance}:` under",
            "# `instances:`, and a bus called `bus`.",
            "types:",
            *(f"  {name}: {definition}" for definition, name in self.types.items()),
            *self.records,
            "components:",
            f"  {self.component}:",
            "    ports:",
            *self.ports,
            "messages:",
            *self.messages,
        ]
        return "\n".join(lines) + "\n"

    def add(self, message: Message) -> None:
        """A message, or `Unsayable`."""
        _named("message", message.name)
        lines = [f"  {message.name}:", "    bus: bus", f"    id: {message.frame_id:#x}"]
        lines += ["    extended: true"] if message.is_extended_frame else []
        lines += ["    format: fd"] if message.is_fd else []
        lines += [f"    bytes: {message.length}"]
        period = self.periods.of(message)
        sends = not self.takes_all and self.node in message.senders
        takes = self.takes_all or self.node in message.receivers
        if not sends and period is None:
            raise Unsayable(
                "it has no cycle time, which a message from outside needs; `--period` gives one"
            )
        if not sends and not takes:
            self.messages += [*lines, f"    period: {period}"]
            return
        if not message.signals:
            raise Unsayable("it has no signals, and a port has a value")
        signals, known = self._signals(message, whole=sends)
        self.types |= known
        record = f"{message.name}_Data"
        fields = ", ".join(f"{s.name}: {name}" for s, (name, _) in signals.items())
        self.records.append(f"  {record}: {{fields: {{{fields}}}}}")
        way = "out" if sends else "in"
        often = f"  # every {period}" if sends and period is not None else ""
        self.ports.append(f"      {message.name}: {{{way}: {record}}}{often}")
        end = f"{self.node.lower()}.{message.name}"
        lines += [f"    from: {end}"] if sends else [f"    to: {end}", f"    period: {period}"]
        selector = next((s for s in message.signals if s.is_multiplexer), None)
        lines += [f"    multiplexor: {selector.name}"] if selector is not None else []
        lines += ["    signals:"]
        lines += [f"      {s.name}: {{{keys}}}" for s, (_, keys) in signals.items()]
        self.messages += lines

    def _signals(
        self, message: Message, *, whole: bool
    ) -> tuple[dict[Signal, tuple[str, str]], dict[str, str]]:
        """The type and the layout of each signal; then all types, with those added.

        Unless ``whole`` a signal may be missing, but not the multiplexor.
        """
        known = dict(self.types)
        found: dict[Signal, tuple[str, str]] = {}
        left_out: list[str] = []
        for signal in message.signals:
            try:
                _named("signal", signal.name)
                definition, keys = _scalar(signal)
                pages = _pages(message, signal)
            except Unsayable as problem:
                if whole or signal.is_multiplexer:
                    raise
                left_out.append(f"{message.name}.{signal.name} is left out: {problem}")
                continue
            if definition is None:
                name = "Boolean"
            else:
                name = known.setdefault(definition, f"{message.name}_{signal.name}")
            found[signal] = (name, ", ".join([*keys, *pages]))
        if not found:
            raise Unsayable("no signal of it has a place in a model")
        self.left_out += left_out
        return found, known


def _named(kind: str, name: str) -> None:
    problem = problem_of(name)
    if problem is not None:
        raise Unsayable(f"the {kind} {name} has a name that a model cannot have: {problem[1]}")


def _cycle(message: Message) -> str | None:
    return f"{message.cycle_time} ms" if message.cycle_time else None


def _exact(value: float | int) -> Decimal:
    return Decimal(repr(value)) if isinstance(value, float) else Decimal(value)


def _whole(value: Decimal, what: str) -> int:
    if value != int(value):
        raise Unsayable(f"{what} is no whole number of counts")
    return int(value)


def _scalar(signal: Signal) -> tuple[str | None, list[str]]:
    """The definition of a signal's type, None for Boolean, and the keys of its layout."""
    what = f"the signal {signal.name}"
    if signal.conversion.is_float:
        raise Unsayable(f"{what} is a floating-point number")
    keys = [f"start: {signal.start}", f"width: {signal.length}"]
    keys += ["order: motorola"] if signal.byte_order == "big_endian" else []
    keys += ["signed: true"] if signal.is_signed else []
    if signal.is_signed and signal.length > SIGNED_BITS:
        raise Unsayable(f"{what} is signed and has more than {SIGNED_BITS} bits")
    scale = _exact(signal.conversion.scale)
    if scale <= 0:
        raise Unsayable(f"{what} has the scale {scale}")
    offset = _exact(signal.conversion.offset)
    low, high = _raw_range(signal, scale, offset)
    choices = dict(signal.conversion.choices or {})
    if choices:
        names = {code: str(name) for code, name in sorted(choices.items())}
        if scale != 1 or offset != 0 or (min(names), max(names)) != (low, high):
            raise Unsayable(f"{what} has names for some values, and numbers for others")
        if names == {0: "False", 1: "True"}:
            return None, keys
        return _enumeration(signal, names), [*keys, f"codes: [{', '.join(map(str, names))}]"]
    counts = _whole(offset / scale, f"the offset of {what}")
    if signal.is_multiplexer and counts:
        raise Unsayable(f"{what} is a multiplexor with an offset")
    if max(-low, high) >= RAW_LIMIT:
        raise Unsayable(f"{what} has values of more than {SIGNED_BITS} bits")
    unit = signal.unit or ""
    if scale != 1:
        unit = f"{scale:f} {unit}".strip()
    if len(unit) > LONGEST_UNIT or '"' in unit or "\\" in unit:
        raise Unsayable(f"{what} counts `{unit}`: a unit has {LONGEST_UNIT} characters at most")
    shown = f', unit: "{unit}"' if unit else ""
    return f"{{range: [{low + counts}, {high + counts}]{shown}}}", [*keys, f"offset: {counts}"]


def _raw_range(signal: Signal, scale: Decimal, offset: Decimal) -> tuple[int, int]:
    """The least and the greatest raw value: by the limits that are given, and by the width."""
    low, high = 0, (1 << signal.length) - 1
    if signal.is_signed:
        low, high = -(1 << signal.length - 1), (1 << signal.length - 1) - 1
    if signal.minimum is not None and signal.maximum is not None:
        first, last = (
            (_exact(limit) - offset) / scale for limit in (signal.minimum, signal.maximum)
        )
        low, high = max(low, math.ceil(first)), min(high, math.floor(last))
    if low > high:
        raise Unsayable(f"the signal {signal.name} has no value within its limits")
    return low, high


def _enumeration(signal: Signal, names: Mapping[int, str]) -> str:
    for name in names.values():
        _named(f"value of the signal {signal.name}", name)
    if len({name.lower() for name in names.values()}) < len(names):
        raise Unsayable(f"the signal {signal.name} has two values of one name")
    return f"{{values: [{', '.join(names.values())}]}}"


def _pages(message: Message, signal: Signal) -> Sequence[str]:
    """The key that tells with which values of the multiplexor a signal is there."""
    selectors = [s for s in message.signals if s.is_multiplexer]
    if len(selectors) > 1:
        several = ", ".join(s.name for s in selectors)
        raise Unsayable(f"it has several multiplexors, {several}")
    if not signal.multiplexer_ids:
        return ()
    names: dict[int, object] = dict(selectors[0].conversion.choices or {})
    pages = [str(names.get(page, page)) for page in signal.multiplexer_ids]
    return (f"when: [{', '.join(pages)}]",)
