# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A board that is watched over its serial line: a pseudo-terminal, or an emulator's socket."""

from __future__ import annotations

import errno
import os
import shutil
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path

import pytest

from ravenchart.analysis.system.row_responses import rows_executed
from ravenchart.building import programs
from ravenchart.building.checking import Checked, check
from ravenchart.command_line import main
from ravenchart.failures import UNUSABLE, WRONG, Refused, Unusable
from ravenchart.running import watched_boards
from ravenchart.running.chart_states import ChartWatch
from ravenchart.running.monitored import NOT_FROM_START
from ravenchart.running.monitoring import given, watching
from ravenchart.running.watched_boards import NOT_NAMED, SerialLine, WatchedBoard, line_of
from ravenchart.workbench.live import LiveView
from tests.support.can_frames import within
from tests.support.far_boards import HEAD, Board
from tests.support.recordings import monitored, random_trace
from tests.support.snapshot_files import GENERATED, PUMP, number, trace_map

pytestmark = pytest.mark.clock

BOOT = ("Xilinx First Stage Boot Loader", "E is no start, nor is", "T 1 State 0 0")


@pytest.fixture(scope="module")
def checked() -> Checked:
    """The pump, whose program is generated."""
    return check(PUMP, deadlines=False)


@pytest.fixture
def board() -> Iterator[Board]:
    """A board that says nothing yet."""
    found = Board()
    yield found
    found.close()


@contextmanager
def watched(checked: Checked, port: str) -> Iterator[WatchedBoard]:
    """Its controller, watched."""
    with watching(checked, given(checked, [port])) as (found,):
        assert isinstance(found, WatchedBoard)
        yield found


def looked(board: WatchedBoard, now: int) -> None:
    """Look until a record of that time was shown."""

    def is_there() -> bool:
        board.look()
        return board.node.now >= now

    assert within(is_there)


def test_nothing_is_shown_until_the_board_names_its_model(checked: Checked, board: Board) -> None:
    with watched(checked, board.port) as found:
        board.says(*BOOT)
        assert within(lambda: found.look() and found.is_new)
        assert found.node.not_seen == [NOT_NAMED]
        assert (found.node.process, found.node.charts, found.node.lost) == (0, [], {})
        board.says(*HEAD, f"T 5000 State {number('bed.Keys', 'region')} 0")
        looked(found, 5000)
        assert [one.name for one in found.node.charts if one.state is not None] == ["bed.Keys"]
        assert NOT_NAMED not in found.node.not_seen


@pytest.mark.parametrize("seed", range(6))
def test_it_shows_what_a_snapshot_of_the_same_records_does(
    checked: Checked, board: Board, seed: int
) -> None:
    lines = random_trace(trace_map(), seed)
    last = max(int(line.split()[1]) for line in lines if line[0] in "TVN")
    wanted = monitored(checked.analysis, trace_map(), lines, last)
    with watched(checked, board.port) as found:
        board.says(*BOOT, *HEAD, *lines)
        looked(found, last)
        assert within(lambda: found.look() and found.node.ended)
        assert _shown(asdict(found.node)) == _shown(asdict(wanted))
        assert found.node.lost == wanted.lost


def _shown(node: dict[str, object]) -> dict[str, object]:
    """What both have: how often and when somebody looked is not it."""
    return {
        key: value
        for key, value in node.items()
        if key not in ("node", "sequence", "unlisted", "missed", "not_seen", "events")
    }


def test_each_transition_is_shown_once_or_counted(checked: Checked, board: Board) -> None:
    region = number("bed.Infusion", "region")
    with watched(checked, board.port) as found:
        board.says(*HEAD)
        shown = 0
        for part in range(3):
            times = range(100 * part + 1, 100 * part + 51)
            board.says(*(f"T {at} Transition {region} 0" for at in times))

            def is_there(last: int = times[-1]) -> bool:
                nonlocal shown
                found.look()
                shown += len(found.node.events) + found.node.unlisted
                return found.node.now >= last

            assert within(is_there)
        assert shown == 150


def test_a_board_that_starts_again_is_another_one(checked: Checked, board: Board) -> None:
    region = number("bed.Keys", "region")
    with watched(checked, board.port) as found:
        board.says(*HEAD, f"T 9000 Transition {region} 0")
        looked(found, 9000)
        first = found.start
        board.says("error: the task control has ended", *HEAD, f"T 20 State {region} 0")
        assert within(lambda: found.look() and found.start != first and found.node.now == 20)
        assert found.node.charts[0].transitions == 0 and found.node.said == []


