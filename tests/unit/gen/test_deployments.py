# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Deployments: named alternatives of one model, each with a program of its own."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from ravenchart.building import checking, generation, programs
from ravenchart.command_line import main
from ravenchart.gen.files.load import deployments_of
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.independent.check import checked as judged
from ravenchart.independent.findings import UnusableError
from ravenchart.language_server import model as editor
from ravenchart.language_server.completing import proposals
from ravenchart.paths import ROOT

HEATER = ROOT / "tests/deployments/heater"
TEXTS = {path.name: path.read_text(encoding="utf-8") for path in HEATER.glob("*.yaml")}
NAMED = "deployments: {bench: bench.yaml, target: target.yaml}\n"


def loaded(path: str, **texts: str) -> Loaded:
    """The heater with other texts of its files, by their names without ending."""
    files = {**TEXTS, **{f"{name}.yaml": text for name, text in texts.items()}}

    def read(file: Path, limit: int) -> bytes:
        if file.name not in files:
            raise FileNotFoundError(2, "No such file or directory")
        return files[file.name].encode()[:limit]

    return load(Path(path), read)


@pytest.fixture
def heater(tmp_path: Path) -> Path:
    return Path(shutil.copytree(HEATER, tmp_path / "heater")) / "model.yaml"


# --- What is read


def test_a_deployment_is_the_model_with_its_file() -> None:
    bench, target = (loaded(f"model.yaml@{name}").system for name in ("bench", "target"))
    assert bench is not None and target is not None
    assert [one.name for one in bench.instances] == ["controller_1", "kettle_1"]
    assert [one.name for one in target.messages] == ["measured", "heat"]
    assert (bench.deployment, target.deployment) == ("bench", "target")
    assert bench.digest != target.digest
    upper = loaded("model.yaml@BENCH").system
    assert upper is not None and upper.deployment == "bench"


def test_a_path_without_a_deployment_is_that_of_a_model_without_any() -> None:
    plain = TEXTS["model.yaml"].replace(NAMED, "include: [bench.yaml]\n")
    found = loaded("model.yaml", model=plain).system
    assert found is not None and found.deployment is None


@pytest.mark.parametrize(
    ("path", "edit", "code", "message", "hint"),
    [
        ("model.yaml", NAMED, "RV-0809",
         "the model has deployments, and none is chosen: bench, target",
         "choose one: `model.yaml@bench`"),
        ("model.yaml@bank", NAMED, "RV-0305", "there is no deployment named `bank`",
         "one of: bench, target"),
        ("model.yaml@benhc", NAMED, "RV-0305", "there is no deployment named `benhc`",
         "did you mean `bench`?"),
        ("model.yaml@bench", "", "RV-0305", "there is no deployment named `bench`",
         "add it: `deployments: {bench: FILE}`"),
        ("model.yaml@bench", "deployments: {bench: bank.yaml}\n", "RV-0101",
         "cannot read bank.yaml: no such file or directory", None),
        ("model.yaml@bench", "deployments: {bench: model.yaml}\n", "RV-0112",
         "model.yaml includes itself", "remove this `include`"),
        ("model.yaml@bench", "deployments: {bench: bench.yaml, Bench: target.yaml}\n", "RV-0303",
         "a second deployment is named `Bench`, like `bench`: case does not count",
         "rename one of them"),
        ("model.yaml@bench", "deployments: {2nd: bench.yaml}\n", "RV-0301",
         "`2nd` is not a name: letters, digits and single underscores, first a letter, last no "
         "underscore", None),
        ("model.yaml@bench", "deployments: [bench.yaml]\n", "RV-0203",
         "`deployments` must be a mapping, not a list", None),
    ],
)  # fmt: skip
def test_an_error_of_deployments_stands_in_their_line(
    path: str, edit: str, code: str, message: str, hint: str | None
) -> None:
    text = TEXTS["model.yaml"].replace(NAMED, edit)
    found = [one for one in loaded(path, model=text).diagnostics if one.is_error]
    first = next(one for one in found if one.code == code)
    assert (first.message, first.hint) == (message, hint)
    assert first.origin.file == "model.yaml"
    assert first.origin.line == (2 if edit else 1)


def test_what_the_common_part_lacks_is_no_error_before_a_deployment_is_chosen() -> None:
    assert [one.code for one in loaded("model.yaml").diagnostics] == ["RV-0809"]


def test_an_error_in_the_file_of_a_deployment_stands_there() -> None:
    text = TEXTS["bench.yaml"].replace("kettle_1.heat}", "kettle_1.hot}")
    (found,) = [one for one in loaded("model.yaml@bench", bench=text).diagnostics if one.is_error]
    assert str(found.origin).startswith("bench.yaml:5:")
    assert found.code == "RV-0305"
    assert loaded("model.yaml@target", bench=text).system is not None


def test_only_the_main_file_has_deployments() -> None:
    text = f"{TEXTS['bench.yaml']}deployments: {{inner: other.yaml}}\n"
    (found,) = loaded("model.yaml@bench", bench=text).diagnostics
    assert (found.code, found.message) == ("RV-0803", "only the main file has deployments")
    assert found.origin.file == "bench.yaml"


