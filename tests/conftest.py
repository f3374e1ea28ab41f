# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How all tests run: side by side in workers, with a compiler that has a store."""

from __future__ import annotations

import os
import shutil
import sys
import sysconfig
import time
from collections.abc import Iterator
from importlib.util import cache_from_source
from pathlib import Path

import pytest
from xdist.workermanage import WorkerController

from ravenchart.paths import work
from tests.support import again, compiler, live, scheduling
from tests.support.effort import ALL

AGAIN = "RAVENCHART_TESTS_AGAIN"
"""A file: where only tests that depend on the clock failed, it names them for a second run."""
QUIET = 0.2
"""Seconds in which a worker that has nothing to do any more is watched."""


def pytest_configure(config: pytest.Config) -> None:
    """Once, before the workers start."""
    if not hasattr(config, "workerinput"):
        if config.args_source is pytest.Config.ArgsSource.ARGS:
            os.environ[ALL] = "1"  # the workers inherit it
        _keep_bytecode()
        compiler.use()
        if named := os.environ.pop(AGAIN, None):  # no worker, and no pytest of a test, has it
            config.pluginmanager.register(again.Again(Path(named)))


def pytest_unconfigure(config: pytest.Config) -> None:
    """At the end of all."""
    if not hasattr(config, "workerinput"):
        _alone().unlink(missing_ok=True)


def _alone() -> Path:
    """A file for the names of the tests that run alone, of this controller."""
    return work() / "build" / f"alone-{os.getpid()}"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """`make test` leaves slow tests out, and says so."""
    if ALL not in os.environ:
        for item in items:
            if item.get_closest_marker("slow") is not None:
                item.add_marker(pytest.mark.skip(reason="slow: `make test-all` runs it"))


@pytest.fixture(scope="session", autouse=True)
def _nothing_goes_on() -> Iterator[None]:
    """After the last test no thread of a test is busy: it would slow all that come after it."""
    yield
    before = time.process_time()
    time.sleep(QUIET)
    used = time.process_time() - before
    assert used < QUIET / 4, (
        f"a thread of a test goes on: {used:.2f} s of the processor in {QUIET} s"
    )


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """A live test runs while no other does."""
    if item.get_closest_marker("live") is None:
        return (yield)
    with live.alone():
        return (yield)


def _keep_bytecode() -> None:
    """Compiled Python stays below build/, whatever the environment says.

    Hundreds of programs start in the tests; without it, each start takes four seconds. What pip
    has compiled of other packages is taken over.
    """
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    sys.dont_write_bytecode = False
    sys.pycache_prefix = os.environ["PYTHONPYCACHEPREFIX"] = str(work() / "build" / "python")
    packages = Path(sysconfig.get_path("purelib"))
    if Path(cache_from_source(packages / "any.py")).parent.exists():
        return
    for made in packages.rglob(f"__pycache__/*.{sys.implementation.cache_tag}.pyc"):
        source = made.parent.parent / f"{made.name.partition('.')[0]}.py"
        place = Path(cache_from_source(source))
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(made, place)


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """One more than processors, for many tests wait."""
    return len(os.sched_getaffinity(0)) + 1


def pytest_configure_node(node: WorkerController) -> None:
    """Where a worker writes which tests run alone."""
    node.workerinput["alone"] = str(_alone())


@pytest.hookimpl(tryfirst=True)
def pytest_collection_finish(session: pytest.Session) -> None:
    """Before a worker says what it has collected, it says which tests run alone."""
    given = getattr(session.config, "workerinput", None)
    if given is not None:
        scheduling.say(session.items, Path(given["alone"]))


def pytest_xdist_make_scheduler(config: pytest.Config) -> scheduling.AloneLast:
    """Tests that run alone come last."""
    return scheduling.AloneLast(config, _alone())
