"""`make hw-test`: SocketCAN and the driver for it, on interfaces of a guest of QEMU.

The guest runs Debian's kernel, sees the root of this machine read-only, and has a virtual
interface, vcan0, and two emulated SJA1000 on one bus, can0 and can1. Exit status: 0 all that
was run passed; 1 something failed; 2 nothing could be run, for the reasons printed.
"""

from __future__ import annotations

import platform
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from . import toolchain
from .toolchain import ROOT, ToolFailed, ToolMissing

QEMU = "qemu-system-x86_64"
KERNEL = ROOT / "build" / "guest"
"""Where `scripts/setup.sh guest` unpacks the kernel: boot/ and lib/modules/."""

HOME = ROOT / "build" / "hw-test"
INIT = ROOT / "scripts" / "guest_init.sh"
MODULES = ("virtio_pci", "9pnet_virtio", "9p", "can-raw", "vcan", "sch_tbf", "kvaser_pci")
PATIENCE = 1_200
"""Seconds after which a guest is given up; it needs about a minute."""

LIMIT = 300
"""Seconds for one step of it."""

TAIL = 15
"""Lines that are shown of a guest's console, or of a step without a result."""


@dataclass(frozen=True, slots=True)
class Step:
    """One program to run in the guest, which writes JUnit XML to ``name``.xml."""

    name: str
    command: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Total:
    """What all steps came to; ``lost`` names those without a result."""

    passed: int
    failed: int
    skipped: int
    lost: tuple[str, ...]

    @property
    def good(self) -> bool:
        """Nothing failed, nothing was lost, and something passed."""
        return self.passed > 0 and self.failed == 0 and not self.lost


def steps(python: str, program: Path) -> tuple[Step, ...]:
    """What is run in the guest, in this order."""
    loopback = (python, "-m", "ravenchart.loopback", "--interface", "socketcan", "--channel")
    driver = (python, "-m", "ravenchart.driver_test", str(program))
    return (
        Step("loopback-vcan0", (*loopback, "vcan0", "--fd")),
        Step("driver-vcan0", (*driver, "vcan0")),
        Step("driver-can0", (*driver, "can0", "--near", "can1", "--emulated")),
    )


def script(chosen: Sequence[Step]) -> str:
    """The steps as the guest's shell runs them, in the folder of results."""
    lines = []
    for step in chosen:
        told = ("timeout", str(LIMIT), *step.command, "--junit", f"{step.name}.xml")
        lines.append(f"{shlex.join(told)} > {step.name}.txt 2>&1\n")
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


def total(chosen: Sequence[Step], results: Path) -> Total:
    """What the guest has written; a step without a well-formed result is lost."""
    passed = failed = skipped = 0
    lost = []
    for step in chosen:
        try:
            root = ElementTree.parse(results / f"{step.name}.xml").getroot()
        except (OSError, ElementTree.ParseError):
            lost.append(step.name)
            continue
        for case in root.iter("testcase"):
            kinds = {child.tag for child in case}
            failed += "failure" in kinds
            skipped += "skipped" in kinds
            passed += not kinds & {"failure", "skipped"}
    return Total(passed, failed, skipped, tuple(lost))


def _tail(path: Path) -> str:
    """The last lines of a text, if there is one."""
    if not path.exists():
        return f"(no {path.name})"
    text = path.read_text(encoding="utf-8", errors="replace")
    return "\n".join(text.splitlines()[-TAIL:])


def _program() -> Path:
    """The Ada program with the driver, built."""
    where, scenario = ROOT / "tests" / "ada", {"MODE": "checks", "CAN_DRIVER": "socketcan"}
    options = ["-p", "-q", "-j0", "-P", "tests.gpr", "can_echo.adb"]
    toolchain.run("gprbuild", options, where, scenario)
    return ROOT / "obj" / "tests-checks-socketcan" / "bin" / "can_echo"


def _told(chosen: Sequence[Step], home: Path) -> bool:
    """Print what the guest found; whether it is good."""
    results = home / "results"
    for step in chosen:
        text = results / f"{step.name}.txt"
        print(f"\n== {step.name}\n")
        print(text.read_text(encoding="utf-8", errors="replace") if text.exists() else "not run")
    found = total(chosen, results)
    if found.lost:
        print(f"\nwithout a result: {', '.join(found.lost)}; the guest's console ended with")
        print(_tail(home / "console.txt"))
    word = "PASS" if found.good else "FAIL"
    print(
        f"\nhw-test: {word}: {found.passed} passed, {found.failed} failed, {found.skipped} skipped"
    )
    return found.good


def main() -> int:
    """Build, boot, and say what came of it."""
    reasons = tuple(missing(KERNEL, platform.machine()))
    if reasons:
        for reason in reasons:
            print(f"hw-test: skipped: {reason}", file=sys.stderr)
        print("hw-test: nothing was run", file=sys.stderr)
        return 2
    shutil.rmtree(HOME / "results", ignore_errors=True)
    (HOME / "results").mkdir(parents=True)
    try:
        chosen = steps(sys.executable, _program())
        (HOME / "results" / "steps").write_text(script(chosen), encoding="utf-8")
        boot(KERNEL, make_initramfs(KERNEL, HOME), HOME)
    except ToolMissing as tool:
        print(f"hw-test: skipped: {tool}\nhw-test: nothing was run", file=sys.stderr)
        return 2
    except ToolFailed as failed:
        print(str(failed).rstrip(), file=sys.stderr)
        return 1
    except subprocess.SubprocessError as failed:
        print(f"hw-test: the guest: {failed}", file=sys.stderr)
    return 0 if _told(chosen, HOME) else 1


if __name__ == "__main__":
    raise SystemExit(main())
