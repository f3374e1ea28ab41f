# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Tables searched with the workers of a Dask scheduler: the same answer, and clear faults."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from distributed import Client, LocalCluster

from ravenchart.allocation import helpers, search
from ravenchart.allocation.proposals import propose, yaml
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.command_line import main
from ravenchart.failures import OK, UNUSABLE, Unusable
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from ravenchart.workbench import room
from tests.support.workbench import PATIENCE, running, until

PUMP = ROOT / "examples" / "pump" / "model.yaml"


@pytest.fixture(scope="module")
def pump() -> Analysis:
    system = load(PUMP).system
    assert system is not None
    return analyse(system)


@pytest.fixture(scope="module")
def cluster() -> Iterator[LocalCluster]:
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as made:
        yield made


@pytest.mark.slow
@pytest.mark.parametrize("strategy", ["fewest", "slack"])
def test_workers_find_the_same_tables(
    pump: Analysis, cluster: LocalCluster, strategy: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(search, "TRIALS", 600)
    here = propose(pump, strategy)
    with helpers.scheduled(cluster.scheduler_address) as there:
        assert yaml(propose(pump, strategy, helpers=there)) == yaml(here)


@pytest.mark.slow
@pytest.mark.clock
def test_the_workbench_searches_with_them_and_finds_the_same(cluster: LocalCluster) -> None:
    before = _tasks(cluster)
    here, there = _best(), _best("--scheduler", cluster.scheduler_address)
    assert here["met"] and there == here
    assert _tasks(cluster) > before


def _best(*words: str) -> dict[str, Any]:
    """The tables that a search in the workbench finds."""
    with running(PUMP, *words) as bench:
        page = bench.stream()
        bench.act(kind="search", strategy="fewest")
        state = until(page, 0)
        while not (state["search"] and not state["search"]["running"]):
            state = page.get(timeout=PATIENCE)
        assert state["search"]["fault"] is None
        found: dict[str, Any] = state["search"]["best"]
        return found


def _tasks(cluster: LocalCluster) -> int:
    """How many events of tasks the workers of a cluster have noted."""
    with Client(cluster.scheduler_address) as client:
        noted = client.run(lambda dask_worker: len(dask_worker.state.log))
        return sum(noted.values())


@pytest.mark.slow
def test_a_worker_of_another_version_is_refused(
    cluster: LocalCluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(helpers, "version", lambda: "99.1")
    refused = pytest.raises(Unusable, match=r"the Dask worker .* has Ravenchart 0.*; it needs 99.1")
    with refused, helpers.scheduled(cluster.scheduler_address):
        pass


@pytest.mark.slow
def test_a_scheduler_that_goes_is_named(pump: Analysis) -> None:
    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0") as made:
        address = made.scheduler_address
        refused = pytest.raises(Unusable, match=r"the Dask scheduler at .* was lost")
        with refused, helpers.scheduled(address) as there:
            propose(pump, "slack", lambda _: made.close(), there)


@pytest.mark.slow
def test_a_scheduler_without_workers_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helpers, "PATIENCE", 1)
    with LocalCluster(n_workers=0, dashboard_address=":0") as made:
        refused = pytest.raises(Unusable, match="has no worker")
        with refused, helpers.scheduled(made.scheduler_address):
            pass


def test_where_nobody_answers_the_command_and_the_workbench_say_so(
    pump: Analysis, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(helpers, "PATIENCE", 1)
    words = ["allocate", str(PUMP), "--strategy", "slack", "--scheduler", "tcp://127.0.0.1:1"]
    assert main(words) == UNUSABLE
    assert "no Dask scheduler answers at tcp://127.0.0.1:1" in capsys.readouterr().err
    question = {"strategy": "slack", "scheduler": "tcp://127.0.0.1:1"}
    told = room.allocated(pump, None, question, lambda _: None)  # type: ignore[arg-type]
    assert "no Dask scheduler answers" in told["fault"]


def test_without_dask_the_command_names_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    words = ["allocate", str(PUMP), "--strategy", "slack", "--scheduler", "tcp://127.0.0.1:1"]
    assert main(words) == UNUSABLE
    assert "`--scheduler` needs Dask: python -m pip install distributed" in capsys.readouterr().err
    assert main(words[:-2]) == OK
