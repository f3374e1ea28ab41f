"""The pages under docs are what their tables say."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from gen.diagnostics import CODES
from gen.reference import TITLES, pages, schema

ROOT = Path(__file__).parent.parent.parent


@pytest.mark.parametrize("name", sorted(pages()))
def test_page_is_up_to_date(name: str) -> None:
    written = (ROOT / "docs" / name).read_text(encoding="utf-8")
    assert written == pages()[name], "run python -m gen.reference"


def test_every_key_has_a_description() -> None:
    made = schema()
    forms = {"ModelFile": made, **made["$defs"]}
    assert set(forms) == set(TITLES)
    for form in forms.values():
        for key, value in form["properties"].items():
            assert value.get("description"), key


def test_every_code_is_used() -> None:
    rooms = [ROOT / name for name in ("gen", "analysis", "behaviour", "ravenchart")]
    source = "".join(path.read_text() for room in rooms for path in room.rglob("*.py"))
    assert [code for code in CODES if source.count(code) < 2] == []


def test_schema_accepts_the_keys_of_the_examples() -> None:
    known = set(schema()["properties"])
    for path in (ROOT / "examples").glob("*/model.yaml"):
        assert set(yaml.safe_load(path.read_text())) <= known
