"""The printer of the Ada constructs: the only place that knows about layout.

Three spaces, 79 columns, one statement a line; long parameter lists and
expressions break one item a line (`layout` decides).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache

from .layout import CUT, SOFT, STEP, Doc, cat, group, laid_out, nest, pad, upright
from .syntax import (
    NULL,
    Aggregate,
    Arg,
    Aspect,
    Assign,
    Call,
    Case,
    CaseExpr,
    Comment,
    Decl,
    Do,
    EnumType,
    Expr,
    ForAll,
    ForSome,
    GenericInstance,
    IfExpr,
    IfStatement,
    Loop,
    Object,
    Old,
    OperatorChain,
    Package,
    Param,
    PlainType,
    Pragma,
    Prefix,
    Protected,
    RecordDeclaration,
    Ref,
    Rename,
    Return,
    Say,
    Stmt,
    Subprogram,
    Unit,
    UsePackage,
    UseType,
    arguments,
)

WIDTH = 79
LONG_REFERENCE = 56
"""Longer names do not fit where they stand deep in other constructs."""
ADA_NAME = re.compile(r"[\w.]+( \(\w+\)(\.\w+)?)?")
"""A name of one or several words, perhaps of a component of an array."""


def _join(docs: Sequence[Doc], separator: str = "") -> list[Doc]:
    """The documents with a separator and a soft place between them."""
    between = (separator, SOFT) if separator else (SOFT,)
    parts = [part for doc in docs for part in (doc, *between)]
    return parts[: -len(between)]


def _lines(docs: Sequence[Doc]) -> Doc:
    """Each on a line of its own, nested, with a line break before each."""
    return nest(*(part for doc in docs for part in (SOFT, doc)))


def _filled(docs: Sequence[Doc], separator: str = ",") -> Doc:
    """The documents with a separator, as many on a line as it holds."""
    *others, last = docs
    first, *rest = [*(cat(doc, separator) for doc in others), last]
    return cat(first, *(group(SOFT, doc) for doc in rest))


def _args(args: Sequence[Arg]) -> Doc:
    """Arguments on one line; else named ones have a line each, and positional ones fill lines."""
    return group("(", nest(*_join([_arg(a) for a in args], ","), by=1), ")")


def _given(head: str, args: Sequence[Arg], end: str = "") -> Doc:
    """A name and its arguments; positional ones begin behind it."""
    if len(args) < 2 or any(a.name is not None for a in args):
        return group(head, nest(SOFT, _args(args), by=2), end)
    first, *rest = (_arg(a) for a in args)
    behind = [group(SOFT, doc, "," if n < len(rest) else ")") for n, doc in enumerate(rest, 1)]
    begin = group(SOFT, "(", nest(first, by=1), ",")
    return group(head, nest(begin, nest(*behind, by=1), by=2), end)


def _arg(arg: Arg) -> Doc:
    value = expression(arg.value)
    return value if arg.name is None else group(arg.name, " =>", nest(SOFT, value, by=2))


_LEVELS = (
    ("and", "or", "xor", "and then", "or else"),
    ("=", "/=", "<", "<=", ">", ">=", "in", "not in"),
    ("+", "-", "&"),
    ("*", "/", "mod", "rem"),
    ("**",),
)
"""The binary operators of Ada, each row binding its operands closer than the one before."""
_CLOSENESS = {operator: level for level, row in enumerate(_LEVELS) for operator in row}
_MEMBERSHIP = ("in", "not in")
_ARITHMETIC = _LEVELS[2] + _LEVELS[3]
"""Operators without which a line may go on: their operands fill the lines."""


def _operand(expr: Expr, operator: str = "", first: bool = False) -> Doc:
    """One operand, in parentheses where the precedence of Ada asks for them.

    The first one of an arithmetic operator needs none where it has an operator of the same level.
    """
    doc = expression(expr)
    if isinstance(expr, OperatorChain):
        own, around = _CLOSENESS[expr.operator], _CLOSENESS.get(operator, len(_LEVELS))
        alike = first and own == around and operator in _ARITHMETIC
        if not (alike or own > around) or operator == "**":
            return cat("(", nest(doc, by=1), ")")
    return doc


def _signed(expr: Expr, operator: str = "", first: bool = False) -> Doc:
    """An operand after an operator: there Ada has no sign, ``abs`` or ``not`` of its own."""
    nested = isinstance(expr, Prefix) and (expr.operator == "-" or not operator)
    return _bare(expression(expr)) if nested else _operand(expr, operator, first)


def _bare(*docs: Doc) -> Doc:
    """Between parentheses, one column in."""
    return group("(", nest(*docs, by=1), ")")


def _choices(text: str) -> Doc:
    """``A | B``, in as many lines as it takes."""
    first, *others = text.split(" | ")
    return cat(first, *(group(SOFT, "| ", choice) for choice in others)) if others else first


def _reference(text: str) -> Doc:
    """A name; one too long for some lines may break before its index, or else before its end."""
    if len(text) <= LONG_REFERENCE or not ADA_NAME.fullmatch(text):
        return text
    head, paren, index = text.partition(" (")
    if paren:
        return group(head, nest(SOFT, f"({index}", by=2))
    head, dot, end = text.rpartition(".")
    return group(head, nest(CUT, f".{end}", by=2)) if dot else text


@lru_cache(maxsize=8192)
def expression(expr: Expr) -> Doc:
    """The layout of one expression; a program has few that it does not repeat."""
    match expr:
        case Ref(text):
            return _choices(text) if " | " in text else _reference(text)
        case Old(name, part):
            return f"{name}'Old{part}"
        case OperatorChain(operator, operands):
            #  GNAT wants to see what a sign before a product is of
            begin = _signed if operator in ("*", "/") else _operand
            head = begin(operands[0], operator, first=True)
            rest = [_signed(o, operator) for o in operands[1:]]
            if operator in _MEMBERSHIP and isinstance(operands[0], Ref):
                return group(head, f" {operator} ", nest(*rest, by=2))
            place = group if operator in _ARITHMETIC else cat
            return group(head, *(place(SOFT, f"{operator} ", nest(r, by=2)) for r in rest))
        case Prefix(operator, operand):
            return cat(operator if operator == "-" else f"{operator} ", _signed(operand))
        case Call(name, args):
            return _given(name, args)
        case Aggregate(args, _, str(base)):
            changed = _join([_arg(a) for a in args], ",")
            return _bare(f"{base}{_DELTA}", nest(SOFT, *changed, by=2))
        case Aggregate(args, of_type):
            return group(f"{of_type}'" if of_type else "", _args(args))
        case IfExpr(branches, otherwise):
            parts: list[Doc] = [
                group(
                    "if " if i == 0 else "elsif ",
                    nest(expression(c)),
                    nest(SOFT, "then ", nest(expression(v))),
                )
                for i, (c, v) in enumerate(branches)
            ]
            if otherwise is not None:
                parts.append(cat("else ", nest(expression(otherwise))))
            return _bare(*_join(parts))
        case CaseExpr(selector, branches):
            rows = [
                group("when ", nest(_choices(f"{choice} =>")), nest(SOFT, expression(value)))
                for choice, value in branches
            ]
            body = nest(SOFT, *_join(rows, ","), by=2)
            return upright("(", nest("case ", expression(selector), " is", body, by=1), ")")
        case ForAll(variable, domain, condition) | ForSome(variable, domain, condition):
            word = "all" if isinstance(expr, ForAll) else "some"
            return _bare(f"for {word} {variable} in {domain} =>", nest(SOFT, expression(condition)))


@lru_cache(maxsize=8192)
def _comment(text: str) -> Doc:
    lines: list[str] = []
    for paragraph in text.split("\n"):
        line = ""
        for word in paragraph.split():
            if line and len(line) + 1 + len(word) > WIDTH - 10:
                lines.append(line)
                line = word
            else:
                line = f"{line} {word}".strip()
        lines.append(line)
    return upright(*_join([f"--  {line}".rstrip() for line in lines]))


def _block(statements: Sequence[Stmt]) -> Doc:
    return _lines([statement(s) for s in statements or (NULL,)])


def statement(stmt: Stmt) -> Doc:
    """The layout of one statement."""
    match stmt:
        case Assign(target, value):
            return group(f"{target} :=", nest(SOFT, expression(value), by=2), ";")
        case Do(name, ()):
            return f"{name};"
        case Do(name, args):
            return _given(name, args, ";")
        case IfStatement(branches, otherwise):
            parts: list[Doc] = []
            for index, (condition, body) in enumerate(branches):
                head = group(
                    "if " if index == 0 else "elsif ", nest(expression(condition)), SOFT, "then"
                )
                parts += [head, _block(body), SOFT]
            if otherwise:
                parts += ["else", _block(otherwise), SOFT]
            return upright(*parts, "end if;")
        case Case(selector, branches):
            rows = [
                upright(group("when ", nest(_choices(f"{choice} =>"))), _block(body))
                for choice, body in branches
            ]
            return upright("case ", expression(selector), " is", _lines(rows), SOFT, "end case;")
        case Loop(head, body):
            start = f"{head} loop" if head else "loop"
            return upright(start, _block(body), SOFT, "end loop;")
        case Say(text):
            return f"{text};"
        case Return(value):
            return group("return", nest(SOFT, expression(value), by=2), ";")
        case Pragma(name, args):
            return _pragma(name, args)
        case Comment(text):
            return _comment(text)


def _pragma(name: str, args: Sequence[Expr]) -> Doc:
    if not args:
        return f"pragma {name};"
    return _given(f"pragma {name}", arguments(*args), ";")


@lru_cache(maxsize=8192)
def _aspects(aspects: Sequence[Aspect]) -> Doc:
    docs = [
        a.name if a.value is None else group(f"{a.name} =>", nest(SOFT, expression(a.value), by=2))
        for a in aspects
    ]
    return cat(SOFT, group("with", nest(SOFT, *_join(docs, ","), by=2)))


@lru_cache(maxsize=8192)
def _params(params: Sequence[Param]) -> Doc:
    """All on one line; or one on each line, their colons below each other."""
    width = max(len(p.name) for p in params)
    docs = [
        cat(
            p.name, pad(width - len(p.name)), f" : {'' if p.mode == 'in' else p.mode + ' '}{p.type}"
        )
        for p in params
    ]
    return group("(", nest(*_join(docs, ";"), by=1), ")")


def _subprogram(sub: Subprogram) -> Doc:
    keyword = "function" if sub.result else "procedure"
    profile = [_params(sub.params)] if sub.params else []
    profile += [f"return {sub.result}"] if sub.result else []
    head = group(f"{keyword} {sub.name}", _profile(profile))
    aspects = _aspects(sub.aspects) if sub.aspects else ""
    if sub.expression is not None:
        inner = expression(sub.expression)
        if not isinstance(sub.expression, (IfExpr, CaseExpr, ForAll, ForSome)):
            inner = _bare(inner)
        if not any(aspect.value for aspect in sub.aspects):
            aspects = group(aspects)
        return upright(group(head, " is", nest(SOFT, inner, by=2)), aspects, ";")
    if sub.body is None:
        return upright(head, aspects, ";")
    declarations = _lines(_items(sub.declarations))
    start = [SOFT, "is"] if sub.aspects else [" is"]
    return upright(
        head,
        aspects,
        *start,
        declarations,
        SOFT,
        "begin",
        _block(sub.body),
        SOFT,
        f"end {sub.name};",
    )


def _profile(parts: Sequence[Doc]) -> Doc:
    """Parameters and result: behind the name, or below it."""
    first, *rest = parts or ("",)
    behind = (group(SOFT, part) for part in rest)
    return nest(SOFT, first, *behind, by=2) if parts else ""


def _object(decl: Object) -> Doc:
    """An object; its name and type stand below each other where no line holds both."""
    words = " ".join(w for w in ("constant" if decl.constant else "", decl.type or "") if w)
    start: list[Doc] = [f"{decl.name} : {words}"]
    if len(f"{decl.name} : {words} :=") > WIDTH - STEP:
        start = [upright(f"{decl.name} :", nest(SOFT, words, by=2))]
    if decl.value is not None:
        start += [" :=", nest(SOFT, expression(decl.value), by=2)]
    return group(*start, _aspects(decl.aspects) if decl.aspects else "", ";")


def _declaration(decl: Decl) -> Doc:
    match decl:
        case EnumType():
            return _enumeration(decl)
        case PlainType():
            return _plain_type(decl)
        case RecordDeclaration(name, ()):
            return f"type {name} is null record;"
        case RecordDeclaration(name, components):
            width = max(len(c.name) for c in components)
            rows = [_component(f"{c.name:<{width}} : {c.type}", c.initial) for c in components]
            return upright(f"type {name} is record", _lines(rows), SOFT, "end record;")
        case Object():
            return _object(decl)
        case Subprogram():
            return _subprogram(decl)
        case GenericInstance(name, generic, args, kind):
            head = f"{kind} {name} is new {generic}"
            return group(head, nest(SOFT, _args(args), by=2), ";")
        case Package():
            return _package(decl)
        case Protected():
            return _protected(decl)
        case Rename(name, other):
            return f"package {name} renames {other};"
        case UseType(name) | UsePackage(name):
            return f"use {'type ' if isinstance(decl, UseType) else ''}{name};"
        case Pragma(name, args):
            return _pragma(name, args)
        case Comment(text):
            return _comment(text)


def _enumeration(decl: EnumType) -> Doc:
    if not decl.notes:
        items = nest(_filled(decl.literals), by=1)
        return group(f"type {decl.name} is", nest(SOFT, group("(", items, ");"), by=2))
    noted = _annotated(decl.literals, decl.notes)
    rows = nest(*_join(list(noted)), by=1)
    end = cat(SOFT, ");") if decl.notes[-1].text else ");"
    return upright(f"type {decl.name} is", nest(SOFT, "(", rows, end, by=2))


def _annotated(literals: Sequence[str], notes: Sequence[Comment]) -> Iterator[Doc]:
    """A line for each literal, its note behind it; before it where that is too long."""
    width = max(map(len, literals)) + 1
    for index, (literal, note) in enumerate(zip(literals, notes, strict=True)):
        row = literal if index == len(literals) - 1 else f"{literal},"
        if not note.text:
            yield row
        elif width + len(note.text) <= WIDTH - 14:
            yield f"{row:<{width}}  --  {note.text}"
        else:
            yield cat(_comment(note.text), SOFT, row)


def _component(head: str, initial: Expr | None) -> Doc:
    if initial is None:
        return f"{head};"
    return group(f"{head} :=", nest(SOFT, expression(initial), by=2), ";")


def _plain_type(decl: PlainType) -> Doc:
    parts = decl.definition.replace(" range ", "\n range ").replace(" .. ", "\n.. ")
    whole, *bounds = [part.strip() for part in parts.split("\n")]
    head = f"{'subtype' if decl.subtype else 'type'} {decl.name} is"
    base = nest(SOFT, whole, *(cat(SOFT, b) for b in bounds), by=2)
    if decl.aspects:
        return group(group(head, base), _aspects(decl.aspects), ";")
    return group(head, base, ";")


_TIGHT = (Object, PlainType, Rename, UseType, Pragma)


def _alike(item: Decl, before: Decl | None) -> bool:
    """Whether an item stands with the one before; a check stands with its number."""
    match item, before:
        case (Object() | Pragma(), Object() | Pragma()):
            return True
    return isinstance(item, _TIGHT) and type(item) is type(before)


def _items(items: Sequence[Decl]) -> list[Doc]:
    """Declarations, set apart by blank lines.

    A comment belongs to the subprogram before it, or else to what follows;
    one-line neighbours of a kind stand together.
    """
    docs: list[Doc] = []
    before: Decl | None = None
    trailing = False
    for item in items:
        is_trailing = isinstance(item, Comment) and isinstance(before, Subprogram)
        led = isinstance(before, Comment) and not trailing
        alike = _alike(item, before)
        tight = before is None or is_trailing or led or alike
        docs.append(_declaration(item) if tight else cat("", SOFT, _declaration(item)))
        before, trailing = item, is_trailing
    return docs


def _package(package: Package) -> Doc:
    keyword = "package body" if package.is_body else "package"
    head = f"{keyword} {package.name}"
    aspects = cat(_aspects(package.aspects), SOFT, "is") if package.aspects else " is"
    return upright(head, aspects, _lines(_items(package.items)), SOFT, f"end {package.name};")


def _protected(decl: Protected) -> Doc:
    operations = _lines(_items(decl.items))
    if not decl.kept:
        return upright(f"protected body {decl.name} is", operations, SOFT, f"end {decl.name};")
    head = cat(_aspects(decl.aspects), SOFT, "is")
    kept = _lines(_items(decl.kept))
    parts = (f"protected {decl.name}", head, operations, SOFT, "private", kept)
    return upright(*parts, SOFT, f"end {decl.name};")


_DELTA = " with delta"
_STATIC = "with Static;"
"""What the language of the other units does not have."""


def print_item(unit: Unit) -> str:
    """The text of ``unit`` without its header and context, ending in a newline."""
    return _laid_out(_declaration(unit.item))


def print_unit(unit: Unit, item: str | None = None) -> str:
    """The text of ``unit``, ending in a newline; ``item`` is what `print_item` made of it."""
    text = print_item(unit) if item is None else item
    parts: list[Doc] = [_comment(unit.header), ""]
    if _STATIC in text:
        parts += ["pragma Ada_2022;", ""]
    elif _DELTA in text:
        parts += ["pragma Ada_2022;", 'pragma Warnings (Off, "*array aggregate using*");', ""]
    parts += [f"with {name};" for name in unit.withs]
    head = _laid_out(upright(*_join(parts)))
    gap = "\n" if unit.withs else ""
    return head + gap + text


def _laid_out(doc: Doc) -> str:
    text = laid_out(doc, WIDTH - 3)
    return "\n".join(map(str.rstrip, text.split("\n"))) + "\n"
