# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Differences between two versions of a system, each for the better or the worse.

Both versions are objects that `analyse --json` prints. So a stored answer, a model and a plain
file can all be compared. Times are whole ns. `--json` has the exact times of a difference, and its
line has rounded ones.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from enum import Enum
from fractions import Fraction
from functools import partial
from typing import Any

from ravenchart import rounded
from ravenchart.analysis.units import exact_time
from ravenchart.rounded import Rounding

Figures = Mapping[str, Any]
"""An object of `analyse --json`."""


class Wording(Enum):
    """The word for a change."""

    WORSE = "worse"
    BETTER = "better"
    CHANGED = "changed"
    ADDED = "added"
    REMOVED = "removed"


@dataclass(frozen=True, slots=True)
class Difference:
    """One figure of an element that has changed, in words."""

    element: str
    figure: str
    before: str
    now: str
    change: str
    word: Wording
    rounded: tuple[str, str] = ("", "")
    """``before`` and ``now`` of the line."""

    @property
    def line(self) -> str:
        """The difference in one line."""
        if self.word in (Wording.ADDED, Wording.REMOVED):
            return f"{self.element}: {self.word.value}"
        by = f" ({self.change})" if self.change else ""
        before, now = self.rounded
        return f"{self.element}: {self.figure} {before} -> {now}{by}, {self.word.value}"


@dataclass(frozen=True, slots=True)
class Differences:
    """All differences from the version called ``earlier``."""

    earlier: str
    verdict: str
    rows: tuple[Difference, ...]

    def figures(self) -> dict[str, object]:
        """The same for `--json`."""
        rows = [asdict(row) | {"word": row.word.value} for row in self.rows]
        for row in rows:
            del row["rounded"]
        return {"earlier": self.earlier, "verdict": self.verdict, "changed": rows}

    def lines(self) -> Iterator[str]:
        """Everything in words, one fact a line."""
        yield f"compared with {self.earlier}: {self.verdict}"
        yield from (row.line for row in self.rows)


@dataclass(frozen=True, slots=True)
class _Figure:
    """A figure to compare: ``larger`` is the word for an increase; None is the largest time.

    ``shown`` gives the text of a value, ``both`` the rounded texts of two values.
    """

    name: str
    key: str
    larger: Wording
    shown: Callable[[Any], str]
    both: Callable[[Any, Any], tuple[str, str]]
    none: str = "none"

    def texts(self, *values: object) -> list[str]:
        """The texts of values that may be missing."""
        return [self.none if value is None else self.shown(value) for value in values]


def _of_name(name: str, key: str, shown: Callable[[Any], str] = str) -> _Figure:
    """A figure that is no quantity."""
    return _Figure(name, key, Wording.CHANGED, shown, lambda old, new: (shown(old), shown(new)))


def _needed(name: str, key: str, larger: Wording = Wording.CHANGED, none: str = "none") -> _Figure:
    """A time that work needs."""
    return _Figure(name, key, larger, exact_time, partial(rounded.changed, side=Rounding.UP), none)


def _allowed(name: str, key: str) -> _Figure:
    """A time that is allowed."""
    both = partial(rounded.changed, side=Rounding.DOWN)
    return _Figure(name, key, Wording.CHANGED, exact_time, both)


def _times(longest: str) -> tuple[_Figure, ...]:
    """The times of a task or message, whose C is the figure ``longest``."""
    return (
        _allowed("T", "period"),
        _allowed("D", "deadline"),
        _needed("C", longest),
        _needed("J", "jitter"),
        _needed("B", "blocked"),
        _needed("R", "response", Wording.WORSE, "no bound"),
    )


_PRIORITY = _of_name("priority", "priority")
_RANK = _of_name("order in arbitration", "rank", hex)
_CORE = _of_name("core", "core")
_BUS = _of_name("bus", "bus")

_ELEMENTS: tuple[tuple[str, str, Sequence[_Figure]], ...] = (
    ("tasks", "task", (_CORE, _PRIORITY, *_times("wcet"))),
    ("messages", "message", (_BUS, _RANK, *_times("cost"))),
    (
        "chains",
        "chain",
        (
            _allowed("reaction limit", "reaction_limit"),
            _needed("reaction", "reaction", Wording.WORSE, "no bound"),
            _allowed("age limit", "age_limit"),
            _needed("age", "age", Wording.WORSE, "no bound"),
        ),
    ),
)
"""The lists of the object, the name of their entries, and the figures of an entry."""

