# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Parts of configurations: the regions of an orthogonal state, each explored by itself.

A chart with orthogonal states has as many configurations as the product of their regions. Where
those are too many, a region is explored in *parts*: a leaf with the states around it, and nothing
of the regions beside it. A step is then made from each part as if the other regions selected
nothing. Their own parts show their transitions in the same step, with three exceptions.

A transition from inside an orthogonal state that leaves this state exits the other regions
too. Its step is also made with each of their parts (`RegionParts.meetings`). An orthogonal
state completes when each of its regions is in a final state. Here it may complete once each
of them was seen in one (`RegionParts.completed`). Data that other regions set may change between
the selection of a step and its end (`RegionParts.contested`).

So the search finds each leaf, transition and event that configurations lead to, and perhaps more.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ravenchart.behaviour.tree import TOP, ChartTree, Occurrence, RegionKey
from ravenchart.gen.language.terms import Flow, Reading, ScalarType, Set

from . import logic
from .cells import every
from .logic import Term, Variable
from .outcomes import Outcome
from .stepping import Configuration

Met = tuple[Configuration, Configuration, Occurrence]
"""A part, its union with another one, and the occurrence that a step of both is made for."""


KeptParts = tuple[str, ...]
"""Some states, in tree order."""


@dataclass
class RegionParts:
    """The parts of one region's configurations that were seen."""

    tree: ChartTree
    types: Mapping[Variable, ScalarType]
    seen: dict[str, list[Configuration]] = field(default_factory=dict)
    """By leaf, an orthogonal state being one."""
    final: set[RegionKey] = field(default_factory=set)
    """The regions that were seen in a final state of their own."""
    leaving: dict[tuple[object, ...], tuple[Configuration, Occurrence, str]] = field(
        default_factory=dict
    )
    """Steps that leave an orthogonal state from inside: the part, the occurrence, the state."""
    _contested: dict[frozenset[RegionKey], dict[Variable, Term]] = field(default_factory=dict)

    def clear(self) -> None:
        """Forget what was seen."""
        self.seen.clear()
        self.final.clear()
        self.leaving.clear()

    # --- parts of configurations

    def of(self, at: Configuration) -> Iterator[Configuration]:
        """The parts of a configuration, or of a union of parts."""
        if at.stopped:
            yield at
            return
        for leaf in at.active:
            if self.tree.is_innermost(leaf):
                region = self.tree.concurrent_region_of[leaf]
                mine = self.tree.chains[leaf]

                def kept(
                    names: Sequence[str], own: RegionKey = region, mine: Sequence[str] = mine
                ) -> KeptParts:
                    around = self.tree.concurrent_region_of
                    return tuple(n for n in names if n in mine and around[n] == own)

                yield Configuration(
                    self.tree.ordered(mine), kept(at.completed), kept(at.pending), kept(at.done)
                )

    def leaf(self, part: Configuration) -> str:
        """The leaf of a part."""
        return part.active[-1]

    def see(self, part: Configuration) -> Iterator[Configuration]:
        """Note a new part; the orthogonal states that may have completed with it."""
        leaf = self.leaf(part)
        self.seen.setdefault(leaf, []).append(part)
        slot = self.tree.slots[leaf]
        owner = slot.owner
        if leaf in self.tree.orthogonal:
            yield from self.completed(part)
        elif owner in self.tree.orthogonal and self.tree.states[leaf].final:
            assert owner is not None
            self.final.add(slot)
            for other in tuple(self.seen.get(owner, ())):
                yield from self.completed(other)

    def completed(self, part: Configuration) -> Iterator[Configuration]:
        """The part of an orthogonal state when its regions have reached their ends."""
        state = self.leaf(part)
        if state not in self.tree.completing or state in part.completed:
            return
        if state in self.tree.working and state not in part.done:
            return
        if all(region in self.final for region in self.tree.regions_of(state)):
            done = self.tree.ordered({*part.completed, state})
            yield replace(part, completed=done, pending=(*part.pending, state))

    def is_outer(self, part: Configuration) -> bool:
        """Whether the leaf of a part is orthogonal. The parts of the regions inside it show the
        steps of the leaf in which these regions select nothing."""
        return self.leaf(part) in self.tree.orthogonal

    def says(self, part: Configuration, state: str) -> bool:
        """Whether a part has the completion of an active state."""
        around = self.tree.concurrent_region_of
        return around[state] == around[self.leaf(part)]

    # --- regions that meet

    def left(self, part: Configuration, outcome: Outcome) -> Iterator[Met]:
        """The further steps for a step that leaves an orthogonal state from inside."""
        if not outcome.fired:
            return
        around = self.tree.chains[self.tree.source_of(outcome.fired[0])][1:]
        for state in around:
            if state in self.tree.orthogonal and state in outcome.left:
                key = (outcome.fired, outcome.occurrence, state)
                if key not in self.leaving:
                    self.leaving[key] = (part, outcome.occurrence, state)
                    others = [p for parts in self.seen.values() for p in parts]
                    yield from (m for o in others for m in self._met(self.leaving[key], o))

    def meetings(self, part: Configuration) -> Iterator[Met]:
        """The same for a new part, and for all known steps that leave such a state."""
        for leaver in tuple(self.leaving.values()):
            yield from self._met(leaver, part)

    def _met(
        self, leaver: tuple[Configuration, Occurrence, str], other: Configuration
    ) -> Iterator[Met]:
        part, occurrence, state = leaver
        leaf = self.leaf(other)
        if state not in other.active[:-1] or leaf in self.tree.orthogonal:
            return
        if self.tree.below(state, leaf) == self.tree.below(state, self.leaf(part)):
            return

        def both(one: KeptParts, two: KeptParts) -> KeptParts:
            return self.tree.ordered({*one, *two})

        union = Configuration(
            both(part.active, other.active),
            both(part.completed, other.completed),
            both(part.pending, other.pending),
            both(part.done, other.done),
        )
        yield part, union, occurrence

    # --- data that other regions set

    def contested(self, at: Configuration) -> dict[Variable, Term]:
        """The data that the other active regions may set, each with the unknown for it."""
        present = frozenset(self.tree.concurrent_region_of[name] for name in at.active)
        if present not in self._contested:
            absent = {
                region
                for region in self.tree.concurrent_regions
                if region not in present
                and region.owner is not None
                and any(s in at.active for s in self.tree.chains[region.owner])
            }
            self._contested[present] = {
                name: logic.symbol(f"{name} in this step", self.types[name])
                for name, regions in self._writers().items()
                if regions & absent
            }
        return self._contested[present]

    def _writers(self) -> dict[Variable, set[RegionKey]]:
        """The regions whose behaviours set each data item."""
        found: dict[Variable, set[RegionKey]] = {}
        for own, flow in self._flows():
            for action in every(flow):
                if isinstance(action, Set):
                    name = logic.variable(Reading.DATA, action.data, action.field)
                    found.setdefault(name, set()).add(own)
        return found

    def _flows(self) -> Iterator[tuple[RegionKey, Flow]]:
        tree, region = self.tree, self.tree.region
        yield TOP, region.initial.effect
        for state in region.states:
            yield tree.concurrent_region_of[state.name], state.entry
            yield tree.concurrent_region_of[state.name], state.exit
            for nested in state.regions:
                key = RegionKey(state.name, nested.name)
                yield tree.concurrent_region_around(key), nested.initial.effect
        for transition in region.transitions:
            yield RegionKey(*region.concurrent_region(transition.source)), transition.effect
