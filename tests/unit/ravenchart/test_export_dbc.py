# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Import, export, and a database again with the same values, names, comments and attributes."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import cantools
import pytest
from cantools.database import Database

from ravenchart.command_line import main
from ravenchart.databases.database import Periods, imported
from ravenchart.failures import OK, WRONG
from ravenchart.paths import ROOT
from tests.unit.ravenchart.test_import_database import HEAD, whole

LINE = (
    HEAD
    + """BO_ 1 end: 8 other
 SG_ a M : 0|8@1+ (1,0) [0|0] "" ecu
 SG_ b__b m1M : 8|8@1+ (1,0) [0|0] "" ecu
 SG_ c m1 : 16|8@1- (-0.5,3) [0|0] "a unit of more than 20 letters" ecu
 SG_ d m2 : 16|16@1+ (1,0) [0|0] "" ecu
BO_ 2 floats: 8 other
 SG_ x : 0|32@1- (1,0) [0|0] "" ecu
 SG_ y : 39|8@0+ (0.1,0.05) [0|25] "V" ecu
BO_ 2147483907 A_Message_Of_A_Long_Name_In_It: 8 ecu
 SG_ A_Signal_Of_A_Long_Name_In_It : 0|64@1+ (1,0) [0|0] "" other
BO_ 4 bare: 3 ecu
BO_ 5 alone: 3 other
BO_ 6 theirs: 8 other
 SG_ z : 0|8@1+ (2,0) [0|0] "" other
CM_ "All of it";
CM_ BU_ ecu "The node";
CM_ BO_ 2 "Two numbers";
CM_ SG_ 2 y "A voltage";
BA_DEF_ "Maker" STRING;
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_DEF_ SG_ "Kind" ENUM "plain","odd";
BA_DEF_DEF_ "Maker" "";
BA_DEF_DEF_ "GenMsgCycleTime" 0;
BA_DEF_DEF_ "Kind" "plain";
BA_ "Maker" "Works";
BA_ "GenMsgCycleTime" BO_ 1 10;
BA_ "Kind" SG_ 2 y 1;
VAL_ 2 y 255 "Absent" ;
SIG_VALTYPE_ 2 x : 1;
SG_MUL_VAL_ 1 b__b a 1-1;
SG_MUL_VAL_ 1 c b__b 1-1;
SG_MUL_VAL_ 1 d b__b 2-3;
"""
)


def modelled(folder: Path, text: str) -> Path:
    """The file of a database; beside it, `model.yaml` is made of it."""
    path = folder / "line.dbc"
    path.write_text(text)
    found = imported(path, "ecu", Periods("50 ms"))
    assert found.problems == []
    (folder / "model.yaml").write_text(whole(found.text, "ecu"))
    return path


@pytest.fixture
def line(tmp_path: Path) -> Path:
    return modelled(tmp_path, LINE)


def again(path: Path, text: str) -> tuple[Database, Database]:
    """The database that was imported, and the one that is exported."""
    second = cantools.database.load_string(text, "dbc", strict=True)
    first = cantools.database.load_file(path)
    assert isinstance(first, Database)
    assert isinstance(second, Database)
    return first, second


def values_of(database: Database, name: str, octets: bytes) -> Any:
    """The values in a frame, or why there are none; a NaN is like any other."""
    try:
        return repr(database.decode_message(name, octets))
    except Exception as problem:
        return type(problem).__name__


def test_a_database_comes_out_as_it_was(line: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export-dbc", str(line.with_name("model.yaml")), "--like", str(line)]) == OK
    out = capsys.readouterr()
    assert out.err == ""
    first, second = again(line, out.out)
    assert [m.name for m in second.messages] == [m.name for m in first.messages]
    chance = random.Random(3)
    for message in first.messages:
        for page in range(40):
            octets = bytes([page % 4, page // 4 % 4, *chance.randbytes(6)])[: message.length]
            of_first = values_of(first, message.name, octets)
            assert values_of(second, message.name, octets) == of_first
    voltage = second.get_message_by_name("floats").get_signal_by_name("y")
    assert (voltage.comment, voltage.unit) == ("A voltage", "V")
    assert voltage.dbc is not None
    assert voltage.dbc.attributes["Kind"].value == 1
    assert second.get_message_by_name("floats").comment == "Two numbers"
    assert second.dbc is not None
    assert second.dbc.attributes["Maker"].value == "Works"
    cycles = {m.name: m.cycle_time for m in second.messages}
    assert (cycles["end"], cycles["floats"]) == (10, 50)
    assert [node.name for node in second.nodes][:2] == ["ecu", "other"]


def test_a_message_with_another_layout_is_as_in_the_model(
    line: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = line.with_name("model.yaml")
    text = model.read_text().replace("start: 39", "start: 47")
    assert text != model.read_text()
    model.write_text(text)
    assert main(["export-dbc", str(model), "--bus", "bus", "--like", str(line)]) == OK
    out = capsys.readouterr()
    assert out.err == (
        "note: floats is as in the model: it has another layout or identifier in line.dbc\n"
    )
    _, second = again(line, out.out)
    moved = second.get_message_by_name("floats").get_signal_by_name("y")
    assert (moved.start, moved.unit) == (47, None)


def test_without_an_original_it_is_the_database_that_is_generated(
    line: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = line.with_name("model.yaml")
    assert main(["export-dbc", str(model)]) == OK
    first, second = again(line, capsys.readouterr().out)
    theirs = {"alone", "theirs"}
    assert {m.name for m in second.messages} == {m.name for m in first.messages} - theirs
    assert main(["export-dbc", str(model), "--bus", "bis"]) == WRONG
    assert "no bus is called bis: did you mean `bus`" in capsys.readouterr().err


def test_a_model_without_a_bus_has_no_database(capsys: pytest.CaptureFixture[str]) -> None:
    model = str(ROOT / "examples" / "three_components" / "model.yaml")
    for bus in ([], ["--bus", "line"]):
        assert main(["export-dbc", model, *bus]) == WRONG
        assert capsys.readouterr().err == f"{model}: error: the model has no bus\n"
