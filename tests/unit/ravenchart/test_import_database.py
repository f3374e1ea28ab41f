# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A CAN database as part of a model, and what comes out of that again."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import cantools
import pytest
import yaml
from cantools.database import Database

from ravenchart.command_line import main
from ravenchart.databases.database import Periods, imported
from ravenchart.failures import OK, WRONG, Refused
from ravenchart.gen.emit.buses.dbc import emit_dbc
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from tests.support.interpreted import plain


def system_of(path: Path) -> System:
    found = load(path)
    assert found.system is not None, [str(d) for d in found.diagnostics]
    return found.system


def whole(text: str, node: str) -> str:
    """An imported model with what a database cannot know."""
    model = plain(text)
    (name,) = model["components"]
    component = model["components"][name]
    outs = [port for port, form in component["ports"].items() if "out" in form]
    rows = [f"{node}.ports"] if len(outs) < len(component["ports"]) else []
    if rows:
        component["port_region"] = {"period": "20 ms", "wcet": "10 us"}
    if outs or not rows:
        sends = {"sends": outs} if outs else {}
        component["activities"] = {
            "work": {"period": "20 ms", "wcet": "10 us", "body": "user", **sends}
        }
        rows.append(f"{node}.work")
    model |= {
        "system": "Again",
        "nodes": {node: {"context_switch": "1 us", "critical_section": "1 us"}},
        "instances": {node: {"component": name, "node": node}},
        "buses": {
            "bus": {
                "bit_rate": "500 kbit/s",
                "driver_wcet": "10 us",
                "receive_depth": 8,
                "transmit_depth": 8,
            }
        },
        "processors": {
            "work": {"node": node, "stack": "16 KiB", "activities": rows},
        },
    }
    if len(outs) < len(component["ports"]):
        model["processors"]["reception"] = {
            "node": node,
            "released_by": "bus",
            "period": "1 ms",
            "stack": "16 KiB",
            "activities": ["bus.receive"],
        }
    return yaml.safe_dump(model, sort_keys=False).replace("'0x", "0x")


def layout(text: str) -> dict[str, object]:
    """Everything that a database says of its messages."""
    database = cantools.database.load_string(text, "dbc", strict=True)
    assert isinstance(database, Database)
    return {
        m.name: (
            m.frame_id,
            m.is_extended_frame,
            m.is_fd,
            m.length,
            m.cycle_time,
            {
                s.name: (
                    *(s.start, s.length, s.byte_order, s.is_signed, s.scale, s.offset),
                    *(s.minimum, s.maximum, s.unit, s.choices and dict(s.choices)),
                    *(s.is_multiplexer, s.multiplexer_ids, s.multiplexer_signal),
                )
                for s in m.signals
            },
        )
        for m in database.messages
    }


def without_limits(text: str) -> str:
    """No limits of signals whose values have names: those between may come in, imported."""
    named = re.findall(r"^VAL_ (\d+) (\w+) ", text, re.M)
    for message, signal in named:
        limits = rf"^(BO_ {message} .*\n(?: SG_ .*\n)*? SG_ {signal} .*)\[.*\|.*\]"
        text, count = re.subn(limits, r"\1[0|0]", text, flags=re.M)
        assert count == 1
    return text


@pytest.mark.parametrize("case", ["signals", "flexible"])
def test_what_is_imported_is_exported_again_as_it_was(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    system = system_of(ROOT / "tests" / "feature" / case / "model.yaml")
    first = emit_dbc(system, system.buses[0])
    (tmp_path / "line.dbc").write_text(first)
    assert main(["import-dbc", str(tmp_path / "line.dbc"), "--node", "board"]) == OK
    model = tmp_path / "model.yaml"
    model.write_text(whole(capsys.readouterr().out, "board"))
    again = system_of(model)
    assert layout(without_limits(emit_dbc(again, again.buses[0]))) == layout(without_limits(first))


HEAD = """VERSION ""
NS_ :
BS_:
BU_: ecu other
"""
GOOD = """BO_ 256 fine: 1 other
 SG_ level : 0|8@1+ (0.5,-40) [-40|87.5] "degC" ecu
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_DEF_DEF_ "GenMsgCycleTime" 0;
BA_ "GenMsgCycleTime" BO_ 256 10;
"""


def database(folder: Path, *messages: str) -> Path:
    path = folder / "odd.dbc"
    path.write_text(HEAD + "\n".join(messages) + "\n" + GOOD)
    return path


def test_a_value_counts_the_scale_of_its_signal(tmp_path: Path) -> None:
    found = yaml.safe_load(imported(database(tmp_path), "ecu").text)
    assert found["types"]["fine_level"] == {"range": [-80, 175], "unit": "0.5 degC"}
    signals = found["messages"]["fine"]["signals"]
    assert signals == {"level": {"start": 0, "width": 8, "offset": -80}}
    assert found["messages"]["fine"]["period"] == "10 ms"


@pytest.mark.parametrize(
    ("message", "told"),
    [
        ("BO_ 1 odd: 0 ecu", "its frame has no data"),
        (
            'BO_ 1 first: 8 ecu\n SG_ x : 0|8@1+ (1,0) [0|9] "" other\nBO_ 1 odd: 8 ecu',
            "first has its identifier 0x1",
        ),
        ('BO_ 1 odd: 8 other\n SG_ x : 0|8@1+ (1,0) [0|9] "" ecu', "no cycle time"),
    ],
)
def test_what_a_model_cannot_say_is_told_and_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], message: str, told: str
) -> None:
    path = database(tmp_path, message)
    assert main(["import-dbc", str(path), "--node", "ecu"]) == WRONG
    out = capsys.readouterr()
    assert f"{path}: error: odd is left out: " in out.err
    assert told in out.err
    assert "odd" not in yaml.safe_load(out.out)["messages"]
    assert "fine" in yaml.safe_load(out.out)["messages"]


