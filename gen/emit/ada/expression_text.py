# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The printer of expressions; `text` prints what they stand in."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from .expressions import (
    Aggregate,
    Arg,
    Attribute,
    BoxMark,
    Call,
    CaseExpr,
    Choice,
    ChoiceList,
    Domain,
    Expr,
    ForAll,
    ForSome,
    IfExpr,
    Indexed,
    IntegerLiteral,
    Membership,
    NullLiteral,
    OperatorChain,
    Others,
    Parenthesized,
    Power,
    Prefix,
    Qualified,
    Range,
    RangeConstrained,
    Selected,
    StringLiteral,
)
from .layout import CUT, SOFT, Doc, cat, group, joined, nest, parenthesized, upright
from .named import DottedName

LONG_REFERENCE = 56
"""Longer names do not fit where they stand deep in other constructs."""


def argument_layout(docs: Sequence[Doc]) -> Doc:
    """Arguments on one line; else named ones have a line each, and positional ones fill lines."""
    return group("(", nest(*joined(docs, ","), by=1), ")")


def with_arguments(head: str, args: Sequence[Arg], end: str = "") -> Doc:
    """A name and its arguments; positional ones begin behind it."""
    docs = [argument(a) for a in args]
    if any(a.name is not None for a in args):
        return group(head, nest(SOFT, argument_layout(docs), by=2), end)
    return behind_name(head, docs, end)


def behind_name(head: str, docs: Sequence[Doc], end: str) -> Doc:
    """A name and what fills the lines behind it."""
    if len(docs) < 2:
        return group(head, nest(SOFT, argument_layout(docs), by=2), end)
    first, *rest = docs
    behind = [group(SOFT, doc, "," if n < len(rest) else ")") for n, doc in enumerate(rest, 1)]
    begin = group(SOFT, "(", nest(first, by=1), ",")
    return group(head, nest(begin, nest(*behind, by=1), by=2), end)


def argument(arg: Arg) -> Doc:
    value = expr_layout(arg.value)
    return value if arg.name is None else group(selector_of(arg), " =>", nest(SOFT, value, by=2))


def selector_of(arg: Arg) -> str:
    return arg.name if isinstance(arg.name, str) else choice_text(arg.name or Others())


_LEVELS = (
    ("and", "or", "xor", "and then", "or else"),
    ("=", "/=", "<", "<=", ">", ">=", "in"),
    ("+", "-", "&"),
    ("*", "/", "mod", "rem"),
    ("**",),
)
"""The binary operators of Ada, each row binding its operands closer than the one before."""
_CLOSENESS = {operator: level for level, row in enumerate(_LEVELS) for operator in row}
_ARITHMETIC = _LEVELS[2] + _LEVELS[3]
"""Operators without which a line may go on: their operands fill the lines."""


def _operand(expr: Expr, operator: str = "", first: bool = False) -> Doc:
    """One operand, in parentheses where the precedence of Ada asks for them.

    The first one of an arithmetic operator needs none where it has an operator of the same level.
    """
    doc = expr_layout(expr)
    if isinstance(expr, OperatorChain | Membership):
        own = _CLOSENESS["in" if isinstance(expr, Membership) else expr.operator]
        around = _CLOSENESS.get(operator, len(_LEVELS))
        alike = first and own == around and operator in _ARITHMETIC
        if not (alike or own > around) or operator == "**":
            return cat("(", nest(doc, by=1), ")")
    return doc


def _signed(expr: Expr, operator: str = "", first: bool = False) -> Doc:
    """An operand after an operator: there Ada has no sign, ``abs`` or ``not`` of its own."""
    nested = isinstance(expr, Prefix) and (expr.operator == "-" or not operator)
    return parenthesized(expr_layout(expr)) if nested else _operand(expr, operator, first)


def choices_text(choices: ChoiceList, end: str = "") -> Doc:
    """``A | B``, in as many lines as it takes."""
    *texts, last = map(choice_text, choices.choices)
    first, *others = [*texts, f"{last}{end}"]
    return cat(first, *(group(SOFT, "| ", choice) for choice in others)) if others else first


def choice_text(choice: Choice | Domain) -> str:
    match choice:
        case Others():
            return "others"
        case Range(low, high):
            return f"{flat(low)} .. {flat(high)}"
        case RangeConstrained(mark, bounds):
            return f"{mark.text} range {choice_text(bounds)}"
    return flat(choice)


def _is_named(item: Expr) -> bool:
    """Is it what a name stands for, which no line begins behind?"""
    return isinstance(item, DottedName | Selected | Indexed | Attribute)


def _among(choices: ChoiceList) -> Doc:
    """The choices behind ``in``."""
    match choices.choices:
        case (DottedName() as only,):
            return _dotted(only)
    return choices_text(choices)


