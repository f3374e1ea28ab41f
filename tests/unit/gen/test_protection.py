# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""End-to-end protection in the model and in the analysis."""

from __future__ import annotations

import json
from fractions import Fraction
from itertools import product
from typing import get_args

import e2e
import pytest

from ravenchart.analysis.present.figures import figures
from ravenchart.analysis.present.report import render_report
from ravenchart.analysis.system.protection import protected, residual_probability
from ravenchart.analysis.system.timing import analyse
from ravenchart.gen.model.protection import PROFILES, ProfileName, Protection, crc_8
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT

MS = 1_000_000


@pytest.fixture(scope="module")
def system() -> System:
    """That of the feature."""
    found = load(ROOT / "tests" / "feature" / "protected" / "model.yaml").system
    assert found is not None
    return found


def test_every_profile_that_a_model_can_name_is_known() -> None:
    assert tuple(PROFILES) == get_args(ProfileName)


def test_no_signal_is_in_the_header(system: System) -> None:
    for message in system.messages:
        assert message.protection is not None
        taken = {bit for signal in message.signals for bit in signal.bits()}
        assert not taken & message.protection.profile.header, message.name
        assert max(taken | message.protection.profile.header) < 8 * message.length


def test_the_residual_probability_is_that_of_all_error_patterns() -> None:
    bits, found, chance = 8, 2, Fraction(1, 10)
    wrong = sum(
        chance ** sum(pattern) * (1 - chance) ** (bits - sum(pattern))
        for pattern in product((0, 1), repeat=bits)
        if sum(pattern) > found
    )
    assert residual_probability(4, found, bits, chance) == wrong / 16


def test_rates_and_times_of_a_message(system: System) -> None:
    analysis = analyse(system)
    by_name = {row.message.name: row for row in protected(analysis)}
    first, fourth = by_name["first_in"], by_name["fourth_in"]
    assert first.random == pytest.approx(2 / (256 * 16))
    assert fourth.random == pytest.approx(5 / (65536 * 256))
    assert first.rate == pytest.approx(first.residual * 3600 / 0.020)
    assert first.tolerated == 40 * MS
    (silence,) = first.silences
    #  delivery, five executions of 20 ms and two more, and how long the last one takes
    delivered, response = (
        analysis.deliveries["line.first_in"].bound, analysis.found.from_event("work")
    )  # fmt: skip
    assert delivered is not None
    assert response is not None
    assert silence.found == delivered + 7 * 20 * MS + response
    assert fourth.silences[0].found is None


@pytest.mark.slow
def test_the_report_has_them(system: System) -> None:
    analysis = analyse(system)
    found = json.loads(json.dumps(figures(analysis)))["protected"]
    assert [row["message"] for row in found] == [m.name for m in system.messages]
    assert found[0]["tolerated"] == 40 * MS
    text = render_report(analysis)
    assert ">End-to-end protection</h2>" in text
    assert "<td>first_in</td><td>e2e_p1</td>" in text


def _with(name: ProfileName, data_id: int = 0, ids: tuple[int, ...] = ()) -> Protection:
    return Protection(name, data_id, ids, 1, 1)


@pytest.mark.parametrize(
    ("one", "two", "passes"),
    [
        (_with("e2e_p1", 0x0001), _with("e2e_p11", 0x0182), True),
        (_with("e2e_p1", 0x0001), _with("e2e_p11", 0x0183), False),
        (_with("e2e_p1b", 0x0123), _with("e2e_p1b", 0x0523), True),
        (_with("e2e_p1b", 0x0123), _with("e2e_p1b", 0x0524), False),
        (_with("e2e_p1c", 0x0123), _with("e2e_p11c", 0x0523), False),
        (_with("e2e_p1c", 0x0123), _with("e2e_p11c", 0x0123), True),
        (_with("e2e_p2", 0, tuple(range(16))), _with("e2e_p2", 0, tuple(range(15, -1, -1))), False),
        (_with("e2e_p2", 0, tuple(range(16))), _with("e2e_p2", 0, (9,) * 16), True),
        (_with("e2e_p5", 0x0123), _with("e2e_p5", 0x0523), False),
        (_with("e2e_p5", 0x0123), _with("e2e_p1", 0x0123), False),
    ],
)
def test_data_identifiers_that_pass_for_each_other(
    one: Protection, two: Protection, passes: bool
) -> None:
    assert one.passes_for(two) is passes
    assert two.passes_for(one) is passes


def test_the_remainder_is_that_of_an_independent_package() -> None:
    for data_id in range(0, 0x10000, 77):
        data = bytearray(8)
        e2e.p01.e2e_p01_protect(data, data_id, length=8, increment_counter=False)
        assert crc_8(data_id.to_bytes(2, "little") + bytes(7)) == data[0]
