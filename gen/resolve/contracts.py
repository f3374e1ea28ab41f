# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Contracts of activities: `requires` and `ensures`, over their inputs and results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from ravenchart.gen.files.located import TextPlace
from ravenchart.gen.files.schema import ActivityForm
from ravenchart.gen.language.expressions import Term
from ravenchart.gen.language.names import Findings, NameScope
from ravenchart.gen.language.terms import (
    BOOLEAN,
    EnumerationType,
    IntegerType,
    Name,
    PortTest,
    Reading,
    Type,
)
from ravenchart.gen.model.component import Clause

from .flows import Targets
from .typed import OLD, PORT_TESTS, SENT, Checker, condition
from .vocabulary import CheckedExpression, Vocabulary

Lists = Mapping[str, tuple[str, ...]]
"""The names that an activity reads, writes, sends on, calls and raises, by key."""


def sent(lists: Lists) -> tuple[str, ...]:
    """The ports that an activity sends on and the commands that it calls, in some executions."""
    return (*lists["sends"], *lists["may_send"], *lists["calls"])


@dataclass(frozen=True, slots=True)
class Side:
    """One side of an activity's contract: the names that it may use."""

    activity: str = ""
    is_flow: bool = False
    before: frozenset[str] = frozenset()
    """Names that have a value when an execution begins."""
    written: frozenset[str] = frozenset()
    sent: frozenset[str] = frozenset()
    every_time: frozenset[str] = frozenset()
    """Those of ``sent`` for which a user's body has no flag."""
    at_end: bool = False
    """It holds when an execution ends."""


@dataclass(slots=True)
class ContractChecker(Checker):
    """Checks a condition of a contract: names must be those of the activity."""

    side: Side = field(default_factory=Side)
    in_old: bool = False
    in_sent: bool = False

    def name(self, term: Term, expected: EnumerationType | None) -> CheckedExpression | None:
        """A name, if the activity reads, writes or sends what it denotes."""
        checked = Checker.name(self, term, expected)
        if checked is None or not isinstance(checked.expression, Name):
            return checked
        found = checked.expression
        if found.kind is Reading.OUTPUT:
            return checked if self.may_send(term, found.name) else None
        return checked if self.may_read(term, found.name) else None

    def inside(self, term: Term) -> CheckedExpression | None:
        """``in(Region.State)``, if the activity reads the region."""
        checked = Checker.inside(self, term)
        region = self.vocabulary.regions.items.get(term.word.lower())
        if checked is None or region is None:
            return checked
        return checked if self.may_read(term, region[0]) else None

    def call(self, term: Term) -> CheckedExpression | None:
        """A function; a test of a port only if the activity reads the port."""
        checked = Checker.call(self, term)
        if checked is not None and term.word.lower() in PORT_TESTS:
            assert isinstance(checked.expression, PortTest)
            return checked if self.may_read(term, checked.expression.port) else None
        return checked

    def old(self, term: Term) -> CheckedExpression | None:
        """A data item, or a field of it, as it was before the execution."""
        if not self.side.at_end or self.in_old:
            return Checker.old(self, term)
        if len(term.operands) != 1 or term.operands[0].kind not in ("name", "member"):
            message = f"`{OLD}` takes the name of a data item, or of a field of it"
            self.refuse("RV-0409", term, message)
            return None
        operand = term.operands[0]
        self.in_old = True
        checked = self.check(operand)
        self.in_old = False
        if checked is None:
            return None
        found = checked.expression
        if not isinstance(found, Name) or found.name not in self.side.written:
            message = f"{self.side.activity} does not write `{operand.word}`"
            hint = f"name it without `{OLD}`: the execution does not change it"
            self.refuse("RV-0419", term, message, hint)
            return None
        before = replace(found, kind=Reading.OLD)
        bounds = checked.bounds
        if isinstance(found.type, IntegerType):
            bounds = (found.type.first, found.type.last)
        return replace(checked, expression=before, bounds=bounds)

    def sent(self, term: Term) -> CheckedExpression | None:
        """Whether the execution sends on a port, or calls a command."""
        if not self.side.at_end:
            return Checker.sent(self, term)
        is_name = len(term.operands) == 1 and term.operands[0].kind == "name"
        self.in_sent = True
        checked = self.check(term.operands[0]) if is_name else None
        self.in_sent = False
        if is_name and checked is None:
            return None
        found = None if checked is None else checked.expression
        if not isinstance(found, Name) or found.kind is not Reading.OUTPUT:
            message = f"`{SENT}` takes the name of an output port, or of a command to call"
            self.refuse("RV-0409", term, message)
            return None
        if found.name in self.side.every_time:
            message = f"{self.side.activity} sends on `{found.name}` in every execution"
            hint = f"leave it out, or name `{found.name}` in `may_send` instead of `sends`"
            self.refuse("RV-0421", term, message, hint)
            return None
        flag = Name(Reading.SENT, found.name, None, BOOLEAN)
        return CheckedExpression(flag, BOOLEAN)

    def may_read(self, term: Term, name: str) -> bool:
        """Whether the activity has a value of that name; reported when not."""
        side = self.side
        if name in side.before or (side.at_end and name in side.written and not self.in_old):
            return True
        if side.is_flow:
            message = f"the flow of {side.activity} does not read or write `{name}`"
            hint = f"leave `{name}` out of the contract"
        else:
            message = f"{side.activity} does not read `{name}`"
            hint = f"add `{name}` to `reads`"
        self.refuse("RV-0420", term, message, hint)
        return False

    def may_send(self, term: Term, port: str) -> bool:
        """Whether an execution sends on that port, and this is about its end; reported when not."""
        side = self.side
        if not side.at_end:
            message = f"`{port}` has no value before {side.activity} sends it"
            self.refuse("RV-0420", term, message, "state the condition in `ensures`")
            return False
        if port not in side.sent:
            subject = f"the flow of {side.activity}" if side.is_flow else side.activity
            hint = f"leave `{port}` out of the contract"
            if not side.is_flow:
                key = "may_send" if self.in_sent else "sends"
                hint = f"add `{port}` to `{key}`, or to `calls` if it is a command"
            self.refuse("RV-0420", term, f"{subject} does not send on `{port}`", hint)
            return False
        return True


