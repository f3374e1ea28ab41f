# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A door whose drive has a protocol, and changes of it."""

from __future__ import annotations

PROTOCOL = """\
{initial: Off, states: [Off, On], transitions: {enable: {from: Off, to: On, on: Enable}, \
move: {from: On, on: Move}, disable: {from: On, to: Off, on: Disable}}}"""
DOOR = """\
system: Door_House
types:
  Opening: {range: [0, 100]}
commands:
  Enable: {kind: void}
  Move: {kind: write, argument: Opening}
  Disable: {kind: void}
  Ping: {kind: void}
  Get_Opening: {kind: read, reply: Opening}
components:
  Drive:
    provides:
      Motion: {queue: 4, served_by: serve, commands: [Enable, Move, Disable, Ping], \
published: {Get_Opening: opening}, protocol: PROTOCOL}
    data:
      opening: {type: Opening, initial: 0}
    activities:
      serve: {period: 10 ms, wcet: 50 us, writes: [opening], body: user}
  Door:
    events: {Open: {external: true}, Close: {external: true}, Stop: {external: true}}
    requires:
      Gate: {commands: [Enable, Move, Disable, Ping, Get_Opening]}
    data:
      ready: {type: Boolean, initial: false}
      seen: {type: Opening, initial: 0}
    regions:
      Sequence:
        period: 20 ms
        wcet: 100 us
        queue: 4
        initial: Closed
        states:
          Closed: {}
          Opened:
            entry: [{call: Enable}, {call: Move, with: 100}, {set: ready, to: true}]
            exit: [{call: Move, with: 0}, {call: Disable}, {set: ready, to: false}]
        transitions:
          open: {from: Closed, to: Opened, on: Open}
          close: {from: Opened, to: Closed, on: Close}
          stop: {from: Opened, on: Stop, effect: [{call: Move, with: 50}]}
          ping: {from: Closed, on: Stop, effect: [{call: Ping}]}
    activities:
      note: {period: 20 ms, wcet: 20 us, body: [{set: seen, to: Get_Opening}]}
nodes:
  board: {context_switch: 5 us, critical_section: 2 us}
instances:
  drive_1: {component: Drive, node: board}
  door_1: {component: Door, node: board}
bindings:
  - {from: door_1.Gate, to: drive_1.Motion}
processors:
  work: {node: board, stack: 32 KiB, activities: [door_1.Sequence, door_1.note, drive_1.serve]}
shutdown: {raises: [], grace: 0 ms}
"""


def door(*changes: tuple[str, str], protocol: str = PROTOCOL) -> str:
    """The model of the door, changed."""
    text = DOOR.replace("PROTOCOL", protocol)
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text
