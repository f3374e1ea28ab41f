# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names that a model cannot have: imported, checked, exported and played by the bench."""

from __future__ import annotations

import random
import re
import shutil
from pathlib import Path
from typing import Any

import cantools
import pytest
from cantools.database import Database

from ravenchart.command_line import main
from ravenchart.databases.database import Periods, imported
from ravenchart.failures import OK
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.hw_can.bench.peer import Codec
from ravenchart.hw_can.bench.scenario import load_scenario
from ravenchart.paths import ROOT
from ravenchart.running.scenarios import problems
from tests.unit.ravenchart.test_export_dbc import modelled
from tests.unit.ravenchart.test_import_database import HEAD, system_of, whole

LONG = "A_Message_Of_A_Very_Long_Name_That_Goes_On"
LONG_SIGNAL = "A_Signal_Of_A_Very_Long_Name_That_Goes_On"
LINE = (
    HEAD
    + f"""BO_ 1 end: 8 other
 SG_ null M : 0|8@1+ (1,0) [0|0] "" ecu
 SG_ Level : 8|8@1+ (1,0) [0|0] "" ecu
 SG_ level : 16|8@1+ (1,0) [0|0] "" ecu
 SG_ a__b m1 : 24|8@1- (1,0) [0|0] "" ecu
 SG_ a_b m1 : 32|8@1+ (1,0) [0|0] "" ecu
 SG_ a_b_ m2 : 31|8@0+ (1,0) [0|0] "" ecu
BO_ 2 {LONG}_1: 8 ecu
 SG_ {LONG_SIGNAL}_1 : 0|16@1+ (0.5,-40) [-40|100] "degC" other
 SG_ {LONG_SIGNAL}_2 : 16|16@1- (1,0) [0|0] "" other
BO_ 2147483651 {LONG}_2: 8 ecu
 SG_ _1st : 0|8@1+ (1,0) [0|0] "" other
BO_ 4 End: 8 other
 SG_ x : 0|8@1+ (1,0) [0|0] "" ecu
BO_ 5 a__b: 8 other
 SG_ x : 0|8@1+ (1,0) [0|0] "" ecu
BO_ 6 a_b: 8 other
 SG_ x : 0|8@1+ (1,0) [0|0] "" ecu
BO_ 7 a_b_2: 8 other
 SG_ x : 0|8@1+ (1,0) [0|0] "" ecu
BO_ 8 package: 8 other
 SG_ x : 0|8@1+ (1,0) [0|0] "" other
"""
)
FOREIGN = "package"
"""Others send it to others: it is in no database of the model."""


@pytest.fixture
def line(tmp_path: Path) -> Path:
    return modelled(tmp_path, LINE)


def database_of(text: str) -> Database:
    found = cantools.database.load_string(text, "dbc", strict=True)
    assert isinstance(found, Database)
    return found


def raw_values(database: Database, name: str, octets: bytes) -> Any:
    """The raw values in a frame, or why there are none."""
    try:
        return database.decode_message(name, octets, decode_choices=False, scaling=False)
    except Exception as problem:
        return type(problem).__name__


