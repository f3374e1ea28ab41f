# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Terms for the active states of a region whose configurations, or their parts, are known."""

from __future__ import annotations

from collections.abc import Sequence

import z3

from ravenchart.behaviour.tree import ChartTree
from ravenchart.gen.model.statechart import Lane

from .logic import Read, Term, Variable


def is_in(asked: Sequence[Variable], found: Sequence[tuple[str, ...]], read: Read) -> Term:
    """That the active states of a region are one of these sets, as far as ``asked`` goes."""
    cases = {tuple(name.state in active for name in asked) for active in found}
    return z3.Or([_said(asked, case, read) for case in sorted(cases)])


def is_in_parts(
    tree: ChartTree, asked: Sequence[Variable], found: Sequence[tuple[str, ...]], read: Read
) -> Term:
    """The same for configurations that are known in parts: each orthogonal region is in one."""
    return z3.And([_lane(tree, lane, asked, found, read) for lane in tree.lanes])


def _lane(
    tree: ChartTree,
    lane: Lane,
    asked: Sequence[Variable],
    found: Sequence[tuple[str, ...]],
    read: Read,
) -> Term:
    """That a region and the states around it are as in one part, or that it is inactive."""
    own = [name for name in asked if tree.lane_of[name.state] == lane]
    if not own:
        return z3.BoolVal(True)
    around = tree.chains[lane.owner] if lane.owner is not None else ()
    outer = [name for name in asked if name.state in around]
    cases = {
        tuple(name.state in active for name in (*own, *outer))
        for active in found
        if any(tree.lane_of[state] == lane for state in active)
    }
    ways = [_said([*own, *outer], case, read) for case in sorted(cases)]
    if lane.owner is not None or tree.terminates:
        #  a terminate may stop the chart while one region has no active state
        without = [name for name in outer if name.state == lane.owner and not tree.terminates]
        ways.append(_said([*own, *without], (False,) * (len(own) + len(without)), read))
    return z3.Or(ways)


def _said(names: Sequence[Variable], values: Sequence[bool], read: Read) -> Term:
    """That Boolean unknowns have these values."""
    pairs = zip(names, values, strict=True)
    return z3.And([read(name) if holds else z3.Not(read(name)) for name, holds in pairs])
