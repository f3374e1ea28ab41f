# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The CAN driver `xilinx` on a model of its registers: filter, counts, bus-off and recovery."""

from __future__ import annotations

import subprocess

import pytest

from ravenchart.paths import ROOT
from ravenchart.tools import toolchain
from tests.support.modes import MODES

pytestmark = pytest.mark.clock


@pytest.mark.parametrize("mode", MODES)
def test_the_driver_counts_what_it_loses_and_recovers_on_request(mode: str) -> None:
    where = ROOT / "tests" / "ada" / "xcan"
    toolchain.run("gprbuild", ["-p", "-q", "-P", "xcan.gpr"], where, {"MODE": mode})
    program = ROOT / "obj" / f"tests-xcan-{mode}" / "test_xcan_driver"
    done = subprocess.run([program], capture_output=True, text=True, timeout=60, check=False)
    facts = done.stdout.splitlines()
    assert len(facts) == 13
    assert [fact for fact in facts if not fact.startswith("ok ")] == []
    assert done.returncode == 0
