# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Statements of generated Ada as nodes."""

from __future__ import annotations

from collections.abc import Iterable

from ravenchart.gen.frozen import built, frozen

from .expressions import (
    Arg,
    Choice,
    ChoiceList,
    Choices,
    Domain,
    Expr,
    Indexed,
    StringLiteral,
    arguments,
    choice_list,
    together,
)
from .named import DottedName, Named, identifier, ref

Target = DottedName | Indexed
"""The left side of an assignment."""


@built
class Assign:
    """``target := value;``"""

    target: Target
    value: Expr

    def __init__(self, target: Target | str, value: Expr) -> None:
        self.target = ref(target) if isinstance(target, str) else target
        self.value = value


@built
class Do:
    """A procedure call."""

    name: DottedName
    args: tuple[Arg, ...]

    def __init__(self, name: Named, args: tuple[Arg, ...] = ()) -> None:
        self.name, self.args = ref(name), args


@frozen
class IfStatement:
    """``if ... then ... elsif ... else ... end if;``"""

    branches: tuple[tuple[Expr, tuple[Stmt, ...]], ...]
    otherwise: tuple[Stmt, ...] = ()


@built
class Case:
    """``case ... is when ... => ... end case;``"""

    selector: Expr
    branches: tuple[tuple[ChoiceList, tuple[Stmt, ...]], ...]

    def __init__(
        self, selector: Expr, branches: Iterable[tuple[Choices, tuple[Stmt, ...]]]
    ) -> None:
        self.selector = selector
        self.branches = tuple((choice_list(choices), body) for choices, body in branches)


@built
class ForLoop:
    """``for variable in domain``: what stands before a loop."""

    variable: str
    domain: Domain

    def __init__(self, variable: str, domain: Domain | str) -> None:
        self.variable = identifier(variable)
        self.domain = ref(domain) if isinstance(domain, str) else domain


@frozen
class Loop:
    """``head loop ... end loop;``; without ``head`` it goes on until an exit."""

    head: ForLoop | None
    body: tuple[Stmt, ...]


@frozen
class NullStatement:
    """``null;``"""


@frozen
class ExitStatement:
    """``exit when condition;``, or without a condition ``exit;``"""

    condition: Expr | None = None


@frozen
class DelayUntil:
    """``delay until time;``"""

    time: Expr


@frozen
class RaiseStatement:
    """``raise exception with words;``"""

    exception: DottedName
    words: StringLiteral


@frozen
class Return:
    """``return value;``, or from a procedure ``return;``"""

    value: Expr | None = None


@frozen
class Pragma:
    """A pragma, among statements or declarations."""

    name: str
    args: tuple[Expr | Arg, ...] = ()


@frozen
class Comment:
    """Comment lines; wrapped to the width."""

    text: str


Stmt = (
    Assign
    | Do
    | IfStatement
    | Case
    | Loop
    | NullStatement
    | ExitStatement
    | DelayUntil
    | RaiseStatement
    | Return
    | Pragma
    | Comment
)

NULL = NullStatement()


def do(name: Named, *args: Expr, **named: Expr) -> Do:
    """A procedure call with positional and then named arguments."""
    return Do(name, arguments(*args, **named))


def case_of(selector: Expr, rows: Iterable[tuple[Choice | str, tuple[Stmt, ...]]]) -> Case:
    """A case statement; choices with the same statements stand together."""
    return Case(selector, together(rows))
