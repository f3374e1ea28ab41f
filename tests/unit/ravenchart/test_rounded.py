# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Times and shares on the terminal: three significant digits, and never a flattering one."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravenchart import rounded
from ravenchart.rounded import MS, SECONDS, US, Rounding, TimeUnit

TIMES = st.integers(0, 10**13)
LENGTHS = {unit.name: unit.length for unit in (US, MS, SECONDS)}


def read(text: str) -> Fraction:
    """The time that a text says, in ns."""
    number, unit = text.split()
    return Fraction(number) * LENGTHS[unit]


@pytest.mark.parametrize(
    ("time", "up", "down"),
    [
        (0, "0 us", "0 us"),
        (50, "0.05 us", "0.05 us"),
        (206_130, "207 us", "206 us"),
        (999_900, "1 ms", "999 us"),
        (1_000_000, "1 ms", "1 ms"),
        (7_735_000, "7.74 ms", "7.73 ms"),
        (14_560_000, "14.6 ms", "14.5 ms"),
        (99_005_000, "99.1 ms", "99 ms"),
        (2_000_000_000, "2 s", "2 s"),
        (1_234_567_000_000, "1235 s", "1234 s"),
        (-130_100, "-130 us", "-131 us"),
    ],
)
def test_a_time_has_three_digits_and_the_unit_that_suits_it(time: int, up: str, down: str) -> None:
    assert (rounded.up(time), rounded.down(time)) == (up, down)


@given(TIMES)
def test_no_bound_is_printed_shorter_and_no_slack_longer(time: int) -> None:
    assert read(rounded.down(time)) <= time <= read(rounded.up(time))
    assert read(rounded.up(-time)) >= -time >= read(rounded.down(-time))


@given(TIMES.filter(lambda time: time < 10**11))
def test_there_are_no_more_than_three_significant_digits(time: int) -> None:
    for text in (rounded.up(time), rounded.down(time)):
        assert len(Decimal(text.split()[0]).normalize().as_tuple().digits) <= rounded.DIGITS


def test_the_cells_of_a_table_have_one_unit() -> None:
    assert rounded.unit_of([999_999, None]) == US
    assert rounded.unit_of([5_000, 1_000_000]) == MS
    assert rounded.unit_of([]) == US
    assert [MS.up(time) for time in (5_000, 695_000, 7_735_000, 10**11, None)] == [
        "0.005",
        "0.695",
        "7.74",
        "100000",
        "-",
    ]
    assert MS.down(12_345_600_000) == "12345"


# --- Two figures -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("needed", "limit", "expected"),
    [
        (14_560_000, 5_000_000, ("14.6 ms", "5 ms")),
        (10_001_000, 10_000_000, ("10.001 ms", "10 ms")),
        (10_040_000, 10_000_000, ("10.04 ms", "10 ms")),
        (9_996_000, 9_998_000, ("9.996 ms", "9.998 ms")),
        (7_731_000, 7_731_000, ("7.731 ms", "7.731 ms")),
        (1_020_000, 900_000, ("1.02 ms", "0.9 ms")),
        (1_200_000_000, 55_000, ("1.2 s", "55 us")),
        (0, 0, ("0 us", "0 us")),
    ],
)
def test_the_digits_show_whether_a_limit_is_met(
    needed: int, limit: int, expected: tuple[str, str]
) -> None:
    assert rounded.against(needed, limit) == expected


def test_a_bound_beside_an_observed_time_is_rounded_up_too() -> None:
    assert rounded.beside(7_731_000, 7_735_000) == ("7.74 ms", "7.74 ms")
    assert rounded.beside(7_735_000, 7_731_000) == ("7.735 ms", "7.731 ms")
    assert rounded.beside(55_001, 55_000) == ("55.001 us", "55 us")
    assert MS.beside(None, 7_731_000) == ("-", "7.74")
    assert MS.against(7_731_000, None) == ("7.74", "-")


@given(TIMES, TIMES)
def test_two_printed_times_compare_as_the_times_do(first: int, second: int) -> None:
    for texts in (rounded.against(first, second), rounded.beside(first, second)):
        assert (read(texts[0]) > read(texts[1])) == (first > second)
        assert read(texts[0]) >= first


@given(TIMES, st.integers(1, 1_000), st.sampled_from([US, MS]))
def test_cells_compare_as_the_times_do(first: int, more: int, unit: TimeUnit) -> None:
    for one, other in ((first, first + more), (first + more, first)):
        for pair in (unit.against(one, other), unit.beside(one, other)):
            assert (Decimal(pair[0]) > Decimal(pair[1])) == (one > other)


@given(TIMES, TIMES, st.sampled_from([Rounding.UP, Rounding.DOWN]))
def test_two_values_of_a_figure_differ_as_printed(before: int, now: int, side: Rounding) -> None:
    texts = rounded.changed(before, now, side)
    assert (texts[0] == texts[1]) == (before == now)


# --- Shares ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("share", "needed", "left"),
    [
        (Fraction(442, 1_000), "44.2 %", "44.2 %"),
        (Fraction(1, 3), "33.4 %", "33.3 %"),
        (Fraction(1), "100 %", "100 %"),
        (Fraction(9_997, 10_000), "99.97 %", "99.9 %"),
        (Fraction(10_004, 10_000), "100.04 %", "100 %"),
        (Fraction(3_406, 1_000), "341 %", "340 %"),
        (Fraction(0), "0 %", "0 %"),
    ],
)
def test_a_load_is_rounded_up_and_room_down(share: Fraction, needed: str, left: str) -> None:
    assert (rounded.percent(share), rounded.room(share)) == (needed, left)


def test_a_share_with_a_long_denominator_is_printed() -> None:
    """The sum of 5,000 shares of different periods has a denominator of 50,000 digits."""
    assert rounded.percent(Fraction(10**50_000 + 7, 3 * 10**50_000 + 1)) == "33.4 %"


def test_changes_of_shares_and_factors_are_visible() -> None:
    assert rounded.signed_percent(Fraction(1, 3)) == "+33.3 %"
    assert rounded.signed_percent(Fraction(-1, 800)) == "-0.125 %"
    assert rounded.factor(Fraction(3_929, 1_000)) == "3.92"
    assert rounded.changed_factors(Fraction(3_929, 1_000), Fraction(3_928, 1_000)) == (
        "3.929",
        "3.928",
    )
    assert rounded.changed_shares(Fraction(1, 3), Fraction(1, 4)) == ("33.4 %", "25 %")
    assert rounded.shares_beside(Fraction(4_424, 10_000), Fraction(4_422, 10_000)) == (
        "44.24 %",
        "44.22 %",
    )


def test_points_in_time_and_ages_have_the_same_places_always() -> None:
    assert (rounded.instant(12_345_678_901), rounded.age(12_345_678_901)) == ("12.346", "12.3")
    assert rounded.age(-5) == "0.0"
    assert rounded.of_seconds(0.1 + 0.2) == 300_000_000
