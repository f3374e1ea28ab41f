# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The runtime, the HAL and generated programs ask for nothing that a bare board lacks."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from ravenchart.paths import ROOT

pytestmark = pytest.mark.slow

RUNTIME = ROOT / "spark_runtime"
HAL = tuple(ROOT / "hw_can" / name for name in ("hal", "protocol", "simulator"))
DRIVERS = ROOT / "hw_can" / "drivers"
CONTROLLERS = ROOT / "hw_can" / "hal" / "ravenchart-can-controllers.adb"
SUBUNIT = "ravenchart-can-controllers-driver.adb"
"""The driver proper: it is compiled with its parent."""

OF_THE_HOST = {
    "ravenchart-can-ctu_hosts.adb",
    "ravenchart-can-driver_hosts.adb",
    "ravenchart-failures.adb",
    "ravenchart-hosts-services.adb",
    "ravenchart-hosts-snapshots.adb",
}
"""Bodies that ask Linux, which a board replaces by its own."""

MODES = {"checks": ("-O0", "-gnata"), "release": ("-O2", "-gnatp")}
EXAMPLES = ("cartesian_robot", "crossing", "pump", "three_components")


def units(*folders: Path) -> Iterator[Path]:
    """Each unit once: its body, or its spec where no folder or driver has a body."""
    places = (*folders, *DRIVERS.iterdir())
    bodies = {path.stem for folder in places for path in folder.glob("*.adb")}
    for folder in folders:
        for path in sorted(folder.glob("*.ad[bs]")):
            if path.name != SUBUNIT and (path.suffix == ".adb" or path.stem not in bodies):
                yield path


def refused(paths: list[Path], folders: list[Path], mode: str, where: Path) -> dict[str, str]:
    """What the compiler says of the units that it does not take."""
    pragmas = where / "board.adc"
    texts = [(RUNTIME / name).read_text() for name in ("ravenscar.adc", "restrictions.adc")]
    pragmas.write_text("".join(texts))
    options = ["-c", "-gnat2012", f"-gnatec={pragmas}", *MODES[mode]]
    searched = [f"-I{folder}" for folder in folders]

    def compiled(path: Path) -> str:
        home = where / path.parent.name
        home.mkdir(exist_ok=True)
        words = ["gcc", *options, *searched, str(path)]
        done = subprocess.run(words, cwd=home, capture_output=True, text=True)
        return "" if done.returncode == 0 else done.stderr

    with ThreadPoolExecutor(2) as pool:
        said = dict(zip(paths, pool.map(compiled, paths), strict=True))
    return {path.name: text for path, text in said.items() if text}


@pytest.mark.parametrize("mode", MODES)
def test_the_runtime_and_the_hal_keep_the_restrictions(mode: str, tmp_path: Path) -> None:
    common = [RUNTIME / "src", RUNTIME / "native", *HAL]
    paths = list(units(*common))
    found = refused(paths, [*common, DRIVERS / "loopback"], mode, tmp_path)
    for driver in sorted(DRIVERS.iterdir()):
        if any(driver.glob("*.ad[bs]")):
            shared = (DRIVERS / name for name in ("serial", "tcp", "sockets"))
            folders = [*common, driver, *shared]
            parent = [CONTROLLERS] if (driver / SUBUNIT).is_file() else []
            found |= refused([*units(driver), *parent], folders, mode, tmp_path)
    assert found.keys() == OF_THE_HOST, found
    assert all("violation of restriction" in text for text in found.values()), found


@pytest.mark.parametrize("mode", MODES)
def test_the_unit_of_a_board_that_takes_interrupts_keeps_them(mode: str, tmp_path: Path) -> None:
    """By the compiler of this machine: no run-time library of a board is needed for that."""
    board, common = RUNTIME / "zynqmp", RUNTIME / "src"
    paths = [
        board / "ravenchart-interrupt_lines.adb",
        common / "ravenchart-interrupt_sources.adb",
    ]
    assert refused(paths, [board, common], mode, tmp_path) == {}


@pytest.mark.parametrize("example", EXAMPLES)
def test_generated_programs_keep_the_restrictions_with_their_contracts(
    example: str, tmp_path: Path
) -> None:
    home = ROOT / "examples" / example
    own = [home / "generated", home / "user"]
    folders = [*own, RUNTIME / "src", RUNTIME / "native", *HAL, DRIVERS / "loopback"]
    paths = list(units(*own))
    assert paths
    assert refused(paths, folders, "checks", tmp_path) == {}
