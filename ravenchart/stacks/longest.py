"""The longest path from a root of a call graph, or why there is no bound."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase

from .graph import INDIRECT, Frame, Function, Graph, plain


@dataclass(frozen=True, slots=True)
class Bound:
    """The most bytes that a frame takes although the compiler has none, and why that is so."""

    extra: int
    """Beyond the part of the frame that has a size."""
    why: str


@dataclass(frozen=True, slots=True)
class Rules:
    """What is known of a program beside its call graph."""

    library: int | None = None
    """Bytes for any call of what is not in the graph; None: all must be in it."""
    bounds: Mapping[str, Bound] = field(default_factory=dict)
    """Symbol to bound, of frames of dynamic size."""
    pointers: Mapping[str, Sequence[str]] = field(default_factory=dict)
    """Symbol of a caller to patterns of the symbols that it calls through pointers."""
    linked: frozenset[str] = frozenset()
    """The symbols of the image, without ``library``: what is not among them is weak, and absent."""
    endings: frozenset[str] = frozenset()
    """Symbols that never return, so a call of one from inside of it is no recursion."""


@dataclass(frozen=True, slots=True)
class Step:
    """A frame on a path."""

    title: str
    size: int
    place: str = ""
    """Where the caller calls it."""


LIBRARY = "the run-time library"
"""The title of all that is not in the graph."""


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


Problem = Recursion | Indirect | Unbounded | Missing


class Depths:
    """Longest paths in one graph; each function is looked at once."""

    def __init__(self, graph: Graph, rules: Rules) -> None:
        self.graph = graph
        self.rules = rules
        self.problems: dict[Problem, None] = {}
        self._best: dict[str, tuple[int, str]] = {}
        """Title to the depth from there, and the callee that it comes from."""

    def depth(self, root: str) -> int:
        """Bytes from the root on; what has no bound is among the problems."""
        for title in (*self._endings(), root):
            self._walk(title)
        return self._best[root][0]

    def path(self, root: str) -> tuple[Step, ...]:
        """The frames of the longest path, the root first."""
        self.depth(root)
        steps: list[Step] = []
        title, place = root, ""
        while title:
            below = self._best[title][1]
            rest = self._best[below][0] if below else 0
            steps.append(Step(title, self._best[title][0] - rest, place))
            place = self.graph[title].calls.get(below, "") if title in self.graph else ""
            title = below
        return tuple(steps)

    def _endings(self) -> list[str]:
        return [t for t, f in self.graph.items() if plain(f.name) in self.rules.endings]

    def _walk(self, root: str) -> None:
        """Depth first, without recursion of its own."""
        if root in self._best:
            return
        ends = set(self._endings())
        open_: dict[str, list[str]] = {root: self._callees(root)}
        while open_:
            title, waiting = next(reversed(open_.items()))
            if waiting:
                callee = waiting.pop()
                if callee in self._best or (callee in ends and ends & open_.keys()):
                    continue
                if callee in open_:
                    self._recursion(list(open_), callee)
                else:
                    open_[callee] = self._callees(callee)
            else:
                del open_[title]
                below = [c for c in self._callees(title) if c in self._best]
                deepest = max(below, key=lambda c: (self._best[c][0], c), default="")
                rest = self._best[deepest][0] if deepest else 0
                self._best[title] = self._size(title) + rest, deepest

    def _callees(self, title: str) -> list[str]:
        """What a function calls, pointers resolved and the library folded."""
        function = self.graph.get(title)
        if function is None:
            return []
        found: list[str] = []
        for callee, place in function.calls.items():
            if callee == INDIRECT:
                found += self._through_pointers(function, place)
            elif callee in self.graph:
                found.append(callee)
            elif self.rules.library is not None:
                found.append(LIBRARY)
            elif callee in self.rules.linked:
                self.problems[Missing(callee, function.name)] = None
        return sorted(set(found), reverse=True)

    def _through_pointers(self, function: Function, place: str) -> list[str]:
        known = self.rules.pointers.get(plain(function.name))
        if known is None:
            self.problems[Indirect(function.name, place or function.place)] = None
            return []
        names = {title: plain(one.name) for title, one in self.graph.items()}
        return [t for t, name in names.items() if any(fnmatchcase(name, one) for one in known)]

    def _size(self, title: str) -> int:
        if title == LIBRARY:
            return self.rules.library or 0
        function = self.graph[title]
        if function.frame is not Frame.DYNAMIC:
            return function.size
        bound = self.rules.bounds.get(plain(function.name))
        if bound is None:
            self.problems[Unbounded(function.name, function.place, function.objects)] = None
            return function.size
        return function.size + bound.extra

    def _recursion(self, path: list[str], back: str) -> None:
        cycle = path[path.index(back) :]
        first = cycle.index(min(cycle))
        turned = [*cycle[first:], *cycle[:first]]
        names = tuple(self.graph[title].name for title in (*turned, turned[0]))
        last = self.graph[turned[-1]]
        place = last.calls.get(turned[0], "") or last.place
        self.problems[Recursion(names, place)] = None
