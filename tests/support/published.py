# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Published systems: each a plain file in tests/published, and the figures of others beside it.

`NAME.toml` has the unit of the figures, the `rows` of the table (all steps of the first figures
where it is left out), and `[[figures]]`. `of` names whose they are and `source` where they stand.
The table has those figures that are of exactly its rows.
`without` says which part of the system these figures leave out: `distances`, or a task. A
difference states our figure, the part without which ours is the published one, and the reason.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from decimal import Decimal
from functools import cached_property
from pathlib import Path

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.plain.build import PlainSystem, load_plain

FOLDER = Path(__file__).parents[1] / "published"
NAMES = tuple(sorted(path.stem for path in FOLDER.glob("*.csv")))
UNITS = {"ns": 1, "us": 10**3, "ms": 10**6}
DISTANCES = "distances"


@dataclass(frozen=True)
class Difference:
    """Our figure, and the part without which it is the published one."""

    ours: Decimal
    equal_without: str
    reason: str


@dataclass(frozen=True)
class Figures:
    """The responses that one source has of a system."""

    of: str
    source: str
    without: str | None
    responses: Mapping[str, Decimal]
    differences: Mapping[str, Difference]


@dataclass(frozen=True)
class Published:
    """A system, and the published figures of it."""

    name: str
    unit: str
    network: Network
    rows: tuple[str, ...]
    figures: tuple[Figures, ...]

    @cached_property
    def _found(self) -> dict[str | None, Mapping[str, Decimal]]:
        return {}

    def ours(self, without: str | None = None) -> Mapping[str, Decimal]:
        """The responses of our analysis in the unit of the figures, by step."""
        if without not in self._found:
            network = _left(self.network, without)
            found = holistic.analyse(network)
            bounds = {name: found.from_event(name) for name in network.items()}
            self._found[without] = {
                name: Decimal(bound) / UNITS[self.unit]
                for name, bound in bounds.items()
                if bound is not None
            }
        return self._found[without]


def _left(network: Network, without: str | None) -> Network:
    if without is None:
        return network
    if without == DISTANCES:
        return replace(network, together=False)
    return replace(network, tasks=tuple(one for one in network.tasks if one.name != without))


def published(name: str) -> Published:
    """The system and figures of a name in tests/published."""
    plain = load_plain((FOLDER / f"{name}.csv").read_text(encoding="utf-8"), f"{name}.csv")
    assert isinstance(plain, PlainSystem), [str(problem) for problem in plain]
    text = (FOLDER / f"{name}.toml").read_text(encoding="utf-8")
    given = tomllib.loads(text, parse_float=Decimal)
    figures = tuple(
        Figures(
            one["of"],
            one["source"],
            one.get("without"),
            {step: Decimal(figure) for step, figure in one["responses"].items()},
            {
                step: Difference(Decimal(why["ours"]), why["equal_without"], why["reason"])
                for step, why in one.get("differences", {}).items()
            },
        )
        for one in given["figures"]
    )
    rows = tuple(given.get("rows", figures[0].responses))
    return Published(name, given["unit"], plain.network, rows, figures)


def complaints(system: Published) -> Iterator[str]:
    """Each published figure that is neither ours nor explained, and each wrong explanation."""
    for figures in system.figures:
        ours = system.ours(figures.without)
        for step in figures.differences.keys() - figures.responses.keys():
            yield f"{figures.of}: no figure of {step}"
        for step, figure in figures.responses.items():
            difference = figures.differences.get(step)
            expected = figure if difference is None else difference.ours
            if ours.get(step) != expected:
                yield f"{figures.of}: {step} is {expected}, not {ours.get(step)}"
            if difference is None:
                continue
            if figure == difference.ours or not difference.reason:
                yield f"{figures.of}: {step} does not differ, or without reason"
            explained = system.ours(difference.equal_without).get(step)
            if explained != figure:
                yield f"{figures.of}: {step} is {explained} without {difference.equal_without}"


def table(system: Published) -> str:
    """The published figures of the rows beside ours, as a table of Markdown."""
    columns: list[tuple[str, Mapping[str, Decimal]]] = []
    for figures in system.figures:
        if set(figures.responses) != set(system.rows):
            continue
        left = "" if figures.without is None else f" without {figures.without}"
        columns.append((figures.of, figures.responses))
        columns.append((f"Ravenchart{left}", system.ours(figures.without)))
    lines = [
        " | ".join((f"response, {system.unit}", *(title for title, _ in columns))),
        " | ".join(("---",) * (1 + len(columns))),
    ]
    for step in system.rows:
        cells = (f"{responses[step]:f}" for _, responses in columns)
        lines.append(" | ".join((f"`{step}`", *cells)))
    return "".join(f"| {line} |\n" for line in lines)


def summary() -> str:
    """Of each system, how much it has and how many of its published figures are ours."""
    lines = ["file | resources | steps | published figures | equal", "--- | --- | --- | --- | ---"]
    for system in map(published, NAMES):
        network = system.network
        resources = {task.core for task in network.tasks} | set(network.buses)
        figures = sum(len(one.responses) for one in system.figures)
        equal = figures - sum(len(one.differences) for one in system.figures)
        counts = (len(resources), len(network.items()), figures, equal)
        lines.append(" | ".join((f"`{system.name}.csv`", *map(str, counts))))
    return "".join(f"| {line} |\n" for line in lines)
