# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Generated Ada as nodes with their places, and a unit in which some of them are others."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any, Generic, TypeVar

from ravenchart.gen.emit.ada.declarations import Subprogram, Unit
from ravenchart.gen.emit.ada.expressions import Expr, OperatorChain
from ravenchart.gen.emit.ada.named import DottedName
from ravenchart.gen.emit.ada.statements import NULL, Case, IfStatement, Loop, Stmt

Step = int | str
"""A position in a tuple, or a field of a node."""
Path = tuple[Step, ...]
T = TypeVar("T")
Node = TypeVar("Node", covariant=True)
Key = TypeVar("Key", bound=Hashable)


@dataclass(frozen=True, slots=True)
class Spot(Generic[Node]):
    """A node, and the way to it from its unit."""

    path: Path
    node: Node

    def at(self, *steps: Step) -> Spot[Any]:
        """What stands there in the node."""
        node: Any = self.node
        for step in steps:
            node = node[step] if isinstance(step, int) else getattr(node, step)
        return Spot((*self.path, *steps), node)

    def within(self, kind: type[T]) -> Iterator[Spot[T]]:
        """The node and those in it that are of a kind, an outer one before those in it."""
        waiting: list[tuple[Path, object]] = [(self.path, self.node)]
        while waiting:
            path, node = waiting.pop()
            if isinstance(node, kind):
                yield Spot(path, node)
            waiting += [((*path, step), part) for step, part in _parts(node)[::-1]]


def _parts(node: object) -> list[tuple[Step, object]]:
    """The nodes that a node consists of."""
    found: list[tuple[Step, object]] = []
    if isinstance(node, tuple):
        found += enumerate(node)
    elif not isinstance(node, DottedName):
        found += [(name, getattr(node, name)) for name in getattr(node, "__slots__", ())]
    return [(step, part) for step, part in found if not isinstance(part, str | int | None)]


@dataclass(frozen=True, slots=True)
class Put:
    """Another node in a place."""

    path: Path
    node: object


def put(spot: Spot[object], node: object) -> tuple[Put, ...]:
    """One other node."""
    return (Put(spot.path, node),)


def exchanged(one: Spot[object], other: Spot[object]) -> tuple[Put, ...]:
    """Two nodes that change places."""
    return Put(one.path, other.node), Put(other.path, one.node)


class Together(tuple[object, ...]):
    """Nodes that stand where one stood."""

    __slots__ = ()


def moved_behind(one: Spot[object], other: Spot[object]) -> tuple[Put, ...]:
    """The first of two statements behind the second; what stands between them stays."""
    return Put(one.path, NULL), Put(other.path, Together((other.node, one.node)))


def written(node: T, puts: Sequence[Put]) -> T:
    """The node with others in these places, which are not in each other."""
    changed: Any = node
    for step, inside in groupby(sorted(puts, key=lambda p: str(p.path[:1])), lambda p: p.path[:1]):
        rest = [Put(one.path[1:], one.node) for one in inside]
        if not step:
            return rest[0].node  # type: ignore[return-value]
        changed = _with(changed, step[0], rest)
    return changed  # type: ignore[no-any-return]


def _with(node: Any, step: Step, puts: Sequence[Put]) -> object:
    if isinstance(step, str):
        return replace(node, **{step: written(getattr(node, step), puts)})
    made = written(node[step], puts)
    here = made if isinstance(made, Together) else (made,)
    parts = [*node[:step], *here, *node[step + 1 :]]
    return tuple(parts) if type(node) is tuple else type(node)(*parts)


# --- What rules look for ---------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Body:
    """A subprogram with a body: statements, or an expression."""

    spot: Spot[Subprogram]

    @property
    def name(self) -> str:
        """The name of the subprogram."""
        return self.spot.node.name

    @property
    def is_expression(self) -> bool:
        """Is it an expression function?"""
        return self.spot.node.expression is not None

    @property
    def inner(self) -> Spot[Any]:
        """The statements, as a tuple, or the expression."""
        return self.spot.at("expression" if self.is_expression else "body")

    @property
    def fires(self) -> bool:
        """Is it Fire, or one of the procedures that do a part of it in a large region?"""
        return self.name == "Fire" or self.name.startswith("Fire_From_")


def whole(unit: Unit) -> Spot[Unit]:
    """A unit as the beginning of all ways."""
    return Spot((), unit)


def bodies(unit: Unit) -> list[Body]:
    """Every subprogram that has a body in a unit, an outer one before those in it."""
    found = map(Body, whole(unit).within(Subprogram))
    return [one for one in found if one.inner.node is not None]


def body_of(unit: Unit, name: str) -> Body | None:
    """The one of that name, or None."""
    return next((one for one in bodies(unit) if one.name == name), None)


def statements(inner: Spot[tuple[Stmt, ...]]) -> list[Spot[Stmt]]:
    """The statements of a list."""
    return [inner.at(position) for position in range(len(inner.node))]


def lists_in(inner: Spot[tuple[Stmt, ...]]) -> Iterator[Spot[tuple[Stmt, ...]]]:
    """The lists of statements inside those of a list: of arms, branches and loops."""
    for statement in statements(inner):
        for own in _lists(statement):
            yield own
            yield from lists_in(own)


def _lists(statement: Spot[Stmt]) -> Iterator[Spot[tuple[Stmt, ...]]]:
    match statement.node:
        case Case(_, branches):
            yield from (statement.at("branches", n, 1) for n in range(len(branches)))
        case IfStatement(branches, otherwise):
            yield from (statement.at("branches", n, 1) for n in range(len(branches)))
            if otherwise:
                yield statement.at("otherwise")
        case Loop():
            yield statement.at("body")


def conjuncts(condition: Spot[Expr]) -> list[Spot[Expr]]:
    """The parts of a condition, joined by ``and then``."""
    match condition.node:
        case OperatorChain("and then", operands):
            return [condition.at("operands", position) for position in range(len(operands))]
    return [condition]


def names_of(node: object) -> Iterator[DottedName]:
    """Each name in a node."""
    return (spot.node for spot in Spot((), node).within(DottedName))


def is_within(name: DottedName, outer: DottedName) -> bool:
    """Is it that name, or of a part of what that name is of?"""
    return name.parts[: len(outer.parts)] == outer.parts


def following(here: Key, among: Sequence[Key]) -> Key | None:
    """The next of several in a circle; None where there is no other."""
    ordered = list(dict.fromkeys(among))
    if here not in ordered or len(ordered) < 2:
        return None
    return ordered[(ordered.index(here) + 1) % len(ordered)]


def each_following(
    found: Sequence[tuple[Key, Spot[Any]]],
) -> Iterator[tuple[Spot[Any], tuple[Put, ...]]]:
    """Each of some nodes with the next of those that have the same key instead."""
    alike: dict[Key, list[Any]] = {}
    for key, spot in found:
        alike.setdefault(key, []).append(spot.node)
    for key, spot in found:
        other = following(spot.node, alike[key])
        if other is not None:
            yield spot, put(spot, other)
