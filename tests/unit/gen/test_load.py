# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Files: what is read, what is refused, and where errors are said to be."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from ravenchart.gen.diagnostics import render
from ravenchart.gen.files.load import LARGEST
from ravenchart.gen.files.located import grow, scalar_value
from ravenchart.gen.origins import Origin
from ravenchart.gen.pipeline import load
from tests.support.pump import PUMP, changed, codes, loaded, system_of

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("name", ["cartesian_robot", "three_components"])
def test_example_loads_without_a_word(name: str) -> None:
    result = load(ROOT / "examples" / name / "model.yaml")
    assert result.diagnostics == ()
    assert result.system is not None
    assert result.system.tasks and result.system.objects


def test_the_small_model_loads_without_a_word() -> None:
    assert loaded(PUMP).diagnostics == ()


def test_a_list_without_a_value_is_empty_in_the_message() -> None:
    found = loaded("system: House\ntypes:\n  Level: {range: }\n").diagnostics
    assert "`range` must be a list, but is empty" in [one.message for one in found]


def test_missing_main_file_is_an_error_at_its_name(tmp_path: Path) -> None:
    result = load(tmp_path / "none.yaml")
    assert [item.code for item in result.diagnostics] == ["RV-0101"]
    assert result.diagnostics[0].origin == Origin(str(tmp_path / "none.yaml"), 1, 1)


def test_directory_is_no_model_file(tmp_path: Path) -> None:
    assert [item.code for item in load(tmp_path).diagnostics] == ["RV-0101"]


def test_name_with_a_nul_is_an_error_not_an_exception() -> None:
    assert [item.code for item in load(Path("a\0b")).diagnostics] == ["RV-0101"]


def test_file_over_4_mib_is_refused() -> None:
    assert [i.code for i in loaded(b"#" * (LARGEST + 1)).diagnostics] == ["RV-0102"]


def test_file_that_is_not_utf8_is_refused_at_its_byte() -> None:
    result = loaded(b"system: A\ntypes: \xff\n")
    assert [(i.code, i.origin.line, i.origin.column) for i in result.diagnostics] == [
        ("RV-0103", 2, 8)
    ]


def test_byte_order_mark_is_skipped() -> None:
    assert loaded(b"\xef\xbb\xbf" + PUMP.encode()).diagnostics == ()


def test_carriage_returns_do_no_harm() -> None:
    assert loaded(PUMP.replace("\n", "\r\n")).diagnostics == ()


@pytest.mark.parametrize("text", ["", "   \n\n", "---\n", "# only a comment\n"])
def test_empty_file_is_refused(text: str) -> None:
    assert [i.code for i in loaded(text).diagnostics] == ["RV-0104"]


def test_control_character_is_refused_where_it_stands() -> None:
    result = loaded("system: A\nnodes: \x01\n")
    assert [(i.code, i.origin.line, i.origin.column) for i in result.diagnostics] == [
        ("RV-0106", 2, 8)
    ]


@pytest.mark.parametrize("text", ["? [a]\n: b\n", "{a: b}: c\n", "? {a: b}\n: c\n"])
def test_key_that_is_no_text_is_refused(text: str) -> None:
    assert [i.code for i in loaded(text).diagnostics] == ["RV-0113"]


@pytest.mark.parametrize(
    "text",
    ['a: "\\Uffffffff"', "%YAML " + "9" * 5000 + ".1\n---\na: b", "a: 'b", "a: b: c", "{", "- -"],
)
def test_odd_yaml_is_an_error_not_an_exception(text: str) -> None:
    assert next(i.code[:5] for i in loaded(text).diagnostics) in ("RV-01", "RV-02")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0", 0),
        ("-20", -20),
        ("1_000", 1000),
        ("0x0F", 15),
        ("010", "010"),
        ("1_", "1_"),
        ("1.5", "1.5"),
        ("true", True),
        ("True", "True"),
        ("no", "no"),
        ("on", "on"),
        ("~", "~"),
        ("9" * 50, "9" * 50),
    ],
)
def test_scalar_has_the_value_that_it_seems_to_have(text: str, value: object) -> None:
    assert scalar_value(text) == value
    assert type(scalar_value(text)) is type(value)


# --- Includes ------------------------------------------------------------------


def split_pump() -> tuple[str, str]:
    """The small model with its types in a second file."""
    begin, end = PUMP.index("types:"), PUMP.index("components:")
    return PUMP[:begin] + "include: [parts.yaml]\n" + PUMP[end:], PUMP[begin:end]


def test_included_sections_belong_to_the_model() -> None:
    main, types = split_pump()
    result = loaded(main, parts=types)
    assert result.diagnostics == ()
    assert result.system is not None
    assert result.system.types[0].origin.file == "parts.yaml"


