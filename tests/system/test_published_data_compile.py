# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Published data, whoever writes and reads them: the program compiles without a warning."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.building import checking, generation, programs

pytestmark = pytest.mark.slow

FRAME = """\
system: Published
types: {{Rate: {{range: [0, 100]}}}}
commands:
  Stop: {{kind: void}}
  Get_Rate: {{kind: read, reply: Rate}}
components:
  Pump:
    provides:
      Control: {{queue: 2, served_by: serve, commands: [Stop], published: {{Get_Rate: rate}}}}
    data: {{rate: {{type: Rate, initial: 0}}{other}}}
    activities:
      serve: {{period: 10 ms, wcet: 10 us, body: user}}
{activity}
    regions:
      Drive:
        period: 10 ms
        wcet: 10 us
        queue: 2
        initial: A
        states: {{A: {{}}, B: {{entry: [{{set: {drive}, to: 7}}]}}}}
        transitions:
          go: {{from: A, to: B, after: 50 ms}}
          back: {{from: B, to: A, after: 50 ms}}
  Panel:
    requires:
      Pump: {{commands: [Stop, Get_Rate]}}
    regions:
      Work:
        period: 10 ms
        wcet: 10 us
        queue: 2
        initial: A
        states: {{A: {{}}, B: {{entry: [{{call: Stop}}]}}}}
        transitions:
          go: {{from: A, to: B, {trigger}}}
          back: {{from: B, to: A, after: 50 ms}}
nodes: {{board: {{context_switch: 5 us, critical_section: 2 us}}}}
instances:
  pump_1: {{component: Pump, node: board}}
  panel_1: {{component: Panel, node: board}}
bindings: [{{from: panel_1.Pump, to: pump_1.Control}}]
processors:
  one: {{stack: 16 KiB, activities: [pump_1.serve, pump_1.Drive{work}{same}]}}
{two}"""
WRITES = '      turn: {period: 10 ms, wcet: 10 us, body: [{set: rate, to: "min(rate + 1, 100)"}]}'


def _model(writer: str, reader: str) -> str:
    is_region, is_near = writer == "region", reader == "in its table"
    two = "" if is_near else "  two: {stack: 16 KiB, activities: [panel_1.Work]}\n"
    return FRAME.format(
        activity="" if is_region else WRITES,
        other="" if is_region else ", other: {type: Rate, initial: 0}",
        drive="rate" if is_region else "other",
        trigger="after: 50 ms" if reader == "nobody" else "when: Get_Rate > 5",
        work="" if is_region else ", pump_1.turn",
        same=", panel_1.Work" if is_near else "",
        two=two,
    )


@pytest.mark.parametrize(
    ("writer", "reader"),
    [
        ("region", "nobody"),
        ("region", "in its table"),
        ("region", "on another processor"),
        ("activity", "nobody"),
    ],
)
def test_a_published_item_compiles(writer: str, reader: str, tmp_path: Path) -> None:
    model = tmp_path / "model.yaml"
    model.write_text(_model(writer, reader), encoding="utf-8")
    checked = checking.check(model)
    assert not checked.warnings
    generation.write_program(checked)
    for made in programs.programs_of(checked):
        made.build()
