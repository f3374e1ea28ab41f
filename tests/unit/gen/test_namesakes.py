# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names that the generator makes of several of the model's, or of signs, never meet."""

from __future__ import annotations

from itertools import product

import pytest

from ravenchart.building import checking, generation
from ravenchart.gen.emit.ada.naming import _unit_names
from ravenchart.gen.emit.program import generate
from ravenchart.paths import ROOT

UNITS = (
    "mm", "MM", "mV", "MV", "m/s", "m_per_s", "m^2", "m_2", "mm 2", "%", "percent",
    "\N{DEGREE SIGN}C", "degC", "\N{MICRO SIGN}m", "um", "\N{INFINITY}", "#", "MM_2",
)  # fmt: skip


def test_each_unit_has_a_type_of_its_own_in_ascii() -> None:
    names = _unit_names(UNITS)
    assert len({name.lower() for name in names.values()}) == len(UNITS)
    assert all(
        name.isascii() and name.isidentifier() and "__" not in name for name in names.values()
    )
    assert (names["mm"], names["MM"], names["m/s"]) == ("Unit_Mm", "Unit_MM_3", "Unit_M_Per_S")


@pytest.mark.parametrize(("first", "second"), list(product(("mV", "MV"), repeat=2)))
def test_the_first_unit_keeps_its_plain_name(first: str, second: str) -> None:
    names = _unit_names(tuple(dict.fromkeys((first, second))))
    assert names[first] == "Unit_MV"


def test_no_declaration_of_the_codecs_has_the_name_of_another() -> None:
    checked = checking.check(ROOT / "tests" / "feature" / "namesakes" / "model.yaml")
    spec = generate(checked.system, generation.claims(checked))["namesake_feature-codecs.ads"]
    packages = [line.split()[1] for line in spec.splitlines() if line.startswith("   package ")]
    assert packages == [
        "Message_Joint", "Type_Joint_Position", "Message_Signal", "Type_Signal", "Type_Mode",
        "Message_Long_Mode",
    ]  # fmt: skip
    assert "function Value_Of_Type_Joint_Position" in spec
    assert "function Value_Of_Signal_Position" in spec
