"""One mistake is told once: what follows from it is not reported beside it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from ravenchart.gen.files import spans
from ravenchart.gen.files.load import read_file
from ravenchart.gen.files.spans import YamlMapping, YamlNode, YamlScalar
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT

CANOPEN = ROOT / "examples" / "canopen_device" / "model.yaml"
SURGICAL = ROOT / "examples" / "surgical_robot" / "model.yaml"
NODES = ROOT / "examples" / "two_nodes" / "model.yaml"
COMPOSITES = ROOT / "tests" / "feature" / "composites" / "model.yaml"
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


def errors(model: Path, text: str) -> list[str]:
    """The codes of the errors in a model whose main file has that text."""

    def read(path: Path, limit: int) -> bytes:
        return text.encode() if path == model else read_file(path, limit)

    return [one.code for one in load(model, read).diagnostics if one.is_error]


def misspelt(model: Path) -> Iterator[str]:
    """The text of a model with the last letter of one key twice."""
    text = model.read_text()
    root = spans.spans(text)
    assert root is not None
    for key in keys(root):
        yield text[: key.end] + text[key.end - 1] + text[key.end :]


@pytest.mark.slow
@pytest.mark.parametrize("model", [CANOPEN, SURGICAL], ids=lambda path: path.parent.name)
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
