# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names of values and nodes that a model cannot have, kept for the database of the bus."""

from __future__ import annotations

from pathlib import Path

import cantools
import pytest
from cantools.database import Database

from ravenchart.building import checking
from ravenchart.command_line import main
from ravenchart.databases.database import Periods, imported
from ravenchart.failures import OK, Refused
from ravenchart.gen.emit.buses.dbc import emit_dbc
from ravenchart.hw_can.bench.naming import as_in_model

LINE = """VERSION ""
NS_ :
BS_:
BU_: Gear_Box other
BO_ 1 gear: 8 Gear_Box
 SG_ state : 0|2@1+ (1,0) [0|3] "" other
 SG_ mode M : 8|2@1+ (1,0) [0|3] "" other
 SG_ level m1 : 16|8@1+ (1,0) [0|255] "" other
BO_ 2 told: 8 other
 SG_ reply : 0|2@1+ (1,0) [0|3] "" Gear_Box
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_DEF_DEF_ "GenMsgCycleTime" 50;
VAL_ 1 state 0 "not in gear" 1 "1st (slow)" 2 "On" 3 "end" ;
VAL_ 1 mode 0 "no level" 1 "a level" 2 "Free" 3 "SNA" ;
VAL_ 2 reply 0 "o.k." 1 "O.K." 2 "Busy" ;
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "line.dbc"
    path.write_text(LINE)
    found = imported(path, "Gear_Box", Periods("50 ms"))
    assert found.problems == []
    (tmp_path / "model.yaml").write_text(found.text)
    return tmp_path / "model.yaml"


def database(text: str) -> Database:
    found = cantools.database.load_string(text, "dbc", strict=True)
    assert isinstance(found, Database)
    return found


def names(made: Database, message: str, signal: str) -> dict[int, str]:
    choices = made.get_message_by_name(message).get_signal_by_name(signal).choices
    return {int(code): str(name) for code, name in ({} if choices is None else choices).items()}


def test_values_and_nodes_come_out_as_they_came(
    model: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export-dbc", str(model)]) == OK
    first, second = database(LINE), database(capsys.readouterr().out)
    for message in first.messages:
        for signal in message.signals:
            if signal.choices:
                expected = names(first, message.name, signal.name)
                assert names(second, message.name, signal.name) == expected
    assert second.get_message_by_name("gear").senders == ["Gear_Box"]
    assert second.get_message_by_name("told").receivers == {"Gear_Box"}
    frame = bytes([3, 1, 77, 0, 0, 0, 0, 0])
    assert second.decode_message("gear", frame) == first.decode_message("gear", frame)


def test_the_bench_has_the_names_of_the_model(model: Path) -> None:
    system = checking.check(model).system
    made = as_in_model(database(emit_dbc(system, system.buses[0])))
    message = next(m for m in system.messages if m.name == "gear")
    state = next(s for s in message.signals if s.name == "state")
    assert names(made, "gear", "state") == {c: n for n, c in state.named_codes.items()}
    gear = made.get_message_by_name("gear")
    octets = gear.encode({"state": "N_1st_slow", "mode": "a_level", "level": 77})
    assert octets[:3] == bytes([1, 1, 77])
    values = gear.decode(octets)
    assert isinstance(values, dict)
    assert str(values["state"]) == "N_1st_slow"


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"not in gear"', '"1st (slow)"', "two values of `state` are named `1st (slow)`"),
        ('"not in gear"', '"On"', "two values of `state` are named `On`"),
        ("{not_in_gear: ", "{Not_There: ", "no value of `state` is `Not_There`"),
        ('"not in gear"', '"caf\u00e9"', "printable ASCII"),
        ('"not in gear"', '""', "1 to 128 characters"),
        ("level: {start: 16,", 'level: {value_names: {A: "b"}, start: 16,', "is no enumeration"),
        ("database_name: Gear_Box", "database_name: gear-box", "is not a name in databases"),
    ],
)
def test_a_name_that_cannot_be_is_refused(model: Path, old: str, new: str, told: str) -> None:
    text = model.read_text()
    assert old in text
    model.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(Refused) as refused:
        checking.check(model)
    assert told in str(refused.value)


def test_two_nodes_of_one_name_are_refused(model: Path) -> None:
    text = model.read_text()
    keys = "context_switch: 1 us, critical_section: 1 us, database_name: Gear_Box"
    other = f"nodes:\n  third: {{{keys}}}\n"
    model.write_text(text.replace("nodes:\n", other, 1))
    with pytest.raises(Refused, match="both named `Gear_Box` in databases"):
        checking.check(model)
