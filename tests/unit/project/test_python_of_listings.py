# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Python of the docs is executed, on a bus within this process where the page has a real one."""

from __future__ import annotations

import ast
import asyncio
import inspect
import subprocess
import sys
import threading
import time
from collections.abc import Awaitable, Mapping
from contextlib import closing
from pathlib import Path
from typing import Any

import can
import canopen
import pytest

from ravenchart.analysis.system.observed import read_map
from ravenchart.evidence.results import junit
from ravenchart.hw_can.bench.peer import FrameValues
from ravenchart.paths import ROOT
from ravenchart.running.remote import connect
from tests.support.bus_server import BusServer
from tests.support.far_end import LIMIT, ROBOT, Answer, FarEnd, robot
from tests.support.listings import Listing, listings, one_of
from tests.support.snapshot_files import held, snapshot

pytestmark = pytest.mark.clock

BUS = one_of("docs/bus-protocol.md", "can.Bus", "python")
COMMAND = one_of("docs/shell.md", "wait_for(", "python")
CHART = one_of("docs/shell.md", "await", "python")
MASTER = one_of("examples/canopen_device/README.md", "import canopen", "python")
STACK = one_of("examples/j1939_node/README.md", "import j1939", "python")
TESTED = one_of("docs/evidence.md", "record_property", "python")
PLANT = one_of("docs/plants.md", "class Oven", "python")


def test_each_listing_in_python_is_executed() -> None:
    python = {one for one in listings() if one.language == "python"}
    assert {BUS, COMMAND, CHART, MASTER, STACK, TESTED, PLANT} == python


def executed(program: Listing, instead: Mapping[str, str], **names: object) -> dict[str, Any]:
    """The names of an executed listing, which has other addresses and files ``instead``."""
    text = program.text
    for old, new in instead.items():
        assert old in text
        text = text.replace(old, new)
    waiting = eval(compile(text, program.page, "exec", ast.PyCF_ALLOW_TOP_LEVEL_AWAIT), names)
    if inspect.isawaitable(waiting):
        asyncio.run(done(waiting))
    return names


async def done(waiting: Awaitable[object]) -> None:
    """The end of a listing with `await`."""
    await waiting


def test_the_page_of_the_bus_opens_a_bus(server: BusServer) -> None:
    address = {"127.0.0.1:29536": server.channel}
    with executed(BUS, address, can=can)["bus"] as bus:
        bus.send(can.Message(arbitration_id=1, data=b"x" * 64, is_fd=True), timeout=5)


MOVES = {'"model.yaml"': repr(str(ROBOT / "model.yaml"))}


def test_the_page_of_the_shell_sends_a_command_and_waits_for_the_answer(
    far: FarEnd, request: pytest.FixtureRequest, capsys: pytest.CaptureFixture[str]
) -> None:
    bus = {"socketcan": "virtual", "can0": request.node.name}
    executed(COMMAND, MOVES | bus)
    assert capsys.readouterr().out == "{'condition': 'Ready', 'x': 300000, 'y': 0}\n"
    assert far.hears("robot_command") == {"kind": "Move", "x": 300_000, "y": 0, "z": 0}


