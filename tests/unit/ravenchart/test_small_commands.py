# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`new`, `explain`, `clean`, `doctor`: what they refuse, and what they touch."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from ravenchart import paths
from ravenchart.command_line import COMMANDS, main
from ravenchart.commands.new import project
from ravenchart.gen.diagnostics import CODES
from ravenchart.gen.explanations import MODEL, explanations
from ravenchart.tools.toolchain import GET_GNATPROVE


def test_a_folder_that_is_there_is_not_touched(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "model.yaml").write_text("mine\n")
    assert main(["new", str(tmp_path)]) == 1
    assert "is there already" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["model.yaml"]


@pytest.mark.parametrize("name", ["2_tanks", "4", "t\u00e4nk"])
def test_a_folder_no_system_can_be_named_after_is_refused(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["new", str(tmp_path / name)]) == 1
    assert "a system cannot be named after" in capsys.readouterr().err
    assert not (tmp_path / name / "model.yaml").exists()


def test_a_project_names_its_system_after_its_folder() -> None:
    files = project("heart-pump 2")
    assert "system: Heart_Pump_2_System\n" in files["model.yaml"]
    assert (
        "package body Heart_Pump_2_System.Plant.Activities"
        in files["user/heart_pump_2_system-plant-activities.adb"]
    )
    assert not [name for name, text in files.items() if "SYSTEM" in text]


@pytest.mark.parametrize("given", ["RV-0305", "rv-0305", "[RV-0305]", "0305", "305", "rv-305"])
def test_a_code_is_explained_as_it_stands_in_a_message(
    given: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["explain", given]) == 0
    assert f"\n{CODES['RV-0305']}\n" in capsys.readouterr().out


def test_an_unknown_code_is_told_with_what_is_like_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "RV-0395"]) == 1
    assert "no message has the code RV-0395; similar codes: RV-" in capsys.readouterr().err


def test_the_models_of_a_code_are_printed_whole(capsys: pytest.CaptureFixture[str]) -> None:
    found = explanations()["RV-0305"]
    assert main(["explain", "RV-0305", "--wrong"]) == 0
    assert capsys.readouterr().out == found.wrong.files[MODEL]
    assert main(["explain", "RV-0305", "--corrected"]) == 0
    assert capsys.readouterr().out == found.corrected.files[MODEL]


def test_several_files_of_a_code_are_printed_below_their_names(
    capsys: pytest.CaptureFixture[str],
) -> None:
    files = explanations()["RV-1303"].wrong.files
    assert main(["explain", "RV-1303", "--wrong"]) == 0
    told = "".join(f"==> {name} <==\n{text}" for name, text in files.items())
    assert capsys.readouterr().out == told and len(files) == 2


def test_the_files_of_a_code_are_written_byte_for_byte(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["explain", "RV-0103", "--wrong", "--out", str(tmp_path / "new")]) == 0
    assert b"F\xfcllstand" in (tmp_path / "new" / "model.yaml").read_bytes()
    assert main(["explain", "RV-0103"]) == 0
    assert "-system: Pump_House  # F\\xfcllstand" in capsys.readouterr().out
    assert main(["explain", "RV-0103", "--out", str(tmp_path)]) == 2
    assert "--out needs --wrong or --corrected" in capsys.readouterr().err


def test_clean_deletes_what_was_built_of_one_model_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from ravenchart.building import programs

    monkeypatch.setattr(programs, "work", lambda: tmp_path / "work")
    for folder in ("one", "two"):
        mark = programs._mark(tmp_path / folder / "model.yaml")
        home = tmp_path / "work" / "build" / f"tank-{mark}-slcan"
        home.mkdir(parents=True)
        (home / "tank_main").write_bytes(bytes(2_000_000))
    assert main(["clean", str(tmp_path / "one" / "model.yaml")]) == 0
    assert capsys.readouterr().out == "2 MB freed\n"
    (left,) = (tmp_path / "work" / "build").iterdir()
    assert left.name == f"tank-{programs._mark(tmp_path / 'two' / 'model.yaml')}-slcan"


def test_doctor_is_status_2_where_no_program_can_be_built(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["doctor"]) == 0
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["doctor"]) == 2
    told = capsys.readouterr().out
    assert "missing  gprbuild" in told and "sudo apt-get install gprbuild" in told
    assert re.search(r"absent +gnatprove +`prove`: alr get gnatprove && PATH=", told)


def test_the_command_that_doctor_prints_puts_gnatprove_on_path(tmp_path: Path) -> None:
    alr = tmp_path / "alr"
    alr.write_text("#!/bin/sh\nmkdir -p gnatprove_14.1.1_0123abcd/bin\n")
    alr.chmod(0o755)
    here = tmp_path / "a folder"
    here.mkdir()
    done = subprocess.run(
        ["/bin/sh", "-ec", f'{GET_GNATPROVE}; echo "$PATH"'], cwd=here, text=True,
        capture_output=True, check=True, env={"PATH": f"{tmp_path}:/usr/bin:/bin"},
    )  # fmt: skip
    assert done.stdout.startswith(f"{here}/gnatprove_14.1.1_0123abcd/bin:{tmp_path}:")


def test_every_command_says_what_it_does(capsys: pytest.CaptureFixture[str]) -> None:
    for name, (_, says) in COMMANDS.items():
        with pytest.raises(SystemExit) as ended:
            main([name, "--help"])
        assert ended.value.code == 0
        assert says.split(",")[0] in " ".join(capsys.readouterr().out.split())


def test_objects_of_a_checkout_that_cannot_be_written_go_to_the_cache(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert paths.work() == paths.ROOT
    monkeypatch.setattr("os.access", lambda _path, _mode: False)
    assert paths.work().parent == tmp_path / "ravenchart"
