# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The printer of statements, declarations and units, over that of expressions.

Three spaces, 79 columns, one statement a line; long parameter lists and
expressions break one item a line (`layout` decides).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

from .declarations import (
    AbstractState,
    ArrayDefinition,
    Aspect,
    Decl,
    Definition,
    DerivedDefinition,
    EnumType,
    FunctionRenaming,
    GenericInstance,
    IndexConstrained,
    ModularDefinition,
    Object,
    ObjectRenaming,
    Package,
    PackageRenaming,
    Param,
    Protected,
    RangeDefinition,
    RecordDeclaration,
    SingleTask,
    Subprogram,
    Subtype,
    SubtypeDeclaration,
    TypeDeclaration,
    Unit,
    UsePackage,
    UseType,
)
from .expression_text import (
    argument,
    argument_layout,
    behind_name,
    choice_text,
    choices_text,
    expr_layout,
    flat,
    selector_of,
    with_arguments,
)
from .expressions import (
    Aggregate,
    Arg,
    CaseExpr,
    Expr,
    ForAll,
    ForSome,
    IfExpr,
    RangeConstrained,
    StringLiteral,
)
from .layout import (
    SOFT,
    STEP,
    Doc,
    cat,
    filled,
    group,
    joined,
    laid_out,
    nest,
    pad,
    parenthesized,
    stacked,
    upright,
)
from .named import ref
from .statements import (
    NULL,
    Assign,
    Case,
    Comment,
    DelayUntil,
    Do,
    ExitStatement,
    ForLoop,
    IfStatement,
    Loop,
    NullStatement,
    Pragma,
    RaiseStatement,
    Return,
    Stmt,
)
from .walking import nodes_in

WIDTH = 79


@lru_cache(maxsize=8192)
def _comment(text: str) -> Doc:
    """Its lines; one that begins with spaces keeps them, and goes on two columns further."""
    lines: list[str] = []
    for paragraph in text.split("\n"):
        line = margin = paragraph[: len(paragraph) - len(paragraph.lstrip())]
        for word in paragraph.split():
            if line.strip() and len(line) + 1 + len(word) > WIDTH - 10:
                lines.append(line)
                line = f"{margin}  {word}" if margin else word
            else:
                line = f"{line} {word}" if line.strip() else line + word
        lines.append(line)
    return upright(*joined([f"--  {line}".rstrip() for line in lines]))


def _block(statements: Sequence[Stmt]) -> Doc:
    return stacked([statement(s) for s in statements or (NULL,)])


def statement(stmt: Stmt) -> Doc:
    """The layout of one statement."""
    match stmt:
        case Assign(target, value):
            return group(f"{flat(target)} :=", nest(SOFT, expr_layout(value), by=2), ";")
        case Do(name, args):
            return with_arguments(name.text, args, ";") if args else f"{name.text};"
        case IfStatement(branches, otherwise):
            parts: list[Doc] = []
            for index, (condition, body) in enumerate(branches):
                head = group(
                    "if " if index == 0 else "elsif ",
                    nest(expr_layout(condition)),
                    SOFT,
                    "then",
                )
                parts += [head, _block(body), SOFT]
            if otherwise:
                parts += ["else", _block(otherwise), SOFT]
            return upright(*parts, "end if;")
        case Case(selector, branches):
            rows = [
                upright(group("when ", nest(choices_text(choices, " =>"))), _block(body))
                for choices, body in branches
            ]
            return upright("case ", expr_layout(selector), " is", stacked(rows), SOFT, "end case;")
        case Loop(head, body):
            return upright(f"{_head(head)}loop", _block(body), SOFT, "end loop;")
        case Return(value):
            if value is None:
                return "return;"
            return group("return", nest(SOFT, expr_layout(value), by=2), ";")
        case Pragma(name, args):
            return _pragma(name, args)
        case Comment(text):
            return _comment(text)
    return f"{_simple(stmt)};"


