# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Libraries: components and types that several systems share, each with code of its own."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ravenchart.building import checking, generation
from ravenchart.command_line import main
from ravenchart.failures import Refused
from ravenchart.gen.diagnostics import render_all
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.independent.check import checked as judged
from ravenchart.paths import ROOT

LIBRARY = ROOT / "tests/feature/library"
MAIN, BLOCKS, WORDS, GAUGES = (
    "model.yaml", "blocks/library.yaml", "words/library.yaml", "gauges/library.yaml"
)  # fmt: skip
TEXTS = {
    name: (LIBRARY / name).read_text(encoding="utf-8") for name in (MAIN, BLOCKS, WORDS, GAUGES)
}


def loaded(path: str = MAIN, **texts: str) -> Loaded:
    """A model of the feature with other texts of its files, by the names of their folders."""
    files = {
        **TEXTS,
        **{MAIN if k == "model" else f"{k}/library.yaml": v for k, v in texts.items()},
    }

    def read(file: Path, limit: int) -> bytes:
        name = file.as_posix().replace("blocks/../", "")
        if name not in files:
            raise FileNotFoundError(2, "No such file or directory")
        return files[name].encode()[:limit]

    return load(Path(path), read)


def system_of(path: str = MAIN, **texts: str) -> System:
    found = loaded(path, **texts)
    assert found.system is not None, render_all(found.diagnostics, found.sources)
    return found.system


def errors(path: str = MAIN, **texts: str) -> list[str]:
    return [
        f"{one.code} {one.message}" for one in loaded(path, **texts).diagnostics if one.is_error
    ]


def written_at(folder: Path) -> checking.Checked:
    """The feature's files in a folder, and its program written."""
    for name, text in TEXTS.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    found = checking.check(folder / MAIN)
    generation.write_program(found)
    return found


# --- What is read


def test_a_system_knows_the_library_of_each_type_and_component() -> None:
    system = system_of()
    assert [(one.name, one.version) for one in system.libraries] == [
        ("Words", "1.0.0"), ("Blocks", "1.2.0"), ("Gauges", "0.3.1-draft")
    ]  # fmt: skip
    homes = {one.name: system.home_of(one).name for one in (*system.types, *system.components)}
    assert homes == {
        "Total": "Library_Feature", "Count": "Blocks", "Level": "Words", "Gradient": "Words",
        "Quality": "Words", "Sample": "Words", "Height": "Gauges", "Tank_Type": "Library_Feature",
        "Smoother_Type": "Blocks", "Watcher_Type": "Blocks", "Gauge_Type": "Gauges",
    }  # fmt: skip
    assert [one.name for one in system.own_components] == ["Tank_Type"]


def test_a_library_is_a_model_of_its_own() -> None:
    alone, inside = system_of(BLOCKS), system_of().libraries[1]
    assert alone.is_library and not system_of().is_library
    assert (alone.name, alone.version, alone.digest) == (inside.name, inside.version, inside.digest)
    assert [one.name for one in alone.libraries] == ["Words"]
    assert [one.name for one in alone.own_components] == ["Smoother_Type", "Watcher_Type"]


def test_the_digest_of_a_library_is_that_of_its_own_files() -> None:
    before = system_of()
    after = system_of(words=f"{TEXTS[WORDS]}# changed\n")
    changed = [
        a.name
        for a, b in zip(before.libraries, after.libraries, strict=True)
        if a.digest != b.digest
    ]
    assert changed == ["Words"]
    assert before.digest != after.digest


# --- What is wrong


