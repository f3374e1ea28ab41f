# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The code of an Ada source or project, without its comments and its layout.

Lexical elements as in the Ada reference manual, 2.2: an apostrophe behind a name, a string, ``@``
or a closing bracket belongs to an attribute or a qualified expression. Any other begins a character
literal, also behind a reserved word other than ``all``.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence

from ravenchart.gen.language.names import RESERVED

_RESERVED = frozenset(word.encode() for word in RESERVED - {"all"})

_ELEMENTS = re.compile(
    rb"""(?P<skipped>\s+|--[^\n]*)
    | (?P<word>[\w\#\x80-\xff]+(?:\.\d[\w\#]*)?)
    | (?P<text>"[^"\n]*")
    | (?P<character>'.')
    | (?P<other>=>|\.\.|\*\*|:=|/=|>=|<=|<<|>>|<>|.)""",
    re.VERBOSE | re.DOTALL,
)


def elements(source: bytes) -> list[bytes]:
    """The lexical elements in order."""
    found: list[bytes] = []
    at, named = 0, False
    while at < len(source):
        if named and source[at : at + 1] == b"'":
            kind, element, at = "other", b"'", at + 1
        else:
            match = _ELEMENTS.match(source, at)
            assert match is not None and match.lastgroup is not None
            kind, element, at = match.lastgroup, match[0], match.end()
        if kind == "skipped":
            continue
        found.append(element)
        named = kind == "text" or element in (b")", b"]", b"@") or _is_name(kind, found)
    return found


def _is_name(kind: str, found: Sequence[bytes]) -> bool:
    """Whether the last element is a name or a number; behind an apostrophe it is an attribute."""
    attribute = len(found) > 1 and found[-2] == b"'"
    return kind == "word" and (attribute or found[-1].lower() not in _RESERVED)


def digest(source: bytes) -> str:
    """SHA-256 of the code: the same where only comments and layout differ."""
    return hashlib.sha256(b"\n".join(elements(source))).hexdigest()


def is_package_renaming(source: bytes) -> bool:
    """Whether a unit renames a package, and so has no code that a proof could be about."""
    found = elements(source)
    head = found[found.index(b"package") :] if b"package" in found else []
    return b"renames" in head and b"is" not in head