# --- Programs


def test_each_deployment_has_a_program_below_generated_and_shares_the_user_folder(
    heater: Path,
) -> None:
    made = {path.name: checking.check(path) for path in deployments_of(heater)}
    assert list(made) == ["model.yaml@bench", "model.yaml@target"]
    for one in made.values():
        generation.write_program(one)
    bench, target = made.values()
    assert bench.generated == heater.parent / "generated/bench"
    assert target.generated == heater.parent / "generated/target"
    assert not (bench.generated / "heater-field.ads").exists()
    assert (target.generated / "heater-field.ads").is_file()
    component = "heater-controller-flows.adb"
    assert (bench.generated / component).read_text() == (target.generated / component).read_text()
    project = (bench.generated / "heater.gpr").read_text()
    assert '"../../build"' in project
    homes = [programs.programs_of(one)[0].home("loopback") for one in made.values()]
    assert homes[0] != homes[1]
    before = (bench.generated / "heater.gpr").stat().st_mtime_ns
    assert generation.write_program(target).changed == 0
    assert (bench.generated / "heater.gpr").stat().st_mtime_ns == before


def test_a_body_of_the_user_is_found_from_each_deployment(tmp_path: Path) -> None:
    text = (ROOT / "tests/feature/composites/model.yaml").read_text(encoding="utf-8")
    common, mark, rest = text.partition("nodes:\n")
    (tmp_path / "model.yaml").write_text(f"{common}deployments: {{one: one.yaml}}\n")
    (tmp_path / "one.yaml").write_text(mark + rest)
    shutil.copytree(ROOT / "tests/feature/composites/user", tmp_path / "user")
    checked = checking.check(tmp_path / "model.yaml@one")
    generation.write_program(checked)
    home = tmp_path / "generated/one"
    project = (home / "composites_feature.gpr").read_text()
    assert '"../../user' in project and '"../user' not in project


@pytest.mark.slow
def test_both_programs_of_a_model_with_deployments_build(heater: Path) -> None:
    for path in deployments_of(heater):
        checked = checking.check(path)
        generation.write_program(checked)
        assert programs.programs_of(checked)[0].build().is_file()


# --- Commands


def test_check_all_checks_each_deployment(heater: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--all", str(heater)]) == 0
    assert capsys.readouterr().out == (
        "--- model.yaml@bench ---\n"
        "Heater: 2 instances on 1 processor, 0 messages; every deadline is met\n"
        "--- model.yaml@target ---\n"
        "Heater: 1 instance on 2 processors, 2 messages; every deadline is met\n"
    )


def test_check_all_reports_an_error_of_one_and_checks_the_others(
    heater: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bench = heater.parent / "bench.yaml"
    bench.write_text(bench.read_text().replace("kettle_1.heat}", "kettle_1.hot}"))
    assert main(["check", "--all", str(heater)]) == 1
    said = capsys.readouterr()
    assert "bench.yaml:5:" in said.out and "[RV-0305]" in said.out
    assert "Heater: 1 instance on 2 processors" in said.out
    assert "1 of 2 deployments have errors: model.yaml@bench" in said.err


def test_check_all_says_once_what_is_wrong_in_all(
    heater: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    heater.write_text(heater.read_text().replace("send: heat", "send: hot"))
    assert main(["check", "--all", str(heater)]) == 1
    said = capsys.readouterr().out
    assert said.count("[RV-0411]") == 1
    assert "the same errors as in model.yaml@bench\n" in said


def test_check_all_of_a_model_without_deployments_checks_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["check", "--all", str(ROOT / "examples/pump/model.yaml")]) == 0
    assert "every deadline is met" in capsys.readouterr().out


def test_the_independent_checker_judges_each_deployment(heater: Path) -> None:
    for path in deployments_of(heater):
        generation.write_program(checking.check(path))
        assert judged(path).disagreements == []
    shutil.rmtree(heater.parent / "generated/bench")
    shutil.copytree(heater.parent / "generated/target", heater.parent / "generated/bench")
    found = judged(heater.parent / "model.yaml@bench").disagreements
    assert {"digest", "tasks"} <= {one.kind for one in found}
    for path in (heater, heater.parent / "model.yaml@bank"):
        with pytest.raises(UnusableError, match="there are bench, target"):
            judged(path)


# --- Editors


def test_an_editor_takes_the_first_deployment_that_has_a_file(heater: Path) -> None:
    folder = heater.parent
    for file, deployment in (("model", "bench"), ("bench", "bench"), ("target", "target")):
        found = editor.main_file(str(folder / f"{file}.yaml"), {}, lambda _name: None)
        assert found == str(folder / f"model.yaml@{deployment}")
        assert editor.checked(Path(found), {}) == ()


def test_an_editor_proposes_the_instances_of_the_common_part_in_a_deployment() -> None:
    path = HEATER / "model.yaml@bench"
    file = HEATER / "bench.yaml"
    offset = TEXTS["bench.yaml"].index("controller_1.control") + len("controller_1.")
    found = proposals(path, str(file), offset, {str(file): TEXTS["bench.yaml"]})
    assert "control" in {one.word for one in found}
