# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Where a region has stopped nothing is selected, in whatever state its terminate stands."""

from __future__ import annotations

import re

from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.charts.declared import emit_region
from tests.support.interpreted import chart_system

CHART = """
initial: Idle
states:
  Idle: {}
  Inside: {initial: Busy, states: {Busy: {}, Stop: {kind: terminate}}}
transitions:
  enter: {from: Idle, to: Inside, on: Go}
  halt: {from: Busy, to: Stop, on: Go}
  away: {from: Inside, to: Idle, on: Bye}
"""


def test_a_state_around_a_terminate_is_not_active_in_it() -> None:
    system = chart_system(CHART)
    component = system.components[0]
    _, body = emit_region(system, component, component.regions[0], "")
    profile = r"function In_Stop \(Self : Region; Now : Occurrence\) return Selection"
    assert re.search(rf"{profile} is\s+\(None\)", print_unit(body))
