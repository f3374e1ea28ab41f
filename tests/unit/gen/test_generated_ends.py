# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Where a region has stopped nothing is selected, in whatever state its terminate stands."""

from __future__ import annotations

import re

from ravenchart.gen.emit.ada.declarations import Unit
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.charts.declared import emit_region
from ravenchart.gen.emit.language.configurations import Configurations
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
    (region,) = component.regions
    spec, _ = emit_region(system, component, region, "")
    assert "when Away => Leaf in Main_States.Inside" in print_unit(spec)
    states = print_unit(Unit("", (), Configurations(region).package_of_states(system.origin)))
    assert re.search(r"type Leaf is\s+\(Idle, .*\s+Busy, .*\s+Stop\b", states)
    assert "subtype Inside is Leaf range Busy .. Busy;" in states
