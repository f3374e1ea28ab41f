# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The words of the project keep the rules that a program can check."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache

import pytest

from tests.support import prose
from tests.support.prose import Sentence

LONGEST = 32
"""Words of a sentence at most; twenty is the aim."""

OPENINGS = re.compile(r"^\W*(What|That which|Nobody|There is said|There are said)\b(?!.*\?$)")

WORDS = {
    r"lanes?": "region",
    r"rivals?": "interference",
    r"goes round|going round": "step, cycle",
    r"stand-ins?|stands in for|what stands in": "fallback",
    r"so-many-eth|so manieth": "n-th",
    r"never fires?|can(not)? fire": "is never taken",
    r"is told|are told|cannot be told": "is reported, is determined",
    r"is said (once )?on": "is printed to",
    r"budgets?|(model|file) claims|claims of the (model|file)": "WCET; a budget is enforced",
    r"nobody (asked|acknowledges|reads|can)": "no node, no reader",
    r"leads nowhere": "is not connected",
    r"and here (a|no|is)\b.*(wanted|value|argument|none)": "expected ..., found ...",
}
"""Expressions that have a better word in the glossary."""

EXCEPTIONS = {
    "ravenchart": "the exit statuses are a table, printed as one paragraph",
    "gen/language/names.py": "lists of reserved words",
    "gen/files/reference.py": "tables and paragraphs of one page in one text",
    "analysis/exchange/pycpa.py": "a program for pyCPA",
}
"""Where the length does not count, and why."""

TITLES = {"What is proved", "What a command keeps"}
"""Headings that other pages link to."""

GROUPS = {
    "pages": lambda: (one for page in prose.PAGES for one in prose.of_page(page)),
    "schema": prose.of_schema,
    "help": prose.of_help,
    "messages": prose.of_messages,
    "explanations": prose.of_explanations,
}


@cache
def all_of(group: str) -> tuple[Sentence, ...]:
    """The sentences of a group; an empty group would prove nothing."""
    found = tuple(GROUPS[group]())
    assert len(found) > 100, group
    return found


def complaints(sentence: Sentence) -> Iterator[str]:
    """The rules that a sentence breaks."""
    if OPENINGS.search(sentence.text) and sentence.text not in TITLES:
        yield "name the thing first"
    for bad, better in WORDS.items():
        if found := re.search(rf"\b({bad})", sentence.text, re.I):
            yield f"`{found[0]}`: {better}"
    if sentence.length > LONGEST and sentence.location.split(":")[0] not in EXCEPTIONS:
        yield f"{sentence.length} words"


@pytest.mark.parametrize("group", GROUPS)
def test_sentences_keep_the_rules(group: str) -> None:
    broken = [
        f"{one.location}: {why}: {one.text}" for one in all_of(group) for why in complaints(one)
    ]
    assert broken == []


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("What is lost is said.", "name the thing first"),
        ("`x` never fires: its guard is false", "is never taken"),
        ("One leaf for each lane.", "region"),
        ("Two rows are above their budgets.", "WCET"),
        (" ".join(["word"] * 33), "33 words"),
    ],
)
def test_a_sentence_that_breaks_a_rule_is_found(text: str, why: str) -> None:
    (sentence,) = prose.sentences("here", text)
    assert any(why in one for one in complaints(sentence))


def test_questions_code_and_links_are_no_offence() -> None:
    text = "What is a lane? See [x](docs/nobody.md) and ``lane``."
    question, rest = prose.sentences("here", text.replace("a lane", "a region"))
    assert not list(complaints(question)) and not list(complaints(rest))
    assert rest.length == 4


def test_every_exception_is_needed() -> None:
    long = {
        one.location.split(":")[0]
        for group in GROUPS
        for one in all_of(group)
        if one.length > LONGEST
    }
    assert set(EXCEPTIONS) <= long
