# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A body of the user that decides when it sends, in virtual time; so does its first version."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from ravenchart.command_line import main
from ravenchart.paths import ROOT

MODEL = ROOT / "tests" / "feature" / "may_send" / "model.yaml"


def _simulated(folder: Path, capsys: pytest.CaptureFixture[str]) -> list[str]:
    """The steps of 600 ms."""
    (folder / "events.yaml").write_text("- {until: 600 ms}\n")
    events = str(folder / "events.yaml")
    assert main(["simulate", str(folder / "model.yaml"), "--events", events]) == 0
    return capsys.readouterr().out.splitlines()


def test_a_value_is_sent_in_the_executions_that_say_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = Path(shutil.copytree(MODEL.parent, tmp_path / "feature"))
    #  alarms in the third and sixth execution; the last report in the third, stale after 200 ms
    assert _simulated(folder, capsys) == [
        "0.000 horn.Sound: Quiet.entry",
        "0.040 horn.Sound: Quiet.exit, first.effect, Loud.entry",
        "0.100 horn.Sound: Loud.exit, second.effect, Louder.entry",
        "0.260 horn.Sound: Louder.exit, worn.effect, Worn.entry",
    ]


@pytest.mark.slow
def test_the_first_version_of_the_body_compiles_and_sends_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copy(MODEL, tmp_path)
    assert main(["generate", str(tmp_path / "model.yaml")]) == 0
    body = (tmp_path / "user" / "may_send_feature-gauge_type-activities.adb").read_text()
    for port in ("Alarm", "Report"):
        assert f"      Send_{port} := False;\n" in body
    capsys.readouterr()
    assert _simulated(tmp_path, capsys) == ["0.000 horn.Sound: Quiet.entry"]
