# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Every listing of the docs is checked by its language, or has a reason why it is not.

YAML, Ada and Python have files of their own beside this one.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest

from ravenchart.analysis.plain.bounds import read_bounds
from ravenchart.analysis.plain.build import PlainSystem, load_plain
from ravenchart.command_line import main, whole_parser
from ravenchart.evidence import lists
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from tests.support.listings import Listing, calls, listings, script

LISTINGS = tuple(listings())
LANGUAGES = {
    "ada", "console", "diff", "lisp", "lua", "python", "sh", "text", "toml", "yaml", "{toctree}"
}  # fmt: skip


def of(*languages: str) -> pytest.MarkDecorator:
    """A test for each listing in one of these languages."""
    chosen = [one for one in LISTINGS if one.language in languages]
    assert chosen
    return pytest.mark.parametrize(
        "listing", chosen, ids=[f"{Path(one.page).stem}-{one.line}" for one in chosen]
    )


def test_every_listing_has_a_language_that_is_checked() -> None:
    assert {one.language for one in LISTINGS} == LANGUAGES
    assert len({one.key for one in LISTINGS if one.language == "text"}) == len(
        [one for one in LISTINGS if one.language == "text"]
    )


# --- Commands ------------------------------------------------------------------------

PROGRAMS = {
    "cantools": "of the Python package of that name",
    "[": "of the shell",
    "cat": "of the system",
    "cd": "of the shell",
    "code": "of Visual Studio Code",
    "cp": "of the system",
    "echo": "of the shell",
    "dask": "of the Python package distributed",
    "gprbuild": "of gprbuild",
    "ip": "of iproute2",
    "jq": "of the Debian package of that name",
    "npm": "of Node.js",
    "npx": "of Node.js",
    "printf": "of the shell",
    "stty": "of the system",
    "./infusion_system_main": "the program of the pump",
    "build/.../checks/NAME_main": "the program of a model",
    "build/by_hand_main": "the program of the example",
}
"""Programs in listings besides `ravenchart`, `make` and `python`, and whose they are."""


@of("sh", "console")
def test_a_shell_reads_the_commands_of_a_listing(listing: Listing) -> None:
    done = subprocess.run(
        ["bash", "-n"], input=script(listing), capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert list(calls(script(listing)))


@of("sh", "console")
def test_every_call_is_one_that_its_program_takes(listing: Listing) -> None:
    targets = (ROOT / "Makefile").read_text(encoding="utf-8")
    for words in calls(script(listing)):
        program = words[0].removeprefix(".venv/bin/")
        if program == "ravenchart":
            assert whole_parser().parse_args(words[1:]).command, words
        elif program == "make":
            assert all(f"\n{target}:" in targets for target in words[1:]), words
        elif program == "python":
            assert is_module(words[words.index("-m") + 1]), words
        else:
            assert program in PROGRAMS, words
        lost = [
            word for word in words if word.startswith(("examples/", "tests/", "scripts/"))
            and not (ROOT / word).exists()
        ]  # fmt: skip
        assert lost == []


def is_module(name: str) -> bool:
    """Whether `python -m` finds it; the independent checker is copied before it is called."""
    path = name.replace("independent", "ravenchart.independent", 1).replace(".", "/")
    return name == "pip" or (ROOT / path).is_dir() or (ROOT / f"{path}.py").is_file()


def test_no_program_is_named_that_no_listing_calls() -> None:
    every = [one for one in LISTINGS if one.language in ("sh", "console")]
    called = {words[0] for one in every for words in calls(script(one))}
    assert set(PROGRAMS) - called == set()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "ravenchart check m.yaml --gone > out.txt  # why",
            [["ravenchart", "check", "m.yaml", "--gone"]],
        ),
        ("A=1 make x && sudo ip link 2>/dev/null", [["make", "x"], ["ip", "link"]]),
        ("a b \\\n  c | d 'e | f'; g < h", [["a", "b", "c"], ["d", "e | f"], ["g"]]),
    ],
)
def test_calls_are_found_in_a_script(text: str, expected: list[list[str]]) -> None:
    assert list(calls(text)) == expected


