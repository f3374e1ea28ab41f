# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A small model with all that evidence is made of: program, record, requirements, tests.

The record is made up: it has the digests of the files that are there, and a check of each unit. So
the tests need no prover, and a record of the repository need not be current.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Sequence
from pathlib import Path

from ravenchart.building import checking, generation, programs
from ravenchart.evidence import facts, folder, lists, records
from ravenchart.evidence.folder import FolderTexts
from ravenchart.gen.emit.nodes.termination import ending_claims
from ravenchart.gen.explanations import edited
from ravenchart.paths import ROOT
from ravenchart.proof import proving
from ravenchart.proof.spark_results import Entity, Outside, Results
from ravenchart.tools.kept import file_digest

BASE = ROOT / "gen" / "explanations" / "bases" / "valve.yaml"
EDITS = (
    (
        "    activities:\n",
        "    data: {seen: {type: Level, initial: 0}}\n"
        "    never:\n"
        "      full: {condition: in(Motion.Closed) and seen > 1000 - 1, req: [R-3]}\n"
        "    activities:\n"
        "      look: {period: 20 ms, wcet: 30 us, body: user, reads: [level]}\n",
    ),
    ("activities: [valve_1.ports, ", "activities: [valve_1.ports, valve_1.look, "),
    ("lost: {from", "lost: {req: [R-1], from"),
    ("reaction: {path", "reaction: {req: [R-2], path"),
)
LIST = 'id,text\nR-1,A lost level closes the valve\nR-2,"In time, always"\nR-3,Never full\n'
RESULTS = """\
<testsuites><testsuite name="t">
<testcase classname="valve" name="closes" time="0.1">
<properties><property name="req" value="R-1"/><property name="req" value="R-3"/></properties>
</testcase>
</testsuite></testsuites>
"""
SCENARIO = """\
scenario: The valve opens
steps:
  - {wait: 10 ms}
  - {wait_for: opening_out.value, is: 3, within: 1 s, req: [R-2]}
"""
UNITS = (
    *("Valve_House.Valve.Motion.Fire", "Valve_House.Valve.Flows.Tell"),
    *("Valve_House.Codecs.Type_Level.Pack", "Valve_House.Timing_Certificate"),
    *("Valve_House.Valve.Activities.Look",),
)


def write(home: Path) -> None:
    """Model, program, record, list, scenario and results in a folder."""
    home.mkdir(parents=True)
    model = home / "model.yaml"
    text = edited({"": BASE.read_text(encoding="utf-8")}, EDITS)[""]
    model.write_text(text, encoding="utf-8")
    generation.write_program(checking.check(model))
    (home / "requirements.csv").write_text(LIST, encoding="utf-8")
    (home / "results.xml").write_text(RESULTS, encoding="utf-8")
    (home / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    record(home)
    runtime = home / "records" / "gnat-12"
    runtime.mkdir(parents=True)
    (home / "runtime.ads").write_text("package Runtime is end Runtime;\n", encoding="utf-8")
    for name in ("loopback", "slcan"):
        text = _text([home / "runtime.ads"], ["Runtime"], ["Ravenchart.Can.Tcp_Sockets"])
        (runtime / f"runtime-{name}.toml").write_text(text, encoding="utf-8")


def record(home: Path, units: Sequence[str] = UNITS, outside: Iterable[str] = ()) -> None:
    """The record of the program that is there."""
    checked = checking.check(home / "model.yaml", deadlines=False)
    (program,) = programs.programs_of(checked)
    driver = ROOT / "hw_can" / "drivers" / "slcan" / records.DRIVER
    sources = [*records.own_sources(program), program.project, driver]
    (home / "proof.toml").write_text(_text(sources, units, outside), encoding="utf-8")
    ends = [claim.entity for claim in ending_claims(program.part)]
    text = _text(sources, ends, (), proving.TERMINATION)
    records.of_termination(home / "proof.toml").write_text(text, encoding="utf-8")


def _text(
    sources: Iterable[Path], units: Sequence[str], outside: Iterable[str], shows: str = ""
) -> str:
    entities = tuple(Entity(unit, 2, ("Z3",)) for unit in units)
    found = tuple(Outside(name, "x.ads:1") for name in outside)
    results = Results(2 * len(units), 0, (), 0, found, frozenset(), entities)
    pairs = tuple((str(path), file_digest(path)) for path in sources)
    return proving.record_text(proving.Proof(results, pairs, "GNATprove 1.0", shows=shows))


def copy(home: Path, place: Path) -> Path:
    """All of it in another place, with the record of that place."""
    shutil.copytree(home, place)
    for path in (*place.glob("proof*.toml"), *(place / "records").rglob("*.toml")):
        path.write_text(path.read_text().replace(str(home), str(place)), encoding="utf-8")
    return place


def made(home: Path, *, with_record: bool = True) -> FolderTexts:
    """The evidence of what is there."""
    given = [home / "proof.toml"] if with_record else []
    found = facts.gather(home / "model.yaml", None, given, home / "results.xml")
    wanted = lists.read(home / "requirements.csv", "requirements.csv")
    return folder.make(found, wanted)


def verdicts(found: FolderTexts) -> dict[str, str]:
    """The verdict of each claim."""
    return {claim.id: claim.verdict.value for claim in found.claims}
