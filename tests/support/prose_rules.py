# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The rules of the project's English that a program can check.

``python -P -m tests.support.prose_rules [PATH]`` lists each sentence that breaks one, below PATH.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from functools import cache

from . import prose
from .prose import Sentence

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
    r"and here is nothing": "but is empty",
}
"""Expressions that have a better word in the glossary."""

ADA_WORDS = {r"tells?|told(?!:)": "notifies, reports, distinguishes"}
"""The same, in hand-written Ada only."""

EXCEPTIONS = {
    "ravenchart": "the exit statuses are a table, printed as one paragraph",
    "gen/language/names.py": "lists of reserved words",
    "gen/emit/ada/naming.py": "names that generated packages have for themselves",
    "gen/emit/language/own_names.py": "names that generated packages have for themselves",
    "gen/emit/nodes/project.py": "templates of project files",
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
    "comments": prose.of_comments,
    "templates": prose.of_templates,
    "ada": prose.of_ada,
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
    is_ada = re.search(r"^(?!.*/generated/).*\.(ad[sb]|gpr):", sentence.location)
    for bad, better in (WORDS | ADA_WORDS if is_ada else WORDS).items():
        if found := re.search(rf"\b({bad})", sentence.text, re.I):
            yield f"`{found[0]}`: {better}"
    if sentence.length > LONGEST and sentence.location.split(":")[0] not in EXCEPTIONS:
        yield f"{sentence.length} words"


def broken(group: str, below: str = "") -> Iterator[str]:
    """The sentences of a group that break a rule, each with its location and the rule."""
    for one in all_of(group):
        if one.location.startswith(below):
            yield from (f"{one.location}: {why}: {one.text}" for why in complaints(one))


def main() -> None:
    """List what breaks a rule."""
    below = sys.argv[1] if len(sys.argv) > 1 else ""
    for group in GROUPS:
        for line in broken(group, below):
            print(line)


if __name__ == "__main__":
    main()
