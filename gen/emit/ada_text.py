"""The printer of the Ada constructs: the only place that knows about layout.

Three spaces, 79 columns, one statement a line; long parameter lists and
expressions break one item a line (a Wadler-Lindig pretty printer decides).
"""

from __future__ import annotations

from collections.abc import Sequence

import wadler_lindig as wl

from .ada import (
    NULL,
    Aggregate,
    Arg,
    Aspect,
    Assign,
    Call,
    Case,
    CaseExpr,
    Chain,
    Comment,
    Decl,
    Do,
    EnumType,
    Expr,
    ForAll,
    ForSome,
    If,
    IfExpr,
    Instance,
    Loop,
    Object,
    Package,
    Param,
    PlainType,
    Pragma,
    Prefix,
    RecordType,
    Ref,
    Rename,
    Return,
    Say,
    Stmt,
    Subprogram,
    Unit,
    UseType,
    arguments,
)

WIDTH = 79
STEP = 3
ONE_LINE = 60
"""Longer parameter lists go one to a line."""

Doc = wl.AbstractDoc
SOFT = wl.BreakDoc(" ")
CUT = wl.BreakDoc("")


def _text(text: str) -> Doc:
    return wl.TextDoc(text)


def _cat(*docs: Doc | str) -> Doc:
    children = tuple(_text(d) if isinstance(d, str) else d for d in docs)
    return wl.ConcatDoc(children=children)  # type: ignore[no-untyped-call]


def _nest(doc: Doc, by: int = STEP) -> Doc:
    return wl.NestDoc(doc, by)


def _group(doc: Doc) -> Doc:
    return wl.GroupDoc(doc)


def _join(docs: Sequence[Doc], separator: str) -> Doc:
    parts: list[Doc] = []
    for index, doc in enumerate(docs):
        last = index == len(docs) - 1
        parts += [doc] if last else [doc, _text(separator), SOFT]
    return _cat(*parts)


def _lines(docs: Sequence[Doc]) -> Doc:
    """Each on a line of its own, nested, with a line break before each."""
    return _nest(_cat(*(_cat(SOFT, d) for d in docs)))


def _upright(doc: Doc) -> Doc:
    return wl.GroupDoc(doc, force_vertical=True)


def _args(args: Sequence[Arg]) -> Doc:
    return _cat("(", _nest(_join([_arg(a) for a in args], ","), 1), ")")


def _arg(arg: Arg) -> Doc:
    value = expression(arg.value)
    return value if arg.name is None else _group(_cat(arg.name, " =>", _nest(_cat(SOFT, value), 2)))


_RELATIONS = ("=", "/=", "<", "<=", ">", ">=", "in", "not in")
_LOGICAL = ("and then", "or else")


def _operand(expr: Expr, operator: str = "") -> Doc:
    """One operand; no parentheses where the precedence of Ada is plain to a reader."""
    doc = expression(expr)
    plain = not isinstance(expr, Chain) or (operator in _LOGICAL and expr.operator in _RELATIONS)
    return doc if plain else _cat("(", _nest(doc, 1), ")")


def _signed(expr: Expr, operator: str = "") -> Doc:
    """An operand after an operator: there Ada has no sign, ``abs`` or ``not`` of its own."""
    nested = isinstance(expr, Prefix) and (expr.operator == "-" or not operator)
    return _bare(expression(expr)) if nested else _operand(expr, operator)


def _bare(doc: Doc) -> Doc:
    """Between parentheses, one column in."""
    return _group(_cat("(", _nest(doc, 1), ")"))