def test_a_board_that_runs_already_is_shown_from_the_next_line_that_names_its_model(
    checked: Checked, board: Board
) -> None:
    keys, port = number("bed.Keys", "region"), number("bed.panel", "port")
    with watched(checked, board.port) as found:
        board.says("ate 1 0", f"T 4000 State {keys} 0", f"T 4500 Arrived {port} 0")
        assert within(lambda: found.look() and found.is_new)
        assert found.node.not_seen == [NOT_NAMED]
        board.says(HEAD[1], f"T 5000 Transition {keys} 0", f"T 5000 State {keys} 0")
        looked(found, 5000)
        (event,) = found.node.events
        assert (event.element, found.overlooked.events) == ("bed.Keys", 0)
        assert NOT_FROM_START in found.node.not_seen and NOT_NAMED not in found.node.not_seen
        board.says(HEAD[1], f"T 6000 Handled {port} 0", f"T 7000 Transition {keys} 0")
        looked(found, 7000)  # a line that names the model again begins nothing anew
        chart = next(one for one in found.node.charts if one.name == "bed.Keys")
        assert (chart.transitions, chart.since) == (2, 5000)
        assert [one.waiting for one in found.node.queues] == [None]
        board.says(*HEAD, f"T 20 State {keys} 0")
        assert within(lambda: found.look() and found.node.now == 20)
        assert NOT_FROM_START not in found.node.not_seen


def test_faults_are_counted_before_the_report(checked: Checked, board: Board) -> None:
    element = number("bed.Keys", "region")
    with watched(checked, board.port) as found:
        board.says(
            *HEAD, f"T 7 Fault {element} 2", f"T 8 Fault {element} 2", f"T 9 Fault {element} 1"
        )
        looked(found, 9)
        assert found.node.faults == {"Queue_Overflow": 2, "Overrun": 1}


