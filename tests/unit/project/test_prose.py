# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The words of the project keep the rules that a program can check."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support import prose
from tests.support.prose_rules import EXCEPTIONS, GROUPS, LONGEST, all_of, broken, complaints


@pytest.mark.parametrize("group", GROUPS)
def test_sentences_keep_the_rules(group: str) -> None:
    assert list(broken(group)) == []


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


def test_comments_of_ada_are_texts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(prose, "ROOT", tmp_path)
    monkeypatch.setattr(prose, "ADA", (".",))
    (tmp_path / "a.ads").write_text(
        "--  SPDX-License-Identifier: Apache-2.0\n\n"
        "--  First\n--  line. Second.\n--\n"
        "--  Guarantees   one\n--               text\n--  Timing       none\n--\n"
        "--     row      of a table,\n--              continued\n--     other row\n\n"
        "   ---------\n   -- Box --\n   ---------\n\n"
        '   A : String := "--  no";  --  [a.tell] see b.tell and\n'
        "                            --  the next line\n"
        "   B : Character := '-';  --  another\n"
        "   --  one more\n"
    )
    assert [(one.location, one.text) for one in prose.of_ada()] == [
        ("a.ads:3", "First line."),
        ("a.ads:3", "Second."),
        ("a.ads:6", "one text"),
        ("a.ads:8", "none"),
        ("a.ads:10", "row of a table, continued"),
        ("a.ads:12", "other row"),
        ("a.ads:18", "see X and the next line"),
        ("a.ads:20", "another"),
        ("a.ads:21", "one more"),
    ]


def test_every_exception_is_needed() -> None:
    long = {
        one.location.split(":")[0]
        for group in GROUPS
        for one in all_of(group)
        if one.length > LONGEST
    }
    assert set(EXCEPTIONS) <= long
