# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Tables put together anew in a model's text: it means what was proposed, and comments stay."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.allocation.proposals import STRATEGIES, Proposal, WantedTable, propose, tables
from ravenchart.analysis.system.timing import Analysis
from ravenchart.editing.edits import LayoutError
from ravenchart.editing.evaluation import Evaluation, Texts, evaluate
from ravenchart.editing.tables import moved, rearranged
from ravenchart.paths import ROOT

ROBOT = ROOT / "examples" / "cartesian_robot" / "model.yaml"
MODELS = [
    *(ROOT / "examples" / n / "model.yaml" for n in ("cartesian_robot", "crossing")),
    *(ROOT / "examples" / n / "model.yaml" for n in ("surgical_robot", "three_components")),
    *(ROOT / "tests" / "feature" / n / "model.yaml" for n in ("arrays", "composites", "registers")),
    ROOT / "tests" / "deployments" / "heater" / "model.yaml@bench",
    *(ROOT / "tests" / "nodes" / n / "model.yaml" for n in ("commands", "gripper", "tactile")),
]


def proposed(path: Path, strategy: str) -> tuple[Evaluation, Proposal, tuple[WantedTable, ...]]:
    state = evaluate(path, {})
    assert state.analysis is not None
    found = propose(state.analysis, strategy)
    return state, found, tables(found)


def bounds(analysis: Analysis | None) -> dict[str, int | None]:
    assert analysis is not None
    return {row.row.name: row.bound for _, row in analysis.rows()}


def text_of(texts: Texts, word: str) -> str:
    return next(t for t in (x.decode() for x in texts.values()) if word in t)


@pytest.mark.slow
@pytest.mark.parametrize("strategy", STRATEGIES)
@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.parent.name)
def test_the_text_then_has_the_bounds_that_were_proposed(path: Path, strategy: str) -> None:
    state, found, wanted = proposed(path, strategy)
    made = rearranged(path, state, wanted)
    after = evaluate(path, made)
    assert bounds(after.analysis) == bounds(found.analysis)
    assert not [one for one in after.found if one.is_error]


def test_a_row_that_stands_once_for_several_nodes_is_not_put_into_several_tables() -> None:
    path = ROOT / "examples" / "two_nodes" / "model.yaml"
    state, _, wanted = proposed(path, "fewest")
    with pytest.raises(LayoutError, match=r"link\.watch goes to a processor of each node"):
        rearranged(path, state, wanted)


def test_a_processor_keeps_its_name_and_comments_and_a_row_takes_its_comment_along() -> None:
    state, _, wanted = proposed(ROBOT, "fewest")
    before, after = (
        [line for text in texts.values() for line in text.decode().splitlines()]
        for texts in (state.texts, rearranged(ROBOT, state, wanted))
    )
    gone = [line for line in before if line not in after]
    assert gone and not [line for line in gone if line.lstrip().startswith("- ")]


MODEL = """\
system: Small
types: {Word: {range: [0, 100]}}
nodes: {cpu: {context_switch: 5 us, critical_section: 5 us}}
instances: {k: {component: C, node: cpu}}
shutdown: {raises: [], grace: 0 ms}
components:
  C:
    data: {n: {type: Word, initial: 0}, m: {type: Word, initial: 0}}
    activities:
      a: {period: 10 ms, wcet: 200 us, body: [{set: n, to: 1}]}
      b: {period: 20 ms, wcet: 500 us, body: [{set: m, to: n}]}
processors:
  # reads
  fast:
    node: cpu
    priority: 7      # by hand
    stack: 32 KiB
    activities:
      - k.a  # first
  # writes
  slow:
    node: cpu
    stack: 32 KiB
    activities:
      - k.b  # second
# the end
"""


def small(tmp_path: Path, text: str = MODEL) -> tuple[Path, Evaluation]:
    path = tmp_path / "model.yaml"
    path.write_text(text)
    return path, evaluate(path, {})


MS = 1_000_000
ONE = WantedTable("one", "cpu", 1, None, 1, 10 * MS, 0, 10 * MS, 32768, ("k.a", "k.b"), {})


