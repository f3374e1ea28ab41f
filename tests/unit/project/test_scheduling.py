# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Proofs run after other tests, a processor each; then tests that run alone. Each runs once."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from tests.support import live

TESTS = """
import os, time, pytest

def note(name):
    with open(os.environ["NOTED"], "a") as file:
        file.write(f"{time.monotonic()} {name}\\n")

@pytest.mark.alone
@pytest.mark.parametrize("number", range(2))
def test_alone(number):
    note(f"alone-{number} begins")
    time.sleep(0.1)
    note(f"alone-{number} ends")

@pytest.mark.skipif(False, reason="gnatprove is not on PATH")
@pytest.mark.parametrize("number", range(6))
def test_proof(number):
    note(f"proof-{number} begins")
    time.sleep(0.3)
    note(f"proof-{number} ends")

@pytest.mark.live
@pytest.mark.parametrize("number", range(20))
def test_live(number):
    note(f"live-{number} begins")
    time.sleep(0.05)
    note(f"live-{number} ends")

@pytest.mark.parametrize("number", range(30))
def test_shared(number):
    note(f"shared-{number} begins")
    time.sleep(0.5 if number == 29 else 0.01)
    note(f"shared-{number} ends")
"""


def most_at_once(noted: list[tuple[str, str]]) -> int:
    """How many of these tests ran side by side at the most."""
    running = [1 if what == "begins" else -1 for _, what in noted]
    return max((sum(running[: at + 1]) for at in range(len(running))), default=0)


@pytest.mark.slow
@pytest.mark.clock
@pytest.mark.parametrize(
    "chosen",
    [
        (),
        ("alone",),
        ("alone[1]",),
        ("shared[29]",),
        ("proof[2]",),
        ("alone[0]", "proof[0]"),
        ("alone[0]", "shared[29]", "shared[3]"),
    ],
    ids=["all", "all alone", "one alone", "one", "one proof", "proof and alone", "few"],
)
def test_what_runs_alone_comes_last_and_runs_beside_nothing(
    tmp_path: Path, chosen: tuple[str, ...]
) -> None:
    module = tmp_path / "test_some.py"
    module.write_text(TESTS)
    named = [f"{module}::test_{one}" for one in chosen] or [str(module)]
    words = [sys.executable, "-P", "-m", "pytest", "-q", "-n", "3", "-p", "tests.conftest"]
    done = subprocess.run(
        [*words, "--rootdir", tmp_path, "-c", os.devnull, "-p", "no:cacheprovider", *named],
        cwd=ROOT,
        env={**os.environ, "NOTED": str(tmp_path / "noted"), live.LOCK: str(tmp_path / "live")},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    lines = [line.split() for line in (tmp_path / "noted").read_text().splitlines()]
    noted = [(name, what) for _, name, what in sorted(lines, key=lambda line: float(line[0]))]
    begun = [name for name, what in noted if what == "begins"]
    assert len(begun) == len(set(begun)) == {(): 58, ("alone",): 2}.get(chosen, len(chosen))
    alone = [one for one in noted if one[0].startswith("alone")]
    assert noted[len(noted) - len(alone) :] == alone
    assert [what for _, what in alone] == ["begins", "ends"] * (len(alone) // 2)
    lively = [one for one in noted if one[0].startswith("live")]
    assert [what for _, what in lively] == ["begins", "ends"] * (len(lively) // 2)
    side_by_side = most_at_once([one for one in noted if one[0].startswith("proof")])
    assert side_by_side <= len(os.sched_getaffinity(0))
    if not chosen:
        assert side_by_side == min(3, len(os.sched_getaffinity(0)))
        proofs = [at for at, (name, _) in enumerate(noted) if name.startswith("proof")]
        assert sum(name.startswith("shared") for name, _ in noted[proofs[0] :]) <= 4
        #  nobody waits for a live test while there is another one
        names = [name.partition("-")[0] for name, _ in noted]
        assert names.index("shared") < len(names) - names[::-1].index("live")
        assert names.index("live") < len(names) - names[::-1].index("shared")
