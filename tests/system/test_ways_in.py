# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Files in the working folder are never taken for modules of ours; ends have their statuses."""

from __future__ import annotations

import os
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from tests.support.processes import LAUNCHER, PYTHON, ROOT
from tests.support.progress import without_progress

MODEL = ROOT / "examples" / "pump" / "model.yaml"
HOSTILE = (
    "gen", "analysis", "behaviour", "ravenchart", "hw_can", "yaml", "lark", "rich", "jinja2",
    "networkx", "pydantic", "z3", "can", "cantools", "matplotlib", "argparse", "json", "signal",
)  # fmt: skip
"""Ours, those that we need, and some of Python itself."""


@pytest.fixture
def hostile(tmp_path: Path) -> Path:
    """A working folder in which every such module says that it was imported."""
    for name in HOSTILE:
        (tmp_path / f"{name}.py").write_text(f"raise SystemExit('imported: {name}')\n")
    return tmp_path


def console_script(folder: Path) -> Path:
    """The script that pip makes of the entry point, in a folder of its own."""
    scripts = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["scripts"]
    module, _, function = scripts["ravenchart"].partition(":")
    script = folder / "bin" / "ravenchart"
    script.parent.mkdir()
    start = f"""#!/bin/sh\n'''exec' "{PYTHON}" "$0" "$@"\n' '''\n"""  # as pip, for any path
    script.write_text(
        f"{start}import sys\nfrom {module} import {function}\nsys.exit({function}())\n"
    )
    script.chmod(0o755)
    return script


def called(words: list[str | Path], where: Path, **more: str) -> subprocess.CompletedProcess[str]:
    """A finished call."""
    environment = {**os.environ, **more}
    return subprocess.run(words, cwd=where, env=environment, capture_output=True, text=True)


def test_a_program_that_imports_the_tool_keeps_its_environment(tmp_path: Path) -> None:
    program = """if True:
        import os
        before = dict(os.environ)
        from ravenchart.building import checking
        assert dict(os.environ) == before
        """
    done = called([PYTHON, "-P", "-c", program], tmp_path, PYTHONPATH=str(ROOT))
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("way", ["launcher", "wheel", "safe module", "empty path"])
def test_modules_in_the_working_folder_are_not_imported(way: str, hostile: Path) -> None:
    more = {}
    words: list[str | Path] = [LAUNCHER]
    if way == "wheel":
        words = [console_script(hostile)]
    elif way == "safe module":
        words = [PYTHON, "-P", "-m", "ravenchart"]
    elif way == "empty path":  # an empty entry of PYTHONPATH stands for the working folder
        (hostile / "ravenchart.py").unlink()
        for name in ("argparse", "json", "signal"):
            (hostile / f"{name}.py").unlink()
        words, more = [console_script(hostile)], {"PYTHONPATH": f":{ROOT}"}
    done = called([*words, "check", MODEL], hostile, **more)
    assert (done.returncode, without_progress(done.stderr)) == (0, ""), done.stderr
    assert "every deadline is met" in done.stdout


def test_a_module_run_without_the_option_imports_nothing_of_the_folder(hostile: Path) -> None:
    """`python -m ravenchart`: only Python itself, before us, can be led astray."""
    for name in ("ravenchart", "argparse", "json", "signal"):
        (hostile / f"{name}.py").unlink()
    done = called([PYTHON, "-m", "ravenchart", "check", MODEL], hostile)
    assert (done.returncode, without_progress(done.stderr)) == (0, ""), done.stderr


def test_every_module_that_we_start_is_started_with_a_safe_path() -> None:
    sources = [ROOT / "Makefile", *sorted((ROOT / "ravenchart").rglob("*.py"))]
    sources += sorted((ROOT / "hw_can").rglob("*.py"))
    unsafe = [
        f"{path.name}: {line.strip()}"
        for path in sources
        for line in path.read_text(encoding="utf-8").splitlines()
        if re.search(r'PYTHON\) -m|(executable|python), "-m"', line) and "pytest" not in line
    ]
    assert unsafe == []


@pytest.mark.slow
def test_output_that_nobody_reads_is_no_error_with_words() -> None:
    plain = ROOT / "tests" / "plain" / "two_nodes.csv"
    for command in ((MODEL, "--json"), (MODEL,), (plain,)):
        reading, writing = os.pipe()
        os.close(reading)
        with os.fdopen(writing, "wb") as unread:
            done = subprocess.run(
                [LAUNCHER, "analyse", *command], stdout=unread, stderr=subprocess.PIPE, text=True
            )
        assert (done.returncode, without_progress(done.stderr)) == (141, "")


BROKEN = """
import sys
from ravenchart import start
from ravenchart.building import checking
def fails(*a, **k): raise IndexError("no such thing")
checking.check = fails
raise SystemExit(start.main(["check", "model.yaml"]))
"""


def test_an_internal_error_has_a_status_of_its_own() -> None:
    done = called([PYTHON, "-P", "-c", BROKEN], ROOT)
    assert done.returncode == 70
    assert "IndexError: no such thing" in done.stderr
    assert done.stderr.endswith(
        "ravenchart: internal error (above): a fault of Ravenchart, not of the model\n"
    )


LATE = "task,priority,period_ms,wcet_us\nlow,1,1,900\nhigh,2,1,200\n"


@pytest.mark.parametrize(("text", "status"), [(LATE, 1), (LATE.replace("900", "100"), 0)])
def test_a_missed_deadline_is_status_1(text: str, status: int, tmp_path: Path) -> None:
    plain = tmp_path / "set.csv"
    plain.write_text(text)
    assert called([LAUNCHER, "analyse", plain], tmp_path).returncode == status


@pytest.mark.slow
def test_a_wrong_call_and_a_missing_file_are_status_2(tmp_path: Path) -> None:
    assert called([LAUNCHER, "analyse"], tmp_path).returncode == 2
    assert called([LAUNCHER, "loopback", "--interface", "none"], tmp_path).returncode == 2
