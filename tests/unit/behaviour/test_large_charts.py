# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A chart of many leaf states is checked to the end, and its code grows with its size alone."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest

from ravenchart.behaviour.limits import UNFINISHED
from ravenchart.behaviour.rules import findings
from ravenchart.behaviour.rules.budget import Budget
from ravenchart.behaviour.rules.reach import Reachable
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.system import System
from tests.bench.large_charts import large_chart
from tests.bench.random_models import random_model
from tests.support.interpreted import system_of

pytestmark = pytest.mark.slow


def _reach(system: System, index: int = 0) -> Reachable:
    return Reachable(system.components[index], system, Budget(150_000_000))


def test_120_leaves_are_checked_to_the_end() -> None:
    system = system_of(large_chart(12))
    found = findings(system)
    assert {item.code for item in found} == {"RV-1105"}, found
    assert UNFINISHED not in [item.code for item in found]


def test_each_further_block_is_as_many_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ravenchart.behaviour.rules.threads.MOST_NODES", 9)
    nodes = [len(_reach(system_of(large_chart(b))).threads[0].nodes) for b in (2, 4, 6)]
    assert nodes[2] - nodes[1] == nodes[1] - nodes[0] == 2 * 13


def _unit(text: str, name: str) -> str:
    """The text of a generated unit of the region Motion."""
    files = generate(system_of(text), Claims())
    return next(made for file, made in files.items() if file.endswith(f"-motion.{name}"))


def _fire(blocks: int) -> int:
    """Lines of `Fire`."""
    body = _unit(large_chart(blocks), "adb")
    return body[body.index("procedure Fire ") : body.index("end Fire;")].count("\n")


@pytest.mark.parametrize("of", [_fire, lambda n: _unit(large_chart(n), "ads").count("\n")])
def test_each_further_block_is_as_many_lines(of: Callable[[int], int]) -> None:
    few, some, many = of(3), of(6), of(9)
    assert many - some <= 1.1 * (some - few)
    assert many <= 90 * 100


def test_each_further_leaf_of_a_hierarchy_is_as_many_lines() -> None:
    lines = {n: _unit(random_model(n, 1), "adb").count("\n") for n in (60, 240)}
    assert lines[240] <= 1.1 * 4 * lines[60]
    assert lines[240] <= 240 * 60


def test_240_leaves_are_few_lines() -> None:
    assert _unit(large_chart(24), "adb").count("\n") <= 240 * 150


@pytest.mark.parametrize("leaves", [20, 60])
def test_the_selection_of_a_large_chart_asks_each_transition_once(leaves: int) -> None:
    text, declared = (_unit(random_model(leaves, 1), name) for name in ("adb", "ads"))
    selected = text[text.index("function Selected") : text.index("end Selected;")]
    literals = declared[declared.index("type Selection is") : declared.index("None);")]
    own = re.findall(r"^ +(\w+),", literals, re.M)
    assert sorted(re.findall(r"Enabled \((\w+),", selected)) == sorted(own)
