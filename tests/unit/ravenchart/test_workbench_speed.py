# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How long a change of a hundred activities takes, from the message to the state for the page."""

from __future__ import annotations

import statistics
from pathlib import Path

import pytest

from ravenchart.workbench.session import Session
from tests.support.workbench_speed import ANALYSED, analysed, hundred


@pytest.mark.slow
@pytest.mark.alone
def test_a_change_of_a_hundred_activities_is_analysed_at_once(tmp_path: Path) -> None:
    """By processor time, which is that of a machine that does nothing else."""
    session = Session(hundred(tmp_path))
    assert session.now.analysis is not None
    assert sum(len(p.slots) for p in session.now.analysis.system.processors) == 101
    taken = list(analysed(session))
    assert session.now.analysis.schedulable
    print(f"median {statistics.median(taken):.0f} ms, longest {max(taken):.0f} ms")
    assert statistics.median(taken) < ANALYSED
