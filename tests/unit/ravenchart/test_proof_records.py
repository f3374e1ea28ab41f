# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Which record of a proof belongs to which program."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.building import checking, programs
from ravenchart.commands.prove import record_of
from ravenchart.evidence import records
from ravenchart.paths import ROOT
from ravenchart.proof import spark_results


def test_prove_writes_a_record_for_each_of_several_nodes() -> None:
    path = Path("out/proof.toml")
    assert record_of(path, "drive", several=True) == Path("out/proof-drive.toml")
    assert record_of(path, "drive", several=False) == path


def test_each_of_two_programs_has_the_record_that_was_made_of_it() -> None:
    model = ROOT / "examples" / "two_nodes" / "model.yaml"
    checked = checking.check(model)
    drive, panel = programs.programs_of(checked)[::-1]
    found = {one.node: records.of_example(one) for one in (drive, panel)}
    for program in (drive, panel):
        path = found[program.node]
        assert path is not None and path.stem == f"two_nodes-{program.node}"
        assert records.belongs(path, program)
        assert not any(records.belongs(path, one) for one in (drive, panel) if one != program)


@pytest.mark.parametrize(
    ("name", "location", "known"),
    [
        (
            "A.Crossings.B.Board.Slots.Read",
            "ravenchart-shared_slots.ads:33",
            "Ravenchart.Shared_Slots.Read",
        ),
        (
            "Tracker.Reports_2.Board.Slots",
            "ravenchart-crossing_boards.adb:19",
            "Ravenchart.Crossing_Boards.Slots",
        ),
        (
            "Ravenchart.Can.Ctu_Core.Open",
            "ravenchart-can-ctu_cores.ads:9",
            "Ravenchart.Can.Ctu_Core.Open",
        ),
        (
            "Tracker.Eye.Activities.Look",
            "tracker-eye-activities.ads:4",
            "Tracker.Eye.Activities.Look",
        ),
    ],
)
def test_an_entity_of_an_instance_of_the_runtime_has_the_name_of_its_generic(
    name: str, location: str, known: str
) -> None:
    assert spark_results.named_outside(name, location).name == known
