# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What is said on a bus: commands, fields and values, by the names of the model."""

from __future__ import annotations

import pytest

from ravenchart.hw_can.bench.scenario import parse_scenario
from ravenchart.paths import ROOT
from ravenchart.running.vocabulary import BusVocabulary
from tests.support.far_end import robot, system_of

FEATURES = ROOT / "tests" / "feature"


def words_of(feature: str) -> BusVocabulary:
    return BusVocabulary.of(system_of(FEATURES / feature / "model.yaml"))


def test_a_command_is_a_literal_of_one_field_alone() -> None:
    """`Ready` is a condition of three drives, so none of them."""
    places = {name: ("robot_command", "kind") for name in ("Halt", "Home", "Move", "Reset")}
    assert robot().commands == places


@pytest.mark.slow
def test_the_values_of_a_boolean_are_no_commands() -> None:
    for feature in sorted(path.name for path in FEATURES.iterdir() if path.is_dir()):
        system = system_of(FEATURES / feature / "model.yaml")
        if system.buses:
            assert not {"True", "False"} & BusVocabulary.of(system).commands.keys()


def test_the_header_of_a_protected_message_is_none_of_its_fields() -> None:
    words = words_of("protected")
    for name in words.messages:
        assert not any(field.startswith("E2E_") for field in words.fields(name))


def test_a_value_has_the_fraction_that_its_unit_gives_it() -> None:
    """The type counts in tenths of a degree."""
    words = words_of("signals")
    tenths = {
        (name, field): signal
        for name in words.messages
        for field, signal in words.fields(name).items()
        if signal.conversion.scale == 0.1
    }
    assert tenths
    for (name, field), signal in tenths.items():
        assert words.misfit(name, signal, 21.5) is None
        assert words.misfit(name, signal, 125.1) == (
            f"`{field}` must be a number from -40 to 125, in degC, not `125.1`"
        )


@pytest.mark.parametrize("value", ["21.5", "-0.1", "21"])
def test_a_scenario_has_values_with_a_fraction(value: str) -> None:
    text = f"scenario: S\nsteps:\n  - {{wait_for: a.x, is: {value}, within: 1 s}}\n"
    (step,) = parse_scenario(text).steps
    assert getattr(step, "value", None) == float(value)


def test_a_number_that_reads_like_a_name_is_none() -> None:
    text = "scenario: S\nsteps:\n  - {wait_for: a.x, is: v1.5, within: 1 s}\n"
    (step,) = parse_scenario(text).steps
    assert getattr(step, "value", None) == "v1.5"
