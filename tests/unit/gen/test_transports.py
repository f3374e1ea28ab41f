# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Values in several frames: what the analysis says of them, and transfers played step by step."""

from __future__ import annotations

import json
import random
from itertools import pairwise
from pathlib import Path

import pytest

from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.present.figures import figures
from ravenchart.analysis.present.report import render_report
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.analysis.system.transport import Transfer
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.transport import code_of, distance_of
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from tests.support.certificates import certificate, changed, compiled

pytestmark = pytest.mark.clock

MS = 1_000_000
CHAINS = """\
chains:
  shown: {path: [gauge.measure, report, face.show], reaction: 200 ms, age: 200 ms}
  told: {path: [face.show, table], reaction: 400 ms}
shutdown:"""


def _analysed(folder: Path, *edits: tuple[str, str]) -> Analysis:
    text = (ROOT / "tests" / "nodes" / "segmented" / "model.yaml").read_text()
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    (folder / "model.yaml").write_text(text)
    loaded = load(folder / "model.yaml")
    assert loaded.system is not None, loaded.diagnostics
    return analyse(loaded.system)


def _transfer(analysis: Analysis, name: str) -> Transfer:
    return next(one for one in analysis.transfers.values() if one.message.name == name)


def test_codes_of_the_separation_time() -> None:
    assert [code_of(Ns(t * 1000)) for t in (0, 1000, 127_000, 100, 900)] == [0, 1, 127, 0xF1, 0xF9]
    assert [code_of(Ns(t * 1000)) for t in (1500, 128_000, 150)] == [None, None, None]
    assert code_of(Ns(100_001)) is None


@pytest.mark.parametrize("row", [500, 1000, 3000, 5000])
@pytest.mark.parametrize("separation", [0, 100, 900, 1000, 5000, 7000])
def test_segments_are_as_far_apart_as_asked(row: int, separation: int) -> None:
    count = distance_of(Ns(separation * 1000), Ns(row * 1000))
    #  the first execution may begin as late as the next one is due, the last one at once
    assert count * row - (row - 1) * bool(separation) > separation or not separation
    assert count >= 1


def test_the_value_is_cut_as_the_standard_says(tmp_path: Path) -> None:
    analysis = _analysed(tmp_path)
    report, table = (_transfer(analysis, name).transport for name in ("report", "table"))
    assert (report.length, report.segments, report.rounds) == (19, 3, 1)
    assert (table.length, table.segments, table.rounds) == (64, 10, 3)
    items = analysis.network.items()
    assert items["line.report"].period == 5 * MS
    #  2 ms apart in a row of 4 ms
    assert items["line.table"].period == 8 * MS
    assert items["line.table_Flow"].period == 5 * MS
    assert items["line.report_Flow"].period == 4 * MS
    frames = {frame.name: frame for frame in analysis.network.frames["line"]}
    assert frames["line.report"].transmission_time == frames["line.table_Flow"].transmission_time


def _played(one: Transfer, chance: random.Random, *, worst: bool) -> int:
    """From the first release to the handing over of the value, with delays and phases drawn."""
    transport = one.transport
    assert one.segment is not None
    assert one.answer is not None
    row, apart, port = transport.row, one.message.period, one.flow.period

    def delay(longest: int) -> int:
        return longest if worst else chance.randint(0, longest)

    now, sent, in_block = 0, 1, 0
    #  an execution of the port region that has just looked is the worst
    phase = (one.segment - 1) % port if worst else chance.randrange(port)
    asks = True
    while True:
        arrived = now + delay(one.segment)
        if sent == transport.segments:
            return arrived
        if asks:
            wait = (phase - arrived) % port
            if worst:
                wait = port - 1
            heard = arrived + wait + delay(one.answer)
            now = max(now + apart, -(-heard // row) * row)
            in_block = 0
        else:
            now += apart
        sent, in_block = sent + 1, in_block + 1
        asks = bool(transport.block) and in_block == transport.block


@pytest.mark.parametrize("name", ["report", "table"])
def test_played_transfers_reach_the_bound_and_never_exceed_it(name: str, tmp_path: Path) -> None:
    one = _transfer(_analysed(tmp_path), name)
    chance = random.Random(7)
    assert one.bound is not None
    times = [_played(one, chance, worst=False) for _ in range(3000)]
    assert max(times) <= one.bound
    assert _played(one, chance, worst=True) == one.bound


def test_a_value_waits_for_the_one_before_it(tmp_path: Path) -> None:
    analysis = _analysed(tmp_path, ("shutdown:", CHAINS))
    one = _transfer(analysis, "report")
    assert one.cycle is not None
    assert one.bound is not None
    chain = next(c for c in analysis.system.chains if c.name == "shown")
    latency = next(found for made, found in analysis.limited if made is chain)
    handed = next(h for h in latency.hops if h.step.name == "line.report.reception")
    first = next(h for h in latency.hops if h.step.name == "line.driver_tx.report")
    assert first.wait is not None
    assert handed.wait is not None
    assert first.wait + handed.wait == one.cycle - one.transport.row
    total = sum(hop.response or 0 for hop in latency.hops[:-2])
    assert total >= one.bound
    assert handed.renewal == one.cycle
    assert findings(analysis) == ()


def test_the_certificate_has_the_same_sums(tmp_path: Path) -> None:
    text = certificate(_analysed(tmp_path, ("shutdown:", CHAINS)))
    assert compiled(text, tmp_path, "Segmented") == ""
    for number, by in (("Line_Table_Transfer", -1), ("Line_Report_Round_Trip", 1)):
        (tmp_path / number).mkdir()
        assert compiled(changed(text, number, by), tmp_path / number, "Segmented") != "", number


def test_a_time_out_that_may_pass_is_refused(tmp_path: Path) -> None:
    (one,) = findings(_analysed(tmp_path, ("timeout: 500 ms", "timeout: 10 ms")))
    assert one.code == "RV-0909"
    assert one.hint is not None
    needed = one.hint.partition("`timeout` of ")[2].removesuffix(" or more")
    again = _analysed(tmp_path, ("timeout: 500 ms", f"timeout: {needed}"))
    assert findings(again) == ()


def test_longer_blocks_take_less_time(tmp_path: Path) -> None:
    bounds = [
        _transfer(_analysed(tmp_path, ("block: 4", f"block: {block}")), "table").bound or 0
        for block in (1, 2, 3, 5, 9, 0)
    ]
    assert all(shorter <= longer for longer, shorter in pairwise(bounds))
    assert bounds[-1] == bounds[-2]


@pytest.mark.slow
def test_report_and_figures_have_the_transfers(tmp_path: Path) -> None:
    analysis = _analysed(tmp_path)
    found = json.loads(json.dumps(figures(analysis)))["transfers"]
    assert [row["message"] for row in found] == ["report", "table"]
    table = _transfer(analysis, "table")
    assert found[1] == {
        "message": "table",
        "bytes": 64,
        "segments": 10,
        "flow_control": "table_Flow",
        "rounds": 3,
        "round_trip": table.round_trip,
        "bound": table.bound,
        "cycle": table.cycle,
        "timeout": 500 * MS,
    }
    assert ">Values in several frames</h2>" in render_report(analysis)
