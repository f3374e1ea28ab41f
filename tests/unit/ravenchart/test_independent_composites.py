# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The independent checker writes composite components out by itself, and finds what is altered."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from ravenchart.independent.check import checked
from ravenchart.independent.findings import Disagreement, UnusableError
from ravenchart.paths import ROOT
from tests.unit.gen.test_composites import ARM
from tests.unit.ravenchart.test_independent import _altered, _generated, _line

FEATURE = ROOT / "tests/feature/composites/model.yaml"

SLOW = """\
  Slow_Source:
    ports: {level: {out: Level}}
    activities:
      tell: {period: 20 ms, wcet: 20 us, body: [{send: level, with: 1}]}
  Pair:
"""


def _nested(folder: Path) -> Path:
    return _generated(Path(shutil.copy(FEATURE, folder)))


def _nodes(folder: Path) -> Path:
    """Two composites on two nodes, joined by a connection and by a message."""
    model = folder / "model.yaml"
    model.write_text(ARM.replace("  Pair:\n", SLOW), encoding="utf-8")
    return _generated(model)


def _found(model: Path, old: str, new: str) -> list[Disagreement]:
    """What is found once the model differs from its program."""
    _altered(model, [[old, new]])
    return [one for one in checked(model).disagreements if one.kind != "digest"]


def test_instances_at_two_levels_agree(tmp_path: Path) -> None:
    report = checked(_nested(tmp_path))
    assert report.disagreements == []
    assert all(report.counts[kind] > 0 for kind in ("tasks", "rows", "sums", "states", "targets"))


def test_a_facade_of_what_composites_provide_agrees(tmp_path: Path) -> None:
    members = "[robot.Left_Motion, robot.Right_Motion, Axis_1]"
    every = ("Go_Home", "Get_Sum", "Arrived")
    choose = ", ".join(f"{command}: robot.Right_Motion" for command in every)
    text = FEATURE.read_text(encoding="utf-8")
    for old, new in (
        (
            "\ncomponents:",
            f"  Both_Arms: {{facade: {members}, choose: {{{choose}}}}}\n\ncomponents:",
        ),
        (
            "{from: left_observer.Arm, to: robot.Left_Motion}",
            "{from: left_observer.Arm, to: Both_Arms}",
        ),
    ):
        assert old in text
        text = text.replace(old, new)
    model = tmp_path / "model.yaml"
    model.write_text(text, encoding="utf-8")
    assert checked(_generated(model)).disagreements == []


def test_instances_on_two_nodes_agree(tmp_path: Path) -> None:
    report = checked(_nodes(tmp_path))
    assert report.disagreements == []
    assert report.counts["arbitration"] > 0


@pytest.mark.slow
@pytest.mark.parametrize("nodes", [False, True])
def test_each_altered_number_of_a_certificate_is_found(nodes: bool, tmp_path: Path) -> None:
    model = (_nodes if nodes else _nested)(tmp_path)
    path = next((tmp_path / "generated").rglob("*-timing_certificate.ads"))
    text = path.read_text(encoding="utf-8")
    found = re.finditer(r"^   (\w+) : constant :=", text, re.MULTILINE)
    #  those of a chain from end to end are not derived
    numbers = [one for one in found if not re.search(r"^Chain_|_(Done|W|Needs)$", one[1])]
    inside = r"Robot_Left_Shoulder_Follow_Wcet" if not nodes else r"One_Source_Tell_Wcet"
    assert len(numbers) > 40 and inside in {one[1] for one in numbers}
    for one in numbers:
        path.write_text(f"{text[: one.end()]} 1 + {text[one.end() :]}", encoding="utf-8")
        lines = {item.line for item in checked(model).disagreements}
        assert _line(text, one[0]) in lines, one[1]


@pytest.mark.parametrize(
    ("old", "new", "part"),
    [
        #  time of a device that is reached through two delegated interfaces
        ("Get_Position: 10 us", "Get_Position: 11 us", "Robot_Right_Elbow_Follow_Wcet is"),
        ("wcet: 100 us\n        body:\n          - {call", "wcet: 101 us\n        body:\n"
         "          - {call", "Robot_Left_Elbow_Follow_Wcet is"),
        #  one of four joints loses its drive
        ("      - {from: left.Shoulder_Drive, to: Left_Shoulder}\n", "",
         "Robot_Left_Shoulder_Follow_Wcet is"),
        ("      - {from: elbow.Drive, to: Elbow_Drive}\n", "",
         "Robot_Right_Elbow_Follow_Wcet is"),
        ("      - robot.left.shoulder.follow\n", "", "Robot_Left_Shoulder_Follow"),
    ],
)  # fmt: skip
def test_an_edit_inside_a_composite_is_found(old: str, new: str, part: str, tmp_path: Path) -> None:
    found = _found(_nested(tmp_path), old, new)
    assert any(part in str(one) for one in found), list(map(str, found))


@pytest.mark.parametrize(
    ("old", "new", "part"),
    [
        (
            "source: {component: Source}",
            "source: {component: Slow_Source}",
            "Line_One_Source_Level_T",
        ),
        (
            "{component: Pair, node: there, ",
            "{component: Pair, node: here, ",
            "Reception_C is missing",
        ),
        ("- {from: one.told, to: two.given}", "- {from: one.told, to: one.given}", "One_Source"),
    ],
)
def test_an_edit_of_what_travels_is_found(old: str, new: str, part: str, tmp_path: Path) -> None:
    found = _found(_nodes(tmp_path), old, new)
    assert any(part in str(one) for one in found), list(map(str, found))


def test_a_chart_inside_a_composite_is_compared(tmp_path: Path) -> None:
    model = _nested(tmp_path)
    found = _found(model, "arrive: {from: Moving, to: At_Goal", "arrive: {from: Moving, to: Still")
    assert {one.kind for one in found} >= {"targets"}


def test_a_component_that_contains_itself_is_no_agreement(tmp_path: Path) -> None:
    model = _nested(tmp_path)
    _altered(model, [["left: {component: Arm,", "left: {component: Robot,"]])
    with pytest.raises(UnusableError, match="no valid model"):
        checked(model)
