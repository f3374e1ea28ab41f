# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Breaks of what a region does: target, order, actions, history, deferral, time, completion."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise

from .mutants import NOTE, Edit, Files, Found, replaced, swapped
from .source import Span, Subprogram, arms, choices, statements, subprogram, subprograms

_MOVE = re.compile(r"^(Exit|Leave|Enter)_\w+;$")
_GHOST = re.compile(r"^(pragma |Active(_\w+)? :=)")
_HELD = re.compile(r"^Self\.(Place(\.\w+)?|Leaf) :=")
_KEPT = re.compile(r"^Self\.(Past|Completed_|Timers)|^Ravenchart\.Timers\.")


def _rows(text: str) -> Iterator[tuple[str, list[Span]]]:
    """The lists of statements in which a firing moves, with the name of what holds them."""
    for one in subprograms(text):
        if one.is_expression:
            continue
        if one.fires or one.name.startswith("Leave_"):
            yield from _nested(text, one.name, one.inner)
        elif one.name.startswith(("Enter_", "Exit_")):
            yield one.name, _working(text, one.inner)


def _nested(text: str, name: str, inner: Span) -> Iterator[tuple[str, list[Span]]]:
    for statement in statements(text, inner):
        if statement.of(text).startswith("case "):
            for arm in arms(text, statement):
                yield name, _working(text, arm.body)
                yield from _nested(text, name, arm.body)
        elif statement.of(text).startswith("if "):
            yield from _nested_if(text, name, statement)


def _nested_if(text: str, name: str, statement: Span) -> Iterator[tuple[str, list[Span]]]:
    start = text.rfind("\n", 0, statement.start) + 1
    indent = " " * (statement.start - start)
    mark = re.compile(rf"^{indent}(?:(?:\S.*)?\bthen|else|end if;)$", re.M)
    cuts = list(mark.finditer(text, start, statement.end))
    for opening, closing in pairwise(cuts):
        inner = Span(opening.end() + 1, closing.start())
        yield name, _working(text, inner)
        yield from _nested(text, name, inner)


def _working(text: str, inner: Span) -> list[Span]:
    """The statements that run and are not there for simulation."""
    return [
        s
        for s in statements(text, inner)
        if not s.of(text).startswith((NOTE, "null;")) and not _GHOST.match(s.of(text))
    ]


def _named(text: str, prefix: str) -> list[str]:
    return [s.name for s in subprograms(text) if s.name.startswith(prefix)]


# --- target


def target_in_code(file: str, files: Files) -> Iterator[Found]:
    """Another state that is entered last, or another leaf that an entry sets."""
    text = files[file]
    entries = _named(text, "Enter_")
    firing = {one.name for one in subprograms(text) if one.fires}
    for place, row in _rows(text):
        last = row[-1].of(text) if row else ""
        if place in firing and last.startswith("Enter_"):
            name = last.removesuffix(";")
            following = entries[(entries.index(name) + 1) % len(entries)]
            if following != name:
                yield place, "enter", replaced(row[-1], f"{following};")
    found = [
        (one.name, match)
        for one in subprograms(text)
        if one.fires or one.name.startswith("Enter_")
        for match in re.compile(r"Self\.(Leaf|Place(?:\.\w+)?) := ([\w.]+);").finditer(
            text, one.inner.start, one.inner.end
        )
    ]
    for place, match in found:
        same = [m.group(2) for _, m in found if m.group(1) == match.group(1)]
        if other := _next(match.group(2), same):
            yield place, "leaf", replaced(Span(*match.span(2)), other)


def _next(here: str, names: list[str]) -> str | None:
    ordered = list(dict.fromkeys(names))
    if len(ordered) < 2:
        return None
    return ordered[(ordered.index(here) + 1) % len(ordered)]


def target_declared(file: str, files: Files) -> Iterator[Found]:
    """Another leaf in the declared target of a transition."""
    text = files[file]
    one = subprogram(text, "Target")
    if one is None:
        return
    pattern = re.compile(r"(\w+) => (\w+_States\.\w+)")
    found = list(pattern.finditer(text, one.inner.start, one.inner.end))
    alone = {r.body.start for r in choices(text, one.inner)}
    for match in found:
        kind = "" if match.start(2) in alone else match.group(1)
        same = [m.group(2) for m in found if ("" if m.start(2) in alone else m.group(1)) == kind]
        if other := _next(match.group(2), same):
            yield "Target", "target", replaced(Span(*match.span(2)), other)


# --- order


