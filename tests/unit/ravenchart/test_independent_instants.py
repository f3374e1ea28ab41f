# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The independent checker on logical execution times, phases and executives, and what it finds."""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest

from ravenchart.analysis.findings.claims import claims_of, uncertified
from ravenchart.analysis.system.timing import analyse
from ravenchart.gen.emit.program import generate
from ravenchart.gen.pipeline import load
from ravenchart.independent.check import checked
from ravenchart.paths import ROOT

COMPONENT = """\
  C{n}:
    ports:
      x: {{in: Level}}
      y: {{out: Level}}
    port_region: {{period: {base} ms, wcet: {c0} us}}
    data:
      kept: {{type: Level, initial: 0}}
      other: {{type: Level, initial: 0}}
    activities:
      first:
        period: {slow} ms
        wcet: {c1} us
        body: [{{set: kept, to: x}}, {{send: y, with: kept}}]
      last: {{period: {slower} ms, wcet: {c2} us, body: [{{set: other, to: kept}}]}}
"""


def _text(chance: random.Random) -> str:
    """Three components in a ring, on processors of their own, with times of every kind."""
    components, processors = "", ""
    for n in range(3):
        base = chance.choice((4, 5, 8, 10))
        slow, slower = (base * chance.choice((1, 2, 3)) for _ in range(2))
        wcets = {f"c{k}": chance.randint(20, 300) for k in range(3)}
        components += COMPONENT.format(n=n, base=base, slow=slow, slower=slower, **wcets)
        keys = [f"offset: {chance.randrange(base)} ms"] if chance.random() < 0.5 else []
        keys += [f"logical_execution_time: {base} ms"] if chance.random() < 0.7 else []
        keys += ["schedule: table"] if chance.random() < 0.4 else []
        if slow > base and chance.random() < 0.5:
            keys.append(f"phases: {{i{n}.first: {base * chance.randrange(slow // base)} ms}}")
        table = f"activities: [i{n}.ports, i{n}.first, i{n}.last]"
        processors += f"  p{n}: {{{', '.join([*keys, 'stack: 16 KiB', table])}}}\n"
    rows = "i0.first, i1.first, i2.last"
    return (
        f"system: Ring\ntypes:\n  Level: {{range: [0, 100]}}\ncomponents:\n{components}"
        "nodes:\n  board: {context_switch: 5 us, critical_section: 2 us}\ninstances:\n"
        + "".join(f"  i{n}: {{component: C{n}, node: board}}\n" for n in range(3))
        + "connections:\n"
        + "".join(f"  - {{from: i{n}.y, to: i{(n + 1) % 3}.x}}\n" for n in range(3))
        + f"processors:\n{processors}chains:\n  way: {{path: [{rows}], reaction: 1 s, age: 1 s}}\n"
        "shutdown: {raises: [], grace: 0 ms}\n"
    )


def _written(text: str, folder: Path) -> Path | None:
    """The model and its program in a folder; None where no certificate can be given."""
    (folder / "model.yaml").write_text(text, encoding="utf-8")
    loaded = load(folder / "model.yaml")
    assert loaded.system is not None, [one.message for one in loaded.diagnostics]
    analysis = analyse(loaded.system)
    if not analysis.schedulable or list(uncertified(analysis)):
        return None
    for name, made in generate(loaded.system, claims_of(analysis)).items():
        path = folder / "generated" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(made, encoding="utf-8")
    return folder / "model.yaml"


def test_random_systems_agree(tmp_path: Path) -> None:
    chance, seen = random.Random(11), 0
    for number in range(40):
        folder = tmp_path / str(number)
        folder.mkdir()
        model = _written(_text(chance), folder)
        if model is not None:
            seen += 1
            assert checked(model).disagreements == [], model
    assert seen > 25


EXECUTIVE = (ROOT / "tests/feature/executive/model.yaml").read_text(encoding="utf-8")
LOGICAL = (ROOT / "tests/feature/logical/model.yaml").read_text(encoding="utf-8")


@pytest.mark.parametrize(("text", "name", "value"), [
    (EXECUTIVE, "Control_1_Ports_Phase", 0),  # given
    (EXECUTIVE, "Control_1_Slower_Phase", 9),  # chosen, but the row never runs
    (EXECUTIVE, "Control_1_Slow_Phase", 3),  # chosen, but another release is the longest then
    (EXECUTIVE, "Sending_Let", 2_000_000),
    (LOGICAL, "Making_Let", 4_000_000),
    (LOGICAL, "Keeping_O", 3_000_000),
    (LOGICAL, "Fast_1_Look_Phase", 0),
    (LOGICAL, "Chain_To_Sink_2_Lag", 0),
    (LOGICAL, "Chain_To_Sink_2_Grid", 2_500_000),
    (LOGICAL, "Sink_1_Sample_Depth", 3),
])  # fmt: skip
def test_an_edit_is_found(text: str, name: str, value: int, tmp_path: Path) -> None:
    model = _written(text, tmp_path)
    assert model is not None and checked(model).disagreements == []
    (certificate,) = (tmp_path / "generated").glob("*timing_certificate.ads")
    was = certificate.read_text(encoding="utf-8")
    made, count = re.subn(rf"({name} : constant :=\s+)[\d_]+;", rf"\g<1>{value};", was)
    assert count == 1 and made != was
    certificate.write_text(made, encoding="utf-8")
    assert checked(model).disagreements
