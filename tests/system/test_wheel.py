# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The wheel, installed in an environment of its own and used in a folder far from the checkout."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from tests.support.once import made_once
from tests.support.progress import without_progress
from tests.support.workbench import pieces, running

ASSETS = ROOT / "ravenchart" / "workbench" / "assets"

SOURCES = (
    *("ravenchart", "gen", "analysis", "behaviour", "hw_can", "spark_runtime", "proofs"),
    *("pyproject.toml", "README.md", "LICENSE", "ravenchart.gpr", "switches.gpr"),
    "docs/ravenchart.1",
)
WITHOUT = shutil.ignore_patterns("__pycache__")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, made of a copy: setuptools leaves files behind."""
    (made,) = (made_once(tmp_path_factory, "wheel", _make_wheel) / "made").glob("*.whl")
    return made


def _make_wheel(folder: Path) -> None:
    for name in SOURCES:
        source, target = ROOT / name, folder / "source" / name
        if source.is_dir():
            shutil.copytree(source, target, symlinks=True, ignore=WITHOUT)
        else:
            target.parent.mkdir(exist_ok=True)
            shutil.copy(source, target)
    options = ["--quiet", "--no-deps", "--no-build-isolation", "--disable-pip-version-check"]
    words = [sys.executable, "-m", "pip", "wheel", *options, "-w", "made", "./source"]
    subprocess.run(words, cwd=folder, check=True)


@pytest.fixture(scope="module")
def away(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A folder with an environment `env` that has the wheel, none of whose files may change.

    The packages it depends on are those of this environment.
    """
    folder = made_once(tmp_path_factory, "far away", lambda folder: _install(wheel, folder))
    before = json.loads((folder / "files.json").read_text(encoding="utf-8"))
    yield folder
    assert _files(_packages(folder) / "ravenchart") == before


def _install(wheel: Path, folder: Path) -> None:
    run = subprocess.run
    run([sys.executable, "-m", "venv", "--without-pip", "env"], cwd=folder, check=True)
    options = ["--quiet", "--no-deps", "--no-index", "--disable-pip-version-check"]
    pip = [sys.executable, "-m", "pip", "--python", "env/bin/python", "install", *options]
    run([*pip, str(wheel)], cwd=folder, check=True)
    home = _packages(folder)
    (home / "others.pth").write_text(f"{sysconfig.get_path('purelib')}\n", encoding="utf-8")
    files = json.dumps(_files(home / "ravenchart"))
    (folder / "files.json").write_text(files, encoding="utf-8")


def _packages(folder: Path) -> Path:
    return next((folder / "env" / "lib").glob("python*/site-packages"))


def _files(folder: Path) -> list[str]:
    return sorted(str(path) for path in folder.rglob("*") if "__pycache__" not in path.parts)


