# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names in generated Ada: identifiers, and what is named by several of them."""

from __future__ import annotations

from functools import lru_cache

from ravenchart.gen.frozen import frozen
from ravenchart.gen.language.names import RESERVED


@frozen
class DottedName:
    """An identifier, or identifiers joined by dots; made by `ref`."""

    parts: tuple[str, ...]

    @property
    def text(self) -> str:
        """The name as it is printed."""
        return ".".join(self.parts)

    @property
    def first(self) -> str:
        """The identifier that must be visible where the name stands."""
        return self.parts[0]

    @property
    def last(self) -> str:
        """The last identifier, without the units or records around it."""
        return self.parts[-1]

    @property
    def parent(self) -> DottedName:
        """The name before the last dot; of a child unit, its parent."""
        return DottedName(self.parts[:-1])

    @property
    def file_stem(self) -> str:
        """GNAT's name for the files of a unit of this name, without an extension."""
        return "-".join(self.parts).lower()

    def __lt__(self, other: DottedName) -> bool:
        """The order of the texts: a dot comes before all that identifiers consist of."""
        return self.parts < other.parts


Named = DottedName | str
"""A name, or the text of one: constructors take both wherever a name is meant."""


def ref(*parts: Named) -> DottedName:
    """The name that these parts are when joined by dots; each may be several identifiers."""
    if len(parts) == 1:
        (only,) = parts
        return only if isinstance(only, DottedName) else _parsed(only)
    found: tuple[str, ...] = ()
    for part in parts:
        found += (part if isinstance(part, DottedName) else _parsed(part)).parts
    return DottedName(found)


@lru_cache(maxsize=65_536)
def _parsed(text: str) -> DottedName:
    return DottedName(tuple(map(identifier, text.split("."))))


@lru_cache(maxsize=65_536)
def identifier(text: str) -> str:
    """The text, which must be an identifier: an expression or a reserved word is none."""
    assert text.lower() not in RESERVED, f"a reserved word of Ada: {text!r}"
    return word(text)


def word(text: str) -> str:
    """The text, which must have the form of an identifier. It may be a reserved word: `X'Range`."""
    has_form = text.isascii() and text.isidentifier() and "__" not in f"_{text}_"
    assert has_form, f"no identifier of Ada: {text!r}"
    return text


def defining(name: Named) -> str:
    """The identifier that a declaration introduces."""
    (only,) = ref(name).parts
    return only
