# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Small breaks of Ada that people wrote: one operator, constant or statement of a subprogram."""

from __future__ import annotations

import re
from collections.abc import Iterator

from .mutants import Found, Mutant, numbered
from .texts import Span, WrittenBody, replaced, written_bodies

_REPLACED = {
    "comparison": {" < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > "},
    "equality": {" = ": " /= ", " /= ": " = "},
    "number": {" + 1": " + 2", " - 1": " - 2", ":= 0;": ":= 1;"},
    "sign": {" + ": " - ", " - ": " + "},
    "connective": {" and then ": " or else ", " or else ": " and then ", " not ": " "},
    "truth": {"True": "False", "False": "True"},
}
"""Kind to what stands for what."""
_HEXADECIMAL = re.compile(r"16#([0-9A-F_]+)#")
_STATEMENT = re.compile(r"^ +((?:delay until )?[A-Z][^\n:]*(?::=[^\n]*)?;)$", re.M)
_TASK = re.compile(r"^( *)task body (\w+) is\n(.*?)^\1end \2;$", re.M | re.S)
KINDS = (*_REPLACED, "hexadecimal", "left out")
_PROOF_ONLY = re.compile(
    r"^ *(?:--.*|Lemma_.*|pragma (?:Assert|Loop_|Annotate)[^;]*;)$|\bwith Ghost\b", re.M
)
"""Comments, and what a compiler without assertions leaves out."""


def mutants_of(file: str, text: str) -> list[Mutant]:
    """Every mutant of a unit, kind by kind; the same text gives the same ones."""
    bodies = [(b.name, b.inner) for b in written_bodies(text) if not _is_ghost(text, b)]
    bodies += [(match[2], Span(*match.span(3))) for match in _TASK.finditer(text)]
    hidden = [Span(*match.span()) for match in _PROOF_ONLY.finditer(text)]
    found: list[Mutant] = []
    for kind in KINDS:
        places: dict[Span, Found] = {}
        for name, inner in bodies:  # one inside another comes behind it
            for rule, span, other in _breaks(kind, text, inner):
                if not any(h.start <= span.start < h.end for h in hidden):
                    places[span] = (name, rule, replaced(span, other))
        found += numbered(kind, "code", file, iter(places.values()))
    return found


def _is_ghost(text: str, body: WrittenBody) -> bool:
    """Is it there for proof alone?"""
    contract = body.whole.of(text)
    if not body.is_expression:
        contract = re.split(r"\bis\n", contract, maxsplit=1)[0]
    return body.name.startswith("Lemma_") or re.search(r"\bGhost\b", contract) is not None


def _breaks(kind: str, text: str, inner: Span) -> Iterator[tuple[str, Span, str]]:
    """Rule, place and text of each break of a kind."""
    if kind == "hexadecimal":
        for match in _HEXADECIMAL.finditer(text, inner.start, inner.end):
            value = int(match[1].replace("_", ""), 16)
            yield "another last bit", Span(*match.span()), f"16#{value ^ 1:X}#"
    elif kind == "left out":
        for match in _STATEMENT.finditer(text, inner.start, inner.end):
            if match[1].count("(") == match[1].count(")"):
                yield "left out", Span(*match.span(1)), "null;"
    else:
        for old, new in _REPLACED[kind].items():
            pattern = re.escape(old) + (r"\b" if old[-1].isalnum() else "")
            for match in re.compile(pattern).finditer(text, inner.start, inner.end):
                yield f"{old.strip()} becomes {new.strip() or 'nothing'}", Span(*match.span()), new