SILENT = 'BO_ 1 odd: 8 other\n SG_ x : 0|8@1+ (1,0) [0|9] "" ecu'


@pytest.mark.parametrize(
    ("rows", "period"),
    [(None, "100 ms"), ("odd: 40 ms\n", "40 ms"), ("fine: 20 ms\n", "100 ms")],
)
def test_a_message_without_a_cycle_time_gets_the_period_that_is_given(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], rows: str | None, period: str
) -> None:
    told = ["import-dbc", str(database(tmp_path, SILENT)), "--node", "ecu", "--period", "100 ms"]
    if rows is not None:
        (tmp_path / "periods.yaml").write_text(rows)
        told += ["--periods", str(tmp_path / "periods.yaml")]
    assert main(told) == OK
    text = capsys.readouterr().out
    messages = yaml.safe_load(text)["messages"]
    assert messages["odd"]["period"] == period
    assert messages["fine"]["period"] == ("20 ms" if rows and "fine" in rows else "10 ms")
    (tmp_path / "model.yaml").write_text(whole(text, "ecu"))
    assert {m.name for m in system_of(tmp_path / "model.yaml").messages} == {"odd", "fine"}


@pytest.mark.parametrize(
    ("default", "rows", "told"),
    [
        ("fast", "", "--period: error: `fast` is no duration such as `20 ms`"),
        ("0 ms", "", "--period: error: `0 ms` is no duration"),
        (None, "odd: 7", "odd: error: `7` is no duration"),
        (None, "- odd", "expected rows `message: 20 ms`"),
        (None, "od: 20 ms", "no message is called od: did you mean `odd`"),
        (None, "odd: [", "error: while parsing"),
    ],
)
def test_periods_that_are_wrong_are_refused(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    default: str | None,
    rows: str,
    told: str,
) -> None:
    (tmp_path / "periods.yaml").write_text(rows)
    call = ["import-dbc", str(database(tmp_path, SILENT)), "--node", "ecu"]
    call += ["--periods", str(tmp_path / "periods.yaml")]
    call += ["--period", default] if default is not None else []
    assert main(call) == WRONG
    out = capsys.readouterr()
    assert told in out.err
    assert out.out == ""