def expression(expr: Expr) -> Doc:
    """The layout of one expression."""
    match expr:
        case Ref(text):
            return _text(text)
        case Chain(operator, operands):
            head = _operand(operands[0], operator)
            rest = [_signed(o, operator) for o in operands[1:]]
            return _group(_cat(head, *(_cat(SOFT, f"{operator} ", _nest(r, 2)) for r in rest)))
        case Prefix(operator, operand):
            return _cat(operator if operator == "-" else f"{operator} ", _signed(operand))
        case Call(name, args):
            return _group(_cat(name, _nest(_cat(SOFT, _args(args)), 2)))
        case Aggregate(args, of_type):
            return _group(_cat(f"{of_type}'" if of_type else "", _args(args)))
        case IfExpr(branches, otherwise):
            parts = [
                _cat(
                    "if " if i == 0 else "elsif ",
                    _nest(expression(c)),
                    _nest(_cat(SOFT, "then ", _nest(expression(v)))),
                )
                for i, (c, v) in enumerate(branches)
            ]
            if otherwise is not None:
                parts.append(_cat("else ", _nest(expression(otherwise))))
            return _bare(_join(parts, ""))
        case CaseExpr(selector, branches):
            rows = [
                _group(_cat(f"when {choice} =>", _nest(_cat(SOFT, expression(value)))))
                for choice, value in branches
            ]
            body = _nest(_cat(SOFT, _join(rows, ",")), 2)
            return _upright(
                _cat("(", _nest(_cat("case ", expression(selector), " is", body), 1), ")")
            )
        case ForAll(variable, domain, condition) | ForSome(variable, domain, condition):
            word = "all" if isinstance(expr, ForAll) else "some"
            return _bare(
                _cat(
                    f"for {word} {variable} in {domain} =>",
                    _nest(_cat(SOFT, expression(condition))),
                )
            )


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
    return _upright(_cat(*_between([_text(f"--  {line}".rstrip()) for line in lines])))


def _between(docs: Sequence[Doc]) -> list[Doc]:
    out: list[Doc] = []
    for index, doc in enumerate(docs):
        out += [doc] if index == 0 else [SOFT, doc]
    return out


def _block(statements: Sequence[Stmt]) -> Doc:
    return _lines([statement(s) for s in statements or (NULL,)])


def statement(stmt: Stmt) -> Doc:
    """The layout of one statement."""
    match stmt:
        case Assign(target, value):
            return _group(_cat(f"{target} :=", _nest(_cat(SOFT, expression(value)), 2), ";"))
        case Do(name, ()):
            return _text(f"{name};")
        case Do(name, args):
            return _group(_cat(name, _nest(_cat(SOFT, _args(args)), 2), ";"))
        case If(branches, otherwise):
            parts: list[Doc] = []
            for index, (condition, body) in enumerate(branches):
                head = _group(
                    _cat(
                        "if " if index == 0 else "elsif ",
                        _nest(expression(condition)),
                        SOFT,
                        "then",
                    )
                )
                parts += [head, _block(body), SOFT]
            if otherwise:
                parts += [_text("else"), _block(otherwise), SOFT]
            return _upright(_cat(*parts, "end if;"))
        case Case(selector, branches):
            rows = [_upright(_cat(f"when {choice} =>", _block(body))) for choice, body in branches]
            return _upright(
                _cat("case ", expression(selector), " is", _lines(rows), SOFT, "end case;")
            )
        case Loop(head, body):
            start = f"{head} loop" if head else "loop"
            return _upright(_cat(start, _block(body), SOFT, "end loop;"))
        case Say(text):
            return _text(f"{text};")
        case Return(value):
            return _group(_cat("return", _nest(_cat(SOFT, expression(value)), 2), ";"))
        case Pragma(name, args):
            return _pragma(name, args)
        case Comment(text):
            return _comment(text)


def _pragma(name: str, args: Sequence[Expr]) -> Doc:
    if not args:
        return _text(f"pragma {name};")
    return _group(_cat(f"pragma {name}", _nest(_cat(SOFT, _args(arguments(*args))), 2), ";"))


def _aspects(aspects: Sequence[Aspect]) -> Doc:
    docs = [
        _text(a.name)
        if a.value is None
        else _group(_cat(f"{a.name} =>", _nest(_cat(SOFT, expression(a.value)), 2)))
        for a in aspects
    ]
    return _cat(SOFT, _group(_cat("with", _nest(_cat(SOFT, _join(docs, ",")), 2))))


def _params(params: Sequence[Param]) -> Doc:
    texts = [f"{'' if p.mode == 'in' else p.mode + ' '}{p.type}" for p in params]
    plain = sum(len(p.name) + len(t) + 5 for p, t in zip(params, texts, strict=True))
    #  names are padded only where each stands on a line of its own
    width = max(len(p.name) for p in params) if plain > ONE_LINE else 0
    docs = [_text(f"{p.name:<{width}} : {t}") for p, t in zip(params, texts, strict=True)]
    return _nest(_cat(SOFT, "(", _nest(_join(docs, ";"), 1), ")"), 2)


