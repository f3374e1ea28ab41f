# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""YAML text to a tree whose nodes know which characters they are made of.

`located` reads what a file means; this reads where it is written, from the events of the same
parser. It is for programs that change a text in place. A text that is not YAML has no tree.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import yaml
from yaml.events import (
    AliasEvent,
    Event,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)

from .located import DEEPEST, parsed


@dataclass(slots=True, eq=False)
class YamlScalar:
    """A scalar: its value as text, and its characters ``text[start:end]``, quotes included."""

    start: int
    end: int
    value: str


@dataclass(slots=True, eq=False)
class YamlMapping:
    """A mapping; ``end`` is behind its bracket (flow style) or its last scalar (block style)."""

    start: int
    end: int
    flow: bool
    entries: list[tuple[YamlScalar, YamlNode]] = field(default_factory=list)

    def entry(self, name: str) -> tuple[YamlScalar, YamlNode] | None:
        """The entry of that name, without regard to case."""
        wanted = name.lower()
        return next((one for one in self.entries if one[0].value.lower() == wanted), None)

    def get(self, name: str) -> YamlNode | None:
        """The value of that name, without regard to case."""
        found = self.entry(name)
        return None if found is None else found[1]

    def mapping(self, name: str) -> YamlMapping | None:
        """The same where it is a mapping."""
        found = self.get(name)
        return found if isinstance(found, YamlMapping) else None

    def scalar(self, name: str) -> YamlScalar | None:
        """The same where it is a scalar."""
        found = self.get(name)
        return found if isinstance(found, YamlScalar) else None

    def mappings(self) -> Iterator[tuple[YamlScalar, YamlMapping]]:
        """The entries whose value is a mapping."""
        yield from ((key, value) for key, value in self.entries if isinstance(value, YamlMapping))


@dataclass(slots=True, eq=False)
class Sequence:
    """A list; ``end`` as in `YamlMapping`."""

    start: int
    end: int
    flow: bool
    items: list[YamlNode] = field(default_factory=list)


YamlNode = YamlScalar | YamlMapping | Sequence

Plain = str | dict[str, "Plain"] | list["Plain"]
"""The content of a tree, without locations: scalars as text."""


def plain_tree(node: YamlNode) -> Plain:
    """The content of a tree."""
    match node:
        case YamlScalar():
            return node.value
        case YamlMapping():
            return {key.value: plain_tree(value) for key, value in node.entries}
        case Sequence():
            return [plain_tree(item) for item in node.items]


def spans(text: str) -> YamlMapping | None:
    """The tree of a text that is one mapping; None where it is not, or no model could be."""
    try:
        root = _Building().of(parsed(text))
    except (yaml.YAMLError, ValueError, OverflowError, _NotAModelError):
        return None
    return root if isinstance(root, YamlMapping) else None


class _NotAModelError(Exception):
    """The text has what no model has: an alias, a key that is no scalar, too much depth."""


class _Building:
    """A tree under construction: what is open, and the key that waits in each mapping."""

    def __init__(self) -> None:
        self.root: YamlNode | None = None
        self.open: list[YamlMapping | Sequence] = []
        self.keys: list[YamlScalar | None] = []

    def of(self, events: Iterable[Event]) -> YamlNode | None:
        """The tree of these events."""
        for event in events:
            self._take(event)
        return self.root

    def _take(self, event: Event) -> None:
        match event:
            case AliasEvent():
                raise _NotAModelError
            case ScalarEvent():
                start, end = _place(event.start_mark), _place(event.end_mark)
                self._put(YamlScalar(start, end, event.value))
            case MappingStartEvent() | SequenceStartEvent():
                if len(self.open) == DEEPEST:
                    raise _NotAModelError
                kind = YamlMapping if isinstance(event, MappingStartEvent) else Sequence
                start = _place(event.start_mark)
                begun = kind(start, start, bool(event.flow_style))
                self._put(begun)
                self.open.append(begun)
                self.keys.append(None)
            case MappingEndEvent() | SequenceEndEvent():
                self.keys.pop()
                self._close(self.open.pop(), _place(event.end_mark))

    def _close(self, ended: YamlMapping | Sequence, behind: int) -> None:
        if ended.flow:
            ended.end = behind
            return
        inside = ended.items if isinstance(ended, Sequence) else [v for _, v in ended.entries]
        ended.end = max((node.end for node in inside), default=ended.start)

    def _put(self, node: YamlNode) -> None:
        if not self.open:
            self.root = node
            return
        around = self.open[-1]
        if isinstance(around, Sequence):
            around.items.append(node)
            return
        key = self.keys[-1]
        if key is not None:
            around.entries.append((key, node))
            self.keys[-1] = None
        elif isinstance(node, YamlScalar):
            self.keys[-1] = node
        else:
            raise _NotAModelError


def _place(mark: Any) -> int:
    """The character at which a mark stands; both parsers set it for all events used here."""
    found: int = mark.index
    return found
