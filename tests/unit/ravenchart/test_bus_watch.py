# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A bus that is watched: its load beside the analysis, its messages, and what is wrong on it."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace

import can
import pytest
from rich.console import Console

from ravenchart.analysis.system.network import frame_length
from ravenchart.building import checking
from ravenchart.command_line import main
from ravenchart.commands import monitor
from ravenchart.failures import OK, UNUSABLE, WRONG, Unusable
from ravenchart.hw_can.bench.interfaces import BusEnd
from ravenchart.hw_can.bench.peer import Value
from ravenchart.paths import ROOT
from ravenchart.running import bus_text, bus_watch
from ravenchart.running.bus_watch import BusWatch, WatchedBus, duration, most_in_a_second
from ravenchart.running.vocabulary import BusVocabulary
from ravenchart.workbench import live_buses, serving
from ravenchart.workbench.live import LiveView
from ravenchart.workbench.live_buses import LiveBuses
from tests.support.bus_server import BusServer
from tests.support.can_frames import within

pytestmark = pytest.mark.clock

PUMP = ROOT / "examples" / "pump" / "model.yaml"
TWO_BUSES = ROOT / "examples" / "two_buses" / "model.yaml"
ROBOT = ROOT / "examples" / "cartesian_robot" / "model.yaml"
ALONE = ROOT / "examples" / "three_components" / "model.yaml"
ANALYSIS = checking.check(PUMP, deadlines=False).analysis
WORDS = BusVocabulary.of(ANALYSIS.system)
DISPLAY: dict[str, Value] = {"given": 70, "lamp": "Steady", "buzzer": "False"}
PRINTED = pytest.CaptureFixture[str]


@pytest.fixture
def channel(request: pytest.FixtureRequest) -> str:
    """A bus of this test alone, in this process."""
    return str(request.node.name)


@pytest.fixture
def sender(channel: str) -> Iterator[can.BusABC]:
    """A node that sends there."""
    with can.Bus(channel, "virtual") as bus:
        yield bus


@pytest.fixture
def watch(channel: str) -> Iterator[BusWatch]:
    """The bus, watched."""
    made = BusWatch(ANALYSIS, BusEnd("virtual", channel))
    yield made
    made.close()


def looked(watch: BusWatch, ready: Callable[[WatchedBus], bool]) -> WatchedBus:
    """The bus once it is as wanted, or as it is when that does not come."""
    within(lambda: ready(watch.look()))
    return watch.look()


def test_each_message_has_its_counts_its_shortest_distance_and_its_last_values(
    watch: BusWatch, sender: can.BusABC
) -> None:
    for number in range(3):
        frame = WORDS.codec.encode("display", DISPLAY | {"given": number})
        sender.send(frame)
        time.sleep(0.02)
    found = looked(watch, lambda bus: bus.frames == 3)
    by_name = {one.name: one for one in found.messages}
    assert [*by_name] == ["line", "motor", "panel", "display"]
    display, motor = by_name["display"], by_name["motor"]
    assert (display.frames, display.fields) == (3, DISPLAY | {"given": 2})
    assert (display.units, display.identifier, display.period) == (
        {"given": "ul"},
        "0x111",
        200_000_000,
    )
    assert display.shortest is not None and 20_000_000 <= display.shortest < 1_000_000_000
    assert display.last is not None and 40_000_000 <= display.last <= found.now
    assert (motor.frames, motor.last, motor.shortest, motor.fields) == (0, None, None, {})
    assert (found.unknown, found.malformed, found.errors, found.gone) == (0, 0, 0, None)


def test_what_does_not_belong_on_the_bus_is_counted(watch: BusWatch, sender: can.BusABC) -> None:
    identifier = WORDS.messages["display"].frame_id
    sender.send(can.Message(arbitration_id=0x7FF, is_extended_id=False, data=[1]))
    sender.send(can.Message(arbitration_id=identifier, is_extended_id=False, data=[1]))
    sender.send(can.Message(is_error_frame=True))
    found = looked(watch, lambda bus: bus.errors == 1)
    assert (found.frames, found.unknown, found.malformed, found.errors) == (2, 1, 1, 1)
    assert not any(one.frames for one in found.messages)
    assert "unknown 1 malformed 1 error frames 1" in next(bus_text.lines(found))


