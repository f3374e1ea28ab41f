# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Codecs and lengths of time on an emulated AArch64, without a run-time library of others."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from tests.support import bare

pytestmark = pytest.mark.skipif(bare.missing() is not None, reason=bare.missing() or "")

FOLDERS = (
    ROOT / "examples" / "cartesian_robot" / "generated",
    ROOT / "spark_runtime" / "src",
    ROOT / "hw_can" / "hal",
)
BROKEN = """\
with Lines;
procedure Broken is
   function Twice (Value : Integer) return Integer
   is (Value + 1)
   with Post => Twice'Result = 2 * Value;
begin
   Lines.Put (Character'Val (Twice (64)));
   Lines.Put ('!');
end Broken;
"""


def test_codecs_and_ticks_are_the_same_as_on_this_machine(tmp_path: Path) -> None:
    program = bare.image("codec_lines", FOLDERS, tmp_path)
    status, written = bare.emulated(program)
    assert status == 0
    assert len(written.splitlines()) == 600
    assert written == bare.native("codec_lines", FOLDERS, tmp_path / "host")


def test_a_contract_that_does_not_hold_ends_the_run(tmp_path: Path) -> None:
    (tmp_path / "broken.adb").write_text(BROKEN, encoding="ascii")
    status, written = bare.emulated(bare.image("broken", (tmp_path,), tmp_path))
    assert (status, written) == (1, "")


def test_two_can_controllers_exchange_every_kind_of_frame(tmp_path: Path) -> None:
    folders = (FOLDERS[1], FOLDERS[2], ROOT / "hw_can" / "drivers" / "xilinx")
    bus = ("-object", "can-bus,id=bus", "-machine", "canbus0=bus,canbus1=bus")
    status, written = bare.emulated(bare.image("can_pair", folders, tmp_path), *bus)
    facts = written.splitlines()
    assert status == 0, written
    assert len(facts) == 8
    assert [fact for fact in facts if not fact.startswith("ok ")] == []
