# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Interrupts of a node: their names, their targets, their code and the checker of certificates."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.behaviour.interpreter.stimuli import read_stimuli, written_stimuli
from ravenchart.building import checking, generation
from ravenchart.building.targets import check_interrupts, target
from ravenchart.failures import Refused
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.independent.check import checked
from ravenchart.language_server.completing import proposals
from ravenchart.language_server.model import model
from ravenchart.language_server.renaming import renamed
from ravenchart.paths import ROOT
from ravenchart.proof.outside_spark import reasons_of

PATH = ROOT / "tests" / "feature" / "interrupts" / "model.yaml"
TEXT = PATH.read_text(encoding="utf-8")


def system_of(*changes: tuple[str, str]) -> System:
    text = TEXT
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    found = load(Path("model.yaml"), lambda path, limit: text.encode())
    assert found.system is not None, [one.message for one in found.diagnostics]
    return found.system


def test_a_target_takes_interrupts_by_its_own_key() -> None:
    both = system_of()
    for name in ("native", "zynqmp"):
        check_interrupts(target(name), both)
    with pytest.raises(Refused, match="limit has no `number`: it comes from nowhere on zynqmp"):
        check_interrupts(target("zynqmp"), system_of(("number: 121, ", "")))
    with pytest.raises(Refused, match="limit has no `signal`: it comes from nowhere on native"):
        check_interrupts(target("native"), system_of(("signal: SIGUSR1, ", "")))


def test_a_target_without_that_unit_takes_none() -> None:
    native = target("native")
    without = replace(native, facts=native.facts.model_copy(update={"interrupts": None}))
    with pytest.raises(Refused, match="take no interrupts, and limit releases a processor"):
        check_interrupts(without, system_of())
    quiet = replace(system_of(), nodes=tuple(replace(n, interrupts=()) for n in system_of().nodes))
    check_interrupts(without, quiet)


@pytest.mark.parametrize("tick", ["", "tick: {period: 100 us, wcet: 2 us}\n    "])
def test_the_independent_checker_agrees(tick: str, tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    path.write_text(TEXT.replace("trace: 2048", f"{tick}trace: 2048"), encoding="utf-8")
    written = generation.write_program(checking.check(path))
    assert checked(path).disagreements == []
    certificate = next(written.folder.glob("*certificate.ads"))
    text = certificate.read_text(encoding="utf-8")
    old = "Board_Limit_Wcet : constant := 20_000;"
    assert old in text
    certificate.write_text(text.replace(old, old.replace("20_000", "10_000")), "utf-8")
    assert any("Board_Limit_Wcet" in str(one) for one in checked(path).disagreements)


def test_stimuli_name_an_interrupt() -> None:
    text = "- {at: 10 ms, interrupt: Board.LIMIT}\n- {until: 20 ms}\n"
    found, wrong = read_stimuli(text, "events.yaml", system_of())
    assert found is not None and not wrong
    assert "interrupt: board.limit}" in written_stimuli(found)
    _, (told,) = read_stimuli(text.replace("LIMIT", "limits"), "events.yaml", system_of())
    assert (told.code, told.hint) == ("RV-1004", "one of: board.limit, board.turn")


def test_an_editor_proposes_the_interrupts_of_a_node() -> None:
    behind = "released_by: board."
    found = proposals(PATH, str(PATH), TEXT.index(behind) + len(behind), {str(PATH): TEXT})
    assert {"limit", "turn"} <= {one.word for one in found}


def test_an_interrupt_is_renamed_where_it_is_declared_and_used() -> None:
    now = model(PATH, {})
    symbol = next(one for one in now.symbols.all() if one.name == "limit")
    assert symbol.declared is not None
    assert sum(map(len, renamed(now, symbol, "end_stop", {}).values())) == 2


def test_only_their_programs_have_a_part_outside_spark() -> None:
    own = {"Ravenchart.Interrupt_Sources": "ASM-024"}
    assert reasons_of(system_of(), PATH.parent) == own
    nodes = tuple(replace(node, interrupts=()) for node in system_of().nodes)
    assert reasons_of(replace(system_of(), nodes=nodes), PATH.parent) == {}
