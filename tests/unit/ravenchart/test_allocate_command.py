# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart allocate`: what is proposed holds when it is put into the model."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from ravenchart.allocation import proposals
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.command_line import main
from ravenchart.failures import OK
from ravenchart.gen.pipeline import load

ROBOT = Path(__file__).parents[3] / "examples" / "cartesian_robot"


def analysed(path: Path) -> Analysis:
    loaded = load(path)
    assert loaded.system is not None, loaded.diagnostics
    return analyse(loaded.system)


def pasted(text: str, folder: Path, home: Path = ROBOT) -> Path:
    """A model with other processors, in the file that has its tables: itself or an included one."""
    for part in home.glob("*.yaml"):
        shutil.copy(part, folder)
    model = folder / "model.yaml"
    named = re.search(r"^include: \[(.*)\]$", model.read_text(encoding="utf-8"), re.M)
    included = named[1].split(", ") if named else []
    changed = 0
    for part in (model, *(folder / name for name in included)):
        old = part.read_text(encoding="utf-8")
        new, count = re.subn(r"(?ms)^processors:\n.*?(?=^\S|\Z)", text, old)
        part.write_text(new, encoding="utf-8")
        changed += count
    assert changed == 1
    return model


@pytest.mark.parametrize("strategy", proposals.STRATEGIES)
def test_what_is_proposed_is_what_the_model_then_has(strategy: str, tmp_path: Path) -> None:
    before = analysed(ROBOT / "model.yaml")
    proposal = proposals.propose(before, strategy)
    after = analysed(pasted(proposals.yaml(proposal), tmp_path))
    assert after.found.met
    rows = {s.element for p in before.system.processors for s in p.slots}
    assert {s.element for p in after.system.processors for s in p.slots} == rows
    for name in after.tasks:
        assert after.found.from_event(name) == proposal.analysis.found.from_event(name), name
        assert after.slack(name) == proposal.analysis.slack(name)
    assert after.schedulable and proposal.analysis.schedulable


def test_few_tasks_are_fewest_and_sporadic_ones_stay() -> None:
    before = analysed(ROBOT / "model.yaml")
    counts = {
        strategy: len(proposals.propose(before, strategy).system.processors)
        for strategy in ("period", "locality", "fewest")
    }
    assert counts["fewest"] == min(counts.values())
    kept = proposals.propose(before, "fewest").system.processors[0]
    assert (kept.name, kept.released_by, kept.period) == ("reception", "robot_bus", 1_000_000)


def test_the_table_fits_80_columns_and_says_what_stays(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["allocate", str(ROBOT / "model.yaml"), "--strategy", "locality"]) == OK
    text = capsys.readouterr().out
    assert text.startswith("Cartesian_Robot: every deadline is met")
    assert max(map(len, text.splitlines())) <= 80
    for phrase in ("reception (stays)", "  joint_x.ports", "Drivers, the host probe, sporadic"):
        assert phrase in text


def test_events_of_misses_and_offsets_go_with_the_rows() -> None:
    before = analysed(ROBOT.parent / "pump" / "model.yaml")
    misses = {m for p in before.system.processors for m in p.on_deadline_miss}
    text = proposals.yaml(proposals.propose(before, "period"))
    assert all(f"      - {instance}.{event}" in text for instance, event in misses)


NODES = ROBOT.parents[1] / "tests" / "nodes"


@pytest.mark.slow
@pytest.mark.parametrize("strategy", proposals.STRATEGIES)
@pytest.mark.parametrize(
    "home",
    [
        *(ROBOT.parent / n for n in ("two_nodes", "surgical_robot")),
        *(NODES / n for n in ("commands", "gripper", "tactile")),
    ],
)
def test_what_is_printed_for_several_nodes_or_files_is_a_model(
    home: Path, strategy: str, tmp_path: Path
) -> None:
    proposal = proposals.propose(analysed(home / "model.yaml"), strategy)
    after = analysed(pasted(proposals.yaml(proposal), tmp_path, home))
    assert after.schedulable
    assert set(after.tasks) == set(proposal.analysis.tasks)
    for name in after.tasks:
        assert after.found.from_event(name) == proposal.analysis.found.from_event(name), name


HEAD = """\
system: Small
types: {Word: {range: [0, 100]}}
nodes: {cpu: {context_switch: 5 us, critical_section: 50 us}}
instances: {k: {component: C, node: cpu}}
shutdown: {raises: [], grace: 0 ms}
"""

SHORT = (
    HEAD
    + """\
components:
  C:
    data: {n: {type: Word, initial: 0}, m: {type: Word, initial: 0}}
    activities:
      a: {period: 10 ms, wcet: 20 us, body: [{set: n, to: 1}]}
      b: {period: 20 ms, wcet: 500 us, body: [{set: m, to: n}]}
processors:
  work: {node: cpu, stack: 32 KiB, activities: [k.a, k.b]}
"""
)
"""A row alone is shorter than the critical section, so it cannot be a processor by itself."""

SENDS = (
    HEAD
    + """\
components:
  C:
    ports: {word: {out: Word}}
    data: {m: {type: Word, initial: 0}}
    activities:
      long: {period: 20 ms, wcet: 6 ms, body: [{set: m, to: 1}]}
      tell: {period: 20 ms, wcet: 60 us, body: [{send: word, with: 1}]}
processors:
  one: {node: cpu, stack: 32 KiB, activities: [k.long]}
  two: {node: cpu, stack: 32 KiB, activities: [k.tell], priority: 2}
buses: {can0: {bit_rate: 500 kbit/s, driver_wcet: 60 us, receive_depth: 4, transmit_depth: 4}}
messages: {told: {bus: can0, id: 1, from: k.word, deadline: 3 ms}}
"""
)
"""The message is late where its sender waits for the other row: in one table, or below it."""


@pytest.mark.parametrize("strategy", proposals.STRATEGIES)
@pytest.mark.parametrize("text", [SHORT, SENDS])
def test_every_strategy_keeps_sections_and_deadlines_of_messages(
    text: str, strategy: str, tmp_path: Path
) -> None:
    model = tmp_path / "model.yaml"
    model.write_text(text)
    assert main(["allocate", str(model), "--strategy", strategy]) == OK
    proposal = proposals.propose(analysed(model), strategy)
    (tmp_path / "new").mkdir()
    after = analysed(pasted(proposals.yaml(proposal), tmp_path / "new", tmp_path))
    assert after.schedulable


def test_tables_that_do_not_exist_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = tmp_path / "model.yaml"
    model.write_text(SENDS.replace("deadline: 3 ms", "deadline: 100 us"))
    assert main(["allocate", str(model), "--strategy", "slack"]) == 1
    assert "No tables were found that keep every deadline and limit" in capsys.readouterr().out