def test_a_database_comes_out_with_its_names_without_the_original(
    line: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first = database_of(LINE)
    assert main(["export-dbc", str(line.with_name("model.yaml"))]) == OK
    second = database_of(capsys.readouterr().out)
    expected = [m for m in first.messages if m.name != FOREIGN]
    assert {m.name for m in second.messages} == {m.name for m in expected}
    chance = random.Random(19)
    compared = 0
    for message in expected:
        again = second.get_message_by_name(message.name)
        assert {s.name for s in again.signals} == {s.name for s in message.signals}
        for number in range(60):
            octets = bytes([number % 4, *chance.randbytes(7)])
            values = raw_values(first, message.name, octets)
            assert raw_values(second, message.name, octets) == values
            if isinstance(values, dict):
                of_first = first.decode_message(message.name, octets)
                assert second.decode_message(message.name, octets) == of_first
                compared += len(values)
                packed = first.encode_message(message.name, values, scaling=False, strict=False)
                other = second.encode_message(message.name, values, scaling=False, strict=False)
                assert other == packed
    assert compared > 500


def test_the_name_is_written_only_where_it_is_another_one(line: Path) -> None:
    text = imported(line, "ecu", Periods("50 ms")).text
    kept = {part.split('"')[1] for part in text.split("database_name: ")[1:]}
    assert kept == {
        *("end", "End", "null", "level", "a__b", "a_b_", "_1st", "package"),
        *(f"{LONG}_1", f"{LONG}_2", f"{LONG_SIGNAL}_1", f"{LONG_SIGNAL}_2"),
    }


def test_two_equal_names_are_kept_once(tmp_path: Path) -> None:
    path = tmp_path / "twice.dbc"
    path.write_text(
        HEAD
        + """BO_ 1 end: 8 other
 SG_ x : 0|8@1+ (1,0) [0|0] "" ecu
BO_ 2 end: 8 other
 SG_ x : 0|8@1+ (1,0) [0|0] "" ecu
"""
    )
    found = imported(path, "ecu", Periods("50 ms"))
    assert found.text.count('database_name: "end"') == 1
    (tmp_path / "model.yaml").write_text(whole(found.text, "ecu"))
    assert len(system_of(tmp_path / "model.yaml").messages) == 2


def without_names(path: Path) -> System:
    """The model without the names, its other lines where they were."""
    text, count = re.subn(r"^ *database_name: .*$", "", path.read_text(), flags=re.M)
    assert count > 10
    bare = path.parent / "bare" / path.name
    bare.parent.mkdir()
    bare.write_text(text)
    return system_of(bare)


def test_the_program_is_the_same_with_and_without_the_names(line: Path) -> None:
    path = line.with_name("model.yaml")
    system = system_of(path)
    bare = without_names(path)
    named, unnamed = generate(system, Claims()), generate(bare, Claims())
    assert named.keys() == unnamed.keys()
    told = {
        name for name, text in named.items()
        if text.replace(system.digest, bare.digest) != unnamed[name]
    }  # fmt: skip
    assert told == {"bus.dbc"}


def test_the_bench_has_the_names_of_the_model(
    line: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    model = line.with_name("model.yaml")
    assert main(["export-dbc", str(model)]) == OK
    (tmp_path / "bus.dbc").write_text(capsys.readouterr().out)
    codec = Codec.from_file(tmp_path / "bus.dbc")
    system = system_of(model)
    for message in system.messages:
        assert set(codec.fields(message.name)) == {s.name for s in message.signals}
    page = next(m for m in system.messages if m.database_name == "end")
    selector = next(s.name for s in page.signals if s.database_name == "null")
    values = {selector: 1, "Level": 3, "level_2": 4, "a_b_2": -5, "a_b": 6}
    frame = codec.encode(page.name, values)
    assert bytes(frame.data) == bytes([1, 3, 4, 251, 6, 0, 0, 0])
    assert codec.decode(frame) == (page.name, values)


def test_a_scenario_has_the_names_of_the_model(line: Path, tmp_path: Path) -> None:
    system = system_of(line.with_name("model.yaml"))
    scenario = tmp_path / "play.yaml"
    scenario.write_text("scenario: Names\nsteps:\n  - {send: a_b, with: {x: 1}}\n"
                        "  - {send: end_2, with: {x: 1}}\n")  # fmt: skip
    found = problems(load_scenario(scenario), system)
    assert [one.message for one in found] == ["end_2 has no field `x`"]


def test_no_message_is_named_like_that_of_a_connection_between_nodes(tmp_path: Path) -> None:
    for one in (ROOT / "examples" / "two_nodes").glob("*.yaml"):
        shutil.copy(one, tmp_path)
    path = tmp_path / "model.yaml"
    text = path.read_text()
    connection = system_of(path).messages[0]
    more = (
        "messages:\n  watched: {bus: link, id: 0x700, period: 1 s, bytes: 1, database_name: NAME}\n"
    )
    assert "\nmessages:" not in text
    path.write_text(text + more.replace("NAME", "another"))
    assert load(path).system is not None
    path.write_text(text + more.replace("NAME", connection.name))
    (found,) = (one for one in load(path).diagnostics if one.is_error)
    assert found.message.startswith(f"watched and {connection.name} are both named")
    assert (found.code, found.origin.line) == ("RV-0622", text.count("\n") + 2)
