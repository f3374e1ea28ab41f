# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Advice: single changes that suffice, those of least effect on the design first.

Where deadlines are missed, the aim is to meet them. Where they are met with little room,
the aim is that all execution times may still grow by `ROOM`. Models and plain files
determine the parts that can be changed, `core.changes` determines the amounts.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from ravenchart import rounded
from ravenchart.analysis.core import changes, holistic
from ravenchart.analysis.core.changes import Change, ChangeKind, Met, Part
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.sensitivity import NetworkScaling, network_scaling, scaled_network
from ravenchart.gen.model.nodes import PROBE, SUPERVISOR
from ravenchart.rounded import Rounding

if TYPE_CHECKING:
    from ravenchart.analysis.system.timing import Analysis

ROOM = Fraction(1, 5)
"""With less room than this, a system that meets its deadlines is tight."""

LARGEST = 120
"""With more tasks and messages than this, no changes are searched for."""

TRIED = 24
"""Execution times and periods that are tried, those of most load first."""

SHOWN = 12
"""Changes that are shown."""

WEIGHED = 6
"""Parts of most load whose relief is shown where no change is enough."""


@dataclass(frozen=True, slots=True)
class Choices:
    """The parts of a network that can be changed.

    ``wcets`` are parts by their names in reports, ``periods`` items that events release,
    ``order`` tasks and frames whose priority or identifier is free.
    """

    wcets: Mapping[str, Sequence[Part]]
    periods: Sequence[str]
    order: Sequence[str]


@dataclass(frozen=True, slots=True)
class Advice:
    """The changes, best first, and whether they are for ``room`` or to meet deadlines.

    Where none is enough, ``relief`` has a factor for each of some parts, the largest first:
    without that part, execution times scaled by the factor meet the deadlines.
    """

    network: Network
    choices: Choices
    room: bool
    changes: tuple[Change, ...]
    relief: tuple[tuple[str, Fraction], ...] = ()
    limits: bool = False
    """Whether a chain is above its limit: the changes also bring it below the limit."""


def of_model(analysis: Analysis) -> Advice | None:
    """The advice for a model; None where there is room enough, or the model is too large."""
    system, network = analysis.system, analysis.network
    wcets: dict[str, list[Part]] = {}
    for task in system.tasks:
        if task.driver_of is not None:
            wcets.setdefault(f"driver_wcet of {task.driver_of}", []).append((task.element, ""))
        elif not task.slots:
            wcets[task.element] = [(task.element, "")]
        wcets |= {slot.element: [(task.element, slot.element)] for slot in task.slots}
    own = {f"{node.name}.{name}" for node in system.nodes for name in (PROBE, SUPERVISOR)}
    own |= {str(p.released_by_interrupt) for p in system.processors if p.released_by_interrupt}
    free = [t for t in system.tasks if t.released_by is None and t.element not in own]
    periods = [task.element for task in free if not task.sporadic]
    periods += [message.element for message in system.messages if message.source is None]
    order = [*(task.element for task in free), *(m.element for m in system.messages)]
    choices = Choices(wcets, periods, order)
    found = advice(network, choices, analysis.scaling, analysis.schedulable, keeps_all(analysis))
    late = any(not latency.met for _, latency in analysis.limited)
    return found and replace(found, limits=late)


def keeps_all(analysis: Analysis) -> Met:
    """Whether a changed network meets every deadline and limit, and loses no values."""

    def holds(other: Network) -> bool:
        return any(
            found.met and replace(analysis, network=other, found=found, plain=found).schedulable
            for found in holistic.analyses(other)
        )

    return holds


def of_network(network: Network, scaling: NetworkScaling | None, *, met: bool) -> Advice | None:
    """The advice for a plain file."""
    wcets = {
        f"{task.name}.{row}" if row else task.name: [(task.name, row)]
        for task in network.tasks
        for _, row in changes.parts(task)
        if row or task.wcet
    }
    items = list(network.items())
    periods = [name for name in items if name not in network.released_by]
    return advice(network, Choices(wcets, periods, items), scaling, met, holistic.met)


def advice(
    network: Network, choices: Choices, scaling: NetworkScaling | None, met: bool, holds: Met
) -> Advice | None:
    """The changes that are tried, ranked; ``met``: the network already meets its deadlines."""
    if len(network.items()) > LARGEST:
        return None
    if met and (scaling is None or scaling.factor >= 1 + ROOM):
        return None
    tasks = {task.name for task in network.tasks}

    def aim(other: Network) -> bool:
        return holds(scaled_network(other, 1 + ROOM, tasks) if met else other)

    loads = {name: item.utilisation for name, item in network.items().items()}
    wcets = sorted(choices.wcets, key=lambda name: -_load(network, choices.wcets[name]))
    periods = sorted(choices.periods, key=lambda name: -loads[name])
    found = [
        *changes.reordered(network, choices.order, aim),
        *changes.shorter(network, {name: choices.wcets[name] for name in wcets[:TRIED]}, aim),
        *changes.slower(network, periods[:TRIED], aim),
    ]
    late = None if scaling is None else scaling.binding
    if late in choices.order and late not in tasks and late is not None:
        found += changes.moved(network, late, aim)
    relief: list[tuple[str, Fraction]] = []
    if not any(change.enough for change in found):
        relief = _relief(network, {name: choices.wcets[name] for name in wcets[:WEIGHED]}, tasks)
    return Advice(network, choices, met, changes.ranked(found), tuple(relief))


