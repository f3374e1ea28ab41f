# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The calls of `ravenchart` in the listings of the docs, and how the tests make them real."""

from __future__ import annotations

import shlex
import tomllib
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from ravenchart.paths import ROOT

from .listings import called, listings, script, whole_calls, written_to

TABLE = ROOT / "tests" / "listings" / "calls.toml"

HERE = {"analyse", "check", "check-certificate", "explain", "generate", "simulate"}
"""Commands that take seconds and leave the examples as they are."""


@dataclass(frozen=True, slots=True)
class Call:
    """One call of a page."""

    page: str
    words: tuple[str, ...]
    into: str | None
    """The file that its standard output goes to."""

    @property
    def text(self) -> str:
        """As the table names it."""
        return shlex.join(self.words) + (f" > {self.into}" if self.into else "")

    @property
    def is_here(self) -> bool:
        """Whether it is quick, and names files of this repository or none."""
        if self.words[0] not in HERE:
            return False
        if self.words[0] == "explain":
            return "--out" not in self.words and self.into is None
        return self.words[1].startswith(("examples/", "tests/"))


@dataclass(frozen=True, slots=True)
class How:
    """How a call is executed, or why it is not."""

    status: int | list[int] = 0
    """Those that the page implies."""
    why: str = ""
    """The reason of a status other than 0."""
    until: str = ""
    """It goes on: Ctrl-C ends it once it has printed this expression."""
    says: str = ""
    """An expression that it prints."""
    shown: bool = False
    """It prints each line that its listing shows."""
    beside: str = ""
    """A call that runs meanwhile, until Ctrl-C; `monitor --once` finds its controllers."""
    given: str = ""
    """Its standard input; `listed`: the lines of its listing behind `> `."""
    inside: str = "."
    """The folder inside that of the page in which it is called."""
    programs: dict[str, str] = field(default_factory=dict)
    """Programs of the model that run meanwhile, by a part of their path: files of snapshots."""
    line: str = ""
    """A recorded trace that a board writes to its serial line meanwhile."""
    excused: str = ""
    """Why no test of the docs executes it: a key of `reasons`."""
    test: str = ""
    """The test file that covers the same path in another way."""
    has: str = ""
    """What stands in that file."""
    words: dict[str, str] = field(default_factory=dict)
    """Real values of words of this call, before those of its page."""


@dataclass(frozen=True, slots=True)
class Page:
    """The folder of a page, and its calls."""

    calls: dict[str, How]
    folder: str = "."
    """Where it is called: an example that was copied, or a new folder."""
    words: dict[str, str] = field(default_factory=dict)
    """Real values of words of the page."""
    listed: dict[str, str] = field(default_factory=dict)
    """Files that are listings of the page, each with words of it."""
    written: dict[str, str] = field(default_factory=dict)
    """Files that the page supposes."""
    before: dict[str, str] = field(default_factory=dict)
    """Files that the page supposes, each with the call that makes it."""


@cache
def calls_of_pages() -> tuple[Call, ...]:
    """Those of all listings, each once, in their order."""
    found = {
        Call(one.page, tuple(called(words)[1:]), written_to(words)): None
        for one in listings()
        if one.language in ("sh", "console")
        for words in whole_calls(script(one))
        if called(words)[0].removeprefix(".venv/bin/") == "ravenchart"
    }
    return tuple(found)


@cache
def table() -> tuple[dict[str, Page], dict[str, str]]:
    """The pages, and the reasons by their names."""
    whole = tomllib.loads(TABLE.read_text(encoding="utf-8"))
    reasons: dict[str, str] = whole.pop("reasons")
    return {name: _page(one) for name, one in whole.items()}, reasons


def _page(given: dict[str, Any]) -> Page:
    calls = {text: How(**how) for text, how in given.pop("calls").items()}
    return Page(calls, **given)


def listed_text(page: str, words: str) -> str:
    """The one listing of a page that has these words."""
    found = [one.text for one in listings() if one.page == page and words in one.text]
    assert len(found) == 1, f"{len(found)} listings of {page} have `{words}`"
    return found[0]


def session(call: Call) -> list[str]:
    """The lines behind a call in its listing."""
    return listed_text(call.page, f"$ ravenchart {call.text}\n").splitlines()[1:]


def prompted(call: Call) -> str:
    """What a reader types in the session that a call begins."""
    return "".join(f"{line[2:]}\n" for line in session(call) if line.startswith("> "))
