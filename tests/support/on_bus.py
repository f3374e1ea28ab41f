# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A feature model on a simulated bus, with a bench that does something."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable
from pathlib import Path

from ravenchart.analysis.system.observed import Observation, read_map, read_trace
from ravenchart.building import checking, generation, programs
from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.paths import ROOT
from ravenchart.running import server as bus
from ravenchart.running.process import ControllerProcess

Play = Callable[[RavenchartBus], None]
"""What the bench does."""


def runner(feature: str, folder: Path) -> Callable[[Play], Observation]:
    """A function that runs a copy of the feature below the folder; what was seen."""
    copy = folder / feature
    shutil.copytree(ROOT / "tests" / "feature" / feature, copy)
    checked = checking.check(copy / "model.yaml")
    generation.write_program(checked)
    program = programs.programs_of(checked)[0].build(driver="bus")

    def run(play: Play) -> Observation:
        trace = copy / "trace.txt"
        with bus.running("port=0", "bitrate=500000", "data_bitrate=2000000") as (_, channel):
            port = channel.rpartition(":")[2]
            names = {"RAVENCHART_BUS_PORT": port, "RAVENCHART_BUS_NAME": "board"}
            process = ControllerProcess(program, trace, 0, **names)
            try:
                process.wait_until_joined()
                with RavenchartBus(channel, fd=True) as bench:
                    play(bench)
                    time.sleep(0.2)
            finally:
                ended = process.stop(0.0)
        assert ended.exit_code == 0
        known = read_map((copy / "generated" / "trace.json").read_text())
        return read_trace(trace.read_text().splitlines(), known)

    return run