WRONG = {
    "no version": ("blocks", "version: 1.2.0\n", "", "RV-0811 the library Blocks has no version"),
    "no number": ("blocks", "1.2.0", "new", "RV-0811 `version` must be a version such as `1.2.0`"),
    "a node": (
        "blocks", "types:", "chains: {}\ntypes:",
        "RV-0811 a library has no `chains`",
    ),
    "a version of a system": (
        "model", "\ninclude", "\nversion: 1.0.0\ninclude", "RV-0811 only a library has a version",
    ),
    "named like the system": (
        "gauges", "library: Gauges", "library: Library_Feature",
        "RV-0304 the library Library_Feature is named like the system",
    ),
    "named like a component": (
        "gauges", "library: Gauges", "library: Tank_Type",
        "RV-0304 the library Tank_Type is named like a component",
    ),
    "named like another": (
        "gauges", "library: Gauges", "library: Words",
        "RV-0304 the library Words is named like another library",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_one_mistake_gives_one_error(case: str) -> None:
    where, old, new, wanted = WRONG[case]
    text = TEXTS[MAIN if where == "model" else f"{where}/library.yaml"]
    assert old in text
    found = errors(**{where: text.replace(old, new, 1)})
    assert len(found) == 1 and found[0].startswith(wanted), found


def test_a_library_sees_nothing_of_the_system() -> None:
    text = TEXTS[BLOCKS].replace("smooth: {out: Sample}", "smooth: {out: Total}")
    found = loaded(blocks=text)
    assert len(found.diagnostics) == 1
    assert found.diagnostics[0].origin.file == BLOCKS
    assert "the library Blocks sees its own files" in found.diagnostics[0].notes[-1][1]


def test_a_part_of_a_library_is_not_included_by_itself(tmp_path: Path) -> None:
    written_at(tmp_path)
    (tmp_path / "gauges/more.yaml").write_text("types: {Depth: {range: [0, 9]}}\n", "utf-8")
    gauges = TEXTS[GAUGES].replace("\ntypes", "\ninclude: [more.yaml]\n\ntypes")
    (tmp_path / GAUGES).write_text(gauges, "utf-8")
    assert load(tmp_path / MAIN).system is not None
    model = TEXTS[MAIN].replace("gauges/library.yaml]", "gauges/library.yaml, gauges/more.yaml]")
    (tmp_path / MAIN).write_text(model, "utf-8")
    (found,) = load(tmp_path / MAIN).diagnostics
    assert found.code == "RV-0803" and "is part of the library in" in found.message
    model = TEXTS[MAIN].replace("[blocks", "[gauges/more.yaml, blocks")
    (tmp_path / MAIN).write_text(model, "utf-8")
    (found,) = load(tmp_path / MAIN).diagnostics
    assert "by the model itself and by a library" in found.message


def test_warnings_of_a_library_are_for_those_who_check_it() -> None:
    text = TEXTS[BLOCKS].replace("types:\n", "types:\n  Idle: {range: [0, 1]}\n", 1)
    text = text.replace("      limit:", "      unused: {type: Level, default: 1}\n      limit:")
    assert any("unused" in one.message for one in loaded(BLOCKS, blocks=text).diagnostics)
    assert not loaded(blocks=text).diagnostics


# --- What is generated


def test_a_library_has_the_same_code_for_every_system(tmp_path: Path) -> None:
    written_at(tmp_path)
    generated = tmp_path / "blocks/generated"
    before = {path.name: path.read_bytes() for path in generated.iterdir()}
    assert "blocks-watcher_type-watching.adb" in before
    other = TEXTS[MAIN].replace("Library_Feature", "Other").replace("limit: 700", "limit: 10")
    (tmp_path / MAIN).write_text(other.replace("period: 10 ms", "period: 20 ms"), "utf-8")
    generation.write_program(checking.check(tmp_path / MAIN))
    assert {path.name: path.read_bytes() for path in generated.iterdir()} == before
    generation.write_program(checking.check(tmp_path / BLOCKS, library=True))
    assert {path.name: path.read_bytes() for path in generated.iterdir()} == before


def test_a_program_has_no_code_of_its_libraries(tmp_path: Path) -> None:
    written_at(tmp_path)
    units = {path.name for path in (tmp_path / "generated").glob("*.ad?")}
    assert not [name for name in units if re.search(r"(smoother|watcher|gauge)_type-", name)]
    renamed = (tmp_path / "generated/library_feature-watcher_type.ads").read_text("utf-8")
    assert "package Library_Feature.Watcher_Type renames Blocks.Watcher_Type;" in renamed
    root = (tmp_path / "generated/library_feature.ads").read_text("utf-8")
    assert "subtype Level is Words.Level;" in root
    assert "function Good return Quality renames Words.Good;" in root
    assert not (tmp_path / "user").exists()
    assert (tmp_path / "blocks/user/blocks-smoother_type-activities.adb").is_file()


def test_values_of_one_unit_from_two_libraries_are_converted(tmp_path: Path) -> None:
    written_at(tmp_path)
    body = (tmp_path / "generated/library_feature-tank_type-flows.adb").read_text("utf-8")
    text = " ".join(body.split())
    assert "Library_Feature.Unit_Mm (Height.Value) + Smooth.Value.Level" in text
    assert "Shown := Library_Feature.Height (" in text
    assert "Mean := Library_Feature.Unit_Mm'Min" in text  # of the first library: no conversion


def test_names_and_versions_stand_beside_the_trace(tmp_path: Path) -> None:
    found = written_at(tmp_path)
    text = (tmp_path / "generated/trace.json").read_text("utf-8")
    for one in found.system.libraries:
        assert f'"version": "{one.version}"' in text and one.digest in text


# --- Commands


def test_commands_on_a_library(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written_at(tmp_path)
    assert main(["check", str(tmp_path / BLOCKS)]) == 0
    assert "Blocks 1.2.0: a library of 1 type and 2 components" in capsys.readouterr().out
    assert main(["generate", str(tmp_path / BLOCKS)]) == 0
    assert main(["draw", str(tmp_path / BLOCKS), "--out", str(tmp_path / "drawn")]) == 0
    assert (tmp_path / "drawn/Watcher_Type.Watching.svg").is_file()
    for command in ("analyse", "run", "evidence", "tests", "measure"):
        assert main([command, str(tmp_path / BLOCKS)]) == 1
        assert "Blocks is a library, which has no instances" in capsys.readouterr().err


def test_a_library_that_cannot_be_written_is_used_as_it_is(tmp_path: Path) -> None:
    found = written_at(tmp_path)
    again = generation.write_program(found)
    assert again.changed == 0
    (tmp_path / "blocks/generated/blocks.ads").write_text("-- edited\n", "utf-8")
    again = generation.write_program(found)
    assert again.changed == 1 and len(again.edited) == 1


def test_the_independent_checker_reads_the_code_of_the_library(tmp_path: Path) -> None:
    written_at(tmp_path)
    assert judged(tmp_path / MAIN).agrees
    spec = tmp_path / "blocks/generated/blocks-watcher_type-watching.ads"
    text = spec.read_text("utf-8")
    spec.write_text(text.replace("Sample.Value.Level >", "Sample.Value.Level <", 1), "utf-8")
    (found,) = judged(tmp_path / MAIN).disagreements
    assert "blocks-watcher_type-watching.ads" in found.file


def test_a_system_cannot_be_checked_as_a_library(tmp_path: Path) -> None:
    written_at(tmp_path)
    with pytest.raises(Refused, match="has no instances"):
        checking.check(tmp_path / WORDS)