def _called(away: Path, *words: str, status: int = 0) -> str:
    """What a command prints, called in a folder of the user."""
    home = away / "work"
    home.mkdir(exist_ok=True)
    done = subprocess.run(
        [away / "env" / "bin" / "ravenchart", *words],
        cwd=home,
        env={**os.environ, "XDG_CACHE_HOME": str(away / "cache"), "PYTHONPATH": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == status, done.stdout + done.stderr
    return done.stdout + without_progress(done.stderr)


def test_a_wheel_has_one_import_package_and_all_that_a_program_needs(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    beside = (".dist-info", ".data/data/share/man/man1/ravenchart.1")
    packages = {name.split("/")[0] for name in names if not any(one in name for one in beside)}
    assert packages == {"ravenchart"}
    ada = {path.relative_to(ROOT) for path in ROOT.glob("spark_runtime/*/*.ad[bsc]")}
    ada |= {path.relative_to(ROOT) for path in ROOT.glob("hw_can/**/*.ad[bs]")}
    assert {f"ravenchart/{path}" for path in ada} <= set(names)
    assets = {f"ravenchart/workbench/assets/{path.name}" for path in ASSETS.iterdir()}
    assert assets and assets <= set(names)
    assert not [name for name in names if "/tests/" in name or "mutation" in name]
    assert not [name for name in names if "/hw_can/crate/" in name], "a second runtime"


@pytest.mark.live
def test_a_new_project_is_checked_built_run_and_drawn(away: Path) -> None:
    _called(away, "new", "tank")
    assert "every deadline is met" in _called(away, "check", "tank/model.yaml")
    assert "tank/generated" in _called(away, "generate", "tank/model.yaml")
    built = _called(away, "build", "tank/model.yaml")
    assert f"built {away / 'cache' / 'ravenchart'}" in built and "warning" not in built
    assert "verdict: PASS" in _called(away, "run", "tank/model.yaml", "--seconds", "2")
    assert "drawings" in _called(away, "draw", "tank/model.yaml", "--format", "mermaid")
    _called(away, "analyse", "tank/model.yaml", "--html", "out/report.html")
    assert (away / "work" / "out" / "report.html").is_file()
    (away / "work" / "events.yaml").write_text("- {until: 1 s}\n")
    assert "Idle.entry" in _called(away, "simulate", "tank/model.yaml", "--events", "events.yaml")
    assert " MB freed" in _called(away, "clean", "tank/model.yaml")
    assert not list((away / "cache" / "ravenchart").glob("work-*/build/tank_system-*"))


@pytest.mark.skipif(shutil.which("gnatprove") is None, reason="gnatprove is not on PATH")
def test_a_new_project_is_proved(away: Path) -> None:
    _called(away, "new", "proved")
    told = _called(away, "prove", "proved/model.yaml")
    assert "justified 0, assumed 0, outside SPARK 0" in told


@pytest.mark.clock
def test_the_bus_serves_and_the_loopback_test_passes(away: Path) -> None:
    server = subprocess.Popen(
        [away / "env" / "bin" / "ravenchart", "bus", "--port", "0"],
        env={**os.environ, "XDG_CACHE_HOME": str(away / "cache")},
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert server.stdout is not None
        channel = server.stdout.readline().split()[-1]
        told = _called(away, "loopback", "--interface", "ravenchart", "--channel", channel)
        assert "PASS" in told and "0 failed" in told
    finally:
        server.terminate()
        server.wait()


def test_the_pages_of_workbench_and_simulate_are_served_whole(away: Path) -> None:
    _called(away, "new", "paged")
    model, program = away / "work" / "paged" / "model.yaml", away / "env" / "bin" / "ravenchart"
    loaded: dict[str, bytes] = {}
    for name in ("workbench", "simulate"):
        with running(model, name=name, installed=program) as page:
            loaded |= pieces(page)
            assert page.request("state").status == 200
    assert {name: (ASSETS / name).read_bytes() for name in loaded} == loaded
    others = {"page.html", "play.html", "preact.LICENSE.txt"}
    assert {path.name for path in ASSETS.iterdir()} == {*loaded} | others


def test_doctor_tells_where_it_is_and_the_version_is_one(away: Path) -> None:
    told = _called(away, "doctor")
    assert f"an installation: {away / 'env'}" in told
    version = _called(away, "--version").split()[1]
    assert f'version = "{version}"' in (ROOT / "alire.toml").read_text()
    assert f'version = "{version}"' in (ROOT / "pyproject.toml").read_text()


def test_the_manual_page_is_where_man_looks(away: Path) -> None:
    page = away / "env" / "share" / "man" / "man1" / "ravenchart.1"
    assert page.read_bytes() == (ROOT / "docs" / "ravenchart.1").read_bytes()
    if shutil.which("man") is not None:
        words: list[str | Path] = ["man", "-M", away / "env" / "share" / "man", "ravenchart"]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        assert "EXIT STATUS" in done.stdout


@pytest.mark.slow
def test_commands_answer_with_json_and_shells_are_completed(away: Path) -> None:
    assert json.loads(_called(away, "new", "answered", "--json"))["status"] == 0
    assert json.loads(_called(away, "check", "answered/model.yaml", "--json"))["result"]
    assert "complete -F _ravenchart ravenchart" in _called(away, "completion", "bash")


@pytest.mark.slow
def test_an_installation_has_the_ledger_and_the_records_of_the_runtime(away: Path) -> None:
    _called(away, "new", "shown")
    _called(away, "generate", "shown/model.yaml")
    _called(away, "evidence", "shown/model.yaml", status=1)
    data = json.loads((away / "work" / "shown" / "evidence" / "evidence.json").read_text())
    verdicts = {one["id"]: one["verdict"] for one in data["claims"]}
    assert verdicts["generated"] == "met" and verdicts["program"] == "not shown"
    assert {"runtime-loopback", "runtime-slcan"} & verdicts.keys()
    assert "not there" not in json.dumps(data["claims"])
    assert "ASM-009" in {gap["what"] for gap in data["not_shown"]}


@pytest.mark.slow
def test_an_installation_explains_codes_with_their_models(away: Path) -> None:
    assert "+          lost: {from: Run, to: Safe, on: Lost}" in _called(away, "explain", "RV-0305")
    wrong = _called(away, "explain", "RV-0305", "--wrong")
    (away / "work" / "wrong.yaml").write_text(wrong, encoding="utf-8")
    assert "[RV-0305]" in _called(away, "check", "wrong.yaml", status=1)


def test_an_installation_answers_an_editor(away: Path) -> None:
    asked: list[dict[str, object]] = [
        {"id": 1, "method": "initialize", "params": {"capabilities": {}}},
        {"id": 2, "method": "shutdown"},
        {"method": "exit"},
    ]
    bodies = [json.dumps({"jsonrpc": "2.0", **one}) for one in asked]
    done = subprocess.run(
        [away / "env" / "bin" / "ravenchart", "language-server"],
        input="".join(f"Content-Length: {len(body)}\r\n\r\n{body}" for body in bodies),
        env={**os.environ, "PYTHONPATH": ""},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert '"renameProvider"' in done.stdout and '"name": "ravenchart"' in done.stdout