def _job(due: int) -> list[str]:
    """The records of a release of the pump's `control`: an activity each 100 us."""
    (control,) = (one for one in check(PUMP).system.processors if one.name == "control")
    rows = rows_executed(control, due // control.period)
    return [
        f"T {due + 100_000 * place} Activity {number(row, 'row')} 0"
        for place, row in enumerate(rows, 1)
    ]


def _report(now: int, releases: int, last: int) -> list[str]:
    """What the board reports each second, of `control` alone."""
    return [HEAD[1], f"N {now}", f"P {number('control', 'processor')} {releases} 0 {last} {last}"]


def _responses(board: WatchedBoard) -> dict[str, tuple[int, int, int]]:
    """The exact responses, upper estimates and executions of activities that have any."""
    return {
        one.name: (sum(one.exact), sum(one.at_most), one.executions)
        for one in board.responses().rows
        if one.executions
    }


MS = 1_000_000
FIRST = [*_job(0), *_job(50 * MS)]
"""The releases before the first report."""
SECOND = [*_job(100 * MS), *_job(150 * MS)]


def test_the_responses_of_a_board_are_those_of_its_reports(checked: Checked, board: Board) -> None:
    with watched(checked, board.port) as found:
        board.says(*HEAD, *FIRST, *_report(60 * MS, 2, MS), *SECOND, *_report(160 * MS, 4, MS))
        assert within(lambda: found.look() and _responses(found).get("bed.ports") == (0, 2, 2))
        assert found.node.processors[-1].completed == 4
        board.says(*_report(161 * MS, 4, MS))  # until then a record might follow
        assert within(lambda: found.look() and _responses(found).get("bed.ports") == (0, 4, 4))
        assert sum(exact for exact, _, _ in _responses(found).values()) == 2
        assert "up to 0.160 s" in found.responses().note
        board.says(*HEAD, *FIRST, *_report(60 * MS, 2, MS))  # it starts again
        assert within(lambda: found.look() and not _responses(found))


def test_where_a_line_is_lost_only_responses_that_are_reported_are_shown(
    checked: Checked, board: Board
) -> None:
    with watched(checked, board.port) as found:
        board.says(*HEAD, *FIRST[1:], *_report(60 * MS, 2, MS), *SECOND, *_report(160 * MS, 4, MS))
        board.says(*_report(161 * MS, 4, MS))
        assert within(lambda: found.look() and _responses(found).get("bed.ports") == (0, 2, 4))


def test_of_a_board_that_ran_already_the_first_report_is_the_begin(
    checked: Checked, board: Board
) -> None:
    with watched(checked, board.port) as found:
        board.says(*FIRST[1:], *_report(60 * MS, 2, MS), *SECOND, *_report(160 * MS, 4, MS))
        board.says(*_report(161 * MS, 4, MS))
        assert within(lambda: found.look() and _responses(found).get("bed.ports") == (0, 2, 2))


def test_a_fault_that_is_reported_is_counted_once(checked: Checked, board: Board) -> None:
    fault = f"T 7 Fault {number('bed.Keys', 'region')} 2"
    with watched(checked, board.port) as found:
        board.says(*HEAD, fault, *_report(8, 0, 0), "H Queue_Overflow 2", fault)
        looked(found, 8)
        assert within(lambda: found.look() and found.node.faults == {"Queue_Overflow": 2})


def test_why_a_controller_ended_is_said(checked: Checked, board: Board) -> None:
    why = "error: CONSTRAINT_ERROR : the stack of control is too small"
    with watched(checked, board.port) as found:
        board.says(*HEAD, why)
        assert within(lambda: found.look() and found.node.said == [why])


def test_lines_that_cannot_be_read_are_counted(checked: Checked, board: Board) -> None:
    with watched(checked, board.port) as found:
        board.says(*HEAD, "T 12 Sta\x00te 1 0", "T 13 State 99999 0", "half a li")
        board.says(f"T 14 State {number('bed.Keys', 'region')} 0")
        looked(found, 14)
        assert found.node.lost == {"serial line.trace": 3}
        assert all(queue.waiting is None for queue in found.node.queues)


def test_what_finds_no_room_is_counted(
    checked: Checked, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    region = number("bed.Keys", "region")
    with watched(checked, board.port) as found:
        board.says(*HEAD, f"T 1 State {region} 0")
        looked(found, 1)
        monkeypatch.setattr(watched_boards, "MOST_WAITING", 0)
        board.says(*(f"T {at} State {region} 0" for at in range(2, 32)))
        assert within(lambda: found.look() and found.node.lost == {"serial line.trace": 30})
        board.writes("x" * (watched_boards.LINE_BYTES + 1))
        assert within(lambda: found.look() and found.node.lost == {"serial line.trace": 31})


def test_the_program_of_another_model_is_refused(checked: Checked, board: Board) -> None:
    with watched(checked, board.port) as found:
        board.says("E 0", f"M {'0' * 64}", "T 1 State 0 0")
        with pytest.raises(Refused, match="was generated from another model"):
            within(lambda: found.look() and False)


def test_a_board_of_another_model_that_runs_already_is_refused(
    checked: Checked, board: Board
) -> None:
    with watched(checked, board.port) as found:
        board.says("T 1 State 0 0", f"M {'0' * 64}")
        with pytest.raises(Refused, match="was generated from another model"):
            within(lambda: found.look() and False)


def test_an_unplugged_line_is_told(checked: Checked, board: Board) -> None:
    with watched(checked, board.port) as found:
        board.says(*HEAD)
        assert within(lambda: found.look() and found.is_new)
        board.unplugged()
        assert within(lambda: found.look() and found.node.process is None)
        assert found.end_in_words.startswith(f"nothing comes from {board.port} any more: ")


def test_the_line_of_an_emulator_is_a_socket(checked: Checked) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        with watched(checked, f"board=socket://127.0.0.1:{port}") as found:
            peer, _ = server.accept()
            with peer:
                peer.sendall("".join(f"{one}\n" for one in (*HEAD, "END")).encode())
                assert within(lambda: found.look() and found.node.ended)
                assert found.node.process == 0
            assert within(lambda: found.look() and found.node.process is None)


def test_a_line_that_comes_back_waits_until_the_board_names_its_model(
    checked: Checked, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watched_boards, "AGAIN", 0.0)
    with socket.create_server(("127.0.0.1", 0)) as server:
        place = f"socket://127.0.0.1:{server.getsockname()[1]}"
        with watched(checked, place) as found:
            server.accept()[0].close()
            assert within(lambda: found.look() and found.node.process is None)
            assert within(lambda: found.look() and found.node.process == 0)
            assert found.node.not_seen == [NOT_NAMED]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("/dev/ttyUSB1", SerialLine("/dev/ttyUSB1", 115_200)),
        ("/dev/ttyUSB1@9600", SerialLine("/dev/ttyUSB1", 9600)),
        ("socket://localhost:4000", SerialLine("socket://localhost:4000", 115_200)),
        ("/dev/serial/by-id/usb-board@9600", SerialLine("/dev/serial/by-id/usb-board", 9600)),
        ("/run/pump.live", None),
        ("/dev/shm/pump.live", None),
        ("pump@9600", None),
    ],
)
def test_a_serial_line_is_a_device_or_an_address(text: str, line: SerialLine | None) -> None:
    assert line_of(text) == line


