# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The responses of activities that `ravenchart monitor` shows: in a terminal, a pipe, as JSON."""

from __future__ import annotations

import io
import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import pytest
from rich.console import Console, RenderableType

from ravenchart.analysis.system.row_responses import (
    BINS,
    RowHistogram,
    RowSample,
    empty_histograms,
    rows_executed,
)
from ravenchart.analysis.system.timing import Analysis
from ravenchart.building import checking
from ravenchart.command_line import main
from ravenchart.commands.monitor import Cropped
from ravenchart.gen.language.terms import Ns
from ravenchart.paths import ROOT
from ravenchart.running import monitor_text
from ravenchart.running.held_files import trace_beside
from ravenchart.running.live_responses import NO_TRACE
from ravenchart.running.monitored import NodeMonitor, Overlooked, WatchedNode
from ravenchart.running.response_text import ResponseTable, response_lines
from ravenchart.running.snapshots import parsed_snapshot
from ravenchart.workbench.live import LiveView
from tests.support.answers import answered
from tests.support.snapshot_files import PUMP, held, number, processors, snapshot, trace_map

PRINTED = pytest.CaptureFixture[str]
US = 1_000
WIDTH, HEIGHT = 80, 24


def row(
    name: str = "own.toil", bound: int | None = 1_000 * US, executions: int = 0
) -> RowHistogram:
    """An activity with R = 1 ms and bins of 50 us, without samples."""
    return RowHistogram(name, "work", 200 * US, bound, 50 * US, executions)


def sampled(one: RowHistogram, *times: int, exact: bool = True) -> RowHistogram:
    """With these responses more, in us."""
    for time in times:
        one.add(RowSample(one.name, Ns(time * US), exact, Ns(0)))
        one.executions += 1
    return one


def printed(
    shown: RenderableType, *, encoding: str = "utf-8", height: int | None = None
) -> list[str]:
    """The lines of what is shown, in a terminal of 80 columns."""
    file = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    out = Console(width=WIDTH, height=height or 500, file=file, force_terminal=False)
    out.print(shown if height is None else Cropped(shown))
    file.seek(0)
    return file.read().splitlines()


def drawn(one: RowHistogram, encoding: str = "utf-8") -> str:
    """The bars of an activity."""
    line = printed(ResponseTable([one], ""), encoding=encoding)[1]
    return line[line.index("%") + 1 :].strip()


# --- The table ------------------------------------------------------------------------------


def test_an_activity_is_beside_its_c_and_r() -> None:
    exact = sampled(row(executions=1), 310, 420, 420)
    estimates = sampled(row("own.Control"), 90, exact=False)
    head, first, second, note = printed(ResponseTable([exact, estimates], "Late."))
    assert head.split() == [
        "activity", "C", "ms", "R", "ms", "longest", "at", "most", "sampled", "responses,", "R:",
        "|",
    ]  # fmt: skip
    assert first.split()[:7] == ["own.toil", "0.2", "1", "0.42", "-", "75", "%"]
    assert second.split()[:7] == ["own.Control", "0.2", "1", "-", "0.09", "100", "%"]
    assert note == "Late."


def test_what_has_no_sample_is_no_number() -> None:
    line = printed(ResponseTable([row(bound=None)], ""))[1]
    assert line.split() == ["own.toil", "200", "-", "-", "-", "-"]
    assert printed(ResponseTable([], NO_TRACE)) == []


def test_a_longest_response_above_r_is_seen_to_be_so() -> None:
    one = sampled(row(), 1_001)
    assert printed(ResponseTable([one], ""))[1].split()[2:4] == ["1", "1.001"]


def test_bars_have_the_height_of_their_counts_and_r_is_marked() -> None:
    one = sampled(row(), *[10] * 8, *[60] * 4, 960)
    assert drawn(one) == "█▄" + " " * 17 + "▁|"
    sampled(one, 1_500)  # the bins reach to 2 R now
    assert drawn(one) == "█" + " " * 8 + "▁|" + " " * 4 + "▁"


