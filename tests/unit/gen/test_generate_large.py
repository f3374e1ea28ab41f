# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Each further region of a large model costs the same work: it grows with the model alone."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from cProfile import Profile
from multiprocessing.context import BaseContext
from pathlib import Path
from pstats import Stats

import pytest

from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.program import _without_claims, generate
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.pipeline import load
from tests.bench.large_models import large_model


def _calls(components: int, regions: int) -> int:
    """How many calls a model takes from its text to the text of its program."""
    model = large_model(components, regions).encode()
    ada_case.cache_clear()
    with Profile() as profile:
        loaded = load(Path("model.yaml"), lambda path, limit: model)
        assert loaded.system is not None
        generate(loaded.system, Claims())
    calls: int = Stats(profile).total_calls  # type: ignore[attr-defined]
    return calls


@pytest.mark.slow
def test_each_further_component_takes_as_many_calls() -> None:
    _calls(1, 1)  # what is made once and kept
    few, some, many = (_calls(components, 1) for components in (4, 12, 20))
    assert many - some <= 1.002 * (some - few)


@pytest.mark.slow
def test_each_further_region_of_a_component_takes_as_many_calls() -> None:
    _calls(1, 1)
    few, some, many = (_calls(1, regions) for regions in (4, 12, 20))
    # every region looks for its events and data among all those of the component
    assert many - some <= 1.025 * (some - few)


def test_many_processes_make_the_same_as_one(monkeypatch: pytest.MonkeyPatch) -> None:
    model = large_model(4, 2).encode()
    system = load(Path("model.yaml"), lambda path, limit: model).system
    assert system is not None
    alone = generate(system, Claims())
    started: list[int] = []

    def counted(mp_context: BaseContext, initializer: Callable[[], None]) -> ProcessPoolExecutor:
        started.append(1)
        return ProcessPoolExecutor(mp_context=mp_context, initializer=initializer)

    monkeypatch.setattr("ravenchart.gen.emit.program.MANY", 8)
    monkeypatch.setattr("concurrent.futures.ProcessPoolExecutor", counted)
    _without_claims.cache_clear()
    assert generate(system, Claims()) == alone
    assert started