def test_path_of_an_included_file_is_relative_to_its_includer(tmp_path: Path) -> None:
    main, types = split_pump()
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "model.yaml").write_text(main.replace("parts.yaml", "deep/a.yaml"))
    (tmp_path / "sub" / "deep").mkdir()
    (tmp_path / "sub" / "deep" / "a.yaml").write_text("include: [b.yaml]\n")
    (tmp_path / "sub" / "deep" / "b.yaml").write_text(types.replace("[0, 1000]", "[1, 0]"))
    result = load(tmp_path / "sub" / "model.yaml")
    assert [i.origin.file for i in result.diagnostics] == [
        str(tmp_path / "sub" / "deep" / "b.yaml")
    ]


def test_file_included_twice_is_read_once() -> None:
    main, types = split_pump()
    main = main.replace("[parts.yaml]", "[parts.yaml, more.yaml]")
    assert loaded(main, parts=types, more="include: [parts.yaml]\n").diagnostics == ()


def test_file_that_includes_itself_is_refused() -> None:
    result = loaded(PUMP + "include: [model.yaml]\n")
    assert [i.code for i in result.diagnostics] == ["RV-0112"]


def test_more_than_100_files_are_refused() -> None:
    others = {f"f{n}": f"include: [f{n + 1}.yaml]\n" for n in range(120)}
    result = loaded(PUMP + "include: [f0.yaml]\n", **others)
    assert [i.code for i in result.diagnostics] == ["RV-0102"]


def test_only_the_main_file_names_the_system() -> None:
    result = loaded(PUMP + "include: [more.yaml]\n", more="system: Other\n")
    assert [(i.code, i.origin.file) for i in result.diagnostics] == [("RV-0803", "more.yaml")]


def test_errors_come_in_the_order_of_the_files() -> None:
    main, types = split_pump()
    main = main.replace("default: 900", "default: 9000")
    result = loaded(main, parts=types.replace("unit: mm}", "unit: mm, step: 1}"))
    assert [i.origin.file for i in result.diagnostics] == ["model.yaml", "parts.yaml"]


# --- Digest, repetition, rendering -----------------------------------------------


def test_digest_follows_the_text() -> None:
    assert system_of().digest == system_of().digest
    assert system_of().digest != system_of(("default: 900", "default: 800")).digest


def test_the_same_text_gives_the_same_system() -> None:
    assert system_of() == system_of()


def test_all_errors_are_reported_at_once() -> None:
    found = codes(
        ("unit: mm}", "unit: mm, step: 1}"),
        ("default: 900", "default: 9000"),
        ("wcet: 20 us}", "wcet: 20 ms}"),
        ("0x101", "0x100"),
        ("north.tell]", "north.tell, north.tell]"),
    )
    assert found == ["RV-0201", "RV-0312", "RV-0703", "RV-0607", "RV-0702"]


def test_error_in_one_component_does_not_spread_to_what_uses_it() -> None:
    assert codes(("{in: Level,", "{in: Levle,")) == ["RV-0305"]
    assert codes(("  north: {component: Tank", "  north: {component: Tnak")) == ["RV-0305"]
    assert codes(("  board: {context_switch: 5 us", "  board: {context_switch: 5")) == ["RV-0205"]


def test_rendering_shows_line_caret_notes_and_hint() -> None:
    result = loaded(changed(("to: Idle, on: Lost}", "to: Idle, on: Lots}")))
    assert render(result.diagnostics[0], result.sources).splitlines() == [
        "model.yaml:34:47: error: there is no event named `Lots` [RV-0305]",
        "   34 |           lost: {from: Filling, to: Idle, on: Lots}",
        "      |                                               ^",
        "model.yaml:34:47: hint: did you mean `Lost`?",
    ]


def test_rendering_cuts_long_lines_around_the_caret() -> None:
    result = loaded("system: A # " + "x" * 500 + "\nfoo: '" + "y" * 500 + "'\n")
    shown = "\n".join(render(item, result.sources) for item in result.diagnostics)
    assert max(len(line) for line in shown.splitlines() if ": hint: " not in line) < 200


def test_rendering_prints_no_control_characters() -> None:
    result = loaded(b"system: \x1b[31m\n")
    shown = "\n".join(render(item, result.sources) for item in result.diagnostics)
    assert "\x1b" not in shown


@pytest.mark.parametrize("opened", ["[", "{a: ", "[{a: "])
def test_deep_nesting_is_refused_before_the_rest_is_read(opened: str) -> None:
    text = "system: " + opened * (LARGEST // len(opened) - 8)
    begun = time.process_time()
    tree, found = grow(text, "model.yaml")
    assert time.process_time() - begun < 8  # quadratic time would be hours
    assert tree is None
    assert [one.code for one in found] == ["RV-0107"]
