# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures of messages, loads and chains on the page: those of `analyse`, beside the saved ones."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from ravenchart import rounded
from ravenchart.paths import ROOT
from ravenchart.workbench.requests import Move, SetTime
from ravenchart.workbench.session import Session
from ravenchart.workbench.view import whole_view
from tests.support.answers import answered

PRINTED = pytest.CaptureFixture[str]
Figures = dict[str, Any]


@pytest.fixture
def session(tmp_path: Path) -> Session:
    """The robot under change."""
    return Session(copied("cartesian_robot", tmp_path))


def copied(example: str, folder: Path) -> Path:
    """The model of an example, in a folder of its own."""
    for path in (ROOT / "examples" / example).glob("*.yaml"):
        shutil.copy(path, folder)
    return folder / "model.yaml"


def moved(session: Session) -> bool:
    """Control of a joint goes to the processor of its trajectory."""
    row = "joint_x.position_control"
    return session.change(Move(kind="move", row=row, to="trajectory", place=0, number=0))


def rarer(session: Session) -> bool:
    """The joints are controlled, and their drives told, half as often."""
    wish = {"kind": "time", "row": "joint_x.position_control", "key": "period", "value": "20 ms"}
    return session.change(SetTime.model_validate(wish | {"number": 0}))


def shown(session: Session, which: str) -> Figures:
    """The figures on the page: `bound`, or `saved`."""
    view = whole_view(session)
    share = {"bound": "text", "saved": "saved_text"}[which]
    return {
        "messages": {f"{one['bus']}.{one['name']}": one[which] for one in view["messages"]},
        "loads": {one["name"]: one[share] for one in view["loads"]},
        "chains": {
            (one["name"], limit["what"]): limit[which]
            for one in view["chains"]
            for limit in one["limits"]
        },
    }


def analysed(session: Session, capsys: PRINTED) -> Figures:
    """The figures of the saved model, by the command."""
    status = 0 if whole_view(session)["met"] else 1
    answer = answered(capsys, "analyse", session.path, status=status)
    return {
        "messages": {one["message"]: one["response"] for one in answer["messages"]},
        "loads": {name: Fraction(load) for name, load in answer["load"].items()},
        "chains": {
            (one["chain"], what): one[what]
            for one in answer["chains"]
            for what in ("reaction", "age")
        },
    }


def differing(one: Figures, other: Figures) -> set[str]:
    """Which figures of two states are not the same."""
    both = ((one[kind], other[kind]) for kind in one)
    return {str(name) for a, b in both for name in a if a[name] != b[name]}


@pytest.mark.parametrize(
    ("change", "changed"),
    [
        (moved, {"robot_bus.x_set_point", "('x_loop', 'reaction')", "('x_loop', 'age')",
                 "('status', 'reaction')", "('status', 'age')"}),
        (rarer, {"robot_bus", "controller", "('x_loop', 'reaction')"}),
    ],
)  # fmt: skip
def test_the_figures_that_a_change_moves_are_those_of_the_analysis(
    change: Callable[[Session], bool], changed: set[str], session: Session, capsys: PRINTED
) -> None:
    before = shown(session, "bound")
    assert agree(before, analysed(session, capsys))
    assert change(session)
    now = shown(session, "bound")
    assert differing(before, now) >= changed
    assert shown(session, "saved") == before
    session.save(late=True)
    assert agree(now, analysed(session, capsys))
    assert shown(session, "saved") == now


def agree(page: Figures, command: Figures) -> bool:
    """The same bounds, and loads as the terminal has them."""
    loads = {name: rounded.percent(load) for name, load in command["loads"].items()}
    assert loads == page["loads"]
    assert page["messages"] == command["messages"]
    assert page["chains"] == command["chains"]
    return True


def test_known_figures(session: Session) -> None:
    assert moved(session)
    view = whole_view(session)
    (x_loop,) = (one for one in view["chains"] if one["name"] == "x_loop")
    reaction = next(one for one in x_loop["limits"] if one["what"] == "reaction")
    assert (reaction["bound_text"], reaction["saved_text"]) == ("32360", "22145")
    assert not reaction["met"] and not x_loop["met"]


# --- Streams to monitors -------------------------------------------------------------------


def test_a_stream_is_a_row_of_the_page_that_follows_each_change(tmp_path: Path) -> None:
    text = (ROOT / "examples" / "pump" / "model.yaml").read_text(encoding="utf-8")
    now = "trace: 4096"
    assert text.count(now) == 1
    model = tmp_path / "model.yaml"
    model.write_text(text.replace(now, f"{now}, stream: {{wcet: 6 ms}}"), encoding="utf-8")
    session = Session(model)
    (row,) = whole_view(session)["streams"]
    (stream,) = session.good.analysis.streams if session.good.analysis is not None else ()
    assert (row["name"], row["core"]) == ("board.stream", "board")
    assert (row["bound"], row["limit"], row["word"], row["met"]) == (
        stream.bound, 100_000_000, "ok", True,
    )  # fmt: skip
    assert row["saved"] == row["bound"]
    assert "stream" in model.read_text(encoding="utf-8").splitlines()[row["line"] - 1]
    assert stream.apart is not None
    assert row["said"][1] == f"Its snapshots are at most {rounded.up(stream.apart)} apart."
    wish = {"kind": "time", "row": "bed.turn", "key": "wcet", "value": "9 ms", "number": 0}
    assert session.change(SetTime.model_validate(wish))
    (changed,) = whole_view(session)["streams"]
    assert changed["bound"] > changed["saved"] == row["bound"]


def test_without_a_stream_the_page_has_no_row_for_one(session: Session) -> None:
    assert whole_view(session)["streams"] == []


def test_a_processor_that_is_on_several_nodes_has_a_response_on_each(
    tmp_path: Path, capsys: PRINTED
) -> None:
    """It stands once in the text, and the analysis has a task of it on each node."""
    session = Session(copied("two_nodes", tmp_path))
    before = {one["node"]: one["bound"] for one in reception(session)["copies"]}
    answer = answered(capsys, "analyse", session.path, status=0)
    tasks = {one["task"]: one["response"] for one in answer["tasks"]}
    assert before == {node: tasks[f"reception_{node}"] for node in ("panel", "drive")}
    wish = {"kind": "time", "row": "link.receive", "key": "wcet", "value": "90 us", "number": 0}
    assert session.change(SetTime.model_validate(wish))
    after = reception(session)
    assert after["deadline"] == "1 ms" and after["bound"] is None
    for one in after["copies"]:
        assert one["bound"] > one["saved"] == before[one["node"]] and one["met"]
    assert all(one["copies"] == [] for one in whole_view(session)["processors"][1:])


def reception(session: Session) -> Figures:
    """The first processor on the page."""
    first: Figures = whole_view(session)["processors"][0]
    return first
