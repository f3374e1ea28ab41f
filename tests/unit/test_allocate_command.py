"""`ravenchart allocate`: what is proposed holds when it is put into the model."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from analysis.timing import Analysis, analyse
from gen.load import load
from ravenchart import allocate
from ravenchart.__main__ import OK, main

ROBOT = Path(__file__).parents[2] / "examples" / "cartesian_robot"


def analysed(path: Path) -> Analysis:
    loaded = load(path)
    assert loaded.system is not None, loaded.diagnostics
    return analyse(loaded.system)


def pasted(text: str, folder: Path) -> Path:
    """The robot's model with other processors."""
    for part in ROBOT.glob("*.yaml"):
        shutil.copy(part, folder)
    model = folder / "model.yaml"
    old = model.read_text(encoding="utf-8")
    new, count = re.subn(r"(?ms)^processors:\n.*?(?=^\S|\Z)", text, old)
    assert count == 1
    model.write_text(new, encoding="utf-8")
    return model


@pytest.mark.parametrize("strategy", allocate.STRATEGIES)
def test_what_is_proposed_is_what_the_model_then_has(strategy: str, tmp_path: Path) -> None:
    before = analysed(ROBOT / "model.yaml")
    proposal = allocate.propose(before, strategy)
    after = analysed(pasted(allocate.yaml(proposal), tmp_path))
    assert after.found.met
    rows = {s.element for p in before.system.processors for s in p.slots}
    assert {s.element for p in after.system.processors for s in p.slots} == rows
    for name in after.tasks:
        assert after.found.from_event(name) == proposal.analysis.found.from_event(name), name
        assert after.slack(name) == proposal.analysis.slack(name)
    #  Only the search for slack parts what a chain hands on at once.
    assert after.schedulable == proposal.analysis.schedulable == (strategy != "slack")


def test_few_tasks_are_fewest_and_sporadic_ones_stay() -> None:
    before = analysed(ROBOT / "model.yaml")
    counts = {
        strategy: len(allocate.propose(before, strategy).system.processors)
        for strategy in ("period", "locality", "fewest")
    }
    assert counts["fewest"] == min(counts.values())
    kept = allocate.propose(before, "fewest").system.processors[0]
    assert (kept.name, kept.released_by, kept.period) == ("reception", "robot_bus", 1_000_000)


def test_the_table_fits_80_columns_and_says_what_stays(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["allocate", str(ROBOT / "model.yaml"), "--strategy", "locality"]) == OK
    text = capsys.readouterr().out
    assert text.startswith("Cartesian_Robot: every deadline is met")
    assert max(map(len, text.splitlines())) <= 80
    for phrase in ("reception (stays)", "  joint_x.ports", "Drivers, the host probe and sporadic"):
        assert phrase in text


def test_events_of_misses_and_offsets_go_with_the_rows() -> None:
    before = analysed(ROBOT.parent / "pump" / "model.yaml")
    misses = {m for p in before.system.processors for m in p.on_deadline_miss}
    text = allocate.yaml(allocate.propose(before, "period"))
    assert all(f"      - {instance}.{event}" in text for instance, event in misses)
