# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What the docs name is there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ravenchart.paths import ROOT

DOOR = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md")
PAGES = (
    *(ROOT / name for name in DOOR),
    *sorted((ROOT / "docs").glob("*.md")),
    ROOT / "proofs/assumptions.md",
)
READ = (
    *(page for page in PAGES if page != ROOT / "README.md"),
    ROOT / "examples" / "README.md",
    *sorted((ROOT / "examples").glob("*/README.md")),
)
"""The pages that name their reader: all but the first page of the repository."""
SOURCE = re.compile(
    r"`((?:gen|analysis|behaviour|hw_can|ravenchart|spark_runtime|tests|proofs|scripts)"
    r"/[\w./-]+\.(?:py|toml|ad[bs]|gpr|sh|md))`"
)
MODULE = re.compile(r"`((?:gen|analysis|behaviour|hw_can|ravenchart)(?:\.(?!gpr`)[a-z_]+)+)`")
LINK = re.compile(r"\]\((?!https?:)([^)#]+)(?:#[^)]*)?\)")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_files_modules_and_links_of_a_page_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    files = [ROOT / name for name in SOURCE.findall(text)]
    files += [page.parent / name for name in LINK.findall(text)]
    lost = [str(path) for path in files if not path.exists()]
    for name in MODULE.findall(text):
        place = ROOT / name.replace(".", "/")
        if not place.is_dir() and not place.with_suffix(".py").exists():
            lost.append(name)
    assert lost == []


READERS = re.compile(r"For (?:engineers|those|anybody|assessors|users)\b")


@pytest.mark.parametrize("page", READ, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_page_begins_with_its_reader(page: Path) -> None:
    title, first = page.read_text(encoding="utf-8").split("\n\n")[:2]
    assert title.startswith("# ") and "\n" not in title
    assert READERS.match(first), first


PARTS = ["Problem", "Forces", "Dynamic_form", "Liability", "Static_form", "Proof", "Code", "Test"]


def test_every_pattern_is_told_in_full() -> None:
    text = (ROOT / "docs" / "patterns.md").read_text(encoding="utf-8")
    sections = re.split(r"^## (?=\d)", text, flags=re.M)[1:]
    assert [one.partition(".")[0] for one in sections] == [str(n) for n in range(1, 19)]
    for section in sections:
        rows = re.findall(r"^\| ([A-Z][a-z ]+) \| (.+) \|$", section, re.M)
        assert [name.replace(" ", "_") for name, _ in rows] == PARTS, section
        told = dict(rows)
        assert all(LINK.search(told[part]) for part in ("Code", "Test")), section
    steps = text.partition("## The sequence")[2].partition("## 1.")[0]
    led = re.findall(r"\(#(\d+)-", steps)
    assert sorted(map(int, led)) == list(range(1, 19))


def test_the_door_is_a_picture_two_commands_and_five_links() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(re.findall(r"^!\[", text, re.M)) == 1
    (commands,) = re.findall(r"^```sh\n(.*?)^```$", text, re.M | re.S)
    assert commands.split("\n") == ["make demo", "make test", ""]
    assert len(re.findall(r"(?<!!)\[[^]]+\]\(", text)) == 5
    assert len(text.split()) < 300


def test_every_page_is_in_the_list_of_pages() -> None:
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    linked = set(LINK.findall(index))
    pages = {page.name for page in (ROOT / "docs").glob("*.md")} - {"index.md"}
    assert pages - linked == set()
    listed = {f"{line}.md" for line in index.splitlines()}  # in the tables of contents of the site
    assert pages - listed == set()
    examples = (ROOT / "examples" / "README.md").read_text(encoding="utf-8")
    folders = {page.parent.name for page in (ROOT / "examples").glob("*/README.md")}
    assert {link.partition("/")[0] for link in LINK.findall(examples)} == folders
