# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Claims on what test cases execute, by an LCOV tracefile."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from ravenchart.building import checking
from ravenchart.evidence import facts, folder
from ravenchart.failures import Refused
from ravenchart.gen.emit.program import simulation
from tests.support.evidence import verdicts

SPEC = "valve_house-valve-motion.ads"
CHART, OWN = "valve_house-valve-motion.adb", "valve_house-valve-activities.adb"
EVERY = "DA:3,1\nDA:4,2\nBRDA:3,0,0,1\nBRDA:3,0,1,2\n"


def _tracefile(home: Path, chart: str = EVERY, own: str = EVERY, spec: str = EVERY) -> Path:
    """Counts of both bodies and of the spec of the chart as they are."""
    texts = simulation(checking.check(home / "model.yaml").system)
    body = (home / "user" / OWN).read_bytes()
    rows = ((CHART, texts[CHART].encode(), chart), (OWN, body, own))
    lines = ""
    for name, content, counts in (*rows, (SPEC, texts[SPEC].encode(), spec)):
        version = hashlib.sha256(content).hexdigest()
        lines += f"TN:\nSF:/elsewhere/{name}\nVER:{version}\n{counts}end_of_record\n"
    file = home / "cases.info"
    file.write_text(lines)
    return file


def _claims(home: Path, file: Path) -> dict[str, tuple[str, tuple[str, ...]]]:
    made = folder.make(
        facts.gather(home / "model.yaml", None, [home / "proof.toml"], coverage=file)
    )
    return {
        one.id: (one.verdict.value, one.reasons)
        for one in made.claims
        if one.id.startswith("coverage-")
    }


def test_what_is_executed_whole_is_met(home: Path) -> None:
    found = _claims(home, _tracefile(home))
    own = OWN.removesuffix(".adb")
    assert found == {"coverage-Valve.Motion": ("met", ()), f"coverage-{own}": ("met", ())}


def test_what_is_left_is_named_by_line(home: Path) -> None:
    left = "DA:3,1\nDA:4,0\nDA:5,0\nBRDA:3,0,0,1\nBRDA:3,0,1,0\nBRDA:4,0,0,-\n"
    verdict, reasons = _claims(home, _tracefile(home, chart=left))["coverage-Valve.Motion"]
    assert verdict == "partly"
    assert reasons == (f"{CHART}: not executed: 4-5", f"{CHART}: a branch is not taken: 3")
    guards = _tracefile(home, spec=left)
    assert _claims(home, guards)["coverage-Valve.Motion"] == (
        "partly",
        (f"{SPEC}: not executed: 4-5", f"{SPEC}: a branch is not taken: 3"),
    )


def test_counts_of_another_text_show_nothing(home: Path) -> None:
    file = _tracefile(home)
    body = home / "user" / OWN
    body.write_text(body.read_text() + "--  later\n")
    assert _claims(home, file)[f"coverage-{OWN.removesuffix('.adb')}"] == (
        "not met",
        (f"{OWN} is not as it was when it was counted",),
    )


def test_counts_of_an_unknown_text_and_none_at_all_show_nothing(home: Path) -> None:
    file = _tracefile(home)
    lines = [one for one in file.read_text().splitlines() if not one.startswith("VER:")]
    file.write_text("\n".join(lines))
    assert {verdict for verdict, _ in _claims(home, file).values()} == {"not met"}
    file.write_text("TN:\nSF:other.adb\nend_of_record\n")
    assert _claims(home, file)["coverage-Valve.Motion"] == (
        "not met",
        (f"the tracefile has no counts of {CHART}", f"the tracefile has no counts of {SPEC}"),
    )


def test_without_a_tracefile_there_is_no_claim_and_a_gap(home: Path) -> None:
    made = folder.make(facts.gather(home / "model.yaml", None, [home / "proof.toml"]))
    assert not [id_ for id_ in verdicts(made) if id_.startswith("coverage-")]
    assert "No structural coverage is given" in made.texts["index.html"]
    given = facts.gather(home / "model.yaml", None, [], coverage=_tracefile(home))
    assert "No structural coverage is given" not in folder.make(given).texts["index.html"]


@pytest.mark.parametrize(
    "text", ["", "SF:a.adb\nDA:1,1\n", "DA:1,1\n", "SF:a.adb\nDA:one,1\nend_of_record\n", "\0\xff"]
)
def test_what_is_no_tracefile_is_said(home: Path, text: str) -> None:
    file = home / "cases.info"
    file.write_bytes(text.encode("latin-1"))
    with pytest.raises(Refused, match="not an LCOV tracefile"):
        facts.gather(home / "model.yaml", None, [], coverage=file)
