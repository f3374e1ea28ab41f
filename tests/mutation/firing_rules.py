# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Breaks of what a region does: target, order, actions, history, deferral, time, completion."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from ravenchart.gen.emit.ada.declarations import Aspect, Object, Unit
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    TRUE,
    Aggregate,
    Arg,
    Call,
    CaseExpr,
    Expr,
    IfExpr,
    IntegerLiteral,
    OperatorChain,
    Prefix,
    number,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.statements import (
    NULL,
    Assign,
    Case,
    Comment,
    Do,
    IfStatement,
    NullStatement,
    Pragma,
    Stmt,
)

from .mutants import Broken, Units
from .nodes import (
    Body,
    Put,
    Spot,
    bodies,
    body_of,
    each_following,
    exchanged,
    following,
    is_within,
    lists_in,
    moved_behind,
    names_of,
    put,
    statements,
    whole,
)

NOTE = ref("Ravenchart.Steps.Note")
"""Only programs for simulation say what they execute; no rule changes that."""
TIMERS = ref("Ravenchart.Timers")
DEFERRALS = ref("Deferrals")
SELF = ref("Self")
_MOVES = ("Exit_", "Leave_", "Enter_")
_Row = Spot[tuple[Stmt, ...]]


def _idle_names(unit: Unit) -> set[DottedName]:
    """What is there for proof or simulation alone: objects, and the procedures that do no more."""
    every = whole(unit).within(Object)
    found = {ref(one.node.name) for one in every if Aspect("Ghost") in one.node.aspects} | {NOTE}
    for one in bodies(unit):
        if one.name.startswith("Leave_") and all(_is_idle(s, found) for s in one.inner.node):
            found.add(ref(one.name))
    return found


def _rows(unit: Unit) -> Iterator[tuple[str, list[Spot[Stmt]]]]:
    """The lists of statements in which a firing moves, with the name of what holds them."""
    idle = _idle_names(unit)
    for one in bodies(unit):
        if one.is_expression:
            continue
        if one.fires or one.name.startswith("Leave_"):
            for inner in lists_in(one.inner):
                yield one.name, _working(inner, idle)
        elif one.name.startswith(("Enter_", "Exit_")):
            yield one.name, _working(one.inner, idle)


def _working(inner: _Row, idle: set[DottedName]) -> list[Spot[Stmt]]:
    """The statements that run and are not there for simulation."""
    return [one for one in statements(inner) if not _is_idle(one.node, idle)]


def _is_idle(statement: Stmt, idle: set[DottedName]) -> bool:
    """Does it do nothing but what is there for proof or simulation?"""
    match statement:
        case NullStatement() | Pragma() | Comment():
            return True
        case Do(name):
            return name in idle
        case Assign(DottedName() as target):
            return any(is_within(target, one) for one in idle)
        case Case(_, branches):
            return all(_is_idle(one, idle) for _, body in branches for one in body)
        case IfStatement(branches, otherwise):
            inner = (*(one for _, body in branches for one in body), *otherwise)
            return all(_is_idle(one, idle) for one in inner)
    return False


def _moved(statement: Stmt) -> str | None:
    """The procedure by which a statement exits or enters something."""
    match statement:
        case Do(DottedName((name,)), ()) if name.startswith(_MOVES):
            return name
    return None


def _assigned(statement: Stmt) -> DottedName | None:
    match statement:
        case Assign(DottedName() as target):
            return target
    return None


def _uses(node: object, name: DottedName | None) -> bool:
    return name is not None and any(is_within(one, name) for one in names_of(node))


# --- target


def target_in_code(file: str, units: Units) -> Iterator[Broken]:
    """Another state that is entered last, or a configuration that stays as it was."""
    unit = units[file]
    entries = [one.name for one in bodies(unit) if one.name.startswith("Enter_")]
    firing = {one.name for one in bodies(unit) if one.fires}
    for place, row in _rows(unit):
        last = _moved(row[-1].node) if row else None
        other = following(last, entries) if last in entries and place in firing else None
        if other is not None:
            yield place, "enter", put(row[-1], Do(other))
    for place, set_ in _set_by_fire(unit, "Leaf", "Configuration"):
        yield place, "stay", put(set_, NULL)


def _set_by_fire(unit: Unit, *parts: str) -> Iterator[tuple[str, Spot[Assign]]]:
    """Where Fire gives parts of the region's own state their new value, with its name."""
    fire = body_of(unit, "Fire")
    targets = {ref(SELF, part) for part in parts}
    for set_ in fire.inner.within(Assign) if fire is not None else ():
        if set_.node.target in targets:
            yield "Fire", set_


