# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`--json` of the commands that compile, run and prove a program; terminals and pipes."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.paths import ROOT
from tests.support.answers import answered, valid

pytestmark = pytest.mark.clock

PRINTED = pytest.CaptureFixture[str]


@pytest.fixture
def model(tmp_path: Path, capsys: PRINTED) -> Path:
    """The model of a new project."""
    answered(capsys, "new", tmp_path / "tank")
    return tmp_path / "tank" / "model.yaml"


def test_a_program_that_was_built_is_named(model: Path, capsys: PRINTED) -> None:
    result = answered(capsys, "build", model)["result"]
    (built,) = result["programs"]
    assert Path(built["program"]).is_file() and result["generated"]["files"] > 0
    source = next((model.parent / "user").glob("*.adb"))
    source.write_text(source.read_text().replace("begin", "begin oops;", 1))
    os.utime(source, (later := source.stat().st_mtime + 2, later))  # an ALI has whole seconds
    answer = answered(capsys, "build", model, status=1)
    assert any(
        one["file"] == source.name and one["line"] and one["severity"] == "error"
        for one in answer["diagnostics"]
    )
    answered(capsys, "clean", model)


@pytest.mark.slow
@pytest.mark.live
def test_a_run_answers_with_its_verdict(model: Path, capsys: PRINTED) -> None:
    result = answered(capsys, "run", model, "--seconds", "1")["result"]
    assert result["passed"] and result["verdict"].startswith("verdict: PASS")
    assert Path(result["report"]).is_file() and result["processors"][0]["count"] > 0
    scenario = model.with_name("none.yaml")
    answer = answered(capsys, "run", model, "--scenario", scenario, status=1)
    assert answer["diagnostics"] and answer["result"] is None
    answered(capsys, "clean", model)


@pytest.mark.skipif(shutil.which("gnatprove") is None, reason="gnatprove is not on PATH")
def test_a_proof_answers_with_its_checks(model: Path, capsys: PRINTED) -> None:
    (proved,) = answered(capsys, "prove", model)["result"]["programs"]
    assert proved["clean"] and proved["checks"] == proved["proved"] > 0
    answered(capsys, "clean", model)


def _joined(result: dict[str, str]) -> None:
    with RavenchartBus(result["channel"]) as bus:
        assert bus.recv(0.01) is None


def _opened(result: dict[str, str]) -> None:
    with urllib.request.urlopen(result["address"], timeout=60) as page:
        assert page.status == 200


SERVERS = {
    "bus": (("bus", "--port", "0"), _joined),
    "workbench": (("workbench", ROOT / "examples/pump/model.yaml", "--no-open"), _opened),
}


def _started(*words: object) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-P", "-m", "ravenchart.start", *map(str, words), "--json"],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", SERVERS)
def test_a_server_answers_as_soon_as_it_serves(name: str) -> None:
    words, used = SERVERS[name]
    with _started(*words) as process:
        try:
            assert process.stdout is not None
            lines = iter(process.stdout.readline, "")
            text = "".join(iter(lambda: next(lines, "}\n"), "}\n")) + "}\n"
            answer = valid(text)
            assert (answer["command"], answer["status"]) == (name, 0)
            used(answer["result"])
        finally:
            process.send_signal(signal.SIGINT)
            out, errors = process.communicate(timeout=60)
    assert (out, process.returncode) == ("", 130)
    assert errors.splitlines()[-1] == "ravenchart: interrupted"


def test_a_bus_that_cannot_serve_answers_why(capsys: PRINTED) -> None:
    with _started("bus", "--port", "0") as process:
        try:
            assert process.stdout is not None
            while "channel" not in (line := process.stdout.readline()):
                assert line
            port = line.rpartition(":")[2].strip().strip('"')
            answer = answered(capsys, "bus", "--port", port, status=2)
            (found,) = answer["diagnostics"]
            assert found["message"] == f"port {port} of this machine is not free"
            assert answer["result"] is None
        finally:
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
