# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A guest of QEMU in which `make hw-test` tries the drivers of CAN controllers.

The guest runs Debian's kernel, sees the root of this machine read-only, and has a virtual
interface, vcan0, two emulated SJA1000 on one bus, can0 and can1, and two cards with two
emulated CTU CAN FD each, for which it has no driver: one on the same bus, one on its own.
It runs a program for each step, and leaves output and exit status in a folder of this machine.
"""

from __future__ import annotations

import json
import shlex
import shutil
import subprocess
import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ravenchart.building import checking, generation, programs
from ravenchart.paths import ROOT
from ravenchart.tools import toolchain

QEMU = "qemu-system-x86_64"
KERNEL = ROOT / "build" / "guest"
"""Where `scripts/setup.sh guest` unpacks the kernel: boot/ and lib/modules/."""

HOME = ROOT / "build" / "hw-test"
INIT = ROOT / "scripts" / "guest_init.sh"
MODULES = ("virtio_pci", "9pnet_virtio", "9p", "can-raw", "vcan", "sch_tbf", "kvaser_pci")
MODE = "checks"
PROGRAMS = {
    "socketcan": ("can_echo.adb",),
    "ctucanfd": ("can_echo.adb", "test_ctu_cores.adb", "test_ctu_driver.adb"),
}
"""What is built with each driver."""

PATIENCE = 1_200
"""Seconds after which a guest is given up; it needs about a minute."""

LIMIT = 300
"""Seconds for one step of it."""

CARDS = "/sys/bus/pci/devices/0000:00:{:02x}.0/resource1"
"""The registers of a card with CTU CAN FD in the guest, by its slot."""

SHARED_SLOT, OWN_SLOT = 0x10, 0x11
"""Of the card on the bus of the SJA1000, and of the one that has a bus of its own."""

TAIL = 15
"""Lines that are shown of a guest's console."""

PASSED, FAILED, SKIPPED = "passed", "failed", "skipped"
"""How a case of a step ended."""


@dataclass(frozen=True, slots=True)
class Step:
    """One program to run in the guest; with ``in_json`` it prints its cases as JSON."""

    name: str
    command: tuple[str, ...]
    in_json: bool = False


@dataclass(frozen=True, slots=True)
class GuestCase:
    """One thing that a step tried, and how that ended."""

    name: str
    verdict: str
    detail: str = ""


@dataclass(frozen=True, slots=True)
class Guest:
    """A guest that has run: its folder, and why it ended early, if it did."""

    home: Path
    trouble: str = ""

    def said(self, step: Step) -> str:
        """All that a step printed, or how the guest ended if it never came to it."""
        texts = [self.home / "results" / f"{step.name}.{end}" for end in ("out", "err")]
        found = [text.read_text(encoding="utf-8", errors="replace") for text in texts if _is(text)]
        return "\n".join(found or [self.trouble, _tail(self.home / "console.txt")])

    def cases(self, step: Step) -> tuple[GuestCase, ...]:
        """What a step tried: nothing when it has no result."""
        results = self.home / "results"
        status, output = results / f"{step.name}.status", results / f"{step.name}.out"
        if not (_is(status) and _is(output)):
            return ()
        text = output.read_text(encoding="utf-8", errors="replace")
        if step.in_json:
            return _cases_in_json(text)
        return facts(text, int(status.read_text(encoding="utf-8")))


def facts(output: str, status: int) -> tuple[GuestCase, ...]:
    """The "ok" and "not ok" lines of a program, and that it ends with status 0 if all hold."""
    found = [
        GuestCase(
            line.removeprefix("not ").removeprefix("ok "),
            PASSED if line.startswith("ok ") else FAILED,
        )
        for line in output.splitlines()
        if line.startswith(("ok ", "not ok "))
    ]
    if not found:
        found.append(GuestCase("it says a fact", FAILED))
    if status != 0 and all(case.verdict == PASSED for case in found):
        found.append(GuestCase("it ends with status 0", FAILED, f"it ended with {status}"))
    return tuple(found)


def _cases_in_json(text: str) -> tuple[GuestCase, ...]:
    """The cases of a conformance suite, as `ravenchart loopback --json` prints them."""
    try:
        result = json.loads(text)["result"]
    except ValueError:
        return ()
    if result is None:
        return ()
    return tuple(GuestCase(one["name"], one["verdict"], one["detail"]) for one in result["cases"])


