# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The stimuli from outside while a model runs: the file of `--events`.

    - {at: 50 ms, raise: motor.Start}
    - {at: 60 ms, raise: motor.Go, with: 250}
    - {at: 70 ms, put: motor.order, value: {kind: Move, target: 1000}}
    - {at: 75 ms, interrupt: board.limit}
    - {until: 2 s}

Times count from the epoch of the processors and never decrease. At each instant the
stimuli come before the rows run. The last instant is that of `until`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TypeVar

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.files.located import Map, grow_list
from ravenchart.gen.language.names import nearest, nearest_hint
from ravenchart.gen.language.quantities import parsed_duration, shown
from ravenchart.gen.language.terms import (
    BOOLEAN,
    NO_TIME,
    EnumerationType,
    IntegerType,
    Named,
    Ns,
    RecordType,
    Scalar,
    ScalarType,
    Type,
    Value,
    named,
)
from ravenchart.gen.model.instances import End, Instance
from ravenchart.gen.model.nodes import InterruptLine
from ravenchart.gen.model.statechart import DONE
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin

N = TypeVar("N", bound=Named)


@dataclass(frozen=True, slots=True)
class Raised:
    """An event of an instance, with its value if it carries one."""

    at: Ns
    instance: str
    event: str
    value: Value | None

    @property
    def receiver(self) -> tuple[str, str]:
        """Instance and event."""
        return self.instance, self.event


@dataclass(frozen=True, slots=True)
class Arrived:
    """A value for an input port."""

    at: Ns
    end: End
    value: Value

    @property
    def receiver(self) -> tuple[str, str]:
        """Instance and port."""
        return self.end.instance, self.end.name


@dataclass(frozen=True, slots=True)
class InterruptCame:
    """An interrupt of a node."""

    at: Ns
    line: InterruptLine

    @property
    def receiver(self) -> tuple[str, str]:
        """Node and interrupt."""
        return self.line.node, self.line.name

    @property
    def value(self) -> None:
        """It carries none."""
        return


Stimulus = Raised | Arrived | InterruptCame
"""An event, value or interrupt from outside."""


@dataclass(frozen=True, slots=True)
class Stimuli:
    """The stimuli in order of time, and the last instant."""

    entries: tuple[Stimulus, ...]
    until: Ns


def written_stimuli(stimuli: Stimuli, comments: Iterable[str] = ()) -> str:
    """A file of these stimuli, which `read` gives back; each comment is a line at its start."""
    lines = [f"# {comment}" for comment in comments]
    for entry in stimuli.entries:
        at = shown(entry.at) if entry.at else "0"
        match entry:
            case Raised(instance=instance, event=event, value=None):
                lines.append(f"- {{at: {at}, raise: {instance}.{event}}}")
            case Raised(instance=instance, event=event, value=value):
                assert value is not None
                lines.append(f"- {{at: {at}, raise: {instance}.{event}, with: {_text(value)}}}")
            case Arrived(end=end, value=value):
                port = f"{end.instance}.{end.name}"
                lines.append(f"- {{at: {at}, put: {port}, value: {_text(value)}}}")
            case InterruptCame(line=line):
                lines.append(f"- {{at: {at}, interrupt: {line}}}")
    lines.append(f"- {{until: {shown(stimuli.until) if stimuli.until else 0}}}")
    return "".join(f"{line}\n" for line in lines)


def _text(value: Value) -> str:
    """A value as YAML."""
    if isinstance(value, tuple):
        return f"{{{', '.join(f'{name}: {_text(one)}' for name, one in value)}}}"
    return {"True": "true", "False": "false"}.get(str(value), str(value))


KEYS = {"at", "raise", "with", "put", "value", "interrupt", "until"}
FORMS = "`{at, raise, with}`, `{at, put, value}`, `{at, interrupt}` or, at the end, `{until}`"


