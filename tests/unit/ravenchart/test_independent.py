# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The independent checker agrees with every generated program, and finds what is altered."""

from __future__ import annotations

import ast
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

import ravenchart.independent
from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.timing import analyse
from ravenchart.building import checking, generation
from ravenchart.command_line import main
from ravenchart.gen.emit.program import generate
from ravenchart.gen.pipeline import load
from ravenchart.independent.check import checked
from ravenchart.independent.findings import CLASSES, Report, UnusableError
from ravenchart.paths import ROOT
from tests import house
from tests.support.answers import answered

FEATURES = sorted(path.parent.name for path in (ROOT / "tests/feature").glob("*/model.yaml"))
FOLDER = Path(ravenchart.independent.__file__).parent


def _example(name: str) -> Path:
    return ROOT / "examples" / name / "model.yaml"


def _generated(main_file: Path) -> Path:
    """The same main file, with its program beside it."""
    loaded = load(main_file)
    assert loaded.system is not None
    for name, text in generate(loaded.system, claims_of(analyse(loaded.system))).items():
        path = main_file.parent / "generated" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return main_file


# --- Agreement -----------------------------------------------------------------------


@pytest.mark.parametrize("name", house.EXAMPLES)
def test_examples_agree(name: str) -> None:
    report = checked(_example(name))
    assert report.disagreements == []
    for kind in ("digest", "tasks", "rows", "sums", "responses", "states", "targets"):
        assert report.counts[kind] > 0


@pytest.mark.parametrize("name", FEATURES)
def test_feature_models_agree(name: str, tmp_path: Path) -> None:
    folder = shutil.copytree(ROOT / "tests/feature" / name, tmp_path / name)
    model = Path(folder) / "model.yaml"
    generation.write_program(checking.check(model, deadlines=False))  # with its libraries
    assert checked(model).disagreements == []


PLATFORM = "tick: {period: 200 us, wcet: 2 us}, release: 3 us, context_switch"
BUS = "errors: {period: 20 ms, burst: 2}, driver_wcet"


@pytest.mark.parametrize(
    "edits",
    [
        [("context_switch", PLATFORM)],
        [("driver_wcet", BUS)],
        [("driver_wcet", f"buffers: priority, {BUS}")],
        [(", id: 0x100", ""), (", id: 0x101", ""), (", id: 0x110", ""), (", id: 0x111", "")],
        [("driver_wcet", "identifiers: audsley, driver_wcet"), (", id: 0x101", "")],
        [("control:\n", "control:\n    offset: 3 ms\n")],
        [("125 kbit/s", "20 kbit/s"), ("period: 50 ms}", "period: 20 ms}")],
    ],
    ids=["platform", "errors", "priority", "identifiers", "audsley", "offset", "busy"],
)
def test_variants_of_a_model_agree(edits: list[tuple[str, str]], tmp_path: Path) -> None:
    text = _example("pump").read_text(encoding="utf-8")
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    model = tmp_path / "model.yaml"
    model.write_text(text, encoding="utf-8")
    assert checked(_generated(model)).disagreements == []


SEPARATION = "block: 4, separation: 2 ms, timeout: 500 ms"
PRIORITY = "transmit_depth: 8, buffers: priority"


@pytest.mark.parametrize(
    "edits",
    [
        [],
        [(SEPARATION, "block: 1, separation: 700 us")],
        [(SEPARATION, "flow_limit: 3"), ("transmit_depth: 16", PRIORITY)],
        [("id: 0x120", "id: 0x120\n    extended: true"), ("    id: 0x130\n", "")],
        [("shutdown:", "chains:\n  told: {path: [face.show, table], reaction: 1 s}\nshutdown:")],
    ],
    ids=["as it is", "blocks", "priority", "identifiers", "chain"],
)
def test_values_in_several_frames_agree(edits: list[tuple[str, str]], tmp_path: Path) -> None:
    report = checked(_segmented(tmp_path, edits))
    assert report.disagreements == []
    assert report.counts["transfers"] > 20 and report.counts["receptions"] > 50
    assert "rows and receptions" not in " ".join(report.not_derived)


def _segmented(folder: Path, edits: list[tuple[str, str]]) -> Path:
    """A model with values in several frames, edited, and its program."""
    text = (ROOT / "tests/nodes/segmented/model.yaml").read_text(encoding="utf-8")
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    model = folder / "model.yaml"
    model.write_text(text, encoding="utf-8")
    return _generated(model)


# --- Alterations ---------------------------------------------------------------------


def _edits(name: str) -> list[Any]:
    """The alterations of a file: where, what, and how."""
    text = (ROOT / "tests/alterations" / f"{name}.yaml").read_text(encoding="utf-8")
    return [
        pytest.param(where, how, id=f"{where}: {what}")
        for where, edits in yaml.safe_load(text).items()
        for what, how in edits.items()
    ]


Json = dict[str, Any]
THREE = "three_components"


