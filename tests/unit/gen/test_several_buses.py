# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Systems with several buses: what travels on which, and what each program gets."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.building import checking, programs
from ravenchart.command_line import main
from ravenchart.failures import OK, Refused
from ravenchart.gen.derive.completion import programs as parts_of
from ravenchart.gen.model.buses import Message
from ravenchart.paths import ROOT

EXAMPLE = ROOT / "examples" / "two_buses" / "model.yaml"
COMMANDS = ROOT / "tests" / "nodes" / "commands"
LINE = "bit_rate: 500 kbit/s, driver_wcet: 40 us, receive_depth: 8, transmit_depth: 8"


def messages_of(text: str, folder: Path) -> dict[str, Message]:
    model = folder / "model.yaml"
    model.write_text(text, encoding="utf-8")
    system = checking.check(model, deadlines=False).system
    return {message.name: message for message in system.messages}


@pytest.fixture(scope="module")
def example() -> str:
    return EXAMPLE.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def commands() -> str:
    """The model whose calls, replies and reads travel, with a second bus."""
    text = (COMMANDS / "model.yaml").read_text(encoding="utf-8")
    text = text.replace("buses:\n", f"buses:\n  other: {{{LINE}}}\n")
    other = (
        "  by_other: {released_by: other, period: 1 ms, stack: 32 KiB, activities: [other.receive]}"
    )
    return text.replace("processors:\n", f"processors:\n{other}\n").replace(
        "time_limit: 60 ms}", "time_limit: 60 ms, bus: other}"
    )


def test_a_connection_travels_on_the_bus_that_it_names(example: str, tmp_path: Path) -> None:
    found = messages_of(example, tmp_path)
    assert found["watch_shown"].bus == "cabin"
    assert found["wheel_speed"].identifier == found["spare_speed"].identifier == 0x80


def test_one_port_on_two_buses_is_two_messages(example: str, tmp_path: Path) -> None:
    own, _, rest = example.partition("  wheel_speed: {")
    _, _, rest = rest.partition("to: watch.spare}\n")
    wired = own.replace(
        "connections:\n",
        "connections:\n"
        "  - {from: wheel.speed, to: watch.wheel, bus: chassis}\n"
        "  - {from: wheel.speed, to: watch.spare, bus: cabin}\n",
    )
    rest = rest.replace("wheel.measure, wheel_speed, ", "wheel.measure, ")
    rest = rest.replace("wheel.measure, spare_speed, ", "wheel.measure, ")
    found = messages_of(wired + rest, tmp_path)
    assert found["wheel_speed"].bus == "chassis"
    assert found["wheel_speed_cabin"].bus == "cabin"
    assert [str(end) for end in found["wheel_speed_cabin"].targets] == ["watch.spare"]


@pytest.mark.parametrize("swapped", [False, True])
def test_the_order_of_connections_decides_nothing(
    swapped: bool, example: str, tmp_path: Path
) -> None:
    """One of the two names its bus, the other one does not: it takes no message of the first."""
    own, _, rest = example.partition("  wheel_speed: {")
    _, _, rest = rest.partition("to: watch.spare}\n")
    lines = [
        "  - {from: wheel.speed, to: watch.wheel, bus: chassis}\n",
        "  - {from: wheel.speed, to: watch.spare}\n",
    ]
    lines = lines[::-1] if swapped else lines
    wired = own.replace("connections:\n", f"connections:\n{''.join(lines)}")
    rest = rest.replace("wheel.measure, wheel_speed, ", "wheel.measure, ")
    rest = rest.replace("wheel.measure, spare_speed, ", "wheel.measure, ")
    with pytest.raises(Refused, match=r"chassis or cabin may carry it .RV-0606"):
        messages_of(wired + rest, tmp_path)


def test_a_connection_takes_the_one_message_of_its_source(example: str, tmp_path: Path) -> None:
    text = example.replace(
        "from: watch.advice}", "from: watch.advice}\n  shown: {bus: cabin, from: watch.shown}"
    )
    found = messages_of(text.replace("to: dial.speed, bus: cabin}", "to: dial.speed}"), tmp_path)
    assert [str(end) for end in found["shown"].targets] == ["dial.speed"]


def test_a_bus_without_messages_agrees_with_the_checker(example: str, tmp_path: Path) -> None:
    model = tmp_path / "model.yaml"
    model.write_text(example.replace("buses:\n", f"buses:\n  idle: {{{LINE}}}\n"), encoding="utf-8")
    assert main(["generate", str(model)]) == OK
    assert main(["check-certificate", str(model)]) == OK


def test_calls_replies_and_reads_travel_on_the_bus_of_their_binding(
    commands: str, tmp_path: Path
) -> None:
    found = messages_of(commands, tmp_path)
    of = {name: message.bus for name, message in found.items()}
    assert set(of.values()) == {"other"}
    assert {"boss_1_Home", "boss_1_Home_Reply", "mover_1_Get_Place_other"} <= of.keys()


def test_a_wire_that_names_a_bus_stays_a_wire_on_one_node(example: str, tmp_path: Path) -> None:
    text = example.replace("node: dash", "node: gate")
    assert "watch_shown" not in messages_of(text, tmp_path)


def test_each_program_has_the_controllers_of_its_buses_alone() -> None:
    parts = {part.nodes[0].name: part for part in parts_of(checking.check(EXAMPLE).system)}
    buses = {node: [bus.name for bus in part.buses] for node, part in parts.items()}
    assert buses == {
        "axle": ["chassis", "cabin"], "gate": ["chassis", "cabin"], "dash": ["cabin"],
    }  # fmt: skip


def test_the_environment_tells_buses_apart_by_their_names() -> None:
    generated = EXAMPLE.parent / "generated" / "gate"
    for number, bus in enumerate(("chassis", "cabin"), 1):
        text = (generated / f"two_buses-{bus}.ads").read_text(encoding="utf-8")
        assert f'Bus_Number => {number},\n      Bus_Name => "{bus.upper()}"' in text


def test_controllers_of_one_bus_are_refused_on_two(monkeypatch: pytest.MonkeyPatch) -> None:
    checked = checking.check(EXAMPLE)
    assert programs.default_driver(checked) == "bus"
    with pytest.raises(Refused, match="ctucanfd has the controller of one bus, and axle is on ch"):
        programs.check_driver(checked, "ctucanfd")


def test_nine_buses_are_too_many(example: str, tmp_path: Path) -> None:
    more = "".join(f"  line_{n}: {{{LINE}}}\n" for n in range(1, 8))
    with pytest.raises(Refused, match=r"a system has at most 8 buses .RV-0209"):
        messages_of(example.replace("buses:\n", f"buses:\n{more}"), tmp_path)