# --- Settings and data ----------------------------------------------------------------


@of("toml")
def test_toml_is_read(listing: Listing) -> None:
    assert tomllib.loads(listing.text)


@of("lua", "lisp")
def test_settings_of_editors_close_what_they_open(listing: Listing) -> None:
    """No interpreter of these languages is among our tools."""
    opened = []
    for sign in listing.text:
        if sign in "([{":
            opened.append(sign)
        elif sign in ")]}":
            assert opened.pop() + sign in ("()", "[]", "{}")
    assert opened == []


# --- Output, and files of data -------------------------------------------------------

OUTPUT = {
    ("docs/architecture.md", "model.yaml ──load──> System"): "a drawing",
    ("docs/boards.md", "model.yaml:12:3: error: the offset"):
        "tests/unit/ravenchart/test_targets.py",
    ("docs/devices.md", "model.yaml:44:11: error: Door calls Move where Motion does not allow it: "
     "Closed -Stop-> Closed [RV-1112]"): "tests/unit/behaviour/test_protocols.py",
    ("docs/command-line.md", "--- 14:03:22 check model.yaml ---"): "tests/system/test_watch.py",
    ("docs/command-line.md", "compile controller: 31 of 55"):
        "tests/unit/ravenchart/test_progress.py",
    ("docs/contracts.md", "generated/tank_house-upper.adb:105:22"):
        "tests/system/test_contracts_proved.py",
    ("docs/execution-times.md", "execution times: Home, two moves"): "figures of an emulated board",
    ("docs/getting-started.md", "user/tank_system-plant-activities.adb:11:24"):
        "tests/system/test_getting_started.py",
    ("docs/memory.md", "model.yaml:64:3: error: the stack of control"):
        "tests/system/test_stack_bounds.py",
    ("docs/memory.md", "built build/cartesian_robot-slcan"): "tests/system/test_stack_bounds.py",
    ("docs/monitor.md", "Infusion_System on board: process 29011"): "figures of a live controller",
    ("docs/monitor.md", "task    "): "tests/unit/analysis/test_streams.py",
    ("docs/monitor.md", "ward: ravenchart "): "figures of a live bus",
    ("docs/semantics.md", "start: "): "tests/system/test_semantics_page.py",
    ("examples/crossing/README.md", "0.000 "): "tests/system/test_examples_charts.py",
    ("examples/fatigue_rig/README.md", "0.055 "): "tests/system/test_examples_charts.py",
    ("examples/pump/README.md", "0.000 "): "tests/system/test_examples_charts.py",
    ("examples/qhsmtst/README.md", "0.000 "): "tests/system/test_examples_charts.py",
}  # fmt: skip
"""Output that is not compared here: the test that does, or the reason that none does."""


def excuses(listing: Listing) -> list[tuple[str, str]]:
    """The entries of OUTPUT for a listing."""
    return [key for key in OUTPUT if listing.page == key[0] and listing.first.startswith(key[1])]


def test_output_is_compared_or_has_a_reason() -> None:
    texts = [one for one in LISTINGS if one.language == "text"]
    compared = {
        ("docs/crates.md", PROJECT),
        ("docs/evidence.md", "id,text"),
        ("docs/execution-times.md", "# an empty line ends a block"),
        ("docs/plain-files.md", "task,core,priority,period_ms,deadline_ms,wcet_us"),
        ("docs/semantics.md", SAFE),
    }
    assert [one.key for one in texts if one.key not in compared and len(excuses(one)) != 1] == []
    assert compared <= {one.key for one in texts}
    assert {key for one in texts for key in excuses(one)} == set(OUTPUT)
    tests = [ROOT / reason for reason in OUTPUT.values() if reason.startswith("tests/")]
    assert [path for path in tests if not path.is_file()] == []


