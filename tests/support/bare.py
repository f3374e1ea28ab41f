# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Images without a run-time library of others: Debian's compiler, our start code, QEMU."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

from ravenchart.paths import ROOT

HERE = ROOT / "tests" / "board"
MACHINE = "aarch64-linux-gnu"
EMULATOR = "qemu-system-aarch64"
NEEDED = {
    f"{MACHINE}-gnatmake": "gnat-12-aarch64-linux-gnu",
    f"{MACHINE}-gcc": "gcc-aarch64-linux-gnu",
    EMULATOR: "qemu-system-arm",
}
"""Programs, and the Debian packages that have them."""

SWITCHES = (
    *("-gnat2012", "-gnata", "-O1", "-fno-pic"),
    "-mstrict-align",  # memory is a device as long as the MMU is off
    *("-mno-outline-atomics", "-fno-stack-protector"),
    "-fno-tree-loop-distribute-patterns",  # a copy in Ada is no call of itself
)
OF_COMPILER = ("ada.ads", "interfac.ads", "a-unccon.ads", "s-stoele.ads", "s-stoele.adb")
"""Files of the compiler's own library without which there is no Ada; they have no state."""


def missing() -> str | None:
    """What is not installed, in words."""
    lost = [f"{name} ({package})" for name, package in NEEDED.items() if not shutil.which(name)]
    return f"not on PATH: {', '.join(lost)}" if lost else None


def image(main: str, folders: Sequence[Path], where: Path) -> Path:
    """The image of a main program, built in ``where``."""
    library = _library(where)
    objects = where / "objects"
    objects.mkdir()
    searched = [f"-I{folder}" for folder in (HERE / "bare", HERE, *folders)]
    options = [f"--RTS={library}", "-c", "-q", "-f", *searched, f"{main}.adb"]
    _run([f"{MACHINE}-gnatmake", *options, "-cargs", *SWITCHES], objects)
    _run([f"{MACHINE}-gnatbind", f"--RTS={library}", "-static", f"{main}.ali"], objects)
    compiler = f"{MACHINE}-gcc"
    _run([compiler, f"--RTS={library}", "-c", *SWITCHES, "-gnatws", f"b~{main}.adb"], objects)
    _run([compiler, "-c", str(HERE / "bare" / "start.S")], objects)
    linked = ["-nostdlib", "-static", "-no-pie", "-T", str(HERE / "bare" / "image.ld")]
    parts = [str(path) for path in sorted((*objects.glob("*.o"), *library.glob("adalib/*.o")))]
    _run([compiler, *linked, "-o", "image", *parts], objects)
    return objects / "image"


def emulated(program: Path, *options: str) -> tuple[int, str]:
    """Run an image on the emulated board; its status, and what it wrote on the serial line."""
    report = program.with_name("serial.txt")
    words = [
        *(EMULATOR, "-M", "xlnx-zcu102,secure=on,virtualization=on", "-m", "2G"),
        *("-display", "none", "-monitor", "none", "-serial", f"file:{report}"),
        *("-semihosting-config", "enable=on,target=native"),
        *("-icount", "shift=2,sleep=off,align=off", *options, "-kernel", str(program)),
    ]
    quiet = {**os.environ, "QEMU_AUDIO_DRV": "none"}
    done = subprocess.run(words, capture_output=True, env=quiet, timeout=120, check=False)
    return done.returncode, report.read_text(encoding="ascii")


def native(main: str, folders: Sequence[Path], where: Path) -> str:
    """What the same main program writes on this machine."""
    where.mkdir()
    searched = [f"-I{folder}" for folder in (HERE / "host", HERE, *folders)]
    _run(["gnatmake", "-q", "-f", *searched, f"{main}.adb", "-cargs", *SWITCHES[:2]], where)
    return _run([str(where / main)], where)


def _library(where: Path) -> Path:
    """The run-time library: our System, and what no Ada is without."""
    library = where / "library"
    sources, objects = library / "adainclude", library / "adalib"
    sources.mkdir(parents=True)
    objects.mkdir()
    root = Path(_run([f"{MACHINE}-gcc", "-print-libgcc-file-name"], where).strip()).parent
    own = sorted((HERE / "bare").glob("s*.ad[sb]"))
    for path in (*own, *(root / "adainclude" / name for name in OF_COMPILER)):
        shutil.copy(path, sources)
    for path in sorted(sources.iterdir()):
        if path.suffix == ".adb" or not path.with_suffix(".adb").exists():
            options = [f"--RTS={library}", "-c", "-gnatpg", "-gnatyN", *SWITCHES[1:], str(path)]
            _run([f"{MACHINE}-gcc", *options], objects)
    return library


def _run(words: Sequence[str], where: Path) -> str:
    done = subprocess.run(words, cwd=where, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(words)}\n{done.stdout}{done.stderr}"
    return done.stdout