def flat(expr: Expr) -> str:
    """An expression on one line."""
    if isinstance(expr, DottedName):
        return expr.text
    doc = expr_layout(expr)
    return doc if isinstance(doc, str) else doc.flat


def _dotted(name: DottedName) -> Doc:
    """A name; one too long for some lines may break before its end."""
    text = name.text
    if len(text) <= LONG_REFERENCE or len(name.parts) == 1:
        return text
    return group(name.parent.text, nest(CUT, f".{name.last}", by=2))


def _element(prefix: Expr, index: Expr, end: str = "") -> Doc:
    """An element of an array, or what ``end`` selects of it; it may break before its index."""
    head, place = flat(prefix), f"({flat(index)}){end}"
    long = len(head) + 1 + len(place) > LONG_REFERENCE
    is_word = isinstance(index, IntegerLiteral) or (
        isinstance(index, DottedName) and len(index.parts) == 1
    )
    if long and is_word and isinstance(prefix, DottedName):
        return group(head, nest(SOFT, place, by=2))
    return f"{head} {place}"


def _integer(literal: IntegerLiteral) -> str:
    if literal.base == 16:
        return f"16#{literal.value:_X}#" if literal.grouped else f"16#{literal.value:X}#"
    return f"{literal.value:_}" if literal.grouped else str(literal.value)


def _word(expr: Expr) -> Doc:
    """An expression that has no place for a break, or a name."""
    match expr:
        case DottedName():
            return _dotted(expr)
        case Selected(Indexed(prefix, index), selector):
            return _element(prefix, index, f".{selector}")
        case Selected(prefix, selector):
            return f"{flat(prefix)}.{selector}"
        case Indexed(prefix, index):
            return _element(prefix, index)
        case Attribute(prefix, designator):
            return f"{flat(prefix)}'{designator}"
        case Qualified(mark, operand):
            return f"{mark.text}'({flat(operand)})"
        case IntegerLiteral():
            return _integer(expr)
        case Power(base, exponent):
            return f"{base}**{exponent}"
        case StringLiteral(words):
            doubled = words.replace('"', '""')
            return f'"{doubled}"'
        case NullLiteral():
            return "null"
        case BoxMark():
            return "<>"
    raise TypeError(expr)


@lru_cache(maxsize=8192)
def expr_layout(expr: Expr) -> Doc:
    """The layout of one expression; a program has few that it does not repeat."""
    match expr:
        case OperatorChain(operator, operands):
            #  GNAT wants to see what a sign before a product is of
            begin = _signed if operator in ("*", "/") else _operand
            head = begin(operands[0], operator, first=True)
            rest = [_signed(o, operator) for o in operands[1:]]
            place = group if operator in _ARITHMETIC else cat
            return group(head, *(place(SOFT, f"{operator} ", nest(r, by=2)) for r in rest))
        case Prefix(operator, operand):
            return cat(operator if operator == "-" else f"{operator} ", _signed(operand))
        case Parenthesized(operand):
            return cat("(", nest(expr_layout(operand), by=1), ")")
        case Membership(item, among):
            head = _operand(item, "in", first=True)
            gap = " " if _is_named(item) else SOFT
            return group(head, gap, "in ", nest(_among(among), by=2))
        case Call(name, args):
            return with_arguments(flat(name), args)
        case Aggregate(args, of_type, base):
            docs = [argument(a) for a in args]
            if base is not None:
                return parenthesized(
                    f"{flat(base)} with delta", nest(SOFT, *joined(docs, ","), by=2)
                )
            return group(f"{of_type.text}'" if of_type else "", argument_layout(docs))
        case IfExpr(branches, otherwise):
            parts: list[Doc] = [
                group(
                    "if " if i == 0 else "elsif ",
                    nest(expr_layout(c)),
                    nest(SOFT, "then ", nest(expr_layout(v))),
                )
                for i, (c, v) in enumerate(branches)
            ]
            if otherwise is not None:
                parts.append(cat("else ", nest(expr_layout(otherwise))))
            return parenthesized(*joined(parts))
        case CaseExpr(selector, branches):
            rows = [
                group(
                    "when ",
                    nest(choices_text(choices, " =>")),
                    nest(SOFT, expr_layout(value)),
                )
                for choices, value in branches
            ]
            body = nest(SOFT, *joined(rows, ","), by=2)
            return upright("(", nest("case ", expr_layout(selector), " is", body, by=1), ")")
        case ForAll(variable, domain, condition) | ForSome(variable, domain, condition):
            word = "all" if isinstance(expr, ForAll) else "some"
            head = f"for {word} {variable} in {choice_text(domain)} =>"
            return parenthesized(head, nest(SOFT, expr_layout(condition)))
    return _word(expr)
