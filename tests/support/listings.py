# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The listings of the docs: each with its page, line and language."""

from __future__ import annotations

import re
import shlex
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass

from ravenchart.paths import ROOT

PAGES = (
    *sorted(ROOT.glob("*.md")),
    *sorted(ROOT.glob("docs/*.md")),
    *sorted(ROOT.glob("examples/**/*.md")),
    ROOT / "proofs" / "assumptions.md",
    ROOT / "ravenchart" / "commands" / "new_project" / "README.md",
)
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


def listings() -> Iterator[Listing]:
    """Those of all pages, in order."""
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        for found in LISTING.finditer(text):
            line = text.count("\n", 0, found.start()) + 1
            name = page.relative_to(ROOT).as_posix()
            yield Listing(name, line, found[2], textwrap.dedent(found[3]))


def script(listing: Listing) -> str:
    """What a shell reads of a listing: of a session the lines behind the prompt."""
    if listing.language != "console":
        return listing.text
    lines = (line for line in listing.text.splitlines() if line.startswith("$ "))
    return "".join(f"{line.removeprefix('$ ')}\n" for line in lines)


def calls(text: str) -> Iterator[list[str]]:
    """The words of each call in a script, without variables, `sudo` and what is the shell's."""
    for line in text.replace("\\\n", " ").splitlines():
        lexer = shlex.shlex(line, posix=True, punctuation_chars=True)
        lexer.whitespace_split = True
        words: list[str] = []
        for word in (*lexer, ";"):
            if re.fullmatch(r"[|&;]+", word):
                if words:
                    yield called(words)
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


def listing(page: str, name: str) -> str:
    """The listing of ``docs/PAGE`` below a line that ends with its name, as `name`:."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    found = re.search(rf"`{re.escape(name)}`:\n\n```\w*\n(.*?)^```$", text, re.M | re.S)
    assert found is not None, name
    return found[1]
