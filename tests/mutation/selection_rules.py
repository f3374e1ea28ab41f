# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Breaks of what a region selects: source, trigger, guard, precedence; as code and as declared."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise

from .mutants import Edit, Files, Found, replaced, swapped
from .source import (
    Branch,
    Span,
    Subprogram,
    branches,
    choices,
    conjuncts,
    declared_rows,
    subprogram,
    subprograms,
)

_PLACED = re.compile(r"^(?:Place|Leaf)\b")
_TRIGGER = re.compile(r"^Now\b")
_COMPARISONS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "=": "/=", "/=": "="}


def selectors(text: str) -> Iterator[tuple[Subprogram, list[Branch]]]:
    """The selection functions of states with their branches; of leaves, where they have one."""
    for one in subprograms(text):
        if one.is_expression and one.name.startswith(("In_", "Around_")):
            found = branches(text, one.inner)
            if found and re.match(r"Now\b", found[0].head.of(text)):
                yield one, found


def _other(text: str, found: re.Match[str], candidates: list[str]) -> str | None:
    """The candidate after the one that stands there, in a circle."""
    here = found.group(0)
    ordered = list(dict.fromkeys(candidates))
    if here not in ordered or len(ordered) < 2:
        return None
    return ordered[(ordered.index(here) + 1) % len(ordered)]


# --- source


def source_in_code(file: str, files: Files) -> Iterator[Found]:
    """A transition that its leaf forgets, and leaves whose functions are exchanged."""
    text = files[file]
    for one, found in selectors(text):
        for index, branch in enumerate(found[:-1]):
            if len(found) == 2:
                yield one.name, "forget", replaced(one.inner, "None")
            elif index == 0:
                span = Span(branch.head.start, found[1].head.start)
                yield one.name, "forget", replaced(span, "")
            else:
                span = Span(found[index - 1].body.end, branch.body.end)
                yield one.name, "forget", replaced(span, "")
    for one in subprograms(text):
        if not one.is_expression or not one.name.startswith(("In_", "Select_")):
            continue
        case = re.compile(r"\(?case ").search(text, one.inner.start, one.inner.end)
        rows = _dispatch(text, one) if case else []
        for first, second in pairwise(rows):
            yield one.name, "exchange", swapped(text, first.body, second.body)


def _dispatch(text: str, one: Subprogram) -> list[Branch]:
    whole = one.inner
    nested = branches(text, whole)
    if nested:
        whole = nested[0].body
    inside = whole.of(text)
    if inside.startswith("("):
        whole = Span(whole.start + 1, whole.end - 1)
    return choices(text, whole)


def source_declared(file: str, files: Files) -> Iterator[Found]:
    """Another state as the source of a declared transition; none that is asked for."""
    yield from _declared(file, files, "In_Source", "source", _PLACED)
    text = files[file]
    one = subprogram(text, "Enabled")
    asked = one and re.compile(r"\bIn_Source \([^()]*\)").search(text, one.inner.start)
    if one is not None and asked and asked.end() < one.inner.end:
        yield "Enabled", "source", replaced(Span(*asked.span()), "True")


def _declared(
    file: str, files: Files, function: str, rule: str, part: re.Pattern[str]
) -> Iterator[Found]:
    text = files[file]
    parts = [
        span
        for row in declared_rows(text, function)
        for span in conjuncts(text, row.body)
        if part.match(span.of(text))
    ]
    literal = re.compile(r"(?<=[=|] )[\w.]+$" if part is _TRIGGER else r"\w+\.\w+$")
    stems: dict[str, list[str]] = {}
    for span in parts:
        match = literal.search(span.of(text))
        if match:
            stems.setdefault(span.of(text)[: match.start()], []).append(match.group(0))
    for span in parts:
        match = literal.search(span.of(text))
        if match is None:
            continue
        stem = span.of(text)[: match.start()]
        new = _other(text, match, stems[stem])
        if new is not None:
            at = Span(span.start + match.start(), span.start + match.end())
            yield function, rule, replaced(at, new)


# --- trigger and guard


