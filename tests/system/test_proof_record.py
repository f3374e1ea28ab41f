"""The record of the last proof speaks of the sources that are here."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from ravenchart import house, proving
from ravenchart.toolchain import ROOT

NAMES = (*(f"runtime-{d}" for d in house.DRIVERS), house.BUS, *house.EXAMPLES)


def _record(name: str) -> Path:
    return house.RECORDS / f"{name}.toml"


@pytest.mark.parametrize("name", NAMES)
def test_every_proved_source_is_as_it_was_proved(name: str) -> None:
    assert proving.stale_sources(_record(name)) == ()


@pytest.mark.parametrize("name", NAMES)
def test_nothing_is_unproved_justified_or_assumed(name: str) -> None:
    found = tomllib.loads(_record(name).read_text())
    assert found["checks"] > 0
    assert found["proved"] == found["checks"]
    assert (found["justified"], found["assumed"]) == (0, 0)


def test_every_generated_and_user_source_of_the_examples_is_in_its_record() -> None:
    for name in house.EXAMPLES:
        recorded = set(tomllib.loads(_record(name).read_text())["sources"])
        folder = ROOT / "examples" / name
        there = {str(p.relative_to(ROOT)) for p in folder.rglob("*.ad[sb]")}
        assert there <= recorded, sorted(there - recorded)


def test_a_changed_source_is_noticed(tmp_path: Path) -> None:
    record = tmp_path / "record.toml"
    text = _record("three_components").read_text()
    name = next(iter(tomllib.loads(text)["sources"]))
    digest = tomllib.loads(text)["sources"][name]
    record.write_text(text.replace(digest, "0" * 64))
    assert proving.stale_sources(record) == (name,)
