"""The pages about the command line are what the command line is."""

from __future__ import annotations

import re

import pytest

from ravenchart import failures, start
from ravenchart.failures import MEANINGS, STATUSES
from ravenchart.paths import ROOT
from ravenchart.reference import pages

PAGE = ROOT / "docs" / "command-line.md"


@pytest.mark.parametrize("name", sorted(pages()))
def test_page_made_of_the_command_line_is_up_to_date(name: str) -> None:
    written = (ROOT / "docs" / name).read_text(encoding="utf-8")
    assert written == pages()[name], "run `make docs`"


def test_the_table_of_exit_statuses_is_that_of_the_help() -> None:
    text = PAGE.read_text(encoding="utf-8").partition("## Exit statuses")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| ([\d, ]+) \| (.*) \|$", text, re.M)
    assert {status: meaning.replace("\\|", "|") for status, meaning in rows} == dict(MEANINGS)
    for status, meaning in MEANINGS.items():
        assert re.search(rf"^  {status} +{re.escape(meaning)}$", STATUSES, re.M)


def test_every_status_of_the_program_has_a_meaning() -> None:
    named = {failures.OK, failures.WRONG, failures.UNUSABLE, failures.NOT_JUDGED, failures.INTERNAL}
    named |= {start.SIGNALLED + number for number in (1, 2, 13, 15)}
    assert {int(one) for words in MEANINGS for one in words.split(", ")} == named
