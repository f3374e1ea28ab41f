# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What `ravenchart monitor` shows of snapshots, and how it ends where there are none."""

from __future__ import annotations

import io
import json
import shutil
from dataclasses import asdict, replace
from pathlib import Path

import pytest
from rich.console import Console

from ravenchart.analysis.system.observed import read_map
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.building import checking
from ravenchart.command_line import main
from ravenchart.commands.monitor import Cropped
from ravenchart.gen.derive.sharing import MAIN
from ravenchart.paths import ROOT
from ravenchart.running import monitor_text
from ravenchart.running.monitored import (
    OLDER_PROGRAM,
    OTHER_VALUES,
    VALUES_NOT_SEEN,
    NodeMonitor,
    Overlooked,
    WatchedNode,
)
from ravenchart.running.snapshots import parsed_snapshot
from tests.support.answers import answered
from tests.support.recorded import MODEL
from tests.support.snapshot_files import PUMP, held, number, processors, snapshot, trace_map

RECENT = 32
"""So many transitions and faults a snapshot lists at the most."""

PRINTED = pytest.CaptureFixture[str]
EXAMPLES = [
    pytest.param(path.parent.name, marks=[] if path == PUMP else pytest.mark.slow)
    for path in sorted(ROOT.glob("examples/*/model.yaml"))
]


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    return checking.check(PUMP).analysis


def seen(monitor: NodeMonitor, *lines: str, sequence: int = 1) -> WatchedNode:
    """What is shown of a snapshot with these lines."""
    return monitor.shown(parsed_snapshot(snapshot(sequence, *lines), trace_map(), "file"), None)


def tally(kind: str, name: str, of: str, count: int, at: int = 1000, value: int = 0) -> str:
    return f"C {kind} {number(name, of)} {count} {at} {value}"


def taken(count: int, *, listed: int) -> list[str]:
    """The pump's chart has taken so many transitions, the last ``listed`` of them at 1 us each."""
    region = number("bed.Infusion", "region")
    lines = [f"T {(count - listed + n) * 1000} Transition {region} {n % 3}" for n in range(listed)]
    return [*lines, tally("TRANSITION", "bed.Infusion", "region", count)]


def leaf(name: str, state: str) -> int:
    return trace_map().named(name, "region").leaves.index(state)


def test_processors_are_beside_what_was_due_and_their_bounds(analysis: Analysis) -> None:
    node = seen(NodeMonitor(analysis, "board"), *processors(40))
    control, reception = sorted(node.processors, key=lambda one: one.name)
    assert (control.due, control.completed, control.misses) == (41, 40, 0)
    bounds = {one.task.name: one.bound for one in analysis.responses}
    assert (control.last_response, control.worst_response) == (301_195, 401_195)
    assert control.bound == bounds["control"]
    assert reception.due is None  # a bus releases it
    assert node.lost == {"ward.lost_out": 3}
    assert node.faults == {}


def test_an_older_program_reports_no_last_response(analysis: Analysis) -> None:
    older = [line.rpartition(" ")[0] if line[0] == "P" else line for line in processors(40)]
    node = seen(NodeMonitor(analysis, "board"), *(line for line in older if line[0] != "Q"))
    assert [one.last_response for one in node.processors] == [None, None]
    assert node.queues == [] and node.not_seen[-1] == OLDER_PROGRAM
    (line,) = [line for line in printed(node) if line.startswith("control")]
    assert line.split()[4:6] == ["-", "402"]


def test_the_queue_of_a_chart_has_its_fill_beside_its_depth(analysis: Analysis) -> None:
    fault = tally("FAULT", "bed.Infusion", "region", 3)
    node = seen(NodeMonitor(analysis, "board"), *taken(1, listed=1), fault, *processors(40))
    found = {one.name: (one.waiting, one.highest, one.depth, one.faults) for one in node.queues}
    assert found == {
        "bed.panel": (0, None, 4, 0), "bed.Infusion": (2, 7, 8, 3), "bed.Keys": (0, 1, 4, 0),
    }  # fmt: skip
    (line,) = [line for line in printed(node) if line.startswith("bed.Infusion  ")]
    assert line.split()[-4:] == ["2", "of", "8", "7"]
    assert "2.000 bed.Infusion queue 2 of 8 most 7" in monitor_text.lines(node, "", counts=True)
    bare = seen(NodeMonitor(analysis, "board"), *processors(40))  # without a trace
    (line,) = [line for line in printed(bare) if line.startswith("bed.Infusion ")]
    assert line.split() == ["bed.Infusion", "2", "of", "8", "7"]


