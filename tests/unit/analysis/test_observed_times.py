# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`analyse --observed`: what a run recorded against the WCETs of the model."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from ravenchart.analysis.present.report import RunReport, render_report
from ravenchart.analysis.system.journeys import Journey
from ravenchart.building import checking
from ravenchart.command_line import main
from ravenchart.failures import OK, WRONG

PUMP = Path(__file__).parents[3] / "examples" / "pump"
MODEL = PUMP / "model.yaml"


def rows() -> dict[str, int]:
    """The numbers of the rows in a trace of the pump."""
    elements = json.loads((PUMP / "generated" / "trace.json").read_text(encoding="utf-8"))
    return {e["element"]: e["id"] for e in elements["elements"] if e["kind"] == "row"}


def digest() -> str:
    """That of the pump's model."""
    return checking.check(MODEL).system.digest


def trace(folder: Path, text: str, model: str | None = None) -> str:
    path = folder / "trace.txt"
    path.write_text(f"M {model or digest()}\n{text}", encoding="ascii")
    return str(path)


def test_executions_within_their_wcets_pass(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = "".join(f"A {number} 1000\n" for number in rows().values())
    assert main(["analyse", str(MODEL), "--observed", trace(tmp_path, lines + "END\n")]) == OK
    found = capsys.readouterr().out
    for name in rows():
        assert f"{name}: 1 us, within its WCET of " in found


@pytest.mark.slow
def test_what_a_trace_shows_is_in_the_report(tmp_path: Path) -> None:
    lines = "".join(f"A {number} 1000\n" for number in rows().values())
    page = tmp_path / "report.html"
    path = trace(tmp_path, lines + "END\n")
    assert main(["analyse", str(MODEL), "--observed", path, "--html", str(page)]) == OK
    text = page.read_text(encoding="utf-8")
    assert "every observed execution time is within its WCET" in text
    assert "Executions beside their WCETs" in text


@pytest.mark.slow
def test_reactions_are_drawn_beside_their_bound() -> None:
    took = Journey(
        "flow", 3, 5_000_000, 9_000_000, 12_000_000, 3, (3_000_000, 5_000_000, 5_000_000)
    )
    run = RunReport("A run", True, "all good", (), (), (), True, None, (took,))
    text = render_report(checking.check(MODEL).analysis, run)
    assert "flow: how often each reaction was observed, beside its bound" in text


def test_an_execution_above_its_wcet_fails_and_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (first, number), *others = rows().items()
    path = trace(tmp_path, f"A {number} 999999999\nEND\n")
    assert main(["analyse", str(MODEL), "--observed", path]) == WRONG
    found = capsys.readouterr().out
    assert f"{first}: 1 s, ABOVE its WCET of " in found
    for name, _ in others:
        assert f"{name}: not executed in this run" in found


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("A 1 5\n", "the trace was cut off"),
        ("END\n", "no activity of"),
        ("A 1\nEND\n", "trace.txt:2: error: not a trace line"),
    ],
)
def test_a_trace_that_says_nothing_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, message: str
) -> None:
    number = next(iter(rows().values()))
    path = trace(tmp_path, text.replace("A 1 5", f"A {number} 5"))
    assert main(["analyse", str(MODEL), "--observed", path]) == WRONG
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ([str(MODEL), "--export", "mast", "--compare", "x"], "cannot be combined with --compare"),
        (
            [str(MODEL), "--json", "--html", "x"],
            "--json and --export cannot be combined with --html, --observed",
        ),
    ],
)
def test_options_that_do_not_go_together_are_refused(
    capsys: pytest.CaptureFixture[str], options: list[str], message: str
) -> None:
    assert main(["analyse", *options]) == WRONG
    assert message in capsys.readouterr().err


def test_a_trace_of_another_model_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = "".join(f"A {number} 1000\n" for number in rows().values())
    path = trace(tmp_path, lines + "END\n", "f" * 64)
    assert main(["analyse", str(MODEL), "--observed", path]) == WRONG
    assert f"has the digest ffffffffffff, and the model has {digest()[:12]}" in (
        capsys.readouterr().err
    )
    Path(path).write_text(lines + "END\n", encoding="ascii")
    assert main(["analyse", str(MODEL), "--observed", path]) == WRONG
    assert "the trace has no digest" in capsys.readouterr().err
