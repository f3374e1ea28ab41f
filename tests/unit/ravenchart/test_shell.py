# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart shell`: its lines, their errors, completion, scripts, and its answer as JSON."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import can
import pytest
from rich.console import Console

from ravenchart.command_line import main
from ravenchart.commands import running
from ravenchart.commands import shell as shell_command
from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.hw_can.bench.interfaces import BusEnd, joined_peer
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.running.process import Ended, StartError
from ravenchart.running.remote import NoAnswerError, RemoteSystem
from ravenchart.running.shell import USAGES, Shell, value_of
from ravenchart.running.started import StartedControllers
from ravenchart.running.vocabulary import BusVocabulary, WordError
from tests.support.answers import answered
from tests.support.bus_server import BusServer
from tests.support.far_end import ROBOT, FarEnd, obedient, robot, status

MODEL = ROBOT / "model.yaml"
PRINTED = pytest.CaptureFixture[str]


@pytest.fixture
def shell(far: FarEnd, request: pytest.FixtureRequest) -> Iterator[Shell]:
    words = robot()
    with RemoteSystem(
        words, joined_peer({"bus": BusEnd("virtual", request.node.name)}, words.codec)
    ) as it:
        yield Shell(it, Console(file=io.StringIO(), width=80, highlight=False))


def said(shell: Shell, *lines: str) -> list[str]:
    """What these lines print."""
    assert isinstance(shell.out.file, io.StringIO)
    shell.out.file.seek(0)
    shell.out.file.truncate()
    for line in lines:
        assert shell.do(line)
    return [line.rstrip() for line in shell.out.file.getvalue().splitlines()]


def test_a_command_is_sent_and_its_answer_waited_for(shell: Shell) -> None:
    lines = said(
        shell, "send Home x=0 y=0 z=0  # to its zeros", "", "# nothing",
        "send Move x=300_000", "wait_for condition Ready 2 s",
    )  # fmt: skip
    assert lines[:2] == [
        "sent robot_command: kind Home, x 0, y 0, z 0",
        "sent robot_command: kind Move, x 300000, y 0, z 0",
    ]
    assert lines[2].startswith("condition is Ready after ")


def test_the_status_has_units_and_the_messages_that_did_not_come(shell: Shell, far: FarEnd) -> None:
    far.say(*status("Homing", 12))
    shell.do("wait_for x 12 2 s")
    lines = said(shell, "status")
    assert lines[0].split() == ["message", "age", "s", "values"]
    assert lines[1].endswith("condition Homing, x 12 um, y 0 um")
    assert lines[2].split() == ["x_set_point", "-", "none", "came"]
    assert len(lines) == 5
    assert said(shell, "status robot_command")[1].split() == ["robot_command", "-", "none", "came"]


