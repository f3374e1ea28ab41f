# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The modes of data that a flow sets: `out` where no value from before is used."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.building import checking
from ravenchart.gen.emit.components.packages import activity_params

MODEL = """
system: Modes
types:
  Level: {range: [0, 1000]}
components:
  Tank:
    ports:
      height: {in: Level}
      told: {out: Level}
    port_region: {period: 10 ms, wcet: 20 us}
    data:
      level: {type: Level, initial: 0}
    activities:
      work: {period: 10 ms, wcet: 20 us, body: BODY}
nodes:
  board: {context_switch: 5 us, critical_section: 2 us}
buses:
  line: {bit_rate: 500 kbit/s, driver_wcet: 20 us, receive_depth: 8, transmit_depth: 8}
instances:
  tank_1: {component: Tank, node: board}
messages:
  height_in: {bus: line, id: 0x100, to: tank_1.height, period: 10 ms}
  told_out: {bus: line, id: 0x101, from: tank_1.told}
processors:
  reception: {released_by: line, period: 1 ms, stack: 16 KiB, activities: [line.receive]}
  works: {stack: 16 KiB, activities: [tank_1.ports, tank_1.work]}
"""
SET = "{set: level, to: height}"
TOLD = "{send: told, with: level}"


@pytest.mark.parametrize(
    ("body", "mode"),
    [
        (f"[{SET}]", "out"),
        (f"[{SET}, {TOLD}]", "out"),
        (f"[{TOLD}, {SET}]", "in out"),
        ('[{set: level, to: "max(level, height)"}]', "in out"),
        (f"[{{if: height > 3, then: [{SET}]}}, {TOLD}]", "in out"),
        (f"[{{if: height > 3, then: [{SET}], else: [{{set: level, to: 0}}]}}, {TOLD}]", "out"),
        (f"[{{if: height > 3, then: [{TOLD}]}}, {SET}]", "in out"),
        (f"[{{if: level > 3, then: [{SET}], else: [{{set: level, to: 0}}]}}]", "in out"),
    ],
)
def test_what_is_set_before_it_is_read_has_mode_out(body: str, mode: str, tmp_path: Path) -> None:
    if TOLD not in body:
        body = f"{body[:-1]}, {{send: told, with: height}}]"
    model = tmp_path / "model.yaml"
    model.write_text(MODEL.replace("BODY", body), encoding="utf-8")
    system = checking.check(model).system
    (component,) = system.components
    params = activity_params(system, component, component.activities[0])
    assert [one.mode for one in params if one.name == "Level"] == [mode]
