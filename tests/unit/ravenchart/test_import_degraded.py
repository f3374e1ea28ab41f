# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A signal that a model cannot have as it is changes that signal alone, and never its message."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cantools
import pytest
import yaml
from cantools.database import Database

from ravenchart.command_line import main
from ravenchart.databases.database import Imported, Periods, imported
from ravenchart.failures import OK, WRONG
from ravenchart.gen.emit.buses.dbc import emit_dbc
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.signals import positions
from ravenchart.gen.model.system import System
from tests.unit.ravenchart.test_import_database import database, system_of, whole


def taken_in(folder: Path, text: str, node: str = "ecu") -> tuple[Imported, Message, System]:
    """A message called `odd`, imported, and what the model has of it."""
    found = imported(database(folder, text), node, Periods("1 s"), lenient=True)
    (folder / "model.yaml").write_text(whole(found.text, node))
    system = system_of(folder / "model.yaml")
    return found, next(m for m in system.messages if m.name == "odd"), system


def raws(message: Message, octets: bytes) -> dict[str, int]:
    """The raw values in a frame, by the model's layout."""
    return {
        s.name: sum(
            (octets[bit // 8] >> bit % 8 & 1) << place
            for place, bit in enumerate(positions(s.start, s.width, s.order))
        )
        for s in message.signals
    }


CASCADED = (
    'BO_ 1 odd: 8 {0}\n SG_ a M : 0|8@1+ (1,0) [0|9] "" {1}\n'
    ' SG_ b m1M : 8|8@1+ (1,0) [0|9] "" {1}\n SG_ c m1 : 16|8@1+ (1,0) [0|9] "" {1}\n'
    ' SG_ d m2 : 16|16@1+ (1,0) [0|9] "" {1}\n SG_ e m2 : 8|16@1+ (1,0) [0|9] "" {1}\n'
    "SG_MUL_VAL_ 1 b a 1-1;\nSG_MUL_VAL_ 1 c b 1-1;\nSG_MUL_VAL_ 1 d b 2-3;\n"
    "SG_MUL_VAL_ 1 e a 2-5;"
)


@pytest.mark.parametrize(("sender", "receiver"), [("ecu", "other"), ("other", "ecu")])
def test_cascaded_multiplexors_are_pages_and_raw_bits(
    tmp_path: Path, sender: str, receiver: str
) -> None:
    found, message, system = taken_in(tmp_path, CASCADED.format(sender, receiver))
    assert found.problems == []
    by_name = {s.name: s for s in message.signals}
    assert by_name["a"].selects
    assert by_name["b"].pages == (1,)
    assert by_name["e"].pages == (2, 3, 4, 5)
    assert (by_name["c_Bits_16"].pages, by_name["c_Bits_16"].width) == ((1,), 16)
    assert "# odd.c_Bits_16  is bits 16 to 31 of the frame, which c, d share\n" in found.text
    assert emit_dbc(system, system.buses[0])
    first = cantools.database.load_file(tmp_path / "odd.dbc")
    assert isinstance(first, Database)
    for octets in (bytes([1, 1, 7, 0, 0, 0, 0, 0]), bytes([1, 2, 7, 9, 0, 0, 0, 0])):
        read: Any = first.decode_message("odd", octets)
        bits = raws(message, octets)["c_Bits_16"]
        assert read.get("c", bits & 255) == bits & 255
        assert read.get("d", bits) == bits


def test_an_inner_signal_that_shares_no_bits_is_its_raw_value(tmp_path: Path) -> None:
    text = CASCADED.format("other", "ecu").replace(' SG_ d m2 : 16|16@1+ (1,0) [0|9] "" ecu\n', "")
    found, message, _ = taken_in(tmp_path, text.replace("SG_MUL_VAL_ 1 d b 2-3;\n", ""))
    (inner,) = (s for s in message.signals if s.name == "c")
    assert (inner.raw_range, inner.pages) == ((0, 255), (1,))
    told = "# odd.c  counts raw values: it counts only where b is 1 (value = 1 * raw + 0)\n"
    assert told in found.text


def test_of_two_multiplexors_the_larger_one_is_the_models(tmp_path: Path) -> None:
    text = (
        'BO_ 1 odd: 8 other\n SG_ a M : 0|8@1+ (1,0) [0|9] "" ecu\n'
        ' SG_ b M : 8|8@1+ (1,0) [0|9] "" ecu\n SG_ c m1 : 16|8@1+ (1,0) [0|9] "" ecu\n'
        ' SG_ d m2 : 16|8@1+ (1,0) [0|9] "" ecu\n SG_ e m1 : 24|8@1+ (1,0) [0|9] "" ecu\n'
        "SG_MUL_VAL_ 1 c b 1-1;\nSG_MUL_VAL_ 1 d b 2-2;\nSG_MUL_VAL_ 1 e a 1-1;"
    )
    found, message, _ = taken_in(tmp_path, text)
    assert found.problems == []
    assert {s.name: (s.selects, s.pages) for s in message.signals} == {
        "a": (False, ()), "b": (True, ()), "c": (False, (1,)), "d": (False, (2,)), "e": (False, ()),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("selector", "values"),
    [("0|4@1- (1,0) [0|0]", ""), ("0|4@1+ (1,0) [0|3]", ""),
     ("0|4@1+ (1,2) [2|17]", ""), ("0|4@1+ (1,0) [0|1]", 'VAL_ 1 a 0 "Off" 1 "On" ;')],
)  # fmt: skip
def test_a_multiplexor_has_all_values_of_its_pages(
    tmp_path: Path, selector: str, values: str
) -> None:
    text = (
        f'BO_ 1 odd: 8 other\n SG_ a M : {selector} "" ecu\n'
        f' SG_ b m9 : 8|8@1+ (1,0) [0|9] "" ecu\n SG_ c m1 : 8|8@1+ (1,0) [0|9] "" ecu\n{values}'
    )
    found, message, _ = taken_in(tmp_path, text)
    assert found.problems == []
    pages = {s.name: s.pages for s in message.signals}
    assert pages == {"a": (), "b": (9,), "c": (1,)}


def test_a_page_that_the_multiplexor_has_no_bits_for_is_left_out(tmp_path: Path) -> None:
    text = (
        'BO_ 1 odd: 8 other\n SG_ a M : 0|2@1+ (1,0) [0|3] "" ecu\n'
        ' SG_ b m9 : 8|8@1+ (1,0) [0|9] "" ecu\n SG_ c m1 : 8|8@1+ (1,0) [0|9] "" ecu'
    )
    found, message, _ = taken_in(tmp_path, text)
    (problem,) = found.problems
    assert problem.endswith("odd.b is left out: its multiplexor has no such value")
    assert [s.name for s in message.signals] == ["a", "c"]


def test_what_is_left_out_of_a_sent_message_is_sent_as_a_constant(tmp_path: Path) -> None:
    text = (
        'BO_ 1 odd: 2 ecu\n SG_ x : 0|8@1+ (1,0) [0|255] "" other\n'
        ' SG_ y : 4|8@1+ (1,0) [0|255] "" other\n SG_ z : 12|8@1+ (1,0) [0|9] "" other\n'
        'BA_DEF_ SG_ "GenSigStartValue" INT 0 255;\nBA_DEF_DEF_ "GenSigStartValue" 0;\n'
        'BA_ "GenSigStartValue" SG_ 1 y 160;'
    )
    found, message, _ = taken_in(tmp_path, text)
    assert len(found.problems) == 2
    (constant,) = (s for s in message.signals if s.name.startswith("Reserved"))
    #  Bits 8 to 11 hold the upper half of 160, bits 12 to 15 the lower half of z's 0.
    assert (constant.start, constant.width, constant.raw_range) == (8, 8, (10, 10))
    assert "# odd.Reserved_8  is sent as 10: it stands for bits of signals that" in found.text
    assert message.length == 2


def test_a_message_without_signals_is_sent_as_raw_bits(tmp_path: Path) -> None:
    found, message, _ = taken_in(tmp_path, "BO_ 1 odd: 5 ecu")
    assert found.problems == []
    assert [(s.name, s.start, s.width) for s in message.signals] == [
        ("Data_0", 0, 32), ("Data_32", 32, 8),
    ]  # fmt: skip


def test_more_signals_than_fields_become_raw_bits(tmp_path: Path) -> None:
    rows = (f' SG_ s{n} : {7 * n}|7@1+ (1,0) [0|127] "" ecu' for n in range(73))
    found, message, _ = taken_in(tmp_path, "BO_ 1 odd: 64 other\n" + "\n".join(rows))
    assert found.problems == []
    assert len(message.signals) <= 64
    assert {bit for s in message.signals for bit in s.bits()} == set(range(7 * 73))
    assert "a value has 64 fields at most; of s" in found.text


def test_a_frame_has_a_length_that_there_is(tmp_path: Path) -> None:
    text = 'BO_ 1 odd: 9 other\n SG_ x : 0|8@1+ (1,0) [0|9] "" ecu'
    found, message, _ = taken_in(tmp_path, text)
    assert (message.length, message.fd) == (12, True)
    assert "# odd  has 12 bytes: there is no frame of 9\n" in found.text


def test_a_message_longer_than_a_frame_is_told(tmp_path: Path) -> None:
    text = 'BO_ 1 odd: 80 other\n SG_ x : 0|8@1+ (1,0) [0|9] "" ecu'
    (problem,) = imported(database(tmp_path, text), "ecu", Periods("1 s")).problems
    assert problem.endswith("odd is left out: it has 80 bytes, and a frame has 64 at most")


@pytest.mark.parametrize("order", ["0|128@1", "7|128@0"])
def test_a_signal_of_any_width_is_imported_in_pieces(tmp_path: Path, order: str) -> None:
    text = f'BO_ 1 odd: 16 other\n SG_ x : {order}+ (1,0) [0|0] "" ecu'
    found, message, _ = taken_in(tmp_path, text)
    assert found.problems == []
    octets = bytes(range(3, 19))
    parts = raws(message, octets)
    whole_value = sum(parts[f"x_{n}"] << 32 * n for n in range(4))
    assert whole_value == int.from_bytes(octets, "little" if order[0] == "0" else "big")


BUSES = """<NetworkDefinition xmlns="http://kayak.2codeornot2code.org/1.0"><Document/>
<Bus name="Front"><Message id="0x10" length="1" name="one"><Signal name="x" offset="0"/>
</Message></Bus>
<Bus name="Rear"><Message id="0x10" length="1" name="two"><Signal name="y" offset="0"/>
</Message></Bus></NetworkDefinition>
"""


def test_one_of_several_buses_is_imported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "line.kcd"
    path.write_text(BUSES)
    call = ["import", str(path), "--all", "--period", "1 s"]
    assert main(call) == WRONG
    told = "two is left out: one has its identifier 0x10; `--bus` imports one bus\n"
    assert told in capsys.readouterr().err
    assert main([*call, "--bus", "Rear"]) == OK
    assert list(yaml.safe_load(capsys.readouterr().out)["messages"]) == ["two"]
    assert main([*call, "--bus", "Rears"]) == WRONG
    assert "no bus is called Rears: did you mean `Rear`" in capsys.readouterr().err


def test_a_database_without_messages_is_a_model(tmp_path: Path) -> None:
    path = tmp_path / "none.dbc"
    path.write_text('VERSION ""\nNS_ :\nBS_:\nBU_: ecu\n')
    (tmp_path / "model.yaml").write_text(imported(path, "ecu").text)
    assert yaml.safe_load((tmp_path / "model.yaml").read_text())["types"] == {}


def test_two_messages_of_one_name_stay_apart(tmp_path: Path) -> None:
    text = 'BO_ {} odd: 1 other\n SG_ x : 0|8@1+ (1,0) [0|9] "" ecu\n'
    found, message, system = taken_in(tmp_path, text.format(1) + text.format(2))
    assert found.problems == []
    assert message.identifier == 1
    assert {m.name: m.identifier for m in system.messages} == {"odd": 1, "odd_2": 2, "fine": 256}
    assert "# odd  is named odd_2\n" in found.text
