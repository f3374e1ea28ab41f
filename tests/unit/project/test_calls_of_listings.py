# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Calls in the docs are executed: quick ones here, others by tests/system/test_page_calls.py."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.command_line import main
from ravenchart.paths import ROOT
from tests.support.page_calls import HERE, TABLE, calls_of_pages, table

CALLS = sorted({one.words for one in calls_of_pages() if one.is_here})
OTHERS = {(one.page, one.text): one for one in calls_of_pages() if not one.is_here}
PAGES, REASONS = table()
TABLED = {(name, text): how for name, page in PAGES.items() for text, how in page.calls.items()}


@pytest.mark.parametrize("words", CALLS, ids=" ".join)
def test_a_call_of_the_docs_succeeds(
    words: tuple[str, ...],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    named = [
        str(ROOT / word) if word.startswith(("examples/", "tests/")) else word for word in words
    ]
    assert main(named) == 0
    assert capsys.readouterr().out or list(tmp_path.iterdir())
    if "--html" in words:
        assert (tmp_path / words[words.index("--html") + 1]).is_file()


def test_every_other_call_is_in_the_table_and_no_call_that_no_page_has() -> None:
    assert len(CALLS) > 15
    assert {words[0] for words in CALLS} <= HERE
    assert OTHERS.keys() - TABLED.keys() == set(), f"not in {TABLE.name}"
    assert TABLED.keys() - OTHERS.keys() == set(), f"in {TABLE.name}, and on no page"


def test_every_call_that_is_not_executed_has_a_reason_and_a_test_of_the_same_command() -> None:
    excused = {at: how for at, how in TABLED.items() if how.excused}
    assert {how.excused for how in excused.values()} == set(REASONS)
    for at, how in excused.items():
        text = (ROOT / how.test).read_text(encoding="utf-8")
        assert how.has and how.has in text, at
    assert len(excused) < len(TABLED) / 3


def test_every_word_that_is_replaced_is_on_its_page() -> None:
    for name, page in PAGES.items():
        executed = [text for text, how in page.calls.items() if not how.excused]
        for word in page.words:
            assert any(word in text for text in executed), (name, word)
        for text, how in page.calls.items():
            assert all(word in text for word in how.words), (name, text)
            assert isinstance(how.status, list) or how.status in (0, 130) or how.why, (name, text)
            assert not isinstance(how.status, list) or how.why, (name, text)
