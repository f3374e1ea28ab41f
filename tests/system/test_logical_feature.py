# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Logical execution times: the same values on one core, on two, and in simulations."""

from __future__ import annotations

import os
import random
import shutil
from itertools import groupby
from pathlib import Path

import pytest

from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.building import checking
from ravenchart.commands.simulate import build_simulation, executed, interpreted
from ravenchart.gen.language.terms import Ns
from ravenchart.paths import ROOT
from tests.support.interpreted import stimuli_of, system_of
from tests.support.short_runs import observed

FOLDER = ROOT / "tests" / "feature" / "logical"
TEXT = (FOLDER / "model.yaml").read_text(encoding="utf-8")

LOGICAL = ("    logical_execution_time: 3 ms\n", "    logical_execution_time: 20 ms\n")
ONE, TWO = "cell: {context_switch", "cell: {cores: 2, context_switch"
KEEPING, LOOKING = "    offset: 1 ms\n", "    offset: 2 ms\n"
FIRST, LAST = "    priority: 30\n", "    priority: 1\n"

MODELS = {
    "one core": TEXT,
    "the receiver on a second core": TEXT.replace(ONE, TWO).replace(
        KEEPING, KEEPING + "    core: 2\n"
    ),
    "another receiver there": TEXT.replace(ONE, TWO).replace(LOOKING, LOOKING + "    core: 2\n"),
    "other priorities": TEXT.replace(KEEPING, KEEPING + FIRST)
    .replace(LOOKING, LOOKING + LAST)
    .replace("wcet: 4 ms", "wcet: 1 ms"),
}

Values = dict[str, list[object]]


def _simulated(text: str) -> Values:
    """What the interpreter records in 3 s, by element."""
    system = system_of(text)
    found: Values = {}
    for one in interpreted(system, stimuli_of("- {until: 3 s}", system)).values:
        found.setdefault(one.element, []).append(one.value)
    return found


def _run(text: str, folder: Path) -> Values:
    """What a running controller records in 1 s."""
    shutil.copytree(FOLDER, folder)
    (folder / "model.yaml").write_text(text, encoding="utf-8")
    checked = checking.check(folder / "model.yaml")
    if not os.sched_getaffinity(0).issuperset(range(checked.system.most_cores)):
        pytest.skip(f"needs the first {checked.system.most_cores} processors of the machine")
    seen = observed(checked, folder, 1)
    assert seen.values_lost == 0
    missed = {name: one.misses for name, one in seen.processors.items()}
    assert not any(missed.values()), f"the host withheld the processor: {missed}"
    found: Values = {}
    for one in seen.values:
        found.setdefault(one.element.name, []).append(one.value)
    return found


@pytest.mark.slow
@pytest.mark.clock
@pytest.mark.parametrize("name", MODELS)
def test_a_run_records_what_the_simulation_does(name: str, tmp_path: Path) -> None:
    wanted, found = _simulated(TEXT), _run(MODELS[name], tmp_path / "logical")
    assert set(found) == set(wanted)
    for element, values in found.items():
        assert len(values) >= 20 and values == wanted[element][: len(values)], element
    assert len(set(found["sink_1.seen"])) > 10 and len(set(found["fast_1.newest"])) > 10


@pytest.mark.parametrize("name", MODELS)
def test_cores_and_priorities_change_no_value(name: str) -> None:
    assert _simulated(MODELS[name]) == _simulated(TEXT)


def test_without_logical_times_priorities_do_change_values() -> None:
    texts = [MODELS[name] for name in ("one core", "other priorities")]
    for line in LOGICAL:
        texts = [text.replace(line, "") for text in texts]
    #  all are released at once, so that the order of the processors shows
    texts = [text.replace("offset: 1 ms", "offset: 0 ms") for text in texts]
    one, other = map(_simulated, texts)
    assert one != other


def test_the_simulated_program_does_the_same_as_the_interpreter(tmp_path: Path) -> None:
    system = system_of(TEXT)
    program = build_simulation(system, tmp_path, tmp_path / "simulation")
    chance = random.Random(7)
    for _ in range(20):
        times = sorted(chance.choices(range(400), k=chance.randint(0, 60)))
        at_once = [(at, len(list(same))) for at, same in groupby(times)]
        puts = [
            f"- {{at: {at} ms, put: {end}, value: {chance.randrange(1000)}}}"
            for at, times_ in at_once
            for end in chance.choices(("source_1.back", "sink_1.mixed", "fast_1.state"), k=times_)
        ]
        stimuli = stimuli_of("\n".join([*puts, "- {until: 500 ms}"]), system)
        assert executed(system, program, stimuli) == interpreted(system, stimuli)


def test_a_value_is_seen_at_the_first_release_after_its_instant() -> None:
    found = _simulated(TEXT)
    #  made at 0, 5, ...: visible from 3, 8, ... on; taken at 1, 21, 41, ...
    assert found["sink_1.seen"][:5] == [0, 4, 8, 12, 16]
    #  taken at 7, 17, 27, ... by a row of 10 ms with a phase of 5 ms
    assert found["fast_1.newest"][:4] == [1, 3, 5, 7]


def test_a_mailbox_shows_what_its_port_has_not_taken() -> None:
    machine = Machine(system_of(TEXT))
    coming = []
    for now, slots in machine.instants(Ns(7_000_000)):
        list(machine.execute(now, slots))
        box = machine.instances["sink_1"].mailboxes["mixed"]
        coming.append((now // 1_000_000, box.coming()))
    #  made at 0 and 5 ms, visible 3 ms later; the port looks at 1 ms and then at 21 ms
    assert coming == [(0, [1]), (1, [1]), (2, [1]), (5, [1, 2]), (7, [1, 2])]
