"""The pages about the command line are what the command line is."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from ravenchart import failures, start
from ravenchart.command_line import whole_parser
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


def test_the_help_fits_a_terminal(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit):
        whole_parser().parse_args(["--help"])
    told = capsys.readouterr().out
    assert max(map(len, told.splitlines())) <= 80
    read = " ".join(told.split())
    for status, meaning in MEANINGS.items():
        assert f" {status} {meaning}" in read


FENCE = re.compile(r"^```(?:sh|console|bash)?\n(.*?)^```$", re.M | re.S)
"""A listing of commands: one without a language, or with that of a shell."""
PAGES = (*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("examples/**/*.md"))


def calls(text: str) -> list[list[str]]:
    """The words of each call of `ravenchart` in the listings, without what is the shell's."""
    found = []
    for block in FENCE.findall(text):
        for line in block.replace("\\\n", " ").splitlines():
            for part in re.split(r"\||&&|;", line):
                call = re.match(r"\s*(?:\$ )?(?:[\w./]*/)?ravenchart (.*)", part)
                if call:
                    words = shlex.split(call[1], comments=True)
                    ends = (n for n, word in enumerate(words) if re.match(r"\d?>", word))
                    found.append(words[: next(ends, len(words))])
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: f"{page.parent.name}-{page.stem}")
def test_every_call_in_a_listing_is_one_that_the_program_takes(page: Path) -> None:
    parser = whole_parser()
    for words in calls(page.read_text(encoding="utf-8")):
        assert parser.parse_args(words).command, words


def test_a_call_with_an_option_that_is_not_there_is_refused() -> None:
    told = calls("```\n$ .venv/bin/ravenchart check m.yaml --gone > out.txt  # why\n```\n")
    assert told == [["check", "m.yaml", "--gone"]]
    with pytest.raises(SystemExit):
        whole_parser().parse_args(told[0])
