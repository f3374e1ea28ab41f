# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Logs of a run and of the bus server: what cannot be written, and what is read back."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import can
import cantools
import pytest

from ravenchart.command_line import main
from ravenchart.failures import Unusable
from ravenchart.hw_can.bench.bus_records import (
    MARK,
    VERSION,
    BusRecord,
    Greeting,
    RecordKind,
    encode,
    greeting_data,
)
from ravenchart.hw_can.bench.peer import Codec
from ravenchart.running import bus_log
from ravenchart.running.runs import run_controller
from tests.support.bench_files import scenario_text, write_files
from tests.support.processes import ROOT

STEPS = """\
  - {send: robot_command, with: {kind: Home, x: 0}}
  - {wait_for: robot_status.condition, is: Ready, within: 4 s}
"""


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".blf", ".asc", ".log"])
def test_a_run_writes_its_log_and_others_read_it(tmp_path: Path, suffix: str) -> None:
    """All that bench and controller sent, in the order of time, with the values of the run."""
    files, log = write_files(tmp_path, scenario_text(STEPS)), tmp_path / f"run{suffix}"
    result = run_controller(
        files.executable, files.trace_json, files.dbc, files.scenario, 20.0, files.out,
        analysis=files.analysis, log=log,
    )  # fmt: skip
    assert result.failures == () and result.scenario_result is not None
    with can.LogReader(log) as reader:
        frames = list(reader)
    times = [frame.timestamp for frame in frames]
    assert times == sorted(times)
    codec, bench = Codec.from_file(files.dbc), result.scenario_result
    named = [codec.decode(frame) for frame in frames]
    for name, count in {**bench.sent, **bench.received}.items():
        assert sum(one is not None and one[0] == name for one in named) >= count > 0
    assert [one[1]["kind"] for one in named if one and one[0] == "robot_command"] == ["Home"]
    assert "Ready" in [one[1]["condition"] for one in named if one and one[0] == "robot_status"]
    if suffix == ".log":
        told = subprocess.run(
            [sys.executable, "-m", "cantools", "decode", files.dbc],
            stdin=log.open(), capture_output=True, text=True, timeout=60,
        )  # fmt: skip
        assert "robot_command" in told.stdout and "Home" in told.stdout
        assert isinstance(cantools.database.load_file(files.dbc), cantools.database.Database)


@pytest.mark.parametrize("command", [["bus"], ["run", "model.yaml"]])
def test_a_log_of_no_known_format_is_refused(
    command: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as over:
        main([*command, "--log", "bus.txt2"])
    assert over.value.code == 2
    assert "'bus.txt2' has no suffix of .asc, .blf" in capsys.readouterr().err


def test_a_log_in_a_folder_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="No such file"), bus_log.written(tmp_path / "no" / "a.blf"):
        pass


def test_a_format_whose_package_is_missing_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "asammdf", None)

    def missing(*_words: object) -> None:
        raise NotImplementedError("the package asammdf is missing")

    monkeypatch.setattr(can, "Logger", missing)
    refused = pytest.raises(Unusable, match=r"bus\.mf4 cannot be written: the package asammdf")
    with refused, bus_log.written(tmp_path / "bus.mf4"):
        pass


class Full:
    """A log on a disk that is full after two frames."""

    def __init__(self) -> None:
        self.frames = 0

    def __enter__(self) -> Full:
        return self

    def __exit__(self, *_words: object) -> None:
        """Nothing is left open."""

    def on_message_received(self, _frame: can.Message) -> None:
        self.frames += 1
        if self.frames > 2:
            raise OSError("No space left on device")


def test_a_bus_does_not_wait_for_a_log_that_is_full(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """More records than a pipe holds: the server would be blocked."""
    full = Full()
    monkeypatch.setattr(can, "Logger", lambda _path: full)
    hello = BusRecord(
        RecordKind.WELCOME,
        length=4,
        code=VERSION,
        identifier=MARK,
        number=255,
        data=greeting_data(Greeting("can0")),
    )
    with bus_log.written(Path("bus.blf")) as descriptor:
        os.write(descriptor, encode(hello))
        for number in range(2_000):
            os.write(descriptor, encode(BusRecord(RecordKind.FRAME, time=number)))
    assert full.frames == 3
    said = capsys.readouterr().err
    assert said == "ravenchart: error: the log ends: No space left on device\n"


def test_one_node_without_a_scenario_has_no_log(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Nobody is on its bus: that is said at once, instead of an empty file."""
    model = ROOT / "examples" / "cartesian_robot" / "model.yaml"
    log = tmp_path / "run.blf"
    assert main(["run", str(model), "--log", str(log)]) == 2
    assert "no log of Cartesian_Robot: without a scenario" in capsys.readouterr().err
    assert not log.exists()