@pytest.mark.parametrize(
    ("signal", "named", "keys", "definition", "changes"),
    [
        (
            'x : 0|8@1+ (0.1,0.05) [0|25] ""', "x", {"start": 0, "width": 8}, [0, 255],
            ["x counts raw values: its offset is no whole number of counts "
             "(value = 0.1 * raw + 0.05)"],
        ),
        (
            'x : 0|8@1- (-2,3) [0|0] "deg"', "x", {"start": 0, "width": 8, "signed": True},
            [-128, 127],
            ["x counts raw values: its scale is -2 (value = -2 * raw + 3 deg)"],
        ),
        (
            'x : 0|8@1+ (1,0) [9|300] "a unit of more than 20 letters"', "x",
            {"start": 0, "width": 8}, [0, 255],
            ["x counts raw values: its unit `a unit of more than 20 letters` is not one of at "
             "most 20 characters (value = 1 * raw + 0 a unit of more than 20 letters)"],
        ),
        (
            'x : 0|8@1+ (1,0) [300|400] ""', "x", {"start": 0, "width": 8}, [0, 255],
            ["x counts raw values: it has no value within its limits (value = 1 * raw + 0)"],
        ),
        (
            'end : 0|8@1+ (1,0) [0|9] ""', "end_2",
            {"start": 0, "width": 8, "offset": 0, "database_name": "end"}, [0, 9],
            ["end is named end_2"],
        ),
        (
            'x__y : 0|8@1+ (1,0) [0|9] ""', "x_y",
            {"start": 0, "width": 8, "offset": 0, "database_name": "x__y"}, [0, 9],
            ["x__y is named x_y"],
        ),
    ],
)  # fmt: skip
@pytest.mark.parametrize(("sender", "receiver"), [("ecu", "other"), ("other", "ecu")])
def test_what_a_model_has_no_words_for_is_changed_and_said(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    signal: str,
    named: str,
    keys: dict[str, object],
    definition: list[int],
    changes: list[str],
    sender: str,
    receiver: str,
) -> None:
    path = database(tmp_path, f"BO_ 1 odd: 8 {sender}\n SG_ {signal} {receiver}")
    assert main(["import", str(path), "--node", "ecu", "--period", "1 s"]) == OK
    out = capsys.readouterr()
    assert out.err == ""
    model = yaml.safe_load(out.out)
    assert model["messages"]["odd"]["signals"] == {named: keys}
    (of_signal,) = (t for n, t in model["types"].items() if n.startswith("odd_") and "range" in t)
    assert of_signal["range"] == definition
    for change in changes:
        assert f"# odd.{' '.join(change.split())}" in [
            " ".join(line.split()) for line in out.out.splitlines()
        ]
    (tmp_path / "model.yaml").write_text(whole(out.out, "ecu"))
    assert "odd" in {m.name for m in system_of(tmp_path / "model.yaml").messages}


@pytest.mark.parametrize("order", ["0|64@1", "7|64@0"])
def test_a_signal_of_64_bits_is_imported_in_halves(tmp_path: Path, order: str) -> None:
    path = database(tmp_path, f'BO_ 1 odd: 8 other\n SG_ x : {order}- (1,0) [0|0] "" ecu')
    found = imported(path, "ecu", Periods("1 s"))
    assert found.problems == []
    signals = yaml.safe_load(found.text)["messages"]["odd"]["signals"]
    starts = {"x_High": 7, "x_Low": 39} if order == "7|64@0" else {"x_High": 32, "x_Low": 0}
    assert {name: keys["start"] for name, keys in signals.items()} == starts
    (tmp_path / "model.yaml").write_text(whole(found.text, "ecu"))
    system = system_of(tmp_path / "model.yaml")
    again = cantools.database.load_string(emit_dbc(system, system.buses[0]), "dbc")
    assert isinstance(again, Database)
    first = cantools.database.load_file(path)
    assert isinstance(first, Database)
    for octets in (bytes(range(1, 9)), bytes(range(250, 242, -1))):
        of_first: Any = first.decode_message("odd", octets)
        halves: Any = again.decode_message("odd", octets)
        assert halves["x_High"] << 32 | halves["x_Low"] == of_first["x"] % 2**64


def test_a_floating_point_number_is_imported_as_its_bits(tmp_path: Path) -> None:
    text = 'BO_ 1 odd: 8 other\n SG_ x : 0|32@1- (1,0) [0|0] "" ecu\nSIG_VALTYPE_ 1 x : 1;'
    found = imported(database(tmp_path, text), "ecu", Periods("1 s"))
    model = yaml.safe_load(found.text)
    assert model["types"]["odd_x"] == {"range": [0, 2**32 - 1]}
    assert "counts raw values: it is a floating-point number\n" in found.text


