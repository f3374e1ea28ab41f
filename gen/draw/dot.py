# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Graphs in the language of Graphviz: typed statements and one printer."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from html import escape

Attributes = dict[str, "str | Html"]


class Html(str):
    """A label in Graphviz's HTML; any other text is quoted as it is."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Defaults:
    """Attributes of everything of a kind (``graph``, ``node``, ``edge``) from here on."""

    kind: str
    attributes: Attributes


@dataclass(frozen=True, slots=True)
class DotNode:
    """A node."""

    name: str
    attributes: Attributes = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class DotEdge:
    """An edge."""

    tail: str
    head: str
    attributes: Attributes = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Group:
    """A graph inside another; a cluster has a border and a name of its own."""

    name: str
    items: tuple[DotItem, ...]


DotItem = Defaults | DotNode | DotEdge | Group


def cluster(name: str) -> str:
    """The name by which edges know the cluster of an element."""
    return f"cluster {name}"


def digraph(name: str, items: Iterable[DotItem]) -> str:
    """The text of a directed graph."""
    return "".join(f"{line}\n" for line in (f"digraph {_quoted(name)} {{", *_body(items), "}"))


def _body(items: Iterable[DotItem]) -> Iterator[str]:
    for item in items:
        for line in _lines(item):
            yield f"  {line}"


def _lines(item: DotItem) -> Iterator[str]:
    match item:
        case Defaults(kind, attributes):
            yield f"{kind}{_bracketed(attributes)};"
        case DotNode(name, attributes):
            yield f"{_quoted(name)}{_bracketed(attributes)};"
        case DotEdge(tail, head, attributes):
            yield f"{_quoted(tail)} -> {_quoted(head)}{_bracketed(attributes)};"
        case Group(name, items):
            yield f"subgraph {_quoted(name)} {{"
            yield from _body(items)
            yield "}"


def _bracketed(attributes: Attributes) -> str:
    return (
        f" [{', '.join(f'{k}={_value(v)}' for k, v in attributes.items())}]" if attributes else ""
    )


def _value(text: str | Html) -> str:
    return f"<{text}>" if isinstance(text, Html) else _quoted(text)


def _quoted(text: str) -> str:
    return '"' + text.replace('"', '\\"') + '"'


def html(text: str, face: str = "") -> Html:
    """A text inside an HTML label; ``face`` is ``b`` or ``i``. Spaces do not collapse."""
    inner = re.sub(" (?= )", "\u00a0", escape(text, quote=False))
    return Html(f"<{face}>{inner}</{face}>" if face else inner)
