# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A running controller as an object, over an interface of python-can that has no descriptor."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import can
import pytest

from ravenchart.failures import Refused, Unusable
from ravenchart.hw_can.bench.interfaces import BusEnd, joined_peer
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.running.remote import NoAnswerError, RemoteSystem, Sent, connect
from ravenchart.running.vocabulary import WordError
from tests.support.bus_server import BusServer
from tests.support.far_end import ROBOT, FarEnd, robot, status

pytestmark = pytest.mark.clock

MODEL = ROBOT / "model.yaml"
ZERO = {"x": 0, "y": 0, "z": 0}


@pytest.fixture
def near(far: FarEnd, request: pytest.FixtureRequest) -> Iterator[RemoteSystem]:
    words = robot()
    with RemoteSystem(
        words, joined_peer({"bus": BusEnd("virtual", request.node.name)}, words.codec)
    ) as one:
        yield one


def test_a_command_is_sent_with_its_fields_and_those_sent_last(
    near: RemoteSystem, far: FarEnd
) -> None:
    assert near.send("Home", **ZERO) == Sent("robot_command", {"kind": "Home", **ZERO})
    assert far.hears("robot_command") == {"kind": "Home", **ZERO}
    near.send("Move", x=300_000)
    near.send("robot_command", kind="Halt", y=7)
    near.wait_for("robot_status.condition", "Ready", 2)
    far.hears("robot_command", kind="Halt")
    assert [values for _, values in far.heard] == [
        {"kind": "Home", **ZERO},
        {"kind": "Move", **ZERO, "x": 300_000},
        {"kind": "Halt", "x": 300_000, "y": 7, "z": 0},
    ]


@pytest.mark.parametrize(
    ("name", "fields", "text"),
    [
        ("Mov", {}, "there is no command or message `Mov`\n  hint: did you mean `Move`?"),
        ("Move", {"q": 1}, "`robot_command` has no field `q`\n  hint: one of kind, x, y, z"),
        ("Move", {"y": 0, "z": 0}, "`Move` needs `x`\n  hint: x is a number from -20000 to"
                                   " 500000, in um"),
        ("Move", {"x": 500_001}, "`x` must be a number from -20000 to 500000, in um,"
                                 " not `500001`"),
        ("Move", {"x": "far"}, "`x` must be a number from -20000 to 500000, in um, not `far`"),
        ("Move", {"kind": "Home"}, "`kind` is `Move` already\n  hint: leave `kind` out"),
        ("robot_status", {}, "`robot_status` is sent by the controller itself\n  hint: to send: "
                             "Halt, Home, Move, Reset, robot_command, x_feedback, y_feedback,"
                             " z_feedback"),
        ("Ready", {}, "there is no command or message `Ready`\n  hint: one of Halt, Home, Move,"
                      " Reset, robot_command, x_feedback, y_feedback, z_feedback"),
    ],
)  # fmt: skip
def test_what_cannot_be_sent_is_refused_in_words(
    near: RemoteSystem, far: FarEnd, name: str, fields: dict[str, int | str], text: str
) -> None:
    with pytest.raises(WordError) as refused:
        near.send(name, **fields)
    assert str(refused.value) == text
    assert far.heard == []


def test_the_status_is_the_last_values_of_each_message_that_came(
    near: RemoteSystem, far: FarEnd
) -> None:
    assert near.status == {} and near.age("robot_status") == float("inf")
    far.say(*status("Homing", 5))
    far.say("x_set_point", {"mode": "Enabled", "speed": -3})
    near.wait_for("x_set_point.mode", "Enabled", 2)
    assert near.status == {
        "robot_status": {"condition": "Homing", "x": 5, "y": 0},
        "x_set_point": {"mode": "Enabled", "speed": -3},
    }
    assert 0 <= near.age("robot_status") < 2


def test_an_answer_that_came_before_it_was_waited_for_counts(
    near: RemoteSystem, far: FarEnd
) -> None:
    near.send("Home", **ZERO)
    far.hears("robot_command")
    time.sleep(0.2)  # the answer, which comes once, has been received
    assert near.wait_for("condition", "Ready", 2) < 0.1


def test_a_state_from_before_the_command_does_not_count(near: RemoteSystem, far: FarEnd) -> None:
    far.say(*status("Failed"))
    assert near.wait_for("condition", "Failed", 2) >= 0
    near.send("Home", **ZERO)
    near.wait_for("condition", "Ready", 2)
    with pytest.raises(NoAnswerError, match=r"was not Failed within 0\.1 s: last Ready, .*s ago"):
        near.wait_for("condition", "Failed", 0.1)


def test_a_coroutine_waits_while_others_go_on(near: RemoteSystem, far: FarEnd) -> None:
    async def both() -> tuple[float, float]:
        async def later() -> float:
            await asyncio.sleep(0.1)
            far.say(*status("Homing"))
            return 0.0

        return await asyncio.gather(near.state("condition", "Homing", timeout=5), later())

    took, _ = asyncio.run(both())
    assert 0.05 < took < 5