def _copied(example: str, tmp_path: Path) -> Path:
    """A copy of an example's model and program."""
    home = tmp_path / example
    kept = shutil.ignore_patterns("user", "*.adb", "*.json")
    shutil.copytree(ROOT / "examples" / example, home, ignore=kept)
    return home


def _altered(path: Path, changes: list[list[str]]) -> str:
    text = path.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text, f"{old!r} is not in {path.name}"
        text = text.replace(old, new)
    path.write_text(text, encoding="utf-8")
    return text


def _line(text: str, part: str) -> int:
    """The line at which a part of the text begins."""
    return text[: text.index(part)].count("\n") + 1


def _is_found(home: Path, path: Path, how: Json) -> None:
    """An alteration of a file is found in that file, at its line or that before (`when ... =>`)."""
    text = _altered(path, how["change"])
    found = checked(home / "model.yaml").disagreements
    assert found
    assert all(str(one).startswith(f"{path}:{one.line}: ") for one in found)
    part = how.get("at") or how["change"][0][1]
    first = _line(text, part)
    lines = {one.line for one in found}
    assert lines & set(range(first - 1, first + part.count("\n") + 1)), list(map(str, found))


@pytest.mark.parametrize(("example", "how"), _edits("certificate"))
def test_an_alteration_of_a_certificate_is_found(example: str, how: Json, tmp_path: Path) -> None:
    home = _copied(example, tmp_path)
    (path,) = (home / "generated").glob("*-timing_certificate.ads")
    _is_found(home, path, how)


@pytest.mark.parametrize(("file", "how"), _edits("chart"))
def test_an_alteration_of_a_chart_is_found(file: str, how: Json, tmp_path: Path) -> None:
    home = _copied("pump", tmp_path)
    _is_found(home, home / "generated" / file, how)


@pytest.mark.parametrize(("example", "how"), _edits("model"))
def test_an_edit_of_the_model_is_found(example: str, how: Json, tmp_path: Path) -> None:
    home = _copied(example, tmp_path)
    _altered(home / "model.yaml", how["change"])
    found = checked(home / "model.yaml").disagreements
    assert {how["kind"], "digest"} <= {one.kind for one in found}
    assert all(Path(one.file).is_file() and one.line >= 1 for one in found)


@pytest.mark.slow
def test_each_number_of_a_certificate_is_found_when_it_is_altered(tmp_path: Path) -> None:
    home = _copied(THREE, tmp_path)
    path = home / "generated/three_components-timing_certificate.ads"
    text = path.read_text(encoding="utf-8")
    numbers = list(re.finditer(r"^   (\w+) : constant :=", text, re.MULTILINE))
    assert len(numbers) > 80
    for one in numbers:
        path.write_text(f"{text[: one.end()]} 1 + {text[one.end() :]}", encoding="utf-8")
        lines = {item.line for item in checked(home / "model.yaml").disagreements}
        assert _line(text, one[0]) in lines, one[1]


def test_each_number_of_a_transfer_is_found_when_it_is_altered(tmp_path: Path) -> None:
    model = _segmented(tmp_path, [])
    path = tmp_path / "generated/sensor/segmented-timing_certificate.ads"
    text = path.read_text(encoding="utf-8")
    wanted = r"^   (\w+_(?:Turn\w*|Handed|Row|Round_Trip|Transfer|Renewal|Timeout)) : constant :="
    numbers = [m for m in re.finditer(wanted, text, re.MULTILINE) if "Table" in m[1]]
    assert len(numbers) == 15
    for one in numbers:
        path.write_text(f"{text[: one.end()]} 1 + {text[one.end() :]}", encoding="utf-8")
        lines = {item.line for item in checked(model).disagreements}
        assert _line(text, one[0]) in lines, one[1]


@pytest.mark.parametrize(
    ("old", "new", "part"),
    [
        ("block: 4", "block: 5", "Line_Table_Transfer :"),
        ("separation: 2 ms", "separation: 5 ms", "Line_Table_T :"),
        ("timeout: 500 ms", "timeout: 600 ms", "Line_Table_Timeout :"),
        ("timeout: 500 ms", "timeout: 10 ms", "Line_Table_Timeout :"),
        ("flow_id: 0x131", "flow_id: 0x132", "Line_Table_Flow_Id :"),
        ("port_region: {period: 5 ms", "port_region: {period: 10 ms", "Line_Table_Flow_T :"),
        ("t30: Word\n", "t30: Byte\n", "Line_Table_Transfer :"),
    ],
)
def test_an_edit_of_a_transfer_is_found(old: str, new: str, part: str, tmp_path: Path) -> None:
    model = _segmented(tmp_path, [])
    text = model.read_text(encoding="utf-8")
    assert old in text
    if "Byte" in new:  # 57 bytes have one frame fewer
        for number in range(24, 31):
            text = text.replace(f"t{number}: Word", f"t{number}: Byte")
    model.write_text(text.replace(old, new), encoding="utf-8")
    path = tmp_path / "generated/sensor/segmented-timing_certificate.ads"
    line = _line(path.read_text(encoding="utf-8"), part)
    assert line in {one.line for one in checked(model).disagreements if one.kind != "digest"}


