# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The declared form of a chart, read from generated Ada text.

The reader takes the types of the states and the functions `In_Source`, `Enabled`, `Target` and
`Is_Deferral` from the specs of a component and of one of its regions. The proof rests on these.
Guards stay text.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from lark import Lark, Token, Transformer, v_args
from lark.exceptions import LarkError
from lark.tree import Meta

GRAMMAR = r"""
enumeration: "type" NAME "is" "(" NAME ("," NAME)* ")"
composite: "subtype" NAME "is" NAME "range" NAME ".." NAME
region: NAME ":" NAME ":=" NAME
sources: _HEAD _profile _cases _aspect?
conditions: _HEAD _profile "(" NAME _group _AND_THEN _cases ")" _aspect?
deferrals: _HEAD _profile "(" deferred ")" _aspect?
deferred: NAME ("=" | "in") NAME ("|" NAME)*
_aspect: "with" NAME
_cases: "(" "case" NAME "is" condition ("," condition)* ")"
moves: _HEAD _profile "(" "case" NAME "is" move ("," move)* ")"

_HEAD: /function\s+\w+/
_profile: "(" _parameter (";" _parameter)* ")" "return" NAME "is"
_parameter: NAME ":" NAME
condition: "when" NAME ("|" NAME)* _ARROW conjunct (_AND_THEN conjunct)*
move: "when" NAME ("|" NAME)* _ARROW (conjunct | configuration)
configuration: "(" [NAME _DELTA] leaf ("," leaf)* ")"
leaf: NAME _ARROW conjunct
conjunct: _piece+
_piece: NAME | NUMBER | SIGN | _group
_group: "(" (_piece | "," | _AND_THEN)* ")"

_ARROW.2: "=>"
_AND_THEN.2: /and\s+then\b/
_DELTA.2: /with\s+delta\b/
SIGN: "/=" | "<=" | ">=" | ".." | "=" | "<" | ">" | "+" | "-" | "*" | "/" | "|" | "'"
NUMBER: /[0-9][0-9_]*/
NAME: /[A-Za-z]\w*(\.[A-Za-z]\w*)*/
%ignore /\s+/
"""

Leaves = dict[str, str]
"""A leaf, or a call that gives one, for each component of a configuration."""


class NotDeclaredError(ValueError):
    """The text is not that of a generated region; the message says what is missing."""


@dataclass(frozen=True, slots=True)
class DeclaredComposite:
    """A composite state: a range of the leaves of ``outer``, a composite or a type of leaves."""

    name: str
    outer: str
    first: str
    last: str


@dataclass(frozen=True, slots=True)
class DrawnRegion:
    """A component of the configuration: the type of its leaves, the leaf it starts with."""

    component: str
    type: str
    default: str


@dataclass(frozen=True, slots=True)
class Declared:
    """The declared form: the states, and for each transition its conditions and its move.

    A move is one leaf or call where a chart has no orthogonal regions.
    """

    title: str
    leaves: dict[str, tuple[str, ...]]
    composites: tuple[DeclaredComposite, ...]
    regions: tuple[DrawnRegion, ...]
    conditions: dict[str, tuple[str, ...]]
    moves: dict[str, str | Leaves]
    deferrals: frozenset[str]
    """The transitions that keep their event for later."""


