# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""YAML text to a tree of located values, within limits.

The tree is built from PyYAML's parser events, not by a loader. Tags, anchors and aliases are
refused. Scalars follow the rules of this language and not those of YAML 1.1. Every key and value
keeps its location. Scalars are integers (decimal or 0x, underscores between digits), ``true`` and
``false``; everything else is text, and so is everything in quotes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

import yaml
from yaml.events import (
    AliasEvent,
    DocumentStartEvent,
    Event,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.origins import Origin

FormPath = tuple[int | str, ...]
"""Keys and numbers of items, from the root of a file."""

DEEPEST = 64
"""Most mappings and lists inside each other."""

INTEGER = re.compile(r"[-+]?(?:0|[1-9][0-9]*(?:_[0-9]+)*|0x[0-9A-Fa-f]+(?:_[0-9A-Fa-f]+)*)")
LINE_BREAK = re.compile("\r\n|[\n\r\x85\u2028\u2029]")
UNLIKE = re.compile("[?!\ufeff]|[|>][-+0-9]*#")
"""Text that libyaml and PyYAML's own parser may read differently."""


@dataclass(frozen=True, slots=True)
class TextPlace:
    """Where a key or value begins; ``exact`` when the text stands there as it is, in one line."""

    origin: Origin
    exact: bool = False


class Map(dict[str, object]):
    """A mapping that knows where its keys and values stand.

    ``dropped`` names the entries taken out because they were wrong;
    ``damaged`` tells that something inside was taken out.
    """

    def __init__(self, origin: Origin) -> None:
        """An empty mapping at ``origin``."""
        super().__init__()
        self.origin = origin
        self.keys_at: dict[str, Origin] = {}
        self.values_at: dict[str, TextPlace] = {}
        self.dropped: dict[str, None] = {}
        self.damaged = False


class Seq(list[object]):
    """A list that knows where its items stand."""

    def __init__(self, origin: Origin) -> None:
        """An empty list at ``origin``."""
        super().__init__()
        self.origin = origin
        self.items_at: list[TextPlace] = []
        self.damaged = False


class RefusedError(Exception):
    """Ends the reading of a file; carries why. Never leaves this module."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        """Refused because of ``diagnostic``."""
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


@dataclass(slots=True)
class Builder:
    """The tree under construction: the containers that are open, innermost last."""

    file: str
    found: list[Diagnostic]
    open: list[Map | Seq] = field(default_factory=list)
    keys: list[tuple[str, Origin] | None] = field(default_factory=list)
    """The key that waits for its value, for each open container."""
    root: object = None
    root_at: Origin | None = None
    refused: bool = False
    """The reading ended early."""

    def at(self, event: Event) -> Origin:
        """Where the event begins."""
        mark = event.start_mark
        return (
            Origin(self.file, mark.line + 1, mark.column + 1) if mark else Origin(self.file, 1, 1)
        )

    def refuse(self, code: str, event: Event, message: str, hint: str) -> RefusedError:
        """The end of this file."""
        return RefusedError(error(code, self.at(event), message, hint=hint))

    def take(self, event: Event) -> None:
        """Add what the event begins or ends."""
        if isinstance(event, AliasEvent) or getattr(event, "anchor", None) is not None:
            hint = "write the value out where it is used"
            raise self.refuse("RV-0108", event, "anchors and aliases are not allowed", hint)
        if getattr(event, "tag", None) not in (None, "!"):
            hint = "leave the tag out"
            raise self.refuse("RV-0110", event, "YAML tags are not allowed", hint)
        if isinstance(event, ScalarEvent):
            self._scalar(event)
        elif isinstance(event, (MappingStartEvent, SequenceStartEvent)):
            self._begin(event)
        elif isinstance(event, (MappingEndEvent, SequenceEndEvent)):
            self.open.pop()
            self.keys.pop()

    def _begin(self, event: Event) -> None:
        if len(self.open) == DEEPEST:
            message = f"mappings and lists are nested more than {DEEPEST} deep"
            raise self.refuse("RV-0107", event, message, "nest less deeply")
        origin = self.at(event)
        if self.open and isinstance(self.open[-1], Map):
            waiting = self.keys[-1]
            if waiting is None:
                message = "a key must be plain text, not a mapping or list"
                raise self.refuse("RV-0113", event, message, "put quotes around text with { or [")
            origin = waiting[1]
        begun = Map(origin) if isinstance(event, MappingStartEvent) else Seq(origin)
        self._put(begun, TextPlace(self.at(event)))
        self.open.append(begun)
        self.keys.append(None)

    def _scalar(self, event: ScalarEvent) -> None:
        if self.open and isinstance(self.open[-1], Map) and self.keys[-1] is None:
            origin = self.at(event)
            if event.value in self.open[-1].keys_at:
                first = self.open[-1].keys_at[event.value]
                self.found.append(
                    error(
                        "RV-0109",
                        origin,
                        f"the key `{event.value}` is given twice",
                        notes=[(first, "the first is here")],
                        hint="remove one of them",
                    )
                )
            self.keys[-1] = (event.value, origin)
            return
        quoted = 1 if event.style else 0
        begin, end = event.start_mark, event.end_mark
        exact = (
            begin is not None
            and end is not None
            and event.style not in ("|", ">")
            and begin.line == end.line
            and end.column - begin.column == len(event.value) + 2 * quoted
        )
        origin = self.at(event)
        if exact:
            origin = replace(origin, column=origin.column + quoted)
        self._put(event.value if quoted else scalar_value(event.value), TextPlace(origin, exact))

    def _put(self, value: object, place: TextPlace) -> None:
        if not self.open:
            self.root, self.root_at = value, place.origin
            return
        container = self.open[-1]
        if isinstance(container, Seq):
            container.append(value)
            container.items_at.append(place)
            return
        waiting, self.keys[-1] = self.keys[-1], None
        if waiting is not None and waiting[0] not in container.keys_at:
            container[waiting[0]] = value
            container.keys_at[waiting[0]] = waiting[1]
            container.values_at[waiting[0]] = place


def scalar_value(text: str) -> int | bool | str:
    """A plain scalar's value: an integer, a Boolean, or the text itself."""
    if text in ("true", "false"):
        return text == "true"
    if len(text) <= 40 and INTEGER.fullmatch(text):
        digits = text.replace("_", "")
        return int(digits, 16) if "x" in digits else int(digits)
    return text


def lines_of(text: str) -> tuple[str, ...]:
    """The lines of a file, broken where YAML breaks them."""
    return tuple(LINE_BREAK.split(text))


def grow(text: str, file: str) -> tuple[Map | None, list[Diagnostic]]:
    """The tree of a file whose content must be one mapping, and what is wrong with it."""
    builder = _built(text, file)
    found = builder.found
    if builder.refused:
        return None, found
    if builder.root_at is None or builder.root == "":
        hint = "start with `system: Name_Of_The_System`"
        return None, [*found, error("RV-0104", Origin(file, 1, 1), "the file is empty", hint=hint)]
    if not isinstance(builder.root, Map):
        message = "a model file must be a mapping, that is `key: value` lines"
        return None, [*found, error("RV-0203", builder.root_at, message)]
    return builder.root, found


def grow_list(text: str, file: str) -> tuple[Seq | None, list[Diagnostic]]:
    """The tree of a file whose content is one list, None when it is not one."""
    builder = _built(text, file)
    if isinstance(builder.root, Seq) and not builder.refused:
        return builder.root, builder.found
    return None, builder.found


def _built(text: str, file: str) -> Builder:
    """The tree of a file, as far as it could be read."""
    builder = Builder(file, [])
    try:
        _no_tabs(text, file)
        documents = 0
        for event in _events(text, file):
            if isinstance(event, DocumentStartEvent):
                documents += 1
                if documents > 1:
                    hint = "put the second document into a file of its own and include it"
                    raise builder.refuse("RV-0111", event, "a second document begins here", hint)
            builder.take(event)
    except RefusedError as refused:
        builder.found.append(refused.diagnostic)
        builder.refused = True
    return builder


def _no_tabs(text: str, file: str) -> None:
    """Refuse a tab before PyYAML does so in less helpful words."""
    for number, line in enumerate(lines_of(text), start=1):
        if "\t" in line:
            origin = Origin(file, number, line.index("\t") + 1)
            hint = "indent with spaces"
            raise RefusedError(error("RV-0105", origin, "tabs are not allowed", hint=hint))


def _events(text: str, file: str) -> Iterator[Event]:
    """PyYAML's events; whatever it finds wrong becomes a located `RefusedError`."""
    try:
        yield from parsed(text)
    except yaml.reader.ReaderError as problem:
        before = text[: problem.position]
        line = len(LINE_BREAK.findall(before))
        column = len(LINE_BREAK.split(before)[-1])
        message = f"the character U+{ord(text[problem.position]):04X} is not allowed"
        origin = Origin(file, line + 1, column + 1)
        raise RefusedError(error("RV-0106", origin, message, hint="remove it")) from None
    except yaml.MarkedYAMLError as problem:
        mark = problem.problem_mark or problem.context_mark
        origin = Origin(file, mark.line + 1, mark.column + 1) if mark else Origin(file, 1, 1)
        words = " ".join(part for part in (problem.context, problem.problem) if part)
        hint = "text that holds any of : # { } [ ] , & * ! | > ' \" % @ ` may need quotes"
        raise RefusedError(error("RV-0106", origin, f"not YAML: {words}", hint=hint)) from None
    except (ValueError, OverflowError):  # an escape or directive out of all bounds
        message = "not YAML: a number or character escape is out of bounds"
        hint = "remove the escape or directive"
        raise RefusedError(error("RV-0106", Origin(file, 1, 1), message, hint=hint)) from None


def parsed(text: str) -> Iterable[Event]:
    """PyYAML's events: by libyaml, the faster, where both parsers agree and all is well."""
    if yaml.__with_libyaml__ and not UNLIKE.search(text):
        try:
            events = _until_too_deep(yaml.parse(text, Loader=yaml.CSafeLoader))
        except (yaml.YAMLError, ValueError, OverflowError):
            events = []  # PyYAML's own parser says what is wrong
        #  where a value is missing, the two see its place differently
        if events and not any(isinstance(e, ScalarEvent) and e.value == "" for e in events):
            return events
    return yaml.parse(text, Loader=yaml.SafeLoader)


def _until_too_deep(events: Iterable[Event]) -> list[Event]:
    """The events up to one that opens more than `DEEPEST`: a parser's time grows with depth."""
    taken: list[Event] = []
    depth = 0
    for event in events:
        taken.append(event)
        if isinstance(event, (MappingStartEvent, SequenceStartEvent)):
            depth += 1
            if depth > DEEPEST:
                break
        elif isinstance(event, (MappingEndEvent, SequenceEndEvent)):
            depth -= 1
    return taken
