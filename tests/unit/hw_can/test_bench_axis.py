# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated drive: bounds, energy, timing, switches, determinism."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ravenchart.hw_can.bench.axis import STEP, Axis, Condition, Drive, DriveMode, Limit, Push

AXIS = Axis(stroke=0.4, start=0.05, low_switch=0.008, high_switch=0.39, count_at_start=-1234)


def run(drive: Drive, seconds: float, speed: float | None = None) -> list[float]:
    """Speeds over that time; with ``speed`` a set point arrives every 10 ms."""
    speeds = []
    for index in range(round(seconds / STEP)):
        if speed is not None and index % 20 == 0:
            drive.command(DriveMode.ENABLED, speed)
        drive.step()
        speeds.append(drive.speed)
    return speeds


def test_a_small_step_of_speed_is_reached_with_the_loops_time_constant() -> None:
    speeds = run(Drive(AXIS), 0.2, 0.02)
    reached = next(i for i, s in enumerate(speeds) if s >= 0.63 * 0.02) * STEP
    assert 0.010 <= reached <= 0.016
    assert speeds[-1] == pytest.approx(0.02, abs=0.0002)
    assert max(speeds) < 1.15 * 0.02


def test_a_large_step_is_bounded_by_the_motors_force() -> None:
    speeds = run(Drive(AXIS), 0.1, 0.4)
    gains = [(b - a) / STEP for a, b in itertools.pairwise(speeds)]
    assert 2.4 < max(gains) <= 3.0


def test_a_set_speed_of_zero_holds_the_axis() -> None:
    drive = Drive(AXIS)
    run(drive, 0.3, 0.1)
    run(drive, 0.3, 0.0)
    held = drive.position
    assert abs(drive.speed) < 0.0005
    run(drive, 0.5, 0.0)
    assert drive.position == pytest.approx(held, abs=0.0001)


def kinetic_energy(drive: Drive) -> float:
    """Energy of motion in J."""
    return 0.5 * drive.axis.mass * drive.speed**2


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(DriveMode), st.floats(-2, 2)), min_size=1, max_size=40))
def test_the_axis_never_leaves_its_stops_and_gains_no_energy_from_nothing(
    commands: list[tuple[DriveMode, float]],
) -> None:
    drive = Drive(AXIS)
    for mode, speed in commands:
        drive.command(mode, speed)
        for _ in range(40):
            before, from_speed = kinetic_energy(drive), abs(drive.speed)
            drive.step()
            assert 0.0 <= drive.position <= AXIS.stroke
            push = abs(drive.force) * max(from_speed, abs(drive.speed)) * STEP
            assert kinetic_energy(drive) <= before + push + 1e-12


def test_a_disabled_axis_loses_all_its_speed_and_stays() -> None:
    drive = Drive(AXIS)
    run(drive, 0.3, 0.25)
    drive.command(DriveMode.DISABLED, 0.25)
    speeds = run(drive, 0.1)
    assert all(b <= a for a, b in itertools.pairwise(speeds))
    assert speeds[-1] == 0.0


def test_the_encoder_counts_from_power_on() -> None:
    drive = Drive(AXIS)
    assert drive.count == -1234
    run(drive, 0.5, 0.1)
    assert drive.count == -1234 + round((drive.position - AXIS.start) * 1e6)


def test_the_low_switch_lets_go_a_little_above_where_it_was_pressed() -> None:
    drive = Drive(AXIS)
    pressed_at = released_at = 0.0
    for speed in (-0.04, 0.01):
        for index in range(round(1.4 / STEP)):
            before = drive.limit
            if index % 20 == 0:
                stay = speed < 0 and before is Limit.LOW_END
                drive.command(DriveMode.ENABLED, 0.0 if stay else speed)
            drive.step()
            if (before, drive.limit) == (Limit.CLEAR, Limit.LOW_END):
                pressed_at = drive.position
            elif (before, drive.limit) == (Limit.LOW_END, Limit.CLEAR):
                released_at = drive.position
    assert pressed_at == pytest.approx(0.008, abs=0.0001)
    assert released_at == pytest.approx(0.009, abs=0.0001)


def test_the_high_switch_is_pressed_beyond_its_place() -> None:
    drive = Drive(Axis(stroke=0.4, start=0.37, low_switch=0.008, high_switch=0.39))
    assert drive.limit is Limit.CLEAR
    run(drive, 1.0, 0.1)
    assert (drive.position, drive.limit) == (0.4, Limit.HIGH_END)


def test_a_switch_can_be_pressed_by_hand() -> None:
    drive = Drive(AXIS)
    drive.push = Push.LOW
    assert (drive.limit, drive.on_low_switch) == (Limit.LOW_END, False)
    drive.push = Push.HIGH
    assert drive.limit is Limit.HIGH_END


def test_driving_into_the_stop_leaves_the_axis_there() -> None:
    drive = Drive(AXIS)
    run(drive, 1.5, -0.2)
    assert drive.position == 0.0
    assert drive.limit is Limit.LOW_END


def test_a_drive_that_hears_nothing_stops_and_faults_until_it_hears_again() -> None:
    drive = Drive(AXIS)
    run(drive, 0.3, 0.2)
    run(drive, 0.085)
    assert drive.condition is Condition.READY
    run(drive, 0.16)
    assert (drive.condition, drive.speed) == (Condition.FAULTED, 0.0)
    drive.command(DriveMode.ENABLED, 0.1)
    assert drive.condition is Condition.READY


def test_a_drive_that_was_never_enabled_does_not_fault() -> None:
    drive = Drive(AXIS)
    run(drive, 0.5)
    assert (drive.condition, drive.position) == (Condition.READY, AXIS.start)


def test_the_same_commands_give_the_same_motion() -> None:
    assert run(Drive(AXIS), 0.4, 0.17) == run(Drive(AXIS), 0.4, 0.17)


@pytest.mark.parametrize(
    ("low", "high", "start"), [(0.3, 0.2, 0.1), (0.01, 0.5, 0.1), (0.01, 0.3, 0.9)]
)
def test_an_impossible_axis_is_refused(low: float, high: float, start: float) -> None:
    with pytest.raises(ValueError, match="stroke"):
        Axis(stroke=0.4, start=start, low_switch=low, high_switch=high)
