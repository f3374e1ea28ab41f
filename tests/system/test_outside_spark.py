# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A proof says what is outside SPARK, and fails unless a list names it with a reason."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from ravenchart.command_line import main
from ravenchart.evidence import records
from ravenchart.failures import OK, WRONG
from ravenchart.tools import toolchain
from tests import house

MODEL = """\
system: Demo
types:
  Level: {range: [0, 2000], unit: mm}
components:
  Sensor:
    data:
      height: {type: Level, initial: 500}
    activities:
      read: {period: 20 ms, wcet: 200 us, reads: [height], writes: [height], body: user}
nodes:
  board: {context_switch: 10 us, critical_section: 5 us}
instances:
  unit: {component: Sensor, node: board}
processors:
  sampling: {node: board, stack: 32 KiB, activities: [unit.read]}
shutdown: {raises: [], grace: 0 ms}
"""
BODY = """\
package body Demo.Sensor.Activities{mode}
is

   procedure Read (Height : in out Level){own}
   is
   begin
      Height := Height{change};
   end Read;

end Demo.Sensor.Activities;
"""
IMPORTED = """\
package body Demo.Sensor.Activities
  with SPARK_Mode
is

   procedure Read (Height : in out Level)
   is
      procedure Sample (Height : in out Level)
      with Import, Convention => Ada, Global => null;
   begin
      Sample (Height);
   end Read;

end Demo.Sensor.Activities;
"""
BODIES = {
    "forgotten": BODY.format(mode="", own="", change=" + 1"),
    "switched off": BODY.format(
        mode="\n  with SPARK_Mode", own="\n   with SPARK_Mode => Off", change=" + 1"
    ),
    "imported": IMPORTED,
}
NAMES = {
    "forgotten": ("Demo.Sensor.Activities", "Demo.Sensor.Activities.Read"),
    "switched off": ("Demo.Sensor.Activities.Read",),
    "imported": ("Demo.Sensor.Activities.Read.Sample",),
}

pytestmark = pytest.mark.skipif(not toolchain.have("gnatprove"), reason="gnatprove is not on PATH")


def _model(folder: Path, body: str) -> str:
    (folder / "user").mkdir()
    (folder / "user" / "demo-sensor-activities.adb").write_text(body)
    (folder / "model.yaml").write_text(MODEL)
    return str(folder / "model.yaml")


@pytest.mark.parametrize("case", BODIES)
def test_a_body_outside_spark_fails_the_proof_by_name(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = _model(tmp_path, BODIES[case])
    assert main(["prove", model]) == WRONG
    told = capsys.readouterr().err
    for name in NAMES[case]:
        assert f"error: {name} (demo-sensor-activities.ad" in told
    (tmp_path / "outside_spark.toml").write_text(f'"{NAMES[case][0]}" = "test T-12"\n')
    assert main(["prove", model]) == OK
    assert f"outside SPARK: {NAMES[case][0]} (test T-12)" in capsys.readouterr().out


def test_a_list_must_give_reasons_and_cover_something(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = _model(tmp_path, BODY.format(mode="\n  with SPARK_Mode", own="", change=" / 2"))
    assert main(["prove", model]) == OK
    listed = tmp_path / "outside_spark.toml"
    listed.write_text('"Demo.Sensor" = "test T-12"\n')
    assert main(["prove", model]) == WRONG
    assert "error: Demo.Sensor stands in outside_spark.toml, but nothing" in capsys.readouterr().err
    listed.write_text('"Demo.Sensor" = ""\n')
    assert main(["prove", model]) == WRONG
    assert "error: Demo.Sensor has no reason" in capsys.readouterr().err


def test_results_do_not_depend_on_what_lies_in_the_object_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = _model(tmp_path, BODY.format(mode="\n  with SPARK_Mode", own="", change=" / 2"))
    assert main(["prove", model, "--fresh"]) == OK
    first = capsys.readouterr().out.splitlines()[-1]
    assert main(["build", model]) == OK
    capsys.readouterr()
    assert main(["prove", model, "--fresh"]) == OK
    assert capsys.readouterr().out.splitlines()[-1] == first


def test_the_list_of_this_project_names_entries_of_the_ledger() -> None:
    ledger = (house.RECORDS.parent / "assumptions.md").read_text()
    listed = tomllib.loads(house.OUTSIDE.read_text())
    assert listed
    for target, table in listed.items():
        assert records.of_target(target) is not None, target
        for name, reason in table.items():
            assert f"## {reason}:" in ledger, (target, name)
