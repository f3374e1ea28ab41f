# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One mistake is told once: what follows from it is not reported beside it."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest

from ravenchart.analysis.findings.deadlines import each_finding, findings
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.files import spans
from ravenchart.gen.files.load import Reader, read_file
from ravenchart.gen.files.spans import YamlMapping, YamlNode, YamlScalar
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT

CANOPEN = ROOT / "examples" / "canopen_device" / "model.yaml"
SURGICAL = ROOT / "examples" / "surgical_robot" / "model.yaml"
ARRAYS = ROOT / "tests" / "feature" / "arrays" / "model.yaml"
NODES = ROOT / "examples" / "two_nodes" / "model.yaml"
COMPOSITES = ROOT / "tests" / "feature" / "composites" / "model.yaml"
GRIPPER = ROOT / "tests" / "nodes" / "gripper" / "model.yaml"
REGISTERS = ROOT / "tests" / "feature" / "registers" / "model.yaml"


def keys(node: YamlNode) -> Iterator[YamlScalar]:
    """All keys of a file."""
    if isinstance(node, YamlMapping):
        for key, value in node.entries:
            yield key
            yield from keys(value)
    elif not isinstance(node, YamlScalar):
        for item in node.items:
            yield from keys(item)


def scalars(node: YamlNode) -> Iterator[YamlScalar]:
    """All values of a file."""
    if isinstance(node, YamlScalar):
        yield node
    elif isinstance(node, YamlMapping):
        for _, value in node.entries:
            yield from scalars(value)
    else:
        for item in node.items:
            yield from scalars(item)


def changed(model: Path, text: str) -> Reader:
    """Reads a model whose main file has that text."""

    def read(path: Path, limit: int) -> bytes:
        return text.encode() if path == model else read_file(path, limit)

    return read


def errors(model: Path, text: str) -> list[str]:
    """The codes of the errors in a model whose main file has that text."""
    found = load(model, changed(model, text)).diagnostics
    return [one.code for one in found if one.is_error]


def misspelt(model: Path) -> Iterator[str]:
    """The text of a model with the last letter of one key twice."""
    text = model.read_text()
    root = spans.spans(text)
    assert root is not None
    for key in keys(root):
        yield text[: key.end] + text[key.end - 1] + text[key.end :]


ROBOT = ROOT / "examples" / "cartesian_robot" / "model.yaml"
LEFT_OUT = re.compile(r"(\d+) errors? that depends? on this (is|are) left out")


def late(
    text: str, judged: Callable[[Analysis], Sequence[Diagnostic]] = findings
) -> list[Diagnostic]:
    """The errors of time in the robot with that model."""
    system = load(ROBOT, changed(ROBOT, text)).system
    assert system is not None
    return list(judged(analyse(system)))


def left_out(found: list[Diagnostic]) -> int:
    """How many errors they stand for besides themselves."""
    notes = [text for one in found for _, text in one.notes]
    return sum(int(match[1]) for text in notes if (match := LEFT_OUT.match(text)))


def test_a_wrong_bit_rate_is_one_error() -> None:
    (one,) = found = late(ROBOT.read_text().replace("500 kbit/s", "50 kbit/s"))
    assert (one.code, one.message) == ("RV-0903", "robot_bus may be loaded to 204 %")
    assert left_out(found) == 28  # 12 tasks, 7 messages, the reception, 4 chains twice


def test_a_late_message_is_named_and_the_driver_and_chains_behind_it_are_counted() -> None:
    found = late(ROBOT.read_text().replace("500 kbit/s", "125 kbit/s"), each_finding)
    assert {one.code for one in found} == {"RV-0901"}
    assert all(one.message.startswith("message ") for one in found) and len(found) == 6
    assert left_out(found) == 11  # 3 tasks of the driver, 4 chains twice


def test_a_full_core_is_one_error_and_the_first_task_without_time_is_named() -> None:
    (one,) = found = late(ROBOT.read_text().replace("driver_wcet: 40 us", "driver_wcet: 2 ms"))
    assert one.message == (
        "robot_bus.driver_rx.robot_command has no response-time bound: it and the tasks that "
        "preempt it need 197 % of the core, more than all of it"
    )
    assert left_out(found) > 20


@pytest.mark.slow
def test_a_value_of_another_place_is_never_an_internal_error() -> None:
    choice = random.Random(7)
    for model in (*ROOT.glob("tests/feature/*/model.yaml"), *ROOT.glob("examples/*/model.yaml")):
        text = model.read_text()
        root = spans.spans(text)
        assert root is not None
        values = list(scalars(root))
        for value in choice.sample(values, min(10, len(values))):
            other = choice.choice(values)
            new = choice.choice(['""', "0", text[other.start : other.end]])
            loaded = load(model, changed(model, text[: value.start] + new + text[value.end :]))
            if loaded.system is not None:
                analyse(loaded.system)


@pytest.mark.slow
@pytest.mark.parametrize(
    "model", [CANOPEN, SURGICAL, ARRAYS, COMPOSITES], ids=lambda path: path.parent.name
)
def test_a_misspelt_key_is_the_only_error(model: Path) -> None:
    found = [codes for text in misspelt(model) if "RV-0201" in (codes := errors(model, text))]
    assert len(found) >= 10
    assert found == [["RV-0201"]] * len(found)


@pytest.mark.parametrize(
    ("model", "old", "new"),
    [
        (NODES, "bit_rate:", "bit_ratee:"),
        (
            COMPOSITES,
            "        served_by: serve\n        commands:",
            "        served_by: serve\n        commandss:",
        ),
        (
            COMPOSITES,
            "  Arm:\n    parameters:\n      reach: {type: A",
            "  Arm:\n    parameters:\n      reach: {type: B",
        ),
        (REGISTERS, "      Control:\n        period: 10 ms", '      Control:\n        period: ""'),
        (REGISTERS, "nodes:\n", "nodess:\n"),
        (REGISTERS, "devices:\n", "devicess:\n"),
        (REGISTERS, "    provides: {Get_Position", "    providess: {Get_Position"),
        (REGISTERS, "Left: {type: Drive", "Left: {typee: Drive"),
        (REGISTERS, "array: [Left, Right]", "array: [Left, []]"),
    ],
)
def test_what_is_lost_brings_no_other_error(model: Path, old: str, new: str) -> None:
    text = model.read_text()
    assert text.count(old) == 1
    assert len(errors(model, text.replace(old, new))) == 1


def test_a_reception_beside_other_rows_is_the_only_error() -> None:
    text = GRIPPER.read_text()
    assert text.count("boss_1.ports") == 1
    assert errors(GRIPPER, text.replace("boss_1.ports", "link.receive")) == ["RV-0705"]


@pytest.mark.parametrize("section", ["components", "nodes", "instances", "processors"])
def test_a_section_that_is_missing_is_the_only_error(section: str) -> None:
    for model in (NODES, COMPOSITES, GRIPPER, REGISTERS):
        text = model.read_text()
        root = spans.spans(text)
        assert root is not None
        found = root.entry(section)
        if found is not None:  # two_nodes includes its components
            key, value = found
            assert errors(model, text[: key.start] + text[value.end :]) == ["RV-0801"], model