@pytest.mark.parametrize("model", [PUMP, ROBOT], ids=["classic", "robot"])
def test_a_frame_takes_as_long_as_in_the_analysis(model: Path) -> None:
    system = checking.check(model, deadlines=False).system
    words = BusVocabulary.of(system)
    compared = 0
    for message in system.messages:
        dbc = words.messages.get(message.name)
        if dbc is None or message.bus != words.buses[0].name:
            continue
        frame = can.Message(
            arbitration_id=dbc.frame_id, is_extended_id=dbc.is_extended_frame, is_fd=dbc.is_fd,
            bitrate_switch=dbc.is_fd, data=bytes(dbc.length),
        )  # fmt: skip
        bits = frame_length(message, words.buses[0])
        assert duration(frame, words.buses[0]) == bits.time(
            words.buses[0].bit_rate, words.buses[0].data_rate or 0
        )
        compared += 1
    assert compared >= 4


def test_the_load_is_that_of_a_second_and_at_first_too_low(
    watch: BusWatch, sender: can.BusABC
) -> None:
    """Ten frames at once, as the watch starts, are no share of some milliseconds."""
    frame = WORDS.codec.encode("motor", {"value": 3})
    for _ in range(10):
        sender.send(frame)
    found = looked(watch, lambda bus: bus.frames == 10)
    assert found.load == pytest.approx(10 * duration(frame, WORDS.buses[0]) / 1e9)
    time.sleep(1.1)
    assert watch.look().load == 0


def test_the_most_that_a_second_can_hold_is_counted_by_hand() -> None:
    #  line once in 1 s, motor and panel in 50 ms, display in 200 ms, each a little later
    by_hand = 2 * 520 + 21 * 600 + 21 * 680 + 6 * 680
    assert most_in_a_second(ANALYSIS, WORDS.buses[0]) == pytest.approx(by_hand / 1e6)


def test_a_driver_that_fails_is_told_and_what_came_stays(
    channel: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Broken(can.BusABC):
        def __init__(self) -> None:
            super().__init__(channel)
            self.left = 2

        def _recv_internal(self, timeout: float | None) -> tuple[can.Message, bool]:
            self.left -= 1
            if self.left < 0:
                raise OSError("Network is down")
            return WORDS.codec.encode("motor", {"value": 3}), True

        def send(self, msg: can.Message, timeout: float | None = None) -> None:
            raise AssertionError

    monkeypatch.setattr(bus_watch, "opened_bus", lambda interface: Broken())
    watch = BusWatch(ANALYSIS, BusEnd("broken", "x"))
    found = looked(watch, lambda bus: bus.gone is not None)
    watch.close()
    assert (found.gone, found.frames) == ("Network is down", 2)


def test_the_table_fits_80_columns(watch: BusWatch, sender: can.BusABC) -> None:
    sender.send(WORDS.codec.encode("display", DISPLAY))
    found = looked(watch, lambda bus: bus.frames == 1)
    console = Console(width=80, record=True, file=open("/dev/null", "w"))  # noqa: SIM115
    console.print(bus_text.tables(found))
    text = console.export_text()
    assert max(map(len, text.splitlines())) <= 80
    assert "load at most" in text and "given 70 ul, lamp Steady, buzzer" in " ".join(text.split())


# --- The commands


def test_monitor_shows_a_bus_on_which_no_controller_of_this_machine_runs(
    channel: str, sender: can.BusABC, capsys: PRINTED
) -> None:
    words = ["--interface", "virtual", "--channel", channel, "--once", "--json"]
    assert main(["monitor", str(PUMP), *words]) == OK
    found = json.loads(capsys.readouterr().out)["result"]
    assert found["nodes"] == []
    (bus,) = found["buses"]
    assert (bus["bus"], bus["interface"], bus["load"]) == ("ward", f"virtual {channel!r}", 0)


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--interface", "virtual"], "--interface and --channel go together"),
        (["--interface", "nothing", "--channel", "x"], "python-can has no interface 'nothing'"),
        (["--interface", "socketcan", "--channel", "nowhere0"], "nowhere0' cannot be opened"),
        ([], "or name its bus with --interface and --channel"),
    ],
)
def test_what_cannot_be_watched_is_said(words: list[str], text: str, capsys: PRINTED) -> None:
    assert main(["monitor", str(PUMP), "--once", *words]) == UNUSABLE
    said = capsys.readouterr().err
    assert text in said and said.count("error: ") == 1


