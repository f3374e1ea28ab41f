# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Nodes with several cores: each analysed on its own; values of ports alone go between them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.allocation import proposals
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.command_line import main
from ravenchart.failures import OK
from ravenchart.gen.model.system import System
from tests.support.pump import loaded
from tests.support.timing_models import worker

MODEL = (
    f"system: Twins\n{worker('200 us', '6 ms')}"
    + """\
nodes:
  board: {context_switch: 10 us, critical_section: 5 us, trace: 16, cores: 2}
instances:
  left: {component: Worker, node: board}
  right: {component: Worker, node: board}
processors:
  one:
    {node: board, stack: 16 KiB, on_deadline_miss: [left.Late],
     activities: [left.Control, left.toil]}
  two:
    {node: board, core: 2, stack: 16 KiB, on_deadline_miss: [right.Late],
     activities: [right.Control, right.toil]}
shutdown: {raises: [left.Late], grace: 10 ms}
"""
)


def system_of_text(text: str) -> System:
    found = loaded(text)
    assert found.system is not None, found.diagnostics
    return found.system


def found(text: str) -> Analysis:
    return analyse(system_of_text(text))


def test_each_core_is_analysed_on_its_own() -> None:
    """6.2 ms of every 10 fit each core; on one core they would be 124 %."""
    both = found(MODEL)
    assert both.schedulable
    assert [both.found.from_event(name) for name in ("one", "two")] == [6_225_000, 6_225_000]
    for name in ("board.1", "board.2"):
        assert both.utilisation(name) == both.utilisation("board.1")
    together = MODEL.replace("core: 2, ", "").replace(", cores: 2", "")
    assert not found(together).schedulable


def test_a_core_has_the_bounds_of_a_node_of_its_own() -> None:
    """The second core: what it has alone, on a node with one core, but for the main program.

    There the task that hands reports over takes its place below all others.
    """
    both = system_of_text(MODEL)
    alone = replace(
        both,
        tasks=tuple(replace(t, core=1) for t in both.tasks if t.core == 2),
        objects=tuple(
            item
            for item in both.objects
            if item.users and set(item.users) <= {"two", "board.reporter_2"}
        ),
        nodes=tuple(replace(node, cores=1) for node in both.nodes),
        processors=tuple(replace(p, core=1) for p in both.processors if p.core == 2),
    )
    assert analyse(alone).found.from_event("two") == analyse(both).found.from_event("two")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[left.Late], grace", "[right.Late], grace", "right.Control.queue is shared by two"),
        (
            "on_deadline_miss: [left.Late]",
            "on_deadline_miss: [right.Late]",
            "right.Control.queue is shared by two (core 2) and one (core 1)",
        ),
    ],
)
def test_nothing_is_shared_between_cores(old: str, new: str, message: str) -> None:
    assert old in MODEL
    result = loaded(MODEL.replace(old, new))
    told = [d for d in result.diagnostics if d.code == "RV-0711"]
    assert result.system is None
    assert message in told[0].message
    assert loaded(MODEL.replace(old, new).replace("core: 2, ", "")).system is not None


def test_a_core_that_is_not_there_is_refused() -> None:
    for text in (MODEL.replace("core: 2,", "core: 3,"), MODEL.replace(", cores: 2", "")):
        assert [d.code for d in loaded(text).diagnostics if d.is_error] == ["RV-0710"]


def test_it_is_analysed_exported_and_generated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = tmp_path / "model.yaml"
    model.write_text(MODEL, encoding="utf-8")
    assert main(["analyse", str(model), "--html", str(tmp_path / "r.html")]) == OK
    text = capsys.readouterr().out
    assert "board.1: core load 62.2 %\nboard.2: core load 62.2 %\n" in text
    for tool in ("mast", "cheddar", "pycpa"):
        assert main(["analyse", str(model), "--export", tool]) == OK
        assert "board_2" in capsys.readouterr().out
    assert main(["generate", str(model)]) == OK
    assert "CPU => 2" in (tmp_path / "generated" / "twins-two.ads").read_text()
    assert main(["check-certificate", str(model)]) == OK


def test_allocation_keeps_rows_on_their_core() -> None:
    proposal = proposals.propose(found(MODEL), "fewest")
    cores = {s.element: p.core for p in proposal.system.processors for s in p.slots}
    assert cores == {"left.Control": 1, "left.toil": 1, "right.Control": 2, "right.toil": 2}
    assert "    core: 2\n" in proposals.yaml(proposal)
