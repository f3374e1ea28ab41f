# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Models with one chart, written down in a few lines."""

from __future__ import annotations

from textwrap import indent

from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import Region
from tests.support.pump import loaded

FRAME = """\
system: Bench

types:
  Distance: {{range: [0, 100], unit: mm}}
  Angle: {{range: [0, 360]}}
  Pose: {{fields: {{x: Distance, turn: Angle}}}}

components:
  Unit:
    events: {events}
    data:
      place: {{type: Distance, initial: 0}}
      pose: {{type: Pose, initial: {{x: 0, turn: 0}}}}
{more}
    regions:
      Motion:
        period: 10 ms
        wcet: 1 ms
{region}
        states:
{states}
        transitions:
{transitions}

nodes:
  board: {{context_switch: 5 us, critical_section: 2 us}}

instances:
  plant: {{component: Unit, node: board}}

processors:
  runner:
    node: board
    stack: 16 KiB
    activities: [{rows}]
    on_deadline_miss: [{raised}]
"""


def chart_text(
    states: str,
    transitions: str,
    *,
    region: str = "initial: A\nqueue: 4",
    events: str = "[Go, Stop]",
    raised: str = "plant.Go, plant.Stop",
    more: str = "",
    rows: str = "plant.Motion",
) -> str:
    """A model whose region Motion has these states and transitions."""
    return FRAME.format(
        events=events,
        raised=raised,
        rows=rows,
        more=indent(more, " " * 4),
        region=indent(region, " " * 8),
        states=indent(states, " " * 10),
        transitions=indent(transitions, " " * 10),
    )


def component_of(text: str) -> Component:
    """The component of the model, in which nothing is wrong."""
    result = loaded(text)
    assert result.system is not None, result.diagnostics
    return result.system.components[0]


def region_of(text: str) -> Region:
    """The region Motion of the model."""
    return component_of(text).region("Motion")


def found(text: str) -> list[tuple[str, str]]:
    """Code and message of what is found in a model; not every chart uses all of its data."""
    told = loaded(text).diagnostics
    return [(item.code, item.message) for item in told if item.code != "RV-0534"]