def _relief(
    network: Network, wcets: Mapping[str, Sequence[Part]], tasks: Collection[str]
) -> list[tuple[str, Fraction]]:
    """The factor that meets all deadlines without each part, where it is larger than with it."""
    nearly_none = Fraction(1, changes.STEPS)
    present = network_scaling(network, tasks, changes.STEPS)
    if present is not None and present.factor >= 1:
        return []  # deadlines are met: a limit of a chain or a queue is not
    found = []
    for name, members in wcets.items():
        without = changes.shrunk(network, members, nearly_none)
        scaling = network_scaling(without, tasks, changes.STEPS)
        if scaling is not None and (present is None or scaling.factor > present.factor):
            found.append((name, scaling.factor))
    return sorted(found, key=lambda pair: -pair[1])


def _load(network: Network, chosen: Sequence[Part]) -> Fraction:
    """The share of a core that these parts need."""
    load = Fraction(0)
    for task in network.tasks:
        load += Fraction(task.wcet, task.period) if (task.name, "") in chosen else 0
        for row in task.rows:
            if (task.name, row.name) in chosen:
                load += Fraction(row.wcet, task.period * row.every)
    return load


def lines(found: Advice | None) -> tuple[str, ...]:
    """The advice in words: a heading, the sufficient changes, and the insufficient ones."""
    if found is None:
        return ()
    aim = "keep all deadlines and limits" if found.limits else "meet all deadlines"
    if found.room:
        aim = f"let all execution times grow by {rounded.room(ROOM)}"
    enough = [change for change in found.changes if change.enough]
    rest = [change for change in found.changes if not change.enough]
    told = (
        [f"To {aim}, one of these is enough:"]
        if enough
        else [f"No change of one WCET, period or order alone would {aim}."]
    )
    told += [f"  {_told(change, found)}" for change in enough[:SHOWN]]
    if len(enough) > SHOWN:
        told.append(f"  and {len(enough) - SHOWN} more")
    told += [f"  {_worth(name, factor)}" for name, factor in found.relief]
    return (*told, *_not_enough(rest))


def _worth(name: str, factor: Fraction) -> str:
    """The relief without a part, in words."""
    if factor >= 1:
        return f"without {name}, all else may grow by {rounded.room(factor - 1)}"
    return f"without {name}, all else must still shrink by {rounded.percent(1 - factor)}"


def figures(found: Advice | None) -> list[dict[str, object]]:
    """The changes for JSON: factors of present times, to meet deadlines or to ``grow`` by."""
    if found is None:
        return []
    return [
        {
            "change": one.kind.value,
            "of": one.name,
            "enough": one.enough,
            "factor": f"{one.factor.numerator}/{one.factor.denominator}" if one.factor else None,
            "order": list(one.order),
            "grow": f"{ROOM.numerator}/{ROOM.denominator}" if found.room else None,
        }
        for one in found.changes
    ]


def _not_enough(rest: Sequence[Change]) -> Iterator[str]:
    """The changes that do not suffice alone, in a sentence for each kind."""
    longer = f"A longer period (up to {changes.LONGEST} times)"
    words = {
        ChangeKind.ORDER: "Reordering alone was not found to be enough on",
        ChangeKind.WCET: "Shortening one of these alone is not enough",
        ChangeKind.PERIOD: f"{longer} of one alone is not enough",
        ChangeKind.PLACE: "Even the most urgent identifier for one of these alone is not enough",
    }
    for kind, text in words.items():
        names = [change.name or "the core" for change in rest if change.kind is kind]
        if names:
            more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
            yield f"{text}: {', '.join(names[:SHOWN])}{more}."


def _told(change: Change, found: Advice) -> str:
    """One change in words; times are rounded so that they suffice."""
    if change.factor is None:
        what = "priorities" if change.order[0] in _tasks(found) else "identifiers"
        if change.kind is ChangeKind.PLACE:
            place = change.order.index(change.name)
            return f"identifier of {change.name} before that of {change.order[place + 1]}"
        return f"{what} of {change.name or 'the core'} in this order: {', '.join(change.order)}"
    share = rounded.percent(change.amount)
    if change.kind is ChangeKind.PERIOD:
        period = found.network.items()[change.name].period
        longer = -(-period * change.factor.numerator // change.factor.denominator)
        before, after = rounded.changed(period, longer, Rounding.UP)
        return f"period of {change.name} longer by {share}: {before} to {after}"
    wcet = _wcet(found, change.name)
    shorter = wcet * change.factor.numerator // change.factor.denominator
    before, after = rounded.changed(wcet, shorter, Rounding.DOWN)
    return f"WCET of {change.name} less by {share}: {before} to {after}"


def _tasks(found: Advice) -> set[str]:
    return {task.name for task in found.network.tasks}


def _wcet(found: Advice, name: str) -> int:
    """The time of one of the parts with that name: all have the same."""
    task_name, row_name = found.choices.wcets[name][0]
    task = next(task for task in found.network.tasks if task.name == task_name)
    return next((row.wcet for row in task.rows if row.name == row_name), task.wcet)