def test_help_fits_a_terminal_and_names_everything(shell: Shell) -> None:
    lines = said(shell, "help")
    assert max(map(len, lines)) <= 80
    assert [line.split()[0] for line in lines[: len(USAGES)]] == [*USAGES]
    assert "to send: Halt, Home, Move, Reset, robot_command, x_feedback," in " ".join(lines)
    assert said(shell, "help Move")[:2] == [
        "robot_command:", "  kind: one of Halt, Home, Move, Reset",
    ]  # fmt: skip
    assert said(shell, "help Mission")[0].startswith("coordinator.Mission: one of Active, ")
    assert "joint_z.Monitoring, coordinator.Mission" in " ".join(lines)
    assert said(shell, "help pull") == [
        "pull DRIVE low|high: press a limit switch of a simulated drive"
    ]


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("hepl", "there is no command `hepl`\n  hint: did you mean `help`?"),
        ("Move x=1", "there is no command `Move`\n  hint: write `send Move`"),
        ("send", "`send` is incomplete\n  hint: write `send NAME [FIELD=VALUE ...]`"),
        ("send Move 5", "`5` is not `FIELD=VALUE`\n  hint: write `send NAME [FIELD=VALUE ...]`"),
        ("send Move x=1 x=2", "`x` is given twice"),
        ("send Move x=900000 y=0 z=0",
         "`x` must be a number from -20000 to 500000, in um, not `900000`"),
        ("send 'Move", "the line cannot be read: no closing quotation"),
        ("wait", "`wait` is incomplete\n  hint: write `wait TIME`"),
        ("wait 5", "`5` is no time: it must be a number and one of us, ms, s, such as `5 ms`\n"
                   "  hint: write `wait TIME`"),
        ("wait -1 s", "`-1 s` is no time: it must be at least 0 s\n  hint: write `wait TIME`"),
        ("wait_for condition", "`wait_for` is incomplete\n"
                               "  hint: write `wait_for NAME VALUE [TIME]`"),
        ("status foo", "there is no message or chart `foo`\n  hint: one of robot_command, "
                       "robot_status, x_set_point, y_set_point, z_set_point, x_feedback, "
                       "y_feedback, z_feedback, joint_x.Motion, joint_x.Monitoring, "
                       "joint_y.Motion, joint_y.Monitoring, joint_z.Motion, joint_z.Monitoring, "
                       "coordinator.Mission"),
        ("status Motion", "`Motion` may be several things\n  hint: write `joint_x.Motion` or "
                          "`joint_y.Motion` or `joint_z.Motion`"),
        ("help Mov", "there is no command, message or chart `Mov`\n  hint: did you mean `Move`?"),
        ("pull x up", "there is no limit switch `up`\n  hint: write `pull DRIVE low|high`"),
        ("release x", "there is no simulated drive `x`\n"
                      "  hint: simulate some: `--drives FILE`, or `drives` of `connect`"),
        ("release x y", "`y` is too much\n  hint: write `release DRIVE`"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_a_hint(shell: Shell, line: str, text: str) -> None:
    with pytest.raises(WordError) as refused:
        shell.do(line)
    assert str(refused.value) == text


def test_faults_of_the_bus_and_of_files_are_said(shell: Shell) -> None:
    with pytest.raises(NoAnswerError, match=r"was not Ready within 0\.02 s: no robot_status came"):
        shell.do("wait_for condition Ready 20 ms")
    with pytest.raises(BenchError, match=r"cannot read none\.blf: no such file or directory"):
        shell.do("replay none.blf")


@pytest.mark.parametrize("line", ["quit", "exit", "quit # now"])
def test_quit_ends(shell: Shell, line: str) -> None:
    assert not shell.do(line)


@pytest.mark.parametrize(
    ("before", "begun", "found"),
    [
        ("", "s", ["send", "status"]),
        ("send ", "M", ["Move"]),
        ("send ", "robot", ["robot_command"]),
        ("send Move ", "", ["x=", "y=", "z="]),
        ("send Move x=1 ", "", ["y=", "z="]),
        ("send robot_command kind=", "H", ["Halt", "Home"]),
        ("send x_set_point ", "", []),
        ("wait_for ", "robot_status.c", ["robot_status.condition"]),
        ("wait_for condition ", "R", ["Ready"]),
        ("wait_for ", "coo", ["coordinator.Mission"]),
        ("wait_for Mission ", "R", ["Ready", "Recovering"]),
        ("wait_for Motion ", "", []),
        ("wait_for nothing ", "", []),
        ("status ", "y", ["y_feedback", "y_set_point"]),
        ("status ", "joint_x", ["joint_x.Monitoring", "joint_x.Motion"]),
        ("help ", "pu", ["pull"]),
        ("help ", "coo", ["coordinator.Mission"]),
        ("pull ", "", []),
        ("pull x ", "", ["high", "low"]),
        ("nothing ", "", []),
    ],
)
def test_words_are_completed(shell: Shell, before: str, begun: str, found: list[str]) -> None:
    assert shell.completions(before, begun) == found


@pytest.mark.parametrize(
    ("text", "value"),
    [("3", 3), ("-20_000", -20_000), ("2.5", 2.5), ("Home", "Home"), ("1e3", "1e3"), ("", "")],
)
def test_numbers_are_read_as_such(text: str, value: int | float | str) -> None:
    assert value_of(text) == value


# --- the command


@pytest.fixture
def channel() -> Iterator[str]:
    """A bus with an obedient robot on it."""
    server = BusServer()
    far = FarEnd(RavenchartBus(server.channel, fd=True), robot(), obedient)
    yield server.channel
    far.close()
    server.close()


def told(monkeypatch: pytest.MonkeyPatch, *lines: str) -> None:
    """What stands on standard input."""
    monkeypatch.setattr("sys.stdin", io.StringIO("".join(f"{line}\n" for line in lines)))


def test_a_script_ends_at_its_first_mistake(
    channel: str, monkeypatch: pytest.MonkeyPatch, capsys: PRINTED
) -> None:
    told(monkeypatch, "send Home x=0 y=0 z=0", "wait_for condition Ready", "send Mov", "status")
    bus = ("--interface", "ravenchart", "--channel", channel)
    assert main(["shell", str(MODEL), *bus]) == 1
    out, errors = capsys.readouterr()
    assert out.startswith("sent robot_command: kind Home, x 0, y 0, z 0\ncondition is Ready after ")
    assert out.count("\n") == 2
    assert errors == (
        "stdin:3: error: there is no command or message `Mov`\n  hint: did you mean `Move`?\n"
    )


def test_a_script_that_is_no_text_is_said_to_be_none(
    channel: str, monkeypatch: pytest.MonkeyPatch, capsys: PRINTED
) -> None:
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"send \xff\n"), "utf-8"))
    assert main(["shell", str(MODEL), "--interface", "ravenchart", "--channel", channel]) == 1
    assert capsys.readouterr().err.startswith(
        "stdin:1: error: there is no command or message `\ufffd`\n  hint: one of Halt, Home, "
    )