def listing_of(page: str, first: str) -> str:
    """The text of one listing."""
    (found,) = [one.text for one in LISTINGS if one.key == (page, first)]
    return found


PROJECT = 'with "config/can_by_hand_config.gpr";'


def test_the_project_of_a_consumer_is_that_which_is_built() -> None:
    built = (ROOT / "tests" / "can_crate" / "can_by_hand.gpr").read_text(encoding="utf-8")
    assert built.endswith(listing_of("docs/crates.md", PROJECT))


def test_the_plain_file_of_its_page_is_analysed() -> None:
    page, first = "docs/plain-files.md", "task,core,priority,period_ms,deadline_ms,wcet_us"
    system = load_plain(listing_of(page, first), page)
    assert isinstance(system, PlainSystem)
    assert {task.name for task in system.network.tasks} == {"position", "plan"}
    assert system.network.sections


def test_the_bounds_of_their_page_are_read() -> None:
    page = "docs/execution-times.md"
    system = load(ROOT / "examples" / "cartesian_robot" / "model.yaml").system
    assert system is not None
    found = read_bounds(listing_of(page, "# an empty line ends a block"), page, system)
    assert isinstance(found, dict) and len(found) == 2


def test_the_requirements_of_their_page_are_read(tmp_path: Path) -> None:
    (tmp_path / "list.csv").write_text(listing_of("docs/evidence.md", "id,text"), encoding="utf-8")
    assert [one.id for one in lists.read(tmp_path / "list.csv")] == ["R-7", "R-12"]


SAFE = (
    "Pump.Infusion: its code has contracts of 3 invariants: alarm_while_running, "
    "alarm_without_sound, overdose"
)


def test_check_prints_what_the_page_says_of_invariants(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(ROOT / "examples" / "pump" / "model.yaml")]) == 0
    assert listing_of("docs/semantics.md", SAFE) in capsys.readouterr().out


def session(page: str, command: str) -> tuple[str, str]:
    """A command of a session, and the lines that it prints."""
    (found,) = [one for one in LISTINGS if one.page == page and one.first.startswith(command)]
    first, _, rest = found.text.partition("\n")
    return first, rest


def test_the_answer_for_programs_has_the_line_and_the_code_of_the_page(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, printed = session("docs/command-line.md", "$ ravenchart check wrong.yaml --json")
    assert main(["explain", "RV-0305", "--wrong"]) == 0
    (tmp_path / "wrong.yaml").write_text(capsys.readouterr().out, encoding="utf-8")
    assert main(["check", str(tmp_path / "wrong.yaml"), "--json"]) == 1
    answer = json.loads(capsys.readouterr().out)
    shown = [f"{one['line']}: {one['code']}\n" for one in answer["diagnostics"]]
    assert "".join(shown) == printed
    watched = listing_of("docs/command-line.md", "--- 14:03:22 check model.yaml ---")
    (one,) = answer["diagnostics"]
    place = f"model.yaml:{one['line']}:{one['column']}"
    assert f"\n{place}: error: {one['message']} [{one['code']}]\n" in watched


def test_the_checker_finds_what_its_page_shows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command, printed = session("docs/independent-checker.md", "$ ravenchart check-certificate")
    name = command.split("/")[1]
    folder = Path(shutil.copytree(ROOT / "examples" / name, tmp_path / name))
    certificate = folder / "generated" / "three_components-timing_certificate.ads"
    text = certificate.read_text(encoding="utf-8")
    right = "Processor_3_B : constant := Board_Critical_Section;"
    assert text.count(right) == 1
    certificate.write_text(text.replace(right, "Processor_3_B : constant := 0;"), encoding="utf-8")
    assert main(["check-certificate", str(folder / "model.yaml")]) == 1
    assert printed in capsys.readouterr().err.replace(f"{folder}/", "")
