# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The pages under docs are what their tables say."""

from __future__ import annotations

from pathlib import Path

import jsonschema
import pytest
import yaml

from ravenchart.gen.diagnostics import CODES
from ravenchart.gen.files.located import grow
from ravenchart.gen.files.reference import TITLES, pages, schema
from ravenchart.gen.pipeline import load

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("name", sorted(pages()))
def test_page_is_up_to_date(name: str) -> None:
    written = (ROOT / "docs" / name).read_text(encoding="utf-8")
    assert written == pages()[name], "run `make docs`"


MODELS = sorted(
    path
    for pattern in (
        "examples/*/model.yaml",
        "tests/feature/*/model.yaml",
        "tests/nodes/*/model.yaml",
    )
    for path in ROOT.glob(pattern)
)


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.parent.name)
def test_an_editor_with_the_schema_takes_every_model_that_the_loader_takes(path: Path) -> None:
    tree, _ = grow(path.read_text(encoding="utf-8"), path.name)
    jsonschema.Draft202012Validator(schema()).validate(tree)


def test_every_key_has_a_description() -> None:
    made = schema()
    forms = {"ModelFile": made, **made["$defs"]}
    assert set(forms) == set(TITLES)
    for form in forms.values():
        for key, value in form["properties"].items():
            assert value.get("description"), key


def test_every_code_is_used() -> None:
    rooms = [ROOT / name for name in ("gen", "analysis", "behaviour", "hw_can", "ravenchart")]
    source = "".join(path.read_text() for room in rooms for path in room.rglob("*.py"))
    assert [code for code in CODES if source.count(code) < 2] == []


def test_schema_accepts_the_keys_of_the_examples() -> None:
    known = set(schema()["properties"])
    for path in (ROOT / "examples").glob("*/model.yaml"):
        assert set(yaml.safe_load(path.read_text())) <= known


def test_the_reference_says_of_nodes_and_connections_what_the_loader_takes() -> None:
    """Two nodes, and connections between them, are a model; so are several buses."""
    keys = schema()["properties"]
    loaded = load(ROOT / "examples" / "two_nodes" / "model.yaml")
    assert loaded.system is not None and len(loaded.system.nodes) == 2
    assert "one or several" in keys["nodes"]["description"]
    assert "between two" in keys["connections"]["description"]
    assert keys["buses"]["description"] == "The CAN buses, at most eight."
    for page in pages().values():
        assert "in this version" not in page


def test_the_page_of_drivers_says_what_the_loopback_driver_does() -> None:
    source = (
        ROOT / "hw_can" / "drivers" / "loopback" / "ravenchart-can-controllers-driver.adb"
    ).read_text()
    assert "which receives the frames that it sends" in " ".join(source.replace("--", " ").split())
    assert "Upper.Receive (F);" in source, "the part of every driver that has the acceptance filter"
    line = next(
        line
        for line in (ROOT / "docs" / "drivers.md").read_text().splitlines()
        if line.startswith("| `loopback` |")
    )
    assert "it receives what it sends, as far as its acceptance filter takes that" in line
