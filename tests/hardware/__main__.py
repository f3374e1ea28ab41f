"""`make hw-test`: drivers of CAN controllers, in a guest of QEMU; and other machines.

The guest runs Debian's kernel, sees the root of this machine read-only, and has a virtual
interface, vcan0, two emulated SJA1000 on one bus, can0 and can1, and two cards with two
emulated CTU CAN FD each, for which it has no driver: one on the same bus, one on its own.
Beside it, the Ada tests and generated codecs run on a big-endian machine and on one of 32
bits, in QEMU's user mode. Exit status: 0 all that was run passed; 1 something failed; 2
nothing could be run, for the reasons printed.
"""

from __future__ import annotations

import itertools
import platform
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from ravenchart.building import checking, generation, programs
from ravenchart.failures import ToolFailed
from ravenchart.paths import ROOT
from ravenchart.tools import toolchain
from ravenchart.tools.toolchain import ToolMissing

from . import machines

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

ELSEWHERE = ("tests/system/test_other_machines.py", "tests/system/test_codecs.py")
"""What is run on other machines: of the latter the tests that are named after one."""

PATIENCE = 1_200
"""Seconds after which a guest is given up; it needs about a minute."""

LIMIT = 300
"""Seconds for one step of it."""

CARDS = "/sys/bus/pci/devices/0000:00:{:02x}.0/resource1"
"""The registers of a card with CTU CAN FD in the guest, by its slot."""

SHARED_SLOT, OWN_SLOT = 0x10, 0x11
"""Of the card on the bus of the SJA1000, and of the one that has a bus of its own."""

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

    def __add__(self, other: Total) -> Total:
        """Both together."""
        return Total(
            self.passed + other.passed,
            self.failed + other.failed,
            self.skipped + other.skipped,
            self.lost + other.lost,
        )

    @property
    def good(self) -> bool:
        """Nothing failed, nothing was lost, and something passed."""
        return self.passed > 0 and self.failed == 0 and not self.lost


def steps(python: str, objects: Path, controller: Path) -> tuple[Step, ...]:
    """What is run in the guest, in this order; ``objects`` is obj/ of the checkout.

    ``controller`` is that of the crossing.
    """
    loopback = (
        python,
        "-P",
        "-m",
        "ravenchart",
        "loopback",
        "--interface",
        "socketcan",
        "--channel",
    )
    driver = (python, "-P", "-m", "tests.hardware.driver")
    fact = (python, "-P", "-m", "tests.hardware.fact")
    remote = (python, "-P", "-m", "tests.hardware.remote")
    socketcan, ctucanfd = (
        objects / f"tests-{MODE}-{name}" / "bin" for name in ("socketcan", "ctucanfd")
    )
    shared, own = CARDS.format(SHARED_SLOT), CARDS.format(OWN_SLOT)
    echo = str(socketcan / "can_echo")
    near = ("--near", "can0", "--emulated")
    return (
        Step("loopback-vcan0", (*loopback, "vcan0", "--fd")),
        Step("driver-vcan0", (*driver, echo, "vcan0")),
        Step("remote-vcan0", (*remote, str(controller), "vcan0")),
        Step("driver-can0", (*driver, echo, "can0", "--near", "can1", "--emulated")),
        Step(
            "driver-ctucanfd",
            (*driver, str(ctucanfd / "can_echo"), f"{shared}:1", "--driver", "ctucanfd", *near),
        ),
        Step(
            "registers-ctucanfd",
            ("env", f"RAVENCHART_CTUCANFD={own}", *fact, str(ctucanfd / "test_ctu_cores")),
        ),
        Step(
            "frames-ctucanfd",
            ("env", f"RAVENCHART_CTUCANFD={own}", *fact, str(ctucanfd / "test_ctu_driver")),
        ),
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
            failed += bool(kinds & {"failure", "error"})
            skipped += "skipped" in kinds
            passed += not kinds & {"failure", "error", "skipped"}
    return Total(passed, failed, skipped, tuple(lost))


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


def _told(chosen: Sequence[Step], home: Path) -> Total:
    """Print what the guest found, and count it."""
    results = home / "results"
    for step in chosen:
        text = results / f"{step.name}.txt"
        print(f"\n== {step.name}\n")
        print(text.read_text(encoding="utf-8", errors="replace") if text.exists() else "not run")
    found = total(chosen, results)
    if found.lost:
        print(f"\nwithout a result: {', '.join(found.lost)}; the guest's console ended with")
        print(_tail(home / "console.txt"))
    return found


def guest() -> Total:
    """Build, boot, and print what came of it; ToolMissing or ToolFailed before that."""
    _build()
    chosen = steps(sys.executable, ROOT / "obj", crossing())
    (HOME / "results" / "steps").write_text(script(chosen), encoding="utf-8")
    try:
        boot(KERNEL, make_initramfs(KERNEL, HOME), HOME)
    except subprocess.SubprocessError as failed:
        print(f"hw-test: the guest: {failed}", file=sys.stderr)
    return _told(chosen, HOME)


def elsewhere() -> Total:
    """The tests for other machines, as far as there are tools for them."""
    step = Step("other-machines", ())
    told = [sys.executable, "-m", "pytest", "-q", "-rs", *ELSEWHERE]
    names = " or ".join(machine.name for machine in machines.OTHERS)
    result = HOME / "results" / f"{step.name}.xml"
    print(f"\n== {step.name}\n", flush=True)
    subprocess.run([*told, "-k", names, f"--junitxml={result}"], cwd=ROOT, check=False)
    return total((step,), HOME / "results")


def main() -> int:
    """Run what can be run, and say what came of it."""
    shutil.rmtree(HOME / "results", ignore_errors=True)
    (HOME / "results").mkdir(parents=True)
    reasons = list(missing(KERNEL, platform.machine()))
    others = [list(machine.missing()) for machine in machines.OTHERS]
    found = Total(0, 0, 0, ())
    try:
        if not reasons:
            found += guest()
        if not all(others):
            found += elsewhere()
    except ToolMissing as tool:
        reasons.append(str(tool))
    except ToolFailed as failed:
        print(str(failed).rstrip(), file=sys.stderr)
        return 1
    for reason in itertools.chain(reasons, *others):
        print(f"hw-test: skipped: {reason}", file=sys.stderr)
    if found == Total(0, 0, 0, ()):
        print("hw-test: nothing was run", file=sys.stderr)
        return 2
    word = "PASS" if found.good else "FAIL"
    counts = f"{found.passed} passed, {found.failed} failed, {found.skipped} skipped"
    print(f"\nhw-test: {word}: {counts}")
    return 0 if found.good else 1


if __name__ == "__main__":
    raise SystemExit(main())