def test_the_page_of_the_shell_waits_for_the_state_of_a_chart(
    request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    """Another process has the file of the controller. It is written here, again at a command."""
    file, start = tmp_path / "live", time.monotonic_ns()
    known = read_map((ROBOT / "generated" / "trace.json").read_text(encoding="utf-8"))
    region = known.named("coordinator.Mission", "region")

    def says(number: int, state: str) -> None:
        lines = (f"N {time.monotonic_ns() - start}", "L trace 0")
        chart = f"C STATE {region.number} 1 0 {region.leaves.index(state)}"
        text = snapshot(number, *lines, chart, digest=known.digest, start=start)
        file.write_text(text, encoding="utf-8")

    def answer(name: str, values: FrameValues) -> list[Answer]:
        says(2, "Ready")
        return []

    says(1, "Waiting")
    bus = {'"ravenchart"': '"virtual"', "127.0.0.1:29536": request.node.name}
    live = {"/run/robot.live": str(file)}
    with (
        closing(FarEnd(can.Bus(request.node.name, "virtual"), robot(), answer)) as far,
        held(file),
    ):
        executed(CHART, MOVES | bus | live, connect=connect)
        assert far.hears("robot_command") == {"kind": "Move", "x": 300_000, "y": 0, "z": 0}


def virtual(channel: str) -> dict[str, str]:
    """A bus of python-can in place of the bus server of an example."""
    return {
        'interface="ravenchart", channel="127.0.0.1:29536"':
            f'interface="virtual", channel="{channel}"',
    }  # fmt: skip


def test_the_master_of_its_page_commands_a_canopen_device(
    request: pytest.FixtureRequest, capsys: pytest.CaptureFixture[str]
) -> None:
    """Here the device is one of the package `canopen`, made from the same data sheet."""
    channel = request.node.name
    sheet = {"examples/canopen_device/device.eds": str(ROOT / "examples/canopen_device/device.eds")}
    with canopen.Network() as network:
        network.connect(interface="virtual", channel=channel)
        device = network.create_node(5, *sheet.values())
        came = threading.Event()

        def measure(*_: object) -> None:
            device.tpdo[1]["Temperature"].raw = 215
            device.tpdo[1].transmit()

        device.nmt.state = "PRE-OPERATIONAL"
        device.nmt.start_heartbeat(20)
        device.tpdo.read()
        device.rpdo.read()
        device.rpdo[1].add_callback(lambda _: came.set())
        network.subscribe(0x80, measure)
        names = executed(MASTER, virtual(channel) | sheet)
        assert came.wait(LIMIT)
        names["network"].disconnect()
        device.nmt.stop_heartbeat()
        assert device.nmt.state == "OPERATIONAL"
        assert device.sdo["Setpoint"].raw == 300
        assert device.sdo["Producer heartbeat time"].raw == 100
        assert device.rpdo[1]["Setpoint"].raw == 250
    assert capsys.readouterr().out == "215\n"


def test_the_stack_of_its_page_talks_to_a_j1939_node(request: pytest.FixtureRequest) -> None:
    """Here no node answers: the frames are seen."""
    channel = request.node.name
    with can.Bus(interface="virtual", channel=channel) as witness:
        names = executed(STACK, virtual(channel))
        seen = [
            (one.arbitration_id, bytes(one.data)) for one in iter(lambda: witness.recv(0), None)
        ]
        names["unit"].stop()
        names["unit"].disconnect()
    assert {0x18EEFF00, 0x18EEFFF9} <= {identifier for identifier, _ in seen}  # claimed addresses
    assert seen[-2:] == [
        (0x18FEEE00, bytes([130, *[255] * 7])),
        (0x18EA80F9, bytes([0xBD, 0xFE, 0])),
    ]


def test_the_page_about_evidence_names_the_requirement_of_a_test(tmp_path: Path) -> None:
    (tmp_path / "test_pump.py").write_text(TESTED.text, encoding="utf-8")
    (tmp_path / "pytest.ini").write_text("[pytest]\njunit_family = xunit1\n")
    words = [sys.executable, "-m", "pytest", "-q", "--junit-xml=results.xml"]
    subprocess.run(words, cwd=tmp_path, check=True, capture_output=True)
    (one,) = junit(tmp_path / "results.xml")
    assert (one.outcome, one.requirements) == ("passed", ("R-7",))


def test_the_oven_of_its_page_is_heated_and_cools_faster_with_an_open_door() -> None:
    oven = executed(PLANT, {})["Oven"]({"capacity": 20})

    def after(seconds: int) -> float:
        start = oven.time
        for cycle in range(200 * seconds):  # of the bench
            oven.advance(start + (cycle + 1) / 200)
        return float(oven.value("temperature"))

    oven.take("heater", "Hot")
    hot = after(2)
    assert 150 < hot < 200 and oven.value("energy") == pytest.approx(4_000)
    oven.take("heater", "Cold")
    warm = after(1)
    oven.take("door", 1)
    assert 0.7 * hot < warm < hot and after(1) < 0.5 * warm
