"""Frames on the simulated bus are as long as the analysis says, and never longer."""

from __future__ import annotations

import subprocess

import pytest

from analysis.core.frames import FD_SIZES, Bits, classic_bits, fd_bits
from ravenchart import toolchain
from ravenchart.toolchain import ROOT

CASES = [
    (kind, extended, length)
    for kind, lengths in (("classic", range(9)), ("fd", FD_SIZES))
    for extended in (False, True)
    for length in lengths
]

Measured = dict[tuple[str, bool, int], tuple[int, Bits]]
"""Bits without stuff bits, and the longest frame found, for each case."""

SLACK = 6
"""Bits by which the bound exceeds the longest frame found: it takes every bit as free, but
the bits of fixed value around the identifier break the pattern that stuffs most."""


@pytest.fixture(scope="module")
def measured() -> Measured:
    """What `test_wire` prints: heads of every pattern, each with the data that stuffs most."""
    options = ["-p", "-q", "-j0", "-P", "tests.gpr", "test_wire.adb"]
    names = {"MODE": "release", "CAN_DRIVER": "loopback"}
    toolchain.run("gprbuild", options, ROOT / "tests" / "ada", names)
    program = ROOT / "obj" / "tests-release-loopback" / "bin" / "test_wire"
    done = subprocess.run([program], capture_output=True, text=True, timeout=40, check=True)
    found: Measured = {}
    for line in done.stdout.splitlines():
        match line.split():
            case ["bits", kind, form, length, plain, nominal, data]:
                key = kind, form == "extended", int(length)
                found[key] = int(plain), Bits(int(nominal), int(data))
    return found


def _bits(kind: str, extended: bool, length: int, *, stuffed: bool) -> Bits:
    formula = classic_bits if kind == "classic" else fd_bits
    return formula(length, extended=extended, stuffed=stuffed)


def test_every_length_was_measured(measured: Measured) -> None:
    assert sorted(measured) == sorted(CASES)


@pytest.mark.parametrize(("kind", "extended", "length"), CASES)
def test_without_stuff_bits_the_lengths_are_equal(
    measured: Measured, kind: str, extended: bool, length: int
) -> None:
    shortest = _bits(kind, extended, length, stuffed=False)
    assert measured[kind, extended, length][0] == shortest.nominal + shortest.data


@pytest.mark.parametrize(("kind", "extended", "length"), CASES)
def test_the_bound_holds_and_is_close(
    measured: Measured, kind: str, extended: bool, length: int
) -> None:
    longest = measured[kind, extended, length][1]
    bound = _bits(kind, extended, length, stuffed=True)
    assert longest.nominal <= bound.nominal
    assert longest.data <= bound.data
    assert longest.nominal + longest.data >= bound.nominal + bound.data - SLACK
