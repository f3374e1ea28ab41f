# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""CAN FD between two programs on one bus, and with a bench: what is good arrives, nothing else."""

from __future__ import annotations

import shutil
import subprocess
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

import can
import pytest

from ravenchart.analysis.system.observed import Observation, read_map, read_trace
from ravenchart.building import checking, generation, programs
from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.hw_can.bench.peer import BenchError, Codec
from ravenchart.paths import ROOT
from ravenchart.running import server as bus
from ravenchart.running.controllers import controller
from ravenchart.running.process import ControllerProcess
from ravenchart.running.runs import run_controller, run_nodes

pytestmark = pytest.mark.alone

TUNING: dict[str, int | str] = {
    "gain": 4711,
    "lower": -32000,
    "upper": 32000,
    "limit": 30000,
    "soft": "True",
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the model."""
    copy: Path = tmp_path / "tactile"
    shutil.copytree(ROOT / "tests" / "nodes" / "tactile", copy)
    return copy


@pytest.mark.slow
def test_frames_of_both_formats_go_between_nodes_and_from_the_bench(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    real = bus.running

    def running(
        *words: str, log: Path | None, beside: Path, bus: str
    ) -> AbstractContextManager[tuple[subprocess.Popen[str], str]]:
        told.extend(words)
        return real(*words, log=log, beside=beside, bus=bus)

    monkeypatch.setattr(bus, "running", running)
    checked = checking.check(folder / "model.yaml")
    assert not checked.warnings
    assert {m.name: (m.fd, m.length) for m in checked.system.messages} == {
        "skin_1_forces": (True, 48),
        "grip_1_order": (False, 1),
        "tuning": (True, 12),
    }
    generation.write_program(checked)
    outcome = run_nodes(
        tuple(controller(made) for made in programs.programs_of(checked)),
        checked.analysis,
        folder / "generated",
        folder / "scenario.yaml",
        0.0,
        folder / "report",
    )
    assert {"bitrate=500000", "data_bitrate=4000000"} <= set(told)
    #  how long a response takes is for runs on a machine of their own to say
    assert [(step.text, step.outcome) for step in outcome.steps if not step.passed] == []
    assert (outcome.ended.exit_code, outcome.ended.killed) == (0, False)
    assert outcome.observation is not None
    assert [r.text for r in outcome.observation.of("transition", "grip_1.Plan")] == [
        "felt", "tuned",
    ]  # fmt: skip
    assert [r.text for r in outcome.observation.of("transition", "skin_1.Life")] == ["tared"]


def test_a_rate_that_the_simulated_bus_cannot_have_is_told(folder: Path) -> None:
    model = folder / "model.yaml"
    model.write_text(model.read_text().replace("data_rate: 4 Mbit/s", "data_rate: 3 Mbit/s"))
    checked = checking.check(model)
    generation.write_program(checked)
    generated = folder / "generated"
    with pytest.raises(BenchError, match="link: a bit at 3000000 bit/s is no whole number of ns"):
        run_nodes((), checked.analysis, generated, None, 1.0, folder / "report")


def changed(frame: can.Message, **fields: object) -> can.Message:
    """The frame with other fields."""
    made = can.Message(
        arbitration_id=frame.arbitration_id,
        is_extended_id=frame.is_extended_id,
        is_fd=frame.is_fd,
        bitrate_switch=frame.bitrate_switch,
        data=frame.data,
    )
    for name, value in fields.items():
        setattr(made, name, value)
    made.dlc = len(made.data)
    return made


BAD: dict[str, Callable[[can.Message], can.Message]] = {
    "a classic frame": lambda good: changed(
        good, is_fd=False, bitrate_switch=False, data=good.data[:8]
    ),
    "a remote frame": lambda good: can.Message(
        arbitration_id=good.arbitration_id, is_extended_id=False, is_remote_frame=True, dlc=8
    ),
    "too short": lambda good: changed(good, data=good.data[:8]),
    "too long": lambda good: changed(good, data=good.data + bytes(4)),
    "another format": lambda good: changed(good, is_extended_id=True),
    "another identifier": lambda good: changed(good, arbitration_id=0x201),
    #  the gain has bits 0 .. 16, which count beyond its 100,000
    "a raw value out of range": lambda good: changed(
        good, data=good.data[:1] + bytes([0xFF, good.data[2] | 1]) + good.data[3:]
    ),
}


@pytest.fixture
def palm(folder: Path) -> Callable[[Callable[[RavenchartBus, Codec], None]], Observation]:
    """Runs one node on a bus with a bench that does something; what was seen."""
    checked = checking.check(folder / "model.yaml")
    generation.write_program(checked)
    (made,) = (p for p in programs.programs_of(checked) if p.node == "palm")
    program = controller(made)
    codec = Codec.from_file(folder / "generated" / "link.dbc")

    def run(play: Callable[[RavenchartBus, Codec], None]) -> Observation:
        trace = folder / "trace.txt"
        words = ("port=0", "bitrate=500000", "data_bitrate=4000000")
        with bus.running(*words) as (_, channel):
            port = channel.rpartition(":")[2]
            process = ControllerProcess(
                program.executable, trace, 0, RAVENCHART_BUS_PORT=port, RAVENCHART_BUS_NAME="palm"
            )
            try:
                process.wait_until_joined()
                with RavenchartBus(channel, fd=True) as bench:
                    play(bench, codec)
                    time.sleep(0.3)
            finally:
                ended = process.stop(0.0)
        assert ended.exit_code == 0
        names = read_map(program.trace_json.read_text())
        return read_trace(trace.read_text().splitlines(), names)

    return run


@pytest.mark.slow
def test_bad_frames_are_not_delivered(
    palm: Callable[[Callable[[RavenchartBus, Codec], None]], Observation],
) -> None:
    def play(bench: RavenchartBus, codec: Codec) -> None:
        good = codec.encode("tuning", TUNING)
        assert (good.is_fd, good.bitrate_switch, len(good.data)) == (True, True, 12)
        for spoil in BAD.values():
            bench.send(spoil(good), timeout=5)
        #  in order, so all that was sent before has been looked at when this one arrives
        bench.send(changed(good, bitrate_switch=False), timeout=5)

    seen = palm(play)
    assert len(list(seen.of("arrived", "tuning"))) == 1


@pytest.mark.slow
def test_one_node_exchanges_both_formats_with_a_bench(tmp_path: Path) -> None:
    copy = tmp_path / "flexible"
    shutil.copytree(ROOT / "tests" / "feature" / "flexible", copy)
    checked = checking.check(copy / "model.yaml")
    generation.write_program(checked)
    (program,) = (controller(made) for made in programs.programs_of(checked))
    scenario = copy / "scenario.yaml"
    angles = ", ".join(f"joint_{n}: {n - 12_000_000}" for n in range(1, 20))
    scenario.write_text(
        f"""
scenario: Both formats
steps:
  - {{send: gear_in, with: {{gear: Backward, load: 90}}}}
  - {{send: posture_in, with: {{{angles}, joint_20: 12000000}}}}
  - {{wait_for: gear_out.gear, is: Backward, within: 2 s}}
  - {{wait_for: gear_plain.load, is: 90, within: 2 s}}
  - {{wait_for: posture_out.joint_20, is: 12000000, within: 2 s}}
  - {{wait_for: posture_out.joint_7, is: -11999993, within: 2 s}}
"""
    )
    outcome = run_controller(
        program.executable,
        program.trace_json,
        copy / "generated" / "line.dbc",
        scenario,
        None,
        copy / "report",
    )
    assert [(step.text, step.outcome) for step in outcome.steps if not step.passed] == []