def test_a_state_inside_one_that_is_not_active_is_none(analysis: Analysis) -> None:
    inside = tally("STATE", "bed.Infusion.Motor", "region", 1, 5000, 0)
    for outer, state in (("Self_Test", "Turning"), ("Programming", None)):
        active = tally("STATE", "bed.Infusion", "region", 1, 5000, leaf("bed.Infusion", outer))
        node = seen(NodeMonitor(analysis, "board"), inside, active, *processors(40))
        charts = {one.name: one.state for one in node.charts}
        assert charts["bed.Infusion"] == outer
        assert charts["bed.Infusion.Motor"] == state


def test_events_are_shown_once_and_those_that_no_snapshot_lists_are_counted(
    analysis: Analysis,
) -> None:
    monitor = NodeMonitor(analysis, "board")
    first = seen(monitor, *taken(3, listed=3))
    assert ([one.at for one in first.events], first.unlisted) == ([0, 1000, 2000], 0)
    again = seen(monitor, *taken(3, listed=3))
    assert (again.events, again.unlisted) == ([], 0)
    more = seen(monitor, *taken(5, listed=5))
    assert ([one.at for one in more.events], more.unlisted) == ([3000, 4000], 0)
    many = seen(monitor, *taken(5 + RECENT + 7, listed=RECENT))
    assert (len(many.events), many.unlisted) == (RECENT, 7)


def test_the_first_snapshot_does_not_count_what_was_long_ago(analysis: Analysis) -> None:
    node = seen(NodeMonitor(analysis, "board"), *taken(1000, listed=RECENT))
    assert (len(node.events), node.unlisted) == (RECENT, 0)


def test_snapshots_that_were_not_looked_at_are_counted(analysis: Analysis) -> None:
    monitor, overlooked = NodeMonitor(analysis, "board"), Overlooked()
    looks = [(40, 3), (40, 3), (41, 4), (45, 5 + RECENT + 7)]
    missed: list[tuple[int, int]] = []
    for sequence, transitions in looks:
        lines = taken(transitions, listed=min(transitions, RECENT))
        node = seen(monitor, *lines, sequence=sequence)
        overlooked.add(node, new=len(missed) != 1)
        missed.append((node.missed, node.unlisted))
    assert missed == [(0, 0), (0, 0), (0, 0), (3, 8)]
    assert overlooked == Overlooked(of=6, snapshots=3, events=8)  # 40 .. 45
    said = "snapshots not looked at: 3 of 6; transitions and faults not listed: 8"
    assert said in printed(node, overlooked=overlooked)
    assert not any("not looked at" in line for line in printed(node, overlooked=Overlooked(9)))


def test_a_fault_has_its_name(analysis: Analysis) -> None:
    element = number("bed.panel", "port")
    line = f"T 5000 Fault {element} 2"
    node = seen(NodeMonitor(analysis, "board"), line, *processors(1))
    (event,) = node.events
    assert (event.kind, event.element, event.what) == ("fault", "bed.panel", "Queue_Overflow")


@pytest.mark.parametrize(("lost", "waiting"), [(0, 2), (1, None)])
def test_a_queue_holds_what_has_arrived_and_was_neither_handled_nor_lost(
    analysis: Analysis, lost: int, waiting: int | None
) -> None:
    lines = [line.replace("L trace 0", f"L trace {lost}") for line in processors(1)]
    counts = [tally(kind, "bed.panel", "port", n) for kind, n in
              (("ARRIVED", 9), ("HANDLED", 6), ("FAULT", 1))]  # fmt: skip
    queue, *_ = seen(NodeMonitor(analysis, "board"), *counts, *lines).queues
    assert (queue.name, queue.waiting, queue.depth) == ("bed.panel", waiting, 4)