def test_signals_that_share_bits_need_lenient(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = database(tmp_path, f'{SILENT}\n SG_ y : 4|8@1+ (1,0) [0|9] "" ecu\n'
                    ' SG_ z : 60|8@1+ (1,0) [0|9] "" ecu')  # fmt: skip
    call = ["import", str(path), "--node", "ecu", "--period", "1 s"]
    assert main(call) == WRONG
    refused = capsys.readouterr()
    assert refused.out == ""
    assert f"{path}: hint: `--lenient` leaves such signals out\n" in refused.err
    assert main([*call, "--lenient"]) == WRONG
    out = capsys.readouterr()
    assert out.err == (
        f"{path}: error: odd.y is left out: it shares bits with x\n"
        f"{path}: error: odd.z is left out: it reaches beyond the 8 bytes of its frame\n"
    )
    assert list(yaml.safe_load(out.out)["messages"]["odd"]["signals"]) == ["x"]


def test_pages_without_a_multiplexor_share_their_bits(tmp_path: Path) -> None:
    text = (
        'BO_ 1 odd: 8 other\n SG_ a m : 6|2@1+ (1,0) [0|3] "" ecu\n'
        ' SG_ b m1 : 0|6@1+ (1,0) [0|9] "" ecu\n SG_ c m2 : 0|6@1+ (1,0) [0|9] "" ecu'
    )
    found = imported(database(tmp_path, text), "ecu", Periods("1 s"), lenient=True)
    (problem,) = found.problems
    assert problem.endswith("odd.c is left out: it shares bits with b")
    (tmp_path / "model.yaml").write_text(whole(found.text, "ecu"))
    assert system_of(tmp_path / "model.yaml")


def test_a_received_message_without_signals_stays_on_the_bus(tmp_path: Path) -> None:
    found = imported(database(tmp_path, "BO_ 1 odd: 4 other"), None, Periods("50 ms"))
    assert found.problems == []
    assert yaml.safe_load(found.text)["messages"]["odd"] == {
        "bus": "bus", "id": 1, "bytes": 4, "period": "50 ms",
    }  # fmt: skip
    assert "# odd  is on the bus alone: no port has its value\n" in found.text


def test_names_that_are_no_names_are_mapped_and_stay_apart(tmp_path: Path) -> None:
    text = (
        'BO_ 1 odd: 8 other\n SG_ a_b : 0|8@1+ (1,0) [0|3] "" ecu\n'
        ' SG_ a__b : 8|8@1+ (1,0) [0|9] "" ecu\n SG_ A_B_ : 16|8@1+ (1,0) [0|9] "" ecu\n'
        'VAL_ 1 a_b 0 "Off now" 1 "off.now" 2 "2nd" 3 "Standard" ;'
    )
    found = imported(database(tmp_path, text), "ecu", Periods("1 s"))
    model = plain(found.text)
    assert list(model["messages"]["odd"]["signals"]) == ["a_b", "a_b_2", "A_B_3"]
    assert model["types"]["odd_a_b"] == {"values": ["Off_now", "off_now_2", "N_2nd", "Standard_2"]}
    assert "# odd.a_b   its value `off.now` is named off_now_2\n" in found.text
    (tmp_path / "model.yaml").write_text(whole(found.text, "ecu"))
    assert system_of(tmp_path / "model.yaml")


@pytest.mark.parametrize("form", ["kcd", "sym", "dbc"])
def test_a_monitor_receives_all_messages_of_any_database(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], form: str
) -> None:
    first = cantools.database.load_file(database(tmp_path, SILENT))
    assert isinstance(first, Database)
    path = tmp_path / f"line.{form}"
    path.write_text(getattr(first, f"as_{form}_string")())
    assert main(["import", str(path), "--all", "--period", "100 ms"]) == OK
    text = capsys.readouterr().out
    model = yaml.safe_load(text)
    assert {m["to"] for m in model["messages"].values()} == {"monitor.odd", "monitor.fine"}
    (tmp_path / "model.yaml").write_text(whole(text, "monitor"))
    found = system_of(tmp_path / "model.yaml")
    fine = next(m for m in found.messages if m.name == "fine")
    #  -40 degC .. 87.5 degC in counts of 0.5 degC, at bit 0
    (signal,) = fine.signals
    assert (signal.start, signal.width, signal.offset, fine.identifier) == (0, 8, -80, 256)


def test_a_database_without_nodes_needs_all(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first = cantools.database.load_file(database(tmp_path, SILENT))
    assert isinstance(first, Database)
    path = tmp_path / "line.sym"
    path.write_text(first.as_sym_string())
    assert main(["import", str(path), "--node", "ecu"]) == WRONG
    assert "no node is called ecu: it has no nodes: use `--all`" in capsys.readouterr().err
    path.with_suffix(".kcd").write_text("<no")
    assert main(["import", str(path.with_suffix(".kcd")), "--all"]) == WRONG
    assert "line.kcd: error: " in capsys.readouterr().err


def test_names_of_single_values_are_told(tmp_path: Path) -> None:
    text = 'BO_ 1 odd: 8 ecu\n SG_ x : 0|8@1+ (1,0) [0|250] "" other\nVAL_ 1 x 255 "Absent" ;'
    found = imported(database(tmp_path, text), "ecu")
    assert found.problems == []
    assert "# odd.x  is a number, of which some have names: 255 Absent\n" in found.text
    assert "odd_x: {range: [0, 255]}" in found.text


def test_a_node_that_is_not_there_is_told_with_those_that_are(tmp_path: Path) -> None:
    with pytest.raises(Refused, match="no node is called ecus: did you mean `ecu`"):
        imported(database(tmp_path), "ecus")


def test_a_file_that_is_no_database_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "no.dbc"
    path.write_text("BO_ 12 x")
    with pytest.raises(Refused, match=r"no\.dbc: error: "):
        imported(path, "ecu")
