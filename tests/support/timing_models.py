# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Small models of which a bound was once too low."""

from __future__ import annotations

from pathlib import Path

from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.gen.pipeline import load

HEAD = """\
system: Sample
types: {Word: {range: [0, 100]}}
nodes:
  cpu: {context_switch: 5 us, critical_section: 5 us}
buses:
  can0: {bit_rate: 500 kbit/s, driver_wcet: 40 us, receive_depth: 8, transmit_depth: 8}
shutdown: {raises: [], grace: 10 ms}
"""

RECEPTION = """\
processors:
  reception: {node: cpu, released_by: can0, period: 1 ms, stack: 32 KiB, activities: [can0.receive]}
"""

SWITCHES = (
    HEAD
    + RECEPTION
    + """\
  work: {node: cpu, stack: 32 KiB, activities: [k.ports, k.act]}
components:
  C:
    ports: {i: {in: Word}}
    port_region: {period: 20 ms, wcet: 100 us}
    data: {n: {type: Word, initial: 0}}
    activities:
      act: {period: 20 ms, wcet: 14000 us, body: [{set: n, to: i}]}
instances: {k: {component: C, node: cpu}}
messages: {m: {bus: can0, id: 0x110, to: k.i, period: 2 ms}}
"""
)

QUEUE = (
    HEAD
    + RECEPTION
    + """\
  port_work: {node: cpu, stack: 32 KiB, activities: [d.ports]}
  work: {node: cpu, stack: 32 KiB, activities: [d.act]}
components:
  Dst:
    ports: {i: {in: Word, kind: queued, depth: 4}, valve: {out: Word}}
    port_region: {period: 10 ms, wcet: 100 us}
    activities:
      act: {period: 10 ms, wcet: 100 us, body: [{send: valve, with: i}]}
instances: {d: {component: Dst, node: cpu}}
messages:
  cmd: {bus: can0, id: 0x110, to: d.i, period: 100 ms, sporadic: no}
  valve: {bus: can0, id: 0x120, from: d.valve}
chains:
  cmd: {path: [cmd, d.act, valve], age: 200 ms, reaction: 200 ms}
"""
)

CHART = (
    HEAD
    + RECEPTION
    + """\
  work: {node: cpu, stack: 32 KiB, activities: [brk.ports, brk.Main, brk.act]}
components:
  Brake:
    ports:
      a: {in: Word, kind: queued, depth: 4, on_arrival: E_A}
      stop: {in: Word, kind: queued, depth: 4, on_arrival: E_Stop}
      valve: {out: Word}
    port_region: {period: 20 ms, wcet: 100 us}
    events: [E_A, E_Stop]
    data: {level: {type: Word, initial: 0}}
    regions:
      Main:
        period: 20 ms
        wcet: 100 us
        queue: 8
        initial: Run
        states:
          Run: {}
          Halted: {entry: [{set: level, to: stop}]}
        transitions:
          a: {from: Run, to: Run, on: E_A}
          halt: {from: Run, to: Halted, on: E_Stop}
          go: {from: Halted, to: Run, on: E_A}
    activities:
      act: {period: 20 ms, wcet: 100 us, body: [{send: valve, with: level}]}
instances: {brk: {component: Brake, node: cpu}}
messages:
  a: {bus: can0, id: 0x100, to: brk.a, period: 80 ms}
  stop: {bus: can0, id: 0x110, to: brk.stop, period: 80 ms}
  valve: {bus: can0, id: 0x120, from: brk.valve}
chains:
  stop: {path: [stop, brk.Main, brk.act, valve], reaction: 90 ms}
"""
)

SEVERAL = (
    HEAD
    + RECEPTION
    + """\
  work: {node: cpu, stack: 32 KiB, activities: [s.ports, s.one, s.two, d.ports, d.act]}
components:
  Src:
    ports: {cmd: {in: Word}, o: {out: Word}}
    port_region: {period: 20 ms, wcet: 100 us}
    activities:
      one: {period: 20 ms, wcet: 100 us, body: [{send: o, with: cmd}]}
      two: {period: 20 ms, wcet: 100 us, body: [{send: o, with: cmd}]}
  Dst:
    ports: {i: {in: Word, kind: queued, depth: 8}, valve: {out: Word}}
    port_region: {period: 20 ms, wcet: 100 us}
    activities:
      act: {period: 20 ms, wcet: 100 us, body: [{send: valve, with: i}]}
instances: {s: {component: Src, node: cpu}, d: {component: Dst, node: cpu}}
connections: [{from: s.o, to: d.i}]
messages:
  cmd: {bus: can0, id: 0x110, to: s.cmd, period: 80 ms}
  valve: {bus: can0, id: 0x120, from: d.valve}
chains:
  cmd: {path: [cmd, s.one, d.act, valve], reaction: 60 ms}
"""
)
KEPT = QUEUE.replace("[d.act]", "[d.look, d.act]").replace(
    """\
    activities:
      act: {period: 10 ms, wcet: 100 us, body: [{send: valve, with: i}]}
""",
    """\
    data: {level: {type: Word, initial: 0}}
    activities:
      look: {period: 10 ms, wcet: 100 us, body: [{if: i > 3, then: [{set: level, to: i}]}]}
      act: {period: 10 ms, wcet: 100 us, body: [{send: valve, with: level}]}
""",
)
"""A valve of which a command is set in some jobs only."""


def analysed(text: str, *replacements: tuple[str, str]) -> Analysis:
    """The timing of a model that is valid; each replacement occurs in it."""
    for old, new in replacements:
        assert old in text, old
        text = text.replace(old, new)
    result = load(Path("model.yaml"), lambda path, limit: text.encode()[:limit])
    assert result.system is not None, [str(item) for item in result.diagnostics]
    return analyse(result.system)


def worker(control: str, toil: str) -> str:
    """Types, and a component with a chart and an activity of these execution times."""
    return f"""\
types:
  Count: {{range: [0, 1000]}}
components:
  Worker:
    events: [Late]
    data: {{rounds: {{type: Count, initial: 0}}}}
    regions:
      Control:
        period: 10 ms
        wcet: {control}
        queue: 4
        initial: Fine
        states: {{Fine: {{}}, Tardy: {{}}}}
        transitions:
          late: {{from: Fine, to: Tardy, on: Late}}
    activities:
      toil:
        period: 10 ms
        wcet: {toil}
        body:
          - {{set: rounds, to: "min(rounds + 1, 1000)"}}
"""