def _head(head: ForLoop | None) -> str:
    return "" if head is None else f"for {head.variable} in {choice_text(head.domain)} "


def _simple(stmt: NullStatement | ExitStatement | DelayUntil | RaiseStatement) -> str:
    """A statement of a few words, without its semicolon."""
    match stmt:
        case NullStatement():
            return "null"
        case ExitStatement(condition):
            return "exit" if condition is None else f"exit when {flat(condition)}"
        case DelayUntil(time):
            return f"delay until {flat(time)}"
        case RaiseStatement(exception, words):
            return f"raise {exception.text} with {flat(words)}"


def _pragma(name: str, args: Sequence[Expr | Arg]) -> Doc:
    if not args:
        return f"pragma {name};"
    docs = [
        f"{selector_of(a)} => {flat(a.value)}" if isinstance(a, Arg) else expr_layout(a)
        for a in args
    ]
    return behind_name(f"pragma {name}", docs, ";")


@lru_cache(maxsize=8192)
def _aspects(aspects: Sequence[Aspect]) -> Doc:
    docs = [
        a.name if a.value is None else group(f"{a.name} =>", nest(SOFT, _given_to(a.value), by=2))
        for a in aspects
    ]
    return cat(SOFT, group("with", nest(SOFT, *joined(docs, ","), by=2)))


def _given_to(value: Expr | AbstractState) -> Doc:
    if isinstance(value, AbstractState):
        return f"({value.name} with {', '.join(value.options)})"
    return expr_layout(value)


@lru_cache(maxsize=8192)
def _params(params: Sequence[Param]) -> Doc:
    """All on one line; or one on each line, their colons below each other."""
    width = max(len(p.name) for p in params)
    docs = [cat(p.name, pad(width - len(p.name)), f" : {_formal(p)}") for p in params]
    return group("(", nest(*joined(docs, ";"), by=1), ")")


def _formal(param: Param) -> str:
    """The mode, type and default of a parameter, as they stand behind the colon."""
    mode = "" if param.mode == "in" else f"{param.mode} "
    default = "" if param.default is None else f" := {flat(param.default)}"
    return f"{mode}{flat(param.type)}{default}"


def _subprogram(sub: Subprogram) -> Doc:
    keyword = "function" if sub.result else "procedure"
    profile = [_params(sub.params)] if sub.params else []
    profile += [f"return {sub.result.text}"] if sub.result else []
    head = group(f"{keyword} {sub.name}", _profile(profile))
    aspects = _aspects(sub.aspects) if sub.aspects else ""
    if sub.expression is not None:
        inner = expr_layout(sub.expression)
        if not isinstance(sub.expression, (IfExpr, CaseExpr, ForAll, ForSome)):
            inner = parenthesized(inner)
        if not any(aspect.value for aspect in sub.aspects):
            aspects = group(aspects)
        return upright(group(head, " is", nest(SOFT, inner, by=2)), aspects, ";")
    if sub.body is None:
        return upright(head, aspects, ";")
    declarations = stacked(_items(sub.declarations))
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


def _task(task: SingleTask) -> Doc:
    if task.body is None:
        return upright(f"task {task.name}", _aspects(task.aspects), ";")
    begin = SOFT, "begin", _block(task.body), SOFT
    return upright(f"task body {task.name} is", *begin, f"end {task.name};")


def _profile(parts: Sequence[Doc]) -> Doc:
    """Parameters and result: behind the name, or below it."""
    first, *rest = parts or ("",)
    behind = (group(SOFT, part) for part in rest)
    return nest(SOFT, first, *behind, by=2) if parts else ""


