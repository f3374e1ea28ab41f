# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A frame that is not as the layout table has it is refused: by gnatprove, or before.

The subject sends a classic frame and CAN FD frames, and receives one of each. The proofs need
gnatprove; without it those tests are skipped, and say so.
"""

from __future__ import annotations

import os

import pytest

from ravenchart.tools import toolchain
from tests.mutation.catalogue import mutants_of
from tests.mutation.mutants import Mutant
from tests.mutation.observing import Observer
from tests.mutation.workbench import Workbench

MODEL = """\
system: Framed
types:
  Word: {range: [0, 60000]}
  Pair: {fields: {one: Word, other: Word}}
  Long: {range: [0, 4000000000]}
  Set: {fields: {one: Long, two: Long, other: Long}}
components:
  Relay:
    ports:
      near: {in: Pair}
      far: {in: Set}
      short: {out: Pair}
      again: {out: Pair}
      wide: {out: Set}
    port_region: {period: 20 ms, wcet: 100 us}
    activities:
      tell:
        period: 20 ms
        wcet: 200 us
        body:
          - {send: short, with: {one: near.one, other: near.other}}
          - {send: again, with: {one: near.other, other: near.one}}
          - {send: wide, with: {one: far.two, two: far.one, other: far.other}}
nodes:
  board: {context_switch: 10 us, critical_section: 5 us}
buses:
  line:
    bit_rate: 500 kbit/s
    data_rate: 2 Mbit/s
    driver_wcet: 20 us
    receive_depth: 8
    transmit_depth: 8
instances:
  middle: {component: Relay, node: board}
messages:
  near_in: {bus: line, id: 0x100, to: middle.near, period: 20 ms}
  far_in: {bus: line, id: 0x102, format: fd, to: middle.far, period: 20 ms}
  short_out: {bus: line, id: 0x104, from: middle.short}
  again_out: {bus: line, id: 0x106, extended: true, format: fd, bytes: 8, from: middle.again}
  wide_out: {bus: line, id: 0x108, format: fd, from: middle.wide}
processors:
  reception:
    {node: board, released_by: line, period: 1 ms, stack: 16 KiB, activities: [line.receive]}
  work: {node: board, stack: 32 KiB, activities: [middle.ports, middle.tell]}
shutdown: {raises: [], grace: 0 ms}
"""

LONG = "RAVENCHART_LONG_TESTS" in os.environ
"""`make test-long`: every break, else one at each place where frames are made or taken."""

SENT = ("short", "long", "identifier", "format")
BREAKS: dict[str, tuple[str, ...]] = {
    "Frame_Of_Short_Out": ("short",),
    "Frame_Of_Wide_Out": ("rate",),
    "Run_Receive": ("identifier",),
    "Accepts": ("identifier",),
}
ALL_BREAKS = {
    "Frame_Of_Short_Out": SENT,
    "Frame_Of_Wide_Out": (*SENT, "rate"),
    "Send_Short_Out": ("message",),
    "Run_Receive": (*SENT, "family"),
    "Accepts": ("identifier",),
    "Frame_Short_Out": ("long",),
    "Frame_Far_In": ("short",),
}
"""Place to the breaks that are tried there; classic and CAN FD frames, sent and received."""
if LONG:
    BREAKS = ALL_BREAKS


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Workbench:
    """The program, of which all that sends and receives is proved as it is."""
    folder = tmp_path_factory.mktemp("framed")
    (folder / "model.yaml").write_text(MODEL)
    made = Workbench(folder / "model.yaml", folder / "bench", Observer)
    units = [name for name in made.files if "-line" in name and name.endswith(".adb")]
    made.prove(units, jobs=2)
    return made


def chosen(bench: Workbench) -> list[Mutant]:
    """The first break of each kind at each place."""
    found: dict[tuple[str, str], Mutant] = {}
    for mutant in mutants_of(bench.files):
        if mutant.kind == "frame" and mutant.rule in BREAKS.get(mutant.place, ()):
            found.setdefault((mutant.place, mutant.rule), mutant)
    return list(found.values())


@pytest.mark.skipif(not toolchain.have("gnatprove"), reason="gnatprove is not on PATH")
def test_no_frame_but_that_of_the_layout_table_is_proved(bench: Workbench) -> None:
    tried = chosen(bench)
    assert {(m.place, m.rule) for m in tried} == {
        (p, r) for p, rules in BREAKS.items() for r in rules
    }
    verdicts = {(m.place, m.rule): bench.refusal(m) for m in tried}
    assert [key for key, verdict in verdicts.items() if verdict.by is None] == []
