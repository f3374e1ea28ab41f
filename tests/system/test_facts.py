# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What the timing certificate states is what the program does: edits of either are refused.

The program is that of the drive of `two_nodes`. The compiler refuses an edit of a task, and one
of the certificate. A row of a table and what is sent or expected on the bus is refused by
gnatprove or by a run (`make mutate --kind fact`); here one of each is run.
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from ravenchart.tools import toolchain
from tests.mutation.__main__ import Subject, mutants, tried
from tests.mutation.mutants import Mutant, text_of
from tests.mutation.observing import Observer, PlayedTogether
from tests.mutation.workbench import Workbench

pytestmark = pytest.mark.slow

MODEL = ROOT / "examples" / "two_nodes" / "model.yaml"
LATER = {"divisor", "phase", "cycle", "bit rate", "id sent", "id expected", "length sent"}
LATER |= {"length expected", "twice", "not at all", "other row"}
"""What the compiler alone lets pass, of edits of the code."""
INCLUDED = ("spark_runtime/src", "spark_runtime/native", "hw_can/hal", "hw_can/drivers/bus")


@pytest.fixture(scope="module")
def subject() -> Subject:
    return Subject("two_nodes", MODEL, PlayedTogether, "drive")


@pytest.fixture(scope="module")
def facts(subject: Subject) -> list[Mutant]:
    return mutants(subject, None, 1, ("fact",))


@pytest.fixture(scope="module")
def bench(subject: Subject, tmp_path_factory: pytest.TempPathFactory) -> Workbench:
    return Workbench(MODEL, tmp_path_factory.mktemp("bench"), Observer, "drive")


def one_of_each(facts: list[Mutant]) -> Mapping[tuple[str, str, str], Mutant]:
    """One edit of each kind in each file; of the certificate, of each place."""
    return {(one.file, one.rule, one.place if one.part == "declared" else ""): one for one in facts}


def is_later(mutant: Mutant) -> bool:
    return mutant.part == "code" and mutant.rule in LATER


def test_the_class_has_all_edits_that_once_passed(facts: list[Mutant]) -> None:
    rules = {(one.place, one.rule) for one in facts}
    assert {r for p, r in rules if p == "priority"} >= {
        "higher", "lower", "bottom", "of Control_Priority", "of Reception_Drive_Priority"
    }  # fmt: skip
    assert {p for p, _ in rules} >= {"period", "deadline", "offset", "minimum_separation"}
    assert {r for p, r in rules if p == "table"} == {"divisor", "phase", "cycle"}
    assert {r for p, r in rules if p == "bus"} == {
        "bit rate", "id sent", "id expected", "length sent", "length expected"
    }  # fmt: skip
    assert {r for p, r in rules if p == "Execute"} == {"twice", "not at all", "other row"}
    assert {o.rule for o in facts if o.part == "declared"} == {
        "blocking", "interference", "budget", "swapped", "level", "divisor", "length", "bit rate",
        "identifiers",
    }  # fmt: skip


def compiled(bench: Workbench, name: str, text: str, folder: Path) -> str:
    """What the compiler says of one file beside those of the bench; "" is yes."""
    (folder / name).write_text(text)
    places = [f"-I{ROOT / place}" for place in INCLUDED]
    done = subprocess.run(
        ["gcc", "-c", "-gnatc", "-gnat2012", "-gnatws", *places, f"-I{bench.source}", name],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    (folder / name).unlink()
    return done.stderr if done.returncode else ""


def test_the_compiler_refuses_an_edited_task_and_an_edited_certificate(
    bench: Workbench, facts: list[Mutant], tmp_path: Path
) -> None:
    asked = [one for one in one_of_each(facts).values() if not is_later(one)]
    assert len(asked) > 60
    for name in {one.file for one in asked}:
        assert compiled(bench, name, text_of(bench.files[name]), tmp_path) == ""
    for one in asked:
        said = compiled(bench, one.file, one.applied(bench.files[one.file]), tmp_path)
        assert re.search("certificate|claim|must|sum", said), (one.name, said)


@pytest.mark.parametrize("rule", sorted(LATER))
def test_a_run_refuses_what_the_compiler_lets_pass(
    runs: Workbench, facts: list[Mutant], rule: str
) -> None:
    one = next(m for m in facts if is_later(m) and m.rule == rule)
    assert runs.run_broken(one)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Workbench:
    made = Workbench(MODEL, tmp_path_factory.mktemp("runs"), PlayedTogether, "drive")
    made.prepare()
    return made


@pytest.mark.skipif(not toolchain.have("gnatprove"), reason="gnatprove is not on PATH")
def test_gnatprove_refuses_a_row_that_is_executed_twice(
    subject: Subject, facts: list[Mutant]
) -> None:
    chosen = [next(m for m in facts if m.rule == rule) for rule in ("twice", "divisor")]
    outcomes = tried(subject, chosen, 1, ())
    assert [o.verdict.by for o in outcomes] == ["gnatprove", "gnatprove"]