def test_the_last_recorded_value_is_shown_in_its_unit(tmp_path: Path) -> None:
    model = Path(shutil.copytree(MODEL.parent, tmp_path / "recorded")) / "model.yaml"
    assert main(["generate", str(model)]) == 0
    text = (model.parent / "generated" / "trace.json").read_text(encoding="utf-8")
    own = read_map(text)
    heat, hue = (own.named(name, "value").number for name in ("taker.heat", "giver.hue"))
    lines = (f"C VALUE {heat} 7 5000 -397", f"C VALUE {hue} 9 6000 2", "N 1000006000")
    whole = snapshot(1, *lines, digest=own.digest)
    monitor = NodeMonitor(checking.check(model).analysis, "board")
    node = monitor.shown(parsed_snapshot(whole, own, "file"), None)
    assert [(v.name, v.value, v.unit, v.count, v.last) for v in node.values] == [
        ("taker.heat", "-39.7", "degC", 7, 5000), ("giver.hue", "Blue", "", 9, 6000),
    ]  # fmt: skip
    assert OTHER_VALUES in node.not_seen and VALUES_NOT_SEEN not in node.not_seen
    assert node.traffic == []
    found = list(monitor_text.lines(node, "", counts=True))
    assert "1.000 taker.heat value -39.7 degC" in found and "1.000 giver.hue value Blue" in found
    console = Console(width=80, file=io.StringIO())
    console.print(monitor_text.tables("System", node, [], 0.0, Overlooked()))
    shown = console.file.getvalue()  # type: ignore[attr-defined]
    (line,) = [line for line in shown.splitlines() if line.startswith("taker.heat")]
    assert line.split() == ["taker.heat", "-39.7", "degC", "7", "1.0"]


def test_what_is_not_seen_is_said(analysis: Analysis) -> None:
    full = seen(NodeMonitor(analysis, "board"), *taken(1, listed=1), *processors(1))
    assert full.not_seen == [VALUES_NOT_SEEN]
    cut = [line.replace("L snapshot 0", "L snapshot 4") for line in processors(1)]
    dropped = seen(NodeMonitor(analysis, "board"), *taken(1, listed=1), *cut)
    assert dropped.not_seen[-1] == "what found no room in a snapshot: `lost` counts it"
    assert dropped.lost["snapshot"] == 4
    empty = seen(NodeMonitor(analysis, "board"), "N 5")
    assert [text.partition(":")[0] for text in empty.not_seen[1:]] == [
        "states, transitions, messages and faults by element",
        "processors, and queues of charts",
    ]
    assert empty.charts == []


def printed(
    node: WatchedNode, height: int | None = None, overlooked: Overlooked | None = None
) -> list[str]:
    """The lines of the tables, in 80 columns."""
    out = Console(width=80, height=height or 500, file=io.StringIO(), force_terminal=False)
    name = "Infusion_System on board"
    whole = monitor_text.tables(name, node, node.events, 0.0, overlooked or Overlooked())
    out.print(whole if height is None else Cropped(whole))
    assert isinstance(out.file, io.StringIO)
    return out.file.getvalue().splitlines()


def test_the_tables_have_80_columns_and_name_everything(analysis: Analysis) -> None:
    counts = [tally("ARRIVED", "bed.panel", "port", 123_456), *taken(3, listed=3)]
    lines = printed(seen(NodeMonitor(analysis, "board"), *counts, *processors(4_000_000)))
    assert max(map(len, lines)) <= 80
    text = "\n".join(lines)
    for word in ("control", "4000000", "lost_out 3", "bed.Infusion", "123456", "not seen: "):
        assert word in text


def test_a_terminal_that_is_too_low_is_told_how_much_is_missing(analysis: Analysis) -> None:
    node = seen(NodeMonitor(analysis, "board"), *taken(3, listed=3), *processors(40))
    whole, cropped = printed(node), printed(node, 10)
    assert cropped[:8] == [line.rstrip() for line in whole[:8]] or cropped[:8] == whole[:8]
    assert cropped[8] == f"... {len(whole) - 8} more lines: --once prints all"
    assert len(cropped) == 9


def test_a_controller_that_was_killed_is_told_from_one_that_has_ended(analysis: Analysis) -> None:
    monitor = NodeMonitor(analysis, "board")
    assert "ENDED WITHOUT ITS REPORT" in printed(seen(monitor, *processors(1)))[0]
    assert "ended in order" in printed(seen(monitor, *processors(1), "END"))[0]


