# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The manual page: whole, and without a complaint of the programs that format it."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from ravenchart.command_line import whole_parser
from ravenchart.failures import MEANINGS
from ravenchart.grammar import grammar
from ravenchart.paths import ROOT

PAGE = ROOT / "docs" / "ravenchart.1"
SECTIONS = (
    *("NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "COMMANDS"),
    *("EXIT STATUS", "ENVIRONMENT", "FILES", "SEE ALSO"),
)


def plain() -> str:
    """The page without its fonts."""
    text = re.sub(r"\\f[BRI]", "", PAGE.read_text(encoding="utf-8"))
    return text.replace(r"\-", "-").replace(r"\&", "")


def test_the_sections_are_those_of_a_manual_page() -> None:
    assert tuple(re.findall(r"^\.SH (.*)$", plain(), re.M)) == SECTIONS


def test_every_command_option_and_status_is_in_it() -> None:
    text = plain()
    for command in grammar(whole_parser()).commands:
        part = text.partition(f"\n.SS {command.name}\n")[2].partition("\n.S")[0]
        assert f"ravenchart {command.name}" in part
        for word in command.options:
            if "--help" not in word.flags:
                assert re.search(rf"^{re.escape(', '.join(word.flags))}\b", part, re.M), word
    for status in MEANINGS:
        assert f"\n{status}\n" in text


@pytest.mark.parametrize(
    "words", [("groff", "-ww", "-man", "-Tutf8", "-z"), ("mandoc", "-Tlint"), ("man", "-l")]
)
def test_programs_format_it_without_complaint(words: tuple[str, ...]) -> None:
    if shutil.which(words[0]) is None:
        pytest.skip(f"{words[0]} is not on PATH")
    done = subprocess.run([*words, PAGE], capture_output=True, text=True, cwd=Path("/"))
    told = done.stderr + (done.stdout if words[0] == "mandoc" else "")
    # It has no date: the same sources give the same page.
    assert [line for line in told.splitlines() if "missing date" not in line] == []
    assert done.returncode == 0 or words[0] == "mandoc"
