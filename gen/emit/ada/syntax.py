"""The Ada constructs that Ravenchart emits, as typed nodes.

An emitter builds a `Unit` from these nodes; `ada_text.print_unit` lays it out.
"""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable, Iterator, Sequence
from typing import NamedTuple, TypeVar

from ravenchart.gen.frozen import frozen

Result = TypeVar("Result", bound=Hashable)

# --- Expressions -------------------------------------------------------------


@frozen
class Ref:
    """A name or literal, as it is to stand in the text."""

    text: str


@frozen
class Old:
    """What a name stood for before the call, ``name'Old``; ``part`` selects from it."""

    name: str
    part: str = ""


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


class Arg(NamedTuple):
    """One association of a call or aggregate; positional when ``name`` is None."""

    name: str | None
    value: Expr


@frozen
class Call:
    """A function call, conversion or attribute with arguments."""

    name: str
    args: tuple[Arg, ...]


@frozen
class Aggregate:
    """A parenthesised list of associations, qualified by ``of_type`` where given.

    Components that it does not name are those of ``base``.
    """

    args: tuple[Arg, ...]
    of_type: str | None = None
    base: str | None = None


@frozen
class IfExpr:
    """``(if a then b elsif c then d else e)``; without ``otherwise``, an implication."""

    branches: tuple[tuple[Expr, Expr], ...]
    otherwise: Expr | None


@frozen
class CaseExpr:
    """``(case s is when c => e, ...)``."""

    selector: Expr
    branches: tuple[tuple[str, Expr], ...]


@frozen
class ForAll:
    """``(for all v in domain => condition)``."""

    variable: str
    domain: str
    condition: Expr


@frozen
class ForSome:
    """``(for some v in domain => condition)``."""

    variable: str
    domain: str
    condition: Expr


Expr = Ref | Old | OperatorChain | Prefix | Call | Aggregate | IfExpr | CaseExpr | ForAll | ForSome

# --- Statements --------------------------------------------------------------


@frozen
class Assign:
    """``target := value;``"""

    target: str
    value: Expr


@frozen
class Do:
    """A procedure call."""

    name: str
    args: tuple[Arg, ...] = ()


@frozen
class IfStatement:
    """``if ... then ... elsif ... else ... end if;``"""

    branches: tuple[tuple[Expr, tuple[Stmt, ...]], ...]
    otherwise: tuple[Stmt, ...] = ()


@frozen
class Case:
    """``case ... is when ... => ... end case;``"""

    selector: Expr
    branches: tuple[tuple[str, tuple[Stmt, ...]], ...]


@frozen
class Loop:
    """``head loop ... end loop;``; an empty ``head`` loops until an exit."""

    head: str
    body: tuple[Stmt, ...]


@frozen
class Say:
    """A simple statement given as it stands: ``null``, ``exit when X``, ``delay until T``."""

    text: str


@frozen
class Return:
    """``return value;``"""

    value: Expr


@frozen
class Pragma:
    """A pragma, among statements or declarations."""

    name: str
    args: tuple[Expr, ...] = ()


@frozen
class Comment:
    """Comment lines; wrapped to the width."""

    text: str


Stmt = Assign | Do | IfStatement | Case | Loop | Say | Return | Pragma | Comment

# --- Declarations ------------------------------------------------------------


class Aspect(NamedTuple):
    """One aspect; a Boolean one has no value."""

    name: str
    value: Expr | None = None


class Param(NamedTuple):
    """One formal parameter; ``mode`` is ``in``, ``out`` or ``in out``."""

    name: str
    mode: str
    type: str


@frozen
class EnumType:
    """An enumeration type; ``notes`` are comments on its literals, empty for one without."""

    name: str
    literals: tuple[str, ...]
    notes: tuple[Comment, ...] = ()


@frozen
class PlainType:
    """``type name is definition;`` or, with ``subtype``, a subtype."""

    name: str
    definition: str
    subtype: bool = False
    aspects: tuple[Aspect, ...] = ()


class RecordComponent(NamedTuple):
    """One record component."""

    name: str
    type: str
    initial: Expr | None = None


@frozen
class RecordDeclaration:
    """A record type."""

    name: str
    components: tuple[RecordComponent, ...]


@frozen
class Object:
    """An object or, without type, a named number."""

    name: str
    type: str | None
    value: Expr | None = None
    constant: bool = False
    aspects: tuple[Aspect, ...] = ()


@frozen
class Subprogram:
    """A subprogram: its spec, or its body when ``body`` or ``expression`` is given."""

    name: str
    params: tuple[Param, ...] = ()
    result: str | None = None
    aspects: tuple[Aspect, ...] = ()
    declarations: tuple[Decl, ...] = ()
    body: tuple[Stmt, ...] | None = None
    expression: Expr | None = None


@frozen
class GenericInstance:
    """``package name is new generic (...);``, or a ``procedure``."""

    name: str
    generic: str
    args: tuple[Arg, ...]
    kind: str = "package"


@frozen
class Package:
    """A package spec, or a body; nested or the unit itself."""

    name: str
    items: tuple[Decl, ...]
    aspects: tuple[Aspect, ...] = ()
    is_body: bool = False


