# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""However the command line ends, nothing that it has started goes on."""

from __future__ import annotations

import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from ravenchart.building.checking import check
from ravenchart.building.generation import write_program
from ravenchart.building.programs import programs_of
from ravenchart.running import server
from ravenchart.running.controllers import controller
from tests.support.faults import shows
from tests.support.processes import LAUNCHER, PYTHON, ROOT, Marked

pytestmark = pytest.mark.live

TWO_NODES = ROOT / "examples" / "two_nodes" / "model.yaml"
LIMIT = 2.0
"""So long anything may go on, in s."""


@pytest.fixture(scope="module")
def programs() -> set[str]:
    """The controllers and the bus server, built, by the names of their processes."""
    checked = check(TWO_NODES)
    write_program(checked)
    built = [controller(made).executable.name for made in programs_of(checked)]
    return {name[:15] for name in (*built, server.built().name)}


@contextmanager
def started(*words: str | Path) -> Iterator[Marked]:
    """A command, and at the end nothing of it."""
    one = Marked([LAUNCHER, *words])
    try:
        yield one
    finally:
        one.kill()
        one.process.communicate()


@pytest.mark.slow
@shows(
    "`run` is ended by TERM or KILL",
    found_by="a guard process",
    reaction="controllers and bus server are ended",
)
@pytest.mark.parametrize(
    ("number", "status"),
    [(signal.SIGKILL, -9), (signal.SIGTERM, 143), (signal.SIGINT, 130), (signal.SIGHUP, 129)],
)
def test_a_run_that_is_ended_ends_its_controllers_and_its_bus(
    programs: set[str], tmp_path: Path, number: signal.Signals, status: int
) -> None:
    with started("run", TWO_NODES, "--seconds", "60", "--report", tmp_path) as run:
        assert run.runs(programs, 60.0), run.alive()
        run.process.send_signal(number)
        assert run.process.wait(LIMIT + 3.0) == status
        assert run.gone(LIMIT), run.alive()
        assert "Traceback" not in run.process.communicate()[1]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGKILL, -9), (signal.SIGTERM, 143), (signal.SIGINT, 130)]
)
def test_a_bus_that_is_ended_ends_its_server(
    programs: set[str], number: signal.Signals, status: int
) -> None:
    with started("bus", "--port", "0") as run:
        assert run.runs({"can_bus"}, 30.0), run.alive()
        run.process.send_signal(number)
        assert run.process.wait(LIMIT) == status
        assert run.gone(LIMIT), run.alive()
        assert "Traceback" not in run.process.communicate()[1]


PARENT = """
import sys, time
from ravenchart.tools import children
child = children.popen(["sh", "-c", "sleep 61 & setsid -w sleep 62 & trap '' TERM; sleep 63"])
time.sleep(60)
"""


def test_children_of_children_end_with_a_killed_parent() -> None:
    parent = Marked([PYTHON, "-P", "-c", PARENT])
    try:
        assert parent.runs({"sh", "sleep"}, 10.0)
        time.sleep(0.2)
        parent.process.kill()
        assert parent.gone(LIMIT), parent.alive()
    finally:
        parent.kill()
        parent.process.communicate()


WORKERS = """
import time
from ravenchart.gen.parallel import made_by_all
from ravenchart.tools import children
made_by_all(lambda number: time.sleep(60), 4, lambda: time.sleep(60))
"""


def test_workers_end_with_a_killed_parent() -> None:
    parent = Marked([PYTHON, "-P", "-c", WORKERS])
    try:
        end = time.monotonic() + 10.0
        while len(parent.alive()) < 4 and time.monotonic() < end:
            time.sleep(0.02)
        assert len(parent.alive()) >= 4  # itself, its guard and two workers
        parent.process.kill()
        assert parent.gone(LIMIT), parent.alive()
    finally:
        parent.kill()
        parent.process.communicate()


SWALLOWED = """
import os, signal, time
from ravenchart import start

class Deaf:
    def __del__(self):  # what is raised here goes no further
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0)

def command(arguments):
    Deaf()
    time.sleep(10)
    return 0

start._command = command
raise SystemExit(start.main())
"""


def test_an_interrupt_that_a_callback_swallows_is_not_lost() -> None:
    begun = time.monotonic()
    ended = subprocess.run(
        [PYTHON, "-P", "-c", SWALLOWED], text=True, capture_output=True, timeout=20
    )
    assert (ended.returncode, ended.stderr) == (130, "ravenchart: interrupted\n")
    assert time.monotonic() - begun < 5


@pytest.mark.slow
def test_an_interrupt_at_any_time_of_the_start_prints_no_traceback() -> None:
    for step in range(24):
        process = subprocess.Popen(
            [LAUNCHER, "check", TWO_NODES], text=True, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )  # fmt: skip
        time.sleep(0.005 + step * 0.03)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
        assert "Traceback" not in errors, (step, errors)
        assert process.returncode in (130, 0, -2), (step, process.returncode)
