# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names of values of a database: enumerations, other values, and numbers with some names."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cantools
import pytest

from ravenchart.gen.emit.buses.dbc import emit_dbc
from ravenchart.gen.language.terms import EnumerationType, IntegerType
from ravenchart.gen.model.signals import Signal
from ravenchart.hw_can.bench.scenario import parse_scenario
from ravenchart.running import scenarios
from tests.unit.ravenchart.test_import_degraded import taken_in

MESSAGE = 'BO_ 1 odd: 8 {} \n SG_ x : {} "{}" {}\nVAL_ 1 x {} ;'


def signal_of(
    folder: Path, layout: str, names: str, *, unit: str = "", sends: bool = False
) -> tuple[str, Signal, str]:
    """The list of changes, the signal `x` in the model, and the database of the model."""
    ends = ("ecu", "other") if sends else ("other", "ecu")
    text = MESSAGE.format(ends[0], layout, unit, ends[1], names)
    found, message, system = taken_in(folder, text)
    assert found.problems == []
    (signal,) = message.signals
    return found.text, signal, emit_dbc(system, system.buses[0])


@pytest.mark.parametrize("sends", [False, True])
@pytest.mark.parametrize(
    ("layout", "names", "literals", "codes"),
    [
        ("0|3@1+ (1,0) [0|7]", '0 "Off" 1 "On" 5 "Bad"', "Off On Bad Other", (0, 1, 5, 2)),
        ("0|2@1+ (1,0) [0|3]", '1 "km" 2 "miles"', "km miles Other", (1, 2, 0)),
        ("0|4@1- (1,0) [0|0]", '-1 "Back" 1 "Forth"', "Back Forth Other", (-1, 1, -8)),
        ("7|8@0+ (1,0) [0|1]", '0 "Off" 255 "Absent"', "Off Absent Other", (0, 255, 1)),
        ("0|1@1+ (1,0) [0|1]", '1 "Lit"', "Lit Other", (1, 0)),
        ("0|2@1+ (1,0) [0|3]", '0 "Other" 1 "else"', "Other N_else Other_2", (0, 1, 2)),
        ("0|3@1+ (1,0) [0|7]", '0 "Off" 1 "On" 9 "Far"', "Off On Other", (0, 1, 2)),
    ],
)
def test_values_without_a_name_have_a_literal(
    tmp_path: Path, layout: str, names: str, literals: str, codes: tuple[int, ...], sends: bool
) -> None:
    text, signal, dbc = signal_of(tmp_path, layout, names, sends=sends)
    assert isinstance(signal.type, EnumerationType)
    wanted = tuple(literals.replace("N_else", signal.type.literals[1]).split())
    assert (signal.type.literals, signal.codes, signal.other) == (wanted, codes, wanted[-1])
    assert f"has {wanted[-1]} for values without a name, which is sent as {codes[-1]}\n" in text
    again: Any = cantools.database.load_string(dbc, "dbc")
    first: Any = cantools.database.load_file(tmp_path / "odd.dbc", strict=False)
    for octet in range(256):
        frame = bytes([octet, 0, 0, 0, 0, 0, 0, 0])
        raw = first.decode_message("odd", frame, decode_choices=False)["x"]
        name = first.decode_message("odd", frame)["x"]
        assert again.decode_message("odd", frame, decode_choices=False)["x"] == raw
        assert signal.value(raw) == (
            wanted[-1] if isinstance(name, int) else wanted[codes.index(raw)]
        )


def test_a_start_value_without_a_name_is_what_is_sent(tmp_path: Path) -> None:
    start = (
        '0 "Off" 1 "On" ;\nBA_DEF_ SG_ "GenSigStartValue" INT 0 255;\n'
        'BA_DEF_DEF_ "GenSigStartValue" 0;\nBA_ "GenSigStartValue" SG_ 1 x 6'
    )
    _, signal, _ = signal_of(tmp_path, "0|3@1+ (1,0) [0|7]", start, sends=True)
    assert (signal.codes, signal.raw("Other")) == ((0, 1, 6), 6)


@pytest.mark.parametrize(
    ("layout", "unit", "names", "limits", "told"),
    [
        ("0|8@1+ (0.5,-40) [-40|80]", "degC", '254 "Error" 255 "Absent"', (-80, 175),
         "174 Error, 175 Absent"),
        ("0|10@1+ (1,0) [0|1021]", "", '1022 "Init" 1023 "Fault"', (0, 1023),
         "1022 Init, 1023 Fault"),
        ("0|8@1+ (1,0) [0|252]", "", '254 "Init" 255 "Fault"', (0, 255), "254 Init, 255 Fault"),
        ("0|8@1+ (1,0) [0|255]", "", '255 "Absent"', (0, 255), "255 Absent"),
        ("0|8@1+ (1,0) [0|100]", "%", '0 "Off" 1 "On"', (0, 100), "0 Off, 1 On"),
    ],
)  # fmt: skip
def test_a_number_of_which_some_values_have_names_stays_a_number(
    tmp_path: Path, layout: str, unit: str, names: str, limits: tuple[int, int], told: str
) -> None:
    text, signal, _ = signal_of(tmp_path, layout, names, unit=unit)
    assert isinstance(signal.type, IntegerType)
    assert (signal.type.first, signal.type.last) == limits
    assert f"# odd.x  is a number, of which some have names: {told}\n" in text


def test_all_values_of_the_limits_have_names(tmp_path: Path) -> None:
    names = '0 "Off" 1 "On" 2 "Bad"'
    _, signal, _ = signal_of(tmp_path, "0|8@1+ (1,0) [0|2]", names, unit="none")
    assert (signal.codes, signal.other) == ((0, 1, 2), None)


def test_a_scenario_has_other_values_as_numbers(tmp_path: Path) -> None:
    text = MESSAGE.format("other", "0|3@1+ (1,0) [0|7]", "", "ecu", '0 "Off" 1 "On"')
    _, _, system = taken_in(tmp_path, text)
    plan = "scenario: x\nsteps:\n"
    plan += "".join(f"  - {{send: odd, with: {{x: {x}}}}}\n" for x in ("Off", 1, 5, 7, 8, "Other"))
    found = scenarios.problems(parse_scenario(plan), system)
    assert [one.message for one in found] == [
        f"`x` must be one of Off, On, or another number from 0 to 7, not `{x}`"
        for x in ("8", "Other")
    ]