def target_declared(file: str, units: Units) -> Iterator[Broken]:
    """Another leaf in the declared target of a transition."""
    one = body_of(units[file], "Target")
    if one is None:
        return
    found: list[tuple[object, Spot[DottedName]]] = []
    for case in one.inner.within(CaseExpr):
        for place, (_, value) in enumerate(case.node.branches):
            row = case.at("branches", place, 1)
            if isinstance(value, Aggregate):
                found += [(arg.node.name, arg.at("value")) for arg in row.within(Arg)]
            else:
                found.append((None, row))
    leaves = [(key, spot) for key, spot in found if _is_literal(spot.node)]
    for _, puts in each_following(leaves):
        yield "Target", "target", puts


def _is_literal(value: object) -> bool:
    """Is it the name of a leaf? That stands in the package of its region's states."""
    return isinstance(value, DottedName) and len(value.parts) == 2 and value.first != "Past"


# --- order


def order(file: str, units: Units) -> Iterator[Broken]:
    """Two neighbours of a firing in the other order: exits, effects, entries, or two effects of
    which one reads what the other sets; what is declared of the configuration before it is set;
    two regions whose transitions are taken in the other order."""
    unit = units[file]
    entered = {one.name: one.inner.node for one in bodies(unit)}
    for place, row in _rows(unit):
        for first, second in pairwise(row):
            called = _moved(second.node) or ""
            if called.startswith("Enter_") and _uses(entered[called], _assigned(first.node)):
                yield place, "late", moved_behind(first, second)
            elif _ordered(first.node, second.node):
                yield place, "exchange", exchanged(first, second)
    fire = body_of(unit, "Fire")
    for first, second in pairwise(statements(fire.inner) if fire is not None else ()):
        if isinstance(second.node, Assign) and _uses(second.node.value, _assigned(first.node)):
            yield "Fire", "late", exchanged(first, second)
    step = body_of(unit, "Step")
    every = [] if step is None else step.inner.within(IfStatement)
    for one, other in pairwise(s for s in every if _of_region(s.node)):
        yield "Step", "regions", exchanged(one, other)


def _of_region(statement: IfStatement) -> bool:
    """Whether it takes the transition that is selected for a region."""
    condition = statement.branches[0][0]
    if isinstance(condition, OperatorChain) and condition.operator == "and then":
        condition = condition.operands[0]
    match condition:
        case OperatorChain("/=", (DottedName(("C", _)), _)):
            return True
    return False


def _ordered(first: Stmt, second: Stmt) -> bool:
    """Whether somebody orders two statements."""
    pair = first, second
    if any(map(_moved, pair)):
        return first != second
    if any(map(_completes, pair)):
        return False
    if any(isinstance(one, IfStatement | Case) for one in pair):
        return False
    return _uses(second, _assigned(first)) or _uses(first, _assigned(second))


# --- actions


def missing(file: str, units: Units) -> Iterator[Broken]:
    """An exit, entry, or action of a state or effect that is left out."""
    for place, row in _rows(units[file]):
        for statement in row:
            node = statement.node
            if _moved(node):
                yield place, "no move", put(statement, NULL)
            elif not _completes(node) and not _is_move(statement):
                yield place, "no action", put(statement, NULL)


def _is_move(statement: Spot[Stmt]) -> bool:
    """A case or if that itself moves, such as what restores a history."""
    if not isinstance(statement.node, Case | IfStatement):
        return False
    if any(_moved(one.node) for one in statement.within(Do)):
        return True
    return any(map(_is_completion, names_of(statement.node)))


def _completes(statement: Stmt) -> bool:
    """Does it say that a state has completed, or that this is over?"""
    target = _assigned(statement)
    return target is not None and _is_completion(target)


def _is_completion(name: DottedName) -> bool:
    match name.parts:
        case ("Self", flag):
            return flag.startswith("Completed_")
    return False


# --- history


def history_in_code(file: str, units: Units) -> Iterator[Broken]:
    """What is left is not remembered; something else is restored."""
    unit = units[file]
    for place, set_ in _set_by_fire(unit, "Past"):
        yield place, "forget", put(set_, NULL)
    for fire in (one for one in bodies(unit) if one.fires):
        yield from _restored(fire)


def _restored(fire: Body) -> Iterator[Broken]:
    for asks in fire.inner.within(IfStatement):
        condition: Expr = asks.node.branches[0][0]
        if isinstance(condition, DottedName) and condition.first == "Past":
            yield fire.name, "known", put(asks.at("branches", 0, 0), Prefix("not", condition))
    for case in fire.inner.within(Case):
        selector = case.node.selector
        if isinstance(selector, DottedName) and selector.first == "Past":
            rows = [case.at("branches", place, 1) for place in range(len(case.node.branches))]
            for row, after in pairwise(rows):
                yield fire.name, "restore", exchanged(row, after)