def steps(python: str, objects: Path, controller: Path) -> tuple[Step, ...]:
    """What is run in the guest, in this order; ``objects`` is obj/ of the checkout.

    ``controller`` is that of the crossing.
    """
    module = (python, "-P", "-m")
    loopback = (*module, "ravenchart", "loopback", "--json", "--interface", "socketcan")
    driver = (*module, "tests.hardware.driver", "--json")
    remote = (*module, "tests.hardware.remote")
    socketcan, ctucanfd = (
        objects / f"tests-{MODE}-{name}" / "bin" for name in ("socketcan", "ctucanfd")
    )
    shared, own = CARDS.format(SHARED_SLOT), CARDS.format(OWN_SLOT)
    echo = str(socketcan / "can_echo")
    card = (str(ctucanfd / "can_echo"), f"{shared}:1", "--driver", "ctucanfd")
    with_own = ("env", f"RAVENCHART_CTUCANFD={own}")
    return (
        Step("loopback-vcan0", (*loopback, "--channel", "vcan0", "--fd"), in_json=True),
        Step("driver-vcan0", (*driver, echo, "vcan0"), in_json=True),
        Step("remote-vcan0", (*remote, str(controller), "vcan0")),
        Step("driver-can0", (*driver, echo, "can0", "--near", "can1", "--emulated"), in_json=True),
        Step("driver-ctucanfd", (*driver, *card, "--near", "can0", "--emulated"), in_json=True),
        Step("registers-ctucanfd", (*with_own, str(ctucanfd / "test_ctu_cores"))),
        Step("frames-ctucanfd", (*with_own, str(ctucanfd / "test_ctu_driver"))),
    )


def script(chosen: Sequence[Step]) -> str:
    """The steps as the guest's shell runs them, in the folder of results."""
    lines = []
    for step in chosen:
        command = shlex.join(("timeout", str(LIMIT), *step.command))
        lines.append(f"{command} > {step.name}.out 2> {step.name}.err\n")
        lines.append(f"echo $? > {step.name}.status\n")
    return "".join(lines)


def missing(kernel: Path, architecture: str) -> Iterator[str]:
    """Why there can be no guest on this machine: nothing when there can."""
    if architecture != "x86_64":
        yield f"programs for {architecture} do not run in a guest that is an x86_64"
    if shutil.which(QEMU) is None:
        yield f"{QEMU} is not on PATH (Debian package qemu-system-x86)"
    busybox = shutil.which("busybox")
    if busybox is None or b"/ld-linux" in Path(busybox).read_bytes():
        yield "there is no static busybox on PATH (Debian package busybox-static)"
    if not toolchain.have("ip"):
        yield "ip is not on PATH (Debian package iproute2)"
    if not list(kernel.glob("boot/vmlinuz-*")):
        yield f"there is no kernel in {kernel} (`scripts/setup.sh guest` gets Debian's)"


def load_order(dependencies: str, wanted: Sequence[str]) -> tuple[str, ...]:
    """Paths of the modules ``wanted`` and of what they need, each behind what it needs.

    ``dependencies`` is modules.dep of depmod(8): it names for each module all that it needs,
    the last needed first. A module that is not there is in the kernel or not to be had.
    """
    needs: Mapping[str, list[str]] = {
        path: needed.split()
        for path, _, needed in (line.partition(":") for line in dependencies.splitlines())
    }
    by_name = {Path(path).name.partition(".")[0].replace("-", "_"): path for path in needs}
    order: dict[str, None] = {}
    for name in wanted:
        path = by_name.get(name.replace("-", "_"))
        if path is not None:
            order.update(dict.fromkeys((*reversed(needs[path]), path)))
    return tuple(order)