def order(file: str, files: Files) -> Iterator[Found]:
    """Two neighbours of a firing in the other order: exits, effects, entries, or two effects of
    which one reads what the other sets; two lanes that fire in the other order."""
    text = files[file]
    for place, row in _rows(text):
        for first, second in pairwise(row):
            if _ordered(first.of(text), second.of(text)):
                yield place, "exchange", swapped(text, first, second)
            if _is_read(text, first.of(text), second.of(text)):
                behind = Edit(Span(second.end, second.end), f"\n{first.of(text)}")
                yield place, "late", (*replaced(first, "null;"), behind)
    step = subprogram(text, "Step")
    if step is None or step.is_expression:
        return
    lanes = list(
        re.compile(r"^( *)if C\.(\w+) /= None\b.*?^\1end if;", re.M | re.S).finditer(
            text, step.inner.start, step.inner.end
        )
    )
    for one, other in pairwise(lanes):
        yield "Step", "lanes", swapped(text, Span(*one.span()), Span(*other.span()))


def _ordered(first: str, second: str) -> bool:
    """Whether somebody orders two statements; that the region has started is part of no order."""
    moves = bool(_MOVE.match(first)), bool(_MOVE.match(second))
    if any(s.startswith("Self.Started :=") for s in (first, second)):
        return False
    if any(moves):
        return first != second
    if any(_HELD.match(s) or _KEPT.match(s) for s in (first, second)):
        return False
    if any(s.startswith(("if ", "case ")) for s in (first, second)):
        return False
    return _uses(second, _assigned(first)) or _uses(first, _assigned(second))


def _is_read(text: str, effect: str, entry: str) -> bool:
    """Does an entry use what the effect before it sets? Then it must not come behind."""
    called = subprogram(text, entry.removesuffix(";")) if entry.startswith("Enter_") else None
    return called is not None and _uses(called.inner.of(text), _assigned(effect))


def _uses(statement: str, name: str | None) -> bool:
    return name is not None and bool(re.search(rf"\b{re.escape(name)}\b", statement))


def _assigned(statement: str) -> str | None:
    match = re.match(r"([\w.]+) :=", statement)
    return match.group(1) if match else None


# --- actions


def missing(file: str, files: Files) -> Iterator[Found]:
    """An exit, entry, or action of a state or effect that is left out."""
    text = files[file]
    for place, row in _rows(text):
        for statement in row:
            word = statement.of(text)
            if _MOVE.match(word):
                yield place, "no move", replaced(statement, "null;")
            elif not _HELD.match(word) and not _KEPT.match(word) and not _is_move(word):
                yield place, "no action", replaced(statement, "null;")


def _is_move(word: str) -> bool:
    """A case or if that itself moves, such as what restores a history."""
    return (
        word.startswith(("case ", "if "))
        and re.search(r"\b(Exit|Enter|Leave)_\w+;|\bDeferrals\.|Self\.Completed_", word) is not None
    )


# --- history


def history_in_code(file: str, files: Files) -> Iterator[Found]:
    """A leaf that is not remembered, or another one; something else restored."""
    text = files[file]
    pattern = re.compile(r"Self\.Past\.(\w+) := ([\w.]+);")
    found = [
        (one.name, match)
        for one in subprograms(text)
        if one.name.startswith("Exit_")
        for match in pattern.finditer(text, one.inner.start, one.inner.end)
    ]
    for place, match in found:
        same = [m.group(2) for _, m in found if m.group(1) == match.group(1)]
        same += ["True", "False"] if match.group(2) in ("True", "False") else []
        if other := _next(match.group(2), same):
            yield place, "remember", replaced(Span(*match.span(2)), other)
        yield place, "forget", replaced(Span(*match.span()), "null;")
    for fire in (one for one in subprograms(text) if one.fires):
        known = re.compile(r"\bif (Past\.Known_\w+) then")
        for match in known.finditer(text, fire.inner.start, fire.inner.end):
            yield fire.name, "known", replaced(Span(*match.span(1)), f"not {match.group(1)}")
        cases = re.compile(r"\bcase Past\.\w+ is")
        for case in cases.finditer(text, fire.inner.start, fire.inner.end):
            for row, after in pairwise(arms(text, Span(case.start(), fire.inner.end))):
                if row.body.of(text) != after.body.of(text):
                    yield fire.name, "restore", swapped(text, row.body, after.body)


def history_declared(file: str, files: Files) -> Iterator[Found]:
    """Another leaf that a history is declared to restore."""
    text = files[file]
    pattern = re.compile(r"(?:=>|else)\s+(\w+_States\.\w+)")
    for one in subprograms(text):
        if one.name.startswith(("Deep_", "Shallow_")):
            found = list(pattern.finditer(text, one.inner.start, one.inner.end))
            for match in found:
                if other := _next(match.group(1), [m.group(1) for m in found]):
                    yield one.name, "restore", replaced(Span(*match.span(1)), other)