@pytest.mark.parametrize("command", ["monitor", "workbench", "run", "shell"])
def test_a_second_interface_is_refused_and_takes_the_place_of_none(
    command: str, capsys: PRINTED
) -> None:
    words = ["--interface", "virtual", "--channel", "one", "--interface", "virtual"]
    with pytest.raises(SystemExit) as ended:
        main([command, str(PUMP), *words])
    assert ended.value.code == UNUSABLE
    assert "--interface: is given twice" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["monitor", "workbench", "run", "shell"])
def test_a_second_channel_of_a_bus_is_refused(command: str, capsys: PRINTED) -> None:
    words = ["--interface", "virtual", "--channel", "one", "--channel", "two"]
    assert main([command, str(PUMP), *words]) == UNUSABLE
    assert "--channel two: ward has a channel already" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["monitor", "workbench"])
@pytest.mark.parametrize(
    ("model", "interface", "text"),
    [(PUMP, "nothing", "has no interface 'nothing'"), (ALONE, "virtual", "has no bus")],
)
def test_a_bus_that_there_cannot_be_ends_the_command_before_anything_starts(
    command: str,
    model: Path,
    interface: str,
    text: str,
    capsys: PRINTED,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(serving, "serve", lambda made, *words, **more: made())
    words = ["--interface", interface, "--channel", "x"]
    assert main([command, str(model), *words]) == UNUSABLE
    said = capsys.readouterr()
    assert text in said.err and "http://" not in said.out


@pytest.mark.parametrize(
    ("channels", "text"),
    [
        (["x"], "--channel x names no bus of Two_Buses: write chassis=CHANNEL or cabin=CHANNEL"),
        (["spare=x"], "--channel spare=x names no bus of Two_Buses"),
        (["cabin=x", "Cabin=y"], "--channel Cabin=y: cabin has a channel already"),
        (["cabin=x", "chassis=x"], "--channel chassis=x: chassis cannot have the channel of cabin"),
        (["cabin="], "--channel cabin=: cabin cannot have no channel"),
    ],
)
def test_of_several_buses_each_channel_names_one(
    channels: list[str], text: str, capsys: PRINTED
) -> None:
    words = [word for channel in channels for word in ("--channel", channel)]
    call = ["monitor", str(TWO_BUSES), "--interface", "virtual", *words, "--once"]
    assert main(call) == UNUSABLE
    assert text in capsys.readouterr().err


@pytest.mark.parametrize("swapped", [False, True])
def test_the_page_shows_the_buses_that_can_be_watched_and_names_the_others(swapped: bool) -> None:
    server = BusServer()
    channels = [f"chassis={server.channel}", "cabin=127.0.0.1:9"]
    buses = LiveBuses(("ravenchart", channels[::-1] if swapped else channels))
    buses.join(checking.check(TWO_BUSES, deadlines=False), runs=False, rings=False)
    assert [bus["bus"] for bus in buses.look()] == ["chassis"]
    assert "127.0.0.1:9" in buses.text
    buses.close()
    server.close()


def test_a_scenario_on_one_bus_says_what_is_on_the_other(tmp_path: Path, capsys: PRINTED) -> None:
    scenario = tmp_path / "scenario.yaml"
    scenario.write_text("scenario: x\nsteps:\n  - {send: pedal, with: {pressed: true}}\n")
    call = ["run", str(TWO_BUSES), "--scenario", str(scenario), "--interface", "virtual"]
    assert main([*call, "--channel", "cabin=x"]) == WRONG
    said = capsys.readouterr().err
    assert "`pedal` is on chassis, which has no channel" in said
    assert "hint: add `--channel chassis=...`" in said


def test_one_of_several_buses_is_watched_alone(capsys: PRINTED) -> None:
    call = ["monitor", str(TWO_BUSES), "--interface", "virtual", "--channel", "cabin=x", "--once"]
    assert main([*call, "--json"]) == OK
    result = json.loads(capsys.readouterr().out)["result"]
    assert [bus["bus"] for bus in result["buses"]] == ["cabin"]
    names = {message["name"] for message in result["buses"][0]["messages"]}
    assert {"spare_speed", "needle"} <= names and "pedal" not in names


def test_a_bus_that_goes_ends_the_monitor(
    channel: str, monkeypatch: pytest.MonkeyPatch, capsys: PRINTED
) -> None:
    def failing(interface: BusEnd) -> can.BusABC:
        bus = can.Bus(channel, "virtual")
        monkeypatch.setattr(bus, "recv", lambda timeout: 1 / 0)
        return bus

    monkeypatch.setattr(bus_watch, "opened_bus", failing)
    words = ["--interface", "virtual", "--channel", channel]
    assert main(["monitor", str(PUMP), *words]) == WRONG
    assert "nothing comes from virtual" in capsys.readouterr().err


def test_the_page_gets_the_bus_beside_the_controllers(channel: str, sender: can.BusABC) -> None:
    live = LiveView(PUMP, ("virtual", [channel]))
    digest = ANALYSIS.system.digest
    assert [one["bus"] for one in live.look(digest)["buses"]] == ["ward"]
    sender.send(WORDS.codec.encode("motor", {"value": 3}))
    within(lambda: live.look(digest)["buses"][0]["frames"])
    assert live.look(digest)["buses"][0]["frames"] == 1
    live.close()
    wrong = LiveView(PUMP, ("nothing", ["x"]))
    found = wrong.look(digest)
    assert found["buses"] == [] and "has no interface 'nothing'" in found["text"]


def test_the_page_watches_a_bus_again_that_was_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(live_buses, "PAUSE", 0.0)
    digest = ANALYSIS.system.digest
    server = BusServer()
    live = LiveView(PUMP, ("ravenchart", [server.channel]))
    assert live.look(digest)["buses"][0]["gone"] is None
    server.close()
    within(lambda: live.look(digest)["buses"][0]["gone"])
    gone = live.look(digest)
    assert gone["buses"][0]["gone"] and "cannot be opened" not in gone["text"]
    again = BusServer()
    live._buses._named = ("ravenchart", [again.channel])  # as if it were at the same port
    assert live.look(digest)["buses"][0]["gone"] is None
    live.close()
    again.close()


def test_in_a_pipe_a_bus_that_goes_is_told_once(
    watch: BusWatch, monkeypatch: pytest.MonkeyPatch, capsys: PRINTED
) -> None:
    monkeypatch.setattr(monitor, "SECOND", 1000.0)
    bus = watch.look()
    lines = monitor._Lines(SimpleNamespace(controllers=[], on_buses=[bus]))  # type: ignore[arg-type]
    lines.show()
    assert "gone: " not in capsys.readouterr().out
    bus.gone = "Network is down"
    for _ in range(3):
        lines.show()
    assert capsys.readouterr().out.count("gone: Network is down") == 1


@pytest.mark.slow
def test_what_others_send_to_others_is_known(channel: str, tmp_path: Path) -> None:
    text = PUMP.read_text(encoding="utf-8")
    model = tmp_path / "model.yaml"
    other = "messages:\n  other: {bus: ward, id: 0x300, bytes: 2, period: 10 ms}\n"
    model.write_text(text.replace("messages:\n", other))
    analysis = checking.check(model, deadlines=False).analysis
    watch = BusWatch(analysis, BusEnd("virtual", channel))
    with can.Bus(channel, "virtual") as sender:
        sender.send(can.Message(arbitration_id=0x300, is_extended_id=False, data=[1, 2]))
        found = looked(watch, lambda bus: bus.frames == 1)
    watch.close()
    assert (found.unknown, found.malformed) == (0, 0)
    assert [(one.name, one.frames) for one in found.messages if one.frames] == [("other", 1)]


def test_a_replay_has_no_bus(capsys: PRINTED) -> None:
    words = ["--replay", "trace.txt", "--interface", "virtual", "--channel", "x", "--no-open"]
    assert main(["workbench", str(PUMP), *words]) == UNUSABLE
    assert "leave --interface out" in capsys.readouterr().err


def test_an_interface_that_there_is_not_is_unusable() -> None:
    with pytest.raises(Unusable, match="socketcan"):
        BusWatch(ANALYSIS, BusEnd("socketcan", "nowhere0"))
