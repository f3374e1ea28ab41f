# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Changes of a model's text: what is not changed keeps every byte, and its comments."""

from __future__ import annotations

import random
import re

import pytest

from ravenchart.editing import edits
from ravenchart.editing.edits import Document, LayoutError, TakenItem
from ravenchart.gen.files.spans import Sequence, YamlMapping, plain_tree
from ravenchart.paths import ROOT

BLOCK = """\
processors:  # all of them
  fast:
    # the urgent one
    period: 10 ms   # as the drive wants it
    stack: 32 KiB
    activities:
      # first the ports
      - a.ports  # reads
      - a.run

      # last
      - 'a.act'
  slow:
    stack: 32 KiB
    activities: [b.ports, b.run]
"""


def document(text: str) -> Document:
    """The document of a text that is YAML."""
    made = Document.of(text)
    assert made is not None
    return made


def mapping(made: Document, *names: str) -> YamlMapping:
    """The mapping at these keys."""
    found = made.root
    for name in names:
        inner = found.mapping(name)
        assert inner is not None, name
        found = inner
    return found


def moved(text: str, source: str, number: int, target: str, place: int) -> str:
    """The text with a row of one processor moved to another."""
    made = document(text)
    flow = edits.is_flow(mapping(made, "processors", target), "activities")
    here = mapping(made, "processors", source)
    made, item = edits.without_item(made, here, "activities", number, comment_stays=flow)
    return edits.with_item(
        made, mapping(made, "processors", target), "activities", place, item
    ).text


def test_a_value_is_exchanged_and_nothing_else() -> None:
    made = document(BLOCK)
    period = mapping(made, "processors", "fast").scalar("period")
    assert period is not None
    assert edits.with_value(made, period, "20 ms").text == BLOCK.replace("10 ms", "20 ms")


def test_a_value_in_quotes_is_exchanged_with_them() -> None:
    made = document("a: {b: '10 ms', c: 1}\n")
    value = mapping(made, "a").scalar("b")
    assert value is not None
    assert edits.with_value(made, value, "5 ms").text == "a: {b: 5 ms, c: 1}\n"


def test_an_entry_gets_a_line_behind_the_comment_of_the_one_before() -> None:
    made = document(BLOCK)
    text = edits.with_entry(
        made, mapping(made, "processors", "fast"), "period", "priority", "7"
    ).text
    line = "    period: 10 ms   # as the drive wants it\n"
    assert text == BLOCK.replace(line, line + "    priority: 7\n")


def test_an_entry_in_brackets_stands_behind_the_other() -> None:
    made = document("p: {period: 5 ms, wcet: 1 ms, body: []}  # x\n")
    text = edits.with_entry(made, mapping(made, "p"), "wcet", "deadline", "4 ms").text
    assert text == "p: {period: 5 ms, wcet: 1 ms, deadline: 4 ms, body: []}  # x\n"


def test_an_entry_goes_and_its_comment_stays() -> None:
    made = document(BLOCK)
    text = edits.without_entry(made, mapping(made, "processors", "fast"), "period").text
    assert text == BLOCK.replace("period: 10 ms   # as", "# as")


@pytest.mark.parametrize(
    ("key", "left"),
    [("a", "{b: 2, c: 3}"), ("b", "{a: 1, c: 3}"), ("c", "{a: 1, b: 2}")],
)
def test_an_entry_in_brackets_goes_with_one_comma(key: str, left: str) -> None:
    made = document("p: {a: 1, b: 2, c: 3}\n")
    assert edits.without_entry(made, mapping(made, "p"), key).text == f"p: {left}\n"


def test_a_row_moves_within_its_list_with_the_comment_of_its_line() -> None:
    text = moved(BLOCK, "fast", 0, "fast", 1)
    assert text == BLOCK.replace("      - a.ports  # reads\n      - a.run\n",
                                 "      - a.run\n      - a.ports  # reads\n")  # fmt: skip


def test_a_row_moved_to_the_front_stands_below_the_comment_of_the_list() -> None:
    text = moved(BLOCK, "fast", 2, "fast", 0)
    assert "      # first the ports\n      - 'a.act'\n      - a.ports  # reads\n" in text
    assert "      # last\n  slow:" in text


def test_a_row_moved_into_brackets_leaves_its_comment_where_it_stood() -> None:
    text = moved(BLOCK, "fast", 0, "slow", 2)
    assert "activities: [b.ports, b.run, a.ports]\n" in text
    assert "      # first the ports\n      # reads\n      - a.run\n" in text


def test_a_row_moves_out_of_brackets() -> None:
    text = moved(BLOCK, "slow", 0, "fast", 3)
    assert "      - 'a.act'\n      - b.ports\n  slow:" in text
    assert "activities: [b.run]\n" in text