def make_initramfs(kernel: Path, home: Path) -> Path:
    """busybox, the modules and INIT as the archive that a kernel starts from."""
    busybox = shutil.which("busybox")
    assert busybox is not None
    modules = next(kernel.glob("lib/modules/*"))
    subprocess.run([busybox, "depmod", "-b", kernel, modules.name], check=True)
    order = load_order((modules / "modules.dep").read_text(encoding="utf-8"), MODULES)
    stage = home / "initramfs"
    shutil.rmtree(stage, ignore_errors=True)
    for folder in ("bin", "proc", "sys", "dev", "modules", "machine"):
        (stage / folder).mkdir(parents=True)
    shutil.copy(busybox, stage / "bin" / "busybox")
    shutil.copy(INIT, stage / "init")
    (stage / "init").chmod(0o755)
    for path in order:
        shutil.copy(modules / path, stage / "modules")
    names = "".join(f"{Path(path).name}\n" for path in order)
    (stage / "modules" / "order").write_text(names, encoding="utf-8")
    told = f"CHECKOUT={shlex.quote(str(ROOT))}\nRESULTS={shlex.quote(str(home / 'results'))}\n"
    (stage / "told").write_text(told, encoding="utf-8")
    archive = home / "initramfs.cpio"
    listed = "\n".join(str(path.relative_to(stage)) for path in sorted(stage.rglob("*")))
    with archive.open("wb") as out:
        subprocess.run(
            [busybox, "cpio", "-o", "-H", "newc"],
            input=listed.encode() + b"\n", cwd=stage, stdout=out, stderr=subprocess.DEVNULL,
            check=True,
        )  # fmt: skip
    return archive


def boot(kernel: Path, archive: Path, home: Path) -> None:
    """Run the guest to its end; subprocess.TimeoutExpired when it finds none."""
    shared = "security_model=none,multidevs=remap"
    subprocess.run(
        [
            QEMU, "-accel", "tcg", "-M", "pc", "-cpu", "max", "-m", "768",
            "-nodefaults", "-no-user-config", "-no-reboot", "-display", "none",
            "-serial", f"file:{home / 'console.txt'}",
            "-object", "can-bus,id=bus",
            "-device", "kvaser_pci,canbus=bus",
            "-device", "kvaser_pci,canbus=bus",
            "-device", f"ctucan_pci,canbus0=bus,canbus1=bus,addr={SHARED_SLOT:#x}",
            "-object", "can-bus,id=other",
            "-device", f"ctucan_pci,canbus0=other,canbus1=other,addr={OWN_SLOT:#x}",
            "-fsdev", f"local,id=machine,path=/,readonly=on,{shared}",
            "-device", "virtio-9p-pci,fsdev=machine,mount_tag=machine",
            "-fsdev", f"local,id=results,path={home / 'results'},{shared}",
            "-device", "virtio-9p-pci,fsdev=results,mount_tag=results",
            "-kernel", str(next(kernel.glob("boot/vmlinuz-*"))),
            "-initrd", str(archive),
            "-append", "console=ttyS0 quiet panic=-1",
        ],
        stdin=subprocess.DEVNULL, check=True, timeout=PATIENCE,
    )  # fmt: skip


def _is(path: Path) -> bool:
    """Whether there is a file that has been written."""
    return path.is_file() and path.stat().st_size > 0


def _tail(path: Path) -> str:
    """The last lines of a text, if there is one."""
    if not path.exists():
        return f"(no {path.name})"
    text = path.read_text(encoding="utf-8", errors="replace")
    return "\n".join(text.splitlines()[-TAIL:])


def crossing() -> Path:
    """The controller of the crossing with the driver of SocketCAN, built."""
    checked = checking.check(ROOT / "examples" / "crossing" / "model.yaml")
    generation.write_program(checked)
    return programs.programs_of(checked)[0].build(driver="socketcan")


def _build() -> None:
    """The Ada programs with the drivers."""
    for driver, mains in PROGRAMS.items():
        options = ["-p", "-q", "-j0", "-P", "tests.gpr", *mains]
        scenario = {"MODE": MODE, "CAN_DRIVER": driver}
        toolchain.run("gprbuild", options, ROOT / "tests" / "ada", scenario)


def run(wanted: Collection[str]) -> Guest:
    """Build, boot and run the steps of these names; ToolMissing or ToolFailed before that."""
    shutil.rmtree(HOME / "results", ignore_errors=True)
    (HOME / "results").mkdir(parents=True)
    _build()
    every = steps(sys.executable, ROOT / "obj", crossing())
    chosen = script([step for step in every if step.name in wanted])
    (HOME / "results" / "steps").write_text(chosen, encoding="utf-8")
    try:
        boot(KERNEL, make_initramfs(KERNEL, HOME), HOME)
    except subprocess.SubprocessError as problem:
        return Guest(HOME, f"the guest: {problem}")
    return Guest(HOME)
