# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`--json`: one object on standard output, whatever comes of a call."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from ravenchart.command_line import COMMANDS, WITHOUT_JSON, main
from ravenchart.commands.answer import found_in
from ravenchart.commands.results import RESULTS
from ravenchart.gen.explanations import MODEL, explanations
from ravenchart.paths import ROOT
from ravenchart.reported import Found, Note
from tests.support.answers import answered, valid

PUMP = ROOT / "examples" / "pump"
PRINTED = pytest.CaptureFixture[str]


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """A model in a folder of its own."""
    return Path(shutil.copy(PUMP / "model.yaml", tmp_path))


def test_check_answers_with_the_size_of_the_system(capsys: PRINTED) -> None:
    answer = answered(capsys, "check", PUMP / "model.yaml")
    assert answer["command"] == "check" and answer["diagnostics"] == []
    assert answer["result"]["system"] == "Infusion_System"


def test_a_wrong_model_is_an_answer_with_located_diagnostics(
    tmp_path: Path, capsys: PRINTED
) -> None:
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text(explanations()["RV-0305"].wrong.files[MODEL])
    answer = answered(capsys, "check", wrong, status=1)
    (found,) = answer["diagnostics"]
    assert (found["code"], found["severity"], found["file"]) == ("RV-0305", "error", str(wrong))
    assert found["line"] > 1 and found["column"] > 1 and found["hint"]
    assert answer["result"] is None


def test_more_errors_than_are_printed_are_all_in_the_answer(
    tmp_path: Path, capsys: PRINTED
) -> None:
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text("".join(f"key_{n}: 1\n" for n in range(150)))
    answer = answered(capsys, "check", wrong, status=1)
    assert len([one for one in answer["diagnostics"] if one["code"] == "RV-0201"]) == 150


def test_standard_error_is_the_same_as_without(tmp_path: Path, capsys: PRINTED) -> None:
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text(explanations()["RV-0305"].wrong.files[MODEL])
    assert main(["check", str(wrong)]) == 1
    plain = capsys.readouterr().err
    assert main(["check", str(wrong), "--json"]) == 1
    assert capsys.readouterr().err == plain != ""


@pytest.mark.parametrize("command", ["check", "generate", "build", "prove", "analyse", "draw"])
def test_a_file_that_is_not_there_is_an_answer(
    command: str, tmp_path: Path, capsys: PRINTED
) -> None:
    answer = answered(capsys, command, tmp_path / "none.yaml", status=1)
    assert answer["command"] == command
    assert answer["diagnostics"][0]["code"] == "RV-0101"


@pytest.mark.parametrize("words", [("check",), ("check", "a", "--nonsense"), ("draw",)])
def test_a_wrong_call_is_an_answer(words: tuple[str, ...], capsys: PRINTED) -> None:
    answer = answered(capsys, *words, status=2)
    assert answer["command"] == words[0] and len(answer["diagnostics"]) == 1


def test_an_unknown_command_is_an_answer_without_command(capsys: PRINTED) -> None:
    answer = answered(capsys, "chekc", status=2)
    assert answer["command"] is None
    found = answer["diagnostics"][0]["message"]
    assert found == "there is no command `chekc`: did you mean `check`?"


@pytest.mark.slow
def test_a_missing_tool_is_an_answer(
    model: Path, monkeypatch: pytest.MonkeyPatch, capsys: PRINTED
) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    answer = answered(capsys, "build", model, status=2)
    assert "gprbuild is not on PATH" in answer["diagnostics"][-1]["message"]
    assert answer["result"]["programs"] == []
    assert answered(capsys, "doctor", status=2)["result"]["tools"]


def test_a_system_error_is_an_answer(tmp_path: Path, capsys: PRINTED) -> None:
    (tmp_path / "file").write_text("")
    answer = answered(capsys, "new", tmp_path / "file" / "tank", status=2)
    assert "not a directory" in answer["diagnostics"][0]["message"]


BROKEN = """
from ravenchart import start
from ravenchart.building import checking
def fails(*a, **k): print("on its way"); raise IndexError("no such thing")
checking.check = fails
raise SystemExit(start.main(["check", "model.yaml", "--json"]))
"""


def test_an_installation_without_a_package_is_an_answer(
    monkeypatch: pytest.MonkeyPatch, capsys: PRINTED
) -> None:
    monkeypatch.setitem(sys.modules, "ravenchart.commands.draw", None)
    with pytest.raises(ImportError):
        main(["draw", "model.yaml", "--json"])
    answer = valid(capsys.readouterr().out)
    assert (answer["command"], answer["status"]) == ("draw", 70)


def test_an_internal_error_is_an_answer() -> None:
    done = subprocess.run(
        [sys.executable, "-P", "-c", BROKEN], cwd=ROOT, capture_output=True, text=True
    )
    answer = valid(done.stdout)
    assert (done.returncode, answer["status"]) == (70, 70)
    assert "a fault of Ravenchart" in answer["diagnostics"][0]["message"]
    assert "IndexError: no such thing" in done.stderr


@pytest.mark.slow
def test_generate_tells_what_it_wrote(model: Path, capsys: PRINTED) -> None:
    first = answered(capsys, "generate", model)["result"]
    assert first["files"] == first["changed"] > 10 and first["edited"] == []
    source = next((model.parent / "generated").glob("*.ads"))
    source.write_text("--  mine\n")
    again = answered(capsys, "generate", model)
    assert again["result"]["edited"] == [source.name]
    assert [one["severity"] for one in again["diagnostics"]] == ["warning"]


