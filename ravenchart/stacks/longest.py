# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The longest path from a root of a call graph, or why there is no bound."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from typing import NamedTuple

from .graph import INDIRECT, Function, Graph, StackFrame, plain_symbol


@dataclass(frozen=True, slots=True)
class StackBound:
    """A limit of a function's stack that the call graph does not give, and why it holds."""

    extra: int
    """Bytes of a frame beyond the part that has a size."""
    why: str
    depth: int = 1
    """How many frames it has at once: it may call itself that often, less one."""


@dataclass(frozen=True, slots=True)
class Rules:
    """Facts about a program beside its call graph."""

    library: int | None = None
    """Bytes for any call of what is not in the graph; None: all must be in it."""
    bounds: Mapping[str, StackBound] = field(default_factory=dict)
    """Symbol to bound, of frames of dynamic size and functions that call themselves."""
    pointers: Mapping[str, Sequence[str]] = field(default_factory=dict)
    """Symbol of a caller to patterns of the symbols that it calls through pointers."""
    linked: frozenset[str] = frozenset()
    """The symbols of the image, without ``library``: what is not among them is weak, and absent."""
    endings: frozenset[str] = frozenset()
    """Symbols that never return, so a call of one from inside of it is no recursion."""


@dataclass(frozen=True, slots=True)
class PathFrame:
    """A frame on a path."""

    title: str
    size: int
    place: str = ""
    """Where the caller calls it."""


LIBRARY = "the run-time library"
"""The title of all that is not in the graph."""

FINALIZATION = "___finalization"
"""In the symbols of subprograms that GNAT adds where it executes contracts. They ask the run-time
library through a pointer (a soft link) for the exception that is propagated."""


@dataclass(frozen=True, slots=True)
class Recursion:
    """Functions that call each other in a circle, the first one again at the end."""

    cycle: tuple[str, ...]
    place: str


@dataclass(frozen=True, slots=True)
class Indirect:
    """A call through a pointer."""

    caller: str
    place: str


@dataclass(frozen=True, slots=True)
class Unbounded:
    """A frame whose size has no bound."""

    function: str
    place: str
    objects: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Missing:
    """A function that is called and whose code is not there."""

    function: str
    caller: str


StackProblem = Recursion | Indirect | Unbounded | Missing


class _Best(NamedTuple):
    """The depth from a function on, and the callee that it comes from."""

    depth: int
    callee: str


class Depths:
    """Longest paths in one graph; each function is looked at once.

    The callees of an ending are walked once more, apart: there, a call of an ending is left out.
    """

    def __init__(self, graph: Graph, rules: Rules) -> None:
        self.graph = graph
        self.rules = rules
        self.problems: dict[StackProblem, None] = {}
        self._endings = {t for t, f in graph.items() if plain_symbol(f.name) in rules.endings}
        self._ended: dict[str, _Best] = {}
        """Of an ending and what it calls."""
        self._best: dict[str, _Best] = {}

    def depth(self, root: str) -> int:
        """Bytes from the root on; what has no bound is among the problems."""
        for title in sorted(self._endings - self._best.keys()):
            self._walk(title, self._ended, inside=True)
            self._best[title] = self._ended[title]
        self._walk(root, self._best, inside=False)
        return self._best[root].depth

    def path(self, root: str) -> tuple[PathFrame, ...]:
        """The frames of the longest path, the root first."""
        self.depth(root)
        steps: list[PathFrame] = []
        title, place, best = root, "", self._best
        while title:
            if title in self._endings:
                best = self._ended
            below = best[title].callee
            rest = best[below].depth if below else 0
            steps.append(PathFrame(title, best[title].depth - rest, place))
            place = self.graph[title].calls.get(below, "") if title in self.graph else ""
            title = below
        return tuple(steps)

    def _walk(self, root: str, best: dict[str, _Best], *, inside: bool) -> None:
        """Depth first, without recursion of its own."""
        if root in best:
            return
        open_: dict[str, list[str]] = {root: self._below(root, inside=inside)}
        while open_:
            title, waiting = next(reversed(open_.items()))
            if waiting:
                callee = waiting.pop()
                if callee == title and self._times(title) > 1:
                    continue
                if callee in open_:
                    self._recursion(list(open_), callee)
                elif callee not in best:
                    open_[callee] = self._below(callee, inside=inside)
            else:
                del open_[title]
                known = [c for c in self._below(title, inside=inside) if c in best]
                deepest = max(known, key=lambda c: (best[c].depth, c), default="")
                rest = best[deepest].depth if deepest else 0
                best[title] = _Best(self._size(title) + rest, deepest)

    def _below(self, title: str, *, inside: bool) -> list[str]:
        """The callees of a function; ``inside`` an ending without the endings."""
        found = self._callees(title)
        return [one for one in found if one not in self._endings] if inside else found

    def _callees(self, title: str) -> list[str]:
        """The callees of a function, pointers resolved and the library folded."""
        function = self.graph.get(title)
        if function is None:
            return []
        found: list[str] = []
        for callee, place in function.calls.items():
            if callee == INDIRECT and FINALIZATION in function.name and self._has_allowance:
                found.append(LIBRARY)
            elif callee == INDIRECT:
                found += self._through_pointers(function, place)
            elif callee in self.graph:
                found.append(callee)
            elif self.rules.library is not None:
                found.append(LIBRARY)
            elif callee in self.rules.linked:
                self.problems[Missing(callee, function.name)] = None
        return sorted(set(found), reverse=True)

    @property
    def _has_allowance(self) -> bool:
        return self.rules.library is not None

    def _through_pointers(self, function: Function, place: str) -> list[str]:
        known = self.rules.pointers.get(plain_symbol(function.name))
        if known is None:
            self.problems[Indirect(function.name, place or function.place)] = None
            return []
        names = {title: plain_symbol(one.name) for title, one in self.graph.items()}
        return [t for t, name in names.items() if any(fnmatchcase(name, one) for one in known)]

    def _size(self, title: str) -> int:
        if title == LIBRARY:
            return self.rules.library or 0
        function = self.graph[title]
        bound = self.rules.bounds.get(plain_symbol(function.name))
        extra = 0
        if function.frame is StackFrame.DYNAMIC:
            if bound is None:
                self.problems[Unbounded(function.name, function.place, function.objects)] = None
            else:
                extra = bound.extra
        return (function.size + extra) * self._times(title)

    def _times(self, title: str) -> int:
        """How many frames of a function are on a stack at once."""
        function = self.graph.get(title)
        bound = self.rules.bounds.get(plain_symbol(function.name)) if function else None
        return 1 if bound is None else bound.depth

    def _recursion(self, path: list[str], back: str) -> None:
        cycle = path[path.index(back) :]
        first = cycle.index(min(cycle))
        turned = [*cycle[first:], *cycle[:first]]
        names = tuple(self.graph[title].name for title in (*turned, turned[0]))
        last = self.graph[turned[-1]]
        place = last.calls.get(turned[0], "") or last.place
        self.problems[Recursion(names, place)] = None
