# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Terms for the active states of a region whose configurations, or their parts, are known."""

from __future__ import annotations

from collections.abc import Sequence

import z3

from ravenchart.behaviour.tree import ChartTree, RegionKey

from .logic import Read, Term, Variable


def is_in(asked: Sequence[Variable], found: Sequence[tuple[str, ...]], read: Read) -> Term:
    """That the active states of a region are one of these sets, as far as ``asked`` goes."""
    cases = {tuple(name.state in active for name in asked) for active in found}
    return z3.Or([_said(asked, case, read) for case in sorted(cases)])


def is_in_parts(
    tree: ChartTree, asked: Sequence[Variable], found: Sequence[tuple[str, ...]], read: Read
) -> Term:
    """The same for configurations that are known in parts: each orthogonal region is in one."""
    return z3.And([_of_region(tree, one, asked, found, read) for one in tree.concurrent_regions])


def _of_region(
    tree: ChartTree,
    region: RegionKey,
    asked: Sequence[Variable],
    found: Sequence[tuple[str, ...]],
    read: Read,
) -> Term:
    """That a region and the states around it are as in one part, or that it is inactive."""
    own = [name for name in asked if tree.concurrent_region_of[name.state] == region]
    if not own:
        return z3.BoolVal(True)
    around = tree.chains[region.owner] if region.owner is not None else ()
    outer = [name for name in asked if name.state in around]
    cases = {
        tuple(name.state in active for name in (*own, *outer))
        for active in found
        if any(tree.concurrent_region_of[state] == region for state in active)
    }
    ways = [_said([*own, *outer], case, read) for case in sorted(cases)]
    if region.owner is not None or tree.terminates:
        #  a terminate may stop the chart while one region has no active state
        without = [name for name in outer if name.state == region.owner and not tree.terminates]
        ways.append(_said([*own, *without], (False,) * (len(own) + len(without)), read))
    return z3.Or(ways)


def _said(names: Sequence[Variable], values: Sequence[bool], read: Read) -> Term:
    """That Boolean unknowns have these values."""
    pairs = zip(names, values, strict=True)
    return z3.And([read(name) if holds else z3.Not(read(name)) for name, holds in pairs])