def test_allocate_has_its_tables_and_the_yaml(capsys: PRINTED) -> None:
    for more in ((), ("--yaml",)):
        answer = answered(capsys, "allocate", PUMP / "model.yaml", "--strategy", "period", *more)[
            "result"
        ]
        assert answer["met"] and "processors:\n" in answer["yaml"]
        for one in answer["processors"]:
            assert one["response"] <= one["deadline"] and one["activities"]


def test_drawings_are_named(tmp_path: Path, capsys: PRINTED) -> None:
    words = ("draw", PUMP / "model.yaml", "--format", "mermaid", "--out", tmp_path)
    result = answered(capsys, *words)["result"]
    assert result["form"] == "mermaid"
    assert sorted(result["files"]) == sorted(path.name for path in tmp_path.iterdir())


def test_a_code_is_explained_with_both_models(capsys: PRINTED) -> None:
    result = answered(capsys, "explain", "1303")["result"]
    found = explanations()["RV-1303"]
    assert result["wrong"] == {"commands": ["ravenchart run model.yaml --scenario scenario.yaml"],
                               "files": found.wrong.files}  # fmt: skip
    assert result["corrected"]["files"] == found.corrected.files
    assert answered(capsys, "explain", "RV-9999", status=1)["result"] is None


def test_new_clean_and_doctor_answer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: PRINTED
) -> None:
    from ravenchart.building import programs

    result = answered(capsys, "new", tmp_path / "tank")["result"]
    assert "model.yaml" in result["files"]
    monkeypatch.setattr(programs, "work", lambda: tmp_path / "work")
    cleaned = answered(capsys, "clean", tmp_path / "tank" / "model.yaml")["result"]
    assert cleaned == {"folders": [], "bytes": 0}
    states = {one["name"]: one["state"] for one in answered(capsys, "doctor")["result"]["tools"]}
    assert states["python"] == "ok"


def test_a_database_is_exported_and_imported(tmp_path: Path, capsys: PRINTED) -> None:
    result = answered(capsys, "export-dbc", PUMP / "model.yaml")["result"]
    database = tmp_path / "bus.dbc"
    database.write_text(result["dbc"])
    words = ("import", database, "--all", "--period", "10 ms")
    assert "messages:" in answered(capsys, *words)["result"]["yaml"]
    assert answered(capsys, "import-dbc", *words[1:])["command"] == "import"
    wrong = answered(capsys, "import", database, "--node", "nobody", status=1)
    assert wrong["diagnostics"][0]["file"] == str(database)


def test_analyse_has_its_figures_beside_the_other_keys(capsys: PRINTED) -> None:
    answer = answered(capsys, "analyse", PUMP / "model.yaml")
    assert answer["met"] and answer["tasks"] and "result" not in answer
    plain = answered(capsys, "analyse", ROOT / "tests" / "plain" / "two_nodes.csv")
    assert plain["tasks"] and plain["unit"] == "ns"


def test_simulate_prints_steps_and_one_object_where_there_are_none(
    tmp_path: Path, capsys: PRINTED
) -> None:
    events = tmp_path / "events.yaml"
    events.write_text("- {until: 1 s}\n")
    model = ROOT / "examples" / "crossing" / "model.yaml"
    words = ["simulate", str(model), "--interpreter", "--events"]
    assert main([*words, str(events), "--json"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines and all("command" not in json.loads(line) for line in lines)
    answer = answered(capsys, *words, tmp_path / "none.yaml", status=1)
    assert answer["diagnostics"][0]["code"] == "RV-1001"


def test_the_loopback_test_answers_with_its_cases(capsys: PRINTED) -> None:
    words = ("loopback", "--interface", "virtual", "--channel", "json")
    result = answered(capsys, *words)["result"]
    assert result["passed"] and {case["verdict"] for case in result["cases"]} <= {
        "passed", "skipped",
    }  # fmt: skip
    answer = answered(capsys, "loopback", "--interface", "none", "--channel", "x", status=2)
    assert answer["diagnostics"]


def test_a_completion_script_is_in_the_answer(capsys: PRINTED) -> None:
    assert main(["completion", "fish"]) == 0
    script = capsys.readouterr().out
    result = answered(capsys, "completion", "fish")["result"]
    assert result == {"shell": "fish", "script": script} and script


def test_every_command_has_an_answer_or_is_named_as_one_that_has_none() -> None:
    forms = {*RESULTS, "analyse", "simulate", *WITHOUT_JSON}
    assert forms == set(COMMANDS)


def test_messages_of_outside_programs_are_read() -> None:
    text = (
        'a.adb:3:05: error: missing ";"\n'
        "a.adb:4:7: medium: overflow check might fail\n"
        "b.ads:9: warning: x is never used\n"
        "   compilation of a.adb failed\n"
    )
    assert found_in(text) == [
        Found("error", 'missing ";"', None, "a.adb", 3, 5),
        Found("error", "overflow check might fail", None, "a.adb", 4, 7),
        Found("warning", "x is never used", None, "b.ads", 9),
    ]
    assert found_in("gprbuild: boom\n") == [Found("error", "gprbuild: boom")]


def test_our_own_messages_are_read_with_notes_and_hints() -> None:
    text = (
        "m.yaml:2:3: error: x is not declared [RV-0305]\n"
        "    2 | a: b: 3:1: error: no\n      |  ^\n"
        "m.yaml:1:1: note: y is\n"
        "m.yaml:2:3: hint: declare x\n"
        "ravenchart: error: no\n  hint: yes\n"
    )
    note = Note("y is", "m.yaml", 1, 1)
    assert found_in(text) == [
        Found("error", "x is not declared", "RV-0305", "m.yaml", 2, 3, "declare x", [note]),
        Found("error", "no", hint="yes"),
    ]