def test_without_an_answer_the_error_says_what_came_last(near: RemoteSystem, far: FarEnd) -> None:
    with pytest.raises(NoAnswerError) as silent:
        near.wait_for("condition", "Ready", 0.05)
    assert str(silent.value) == (
        "robot_status.condition was not Ready within 0.05 s: no robot_status came\n"
        "  hint: is the controller on robot_bus, at 500000 bit/s? Messages received: none"
    )
    far.say(*status("Failed"))
    near.wait_for("condition", "Failed", 2)
    with pytest.raises(TimeoutError, match=r"was not Ready within 0.05 s: last Failed, .* ms ago"):
        asyncio.run(near.state("condition", "Ready", timeout=0.05))


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("robot_status.conditoin", "Ready", "there is no field or chart `robot_status.conditoin`\n"
         "  hint: did you mean `robot_status.condition`?"),
        ("mode", "Enabled", "`mode` is a field of x_set_point and y_set_point and z_set_point\n"
         "  hint: write `x_set_point.mode`"),
        ("condition", "Redy", "`condition` must be one of Waiting, Homing, Ready, Moving, Failed,"
         " Stopped, not `Redy`"),
        ("condition", 2, "`condition` must be one of Waiting, Homing, Ready, Moving, Failed,"
         " Stopped, not `2`"),
        ("x", 500_001, "`x` must be a number from -20000 to 500000, in um, not `500001`"),
    ],
)  # fmt: skip
def test_what_cannot_come_is_not_waited_for(
    near: RemoteSystem, name: str, value: int | str, text: str
) -> None:
    with pytest.raises(WordError) as refused:
        near.wait_for(name, value)
    assert str(refused.value) == text


def test_a_malformed_frame_is_counted_and_the_next_one_read(
    near: RemoteSystem, far: FarEnd
) -> None:
    short = far.words.codec.encode(*status("Ready"))
    far.bus.send(can.Message(arbitration_id=short.arbitration_id, is_extended_id=False, data=b"1"))
    far.say(*status("Homing"))
    near.wait_for("condition", "Homing", 2)
    assert near.malformed == 1


def test_closing_ends_who_waits(near: RemoteSystem) -> None:
    threading.Timer(0.1, near.close).start()
    with pytest.raises(BenchError, match="the bus was left"):
        near.wait_for("condition", "Ready", 30)
    with pytest.raises(BenchError, match="the bus was left"):
        near.send("Home", **ZERO)


def test_a_bus_that_breaks_ends_who_waits_and_names_itself() -> None:
    server = BusServer()
    words = robot()
    try:
        with RemoteSystem(
            words, joined_peer({"bus": BusEnd("ravenchart", server.channel)}, words.codec)
        ) as it:
            threading.Timer(0.1, server.cut).start()
            with pytest.raises(BenchError, match=rf"^ravenchart '{server.channel}': the bus serv"):
                it.wait_for("condition", "Ready", 30)
            with pytest.raises(BenchError, match="the bus server"):
                it.send("Home", **ZERO)
    finally:
        server.close()


@pytest.mark.parametrize("kind", [str, Path])
def test_drives_of_a_scenario_are_simulated_and_pushed(
    far: FarEnd, tmp_path: Path, kind: type[str] | type[Path]
) -> None:
    drives = kind(ROBOT / "scenario.yaml")
    channel = far.bus.channel_info.split()[-1]
    log = kind(tmp_path / "bus.log")
    with connect(MODEL, interface="virtual", channel=channel, drives=drives, log=log) as near:
        assert near.drives == ("x", "y", "z")
        far.hears("y_feedback", limit="Clear")
        near.pull("y", "high")
        far.hears("y_feedback", limit="High_End")
        near.release("y")
        far.hears("y_feedback", limit="Clear")
        with pytest.raises(WordError, match="no simulated drive `q`\n  hint: one of x, y, z"):
            near.pull("q", "low")
        near.send("Home", **ZERO)
        near.wait_for("condition", "Ready", 2)
    with can.LogReader(log) as reader:
        kept = {frame.arbitration_id for frame in reader}
    assert {0x080, 0x120, 0x121, 0x122, 0x180} <= kept
    with connect(MODEL, interface="virtual", channel=channel) as near:
        assert near.replay(log) > 10  # the feedback: the drives are not simulated now
        assert near.drives == ()


def test_what_there_is_not_is_refused_when_it_is_connected(tmp_path: Path) -> None:
    with pytest.raises(Unusable, match="python-can has no interface 'none'; it has "):
        connect(MODEL, interface="none", channel="x")
    with pytest.raises(Unusable, match=r"ravenchart '127.0.0.1:1' cannot be opened: "):
        connect(MODEL, interface="ravenchart", channel="127.0.0.1:1")
    with pytest.raises(Unusable, match="Three_Components has no bus"):
        connect(ROBOT.parent / "three_components" / "model.yaml", interface="virtual", channel="x")
    with pytest.raises(Refused, match="RV-0101"):
        connect(tmp_path / "none.yaml", interface="virtual", channel="x")
