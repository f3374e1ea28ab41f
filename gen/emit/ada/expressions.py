# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Expressions of generated Ada as nodes, and short ways to make them.

A constructor takes a name as a node or as its text. The text is read once, by `ref`, which refuses
all that is no name.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TypeVar

from ravenchart.gen.frozen import built, frozen

from .named import DottedName, Named, identifier, ref, word

T = TypeVar("T")


def _node(given: T | str) -> T | DottedName:
    """The node, or the name that a text is."""
    return ref(given) if isinstance(given, str) else given


# --- Names of several parts ----------------------------------------------------------


@built
class Selected:
    """``prefix.selector``, where the prefix is more than identifiers."""

    prefix: Holder
    selector: str

    def __init__(self, prefix: Holder, selector: str) -> None:
        self.prefix, self.selector = prefix, identifier(selector)


@built
class Indexed:
    """``prefix (index)``: an element of an array."""

    prefix: Holder
    index: Expr

    def __init__(self, prefix: Holder | str, index: Expr) -> None:
        self.prefix = _node(prefix)
        self.index = index


@built
class Attribute:
    """``prefix'designator``."""

    prefix: Holder
    designator: str

    def __init__(self, prefix: Holder | str, designator: str) -> None:
        self.prefix = _node(prefix)
        self.designator = word(designator)


@frozen
class Qualified:
    """``mark'(operand)``."""

    mark: DottedName
    operand: Expr


# --- Literals ------------------------------------------------------------------------


@frozen
class IntegerLiteral:
    """A number that is not negative, with underscores if ``grouped``."""

    value: int
    base: int = 10
    grouped: bool = True


@frozen
class Power:
    """``base**exponent`` of two numbers, as one word."""

    base: int
    exponent: int


@frozen
class StringLiteral:
    """Words between quotation marks."""

    words: str


@frozen
class NullLiteral:
    """``null``, where a value or a list of objects is meant."""


@frozen
class BoxMark:
    """``<>``: what a component or parameter has by default."""


@frozen
class Others:
    """``others``: the choice of all that no other choice has."""


# --- Choices -------------------------------------------------------------------------


@frozen
class Range:
    """``low .. high``"""

    low: Expr
    high: Expr


@built
class RangeConstrained:
    """``mark range low .. high``"""

    mark: DottedName
    bounds: Range

    def __init__(self, mark: Named, bounds: Range) -> None:
        self.mark, self.bounds = ref(mark), bounds


@built
class ChoiceList:
    """``A | B .. C | others``"""

    choices: tuple[Choice, ...]

    def __init__(self, choices: Iterable[Choice | str]) -> None:
        self.choices = tuple(_node(choice) for choice in choices)


# --- Operators and calls -------------------------------------------------------------


@frozen
class OperatorChain:
    """Operands joined by one operator; operands that are chains get parentheses."""

    operator: str
    operands: tuple[Expr, ...]


@frozen
class Prefix:
    """``not``, ``-`` or ``abs`` before one operand."""

    operator: str
    operand: Expr


@frozen
class Parenthesized:
    """An operand in parentheses of its own."""

    operand: Expr


@frozen
class Membership:
    """``item in choices``"""

    item: Expr
    among: ChoiceList


@built
class Arg:
    """One association of a call or aggregate; positional when ``name`` is None.

    A text is the identifier of a parameter or component; an element of an array has a choice.
    """

    name: str | Choice | None
    value: Expr

    def __init__(self, name: str | Choice | None, value: Expr) -> None:
        self.name = identifier(name) if isinstance(name, str) else name
        self.value = value


@built
class Call:
    """A function call, conversion or attribute with arguments."""

    name: Callee
    args: tuple[Arg, ...]

    def __init__(self, name: Callee | str, args: tuple[Arg, ...]) -> None:
        self.name = _node(name)
        self.args = args


@frozen
class Aggregate:
    """A parenthesised list of associations, qualified by ``of_type`` where given.

    Components that it does not name are those of ``base``.
    """

    args: tuple[Arg, ...]
    of_type: DottedName | None = None
    base: Expr | None = None


@frozen
class IfExpr:
    """``(if a then b elsif c then d else e)``; without ``otherwise``, an implication."""

    branches: tuple[tuple[Expr, Expr], ...]
    otherwise: Expr | None


@built
class CaseExpr:
    """``(case s is when c => e, ...)``."""

    selector: Expr
    branches: tuple[tuple[ChoiceList, Expr], ...]

    def __init__(self, selector: Expr, branches: Iterable[tuple[Choices, Expr]]) -> None:
        self.selector = selector
        self.branches = tuple((choice_list(choices), value) for choices, value in branches)


@built
class Quantified:
    """The condition holds for all values of the domain, or for some."""

    variable: str
    domain: Domain
    condition: Expr

    def __init__(self, variable: str, domain: Domain | str, condition: Expr) -> None:
        self.variable, self.domain = identifier(variable), _node(domain)
        self.condition = condition


class ForAll(Quantified):
    """``(for all v in domain => condition)``."""


