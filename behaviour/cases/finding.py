# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Cases for all goals: of the system, and of components alone for goals that no system case shows.

In the whole system the activities that the user writes do nothing, and a value that one instance
sends another cannot stay away. A component alone (`gen.derive.alone`) shows the goals that depend
on these: all its inputs are free.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ravenchart.gen.derive.alone import alone, given_by, unit_instances
from ravenchart.gen.derive.distribution import as_one
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.system import System

from .goals import Goal, goals_of
from .possible import Outlook, outlook
from .search import EFFORT, CaseSearch, SearchResult


def found_cases(system: System, effort: int = EFFORT) -> SearchResult:
    """The cases that meet goals of a valid system, found in at most ``effort`` instants.

    Half of the effort, and at least one instant, is for the system. This part ends once a quarter
    of it has shown nothing new. The components share the rest alike. A system that calls
    drivers is not executed.
    """
    whole = as_one(system)
    goals = goals_of(whole)
    ahead = outlook(whole, goals)
    if system.bindings:
        found = SearchResult([], goals, [g for g in goals if g not in ahead.unreachable], [], 0)
    else:
        search = CaseSearch(whole, max(1, effort // 2), ahead=ahead, patience=max(1, effort // 8))
        found = search.found()
    cases, open_, executed = list(found.cases), list(found.open), found.executed
    stuck = list(found.stuck)
    units = list(_units(system, open_))
    share = (effort - executed) // len(units) if units else 0
    for instance in units:
        own = [goal for goal in open_ if goal.element[0] == instance.component.name]
        if own:
            unit = _of_unit(system, instance, own, ahead, share)
            cases += [replace(case, instance=instance.name) for case in unit.cases]
            met = {goal for case in unit.cases for goal in case.shows}
            open_ = [goal for goal in open_ if goal not in met]
            executed += unit.executed
            stuck += unit.stuck
    return SearchResult(cases, goals, open_, ahead.unreachable, executed, stuck)


def _units(system: System, open_: list[Goal]) -> Iterator[Instance]:
    """The instances that may meet an open goal."""
    components = {goal.element[0] for goal in open_}
    return (one for one in unit_instances(system) if one.component.name in components)


def _of_unit(
    system: System, instance: Instance, goals: list[Goal], ahead: Outlook, effort: int
) -> SearchResult:
    """The cases of one instance alone."""
    search = CaseSearch(
        alone(system, instance.name),
        effort,
        needed=goals,
        ahead=ahead,
        given=given_by(instance.component),
    )
    return search.found()
