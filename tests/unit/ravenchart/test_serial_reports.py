# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a terminal has kept of the serial line of a board, read as the trace of a run."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.analysis.system.observed import TraceError, read_map
from ravenchart.building import checking
from ravenchart.building.checking import Checked
from ravenchart.command_line import main
from ravenchart.paths import ROOT
from ravenchart.running.boards import write_trace
from ravenchart.running.replaying import ReplayedRun
from ravenchart.running.traces.files import NodeTrace, read_traces
from ravenchart.workbench.replay import ReplayView
from tests.support.recordings import random_trace
from tests.support.snapshot_files import PUMP, trace_map

NODES = ROOT / "examples" / "two_nodes" / "model.yaml"
HEAD = f"E 5210000\nM {trace_map().digest}\n"
BOOT = "\r\nXilinx Zynq MP First Stage Boot Loader \r\nE1: eMMC\r\nNOTICE:  BL31: v2.8\r\n"
WHY = "error: control has ended by an exception: infusion_system-bed.adb:12"


@pytest.fixture(scope="module")
def checked() -> Checked:
    return checking.check(PUMP, deadlines=False)


def kept(checked: Checked, folder: Path, text: str) -> NodeTrace:
    """The trace in a file with this text, byte for byte."""
    path = folder / "board.txt"
    path.write_bytes(text.encode())
    return read_traces(checked, [path])["board"]


def test_what_is_said_before_and_the_ends_of_lines_make_no_difference(
    checked: Checked, tmp_path: Path
) -> None:
    lines = random_trace(trace_map(), 3)
    plain = HEAD + "".join(f"{line}\n" for line in lines)
    expected = kept(checked, tmp_path, plain)
    found = kept(checked, tmp_path, BOOT + plain.replace("\n", "\r\n"))
    assert found.seen == expected.seen and found.seen.complete and len(found.seen.records) > 100
    assert [r for one in found.reports for r in one] == [r for one in expected.reports for r in one]
    assert found.said == []


def test_a_board_may_repeat_the_line_that_names_its_model(checked: Checked, tmp_path: Path) -> None:
    lines = random_trace(trace_map(), 3)
    expected = kept(checked, tmp_path, HEAD + "".join(f"{line}\n" for line in lines))
    again = HEAD.splitlines()[1]
    found = kept(
        checked, tmp_path, HEAD + "".join(f"{line}\n{again}\n" for line in lines[:-1]) + "END\n"
    )
    assert found.seen == expected.seen and found.reports == expected.reports


@pytest.mark.slow
def test_wherever_the_file_ends_its_whole_lines_are_read(checked: Checked, tmp_path: Path) -> None:
    lines = random_trace(trace_map(), 4, length=25)
    text = HEAD + "".join(f"{line}\n" for line in lines)
    whole = kept(checked, tmp_path, text).seen
    for end in range(len(HEAD), len(text)):
        seen = kept(checked, tmp_path, text[:end]).seen
        left = sum(line[0] in "TV" for line in text[:end].splitlines(keepends=True) if "\n" in line)
        records = sorted((*seen.records, *seen.values), key=lambda one: one.time)
        assert len(records) == left and seen.records == whole.records[: len(seen.records)]
        assert seen.complete == text[:end].endswith("\nEND")


def test_the_line_that_an_exception_interrupts_is_left_out_and_the_reason_is_told(
    checked: Checked, tmp_path: Path
) -> None:
    lines = random_trace(trace_map(), 5, length=40)
    text = HEAD + "".join(f"{line}\n" for line in lines[:30])
    expected = kept(checked, tmp_path, text)
    cut = lines[30][: len(lines[30]) - 1]
    for interrupted in ("", cut):  # Ravenchart.Failures ends the line first
        found = kept(checked, tmp_path, f"{text}{interrupted}\n{WHY}\n")
        assert (found.seen, found.said) == (expected.seen, [WHY])
    after_end = kept(checked, tmp_path, f"{text}END\n{WHY}\n")
    assert after_end.seen.complete and after_end.said == [WHY]


def test_a_second_run_and_a_line_that_is_none_are_refused_with_their_lines(
    checked: Checked, tmp_path: Path
) -> None:
    with pytest.raises(TraceError, match=r"board\.txt:7: error: the controller has started again"):
        kept(checked, tmp_path, f"{BOOT}{HEAD}{HEAD}")
    with pytest.raises(TraceError, match=r"board\.txt:7: error: not a trace line: 'Xilinx"):
        kept(checked, tmp_path, f"{BOOT}{HEAD}Xilinx\nEND\n")


def test_the_page_and_the_command_tell_why_the_controller_ended(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "board.txt"
    path.write_text(f"{BOOT}{HEAD}{random_trace(trace_map(), 6)[0]}\n\n{WHY}\n")
    found = ReplayView(PUMP, [path]).look(None)["replay"]
    assert found["said"] == [{"node": "board", "text": WHY}] and found["cut"] == ["board"]
    assert main(["trace", str(PUMP), str(path), "--out", str(tmp_path / "out.csv")]) == 0
    assert f"warning: the controller said: {WHY}" in capsys.readouterr().err


def test_boards_that_have_run_together_are_replayed_together(tmp_path: Path) -> None:
    """The clock of each board is its own: the times of all begin with the first look."""
    files = []
    for number, map_of in enumerate(sorted((NODES.parent / "generated").rglob("trace.json"))):
        names = read_map(map_of.read_text(encoding="utf-8"))
        row = names.of_kind("row")[0].number
        serial = tmp_path / "serial.txt"
        serial.write_text(
            f"E {7 + number * 10**9}\nM {names.digest}\nT 1000 Activity {row} 0\nEND\n"
            f"warning: {number}\n"
        )
        files.append(tmp_path / f"trace-{map_of.parent.name}.txt")
        assert write_trace(serial, files[-1], together=True) == (f"warning: {number}",)
    checked = checking.check(NODES, deadlines=False)
    replay = ReplayedRun(checked.analysis, read_traces(checked, files))
    assert [one.late for one in replay.controllers] == [0, 0] and replay.end == 1000
    assert write_trace(tmp_path / "absent", files[0], together=False) == ()
    assert files[0].read_text() == ""
