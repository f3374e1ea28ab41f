# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Walks over the nodes of generated Ada: what is named in them, and what they hold."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar, cast

from .declarations import Unit
from .expressions import IntegerLiteral
from .named import DottedName
from .statements import Comment

T = TypeVar("T")
_PLAIN = (str, int, type(None))
"""The types that are no nodes."""
_WHOLE = (DottedName, IntegerLiteral, Comment)
"""Nodes without others in them."""


def parts_of(construct: object) -> Sequence[object]:
    """The parts of a node, or the items of a tuple."""
    if isinstance(construct, tuple):
        return construct
    return [getattr(construct, name) for name in getattr(construct, "__slots__", ())]


def nodes_in(construct: object) -> Iterator[object]:
    """A node, and every one in it, in the order of the text; names are not divided."""
    waiting = [construct]
    while waiting:
        node = waiting.pop()
        yield node
        if not isinstance(node, _WHOLE):
            waiting += [part for part in parts_of(node)[::-1] if not isinstance(part, _PLAIN)]


def names_in(construct: object) -> Iterator[DottedName]:
    """Each name in it: types, generics and called ones as well, and its own where it is a unit.

    The identifier that a declaration introduces is none of them. Nor is that which a selector or
    an association selects.
    """
    return (node for node in nodes_in(construct) if isinstance(node, DottedName))


def rewritten(construct: T, change: Callable[[object], object]) -> T:
    """A node with ``change`` applied to it or to the nodes in it; None keeps a node."""
    changed = change(construct)
    if changed is None and not isinstance(construct, DottedName | str):
        parts = parts_of(construct)
        made = [rewritten(part, change) for part in parts]
        if all(one is other for one, other in zip(parts, made, strict=True)):
            return construct
        changed = tuple(made) if type(construct) is tuple else type(construct)(*made)
    return construct if changed is None else cast(T, changed)


def named_units(unit: Unit) -> set[DottedName]:
    """The names in a unit and their prefixes: each unit that it needs is there."""
    found: set[tuple[str, ...]] = set()
    for name in set(names_in(unit.item)):
        found.update(name.parts[:length] for length in range(1, len(name.parts) + 1))
    return set(map(DottedName, found))
