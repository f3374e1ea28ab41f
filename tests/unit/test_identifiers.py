"""Identifiers that the model does not give: by deadline, beside those that it gives."""

from __future__ import annotations

import pytest

from tests.support.pump import codes, system_of


def identifiers(*replacements: tuple[str, str]) -> dict[str, int]:
    return {m.name: m.identifier for m in system_of(*replacements).frames}


def test_the_shorter_deadline_has_the_lower_identifier() -> None:
    without = (("id: 0x100, ", ""), ("id: 0x101, ", ""))
    assert identifiers(*without) == {"level_in": 1, "valve_out": 2}
    urgent = ("id: 0x101, from: north.valve", "from: north.valve, deadline: 5 ms")
    assert identifiers(("id: 0x100, ", ""), urgent) == {"level_in": 2, "valve_out": 1}


def test_given_identifiers_are_kept_and_stepped_over() -> None:
    assert identifiers(("id: 0x100, ", ""), ("id: 0x101, ", "id: 1, ")) == {
        "level_in": 2,
        "valve_out": 1,
    }


def test_extended_identifiers_keep_the_order_among_standard_ones() -> None:
    found = identifiers(("id: 0x100, ", "extended: true, "), ("id: 0x101, ", ""))
    assert found == {"level_in": 1 << 18, "valve_out": 2}


@pytest.mark.parametrize(("key", "code"), [("", "RV-0202"), ("id: -1, ", "RV-0204")])
def test_what_others_send_must_be_given(key: str, code: str) -> None:
    line = f"  other: {{bus: can_bus, {key}bytes: 1, period: 5 ms}}\n  valve_out"
    assert codes(("  valve_out", line)) == [code]
