# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The pages about the command line are what the command line is."""

from __future__ import annotations

import re
from argparse import ArgumentParser, _SubParsersAction
from collections.abc import Iterator

import pytest

from ravenchart import failures, start
from ravenchart.command_line import COMMANDS, whole_parser
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


def parsers(parser: ArgumentParser) -> Iterator[ArgumentParser]:
    """A parser and those of all its commands, however deep."""
    yield parser
    for action in parser._actions:
        if isinstance(action, _SubParsersAction):
            for sub in dict.fromkeys(action.choices.values()):
                yield from parsers(sub)


PARSERS = tuple(parsers(whole_parser()))


@pytest.mark.parametrize("parser", PARSERS, ids=lambda parser: parser.prog)
def test_usage_and_help_of_every_command_fit_a_terminal(
    parser: ArgumentParser, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    told = parser.format_usage() + parser.format_help()
    assert [line for line in told.splitlines() if len(line) > 80] == []


def test_the_help_of_every_command_is_measured() -> None:
    names = {parser.prog.removeprefix("ravenchart").strip() for parser in PARSERS}
    assert names == {"", *COMMANDS}


def test_the_help_has_the_exit_statuses(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    read = " ".join(whole_parser().format_help().split())
    for status, meaning in MEANINGS.items():
        assert f" {status} {meaning}" in read
