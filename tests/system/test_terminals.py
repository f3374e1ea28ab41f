# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Colour is for terminals that want it, and progress for people who wait at one."""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from tests.support.processes import ROOT

pytestmark = pytest.mark.clock

PUMP = ROOT / "examples" / "pump" / "model.yaml"
ESCAPE = "\x1b"
COLOUR = re.compile(r"\x1b\[[\d;]*m")
LINE = re.compile(r"(?:check|generate|compile|run|start|write) .* \(\d+ s\)")
"""Progress where there is no terminal, which comes when a command takes long."""


def called(*words: object, terminals: str = "", **more: str) -> tuple[str, str]:
    """Standard output and error of a command; ``terminals`` names those that are one.

    A host that withholds the core may make a run miss a deadline, which is not judged here.
    """
    environment = {name: value for name, value in os.environ.items() if "_COLOR" not in name}
    environment |= {"PYTHONPATH": str(ROOT), "TERM": "xterm-256color", **more}
    ends = {}
    for stream in ("out", "err"):
        ends[stream] = pty.openpty() if stream in terminals else os.pipe()
    process = subprocess.Popen(
        [sys.executable, "-P", "-m", "ravenchart.start", *map(str, words)],
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=ends["out"][1],
        stderr=ends["err"][1],
    )
    texts = []
    for reading, writing in ends.values():
        os.close(writing)
        texts.append(_all(reading))
    assert process.wait() in ((0, 1) if words[0] == "run" else (0,)), texts
    return texts[0], texts[1]


def _all(reading: int) -> str:
    """Everything that comes; a terminal ends with an error."""
    parts = []
    with suppress(OSError), os.fdopen(reading, "rb", buffering=0) as source:
        while part := source.read(4096):
            parts.append(part)
    return b"".join(parts).decode()


@pytest.mark.parametrize("words", [("analyse", PUMP), ("check", PUMP), ("--help",)])
def test_pipes_get_no_escape_codes(words: tuple[object, ...]) -> None:
    out, errors = called(*words)
    assert out and ESCAPE not in out + errors


@pytest.mark.slow
def test_a_terminal_gets_colour() -> None:
    assert COLOUR.search(called("analyse", PUMP, terminals="out err")[0])
    assert COLOUR.search(called("analyse", PUMP, terminals="out err", NO_COLOR="")[0])


@pytest.mark.slow
def test_colour_for_a_pipe_is_for_those_who_ask_and_do_not_ask_for_none() -> None:
    assert COLOUR.search(called("analyse", PUMP, FORCE_COLOR="1")[0])
    assert ESCAPE not in called("analyse", PUMP, FORCE_COLOR="1", NO_COLOR="1")[0]


@pytest.mark.slow
@pytest.mark.parametrize("more", [{"NO_COLOR": "1"}, {"TERM": "dumb"}], ids=str)
@pytest.mark.parametrize(
    "words",
    [
        ("analyse", PUMP),
        ("analyse", ROOT / "tests" / "plain" / "two_nodes.csv"),
        ("allocate", PUMP, "--strategy", "period"),
        ("loopback", "--interface", "virtual", "--channel", "terminal"),
        ("check", "--help"),
    ],
    ids=lambda words: words[0],
)
def test_a_terminal_that_wants_no_colour_gets_none(
    words: tuple[object, ...], more: dict[str, str]
) -> None:
    out, errors = called(*words, terminals="out err", **more)
    assert out and ESCAPE not in out and not COLOUR.search(errors)
    assert "NO_COLOR" in more or ESCAPE not in errors  # progress moves the cursor


def test_json_has_no_escape_codes_on_a_terminal() -> None:
    out, _ = called("doctor", "--json", terminals="out err")
    assert out.startswith("{") and ESCAPE not in out


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """The model of a new project."""
    called("new", tmp_path / "tank")
    return tmp_path / "tank" / "model.yaml"


@pytest.mark.slow
@pytest.mark.live
def test_progress_is_shown_at_a_terminal_and_never_in_the_output(project: Path) -> None:
    out, errors = called("build", project, terminals="err")
    assert re.search(r"compile \w+: \d+ of \d+ units compiled", errors)
    assert ESCAPE not in out and "compile" not in out
    called("clean", project)
    out, errors = called("build", project, terminals="out")
    assert "compile" not in out and ESCAPE not in errors + out
    assert [line for line in errors.splitlines() if not LINE.fullmatch(line)] == []
    out, errors = called("run", project, "--seconds", "1", terminals="err", NO_COLOR="1")
    assert "start the controller" in errors and ESCAPE not in out
    assert not COLOUR.search(errors)
    out, errors = called("run", project, "--seconds", "1", terminals="err", TERM="dumb")
    assert ESCAPE not in out + errors and "start the controller" not in out
    assert [line for line in errors.splitlines() if not LINE.fullmatch(line)] == []
    called("clean", project)
