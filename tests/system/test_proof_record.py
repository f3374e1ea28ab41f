"""The record of the last proof speaks of the sources that are here."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from ravenchart import house, proving
from ravenchart.toolchain import ROOT

NAMES = (
    *(f"runtime-{driver}" for driver in house.DRIVERS),
    house.BUS,
    house.KERNEL,
    *(name for example in house.EXAMPLES for name in house.record_names(example)),
)


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
        records = [tomllib.loads(_record(n).read_text()) for n in house.record_names(name)]
        recorded = {source for record in records for source in record["sources"]}
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
