# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`make hw-test`: the steps that a guest of QEMU runs, with drivers of CAN controllers.

A case of a step is a subtest: skipped with its reason, or failed with what was seen. The guest is
booted once, with the steps that are chosen (`-k driver-vcan0`).
"""

from __future__ import annotations

import platform
from pathlib import Path

import pytest

from ravenchart.tools.toolchain import ToolMissing
from tests.hardware import guest
from tests.hardware.guest import PASSED, SKIPPED, Guest, Step

STEPS = guest.steps("python", Path("obj"), Path("controller"))


@pytest.fixture(scope="session")
def booted(request: pytest.FixtureRequest) -> Guest:
    """The guest, when it has run the chosen steps; skipped where there can be none."""
    reasons = tuple(guest.missing(guest.KERNEL, platform.machine()))
    if reasons:
        pytest.skip("; ".join(reasons))
    tests = [one for one in request.session.items if isinstance(one, pytest.Function)]
    chosen = [step for one in tests for step in one.callspec.params.values()]
    try:
        return guest.run({step.name for step in chosen if isinstance(step, Step)})
    except ToolMissing as tool:
        pytest.skip(str(tool))


@pytest.mark.parametrize("step", STEPS, ids=[step.name for step in STEPS])
def test_a_step_passes_in_the_guest(booted: Guest, step: Step, subtests: pytest.Subtests) -> None:
    cases = booted.cases(step)
    print(booted.said(step))
    assert [case for case in cases if case.verdict == PASSED], "nothing passed"
    for case in cases:
        with subtests.test(msg=case.name):
            if case.verdict == SKIPPED:
                pytest.skip(case.detail)
            assert case.verdict == PASSED, case.detail