_LOAD = _Figure("load", "load", Wording.WORSE, rounded.percent, rounded.changed_shares)
_SCALING = _Figure(
    "factor of all execution times",
    "scaling",
    Wording.BETTER,
    rounded.factor,
    rounded.changed_factors,
)


def differences(earlier: str, before: Figures, now: Figures) -> Differences:
    """The differences of ``now`` from ``before``; KeyError or the like for other objects."""
    rows: list[Difference] = []
    for list_name, kind, figures in _ELEMENTS:
        rows += _of_list(kind, _by_name(before, list_name, kind), _by_name(now, list_name, kind),
                         figures)  # fmt: skip
    loads = [
        {name: {"load": Fraction(share)} for name, share in one["load"].items()}
        for one in (before, now)
    ]
    rows += _of_list("", loads[0], loads[1], (_LOAD,))
    factors = [
        {"scaling": Fraction(one["scaling"]) if one["scaling"] else None} for one in (before, now)
    ]
    rows += _of_element("system", factors[0], factors[1], (_SCALING,))
    return Differences(earlier, _verdict(rows, before["met"], now["met"]), tuple(rows))


def figures_of(answer: object) -> Figures | None:
    """The figures of an answer of `analyse --json`; None where it is none."""
    needed = {"unit", "met", "tasks", "messages", "chains", "load", "scaling"}
    if not isinstance(answer, dict) or not needed <= answer.keys():
        return None
    return answer


def _by_name(one: Figures, list_name: str, kind: str) -> dict[str, Figures]:
    return {entry[kind]: entry for entry in one[list_name]}


def _of_list(
    kind: str,
    before: Mapping[str, Figures],
    now: Mapping[str, Figures],
    figures: Sequence[_Figure],
) -> Iterator[Difference]:
    """The differences of each element, and the elements that are removed or added."""
    for name, old in before.items():
        element = f"{kind} {name}".strip() or "the core"
        if name not in now:
            yield Difference(element, "", "present", "-", "", Wording.REMOVED)
        else:
            yield from _of_element(element, old, now[name], figures)
    for name in now:
        if name not in before:
            yield Difference(
                f"{kind} {name}".strip() or "the core", "", "-", "present", "", Wording.ADDED
            )


def _of_element(
    element: str, before: Figures, now: Figures, figures: Sequence[_Figure]
) -> Iterator[Difference]:
    for figure in figures:
        old, new = before[figure.key], now[figure.key]
        if old != new:
            shown = figure.texts(old, new)
            more = figure.larger if _more(figure, old, new) else _opposite(figure.larger)
            change, both = _change(old, new), _both(figure, old, new)
            yield Difference(element, figure.name, shown[0], shown[1], change, more, both)
    if "met" in before and before["met"] != now["met"]:
        word = Wording.BETTER if now["met"] else Wording.WORSE
        words = _met(before["met"]), _met(now["met"])
        yield Difference(element, "verdict", *words, "", word, words)


def _both(figure: _Figure, old: Any, new: Any) -> tuple[str, str]:
    """The texts of two values for a line; of one value alone where the other is missing."""
    if old is not None and new is not None:
        return figure.both(old, new)
    alone = old if new is None else new
    text = figure.both(alone, alone)[0]
    return (text, figure.none) if new is None else (figure.none, text)


def _more(figure: _Figure, old: Any, new: Any) -> bool:
    """Whether the new value is larger; a missing bound is larger than any time, but no factor."""
    if old is None or new is None:
        return (new is None) == (figure.larger is not Wording.BETTER)
    return bool(new > old)


def _opposite(word: Wording) -> Wording:
    return {Wording.WORSE: Wording.BETTER, Wording.BETTER: Wording.WORSE}.get(word, word)


def _change(old: object, new: object) -> str:
    """The difference in per cent of the old value; "" where there is no number."""
    if isinstance(old, int | Fraction) and isinstance(new, int | Fraction) and old:
        return rounded.signed_percent((new - old) / Fraction(old))
    return ""


def _met(met: bool) -> str:
    return "met" if met else "not met"


def _verdict(rows: Sequence[Difference], before: bool, now: bool) -> str:
    """The outcome of all differences, in one sentence."""
    if not rows and before == now:
        return "nothing changed."
    counts = [(word, sum(row.word is word for row in rows)) for word in Wording]
    listed = ", ".join(f"{count} {word.value}" for word, count in counts if count)
    kept = "every deadline and limit is"
    if before != now:
        outcome = f"{kept} met now" if now else "a deadline or limit is no longer met"
    else:
        outcome = f"{kept} still met" if now else "a deadline or limit is still not met"
    return f"{outcome}; {listed or 'no figure differs'}."
