# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The names of a model: where each is declared and used.

The resolver notes every name that it looks up, with the place of its declaration (`NameUse`). Here
these become characters of the files. A declaration that itself uses a name, as a required command
does with that of the dictionary, is the same symbol.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from ravenchart.gen.files import spans
from ravenchart.gen.language.names import NameUse

from .texts import FileText, TextRange

Token = tuple[str, int, int]
"""A file, the first character of a name in it, and the one behind its last."""


@dataclass(slots=True, eq=False)
class ModelSymbol:
    """A name with all its places."""

    name: str
    kind: str
    declared: Token | None
    tokens: set[Token] = field(default_factory=set)
    """The declaration among them."""


class Symbols:
    """The names of a model that something uses."""

    def __init__(self, uses: Iterable[NameUse], texts: Mapping[str, FileText]) -> None:
        """Those of ``uses``, in the files by their names."""
        self._texts = texts
        self._of: dict[Token, ModelSymbol] = {}
        self._ends: dict[object, int] = {}
        """Behind the last name that was found from a place on."""
        for use in uses:
            self._add(use)

    def all(self) -> list[ModelSymbol]:
        """Each once, in the order of their first place."""
        return list(dict.fromkeys(self._of[one] for one in sorted(self._of)))

    def at(self, file: str, offset: int) -> tuple[ModelSymbol, Token] | None:
        """The symbol at a character, or just before it, and its place there."""
        for token, symbol in self._of.items():
            if token[0] == file and token[1] <= offset <= token[2]:
                return symbol, token
        return None

    def shape(self) -> tuple[int, ...]:
        """For each name in the order of the files, the number of its symbol.

        The same after another name is used everywhere, unless names mean something else then.
        """
        numbers: dict[int, int] = {}
        ordered = sorted(self._of)
        return tuple(numbers.setdefault(id(self._of[one]), len(numbers)) for one in ordered)

    def _add(self, use: NameUse) -> None:
        place = self._place(use)
        declared = self._declaration(use)
        known = {id(s): s for t in (place, declared) if t and (s := self._of.get(t))}
        symbols = list(known.values())
        symbol = symbols[0] if symbols else ModelSymbol(use.name, use.kind, declared)
        for other in symbols[1:]:
            symbol.tokens |= other.tokens
            for token in other.tokens:
                self._of[token] = symbol
        if declared is not None:
            symbol.declared = declared
        for own in (place, declared):
            if own is not None:
                symbol.tokens.add(own)
                self._of[own] = symbol

    def _place(self, use: NameUse) -> Token | None:
        """Where the name stands: behind those that were looked up there before it."""
        file, text = use.origin.file, self._texts.get(use.origin.file)
        if text is None:
            return None
        start = text.offset(use.origin)
        scalar = text.scalar_at(start)
        end = start + len(use.name) if scalar is None else scalar.end
        exact = _word(text, use, start, start + len(use.name))
        found: TextRange | None = None
        if exact is None or (file, start, use.name.lower()) in self._ends:
            found = _word(text, use, max(start, self._ends.get((file, start), start)), end)
        found = found or exact or _word(text, use, start, end)
        if found is None:
            return None
        self._ends[file, start] = self._ends[file, start, use.name.lower()] = found[1]
        return file, *found

    def _declaration(self, use: NameUse) -> Token | None:
        at = use.declared
        text = None if at is None else self._texts.get(at.file)
        if at is None or text is None:
            return None
        start = text.offset(at)
        if use.within:
            literal = _literal(text, start, use.name)
            return None if literal is None else (at.file, literal.start, literal.end)
        scalar = text.scalar_at(start)
        end = start + len(use.name) if scalar is None else scalar.end
        found = text.word(use.name, start, end)
        return None if found is None else (at.file, *found)


def _word(text: FileText, use: NameUse, start: int, end: int) -> TextRange | None:
    """The first place of a name that is used; of an array it is without number or star."""
    if use.of_array:
        return text.array(use.name, start, end)
    return text.word(use.name, start, end)


def _literal(text: FileText, start: int, name: str) -> spans.YamlScalar | None:
    """The literal of that name in the type whose key begins there."""
    types = None if text.root is None else text.root.mapping("types")
    for key, form in () if types is None else types.mappings():
        values = form.get("values")
        if key.start == start and isinstance(values, spans.Sequence):
            literals = (one for one in values.items if isinstance(one, spans.YamlScalar))
            return next((one for one in literals if one.value.lower() == name.lower()), None)
    return None
