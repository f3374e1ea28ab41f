# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A model of two nodes: a command, a link between them, and a valve that follows."""

LINK = """\
system: Sample
types: {Word: {range: [0, 100]}}
nodes:
  cpu: {context_switch: 5 us, critical_section: 5 us}
  far: {context_switch: 5 us, critical_section: 5 us}
buses:
  can0: {bit_rate: 500 kbit/s, driver_wcet: 40 us, receive_depth: 8, transmit_depth: 8}
components:
  Src:
    ports: {cmd: {in: Word}, o: {out: Word}}
    port_region: {period: 10 ms, wcet: 100 us}
    activities:
      one: {period: 10 ms, wcet: 100 us, body: [{send: o, with: cmd}]}
  Dst:
    ports: {i: {in: Word}, valve: {out: Word}}
    port_region: {period: 20 ms, wcet: 100 us}
    activities:
      act: {period: 20 ms, wcet: 100 us, body: [{send: valve, with: i}]}
instances: {s: {component: Src, node: cpu}, d: {component: Dst, node: far}}
messages:
  cmd: {bus: can0, id: 0x110, to: s.cmd, period: 10 ms, sporadic: no}
  link: {bus: can0, id: 0x111, from: s.o, to: d.i}
  valve: {bus: can0, id: 0x120, from: d.valve}
processors:
  reception: {released_by: can0, period: 1 ms, stack: 32 KiB, activities: [can0.receive]}
  work: {stack: 32 KiB, activities: [s.ports, s.one]}
  rest: {stack: 32 KiB, activities: [d.ports, d.act]}
chains:
  cmd: {path: [cmd, s.one, link, d.act, valve], reaction: 900 ms, age: 900 ms}
shutdown: {raises: [], grace: 10 ms}
"""
