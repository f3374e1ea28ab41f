# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What `import` prints is a model: it passes `check`, and its program can be made."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from ravenchart.building import checking, generation
from ravenchart.command_line import main
from ravenchart.databases.database import Imported, Periods, imported
from ravenchart.failures import OK
from ravenchart.gen.model.system import System
from tests.unit.ravenchart.test_import_database import HEAD

PLAIN = """BO_ 1 first: 8 ecu
 SG_ speed : 0|16@1+ (0.1,0) [0|100] "m/s" other
BO_ 2 second: 4 ecu
 SG_ force : 0|8@1+ (1,0) [0|255] "N" other
BO_ 3 third: 8 other
 SG_ level : 0|8@1+ (1,0) [0|255] "%" ecu
BO_ 4 fourth: 8 other
 SG_ heat : 0|8@1+ (1,0) [0|255] "K" other
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_DEF_DEF_ "GenMsgCycleTime" 0;
BA_ "GenMsgCycleTime" BO_ 1 20;
BA_ "GenMsgCycleTime" BO_ 3 10;
"""
KCD = """<NetworkDefinition xmlns="http://kayak.2codeornot2code.org/1.0">
<Document/><Bus name="slow" baudrate="{rate}">
<Message id="0x10" length="8" name="often" interval="{interval}"/>
<Message id="0x11" length="8" name="seldom" interval="100"/>
</Bus></NetworkDefinition>"""


def database(folder: Path, text: str) -> Path:
    """A DBC of the nodes `ecu` and `other`."""
    path = folder / "line.dbc"
    path.write_text(HEAD + text)
    return path


def made(folder: Path, found: Imported) -> System:
    """The model that was printed, checked, with its program."""
    (folder / "model.yaml").write_text(found.text)
    checked = checking.check(folder / "model.yaml")
    generation.write_program(checked)
    return checked.system


@pytest.mark.parametrize("node", ["ecu", "other", None])
def test_it_is_checked_and_generated(tmp_path: Path, node: str | None) -> None:
    found = imported(database(tmp_path, PLAIN), node, Periods("50 ms"))
    system = made(tmp_path, found)
    assert found.problems == []
    assert len(system.frames) == 4
    assert (tmp_path / "generated").is_dir()


def test_a_row_sends_what_has_its_cycle_time(tmp_path: Path) -> None:
    system = made(tmp_path, imported(database(tmp_path, PLAIN), "ecu", Periods("50 ms")))
    periods = {p.name: p.period for p in system.processors}
    assert periods["every_20_ms"] == 20_000_000
    assert periods["every_50_ms"] == 50_000_000
    model = yaml.safe_load((tmp_path / "model.yaml").read_text())
    rows = model["components"]["Ecu_Ports"]["activities"]
    assert rows["every_20_ms"]["sends"] == ["first"]
    assert rows["every_50_ms"]["sends"] == ["second"]


@pytest.mark.parametrize("node", ["ecu", None])
def test_a_database_without_messages_is_a_model_too(tmp_path: Path, node: str | None) -> None:
    system = made(tmp_path, imported(database(tmp_path, ""), node))
    assert system.frames == ()


@pytest.mark.parametrize(
    ("rate", "interval", "bit_rate", "deadline"),
    [
        (125_000, 10, 125_000, None),
        (125_000, 2, 125_000, 5_000_000),
        (125_000, 1, 500_000, 2_000_000),
    ],
)
def test_frames_fit_on_the_bus(
    tmp_path: Path, rate: int, interval: int, bit_rate: int, deadline: int | None
) -> None:
    path = tmp_path / "line.kcd"
    path.write_text(KCD.format(rate=rate, interval=interval))
    found = imported(path, None)
    system = made(tmp_path, found)
    assert system.buses[0].bit_rate == bit_rate
    assert ("not 125000" in found.text) == (bit_rate != rate)
    often = next(m for m in system.frames if m.name == "often")
    assert often.deadline == deadline


def test_so_many_messages_at_once_have_time(tmp_path: Path) -> None:
    text = "".join(
        f'BO_ {number} m{number}: 8 other\n SG_ s : 0|8@1+ (1,0) [0|255] "" ecu\n'
        for number in range(1, 121)
    )
    (tmp_path / "model.yaml").write_text(
        imported(database(tmp_path, text), None, Periods("100 ms")).text
    )
    assert len(checking.check(tmp_path / "model.yaml").system.frames) == 120


def test_the_parts_alone_are_for_another_model(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = database(tmp_path, PLAIN)
    call = ["import", str(path), "--node", "ecu", "--period", "50 ms"]
    assert main([*call, "--parts"]) == OK
    parts = yaml.safe_load(capsys.readouterr().out)
    assert main(call) == OK
    whole = yaml.safe_load(capsys.readouterr().out)
    assert set(parts) == {"types", "components", "messages"}
    assert parts["types"] == whole["types"]
    assert parts["messages"] == whole["messages"]
    assert set(whole) - set(parts) == {"system", "nodes", "buses", "instances", "processors"}
