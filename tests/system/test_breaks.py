# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A transition, a ceiling, a queue bound and a WCET, each broken by hand: each is refused.

The proofs need gnatprove; without it those tests are skipped, and say so.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from ravenchart.building import checking
from ravenchart.failures import Refused, ToolFailed
from ravenchart.paths import ROOT
from ravenchart.proof import ages
from ravenchart.tools import toolchain

needs_gnatprove = pytest.mark.skipif(
    not toolchain.have("gnatprove"), reason="gnatprove is not on PATH: nothing is proved"
)


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of what the three components' program is built from."""
    for name in ("spark_runtime", "hw_can"):
        shutil.copytree(ROOT / name, tmp_path / name)
    for name in ("ravenchart.gpr", "switches.gpr"):
        shutil.copy(ROOT / name, tmp_path)
    shutil.copytree(ROOT / "examples" / "three_components", tmp_path / "three")
    monkeypatch.setattr(toolchain, "ROOT", tmp_path)
    return tmp_path


def _break(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text, f"{path.name} does not hold {old!r}"
    path.write_text(text.replace(old, new, 1))


def _prove(checkout: Path, *units: str) -> str:
    options = ["-P", "three_components.gpr", "-q", "--output=oneline", "-u", *units]
    variables = {"MODE": "checks", "RAVENCHART_BUILD": str(checkout / "build")}
    return ages.run(options, checkout / "three" / "generated", variables)


@needs_gnatprove
def test_a_transition_to_the_wrong_state_is_not_proved(checkout: Path) -> None:
    unit = "three_components-station-handling.adb"
    _prove(checkout, unit)
    body = checkout / "three" / "generated" / unit
    _break(body, "Self.Leaf := Target (Chosen);", "Self.Leaf := Handling_States.Empty;")
    with pytest.raises(ToolFailed, match="might fail"):
        _prove(checkout, unit)


@needs_gnatprove
def test_a_transition_on_the_wrong_event_is_not_proved(checkout: Path) -> None:
    unit = "three_components-station-handling.adb"
    body = checkout / "three" / "generated" / unit
    _break(body, "when On_Worked =>", "when Conditions =>")
    with pytest.raises(ToolFailed, match="postcondition might fail"):
        _prove(checkout, unit)


@needs_gnatprove
def test_a_ceiling_that_is_too_low_is_not_proved(checkout: Path) -> None:
    generated = checkout / "three" / "generated"
    body = generated / "three_components-two.adb"
    text = body.read_text()
    start = text.index("package Held_Board")
    end = text.index(";", start)
    declared = text[start:end]
    assert "Default_Priority + 2" in declared
    body.write_text(text[:start] + declared.replace("Priority + 2", "Priority + 1") + text[end:])
    with pytest.raises(ToolFailed, match="ceiling"):
        _prove(checkout, "three_components-processor_2.adb", "three_components_main.adb")


@needs_gnatprove
def test_a_full_queue_that_forgets_an_element_is_not_proved(checkout: Path) -> None:
    body = checkout / "spark_runtime" / "src" / "ravenchart-policy_queues.adb"
    _break(body, "if Status /= Queueing.Rejected_Full then", "if Status = Queueing.Queued then")
    with pytest.raises(ToolFailed, match="postcondition might fail"):
        _prove(checkout, "three_components-two.adb")


def test_a_wcet_past_its_slack_does_not_compile(checkout: Path) -> None:
    certificate = checkout / "three" / "generated" / "three_components-timing_certificate.ads"
    _break(
        certificate,
        "Two_Work_Wcet : constant := 200_000;",
        "Two_Work_Wcet : constant := 200_001;",
    )
    options = ["-p", "-q", "-P", "three_components.gpr"]
    variables = {"MODE": "checks", "RAVENCHART_BUILD": str(checkout / "build")}
    with pytest.raises(ToolFailed, match="processor_3 claims a wrong response time"):
        toolchain.run("gprbuild", options, checkout / "three" / "generated", variables)


def test_a_wcet_that_cannot_be_met_is_refused_with_the_model_line(
    copy_of: Callable[[str], Path],
) -> None:
    folder = copy_of("three_components")
    model = folder / "model.yaml"
    model.write_text(model.read_text().replace("wcet: 200 us", "wcet: 9 ms"))
    with pytest.raises(Refused, match=r"model.yaml:\d+:\d+: error: processor_1 has no"):
        checking.check(model)