def test_a_wrong_rate_or_port_is_told(checked: Checked, board: Board) -> None:
    with pytest.raises(Unusable, match="'fast' is no number of bits in a second"):
        line_of(f"{board.port}@fast")
    absent = pytest.raises(Unusable, match=r"cannot read the serial line /dev/ttyUSB99: .*No such")
    with absent, watched(checked, "/dev/ttyUSB99"):
        pass
    locked = pytest.raises(Unusable, match="lock")
    with watched(checked, board.port), locked, watched(checked, board.port):
        pass


def test_the_monitor_ends_with_the_line_and_says_so(
    board: Board, capsys: pytest.CaptureFixture[str]
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        pid = os.fork()
        if pid == 0:
            peer, _ = server.accept()
            time.sleep(0.5)  # a board boots; what comes while the line is opened is discarded
            with peer:
                region = number("bed.Keys", "region")
                lines = (*HEAD, f"T 1500000000 State {region} 0", f"T 2000000000 Fault {region} 2")
                peer.sendall("".join(f"{one}\n" for one in lines).encode())
            os._exit(0)
        port = server.getsockname()[1]
        status = main(["monitor", str(PUMP), "--file", f"socket://127.0.0.1:{port}"])
        os.waitpid(pid, 0)
    out, error = capsys.readouterr()
    assert status == WRONG
    assert "2.000 bed.Keys fault Queue_Overflow\n" in out
    assert f"error: nothing comes from socket://127.0.0.1:{port} any more: " in out + error


@pytest.mark.slow
def test_the_page_shows_a_board_and_waits_after_that_of_another_model(
    tmp_path: Path, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(programs, "work", lambda: tmp_path)
    shutil.copytree(GENERATED, tmp_path / "pump" / "generated")
    model = Path(shutil.copy(PUMP, tmp_path / "pump"))
    live = LiveView(model, None, [board.port])
    digest = trace_map().digest
    try:
        (node,) = live.look(digest)["nodes"]
        assert node["not_seen"] == [NOT_NAMED]
        board.says("E 0", f"M {'0' * 64}")
        assert within(lambda: "another model" in live.look(digest)["text"])
        board.says("T 3 State 0 0", "T 4 State 0 0")
        for _ in range(20):  # until a program of this model starts
            time.sleep(0.02)
            assert "another model" in live.look(digest)["text"]
        region = number("bed.Keys", "region")
        board.says(*HEAD, f"T 5 State {region} 0")
        assert within(lambda: live.look(digest)["nodes"][0]["now"] == 5)
        found = live.look(digest)
        assert found["text"] == "" and found["nodes"][0]["charts"][-1]["name"] == "bed.Keys"
    finally:
        live.close()


def test_a_serial_line_that_cannot_be_read_is_refused_before_a_page_is_served(
    capsys: pytest.CaptureFixture[str],
) -> None:
    status = main(["workbench", str(PUMP), "--no-open", "--file", "/dev/ttyUSB99"])
    assert status == UNUSABLE
    assert os.strerror(errno.ENOENT) in capsys.readouterr().err


def test_the_shell_sees_the_states_of_its_charts(checked: Checked, board: Board) -> None:
    with watched(checked, board.port) as found:
        charts = ChartWatch([found])
        assert charts.look() == {}
        board.says(*HEAD, f"T 5 State {number('bed.Keys', 'region')} 0", "T 6 Sta")
        board.says(f"T 7 Activity {number('bed.ports', 'row')} 0")
        assert within(lambda: charts.look() and found.node.now == 7)
        seen = charts.look()["bed.Keys"]
        assert (seen.state, seen.lost, seen.ended) == ("Listening", 1, False)
