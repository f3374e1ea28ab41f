# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Another name for an element of a model, everywhere.

The changed texts are loaded before the editor gets them. Where that finds an error that was not
there, or a name that would mean something else than before, nothing is changed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from ravenchart.gen.language.names import problem_of
from ravenchart.gen.pipeline import Loaded

from .model import Open, OpenModel, model, real
from .symbols import ModelSymbol, Token
from .texts import TextRange


class NotRenamedError(Exception):
    """A name cannot be changed; the message says why."""


def renamed(
    now: OpenModel, symbol: ModelSymbol, new: str, documents: Open
) -> Mapping[str, list[TextRange]]:
    """Where the new name goes in each file, by its absolute name."""
    if symbol.declared is None:
        raise NotRenamedError(f"no file of the model declares `{symbol.name}`")
    problem = problem_of(new)
    if problem is not None:
        raise NotRenamedError(problem[1])
    places: dict[str, list[TextRange]] = {}
    for file, start, end in sorted(symbol.tokens):
        places.setdefault(file, []).append((start, end))
    changed = dict(documents)
    for file, spans in places.items():
        changed[real(file)] = _exchanged(now.texts[file].text, spans, new)
    after = model(now.path, changed)
    found = _news(now.loaded, after.loaded)
    if found is not None:
        raise NotRenamedError(f"with this name there would be an error: {found}")
    if after.symbols.shape() != now.symbols.shape():
        raise NotRenamedError(f"with the name `{new}` something would mean another element")
    return {real(file): spans for file, spans in places.items()}


def _exchanged(text: str, spans: list[TextRange], new: str) -> str:
    for start, end in reversed(spans):
        text = text[:start] + new + text[end:]
    return text


def _news(before: Loaded, after: Loaded) -> str | None:
    """An error that was not there before."""
    was = Counter(one.code for one in before.diagnostics if one.is_error)
    for one in after.diagnostics:
        if one.is_error:
            was[one.code] -= 1
            if was[one.code] < 0:
                return f"{one.message} [{one.code}]"
    return None


def place_of(token: Token) -> TextRange:
    """The characters of a place."""
    return token[1], token[2]