def _object(decl: Object) -> Doc:
    """An object; its name and type stand below each other where no line holds both."""
    of_type = [] if decl.type is None else [" ".join(_subtype(decl.type))]
    words = " ".join([*(["constant"] if decl.constant else []), *of_type])
    start: list[Doc] = [f"{decl.name} : {words}"]
    if len(f"{decl.name} : {words} :=") > WIDTH - STEP:
        start = [upright(f"{decl.name} :", nest(SOFT, words, by=2))]
    if decl.value is not None:
        start += [" :=", nest(SOFT, expr_layout(decl.value), by=2)]
    return group(*start, _aspects(decl.aspects) if decl.aspects else "", ";")


def _declaration(decl: Decl | PackageRenaming) -> Doc:
    match decl:
        case EnumType():
            return _enumeration(decl)
        case TypeDeclaration(name, definition):
            return _is(f"type {name} is", _subtype(definition))
        case SubtypeDeclaration(name, base, aspects):
            return _is(f"subtype {name} is", _subtype(base), aspects)
        case RecordDeclaration(name, ()):
            return f"type {name} is null record;"
        case RecordDeclaration(name, components):
            width = max(len(c.name) for c in components)
            rows = [
                _component(f"{c.name:<{width}} : {' '.join(_subtype(c.type))}", c.initial)
                for c in components
            ]
            return upright(f"type {name} is record", stacked(rows), SOFT, "end record;")
        case Object():
            return _object(decl)
        case Subprogram():
            return _subprogram(decl)
        case GenericInstance(name, generic, args, kind):
            head = f"{kind} {name} is new {generic.text}"
            return group(head, nest(SOFT, argument_layout([argument(a) for a in args]), by=2), ";")
        case Package() | Protected() | SingleTask():
            return _enclosing(decl)
        case FunctionRenaming() | ObjectRenaming() | PackageRenaming():
            return _renaming(decl)
        case UseType(name) | UsePackage(name):
            return f"use {'type ' if isinstance(decl, UseType) else ''}{name.text};"
        case Pragma(name, args):
            return _pragma(name, args)
        case Comment(text):
            return _comment(text)


def _enclosing(decl: Package | Protected | SingleTask) -> Doc:
    match decl:
        case Package():
            return _package(decl)
        case Protected():
            return _protected(decl)
        case SingleTask():
            return _task(decl)


def _enumeration(decl: EnumType) -> Doc:
    if not decl.notes:
        items = nest(filled(decl.literals), by=1)
        return group(f"type {decl.name} is", nest(SOFT, group("(", items, ");"), by=2))
    noted = _annotated(decl.literals, decl.notes)
    rows = nest(*joined(list(noted)), by=1)
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
    return group(f"{head} :=", nest(SOFT, expr_layout(initial), by=2), ";")


def _subtype(decl: Subtype | Definition) -> list[str]:
    """A subtype or the definition of a type, in the pieces between which a line may end."""
    match decl:
        case RangeConstrained(mark, bounds):
            return [mark.text, f"range {flat(bounds.low)}", f".. {flat(bounds.high)}"]
        case IndexConstrained(mark, bounds):
            return [f"{mark.text} ({choice_text(bounds)})"]
        case RangeDefinition(bounds):
            return [f"range {flat(bounds.low)}", f".. {flat(bounds.high)}"]
        case DerivedDefinition(parent):
            return [f"new {parent.text}"]
        case ModularDefinition(modulus):
            return [f"mod {flat(modulus)}"]
        case ArrayDefinition(index, component):
            return [f"array ({choice_text(index)}) of {component.text}"]
    return [flat(decl)]


def _renaming(decl: FunctionRenaming | ObjectRenaming | PackageRenaming) -> Doc:
    match decl:
        case FunctionRenaming(name, result):
            head = f"function {name} return {result.text}"
        case ObjectRenaming(name, of_type):
            head = f"{name} : {of_type.text}"
        case PackageRenaming(package):
            head = f"package {package.text}"
    return group(head, nest(SOFT, f"renames {decl.renamed.text};", by=2))


