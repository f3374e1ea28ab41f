# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How long a user waits: start, check, generate, and generate and build where nothing changed.

Beside the figures before the commands imported what they need when they are called, and the aims.
Each is the best of some calls in a process of its own, with what other calls have kept. It is the
processor time, its children's included: other programs on the machine change that little. Modules
are compiled before, as those of an installed package are.
"""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ravenchart.paths import ROOT

ROUNDS = 5


@dataclass(frozen=True, slots=True)
class Wait:
    """A call for the robot, in seconds: the time before, and the aim."""

    name: str
    words: tuple[str, ...]
    before: float | None
    aim: float

    def shown(self, now: float) -> str:
        """The line of the figures."""
        before = "    -   " if self.before is None else f"{1e3 * self.before:5.0f} ms"
        verdict = "" if now <= self.aim else " (more)"
        return (
            f"  {self.name:<26} before {before}  now {1e3 * now:5.0f} ms  "
            f"aim {1e3 * self.aim:4.0f} ms{verdict}"
        )


WAITS = (
    Wait("--help", ("--help",), 1.8, 0.15),
    Wait("check", ("check", "model.yaml"), 1.6, 0.4),
    Wait("generate", ("generate", "model.yaml"), None, 1.0),
    Wait("generate, nothing changed", ("generate", "model.yaml"), None, 0.5),
    Wait("build, nothing changed", ("build", "model.yaml"), None, 0.5),
)


def measured() -> list[tuple[Wait, float]]:
    """Each call with its time, in a copy of the robot's folder."""
    with tempfile.TemporaryDirectory(prefix="ravenchart-waiting-") as place:
        folder = Path(place) / "robot"
        shutil.copytree(ROOT / "examples" / "cartesian_robot", folder)
        _seconds(("build", "model.yaml"), folder)  # compiles the modules, too
        found = []
        for wait in WAITS:
            spent = []
            for _ in range(ROUNDS):
                if wait.name == "generate":
                    shutil.rmtree(folder / "generated")
                spent.append(_seconds(wait.words, folder))
            found.append((wait, min(spent)))
        return found


def _seconds(words: Sequence[str], folder: Path) -> float:
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    environment |= {"PYTHONSAFEPATH": "1", "PYTHONPYCACHEPREFIX": str(folder.parent / "compiled")}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [sys.executable, "-P", "-m", "ravenchart", *words],
        cwd=folder,
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=True,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """The figures."""
    print(f"waiting for a command, the Cartesian robot (best of {ROUNDS}):")
    for wait, now in measured():
        print(wait.shown(now))


if __name__ == "__main__":
    main()
