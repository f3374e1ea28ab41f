# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The seam tracker on two cores: where its tasks run, and what its trace and report say."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from ravenchart.analysis.system.observed import Observation, read_map, read_trace
from ravenchart.building import checking, programs
from ravenchart.failures import Unusable
from ravenchart.paths import ROOT
from ravenchart.running.process import ControllerProcess, separate_cores

pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(
        not {0, 1} <= os.sched_getaffinity(0), reason="needs the processors 0 and 1 of the machine"
    ),
]

MODEL = ROOT / "examples" / "seam_tracker" / "model.yaml"


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, str], Observation]:
    """The processors that each thread may use, while it runs, and what the trace says then."""
    folder = tmp_path_factory.mktemp("seam_tracker")
    program = programs.programs_of(checking.check(MODEL))[0].build()
    with separate_cores(2) as cores:
        process = ControllerProcess(program, folder / "trace.txt", cores)
        process.wait_for_port()
        time.sleep(1.0)
        allowed = threads(Path(f"/proc/{process._process.pid}/task"))
        ended = process.stop(0.1)
    assert ended.exit_code == 0, ended.warnings
    lines = (folder / "trace.txt").read_text(encoding="utf-8").splitlines()
    trace_map = read_map((MODEL.parent / "generated" / "trace.json").read_text(encoding="utf-8"))
    return allowed, read_trace(lines, trace_map)


def threads(tasks: Path) -> dict[str, str]:
    found = {}
    for task in tasks.iterdir():
        lines = (task / "status").read_text(encoding="utf-8").splitlines()
        words = dict(line.split(":", 1) for line in lines if ":" in line)
        found[task.name] = words["Cpus_allowed_list"].strip()
    return found


def test_each_task_has_its_processor(run: tuple[dict[str, str], Observation]) -> None:
    """`vision` and the task that hands over on the second, all others on the first."""
    allowed, _ = run
    assert sorted(allowed.values()).count("1") == 2
    assert set(allowed.values()) == {"0", "1"}


def test_both_cores_are_in_the_report(run: tuple[dict[str, str], Observation]) -> None:
    _, seen = run
    assert seen.complete
    assert seen.trace_lost == seen.values_lost == 0
    for name in ("motion", "vision"):
        counts = seen.processors[name]
        assert counts.releases > 20
        assert counts.now is not None
    assert seen.processors["vision"].now != seen.processors["motion"].now
    records = [record.time for record in seen.records]
    assert records == sorted(records)
    begun = {record.element.name for record in seen.records if record.kind == "activity"}
    assert {"slide.ports", "eye.ports"} <= begun
    assert {record.element.name for record in seen.values} == set()


def test_a_machine_with_too_few_processors_is_told() -> None:
    with pytest.raises(Unusable, match="tasks on 4096 cores"), separate_cores(4096):
        pass