def contract_of(
    name: str,
    form: ActivityForm,
    lists: Lists,
    words: Vocabulary,
    targets: Targets,
    findings: Findings,
) -> tuple[tuple[Clause, ...], tuple[Clause, ...]]:
    """The clauses that an activity requires, and those that it ensures."""
    is_flow = not isinstance(form.body, str)
    written = frozenset(lists["writes"])
    #  a flow finds what it writes as it was: it sets some of it, or sets it in some executions
    before = frozenset(lists["reads"]) | (written if is_flow else frozenset())
    every_time = frozenset(() if is_flow else lists["sends"])
    side = Side(name, is_flow, before, written, frozenset(sent(lists)), every_time)
    words = replace(words, readable=_with_outputs(words, targets))
    requires = tuple(_clauses("requires", form, side, words, findings))
    ensures = tuple(_clauses("ensures", form, replace(side, at_end=True), words, findings))
    return requires, ensures


def _with_outputs(words: Vocabulary, targets: Targets) -> NameScope[tuple[Reading, str, Type]]:
    """The names that may be read, and those of output ports and of called commands."""
    known = words.readable
    scope: NameScope[tuple[Reading, str, Type]] = NameScope(
        "data item, parameter or port", dict(known.items), known.open
    )
    for name, origin, of_type in targets.outputs.items.values():
        scope.declare(name, origin, None if of_type is None else (Reading.OUTPUT, name, of_type))
    for name, origin, need in targets.calls.items.values():
        if need is not None and need.argument is not None:
            scope.declare(name, origin, (Reading.OUTPUT, name, need.argument))
    return scope


def _clauses(
    key: str, form: ActivityForm, side: Side, words: Vocabulary, findings: Findings
) -> Iterator[Clause]:
    given = form.requires if key == "requires" else form.ensures
    places: list[tuple[int | bool | str, TextPlace]] = []
    if isinstance(given, list):
        places = [(text, form.item_place(key, index)) for index, text in enumerate(given)]
    elif given is not None:
        places = [(given, form.place(key))]
    for text, place in places:
        made = condition(text, place, words, findings, key, partial(ContractChecker, side=side))
        if made is not None:
            yield Clause(place.origin, made)