def test_a_script_has_an_answer_for_programs(
    channel: str, monkeypatch: pytest.MonkeyPatch, capsys: PRINTED, tmp_path: Path
) -> None:
    bus = ("--interface", "ravenchart", "--channel", channel, "--log", tmp_path / "bus.blf")
    told(monkeypatch, "send Home x=7 y=0 z=0", "wait_for condition Ready", "quit", "send Mov")
    result = answered(capsys, "shell", MODEL, *bus)["result"]
    assert [one["outcome"] for one in result["commands"]] == ["done"] * 3
    assert result["status"] == {"robot_status": {"condition": "Ready", "x": 7, "y": 0}}
    with can.LogReader(tmp_path / "bus.blf") as log:
        assert {frame.arbitration_id for frame in log} == {0x080, 0x180}
    told(monkeypatch, "wait 1 ms", "wait_for condition Ready 1 ms")
    answer = answered(capsys, "shell", MODEL, *bus, status=1)
    assert [one["passed"] for one in answer["result"]["commands"]] == [True, False]
    (found,) = answer["diagnostics"]
    assert (found["file"], found["line"], found["severity"]) == ("stdin", 2, "error")
    assert "is the controller on robot_bus, at 500000 bit/s?" in found["hint"]


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (("--interface", "socketcan"), "--interface and --channel go together"),
        (("--channel", "can0"), "--interface and --channel go together"),
        (("--interface", "none", "--channel", "can0"), "python-can has no interface 'none'"),
        (("--interface", "socketcan", "--channel", "can99"),
         "socketcan 'can99' cannot be opened: "),
    ],
)  # fmt: skip
def test_a_bus_that_there_is_not_is_status_2(
    words: tuple[str, ...], text: str, capsys: PRINTED
) -> None:
    assert main(["shell", str(MODEL), *words]) == 2
    assert f"ravenchart: error: {text}" in capsys.readouterr().err


def test_a_model_without_a_bus_is_status_2(capsys: PRINTED) -> None:
    assert main(["shell", str(ROBOT.parent / "three_components" / "model.yaml")]) == 2
    assert "Three_Components has no bus\n" in capsys.readouterr().err


def stopped(controller: Ended) -> Callable[..., AbstractContextManager[StartedControllers]]:
    """In place of what starts the controllers: one that ends like this."""

    @contextmanager
    def started(
        _built: object, _analysis: object, words: BusVocabulary, *_: object
    ) -> Iterator[StartedControllers]:
        if controller.killed:
            raise StartError("the controller did not open its bus within 10 s")
        peer = joined_peer({"bus": BusEnd("virtual", "own")}, words.codec)
        yield StartedControllers(peer, ended=[controller])

    return started


@pytest.mark.parametrize(
    ("ended", "text"),
    [
        (Ended(1, False, True, ("error: no room",)), "the controller stopped itself: no room"),
        (Ended(-11, False, True, ()), "the controller was ended by SIGSEGV: a stack overflow, or "
                                      "an access to memory that it does not have"),
        (Ended(0, True, True, ()), "the controller did not open its bus within 10 s"),
    ],
)  # fmt: skip
def test_a_controller_of_its_own_that_stops_itself_fails_the_shell(
    ended: Ended, text: str, monkeypatch: pytest.MonkeyPatch, capsys: PRINTED
) -> None:
    monkeypatch.setattr(running, "controllers", lambda *_: ())
    monkeypatch.setattr(shell_command, "started", stopped(ended))
    told(monkeypatch, "wait 1 ms")
    assert main(["shell", str(MODEL)]) == 1
    assert capsys.readouterr().err == f"ravenchart: error: {text}\n"


def test_a_controller_of_its_own_that_goes_on_passes(
    monkeypatch: pytest.MonkeyPatch, capsys: PRINTED
) -> None:
    monkeypatch.setattr(running, "controllers", lambda *_: ())
    monkeypatch.setattr(shell_command, "started", stopped(Ended(0, False, True, ())))
    told(monkeypatch, "wait 1 ms")
    assert main(["shell", str(MODEL)]) == 0
    assert capsys.readouterr().err == ""