def _is(head: str, pieces: Sequence[str], aspects: Sequence[Aspect] = ()) -> Doc:
    """The declaration of a type."""
    base = nest(SOFT, pieces[0], *(cat(SOFT, piece) for piece in pieces[1:]), by=2)
    if aspects:
        return group(group(head, base), _aspects(tuple(aspects)), ";")
    return group(head, base, ";")


_TYPES = (TypeDeclaration, SubtypeDeclaration)
_TIGHT = (_TYPES, Object, FunctionRenaming, UseType, Pragma)
"""No blank line separates two declarations of one of these kinds."""


def _alike(item: Decl, before: Decl | None) -> bool:
    """Whether an item stands with the one before; a check stands with its number."""
    match item, before:
        case (Object() | Pragma(), Object() | Pragma()):
            return True
    return any(isinstance(item, kind) and isinstance(before, kind) for kind in _TIGHT)


def _items(items: Sequence[Decl]) -> list[Doc]:
    """Declarations, set apart by blank lines.

    A comment belongs to the subprogram before it, or else to the declaration that follows;
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
    head = f"{keyword} {package.name.text}"
    aspects = cat(_aspects(package.aspects), SOFT, "is") if package.aspects else " is"
    return upright(head, aspects, stacked(_items(package.items)), SOFT, f"end {package.name.text};")


def _protected(decl: Protected) -> Doc:
    operations = stacked(_items(decl.items))
    if not decl.kept:
        return upright(f"protected body {decl.name} is", operations, SOFT, f"end {decl.name};")
    head = cat(_aspects(decl.aspects), SOFT, "is")
    kept = stacked(_items(decl.kept))
    parts = (f"protected {decl.name}", head, operations, SOFT, "private", kept)
    return upright(*parts, SOFT, f"end {decl.name};")


@dataclass(frozen=True, slots=True)
class PrintedItem:
    """The text of what a unit consists of, and the pragmas that it asks for before the context."""

    text: str
    pragmas: tuple[Pragma, ...]


_NEWER = Pragma("Ada_2022")
"""For constructs that Ada 2012, the language of the other units, does not have."""
_OF_ARRAYS = Pragma("Warnings", (ref("Off"), StringLiteral("*array aggregate using*")))


OF_PREFIXES = Pragma("Warnings", (ref("Off"), StringLiteral("no entities of*")))
"""For a renamed package that is only a prefix: the compiler takes it for unused."""
_IN_SPARK = Pragma("SPARK_Mode")
"""For a renaming, which has no aspect of that name."""


def _language(unit: Unit) -> tuple[Pragma, ...]:
    """The pragmas that static functions, delta aggregates or a renaming ask for."""
    if isinstance(unit.item, PackageRenaming):
        return (_IN_SPARK,)
    changing = False
    for node in nodes_in(unit.item):
        if isinstance(node, Aspect) and node.name == "Static":
            return (_NEWER,)
        changing |= isinstance(node, Aggregate) and node.base is not None
    return (_NEWER, _OF_ARRAYS) if changing else ()


def print_item(unit: Unit) -> PrintedItem:
    """``unit`` without its header and context; its text ends in a newline."""
    return PrintedItem(_laid_out(_declaration(unit.item)), _language(unit))


def print_unit(unit: Unit, item: PrintedItem | None = None) -> str:
    """The text of ``unit``, ending in a newline; ``item`` is what `print_item` made of it."""
    printed = print_item(unit) if item is None else item
    parts: list[Doc] = [_comment(unit.header), ""]
    if printed.pragmas:
        parts += [*map(_declaration, printed.pragmas), ""]
    parts += [f"with {name.text};" for name in unit.withs]
    head = _laid_out(upright(*joined(parts)))
    gap = "\n" if unit.withs else ""
    return head + gap + printed.text


def _laid_out(doc: Doc) -> str:
    text = laid_out(doc, WIDTH - 3)
    return "\n".join(map(str.rstrip, text.split("\n"))) + "\n"
