# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What is not proved is said in the user's words, whichever age of gnatprove says it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from ravenchart.proof.spark_results import Open, Results, read_results
from ravenchart.proof.unproved import IN_GENERATED, UnprovedCheck, element_of, findings

ROBOT = ROOT / "examples" / "cartesian_robot" / "model.yaml"
NAME = "Cartesian_Robot.Joint.Activities.Position_Control"
BODY = "cartesian_robot-joint-activities.adb"


def _check(severity: str, entity: object, **more: object) -> dict[str, Any]:
    place = {"file": BODY, "line": 168, "col": 27, "rule": "VC_RANGE_CHECK"}
    return {**place, "severity": severity, "entity": entity, **more}


def _older() -> dict[str, Any]:
    entity = {"name": NAME, "sloc": [{"file": "joint.ads", "line": 16}]}
    outside = {"name": "Hidden", "sloc": [{"file": "hidden.ads", "line": 3}], "spark": "spec"}
    checks = [_check("info", entity, stats={"Z3": {}}), _check("medium", entity)]
    flow = [_check("info", entity), _check("warning", entity)]
    return {"spark": [entity | {"spark": "all"}, outside], "flow": flow, "proof": checks}


def _younger() -> dict[str, Any]:
    """The same results as the younger age writes them."""
    entities = {
        " 7": {"name": NAME, "sloc": [{"file": "joint.ads", "line": 16}]},
        " 9": {"name": "Hidden", "sloc": [{"file": "hidden.ads", "line": 3}]},
    }
    checks = [_check("info", 7, stats={"Z3": {}}), _check("medium", 7)]
    flow = [_check("info", 7), _check("warning", 7)]
    modes = {" 7": "all", " 9": "spec"}
    skipped: dict[str, list[int]] = {"skip_flow_proof": [], "skip_proof": []}
    return {"entities": entities, "spark": modes, "flow": flow, "proof": checks, **skipped}


def _read(folder: Path, unit: dict[str, Any]) -> Results:
    (folder / "unit.spark").write_text(json.dumps(unit), encoding="utf-8")
    return read_results([folder])


@pytest.mark.parametrize("written", [_older, _younger])
def test_both_ages_give_the_same_results(
    written: Callable[[], dict[str, Any]], tmp_path: Path
) -> None:
    found = _read(tmp_path, written())
    assert (found.checks, found.justified, found.unproved, found.assumed) == (3, 0, 1, 0)
    assert found.open == (Open(BODY, 168, 27, "VC_RANGE_CHECK", NAME),)
    (entity,) = found.entities
    assert (entity.path, entity.checks, entity.provers) == (NAME, 2, ("Z3",))
    (outside,) = found.outside
    assert (outside.name, outside.location) == ("Hidden", "hidden.ads:3")


def test_what_an_annotation_skips_is_outside(tmp_path: Path) -> None:
    unit = _younger()
    unit["skip_proof"] = [7]
    assert [one.name for one in _read(tmp_path, unit).outside] == [NAME, "Hidden"]


def _finding(place: str, text: str, entity: str, folder: Path) -> UnprovedCheck:
    source = folder / place
    source.parent.mkdir(exist_ok=True)
    source.write_text("\n" * 167 + "      Measured.Position := Position (Reached);\n")
    system = load(ROBOT).system
    assert system is not None
    one = Open(source.name, 168, 27, "VC_RANGE_CHECK", entity)
    line = f"{source.name}:168:27: high: {text}\n{source.name}:168:27: high: in a body at x:1[#2]"
    (found,) = findings(line, [one], system, folder, [source.parent])
    return found


def test_a_finding_has_file_check_values_and_element(tmp_path: Path) -> None:
    text = (
        "range check might fail, cannot prove upper bound for Reached (e.g. when Reached = 500001)"
        " [reason for check: value must be convertible][#0]"
    )
    found = _finding(f"user/{BODY}", text, NAME, tmp_path)
    assert found.file == f"user/{BODY}"
    assert found.check == "range check might fail, cannot prove upper bound for Reached"
    assert found.example == "Reached = 500001"
    assert found.element == "Joint.position_control"
    assert found.origin is not None and found.origin.file.endswith("joint.yaml")
    assert list(found.lines())[1:3] == [
        "  168 |       Measured.Position := Position (Reached);",
        "      |                           ^",
    ]
    assert "'Min and 'Max" in found.help


def test_of_generated_code_the_model_is_to_be_changed(tmp_path: Path) -> None:
    """Never a precondition of a spec that the next `generate` writes again."""
    text = "precondition might fail [possible fix: add a precondition to subprogram at line 3]"
    found = _finding(f"generated/{BODY}", text, "Cartesian_Robot.Joint.Motion.Fire", tmp_path)
    assert found.help == IN_GENERATED
    assert found.element == "Joint.Motion"
    assert "precondition to" not in "\n".join(found.lines())


def test_elements_of_instances_processors_and_the_rest() -> None:
    system = load(ROBOT).system
    assert system is not None
    assert element_of(system, "Cartesian_Robot.Joint_X.Execute_Motion")[0] == "joint_x"
    assert element_of(system, "Cartesian_Robot.Control.Execute")[0] == "control"
    assert element_of(system, "Ravenchart.Rings.Append") == ("", None)
    assert element_of(system, "Cartesian_Robot_Main") == ("", None)
