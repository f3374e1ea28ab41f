# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Published systems have the published figures; where not, the reason is stated and checked."""

from __future__ import annotations

from dataclasses import replace
from decimal import Decimal

import pytest

from ravenchart.paths import ROOT
from tests.support.published import FOLDER, NAMES, complaints, published, summary, table

PAGE = ROOT / "docs" / "published-systems.md"


@pytest.mark.parametrize("name", NAMES)
def test_each_published_figure_is_ours_or_the_reason_is_checked(name: str) -> None:
    assert list(complaints(published(name))) == []


@pytest.mark.parametrize("name", NAMES)
def test_a_figure_stands_for_each_step(name: str) -> None:
    system = published(name)
    for step in system.network.items():
        assert any(step in figures.responses for figures in system.figures), step
    text = (FOLDER / f"{name}.csv").read_text(encoding="utf-8")
    assert "# Source: " in text and all(figures.source for figures in system.figures)


def test_the_case_of_several_processors_and_networks_has_that_many() -> None:
    network = published("wpdrts_1995").network
    cores = {task.core for task in network.tasks}
    assert len([core for core in cores if core.startswith("cpu_")]) == 8
    assert len([core for core in cores if core.startswith("net_")]) == 3
    assert len(network.tasks) == 93


def test_a_wrong_figure_is_found() -> None:
    system = published("np_example1")
    (figures,) = system.figures
    wrong = replace(figures, responses={**figures.responses, "c": Decimal(3)})
    assert list(complaints(replace(system, figures=(wrong,)))) == [
        "MAST 1.7.0.0, non-preemptive: c is 3, not 3.5"
    ]


def test_a_wrong_reason_is_found() -> None:
    system = published("waters_2019")
    (figures,) = system.figures
    given = figures.differences["OS_Overhead"]

    def of(**changes: object) -> list[str]:
        differences = {"OS_Overhead": replace(given, **changes)}  # type: ignore[arg-type]
        changed = replace(figures, differences=differences)
        return list(complaints(replace(system, figures=(changed,))))

    assert of() == []
    assert of(equal_without="EKF") == [f"{figures.of}: OS_Overhead is 79985200 without EKF"]
    assert len(of(ours=Decimal(50000000))) == 2
    assert len(of(reason="")) == 1
    lost = replace(figures, differences={"other": given})
    assert len(list(complaints(replace(system, figures=(lost,))))) == 2


@pytest.mark.parametrize("name", NAMES)
def test_the_page_has_the_table(name: str) -> None:
    assert table(published(name)) in PAGE.read_text(encoding="utf-8")


def test_the_page_has_the_summary() -> None:
    assert summary() in PAGE.read_text(encoding="utf-8")


def test_the_page_states_each_difference() -> None:
    text = " ".join(PAGE.read_text(encoding="utf-8").split())
    for name in NAMES:
        for figures in published(name).figures:
            for difference in figures.differences.values():
                assert difference.reason in text
