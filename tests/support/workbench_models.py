# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A model of a hundred activities, as large as the workbench is meant for."""

from __future__ import annotations

from collections.abc import Iterator

COMPONENTS = 10
"""Component types with one instance each; each has a port region and nine activities."""
PERIODS = (10, 20, 40, 80)
"""In ms: the activities have them in turn."""
BODIES = 9


def hundred_activities() -> str:
    """Ten components, a hundred rows on four processors, twenty messages and ten chains."""
    return "\n".join(_lines()) + "\n"


def _lines() -> Iterator[str]:
    units = range(COMPONENTS)
    yield "system: Hundred"
    yield "types: {Word: {range: [0, 100]}}"
    yield "nodes: {cpu: {context_switch: 5 us, critical_section: 5 us}}"
    yield "buses:"
    yield (
        "  can0: {bit_rate: 500 kbit/s, driver_wcet: 20 us, receive_depth: 64, transmit_depth: 64}"
    )
    yield "components:"
    for unit in units:
        yield from _component(unit)
    yield "instances:"
    yield from (f"  u{unit}: {{component: Unit_{unit}, node: cpu}}" for unit in units)
    yield "messages:"
    for unit in units:
        to = f"to: u{unit}.i, period: 20 ms, sporadic: no"
        yield f"  in{unit}: {{bus: can0, id: {0x100 + unit:#x}, {to}}}"
        yield f"  out{unit}: {{bus: can0, id: {0x200 + unit:#x}, from: u{unit}.o}}"
    yield "processors:"
    rows = "stack: 32 KiB, activities: [can0.receive]"
    yield f"  reception: {{node: cpu, released_by: can0, period: 1 ms, {rows}}}"
    for number, period in enumerate(PERIODS):
        yield from (f"  p{period}:", "    node: cpu", "    stack: 32 KiB", "    activities:")
        yield from (f"      - u{unit}.ports" for unit in units if period == 20)
        for unit in units:
            yield from (f"      - u{unit}.act{act}" for act in range(number, BODIES, len(PERIODS)))
    yield "chains:"
    yield from (
        f"  c{unit}: {{path: [in{unit}, u{unit}.act0, out{unit}], reaction: 900 ms}}"
        for unit in units
    )
    yield "shutdown: {raises: [], grace: 10 ms}"


def _component(unit: int) -> Iterator[str]:
    """A component whose activities hand a value on, from the input to the output."""
    yield from (f"  Unit_{unit}:", "    ports: {i: {in: Word}, o: {out: Word}}")
    yield "    port_region: {period: 20 ms, wcet: 20 us}"
    data = ", ".join(f"n{act}: {{type: Word, initial: 0}}" for act in range(BODIES))
    yield from (f"    data: {{{data}}}", "    activities:")
    for act in range(BODIES):
        flow = f"{{set: n{act}, to: {'i' if act == 0 else f'n{act - 1}'}}}"
        if act == BODIES - 1:
            flow += f", {{send: o, with: n{act - 1}}}"
        period = PERIODS[act % len(PERIODS)]
        yield f"      act{act}: {{period: {period} ms, wcet: 100 us, body: [{flow}]}}"
