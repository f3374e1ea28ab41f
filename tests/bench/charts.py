# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures of a chart: generated code against nested case statements, in time and in bytes."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

from ravenchart.building import checking, generation
from ravenchart.building.generation import replace_file
from ravenchart.failures import ToolFailed
from ravenchart.gen.emit.program import generate
from ravenchart.paths import ROOT
from ravenchart.tools import toolchain

HERE = ROOT / "tests" / "ada" / "charts"
MOST = 1.1
"""What generated code may take, in times of the hand-written."""
CROSS = ("arm-linux-gnueabihf-gcc-12", "arm-linux-gnueabihf-gcc")
CROSS_HINT = (
    "install the Debian package gnat-12-arm-linux-gnueabihf "
    "(arm-none-eabi-gcc of Debian knows no Ada)"
)
CROSS_SWITCHES = (
    *("-O2", "-gnatp", "-fno-tree-switch-conversion", "-freorder-blocks-algorithm=simple"),
    *("-gnat2012", "-mthumb"),
)
"""Those of the release mode in ravenchart.gpr, and the language of switches.gpr."""
REGION = "chart_bench-unit-motion"
_LINE = re.compile(r"(.*): generated +([\d.]+) ns, hand-written +([\d.]+) ns")


def main() -> None:
    """Build, run and measure."""
    home = ROOT / "build" / "bench-charts"
    source = home / "generated"
    source.mkdir(parents=True, exist_ok=True)
    checked = checking.check(HERE / "model.yaml")
    for name, text in generate(checked.system, generation.claims(checked)).items():
        replace_file(source / name, text)
    variables = {
        "MODE": "release",
        "RAVENCHART_GENERATED": str(source),
        "RAVENCHART_BUILD": str(home / "objects"),
    }
    options = ["-p", "-q", "-P", "bench_charts.gpr"]
    toolchain.run("gprbuild", options, HERE, variables)
    print("a chart, generated against hand-written (-O2, checks off; shortest of 25 rounds):")
    times(home / "objects" / "bench_charts")
    print("object code of its region, in bytes:")
    objects = home / "objects"
    size("this machine", "size", objects / f"{REGION}.o", objects / "hand_written.o")
    cross_size(source, home / "arm")


def times(program: Path) -> None:
    """Run the comparison and print the ratios."""
    done = subprocess.run([program], capture_output=True, text=True, timeout=60, check=True)
    for line in done.stdout.splitlines():
        match = _LINE.fullmatch(line)
        assert match is not None, line
        what, generated, written = match.group(1), float(match.group(2)), float(match.group(3))
        ratio = generated / written
        verdict = "" if ratio <= MOST else f" (more than {MOST})"
        print(f"  {what}: {generated} ns, by hand {written} ns: {ratio:.2f} times{verdict}")


def size(where: str, tool: str, generated: Path, written: Path) -> None:
    """Print the sizes of both object files; tables in RAM would be in .data or .bss."""
    for what, path in (("generated", generated), ("by hand", written)):
        table = subprocess.run([tool, "-A", path], capture_output=True, text=True, check=True)
        found = dict(re.findall(r"^(\.\S+) +(\d+)", table.stdout, re.M))
        code = _sum(found, ".text")
        constants = _sum(found, ".rodata")
        ram = f".data {_sum(found, '.data')}, .bss {_sum(found, '.bss')}"
        print(f"  {where}, {what}: code {code}, constants {constants}, {ram}")


def _sum(found: dict[str, str], section: str) -> int:
    return sum(
        int(n) for name, n in found.items() if name == section or name.startswith(f"{section}.")
    )


def cross_size(source: Path, home: Path) -> None:
    """The same for 32-bit Arm, when its compiler is there."""
    compiler = next((c for c in CROSS if shutil.which(c)), None)
    if compiler is None:
        print(f"  32-bit Arm: no compiler; {CROSS_HINT}")
        return
    home.mkdir(parents=True, exist_ok=True)
    folders = [source, HERE, ROOT / "spark_runtime" / "src"]
    command = [compiler, "-c", *CROSS_SWITCHES, *(f"-I{f}" for f in folders)]
    for path in (source / f"{REGION}.adb", HERE / "hand_written.adb"):
        done = subprocess.run(
            [*command, path], cwd=home, capture_output=True, text=True, check=False
        )
        if done.returncode != 0:
            raise ToolFailed(done.stderr)
    tool = re.sub(r"gcc(-\d+)?$", "size", compiler)
    size("32-bit Arm (Thumb-2)", tool, home / f"{REGION}.o", home / "hand_written.o")
