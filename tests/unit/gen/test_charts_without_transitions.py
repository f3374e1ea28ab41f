# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A chart without transitions is a chart: it enters its states, and is checked like others."""

from __future__ import annotations

import pytest

from tests.support.behaviour_models import model, region, said
from tests.support.interpreted import steps


def test_nothing_is_wrong_with_it() -> None:
    still = region("Main", "{A: {entry: [{set: armed, to: true}]}}", "{}")
    assert not said(model(still))


@pytest.mark.parametrize("none", ["", "transitions: {}"])
def test_it_enters_its_states_and_stays(none: str) -> None:
    chart = f"""
    initial: A
    states: {{A: {{initial: B, states: {{B: {{entry: [{{set: x, to: 1}}]}}}}}}}}
    {none}
    data: {{x: 0}}
    """
    assert steps(chart) == ["0 A.entry, B.entry"]