@v_args(meta=True)
class _Reader(Transformer[Token, object]):
    """Builds the meaning of each declaration; conjuncts are slices of the text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.text = text

    def conjunct(self, meta: Meta, _: Sequence[object]) -> str:
        """One condition or value, as written."""
        return " ".join(self.text[meta.start_pos : meta.end_pos].split())

    def enumeration(self, _: Meta, names: Sequence[Token]) -> tuple[str, tuple[str, ...]]:
        """A type and its literals."""
        return str(names[0]), tuple(map(str, names[1:]))

    def composite(self, _: Meta, names: Sequence[Token]) -> DeclaredComposite:
        """A range of leaves."""
        return DeclaredComposite(*map(str, names))

    def region(self, _: Meta, names: Sequence[Token]) -> DrawnRegion:
        """A component of a configuration."""
        return DrawnRegion(*map(str, names))

    def condition(self, _: Meta, parts: Sequence[str]) -> dict[str, tuple[str, ...]]:
        """Transitions and their conjuncts."""
        said = tuple(part for part in parts if not isinstance(part, Token))
        return {str(part): said for part in parts if isinstance(part, Token)}

    def leaf(self, _: Meta, parts: Sequence[str]) -> tuple[str, str]:
        """A component and its leaf."""
        return str(parts[0]), parts[1]

    def configuration(self, _: Meta, parts: Sequence[object]) -> Leaves:
        """A leaf for each component that does not stay as it was."""
        return dict(part for part in parts if isinstance(part, tuple))

    def move(self, _: Meta, parts: Sequence[object]) -> dict[str, object]:
        """Transitions and where they lead."""
        return {str(name): parts[-1] for name in parts[:-1]}

    def sources(self, _: Meta, parts: Sequence[object]) -> dict[str, object]:
        """`In_Source`."""
        return _rows(parts)

    def conditions(self, _: Meta, parts: Sequence[object]) -> dict[str, object]:
        """`Enabled`."""
        return _rows(parts)

    def moves(self, _: Meta, parts: Sequence[object]) -> dict[str, object]:
        """`Target`."""
        return _rows(parts)

    def deferred(self, _: Meta, names: Sequence[Token]) -> frozenset[str]:
        """The transitions with which a parameter is compared."""
        return frozenset(map(str, names[1:]))

    def deferrals(self, _: Meta, parts: Sequence[object]) -> frozenset[str]:
        """`Is_Deferral`."""
        return next(part for part in parts if isinstance(part, frozenset))


def _rows(parts: Sequence[object]) -> dict[str, object]:
    """The alternatives of a case, by transition."""
    rows = [part for part in parts if isinstance(part, dict)]
    return {name: said for row in rows for name, said in row.items()}


_ENUMERATION = re.compile(r"type \w+ is \(")
_COMPOSITE = re.compile(r"subtype \w+ is \w+ range")
_COMPONENT = re.compile(r"\w+ : \w+ := \w+$")
_RECORD = re.compile(r"type \w+ is record ")
_PARSER = Lark(
    GRAMMAR,
    parser="lalr",
    start=["enumeration", "composite", "region", "sources", "conditions", "moves", "deferrals"],
    propagate_positions=True,
)


def declared(spec: str, component: str) -> Declared:
    """The declared form in the specs of a region and of its component."""
    spec, component = _plain(spec), _plain(component)
    package = re.search(r"\bpackage ([\w.]+) with", spec)
    functions = [_function(name, spec) for name in ("In_Source", "Enabled", "Target")]
    states = re.search(r": (\w+_States)\.", spec)
    inside = states and re.search(rf"\bpackage {states[1]} is (.*) end {states[1]};", component)
    if not (package and all(functions) and inside):
        raise NotDeclaredError("no functions Enabled and Target over the states of a region")
    sources, conditions, moves = map(_read, ("sources", "conditions", "moves"), functions)
    deferrals = _function("Is_Deferral", spec)  # a region without deferrals has none
    parts = [_RECORD.sub("", part) for part in _declarations(inside[1])]
    return Declared(
        ".".join(package[1].split(".")[-2:]),
        dict(_read("enumeration", part) for part in parts if _ENUMERATION.match(part)),
        tuple(_read("composite", part) for part in parts if _COMPOSITE.match(part)),
        tuple(_read("region", part) for part in parts if _COMPONENT.match(part)),
        {name: (*sources.get(name, ()), *said) for name, said in conditions.items()},
        moves,
        _read("deferrals", deferrals) if deferrals else frozenset(),
    )


def _function(name: str, spec: str) -> str:
    """The declaration of a function; its parameter `Self`, the region, says nothing more."""
    found = re.search(rf"\bfunction {name} .*", spec)
    return next(_declarations(found[0])).replace("Self.", "") if found else ""


def _plain(text: str) -> str:
    """Ada text without comments and line breaks."""
    return " ".join(re.sub(r"--[^\n]*", "", text).split())


def _declarations(text: str) -> Iterator[str]:
    """The parts of a text that semicolons end, those in parentheses aside."""
    depth = start = 0
    for index, character in enumerate(text):
        depth += (character == "(") - (character == ")")
        if character == ";" and depth == 0:
            yield text[start:index].strip()
            start = index + 1


def _read(kind: str, text: str) -> Any:
    """The meaning of a declaration of that kind."""
    try:
        return _Reader(text).transform(_PARSER.parse(text, start=kind))
    except LarkError as problem:
        raise NotDeclaredError(f"its {kind} are not of the declared form: {problem}") from problem
