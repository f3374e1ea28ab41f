# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One region as explored so far: its nodes, its steps, and how finely it is explored."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from ravenchart.behaviour.tree import ChartTree, Occurrence, RegionKey
from ravenchart.gen.language.terms import ScalarType

from .logic import Term, Variable
from .outcomes import Outcome
from .parts import RegionParts
from .stepping import Configuration

Steps = dict[tuple[Configuration, Occurrence], tuple[Outcome, ...]]
"""The outcomes of steps, data aside."""
Cells = tuple[int, ...]
"""The cell of each variable that a region writes and distinguishes."""

MOST_NODES = 1_000
"""A region of more nodes is explored more coarsely."""
MOST_QUESTIONS = 1_500
"""A region that needs more answers of z3 for its data is explored more coarsely."""
MOST_CONFIGURATIONS = 3_000
"""A region of more configurations, data and histories aside, is explored in parts."""


@dataclass(frozen=True, slots=True)
class Situation:
    """A situation of one region: its control, and the cells of its own data."""

    configuration: Configuration
    cells: Cells


@dataclass(frozen=True, slots=True)
class Edge:
    """A step from one node to another."""

    before: Situation
    outcome: Outcome
    after: Situation


@dataclass
class Thread:
    """A region, or an activity with a flow (a region of one state), with its nodes and edges."""

    tree: ChartTree
    own: tuple[Variable, ...]
    types: Mapping[Variable, ScalarType]
    nodes: dict[Situation, Edge | None] = field(default_factory=dict)
    """Each node with the edge that leads to it on a shortest way."""
    edges: list[Edge] = field(default_factory=list)
    questions: int = 0
    past: dict[RegionKey, set[str]] | None = None
    """The leaves that each region inside was seen to remember, where nodes do not have them."""
    steps: Steps = field(default_factory=dict)
    exact: Steps = field(default_factory=dict)
    """The same with histories, where ``steps`` are without."""
    known: dict[tuple[object, ...], tuple[Cells, ...]] = field(default_factory=dict)
    answers: dict[tuple[object, ...], tuple[Term, bool]] = field(default_factory=dict)
    """Whether a condition can be met, with the condition, so that it keeps its number."""
    parts: RegionParts | None = None
    """Where configurations are explored in parts."""

    @property
    def name(self) -> str:
        """The name of the region or activity."""
        return self.tree.region.name

    def begin(self, start: Situation) -> None:
        """Forget nodes and edges, but keep the outcomes of steps."""
        self.nodes, self.edges = {start: None}, []
        if self.parts is not None:
            self.parts.clear()

    @property
    def tells_more(self) -> bool:
        """Whether the nodes distinguish data or histories."""
        return bool(self.own) or (self.past is None and bool(self.tree.remembered))

    @property
    def most(self) -> int | None:
        """How many nodes it may have before it is explored more coarsely."""
        if self.tells_more:
            return MOST_NODES
        return None if self.parts is not None or not self.tree.orthogonal else MOST_CONFIGURATIONS

    def look_coarser(self) -> None:
        """Drop the histories, or else the data, or else the combinations of regions."""
        if self.past is None and self.tree.remembered:
            self.past, self.exact, self.steps = {}, self.steps, {}
        elif self.own:
            self.own = ()
        else:
            self.exact = self.steps if self.past is None else self.exact
            self.parts, self.steps = RegionParts(self.tree, self.types), {}
        self.questions = 0
        self.known.clear()
        self.answers.clear()

    def explored(self, at: Configuration) -> Iterable[Configuration]:
        """A configuration, or the parts of it that are explored."""
        return (at,) if self.parts is None else self.parts.of(at)

    def remember(self, outcome: Outcome) -> None:
        """Note the leaves that a step remembers; steps that recall them are made again."""
        if self.past is None:
            return
        grown = set()
        for slot, leaf in outcome.remembered:
            if leaf not in self.past.setdefault(slot, set()):
                self.past[slot].add(leaf)
                grown.add(slot)
        if grown:
            made = self.steps.items()
            self.steps = {
                key: found for key, found in made if not any(one.recalled & grown for one in found)
            }

    def recalls(self) -> int:
        """The number of leaves that histories were seen to remember."""
        return sum(len(leaves) for leaves in (self.past or {}).values())
