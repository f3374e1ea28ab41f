# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How long a change of a hundred activities takes, from the message to the state for the page."""

from __future__ import annotations

import json
import statistics
import time
from pathlib import Path

import pytest

from ravenchart.workbench.requests import Move, SetTime
from ravenchart.workbench.session import Session
from ravenchart.workbench.view import whole_view
from tests.support.workbench_models import hundred_activities

LIMIT = 1.0
"""Seconds on a busy machine; the aim is 0.2 s."""


@pytest.mark.slow
@pytest.mark.alone
def test_a_change_of_a_hundred_activities_is_analysed_at_once(tmp_path: Path) -> None:
    model = tmp_path / "model.yaml"
    model.write_text(hundred_activities(), encoding="utf-8")
    session = Session(model)
    assert session.now.analysis is not None
    assert sum(len(p.slots) for p in session.now.analysis.system.processors) == 101
    taken = []
    for number in range(10):
        begin = time.perf_counter()
        if number % 2:
            row, place = "u3.act0", number % 7
            session.change(Move(kind="move", row=row, to="p10", place=place, number=0))
        else:
            value = f"{101 + number} us"
            session.change(SetTime(kind="time", row="u0.act0", key="wcet", value=value, number=0))
        json.dumps(whole_view(session))
        taken.append(time.perf_counter() - begin)
    assert session.now.analysis.schedulable
    print(f"median {1000 * statistics.median(taken):.0f} ms, longest {1000 * max(taken):.0f} ms")
    assert statistics.median(taken) < LIMIT
