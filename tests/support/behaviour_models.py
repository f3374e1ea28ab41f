# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Small models for the rules of behaviour: one component, its regions, and what is said of them."""

from __future__ import annotations

from textwrap import indent

from ravenchart.behaviour.rules import findings
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.model.system import System
from tests.support.pump import loaded

FRAME = """\
system: Tried
types:
  Level: {{range: [0, 100]}}
  Mode: {{values: [Manual, Automatic, Service]}}
components:
  Unit:
    ports:
      level: {{in: Level}}
      mode: {{in: Mode}}
    port_region: {{period: 10 ms, wcet: 20 us{groups}}}
    events: {events}
    data:
      count: {{type: Level, initial: 0}}
      armed: {{type: Boolean, initial: false}}
    never: {never}
    regions:
{regions}
{more}
nodes:
  board: {{context_switch: 5 us, critical_section: 2 us}}
buses:
  bus: {{bit_rate: 500 kbit/s, driver_wcet: 20 us, receive_depth: 8, transmit_depth: 8}}
instances:
  one: {{component: Unit, node: board}}
messages:
  level_in: {{bus: bus, id: 0x100, to: one.level, period: 10 ms}}
  mode_in: {{bus: bus, id: 0x101, to: one.mode, period: 10 ms}}
processors:
  reception:
    {{node: board, released_by: bus, period: 1 ms, stack: 8 KiB, activities: [bus.receive]}}
  runner:
    node: board
    stack: 16 KiB
    activities: [{rows}]
    on_deadline_miss: [{outside}]
{others}
"""

HEAD = "period: 10 ms\nwcet: 20 us\nqueue: 4\n"


def region(name: str, states: str, transitions: str, *, head: str = "", initial: str = "A") -> str:
    """A region of 10 ms with these states (a flow mapping) and transitions, one a line."""
    lines = [f"{HEAD}{head}initial: {initial}", f"states: {states}", "transitions:"]
    return f"{name}:\n" + indent("\n".join([*lines, indent(transitions, "  ")]), "  ")


def model(
    *regions: str,
    never: str = "{}",
    events: str = "[Go, Stop]",
    outside: str = "one.Go, one.Stop",
    rows: str | None = None,
    others: str = "",
    more: str = "",
    groups: str = "",
) -> System:
    """The system of a valid model with these regions."""
    named = [text.partition(":")[0] for text in regions]
    text = FRAME.format(
        events=events,
        never=never,
        regions=indent("\n".join(regions), " " * 6),
        more=indent(more, " " * 4),
        rows=rows or ", ".join(["one.ports", *(f"one.{name}" for name in named)]),
        outside=outside,
        others=indent(others, " " * 2),
        groups=f", groups: {groups}" if groups else "",
    )
    result = loaded(text)
    assert result.system is not None, "\n".join(str(d) for d in result.diagnostics)
    return result.system


def said(system: System) -> list[str]:
    """Codes and messages of what is found."""
    return [f"{item.code} {item.severity.value}: {item.message}" for item in findings(system)]


def only(system: System) -> Diagnostic:
    """The one finding."""
    (found,) = findings(system)
    return found