@frozen
class Protected:
    """A single protected object: its spec with what it holds, or without that its body."""

    name: str
    items: tuple[Subprogram, ...]
    kept: tuple[Object, ...] = ()
    aspects: tuple[Aspect, ...] = ()


@frozen
class Rename:
    """``package name renames other;``"""

    name: str
    other: str


@frozen
class UseType:
    """``use type name;``"""

    name: str


@frozen
class UsePackage:
    """``use name;``"""

    name: str


Decl = (
    EnumType
    | PlainType
    | RecordDeclaration
    | Object
    | Subprogram
    | GenericInstance
    | Package
    | Protected
    | Rename
    | UseType
    | UsePackage
    | Pragma
    | Comment
)


@frozen
class Unit:
    """A compilation unit with its context clause and header comment."""

    header: str
    withs: tuple[str, ...]
    item: Package | Subprogram | GenericInstance

    @property
    def file_name(self) -> str:
        """GNAT's name for the file that holds it."""
        match self.item:
            case Package(is_body=is_body):
                pass
            case Subprogram(body=body):
                is_body = body is not None
            case GenericInstance():
                is_body = False
        stem = self.item.name.lower().replace(".", "-")
        return f"{stem}.{'adb' if is_body else 'ads'}"


# --- Shorthands --------------------------------------------------------------

TRUE = Ref("True")
FALSE = Ref("False")
NULL = Say("null")
SPARK = Aspect("SPARK_Mode")


def number(value: int) -> Ref:
    """An integer literal with underscores; a negative one in parentheses."""
    return Ref(f"{value:_}" if value >= 0 else f"(-{-value:_})")


def call(name: str, *args: Expr, **named: Expr) -> Call:
    """A function call with positional and then named arguments."""
    return Call(name, arguments(*args, **named))


def do(name: str, *args: Expr, **named: Expr) -> Do:
    """A procedure call with positional and then named arguments."""
    return Do(name, arguments(*args, **named))


def arguments(*args: Expr, **named: Expr) -> tuple[Arg, ...]:
    """Associations, positional first."""
    return (*[Arg(None, a) for a in args], *[Arg(n, a) for n, a in named.items()])


def chain(operator: str, operands: Sequence[Expr], empty: Expr = TRUE) -> Expr:
    """The operands joined; one stands alone, none gives ``empty``."""
    if not operands:
        return empty
    return operands[0] if len(operands) == 1 else OperatorChain(operator, tuple(operands))


def both(*operands: Expr) -> Expr:
    """``and then`` over the operands."""
    return chain("and then", operands)


def equal(left: Expr, right: Expr) -> Expr:
    """``left = right``."""
    return OperatorChain("=", (left, right))


def case_of(selector: Expr, rows: Iterable[tuple[str, tuple[Stmt, ...]]]) -> Case:
    """A case statement; choices with the same statements stand together."""
    return Case(selector, _together(rows))


def choice_of(selector: Expr, rows: Iterable[tuple[str, Expr]]) -> CaseExpr:
    """A case expression; choices with the same value stand together."""
    return CaseExpr(selector, _together(rows))


def _together(rows: Iterable[tuple[str, Result]]) -> tuple[tuple[str, Result], ...]:
    found: dict[Result, list[str]] = {}
    for choice, result in rows:
        found.setdefault(result, []).append(choice)
    return tuple((" | ".join(names), result) for result, names in found.items())


_NAME = re.compile(r"[A-Za-z]\w*(?:\.\w+)*")


def units_named_in(construct: object) -> set[str]:
    """The names in it with what stands before their dots: each unit that it names is among them.

    What comments say is not among them.
    """
    found: set[str] = set()
    for text in set(_texts(construct)):
        for name in _NAME.findall(text):
            while name and name not in found:
                found.add(name)
                name = name.rpartition(".")[0]
    return found


def _texts(construct: object) -> Iterator[str]:
    if isinstance(construct, str):
        yield construct
    elif not isinstance(construct, Comment):
        for part in _parts(construct):
            yield from _texts(part)


def _parts(construct: object) -> Sequence[object]:
    if isinstance(construct, tuple):
        return construct
    return [getattr(construct, name) for name in getattr(construct, "__slots__", ())]


def chains_in(construct: object) -> Iterator[OperatorChain]:
    """Each chain of operands in it."""
    if isinstance(construct, OperatorChain):
        yield construct
    if not isinstance(construct, str):
        for part in _parts(construct):
            yield from chains_in(part)


def names_in(construct: object) -> Iterator[str]:
    """The text of each name and literal in it."""
    if isinstance(construct, Ref):
        yield construct.text
        return
    if isinstance(construct, Old):
        yield construct.name
        return
    for part in _parts(construct):
        yield from names_in(part)


def member(left: Expr, choices: str) -> Expr:
    """``left in choices``."""
    return OperatorChain("in", (left, Ref(choices)))


def one_of(left: Expr, literals: Sequence[str]) -> Expr:
    """Is it one of these? False where there are none."""
    if len(literals) > 1:
        return member(left, " | ".join(literals))
    return chain("=", (left, Ref(literals[0]))) if literals else FALSE