def test_the_last_row_of_a_list_leaves_brackets_and_can_come_back() -> None:
    text = "processors:\n  p:\n    activities:  # all\n      # one\n      - a.run  # it\n  q:\n" \
           "    activities:\n      - a.x\n"  # fmt: skip
    empty = moved(text, "p", 0, "q", 1)
    assert "    activities: []  # all\n      # one\n  q:\n" in empty
    assert empty.endswith("      - a.x\n      - a.run  # it\n")
    assert "activities: [a.run]  # all\n" in moved(empty, "q", 1, "p", 0)


def test_line_breaks_of_the_file_are_used() -> None:
    text = BLOCK.replace("\n", "\r\n")
    assert moved(text, "fast", 0, "fast", 1) == moved(BLOCK, "fast", 0, "fast", 1).replace(
        "\n", "\r\n"
    )


def test_a_file_without_a_last_line_break_keeps_it_so() -> None:
    text = "processors:\n  p: {activities: [a.x]}\n  q:\n    activities:\n      - b.x"
    assert moved(text, "p", 0, "q", 1) == (
        "processors:\n  p: {activities: []}\n  q:\n    activities:\n      - b.x\n      - a.x"
    )


def test_brackets_over_several_lines_keep_their_comments() -> None:
    text = "processors:\n  p:\n    activities: [a.x,  # first\n      a.y,  # second\n      a.z]\n"
    assert moved(text, "p", 1, "p", 0) == (
        "processors:\n  p:\n    activities: [a.y, a.x,  # first\n        # second\n      a.z]\n"
    )


@pytest.mark.parametrize(
    "text",
    [
        "processors: {p: {activities:\n  [a.x, a.y]}, q: {activities: [b.x]}}\n",
        "processors:\n  p:\n    activities:\n    - a.x\n    - a.y\n"
        "  q:\n    activities:\n    - b.x\n",
        "'processors':\n  \"p\":\n    activities:\n      -   a.x\n      -   a.y\n"
        "  q: {activities: [ b.x ]}\n",
    ],
)
def test_other_layouts_are_changed_to_what_was_meant(text: str) -> None:
    made = plain_tree(document(moved(text, "p", 0, "q", 1)).root)
    assert made == {
        "processors": {"p": {"activities": ["a.y"]}, "q": {"activities": ["b.x", "a.x"]}}
    }


def test_a_layout_that_cannot_be_changed_is_refused() -> None:
    text = "processors:\n  p:\n    activities:\n      -\n        a.x\n      - a.y\n"
    made = document(text)
    with pytest.raises(LayoutError):
        edits.without_item(
            made, mapping(made, "processors", "p"), "activities", 0, comment_stays=False
        )


def test_a_value_that_would_be_other_yaml_is_refused() -> None:
    made = document("a: {b: 1}\n")
    value = mapping(made, "a").scalar("b")
    assert value is not None
    for bad in ("1, c: 2", "[", "x # y", "1}\nz: {q: 1"):
        with pytest.raises(LayoutError):
            edits.with_value(made, value, bad)


@pytest.mark.slow
def test_random_moves_in_the_examples_lose_no_comment_and_no_word() -> None:
    chance = random.Random(2026)
    tried = 0
    for path in sorted((ROOT / "examples").glob("*/*.yaml")):
        text = path.read_text(encoding="utf-8")
        made = Document.of(text)
        processors = None if made is None else made.root.mapping("processors")
        names = [] if processors is None else [name.value for name, _ in processors.mappings()]
        for _ in range(12 if names else 0):
            source, target = chance.choice(names), chance.choice(names)
            assert made is not None
            rows = mapping(made, "processors", source).get("activities")
            assert isinstance(rows, Sequence)
            others = mapping(made, "processors", target).get("activities")
            assert isinstance(others, Sequence)
            if not rows.items:
                continue
            room = len(others.items) - (source == target)
            text = moved(made.text, source, chance.randrange(len(rows.items)), target,
                         chance.randint(0, room))  # fmt: skip
            assert sorted(re.findall(r"#.*", text)) == sorted(re.findall(r"#.*", made.text))
            assert sorted(re.findall(r"\w+", text)) == sorted(re.findall(r"\w+", made.text))
            made = document(text)
            tried += 1
    assert tried > 60


def test_an_item_is_taken_with_its_quotes() -> None:
    made = document("p: {activities: ['a.x', b.y]}\n")
    _, item = edits.without_item(made, mapping(made, "p"), "activities", 0, comment_stays=True)
    assert item == TakenItem("a.x", "'a.x'")