def test_lines_for_a_pipe(analysis: Analysis) -> None:
    node = seen(NodeMonitor(analysis, "board"), *taken(2, listed=1), *processors(40))
    events = list(monitor_text.lines(node, "", counts=False))
    name = trace_map().named("bed.Infusion", "region").transitions[0]
    assert events == [f"0.000 bed.Infusion transition {name}"]
    counts = list(monitor_text.lines(node, "board", counts=True))[1:]
    assert counts[-1] == "board 2.000 ward.lost_out lost 3"
    assert any(
        "control processor due 41 completed 40 misses 0 last 302 us worst 402 us" in c
        for c in counts
    )


# --- The command -----------------------------------------------------------------


@pytest.mark.slow
def test_without_a_controller_the_call_fails_and_says_how_to_start_one(
    tmp_path: Path, capsys: PRINTED
) -> None:
    model = Path(shutil.copy(PUMP, tmp_path))
    answer = answered(capsys, "monitor", model, "--once", status=2)
    (found,) = answer["diagnostics"]
    assert "no controller of Infusion_System runs" in found["message"]
    assert "`ravenchart run`" in found["message"] and "--file" in found["message"]


def test_a_file_that_nobody_writes_is_refused(tmp_path: Path, capsys: PRINTED) -> None:
    file = tmp_path / "live"
    file.write_text(snapshot(1, *processors(1)))
    assert main(["monitor", str(PUMP), "--file", str(file)]) == 2
    assert "no controller writes this file now" in capsys.readouterr().err
    assert main(["monitor", str(PUMP), "--file", str(tmp_path / "none")]) == 2
    assert "no such file" in capsys.readouterr().err


def test_the_controller_of_another_model_is_refused(tmp_path: Path, capsys: PRINTED) -> None:
    file = tmp_path / "live"
    file.write_text(snapshot(1, *processors(1), digest="0" * 64))
    with held(file):
        assert main(["monitor", str(PUMP), "--file", str(file), "--once"]) == 1
    assert "was generated from another model" in capsys.readouterr().err


def test_once_shows_one_snapshot(tmp_path: Path, capsys: PRINTED) -> None:
    file = tmp_path / "live"
    file.write_text(snapshot(7, *taken(2, listed=2), *processors(40)))
    with held(file) as process:
        assert main(["monitor", str(PUMP), "--file", str(file), "--once"]) == 0
        out = capsys.readouterr().out
        assert f"process {process}" in out and "snapshot 7" in out
        result = answered(capsys, "monitor", PUMP, "--file", f"board={file}", "--once")["result"]
    (node,) = result["nodes"]
    assert (node["process"], node["sequence"], len(node["events"])) == (process, 7, 2)


def test_a_node_that_the_model_does_not_have_is_refused(tmp_path: Path, capsys: PRINTED) -> None:
    model = ROOT / "examples" / "two_nodes" / "model.yaml"
    assert main(["monitor", str(model), "--file", str(tmp_path / "live")]) == 2
    assert "names no node: the model has" in capsys.readouterr().err


def test_an_object_of_a_stream_is_the_result_of_one_snapshot(analysis: Analysis) -> None:
    from ravenchart.commands.run_results import MonitorResult

    node = seen(NodeMonitor(analysis, "board"), *processors(40))
    text = json.dumps(asdict(MonitorResult("Infusion_System", [node], [])))
    assert json.loads(text)["nodes"][0]["now"] == 2_000_000_000


# --- Its cost ----------------------------------------------------------------------


@pytest.mark.parametrize("example", EXAMPLES)
def test_no_bound_changes_where_the_main_program_reads_all_counts_at_run_time(
    example: str,
) -> None:
    """Its sections reach no task that a section of health or trace does not reach already."""
    checked = checking.check(ROOT / "examples" / example / "model.yaml", deadlines=False)
    read = ("monitor", "transmit", "receive", "board", "queue")
    objects = tuple(
        replace(one, users=(*one.users, MAIN))
        if one.element.rpartition(".")[2] in read and MAIN not in one.users
        else one
        for one in checked.system.objects
    )
    assert objects != checked.system.objects
    watched = analyse(replace(checked.system, objects=objects))
    bounds = [(one.task.name, one.bound) for one in checked.analysis.responses]
    assert [(one.task.name, one.bound) for one in watched.responses] == bounds