def _subprogram(sub: Subprogram) -> Doc:
    keyword = "function" if sub.result else "procedure"
    head = _group(
        _cat(
            f"{keyword} {sub.name}",
            _params(sub.params) if sub.params else "",
            _nest(_cat(SOFT, f"return {sub.result}"), 2) if sub.result else "",
        )
    )
    aspects = _aspects(sub.aspects) if sub.aspects else _text("")
    if sub.expression is not None:
        inner = expression(sub.expression)
        if not isinstance(sub.expression, (IfExpr, CaseExpr, ForAll, ForSome)):
            inner = _bare(inner)
        body = _cat(head, " is", _nest(_cat(SOFT, inner), 2))
        return _upright(_cat(_group(body), aspects, ";"))
    if sub.body is None:
        return _upright(_cat(head, aspects, ";"))
    declarations = _lines([_declaration(d) for d in sub.declarations])
    start = [SOFT, _text("is")] if sub.aspects else [_text(" is")]
    return _upright(
        _cat(
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
    )


def _declaration(decl: Decl) -> Doc:
    match decl:
        case EnumType(name, literals):
            items = _nest(_join([_text(i) for i in literals], ","), 1)
            return _group(_cat(f"type {name} is", _nest(_cat(SOFT, "(", items, ");"), 2)))
        case PlainType(name, definition, subtype):
            parts = f"{definition};".replace(" range ", "\n range ").replace(" .. ", "\n.. ")
            whole, *bounds = [_text(part.strip()) for part in parts.split("\n")]
            head = f"{'subtype' if subtype else 'type'} {name} is"
            return _group(_cat(head, _nest(_cat(SOFT, whole, *(_cat(SOFT, b) for b in bounds)), 2)))
        case RecordType(name, ()):
            return _text(f"type {name} is null record;")
        case RecordType(name, components):
            width = max(len(c.name) for c in components)
            rows = [_component(f"{c.name:<{width}} : {c.type}", c.initial) for c in components]
            body = _cat(_text("record"), _lines(rows), SOFT, "end record;")
            return _upright(_cat(f"type {name} is ", body))
        case Object(name, type_name, value, constant, aspects):
            words = [w for w in ("constant" if constant else "", type_name or "") if w]
            head = f"{name} : {' '.join(words)}"
            start = (
                _text(head)
                if value is None
                else _cat(f"{head} :=", _nest(_cat(SOFT, expression(value)), 2))
            )
            return _group(_cat(start, _aspects(aspects) if aspects else "", ";"))
        case Subprogram():
            return _subprogram(decl)
        case Instance(name, generic, args, kind):
            head = f"{kind} {name} is new {generic}"
            return _group(_cat(head, _nest(_cat(SOFT, _args(args)), 2), ";"))
        case Package():
            return _package(decl)
        case Rename(name, other):
            return _text(f"package {name} renames {other};")
        case UseType(name):
            return _text(f"use type {name};")
        case Pragma(name, args):
            return _pragma(name, args)
        case Comment(text):
            return _comment(text)


def _component(head: str, initial: Expr | None) -> Doc:
    if initial is None:
        return _text(f"{head};")
    return _group(_cat(f"{head} :=", _nest(_cat(SOFT, expression(initial)), 2), ";"))


_TIGHT = (Object, PlainType, Rename, UseType, Pragma)


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
        alike = isinstance(item, _TIGHT) and type(item) is type(before)
        tight = before is None or is_trailing or led or alike
        docs.append(_declaration(item) if tight else _cat("", SOFT, _declaration(item)))
        before, trailing = item, is_trailing
    return docs


def _package(package: Package) -> Doc:
    keyword = "package body" if package.is_body else "package"
    head = _cat(f"{keyword} {package.name}")
    aspects = _cat(_aspects(package.aspects), SOFT, "is") if package.aspects else _text(" is")
    return _upright(
        _cat(head, aspects, _lines(_items(package.items)), SOFT, f"end {package.name};")
    )


def print_item(unit: Unit) -> str:
    """The text of ``unit`` without its header and context, ending in a newline."""
    return _laid_out(_declaration(unit.item))


def print_unit(unit: Unit, item: str | None = None) -> str:
    """The text of ``unit``, ending in a newline; ``item`` is what `print_item` made of it."""
    parts: list[Doc] = [_comment(unit.header), _text("")]
    parts += [_text(f"with {name};") for name in unit.withs]
    head = _laid_out(_upright(_cat(*_between(parts))))
    gap = "\n" if unit.withs else ""
    return head + gap + (print_item(unit) if item is None else item)


def _laid_out(doc: Doc) -> str:
    text = wl.pformat(doc, width=WIDTH - 3)
    return "\n".join(line.rstrip() for line in text.split("\n")) + "\n"