def history_declared(file: str, units: Units) -> Iterator[Broken]:
    """Another leaf that a history is declared to restore, or nothing that is remembered."""
    for one in bodies(units[file]):
        if one.is_expression and one.name == "Remembered":
            for asks in one.inner.within(IfExpr):
                yield one.name, "forget", put(asks, asks.node.otherwise)
        if one.is_expression and one.name.startswith(("Deep_", "Shallow_")):
            values = [
                value
                for case in one.inner.within(CaseExpr)
                for value in (case.at("branches", n, 1) for n in range(len(case.node.branches)))
            ]
            values += [asks.at("otherwise") for asks in one.inner.within(IfExpr)]
            for _, puts in each_following([(0, v) for v in values if _is_literal(v.node)]):
                yield one.name, "restore", puts


# --- deferral, time, completion


def _calls(body: Body, name: DottedName) -> Iterator[Spot[Do]]:
    return (one for one in body.inner.within(Do) if one.node.name == name)


def deferral(file: str, units: Units) -> Iterator[Broken]:
    """A deferred event that is not kept, or never taken."""
    for name, procedure, rule, instead in (
        ("Fire", "Change", "lose", NULL),
        ("Poll", "Take_Due", "never", Assign("Released", FALSE)),
    ):
        one = body_of(units[file], name)
        for call in _calls(one, ref(DEFERRALS, procedure)) if one is not None else ():
            yield name, rule, put(call, instead)


def deferral_declared(file: str, units: Units) -> Iterator[Broken]:
    """An event that is not declared as deferred, or as freed by the exit of a state."""
    for name, rule in (("Is_Deferred", "take"), ("Is_Freed", "keep")):
        one = body_of(units[file], name)
        for case in one.inner.within(CaseExpr) if one is not None else ():
            for place, (_, value) in enumerate(case.node.branches):
                if value != FALSE:
                    yield name, rule, put(case.at("branches", place, 1), FALSE)


def _longer(count: Spot[Expr]) -> tuple[Put, ...]:
    assert isinstance(count.node, IntegerLiteral)
    return put(count, IntegerLiteral(count.node.value + 1))


def timeout(file: str, units: Units) -> Iterator[Broken]:
    """Time-outs that neither start nor stop; one that is not taken, or taken for another."""
    for place, set_ in _set_by_fire(units[file], "Timers"):
        yield place, "move", put(set_, NULL)
    poll = body_of(units[file], "Poll")
    if poll is None:
        return
    for call in _calls(poll, ref(TIMERS, "Take_Due")):
        yield "Poll", "due", put(call, Assign("Due", number(0)))
    rows = [one.at("value") for one in poll.inner.within(Assign) if _is_expiry(one.node.value)]
    for first, second in pairwise(rows):
        yield "Poll", "expiry", exchanged(first, second)


def _is_expiry(value: Expr) -> bool:
    return isinstance(value, DottedName) and value.last.startswith("Expiry_Of_")


def timeout_declared(file: str, units: Units) -> Iterator[Broken]:
    """A time-out that is declared longer, or as one that does not start or stop."""
    one = body_of(units[file], "Timers_After")
    for call in one.inner.within(Call) if one is not None else ():
        if call.node.name == ref(TIMERS, "Started"):
            yield "Timers_After", "later", _longer(call.at("args", 0, "value"))
        elif call.node.name == ref(TIMERS, "Moved"):
            yield "Timers_After", "stop", put(call.at("args", 2, "value"), FALSE)
            yield "Timers_After", "start", put(call.at("args", 3, "value"), FALSE)


def domain_declared(file: str, units: Units) -> Iterator[Broken]:
    """Another region as the domain of a transition."""
    one = body_of(units[file], "Domain_Of")
    for case in one.inner.within(CaseExpr) if one is not None else ():
        rows = [(0, case.at("branches", n, 1)) for n in range(len(case.node.branches))]
        for _, puts in each_following(rows):
            yield "Domain_Of", "domain", puts


def completion(file: str, units: Units) -> Iterator[Broken]:
    """A completion that is not noticed, comes again, or outlives its state."""
    for one in bodies(units[file]):
        if one.is_expression or not one.name.startswith(("Enter_", "Exit_", "Poll")):
            continue
        for set_ in one.inner.within(Assign):
            if isinstance(set_.node.target, DottedName) and _is_completion(set_.node.target):
                yield one.name, "forget", put(set_, NULL)
        for asks in one.inner.within(IfStatement):
            condition = asks.at("branches", 0, 0)
            if _compares_own(condition.node):
                yield one.name, "others", put(condition, TRUE)


def _compares_own(condition: Expr) -> bool:
    """Does it begin with a comparison of the region's own state?"""
    match condition:
        case OperatorChain("and then" | "or else", (first, *_)):
            return _compares_own(first)
        case OperatorChain("=", (DottedName() as name, _)):
            return is_within(name, SELF)
    return False
