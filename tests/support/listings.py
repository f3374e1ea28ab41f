# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The listings of the docs: each with its page, line and language."""

from __future__ import annotations

import re
import shlex
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ravenchart.gen.files.located import grow, grow_list
from ravenchart.paths import ROOT

PAGES = (
    *sorted(ROOT.glob("*.md")),
    *sorted(ROOT.glob("docs/*.md")),
    *sorted(ROOT.glob("examples/**/*.md")),
    ROOT / "proofs" / "assumptions.md",
    ROOT / "ravenchart" / "commands" / "new_project" / "README.md",
)
MODELS = ROOT / "tests" / "listings"
"""Models with places for listings."""
PLACE = "listing"
"""The key of such a place: which listing stands there, and the warnings that its page names."""
LISTING = re.compile(r"^( *)```(\S*)[^\n]*\n(.*?)^ *```$", re.M | re.S)
ASSIGNMENT = re.compile(r"\w+=\S*")


@dataclass(frozen=True, slots=True)
class Listing:
    """One listing; ``line`` is that of its fence."""

    page: str
    line: int
    language: str
    text: str

    @property
    def first(self) -> str:
        """Its first line, by which a test names it."""
        return self.text.partition("\n")[0]

    @property
    def key(self) -> tuple[str, str]:
        """Page and first line."""
        return self.page, self.first


@cache
def listings() -> tuple[Listing, ...]:
    """Those of all pages, in order."""
    return tuple(one for page in PAGES for one in listings_of(page))


def listings_of(page: Path) -> Iterator[Listing]:
    """Those of one page."""
    text = page.read_text(encoding="utf-8")
    for found in LISTING.finditer(text):
        line = text.count("\n", 0, found.start()) + 1
        name = page.relative_to(ROOT).as_posix()
        yield Listing(name, line, found[2], textwrap.dedent(found[3]))


@cache
def one_of(page: str, words: str, language: str = "yaml") -> Listing:
    """The listing of a page that has these words."""
    found = [
        one for one in listings()
        if (one.page, one.language) == (page, language) and words in one.text
    ]  # fmt: skip
    assert len(found) == 1, f"{len(found)} listings of {page} have `{words}`"
    return found[0]


def tree_of(text: str, file: str) -> Any:
    """A YAML text as the tool reads it; `...` stands for keys that a page leaves out."""
    read = grow_list if re.match(r"(#.*\n)*- ", text) else grow
    tree, found = read(text.replace("{..., ", "{"), file)
    assert tree is not None and found == [], found
    return tree


@dataclass(frozen=True, slots=True)
class Filled:
    """A model of `tests/listings` with the listings in its places."""

    name: str
    tree: Any
    listings: tuple[Listing, ...]
    warnings: frozenset[str]
    """Codes of the warnings that the page names."""


def filled(path: Path) -> Filled:
    """The model in that file; each mapping with the key PLACE gets a listing."""
    places: list[dict[str, str]] = []

    def with_listings(node: Any) -> Any:
        if isinstance(node, list):
            return [with_listings(one) for one in node]
        if not isinstance(node, dict):
            return node
        found = {key: with_listings(value) for key, value in node.items() if key != PLACE}
        if PLACE not in node:
            return found
        places.append(node[PLACE])
        part = one_of(node[PLACE]["of"], node[PLACE]["with"])
        return joined(found, tree_of(part.text, part.page))

    tree = with_listings(tree_of(path.read_text(encoding="utf-8"), path.name))
    return Filled(
        path.stem,
        tree,
        tuple(one_of(place["of"], place["with"]) for place in places),
        frozenset(place["warns"] for place in places if "warns" in place),
    )


def joined(model: Any, part: Any) -> Any:
    """A model with a part; the model may not give a value that the part gives."""
    if isinstance(model, dict) and isinstance(part, dict):
        both = {key: joined(model[key], part[key]) for key in model.keys() & part.keys()}
        return {**model, **part, **both}
    assert isinstance(model, list) and isinstance(part, list), (model, part)
    return [*model, *part]


def script(listing: Listing) -> str:
    """What a shell reads of a listing: of a session the lines behind the prompt."""
    if listing.language != "console":
        return listing.text
    lines = (line for line in listing.text.splitlines() if line.startswith("$ "))
    return "".join(f"{line.removeprefix('$ ')}\n" for line in lines)


def calls(text: str) -> Iterator[list[str]]:
    """The words of each call in a script, without variables, `sudo` and what is the shell's."""
    return map(called, whole_calls(text))


def whole_calls(text: str) -> Iterator[list[str]]:
    """All words of each call in a script."""
    for line in text.replace("\\\n", " ").splitlines():
        lexer = shlex.shlex(line, posix=True, punctuation_chars=True)
        lexer.whitespace_split = True
        words: list[str] = []
        for word in (*lexer, ";"):
            if re.fullmatch(r"[|&;]+", word):
                if words:
                    yield words
                words = []
            else:
                words.append(word)


def called(words: list[str]) -> list[str]:
    """One call, from its program to where its output goes."""
    while ASSIGNMENT.fullmatch(words[0]) or words[0] == "sudo":
        words = words[1:]
    ends = [n for n, word in enumerate(words) if re.fullmatch(r"[<>]+", word)]
    if not ends:
        return words
    numbered = words[ends[0] - 1] in ("1", "2")  # of the stream
    return words[: ends[0] - numbered]


def written_to(words: list[str]) -> str | None:
    """The file that a call writes its standard output to."""
    for one, word, file in zip(words, words[1:], words[2:], strict=False):
        if word == ">" and one != "2":
            return file
    return None


def listing(page: str, name: str) -> str:
    """The listing of ``docs/PAGE`` below a line that ends with its name, as `name`:."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    found = re.search(rf"`{re.escape(name)}`:\n\n```\w*\n(.*?)^```$", text, re.M | re.S)
    assert found is not None, name
    return found[1]
