# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A folder of evidence never says more than the facts: each claim falls when its grounds do."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import jsonschema
import pytest

from ravenchart.behaviour import rules
from ravenchart.command_line import main
from ravenchart.evidence import facts, folder, ledger, records, standards
from ravenchart.evidence.claim import ClaimKind
from ravenchart.gen.diagnostics import warning
from ravenchart.paths import ROOT
from ravenchart.tools.kept import file_digest
from tests.support import evidence
from tests.support.evidence import made, verdicts

PROVED = ("program", "chart-Valve.Motion", "activities-Valve.flows", "codecs")
TIMED = (
    *("deadline-reception", "deadline-work", "deadline-line.level_in", "deadline-line.opening_out"),
    *("chain-reaction", "queues"),
)
USERS = ("activities-Valve.activities",)
ENDS = ("termination",)
GOOD = ("met", "partly")
ENDING = "proof-termination.toml"
RUNTIME_RECORD = "records/gnat-12/runtime-slcan.toml"


def _edit(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text, (path, old)
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def _append(path: Path) -> None:
    path.write_bytes(path.read_bytes() + b"--  edited\n")


def test_everything_that_is_shown_is_met(home: Path) -> None:
    found = made(home)
    assert {id_: v for id_, v in verdicts(found).items() if v != "met"} == {
        "activities-Valve.activities": "partly",
        "runtime-loopback": "partly",
        "runtime-slcan": "partly",
        "stack-reception": "user's",
        "stack-work": "user's",
    }
    assert found.findings == ()
    assert {*PROVED, *TIMED, *USERS, *ENDS} <= verdicts(found).keys()


# --- Sabotage --------------------------------------------------------------------

GENERATED = "generated/valve_house"
Spoil = Callable[[Path], None]


def _model(old: str, new: str) -> Spoil:
    return lambda home: _edit(home / "model.yaml", old, new)


def _record(old: str, new: str) -> Spoil:
    return lambda home: _edit(home / "proof.toml", old, new)


def _program_for_ending(home: Path) -> None:
    (home / ENDING).write_bytes((home / "proof.toml").read_bytes())


def _ending(old: str, new: str) -> Spoil:
    return lambda home: _edit(home / ENDING, old, new)


def _without(pattern: str, name: str = "proof.toml") -> Spoil:
    def spoil(home: Path) -> None:
        path = home / name
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
        kept = [line for line in lines if not re.search(pattern, line)]
        assert len(kept) < len(lines)
        path.write_text("".join(kept), encoding="utf-8")

    return spoil


def _foreign_body(home: Path) -> None:
    (home / "generated" / "valve_house-more.ads").write_text("package Valve_House.More is end;\n")


def _cut(home: Path) -> None:
    text = (home / "proof.toml").read_text(encoding="utf-8")
    (home / "proof.toml").write_text(text[:200], encoding="utf-8")


ALL = (*PROVED, *USERS, *TIMED)
CASES: dict[str, tuple[Spoil, tuple[str, ...]]] = {
    "model: a wcet": (_model("wcet: 30 us", "wcet: 31 us"), ("generated", *ALL, *ENDS)),
    "model: a time-out": (_model("after: 1 s", "after: 2 s"), ("generated", *ALL)),
    "model: a missed deadline": (
        _model("wcet: 30 us", "wcet: 9999 us"),
        ("generated", "deadline-work", *ALL),
    ),
    "model: a limit that is not kept": (
        _model("reaction: 90 ms", "reaction: 9 ms"),
        ("generated", "chain-reaction"),
    ),
    "model: a comment": (_model("system:", "# another text\nsystem:"), ("generated", *ALL)),
    "code: a chart": (
        lambda home: _append(home / f"{GENERATED}-valve-motion.adb"), ("generated", *ALL, *ENDS),
    ),
    "code: a codec": (lambda home: _append(home / f"{GENERATED}-codecs.ads"), ("generated", *ALL)),
    "code: the project": (lambda home: _append(home / f"{GENERATED}.gpr"), ("generated", *ALL)),
    "code: a file is gone": (
        lambda home: (home / f"{GENERATED}-codecs.adb").unlink(), ("generated", *ALL),
    ),
    "code: a file too many": (_foreign_body, ("generated", *ALL, *ENDS)),
    "certificate": (
        lambda home: _append(home / f"{GENERATED}-timing_certificate.ads"),
        ("generated", *TIMED),
    ),
    "trace map": (
        lambda home: _edit(home / "generated/trace.json", '"id": 1', '"id": 7'),
        ("generated", *PROVED),
    ),
    "user's body": (
        lambda home: _append(home / "user/valve_house-valve-activities.adb"), (*ALL, *ENDS),
    ),
    "record: an unproved check": (_record("proved = 10", "proved = 9"), ALL),
    "record: more checks than proofs": (_record("checks = 10", "checks = 11"), ALL),
    "record: a justified check": (_record("justified = 0", "justified = 1"), ALL),
    "record: an assumption": (_record("assumed = 0", "assumed = 1"), ALL),
    "record: no checks": (_record("checks = 10\nproved = 10", "checks = 0\nproved = 0"), ALL),
    "record: more in the parts than in the sum": (
        _record("{ checks = 2,", "{ checks = 200,"), ALL,
    ),
    "record: a digest": (
        lambda home: _edit(home / "proof.toml", _digest(home), "0" * 64), ALL,
    ),
    "record: a source is missing": (_without(r"motion\.adb\" ="), ALL),
    "record: the user's body is missing": (_without(r"activities\.adb\" ="), ALL),
    "record: the chart is not in it": (_without(r"Motion\.Fire"), ("chart-Valve.Motion",)),
    "record: the codecs are not in it": (_without(r"Codecs\.Type"), ("codecs",)),
    "record: the certificate is not in it": (_without(r"^\"Valve_House\.Timing"), TIMED),
    "record: outside SPARK without a reason": (
        _record("outside = []", 'outside = ["Valve_House.Valve.Motion.Fire"]'), ("program",),
    ),
    "record: cut off": (_cut, ALL),
    "record: a number is text": (_record("checks = 10", 'checks = "10"'), ALL),
    "termination: an unproved check": (_ending("proved = 18", "proved = 17"), ENDS),
    "termination: a row is not in it": (_without(r"Of_Work\.Valve_1_Look", ENDING), ENDS),
    "termination: the table is not in it": (_without(r"Of_Work\.Table", ENDING), ENDS),
    "termination: a digest": (
        lambda home: _edit(home / ENDING, _digest(home), "0" * 64), ENDS,
    ),
    "termination: the record of the program in its place": (_program_for_ending, ENDS),
    "termination: no record": (lambda home: (home / ENDING).unlink(), ENDS),
    "runtime: a source": (
        lambda home: _append(home / "runtime.ads"), ("runtime-loopback", "runtime-slcan"),
    ),
    "runtime: outside SPARK without a reason": (
        lambda home: _edit(home / RUNTIME_RECORD, "Tcp_Sockets", "Other_Sockets"),
        ("runtime-slcan",),
    ),
    "tests: one failed": (
        lambda home: _edit(home / "results.xml", "</testcase>", "<failure/></testcase>"),
        ("tests",),
    ),
}  # fmt: skip
"""What is spoilt, and claims that may then no longer be met, not even partly."""


def _digest(home: Path) -> str:
    found = tomllib.loads((home / "proof.toml").read_text(encoding="utf-8"))["sources"]
    return str(next(iter(found.values())))


@pytest.mark.parametrize("case", CASES)
def test_a_claim_falls_with_its_grounds(home: Path, case: str) -> None:
    spoil, concerned = CASES[case]
    spoil(home)
    found = made(home)
    now = verdicts(found)
    assert {id_: now[id_] for id_ in concerned if now[id_] in GOOD} == {}
    # the pages and the files for programs say so too
    data = json.loads(found.texts[folder.DATA])
    told = {one["id"]: one["verdict"] for one in data["claims"]}
    results = json.loads(found.texts[folder.SARIF])["runs"][0]["results"]
    first = {gap["what"] for gap in data["not_shown"] if gap["kind"] == "claim"}
    for id_ in concerned:
        assert told[id_] not in GOOD and id_ in first
        assert any(one["message"]["text"].startswith(f"{id_} is not") for one in results)
        assert f'<a href="#claim-{id_}">' in found.texts[folder.INDEX]
        row = found.texts[folder.INDEX].partition(f'id="claim-{id_}"')[2].partition("</tr>\n")[0]
        assert '<span class="bad">' in row


def test_without_a_record_proofs_are_not_shown_and_bounds_only_partly(home: Path) -> None:
    found = verdicts(made(home, with_record=False))
    assert {found[id_] for id_ in (*PROVED, *USERS)} == {"not shown"}
    assert {found[id_] for id_ in TIMED} == {"partly"}
    assert found["generated"] == "met"


def test_a_record_with_another_driver_shows_nothing(home: Path) -> None:
    given = [home / "proof.toml"]
    found = facts.gather(home / "model.yaml", "socketcan", given, home / "results.xml")
    assert verdicts(folder.make(found))["program"] == "not met"


def test_without_records_of_the_runtime_it_is_not_shown(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(records, "RECORDS", home / "nowhere")
    assert verdicts(made(home))["runtime"] == "not shown"


def test_a_skipped_test_is_named(home: Path) -> None:
    _edit(home / "results.xml", "</testcase>", '<skipped message="no bus"/></testcase>')
    found = made(home)
    assert verdicts(found)["tests"] == "partly"
    assert any("no bus" in gap.why for gap in found.evidence.not_shown)
    assert "RV-1405" in {one.code for one in found.findings}


def test_what_is_outside_spark_with_a_reason_is_partly_shown(home: Path) -> None:
    name = "Valve_House.Valve.Activities.Look"
    evidence.record(home, [u for u in evidence.UNITS if u != name], [name])
    (home / "outside_spark.toml").write_text(f'"{name}" = "reads a register"\n')
    found = made(home)
    assert verdicts(found)["program"] == "partly"
    assert ("outside", name) in {(gap.kind, gap.what) for gap in found.evidence.not_shown}


def test_an_invariant_that_cannot_be_excluded_is_not_met(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        rules,
        "findings",
        lambda system, _: (
            warning("RV-1109", system.components[0].invariants[0].origin, "it may happen"),
        ),
    )
    _edit(home / "model.yaml", "system:", "# no result is kept of this either\nsystem:")
    assert verdicts(made(home))["never-Valve.full"] == "not met"


def test_a_behaviour_that_is_not_checked_to_the_end_is_not_shown(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        rules,
        "findings",
        lambda system, _: (warning("RV-1110", system.components[0].origin, "not finished"),),
    )
    _edit(home / "model.yaml", "system:", "# no result is kept of this\nsystem:")
    found = verdicts(made(home))
    assert found["never-Valve.full"] == found["behaviour-rules"] == "not shown"


# --- Requirements ----------------------------------------------------------------

TRACES: dict[str, tuple[Spoil, set[str]]] = {
    "list: an id is gone": (
        lambda home: _edit(home / "requirements.csv", "R-3,Never full\n", ""), {"RV-1404"},
    ),
    "list: an id is new": (
        lambda home: _edit(home / "requirements.csv", "R-3,", "R-9,x\nR-3,"),
        {"RV-1403", "RV-1405"},
    ),
    "model: nobody names it": (_model("{req: [R-1], from", "{from"), {"RV-1403"}),
    "scenario: nobody tests it": (
        lambda home: _edit(home / "scenario.yaml", ", req: [R-2]", ""), {"RV-1405"},
    ),
    "scenario: an unknown id": (
        lambda home: _edit(home / "scenario.yaml", "[R-2]", "[R-2, R-7]"), {"RV-1404"},
    ),
    "tests: the test of it failed": (
        lambda home: _edit(home / "results.xml", "</testcase>", "<error/></testcase>"),
        {"RV-1405"},
    ),
    "record: what proves it is gone": (_record("proved = 10", "proved = 9"), {"RV-1406"}),
}  # fmt: skip


@pytest.mark.parametrize("case", TRACES)
def test_a_gap_in_traceability_is_a_finding(home: Path, case: str) -> None:
    spoil, codes = TRACES[case]
    spoil(home)
    found = made(home)
    assert codes <= {one.code for one in found.findings}
    rows = [row for one in found.evidence.standards for row in one.objectives]
    traced = [row for row in rows if "traceability of requirements" in row.claims]
    assert traced and {row.status for row in traced} == {"not met"}
    for code in codes:
        assert code in found.texts[folder.INDEX]


def test_requirements_are_traced_both_ways(home: Path) -> None:
    found = made(home).evidence
    assert found.requirements is not None
    rows = {one.id: one for one in found.requirements}
    assert rows["R-1"].elements == ["Valve.Motion.lost"]
    assert "chart-Valve.Motion" in rows["R-1"].claims
    assert rows["R-1"].code == [f"{GENERATED}-valve-motion.ad{end}" for end in "bs"]
    assert [one.outcome for one in rows["R-1"].tests] == ["passed"]
    assert rows["R-2"].claims == ["chain-reaction"]
    assert [one.outcome for one in rows["R-2"].tests] == ["result not given"]
    assert rows["R-3"].claims == ["code-never-Valve.full", "never-Valve.full"]
    back = {one.element: one.requirements for one in found.elements}
    assert back == {"Valve.Motion.lost": ["R-1"], "Valve.full": ["R-3"], "reaction": ["R-2"]}
    named = {one.id: one.requirements for one in found.claims if one.requirements}
    assert named["chart-Valve.Motion"] == ["R-1"] and named["chain-reaction"] == ["R-2"]


def test_requirement_ids_change_no_generated_file_but_for_the_digest(home: Path) -> None:
    before = {path.name: path.read_text() for path in (home / "generated").iterdir()}
    _edit(home / "model.yaml", "{req: [R-2], path", "{path")
    assert main(["generate", str(home / "model.yaml")]) == 0
    digests = re.compile("[0-9a-f]{64}")
    for path in (home / "generated").iterdir():
        assert digests.sub("", path.read_text()) == digests.sub("", before[path.name]), path


# --- The folder ------------------------------------------------------------------


class _Links(HTMLParser):
    """What a page links to, and the ids that it has."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.ids: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name in ("href", "src") and value:
                self.links.append(value)
            elif name == "id" and value:
                self.ids.append(value)


def _written(home: Path, *more: str) -> int:
    words = ["--record", str(home / "proof.toml"), "--tests", str(home / "results.xml")]
    return main(["evidence", str(home / "model.yaml"), *words, *more])


@pytest.mark.slow
def test_the_folder_is_whole_and_the_same_wherever_it_is_made(
    base: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    texts = []
    for name in ("one", "two"):
        place = evidence.copy(base, tmp_path / name)
        monkeypatch.setattr(records, "RECORDS", place / "records")
        monkeypatch.chdir(place if name == "two" else tmp_path)
        model = place if name == "one" else Path(".")
        assert _written(model, "--requirements", str(model / "requirements.csv")) == 0
        out = place / "evidence"
        texts.append({path.name: path.read_bytes() for path in out.iterdir()})
        page = _Links((out / "index.html").read_text(encoding="utf-8"))
        assert len(page.ids) == len({*page.ids})
        lost = [
            link
            for link in page.links
            if not (link[1:] in page.ids if link.startswith("#") else (out / link).is_file())
        ]
        assert lost == [] and len(page.links) > 30
    assert texts[0] == texts[1]
    for name, content in texts[0].items():
        assert str(tmp_path).encode() not in content, name
        assert not re.search(rb"(src|href)=\"(https?:)?//", content), name
    assert b"<h1>Valve_House</h1>" in texts[0]["timing.html"]


def test_the_json_is_as_its_schema_says(home: Path) -> None:
    schema = json.loads((ROOT / "docs" / "evidence.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(json.loads(made(home).texts[folder.DATA]), schema)


def test_sarif_and_sbom_have_what_their_formats_require(home: Path) -> None:
    _edit(home / "requirements.csv", "R-3,", "R-9,x\nR-3,")
    texts = made(home).texts
    log = json.loads(texts[folder.SARIF])
    (run,) = log["runs"]
    rules = {rule["id"] for rule in run["tool"]["driver"]["rules"]}
    assert log["version"] == "2.1.0" and run["results"]
    for result in run["results"]:
        assert result["ruleId"] in rules
        assert result["level"] in ("error", "warning", "note") and result["message"]["text"]
        for place in result.get("locations", ()):
            assert place["physicalLocation"]["region"]["startLine"] >= 1
    bill = json.loads(texts[folder.SBOM])
    assert (bill["bomFormat"], bill["specVersion"], bill["version"]) == ("CycloneDX", "1.6", 1)
    refs = [bill["metadata"]["component"]["bom-ref"]]
    refs += [one["bom-ref"] for one in bill["components"]]
    assert len(refs) == len({*refs})
    assert {ref for one in bill["dependencies"] for ref in one["dependsOn"]} <= {*refs}
    files = {one["name"]: one for top in bill["components"] for one in top.get("components", ())}
    body = "user/valve_house-valve-activities.adb"
    assert files[body]["hashes"][0]["content"] == file_digest(home / body)


def test_the_tree_shows_each_claim_with_its_verdict(home: Path) -> None:
    found = made(home)
    words = " ".join(ElementTree.fromstring(found.texts[folder.TREE]).itertext())
    words = re.sub(r"\s+", " ", words)
    for id_, verdict in verdicts(found).items():
        assert f"{id_}: {verdict}" in words


def test_an_earlier_folder_goes_when_the_model_has_errors(
    home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _written(home) == 0
    (home / "evidence" / "mine.txt").write_text("kept")
    # by this the excluded does happen, so the model is refused
    _edit(home / "model.yaml", "reads: [level]}", "reads: [level], writes: [seen]}")
    assert _written(home) == 1
    assert f"{home / 'model.yaml'}:" in capsys.readouterr().err
    assert [path.name for path in (home / "evidence").iterdir()] == ["mine.txt"]


def test_the_command_says_what_is_not_shown(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["evidence", str(home / "model.yaml"), "--json"]) == 1
    result = json.loads(capsys.readouterr().out)["result"]
    assert result["claims"]["not shown"] == 8
    words = ["--record", str(home / "proof.toml"), "--tests", str(home / "results.xml")]
    call = ["requirements", str(home / "model.yaml"), str(home / "requirements.csv"), *words]
    assert main(call) == 0
    shown = capsys.readouterr().out
    assert "  element Valve.Motion.lost (transition, model.yaml:" in shown
    assert shown.endswith("3 requirements, 0 findings\n")
    assert main(call[:3]) == 1
    assert "RV-1406" in capsys.readouterr().err


def test_no_word_of_a_verdict_is_better_than_the_worst_claim() -> None:
    assert standards.status("met", ["met", "partly"]) == "partly"
    assert standards.status("met", ["met", "user's"]) == "partly"
    assert standards.status("met", ["met", "met"]) == "met"
    assert standards.status("partly", ["met"]) == "partly"
    assert standards.status("partly", ["met", "not met"]) == "not met"
    assert standards.status("user's", ["met"]) == "user's"


def test_every_row_of_a_standard_names_kinds_of_claims_that_exist() -> None:
    rows = [row for one in standards.standards((), None) for row in one.objectives]
    assert len(rows) > 40 and {row.status for row in rows} <= {"user's", "partly", "not met"}
    text = (ROOT / "ravenchart" / "evidence" / "objectives.toml").read_text(encoding="utf-8")
    for one in tomllib.loads(text)["standard"]:
        for row in one["rows"]:
            assert {*row["claims"]} <= {*ClaimKind.__members__, standards.REQUIREMENTS}


def test_an_entry_of_the_ledger_that_nobody_knows_is_in_use() -> None:
    known = {one.id for one in ledger.entries()}
    assert {*ledger.WHERE} <= known and len(known) >= 18
    for one in known - {*ledger.WHERE}:
        assert one not in ("ASM-007", "ASM-017")


def test_the_ledger_shows_what_the_driver_and_the_devices_touch(home: Path) -> None:
    found = {gap.what for gap in made(home).evidence.not_shown if gap.kind == "assumption"}
    assert {"ASM-001", "ASM-005", "ASM-012"} <= found
    assert not found & {"ASM-007", "ASM-010", "ASM-011", "ASM-013", "ASM-015", "ASM-018"}


def test_every_fault_of_the_matrix_is_in_the_folder(home: Path) -> None:
    text = (ROOT / "docs" / "faults.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("| ")]
    assert len(made(home).evidence.faults) == len(rows) - 2


def _with_contract(home: Path) -> None:
    contract = "requires: fresh(level) or stale(level), ensures: noted = level"
    seen = "seen: {type: Level, initial: 0}"
    _edit(home / "model.yaml", seen, f"{seen}, noted: {{type: Level, initial: 0}}")
    old = "body: user, reads: [level]"
    _edit(home / "model.yaml", old, f"{old}, writes: [noted], {contract}")
    assert main(["generate", str(home / "model.yaml")]) == 0


def test_each_side_of_a_contract_is_a_claim(home: Path) -> None:
    """What is required is shown by the instances, and what is ensured by the body."""
    _with_contract(home)
    evidence.record(home, (*evidence.UNITS, "Valve_House.Valve_1.Run_Look"))
    found = made(home)
    verdict = verdicts(found)
    for side in ("requires", "ensures"):
        assert verdict[f"{side}-Valve.look"] == "met"
    assert verdict["activities-Valve.activities"] == "met"
    evidence.record(home)
    assert verdicts(made(home))["requires-Valve.look"] == "not met"
    evidence.record(home, [one for one in evidence.UNITS if not one.endswith("Look")])
    assert verdicts(made(home))["ensures-Valve.look"] == "not met"
