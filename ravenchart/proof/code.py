# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The code of an Ada source or project, without its comments and its layout.

Lexical elements as in the Ada reference manual, 2.2: an apostrophe behind a name or a closing
parenthesis belongs to an attribute, any other begins a character literal.
"""

from __future__ import annotations

import hashlib
import re

_ELEMENTS = re.compile(
    rb"""(?P<skipped>\s+|--[^\n]*)
    | (?P<word>[\w\#]+(?:\.\d[\w\#]*)?)
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
        named = kind in ("word", "text") or element in (b")", b"]")
    return found


def digest(source: bytes) -> str:
    """SHA-256 of the code: the same where only comments and layout differ."""
    return hashlib.sha256(b"\n".join(elements(source))).hexdigest()