def test_upper_estimates_are_drawn_with_shades_where_they_are_more() -> None:
    one = sampled(row(), *[10] * 6, *[60] * 2, exact=False)
    sampled(one, 60, 60, 960)
    assert drawn(one) == "▓▆" + " " * 17 + "▂|"


@pytest.mark.parametrize("encoding", ["ascii", "iso-8859-1"])
def test_without_utf_8_the_bars_are_plain(encoding: str) -> None:
    one = sampled(row(), *[10] * 4, *[60] * 3, 110, 110, 160)
    sampled(one, *[210] * 4, *[260] * 3, 310, 310, 360, exact=False)
    assert drawn(one, encoding) == "#+:.Oo;," + " " * 12 + "|"


@pytest.mark.parametrize(
    ("length", "characters"), [(12, BINS + 1), (24, BINS // 2 + 1), (30, BINS // 4 + 1), (40, 0)]
)
def test_bars_take_the_room_that_names_leave(length: int, characters: int) -> None:
    one = sampled(row("a" * length), 990)
    lines = printed(ResponseTable([one], ""))
    assert len(lines) == 2
    bars = lines[1].partition("%")[2].strip()
    assert bars == ("█|" if characters else "")
    assert max(map(len, lines)) <= WIDTH
    header = lines[0].partition("sampled")[2].strip()
    assert header == {BINS + 1: "responses, R: |", 0: ""}.get(characters, "R: |")


@pytest.mark.parametrize("encoding", ["utf-8", "ascii"])
@pytest.mark.parametrize("example", ["pump", "cartesian_robot"])
def test_each_activity_of_an_example_has_one_line_of_80_columns(
    example: str, encoding: str
) -> None:
    checked = checking.check(ROOT / "examples" / example / "model.yaml", deadlines=False)
    rows = empty_histograms(checked.analysis, checked.system.processors)
    for one in rows:
        one.executions = 9_999_999
        assert one.bound is not None
        for exact in (True, False):
            for response in (1, one.bound // 3, one.bound + 1):
                one.add(RowSample(one.name, Ns(response), exact, Ns(0)))
    lines = printed(ResponseTable(rows, ""), encoding=encoding)
    assert len(lines) == 1 + len(rows)
    assert max(map(len, lines)) <= WIDTH
    assert [line.split()[0] for line in lines[1:]] == [one.name for one in rows]
    assert all("|" in line for line in lines[1:])


# --- A node ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    return checking.check(PUMP).analysis


def watched(analysis: Analysis, rows: Sequence[RowHistogram]) -> WatchedNode:
    """The pump with these responses."""
    monitor = NodeMonitor(analysis, "board")
    node = monitor.shown(parsed_snapshot(snapshot(1, *processors(40)), trace_map(), "file"), None)
    node.responses, node.responses_note = list(rows), NO_TRACE
    return node


def test_processors_and_all_activities_are_on_a_screen_of_24_lines(analysis: Analysis) -> None:
    rows = empty_histograms(analysis, analysis.system.processors)
    node = watched(analysis, rows)
    lines = printed(monitor_text.response_tables([("Pump", node, 0.0)]), height=HEIGHT)
    assert len(lines) < HEIGHT and max(map(len, lines)) <= WIDTH
    first = [line.split()[0] for line in lines]
    assert first[1:4] == ["processor", "control", "reception"]
    assert first[6:15] == ["activity", *(one.name for one in rows)]
    assert not any("more lines" in line for line in lines)


def test_the_processors_of_all_nodes_come_before_the_activities(analysis: Analysis) -> None:
    rows = empty_histograms(analysis, analysis.system.processors)
    nodes = [(name, watched(analysis, rows), 0.0) for name in ("one", "two")]
    lines = printed(monitor_text.response_tables(nodes), height=HEIGHT)
    first = [line.split()[0] for line in lines]
    assert [place for place, word in enumerate(first) if word == "processor"] == [1, 7]
    assert first.index("activity") > 7
    assert "more lines" in lines[-1]


def test_all_tables_of_a_node_end_with_its_activities(analysis: Analysis) -> None:
    rows = empty_histograms(analysis, analysis.system.processors)
    node = watched(analysis, rows)
    lines = printed(monitor_text.tables("Pump", node, [], 0.0, Overlooked()))
    first = [line.split()[0] for line in lines]
    assert first.index("processor") < first.index("chart") < first.index("activity")
    assert first.index("activity") < max(n for n, word in enumerate(first) if word == "not")


def test_a_pipe_has_a_line_for_each_activity_that_was_executed(analysis: Analysis) -> None:
    done = sampled(row(executions=1), 310)
    sampled(done, 90, exact=False)
    assert list(response_lines([done, row("own.rest")])) == [
        "own.toil activity longest 0.31 ms at most 90 us R 1 ms sampled 2 of 3"
    ]
    node = watched(analysis, [done])
    found = list(monitor_text.lines(node, "", counts=True))
    assert "2.000 own.toil activity longest 0.31 ms at most 90 us R 1 ms sampled 2 of 3" in found
    assert not any("activity" in line for line in monitor_text.lines(node, "", counts=False))


# --- The command ----------------------------------------------------------------------------


def _recorded(file: Path) -> None:
    """A snapshot, and the trace of the first releases of `control` beside it."""
    file.write_text(snapshot(7, *processors(2)))
    (control,) = (one for one in checking.check(PUMP).system.processors if one.name == "control")
    begins = [
        f"T {due + 100 * US * place} Activity {number(name, 'row')} 0"
        for release, due in enumerate((0, control.period))
        for place, name in enumerate(rows_executed(control, release), 1)
    ]
    report = (f"N {2 * control.period}", f"P {number('control', 'processor')} 2 0 900000 900000")
    head = ("E 84385114343632", f"M {trace_map().digest}")
    text = "\n".join((*head, *begins, *report, "END"))
    trace_beside(file).write_text(f"{text}\n")


def test_an_object_has_the_rows_of_the_page(tmp_path: Path, capsys: PRINTED) -> None:
    file = tmp_path / "live"
    _recorded(file)
    with held(file):
        result = answered(capsys, "monitor", PUMP, "--file", file, "--once")["result"]
        live = LiveView(PUMP, files=[str(file)])
        page = live.look(trace_map().digest)
        live.close()
    for key in ("responses", "responses_note"):
        assert result["nodes"][0][key] == json.loads(json.dumps(page["nodes"][0][key]))
    rows = {one["name"]: one for one in result["nodes"][0]["responses"]}
    assert sum(map(sum, (one["exact"] for one in rows.values()))) == 1
    assert rows["bed.ports"]["longest_at_most"] == 200 * US
    assert rows.keys() == {one["name"] for one in page["nodes"][0]["responses"]}


def test_responses_alone_are_shown_on_request(tmp_path: Path, capsys: PRINTED) -> None:
    file = tmp_path / "live"
    _recorded(file)
    words = ["monitor", str(PUMP), "--file", str(file), "--once"]
    with held(file):
        assert main(words) == 0
        whole = capsys.readouterr().out
        assert main([*words, "--responses"]) == 0
        alone = capsys.readouterr().out
    for text in (whole, alone):
        (line,) = [one for one in text.splitlines() if one.startswith("bed.ports ")]
        assert line.split()[4:7] == ["200", "100", "%"]
        assert "processor  due" in text
    assert "chart" in whole and "chart" not in alone


def test_what_is_described_is_what_is_written() -> None:
    assert set(asdict(row())) == {
        "name", "processor", "wcet", "bound", "width", "executions", "exact", "at_most",
        "longest", "longest_at_most",
    }  # fmt: skip