def test_two_processors_become_one_and_one_becomes_two(tmp_path: Path) -> None:
    path, state = small(tmp_path)
    texts = rearranged(path, state, (ONE,))
    assert text_of(texts, "processors").partition("processors:\n")[2] == (
        "  # reads\n  fast:\n    node: cpu\n    # by hand\n    stack: 32 KiB\n    activities:\n"
        "      - k.a  # first\n      - k.b  # second\n# the end\n"
    )
    path.write_text(text_of(texts, "processors"))
    slow = replace(ONE, name="fast", period=20 * MS, offset=MS, stack_bytes=4096, rows=("k.b",))
    halves = (
        replace(ONE, name="every_10_ms", priority=2, deadline=8 * MS, rows=("k.a",)),
        replace(slow, deadline=20 * MS),
    )
    again = rearranged(path, evaluate(path, {}), halves)
    assert text_of(again, "processors").partition("processors:\n")[2] == (
        "  # reads\n  fast:\n    node: cpu\n    # by hand\n    stack: 32 KiB\n"
        "    deadline: 8 ms\n    activities:\n      - k.a  # first\n"
        "  fast_2:\n    node: cpu\n    period: 20 ms\n    offset: 1 ms\n    stack: 4 KiB\n"
        "    activities:\n      - k.b  # second\n# the end\n"
    )


def test_the_last_processor_of_an_included_file_takes_its_section_along(tmp_path: Path) -> None:
    slow = MODEL[MODEL.index("  # writes") : MODEL.index("# the end")]
    shutdown = "shutdown: {raises: [], grace: 0 ms}\n"
    other = tmp_path / "slow.yaml"
    other.write_text(f"{shutdown}# tables\nprocessors:\n{slow}# the end\n")
    main = MODEL.replace(slow, "").replace(shutdown, "include: [slow.yaml]\n")
    path, state = small(tmp_path, main)
    texts = rearranged(path, state, (ONE,))
    assert text_of(texts, "shutdown") == f"{shutdown}# the end\n"
    assert bounds(evaluate(path, texts).analysis).keys() == {"k.a", "k.b"}


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            MODEL[MODEL.index("  # reads") :],
            "  {fast: {node: cpu, stack: 32 KiB, activities: [k.a]},\n"
            "   slow: {node: cpu, stack: 32 KiB, activities: [k.b]}}\n",
            "`slow` does not stand in a line of its own",
        ),
    ],
)
def test_what_the_text_does_not_allow_is_refused(
    tmp_path: Path, old: str, new: str, said: str
) -> None:
    assert old in MODEL
    path, state = small(tmp_path, MODEL.replace(old, new))
    with pytest.raises(LayoutError, match=said):
        rearranged(path, state, (ONE,))


PHASED = ROOT / "tests" / "feature" / "logical" / "model.yaml"


@pytest.mark.parametrize(("row", "gone"), [
    ("source_1.make_slowly", "source_1.make_slowly: 10 ms, "),
    ("fast_1.look", "    phases: {fast_1.look: 5 ms}\n"),
])  # fmt: skip
def test_a_row_that_leaves_its_table_leaves_its_phase(row: str, gone: str) -> None:
    places = evaluate(PHASED, {}).places
    text = PHASED.read_text(encoding="utf-8")
    assert gone in text
    (made,) = moved(places, row, "keeping", 0).values()
    assert made.text.count("phases") == text.replace(gone, "").count("phases")
    assert row not in made.text.partition("    phases")[2].partition("\n")[0]


@pytest.mark.parametrize(("written", "left"), [
    ("{servo_*.tell: 5 ms, cells.tell: 10 ms}  # apart",
     "{servo_1.tell: 5 ms, servo_3.tell: 5 ms, servo_4.tell: 5 ms, cells.tell: 10 ms}  # apart"),
    ("\n      servo_*.tell: 5 ms",
     "\n      servo_1.tell: 5 ms\n      servo_3.tell: 5 ms\n      servo_4.tell: 5 ms"),
])  # fmt: skip
def test_the_other_elements_of_an_array_keep_their_phase(
    tmp_path: Path, written: str, left: str
) -> None:
    shutil.copytree(ROOT / "examples" / "autopilot", tmp_path, dirs_exist_ok=True)
    model, head = tmp_path / "model.yaml", "  moving:\n    schedule: table\n"
    text = model.read_text(encoding="utf-8")
    assert text.count(head) == 1
    model.write_text(text.replace(head, f"{head}    phases: {written}\n"), encoding="utf-8")
    state = evaluate(model, {})
    assert state.analysis is not None
    (made,) = moved(state.places, "servo_2.tell", "acting", 0).values()
    assert f"{head}    phases: {left}\n" in made.text


def test_a_row_that_moves_inside_its_table_keeps_its_phase() -> None:
    places = evaluate(PHASED, {}).places
    (made,) = moved(places, "source_1.make_slowly", "making", 0).values()
    assert "source_1.make_slowly: 10 ms" in made.text
