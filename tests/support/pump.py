# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A small valid model, and models made from it by replacing text."""

from __future__ import annotations

from pathlib import Path

from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load

PUMP = """\
system: Pump_House

types:
  Level: {range: [0, 1000], unit: mm}
  Mode: {values: [Off, Filling]}
  Report: {fields: {mode: Mode, level: Level}}

components:
  Tank:
    parameters:
      limit: {type: Level, default: 900}
    ports:
      level: {in: Level, max_age: 100 ms, on_stale: Lost}
      valve: {out: Report}
    port_region: {period: 10 ms, wcet: 20 us}
    events: [Lost]
    data:
      wanted: {type: Mode, initial: Off}
    regions:
      Control:
        period: 10 ms
        wcet: 30 us
        queue: 4
        initial: Idle
        safe_state: Idle
        states:
          Idle:
            entry: [{set: wanted, to: Off}]
          Filling:
            entry: [{set: wanted, to: Filling}]
        transitions:
          fill: {from: Idle, to: Filling, when: level < limit}
          full: {from: Filling, to: Idle, when: level >= limit}
          lost: {from: Filling, to: Idle, on: Lost}
    activities:
      tell:
        period: 20 ms
        wcet: 30 us
        body:
          - {send: valve, with: {mode: wanted, level: level}}

nodes:
  board: {context_switch: 5 us, critical_section: 2 us}

buses:
  can_bus: {bit_rate: 500 kbit/s, driver_wcet: 20 us, receive_depth: 8, transmit_depth: 8}

instances:
  north: {component: Tank, node: board}

messages:
  level_in: {bus: can_bus, id: 0x100, to: north.level, period: 10 ms}
  valve_out: {bus: can_bus, id: 0x101, from: north.valve}

processors:
  reception:
    {node: board, released_by: can_bus, period: 1 ms, stack: 8 KiB, activities: [can_bus.receive]}
  regulation:
    {node: board, stack: 16 KiB, activities: [north.ports, north.Control, north.tell]}
"""


def changed(*replacements: tuple[str, str]) -> str:
    """The model with each text, which must occur, replaced."""
    text = PUMP
    for old, new in replacements:
        assert old in text, old
        text = text.replace(old, new)
    return text


def loaded(text: str | bytes, **others: str) -> Loaded:
    """What loading the text as model.yaml gives; ``others`` are files by stem."""
    files = {f"{stem}.yaml": content.encode() for stem, content in others.items()}
    files["model.yaml"] = text.encode() if isinstance(text, str) else text

    def read(path: Path, limit: int) -> bytes:
        if str(path) not in files:
            raise FileNotFoundError(2, "No such file or directory")
        return files[str(path)][:limit]

    return load(Path("model.yaml"), read)


def system_of(*replacements: tuple[str, str]) -> System:
    """The system of the changed model, which must be valid."""
    result = loaded(changed(*replacements))
    assert result.system is not None, [str(item) for item in result.diagnostics]
    return result.system


def codes(*replacements: tuple[str, str]) -> list[str]:
    """The codes of what is found in the changed model, in order of place."""
    return [item.code for item in loaded(changed(*replacements)).diagnostics]
