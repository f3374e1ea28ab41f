# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames on the simulated bus are as long as the analysis says, and never longer."""

from __future__ import annotations

import subprocess

import pytest

from ravenchart.analysis.core.frames import FD_SIZES, Bits, classic_bits, fd_bits
from tests.support.ada_programs import built

pytestmark = pytest.mark.clock

CASES = [
    (kind, extended, length)
    for kind, lengths in (("classic", range(9)), ("fd", FD_SIZES))
    for extended in (False, True)
    for length in lengths
]

Measured = dict[tuple[str, bool, int], tuple[int, Bits]]
"""Bits without stuff bits, and the longest frame found, for each case."""

FREE = "x"
"""Stands for a bit of either value, among bits of fixed value."""

SLACK = 6
"""Bits by which the bound of the analysis may exceed the longest frame found: it takes
every bit as free, but those around the identifier break the pattern that stuffs most."""


@pytest.fixture(scope="module")
def measured() -> Measured:
    """What `test_wire` prints: heads of every pattern, each with the data that stuffs most."""
    program = built("release", "loopback", "test_wire") / "test_wire"
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


def _most_stuff_bits(pattern: str) -> int:
    """The most stuff bits inside any bits of this pattern; none behind the last."""
    best = {("", 0): 0}
    for bit in pattern:
        longer: dict[tuple[str, int], int] = {}
        for (last, run), stuffed in best.items():
            due = run == 5
            before, count = ("10"[int(last)], 1) if due else (last, run)
            for sent in "01" if bit == FREE else bit:
                now = sent, count + 1 if sent == before else 1
                longer[now] = max(longer.get(now, 0), stuffed + due)
        best = longer
    return max(best.values())


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
    """At any data bit rate: the bound takes both bits of the switch as nominal, which in the
    frame make one nominal bit and one data bit."""
    longest = measured[kind, extended, length][1]
    bound = _bits(kind, extended, length, stuffed=True)
    for data_bit in (0.05, 0.25, 1):
        assert longest.nominal + data_bit * longest.data <= bound.nominal + data_bit * bound.data
    assert longest.nominal + longest.data >= bound.nominal + bound.data - SLACK


@pytest.mark.parametrize("length", FD_SIZES)
def test_the_longest_standard_fd_frame_is_found(measured: Measured, length: int) -> None:
    """All identifiers are tried, and no CRC is exposed: nothing but the pattern counts."""
    code = f"{FD_SIZES.index(length):04b}"
    head = "0" + 11 * FREE + "00" + "101" + FREE + code
    plain, longest = measured["fd", False, length]
    assert longest.nominal + longest.data == plain + _most_stuff_bits(head + 8 * length * FREE)