class ForSome(Quantified):
    """``(for some v in domain => condition)``."""


Holder = DottedName | Selected | Indexed | Attribute | Call
"""The prefix of a dot, an index or an attribute."""
Callee = DottedName | Attribute
Domain = DottedName | Attribute | Range | RangeConstrained
"""The values that a variable goes through."""
Choice = DottedName | IntegerLiteral | Prefix | Range | Others
Choices = ChoiceList | Choice | str
"""Several choices, one, or the text of a name."""
Expr = (
    DottedName
    | Selected
    | Indexed
    | Attribute
    | Qualified
    | IntegerLiteral
    | Power
    | StringLiteral
    | NullLiteral
    | BoxMark
    | OperatorChain
    | Prefix
    | Parenthesized
    | Membership
    | Call
    | Aggregate
    | IfExpr
    | CaseExpr
    | Quantified
)

# --- Short ways ----------------------------------------------------------------------

TRUE = ref("True")
FALSE = ref("False")
NOTHING = NullLiteral()
BOX = BoxMark()
OTHERS = Others()
COMPARISONS = frozenset(("=", "/=", "<", "<=", ">", ">="))


def number(value: int) -> IntegerLiteral | Parenthesized:
    """An integer literal with underscores; a negative one in parentheses."""
    return IntegerLiteral(value) if value >= 0 else Parenthesized(signed(value))


def signed(value: int) -> IntegerLiteral | Prefix:
    """The same without parentheses: a bound, a choice, or the only argument."""
    return IntegerLiteral(value) if value >= 0 else Prefix("-", IntegerLiteral(-value))


def plain(value: int) -> IntegerLiteral:
    """A small number, such as a position, without underscores."""
    return IntegerLiteral(value, grouped=False)


def bits(value: int) -> IntegerLiteral:
    """A pattern of bits."""
    return IntegerLiteral(value, 16, grouped=False)


def select(prefix: Holder | str, *selectors: Named) -> DottedName | Selected:
    """A component of what ``prefix`` names, one of that, and so on."""
    if isinstance(prefix, DottedName | str):
        return ref(prefix, *selectors)
    found: Holder = prefix
    for selector in ref(*selectors).parts:
        found = Selected(found, selector)
    assert isinstance(found, Selected)
    return found


def old(name: Holder | str) -> Attribute:
    """The value of a name before the call."""
    return Attribute(name, "Old")


def result(function: str) -> Attribute:
    """The result of a function."""
    return Attribute(function, "Result")


def between(low: int, high: int) -> Range:
    """``low .. high`` of two numbers."""
    return Range(signed(low), signed(high))


def up_to(last: Expr) -> Range:
    """``1 .. last``"""
    return Range(plain(1), last)


def call(name: Callee | str, *args: Expr, **named: Expr) -> Call:
    """A function call with positional and then named arguments."""
    return Call(name, arguments(*args, **named))


def arguments(*args: Expr, **named: Expr) -> tuple[Arg, ...]:
    """Associations, positional first."""
    return (*[Arg(None, a) for a in args], *[Arg(n, a) for n, a in named.items()])


def record(components: Mapping[str, Expr], of_type: DottedName | None = None) -> Aggregate:
    """An aggregate of components by their names."""
    return Aggregate(tuple(Arg(name, value) for name, value in components.items()), of_type)


def all_else(value: Expr) -> Aggregate:
    """``(others => value)``"""
    return Aggregate((Arg(OTHERS, value),))


def chain(operator: str, operands: Sequence[Expr], empty: Expr = TRUE) -> Expr:
    """The operands joined; one stands alone, none gives ``empty``."""
    if not operands:
        return empty
    return operands[0] if len(operands) == 1 else OperatorChain(operator, tuple(operands))


def both(*operands: Expr) -> Expr:
    """``and then`` over the operands."""
    return chain("and then", operands)


def equal(left: Expr, right: Expr) -> OperatorChain:
    """``left = right``."""
    return OperatorChain("=", (left, right))


def choice_list(choices: Choices) -> ChoiceList:
    """The choices as a list."""
    return choices if isinstance(choices, ChoiceList) else ChoiceList((choices,))


def member(item: Expr, *choices: Choice | str) -> Membership:
    """``item in choices``."""
    return Membership(item, ChoiceList(choices))


def one_of(item: Expr, literals: Sequence[Named]) -> Expr:
    """Is it one of these? False where there are none."""
    if len(literals) > 1:
        return member(item, *literals)
    return equal(item, ref(literals[0])) if literals else FALSE


def choice_of(selector: Expr, rows: Iterable[tuple[Choice | str, Expr]]) -> CaseExpr:
    """A case expression; choices with the same value stand together."""
    return CaseExpr(selector, together(rows))


def together(rows: Iterable[tuple[Choice | str, T]]) -> list[tuple[ChoiceList, T]]:
    """The choices that come to the same as one list."""
    found: dict[T, list[Choice | str]] = {}
    for choice, of_choice in rows:
        found.setdefault(of_choice, []).append(choice)
    return [(ChoiceList(choices), of_choices) for of_choices, choices in found.items()]