# --- deferral, time, completion


def deferral(file: str, files: Files) -> Iterator[Found]:
    """A deferred event that is taken too early, twice, never, or not kept."""
    text = files[file]
    for one in subprograms(text):
        if one.fires or one.name == "Poll":
            yield from _edits(text, one, "early", r"\bif (not )Is_Deferred\b", "")
            yield from _edits(text, one, "twice", r"(Deferrals\.Remove [^;]*;)", "null;")
            element = r"Deferrals\.Element \(Self\.Deferred, (I)\)"
            yield from _edits(text, one, "first", element, "1")
            yield from _edits(text, one, "lose", r"(Deferrals\.Append [^;]*;)", "null;")
            yield from _edits(text, one, "full", r"Count \(Self\.Deferred\)( = )", " /= ")


def deferral_declared(file: str, files: Files) -> Iterator[Found]:
    """An event that is not declared as deferred; less room for deferred ones."""
    text = files[file]
    one = subprogram(text, "Is_Deferred")
    if one is not None:
        for row in choices(text, one.inner):
            if row.body.of(text) != "False":
                yield one.name, "take", replaced(row.body, "False")


def timeout(file: str, files: Files) -> Iterator[Found]:
    """A time-out that is longer, not started, not stopped, or taken for another."""
    text = files[file]
    for one in subprograms(text):
        if one.name.startswith(("Enter_", "Exit_")) and not one.is_expression:
            pattern = re.compile(r"Timers\.Arm \(Self\.Timers \(\d+\), ([\d_]+)")
            for match in pattern.finditer(text, one.inner.start, one.inner.end):
                longer = str(int(match.group(1).replace("_", "")) + 1)
                yield one.name, "later", replaced(Span(*match.span(1)), longer)
            yield from _edits(text, one, "start", r"(Ravenchart\.Timers\.Arm [^;]*;)", "null;")
            yield from _edits(text, one, "stop", r"(Ravenchart\.Timers\.Disarm [^;]*;)", "null;")
    poll = subprogram(text, "Poll")
    if poll is None:
        return
    yield from _edits(text, poll, "due", r"(Ravenchart\.Timers\.Take_Due [^;]*;)", "Due := 0;")
    rows = list(
        re.compile(r"Now := (Expiry_Of_\w+);").finditer(text, poll.inner.start, poll.inner.end)
    )
    for first, second in pairwise(rows):
        yield "Poll", "expiry", swapped(text, Span(*first.span(1)), Span(*second.span(1)))


def timeout_declared(file: str, files: Files) -> Iterator[Found]:
    """A time-out that is declared longer."""
    text = files[file]
    one = subprogram(text, "Timer_After")
    if one is None:
        return
    pattern = re.compile(r"Timers\.Started \(([\d_]+)")
    for match in pattern.finditer(text, one.inner.start, one.inner.end):
        longer = str(int(match.group(1).replace("_", "")) + 1)
        yield one.name, "later", replaced(Span(*match.span(1)), longer)


def domain_declared(file: str, files: Files) -> Iterator[Found]:
    """Another region as the domain of a transition."""
    text = files[file]
    one = subprogram(text, "Domain_Of")
    if one is None:
        return
    rows = choices(text, one.inner)
    names = [row.body.of(text) for row in rows]
    for row, name in zip(rows, names, strict=True):
        if other := _next(name, names):
            yield one.name, "domain", replaced(row.body, other)


def completion(file: str, files: Files) -> Iterator[Found]:
    """A completion that is not noticed, comes again, or outlives its state."""
    text = files[file]
    for one in subprograms(text):
        if one.is_expression or not one.name.startswith(("Enter_", "Exit_", "Poll")):
            continue
        noticed = r"(Self\.Completed_\w+ := (?:True|False);)"
        yield from _edits(text, one, "forget", noticed, "null;")
        others = r"\bif (Self\.\w+(?:\.\w+)? = [^;]*?)\s+then"
        yield from _edits(text, one, "others", others, "True")


def _edits(
    text: str, one: Subprogram, rule: str, pattern: str, new: str
) -> Iterator[tuple[str, str, tuple[Edit, ...]]]:
    for match in re.compile(pattern).finditer(text, one.inner.start, one.inner.end):
        yield one.name, rule, replaced(Span(*match.span(1)), new)