def trigger_in_code(file: str, files: Files) -> Iterator[Found]:
    """Another occurrence in the condition of a selected transition."""
    text = files[file]
    found = [(one.name, row.head) for one, rows in selectors(text) for row in rows[:-1]]
    names = re.findall(r"\bNow = (\w+)", "\n".join(h.of(text) for _, h in found))
    for name, head in found:
        match = re.match(r"Now = (\w+)", head.of(text))
        if match is None:
            continue
        new = _after(match.group(1), names)
        if new is not None:
            at = Span(head.start + match.start(1), head.start + match.end(1))
            yield name, "trigger", replaced(at, new)


def _after(here: str, names: list[str]) -> str | None:
    ordered = list(dict.fromkeys(names))
    if len(ordered) < 2:
        return None
    return ordered[(ordered.index(here) + 1) % len(ordered)]


def trigger_declared(file: str, files: Files) -> Iterator[Found]:
    """Another occurrence as the trigger of a declared transition."""
    yield from _declared(file, files, "Enabled", "trigger", _TRIGGER)


def guard_in_code(file: str, files: Files) -> Iterator[Found]:
    """A guard that is dropped, denied or shifted by one comparison, in a leaf's function."""
    text = files[file]
    for one, rows in selectors(text):
        for row in rows[:-1]:
            parts = conjuncts(text, row.head)
            for before, part in pairwise(parts):
                for rule, edits in _guards(text, before, part):
                    yield one.name, rule, edits


def guard_declared(file: str, files: Files) -> Iterator[Found]:
    """A guard that is dropped, denied or shifted by one comparison."""
    text = files[file]
    for row in declared_rows(text, "Enabled"):
        parts = conjuncts(text, row.body)
        for before, part in pairwise(parts):
            for rule, edits in _guards(text, before, part):
                yield "Enabled", rule, edits


def _guards(text: str, before: Span, part: Span) -> Iterator[tuple[str, tuple[Edit, ...]]]:
    yield "drop guard", replaced(Span(before.end, part.end), "")
    yield "deny guard", replaced(part, f"not ({part.of(text)})")
    for match in re.finditer(r"(?<= )(<=|>=|/=|<|>|=)(?= )", part.of(text)):
        at = Span(part.start + match.start(), part.start + match.end())
        yield "shift guard", replaced(at, _COMPARISONS[match.group(0)])


# --- precedence


def priority_in_code(file: str, files: Files) -> Iterator[Found]:
    """Two transitions of one trigger that are looked at in the other order; an outer lane that
    selects although an inner one does."""
    text = files[file]
    for one, rows in selectors(text):
        for first, second in _same_trigger(text, rows):
            edits = (
                *swapped(text, first.head, second.head),
                *swapped(text, first.body, second.body),
            )
            yield one.name, "precede", edits
    choose = subprogram(text, "Choose")
    if choose is not None:
        for match in re.compile(r"\bif (C\.[^;]*?)\s+then\b").finditer(
            text, choose.inner.start, choose.inner.end
        ):
            yield "Choose", "outer lane", replaced(Span(*match.span(1)), "True")


def _same_trigger(text: str, rows: list[Branch]) -> Iterator[tuple[Branch, Branch]]:
    for first, second in pairwise(rows[:-1]):
        heads = [conjuncts(text, r.head)[0].of(text) for r in (first, second)]
        if heads[0] == heads[1]:
            yield first, second


def priority_declared(file: str, files: Files) -> Iterator[Found]:
    """Two transitions of one trigger that are declared in the other order."""
    text = files[file]
    body = files.get(file.removesuffix("s") + "b", "")
    listed = re.search(r"type Selection is\s*\(([^)]*)\)", text)
    if listed is None:
        return
    at = {m.group(0): m for m in re.compile(r"\w+").finditer(text, *listed.span(1))}
    bounds = set(re.findall(r"range (\w+) \.\. (\w+)", text))
    kept = {name for pair in bounds for name in pair}
    done = set()
    for _, rows in selectors(body):
        for first, second in _same_trigger(body, rows):
            one, other = first.body.of(body), second.body.of(body)
            if (one, other) in done or {one, other} & kept:
                continue
            done.add((one, other))
            spans = [Span(*at[name].span()) for name in (one, other)]
            yield "Selection", "precede", swapped(text, *spans)
