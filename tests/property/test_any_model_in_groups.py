# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Input ports of any model can be put into groups: only the times of their handlers change."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from ravenchart.behaviour.cases.stimulation import choices
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.stimuli import Stimuli
from ravenchart.building import checking, generation, programs
from ravenchart.building.checking import Checked
from ravenchart.commands.simulate import build_simulation, run_simulation
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import System
from ravenchart.independent.check import checked as independently
from ravenchart.paths import ROOT
from tests.support.as_groups import grouped
from tests.support.effort import seeds

ALL_INSIDE = {"called", "gathered", "library"}
"""All of their input ports are in composites, arrays or a library, one in each component."""
MODELS = {
    path.parent.name: path.parent
    for kind in ("tests/feature", "tests/nodes")
    for path in sorted((ROOT / kind).glob("*/model.yaml"))
    if "port_region" in path.read_text("utf-8") and path.parent.name not in (*ALL_INSIDE, "grouped")
}
FAR_COMMANDS = {"gripper"}
"""The independent checker does not know commands between nodes."""
UNTIL = Ns(2 * 10**9)


def checked(name: str, folder: Path, chance: random.Random | None = None) -> Checked:
    """A model with groups: right behind the port region, or drawn."""
    found = checking.check(grouped(MODELS[name], folder, chance), deadlines=False)
    assert any(one.component.groups for one in found.system.instances)
    return found


def drawn(system: System, chance: random.Random) -> Stimuli:
    """Values and events from outside."""
    known = choices(system)
    times = sorted(chance.randrange(UNTIL) for _ in range(40 if known else 0))
    return Stimuli(tuple(chance.choice(known).drawn(Ns(at), chance) for at in times), UNTIL)


@pytest.mark.parametrize("name", MODELS)
def test_a_group_right_behind_the_port_region_changes_nothing(name: str, tmp_path: Path) -> None:
    whole = checking.check(MODELS[name] / "model.yaml", deadlines=False).system
    parted = checked(name, tmp_path / "grouped").system
    stimuli = drawn(whole, random.Random(7))
    assert list(Machine(parted).run(stimuli)) == list(Machine(whole).run(stimuli))


@pytest.mark.parametrize("name", sorted(MODELS.keys() - FAR_COMMANDS))
@pytest.mark.parametrize("seed", seeds(1, 2))
def test_the_independent_checker_agrees(name: str, seed: int, tmp_path: Path) -> None:
    found = checked(name, tmp_path / "grouped", random.Random(seed))
    generation.write_program(found)
    wrong = independently(found.path).disagreements
    #  a queue may fill, since some groups run less often; then the certificate says so
    assert [one for one in wrong if one.kind != "checks"] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("seed", seeds(1, 2))
def test_the_program_does_what_the_interpreter_does(name: str, seed: int, tmp_path: Path) -> None:
    """It compiles without a warning; bodies of the user do nothing in the interpreter."""
    chance = random.Random(seed)
    found = checked(name, tmp_path / "grouped", chance)
    generation.write_program(found)
    said: list[str] = []
    for one in programs.programs_of(found):
        one.build("checks", warn=said.append, stacks_needed=False)
    assert said == []
    if list((MODELS[name] / "user").rglob("*.adb")) or len(found.system.nodes) > 1:
        return
    program = build_simulation(found.system, found.folder, tmp_path / "simulation")
    for _ in range(5):
        stimuli = drawn(found.system, chance)
        wanted = list(Machine(found.system).run(stimuli))
        assert list(run_simulation(found.system, program, stimuli)) == wanted