def read_stimuli(
    text: str, file: str, system: System
) -> tuple[Stimuli | None, tuple[Diagnostic, ...]]:
    """The stimuli in a file for ``system``; None when the file has an error."""
    tree, found = grow_list(text, file)
    reading = _Reading(system, list(found))
    if tree is None:
        if not found:
            message = "an events file is a list of `- {...}` lines"
            reading.wrong("RV-1001", Origin(file, 1, 1), message, f"each is {FORMS}")
        return None, tuple(reading.found)
    until = None
    for item, at in zip(tree, tree.items_at, strict=True):
        if until is not None:
            reading.wrong("RV-1006", at.origin, "nothing comes after `until`")
            break
        if isinstance(item, Map):
            until = reading.take(item)
        else:
            reading.wrong("RV-1002", at.origin, "this is no mapping", f"each is {FORMS}")
    if until is None and not reading.found:
        last = tree.items_at[-1].origin if tree else tree.origin
        hint = "end with the last instant, such as `- {until: 2 s}`"
        reading.wrong("RV-1006", last, "the list does not end with `until`", hint)
    if reading.found or until is None:
        return None, tuple(reading.found)
    return Stimuli(tuple(reading.entries), until), ()


@dataclass(slots=True)
class _Reading:
    """The entries read so far."""

    system: System
    found: list[Diagnostic]
    entries: list[Stimulus] = field(default_factory=list)
    now: Ns = NO_TIME

    def wrong(self, code: str, origin: Origin, message: str, hint: str | None = None) -> None:
        """Report an error."""
        self.found.append(error(code, origin, message, hint=hint))

    def take(self, item: Map) -> Ns | None:
        """Read one entry; the last instant if the entry is `until`."""
        keys = set(item)
        if keys == {"until"}:
            return self.time(item, "until")
        forms = {"raise", "with"}, {"put", "value"}, {"interrupt"}
        known = next((form for form in forms if keys & form), {"raise"})
        wanted = {"at", *known}
        slips = {key: nearest(key, KEYS - keys) for key in item if key not in wanted}
        for key, meant in slips.items():
            hint = f"did you mean `{meant}`?" if meant else f"an entry is {FORMS}"
            self.wrong("RV-1002", item.keys_at[key], f"`{key}` has no place here", hint)
        missing = set() if "until" in slips.values() else wanted - {"with", *slips.values()} - keys
        for key in sorted(missing):
            self.wrong(
                "RV-1002", item.origin, f"the key `{key}` is missing", f"an entry is {FORMS}"
            )
        if keys <= wanted and wanted - {"with"} <= keys:
            at = self.time(item, "at")
            if at is not None and "raise" in item:
                self.raised(at, item)
            elif at is not None and "put" in item:
                self.put(at, item)
            elif at is not None:
                self.interrupt(at, item)
        return None

    def time(self, item: Map, key: str) -> Ns | None:
        """A time that is not before that of the entry above."""
        origin = item.values_at[key].origin
        given = item[key]
        time = parsed_duration(given) if isinstance(given, str) else None
        if given == 0 and not isinstance(given, bool):
            time = NO_TIME
        if time is None:
            hint = "a number with ns, us, ms or s, such as `50 ms`"
            self.wrong("RV-1003", origin, f"`{key}` takes a time", hint)
        elif time < self.now:
            message = f"{shown(time)} is before {shown(self.now)} of the entry above"
            self.wrong("RV-1003", origin, message, "put the entries in order of time")
            time = None
        self.now = time or self.now
        return time

    def raised(self, at: Ns, item: Map) -> None:
        """An event of an instance."""
        found = self.member(item, "raise")
        if found is None:
            return
        instance, name = found
        origin = item.values_at["raise"].origin
        events = instance.component.events
        event = _find(events, name)
        if event is None:
            of = "by its do activities alone" if name.lower() == DONE else _one_of(events)
            self.wrong("RV-1004", origin, f"{instance.name} has no event `{name}`", of)
            return
        value = None
        if event.type is None and "with" in item:
            message = f"the event {event.name} carries no value"
            self.wrong("RV-1005", item.keys_at["with"], message, "remove `with`")
            return
        if event.type is not None:
            if "with" not in item:
                message = f"the event {event.name} carries a value of type {event.type.name}"
                self.wrong("RV-1005", origin, message, "give it by `with: ...`")
                return
            value = self.value(event.type, item, "with")
            if value is None:
                return
        self.entries.append(Raised(at, instance.name, event.name, value))

    def put(self, at: Ns, item: Map) -> None:
        """A value for an input port."""
        found = self.member(item, "put")
        if found is None:
            return
        instance, name = found
        ports = instance.component.inputs()
        port = _find(ports, name)
        if port is None:
            message = f"{instance.name} has no input port `{name}`"
            self.wrong("RV-1004", item.values_at["put"].origin, message, _one_of(ports))
            return
        value = self.value(port.type, item, "value")
        if value is not None:
            self.entries.append(Arrived(at, End(instance.name, port.name), value))

    def interrupt(self, at: Ns, item: Map) -> None:
        """An interrupt of a node that releases a processor."""
        origin, text = item.values_at["interrupt"].origin, str(item["interrupt"])
        found = (one.released_by_interrupt for one in self.system.processors)
        lines = {str(line).lower(): line for line in found if line is not None}
        line = lines.get(text.lower())
        if line is None:
            names = ", ".join(map(str, lines.values()))
            hint = f"one of: {names}" if names else "the model has none"
            self.wrong("RV-1004", origin, f"there is no interrupt `{text}`", hint)
        else:
            self.entries.append(InterruptCame(at, line))

    def member(self, item: Map, key: str) -> tuple[Instance, str] | None:
        """The instance of ``instance.name``, and the name."""
        origin = item.values_at[key].origin
        owner, dot, name = str(item[key]).rpartition(".")
        if not isinstance(item[key], str) or not dot:
            self.wrong("RV-1002", origin, f"`{key}` takes `instance.name`")
            return None
        instance = _find(self.system.instances, owner)
        if instance is None:
            message = f"there is no instance `{owner}`"
            self.wrong("RV-1004", origin, message, _one_of(self.system.instances))
            return None
        return instance, name

    # --- values

    def value(self, kind: Type, item: Map, key: str) -> Value | None:
        """A value of a type."""
        given, origin = item[key], item.values_at[key].origin
        if not isinstance(kind, RecordType):
            return self.scalar(kind, given, origin)
        if not isinstance(given, Map):
            fields = ", ".join(f"{one.name}: ..." for one in kind.fields)
            message = f"{kind.name} is a record"
            self.wrong("RV-1005", origin, message, f"`{key}: {{{fields}}}`")
            return None
        keys = {name.lower(): name for name in given}
        values: list[tuple[str, Scalar]] = []
        for one in kind.fields:
            name = keys.pop(one.name.lower(), None)
            if name is None:
                self.wrong("RV-1005", origin, f"the field `{one.name}` of {kind.name} is missing")
                continue
            value = self.scalar(one.type, given[name], given.values_at[name].origin)
            if value is not None:
                values.append((one.name, value))
        for name in keys.values():
            message = f"{kind.name} has no field `{name}`"
            self.wrong("RV-1005", given.keys_at[name], message, _one_of(kind.fields))
        return tuple(values) if len(values) == len(kind.fields) and not keys else None

    def scalar(self, kind: ScalarType, given: object, origin: Origin) -> Scalar | None:
        """A scalar value of a type."""
        match kind, given:
            case IntegerType(), int() if not isinstance(given, bool):
                if kind.first <= given <= kind.last:
                    return given
            case EnumerationType(), bool() if kind == BOOLEAN:
                return str(given)
            case EnumerationType(), str():
                for literal in kind.literals:
                    if literal.lower() == given.lower():
                        return literal
        hint = None
        if isinstance(kind, IntegerType):
            wanted = f"{kind.first} .. {kind.last}"
        else:
            wanted = f"one of {', '.join(kind.literals)}"
            hint = nearest_hint(str(given), kind.literals)
        self.wrong("RV-1005", origin, f"a value of type {kind.name} is {wanted}", hint)
        return None


def _find(items: tuple[N, ...], name: str) -> N | None:
    try:
        return named(items, name)
    except KeyError:
        return None


def _one_of(items: Iterable[Named]) -> str | None:
    names = [item.name for item in items]
    return f"one of: {', '.join(names)}" if names else None
