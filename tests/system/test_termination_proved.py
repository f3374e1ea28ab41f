# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Each execution of a row ends: `prove` shows it, and names the row where it does not."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from ravenchart.building import checking, programs
from ravenchart.command_line import main
from ravenchart.evidence.records import of_termination
from ravenchart.gen.emit.nodes.termination import (
    SLOTS,
    TerminationForm,
    ending_claims,
    termination_files,
)
from ravenchart.paths import ROOT
from ravenchart.tools import toolchain

FEATURE = ROOT / "tests" / "feature" / "contracts"
MODEL = "model.yaml"
BODY = "user/contracts_feature-plant-activities.adb"
proved = pytest.mark.skipif(
    not toolchain.have("gnatprove"), reason="gnatprove is not on PATH: nothing is proved"
)


def test_there_is_a_claim_for_each_row_and_for_what_a_processor_calls() -> None:
    checked = checking.check(FEATURE / MODEL)
    (program,) = programs.programs_of(checked)
    claims = ending_claims(program.part)
    rows = [slot.element for one in program.part.processors for slot in one.slots]
    assert [claim.element for claim in claims if "." in claim.element] == rows
    names = {one.name for one in program.part.processors}
    assert {claim.element for claim in claims} == {*rows, *names}
    assert len({claim.entity.lower() for claim in claims}) == len(claims)
    for declared in TerminationForm:
        files = termination_files(program.part, ROOT, Path("x.gpr"), declared)
        spec = files["contracts_feature-termination.ads"]
        assert spec.count(declared.value) == len(claims)
        assert files[f"runtime/{SLOTS}"].count(declared.value) == 2
        (other,) = (one for one in TerminationForm if one is not declared)
        assert other.value not in spec


def _in_boost(more: str) -> Callable[[str], str]:
    """The body with more statements behind the one of `Boost`."""
    one = "      Share := Rate + Rate;\n"
    return lambda text: text.replace(one, f"{one}{more}")


AGAIN = """
   procedure Again (Left : Natural);

   procedure Again (Left : Natural) is
   begin
      if Left > 0 then
         Again (Left - 1);
      end if;
   end Again;
"""
CHANGES: dict[str, tuple[Callable[[str], str], bool]] = {
    "as it is": (lambda text: text, True),
    "a loop with a variant": (
        _in_boost(
            "      declare\n         Left : Natural := 3;\n      begin\n"
            "         while Left > 0 loop\n"
            "            pragma Loop_Variant (Decreases => Left);\n"
            "            Left := Left - 1;\n         end loop;\n      end;\n"
        ),
        True,
    ),
    "an endless loop": (
        _in_boost("      while Share > 50 loop\n         null;\n      end loop;\n"),
        False,
    ),
    "a recursion": (
        lambda text: _in_boost("      Again (3);\n")(text).replace(
            "is\n   procedure Filter", f"is{AGAIN}\n   procedure Filter"
        ),
        False,
    ),
}


@proved
@pytest.mark.slow
@pytest.mark.parametrize("change", CHANGES)
def test_what_may_not_end_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], change: str
) -> None:
    changed, ends = CHANGES[change]
    folder = tmp_path / "contracts"
    shutil.copytree(FEATURE, folder)
    text = (folder / BODY).read_text(encoding="utf-8")
    assert changed(text) != text or change == "as it is"
    (folder / BODY).write_text(changed(text), encoding="utf-8")
    code = main(["prove", str(folder / MODEL), "--record", str(folder / "proof.toml")])
    said = "".join(capsys.readouterr())
    assert f"rows end: {'proved' if ends else 'NOT PROVED'}\n" in said
    assert (code == 0) is ends
    found = [line for line in said.splitlines() if "may never end" in line]
    rows = {f"an execution of {one}.boost may never end" for one in ("plant_1", "plant_2")}
    assert {line.rpartition("not proved: ")[2] for line in found} == (set() if ends else rows)
    assert all(line.startswith(f"{folder / MODEL}:") for line in found)
    record = of_termination(folder / "proof.toml").read_text(encoding="utf-8")
    assert f'{BODY}" = "' in record


@proved
@pytest.mark.slow
def test_rows_that_may_call_bodies_outside_spark_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "contracts"
    shutil.copytree(FEATURE, folder)
    body = folder / BODY
    head = "      Noted  : out Boolean)\n   is\n"
    text = body.read_text(encoding="utf-8")
    assert text.count(head) == 1
    body.write_text(text.replace(head, head.replace("   is", "   with SPARK_Mode => Off\n   is")))
    name = "Contracts_Feature.Plant.Activities.Filter"
    (folder / "outside_spark.toml").write_text(f'"{name}" = "tried"\n')
    record = str(folder / "proof.toml")
    assert main(["prove", str(folder / MODEL), "--record", record]) == 0
    line = (
        "executions of 12 of 14 rows end: proved; bodies outside SPARK may be below "
        "plant_1.filter, plant_2.filter"
    )
    assert line in "".join(capsys.readouterr())
    main(["evidence", str(folder / MODEL), "--record", record])
    claims = json.loads((folder / "evidence" / "evidence.json").read_text())["claims"]
    (claim,) = (one for one in claims if one["id"] == "termination")
    assert claim["verdict"] == "partly" and name in claim["reasons"][0]
