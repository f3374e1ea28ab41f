# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The words that could stand at a location of a model, and the meaning of the key there.

A word that no model has is put at the location, and the model is read. The proposals are the
words that the forms and the resolver would have taken instead. So they are exactly the names that
are allowed there, without a second description of the language.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from ravenchart.gen.files.forms import keys_beside, words_for
from ravenchart.gen.files.located import Map, grow
from ravenchart.gen.files.spans import YamlMapping

from .model import Open, model
from .texts import FileText, path_to

WORD = "Zz_Any_Word_Zz"
_BEFORE = re.compile(r"\w*\Z")
_BEHIND = re.compile(r"\w*")


@dataclass(frozen=True, slots=True)
class CompletionProposal:
    """A word that could stand at a place; ``detail`` is its kind, or what the key means."""

    word: str
    detail: str
    is_key: bool = False


def proposals(path: Path, file: str, offset: int, documents: Open) -> list[CompletionProposal]:
    """The words that could stand at a character of an open file of the model at ``path``."""
    text = documents[file]
    found: dict[str, CompletionProposal] = {}
    for one in (*_keys(text, offset), *_values(path, file, offset, documents)):
        found.setdefault(one.word.lower(), one)
    return list(found.values())


def key_meaning(text: str, offset: int) -> str | None:
    """The meaning of the key at a character; None of anything else, and of names."""
    whole = FileText(text)
    scalar = whole.scalar_at(offset)
    if scalar is None:
        return None
    made = text[: scalar.start] + WORD + text[scalar.end :]
    return _keys_in(made).get(scalar.value)


def _word(text: str, offset: int) -> tuple[int, int]:
    """The word around a character."""
    before, behind = _BEFORE.search(text, 0, offset), _BEHIND.match(text, offset)
    return before.start() if before else offset, behind.end() if behind else offset


def _keys(text: str, offset: int) -> list[CompletionProposal]:
    """The keys, where the word is a key that is being written."""
    start, end = _word(text, offset)
    line_start = text.rfind("\n", 0, start) + 1
    head, tail = text[line_start:start], text[end:].partition("\n")[0]
    is_line = not head.strip(" -") and not tail.strip()
    in_braces = head.rstrip()[-1:] in ("{", ",")
    if tail.lstrip().startswith(":"):
        made = text[:start] + WORD + text[end:]
    elif is_line or in_braces:
        made = f"{text[:start]}{WORD}: {WORD}{text[end:]}"
    else:
        return []
    there = _siblings(made, start)
    told = _keys_in(made)
    return [
        CompletionProposal(key, meant, is_key=True)
        for key, meant in told.items()
        if key not in there
    ]


def _keys_in(text: str) -> dict[str, str]:
    tree, _ = grow(text, "")
    return keys_beside(tree, WORD) if isinstance(tree, Map) else {}


def _siblings(text: str, offset: int) -> set[str]:
    """The keys of the mapping in which the one at a character stands."""
    root = FileText(text).root
    path = path_to(root, offset) if isinstance(root, YamlMapping) else []
    return {key.value for key, _ in path[-1][0].entries} if path else set()


def _values(path: Path, file: str, offset: int, documents: Open) -> list[CompletionProposal]:
    """The names and words, where the word is part of a value."""
    text = documents[file]
    start, end = _word(text, offset)
    made = text[:start] + WORD + text[end:]
    changed = {**documents, file: made}
    found = [
        CompletionProposal(name, one.kind)
        for one in model(path, changed).loaded.unknown
        if one.name == WORD
        for name in one.known
    ]
    tree, _ = grow(made, "")
    words = words_for(tree, WORD) if isinstance(tree, Map) else ()
    return found + [CompletionProposal(word, "word of the language") for word in words]