def test_each_state_in_a_declared_form_is_found_when_it_is_altered(tmp_path: Path) -> None:
    home = _copied("qhsmtst", tmp_path)
    path = home / "generated/qhsm_test-qhsm-chart.ads"
    text = path.read_text(encoding="utf-8")
    begin, end = text.index("function In_Source"), text.index("type Variables")
    names = [m for m in re.finditer(r"Chart_States\.(\w+)", text) if begin < m.end() < end]
    places = [m for m in names if m[1] not in ("Leaf", "Configuration")]
    assert len(places) > 10
    for one in places:
        other = next(m[1] for m in places if m[1] != one[1])
        path.write_text(f"{text[: one.start(1)]}{other}{text[one.end(1) :]}", encoding="utf-8")
        assert checked(home / "model.yaml").disagreements, _line(text, one[0])


# --- What it does not do -------------------------------------------------------------


def test_what_is_not_derived_is_said() -> None:
    lines = checked(_example("two_nodes")).lines()
    said = [line for line in lines if line.startswith("not derived: ")]
    assert any("chains from end to end: " in line for line in said)
    assert any("effects" in line for line in said) and any("share" in line for line in said)


def test_each_class_has_a_line() -> None:
    report = checked(_example(THREE))
    lines = report.lines()
    assert [line.rpartition(": ")[0] for line in lines[: len(CLASSES)]] == list(CLASSES.values())
    assert "buses: bit rates, bit times, errors: none in this model" in lines
    total = sum(report.counts.values())
    assert lines[-1] == f"model, charts and certificate agree in {total} comparisons"


def test_commands_between_nodes_are_refused_and_not_passed() -> None:
    model = ROOT / "tests/nodes/commands/model.yaml"
    with pytest.raises(UnusableError, match=r"model\.yaml:\d+: commands between nodes are not"):
        checked(model)


def test_a_program_that_is_not_there_is_no_agreement(tmp_path: Path) -> None:
    model = Path(shutil.copy(_example(THREE), tmp_path))
    with pytest.raises(UnusableError, match="generate the program first"):
        checked(model)
    assert main(["check-certificate", str(model)]) == 2


def test_text_that_cannot_be_read_is_no_agreement(tmp_path: Path) -> None:
    home = _copied(THREE, tmp_path)
    for path in (home / "model.yaml", home / "generated/three_components-station-handling.ads"):
        text = path.read_text(encoding="utf-8")
        for end in range(0, len(text), 800):
            path.write_text(text[:end], encoding="utf-8")
            try:
                assert checked(home / "model.yaml").disagreements
            except UnusableError as problem:
                assert str(home) in str(problem)
        path.write_text(text, encoding="utf-8")
    assert checked(home / "model.yaml").agrees


# --- The two command lines -----------------------------------------------------------


def test_the_command_reports_and_ends_with_the_verdict(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    home = _copied(THREE, tmp_path)
    answer = answered(capsys, "check-certificate", home / "model.yaml")
    assert answer["result"]["agrees"] is True and answer["diagnostics"] == []
    certificate = home / "generated/three_components-timing_certificate.ads"
    _altered(certificate, [["Two_Work_Phase : constant := 0", "Two_Work_Phase : constant := 1"]])
    answer = answered(capsys, "check-certificate", home / "model.yaml", status=1)
    assert answer["result"]["agrees"] is False
    assert {one["file"] for one in answer["diagnostics"]} == {str(certificate)}
    assert all(one["line"] > 1 for one in answer["diagnostics"])


def test_a_copy_of_the_folder_works_without_ravenchart(tmp_path: Path) -> None:
    shutil.copytree(FOLDER, tmp_path / "independent")
    (tmp_path / "yaml").symlink_to(Path(yaml.__file__).parent)

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-S", *words]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)

    assert run("-c", "import ravenchart").returncode == 1
    done = run("-m", "independent", str(_example(THREE)), "--json")
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["agrees"] is True
    home = _copied(THREE, tmp_path / "altered")
    _altered(home / "model.yaml", [["wcet: 50 us", "wcet: 60 us"]])
    done = run("-m", "independent", str(home / "model.yaml"))
    assert done.returncode == 1 and "certificate.ads:" in done.stderr
    assert run("-m", "independent", "none.yaml").returncode == 2


def test_it_imports_the_standard_library_and_pyyaml_alone() -> None:
    for path in FOLDER.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.level == 0:
                names = [node.module or ""]
            elif isinstance(node, ast.ImportFrom):
                assert node.level == 1, path
                continue
            else:
                names = [n.name for n in node.names] if isinstance(node, ast.Import) else []
            for name in names:
                assert name.partition(".")[0] in {*sys.stdlib_module_names, "yaml"}, path


def test_a_report_counts_each_comparison() -> None:
    report = Report()
    report.agree("tasks", Path("a.ads"), 3, True, "")
    report.agree("tasks", Path("a.ads"), 4, False, "R is 2")
    assert report.counts["tasks"] == 2 and not report.agrees
    assert str(report.disagreements[0]) == "a.ads:4: R is 2"
