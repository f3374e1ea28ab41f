# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The record of the last proof speaks of the sources that are here."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from ravenchart.evidence import records
from ravenchart.paths import ROOT
from ravenchart.proof import ages
from tests import house
from tests.support.proof_records import stale_sources

PROGRAMS = {name: ROOT / "examples" / name for name in house.EXAMPLES}
NAMES = (
    *(f"runtime-{driver}" for driver in house.DRIVERS),
    house.FLOATS,
    house.VALUES,
    house.LOGICAL,
    house.GATHERED,
    house.EVENTS,
    house.INTERRUPTS,
    house.BUS,
    house.KERNEL,
    *(record for name, at in PROGRAMS.items() for record in house.record_names(name, at)),
)

LEDGER = ROOT / "proofs" / "assumptions.md"


OF_MODELS = tuple(f"{name}{end}" for name in house.MODELS for end in ("", "-*"))
"""Of programs that are not kept."""
RECORDS = sorted(house.RECORDS.glob("*/*.toml"))
KEPT = [path for path in RECORDS if not any(path.match(f"{name}.toml") for name in OF_MODELS)]


def _record(name: str) -> Path:
    path = records.of_target(name)
    assert path is not None, f"there is no record of {name}"
    return path


def test_a_name_that_no_target_has_is_refused() -> None:
    with pytest.raises(
        house.UnknownTargetError, match="no target is called feature-chart; there are "
    ):
        list(house.targets(["feature-chart"]))


@pytest.mark.parametrize("name", NAMES)
def test_every_target_has_a_record(name: str) -> None:
    assert _record(name) in RECORDS


@pytest.mark.parametrize("path", KEPT, ids=lambda p: f"{p.parent.name}-{p.stem}")
def test_every_proved_source_is_as_it_was_proved(path: Path) -> None:
    assert path.stem in NAMES
    assert path.parent.name in {age.name for age in ages.AGES}
    assert stale_sources(path) == ()


@pytest.mark.parametrize("path", RECORDS, ids=lambda p: f"{p.parent.name}-{p.stem}")
def test_nothing_is_unproved_justified_or_assumed(path: Path) -> None:
    found = tomllib.loads(path.read_text())
    assert found["checks"] > 0
    assert found["proved"] == found["checks"]
    assert (found["justified"], found["assumed"]) == (0, 0)
    provers = {"gnat-12": "CVC4", "gnat-14": "cvc5"}[path.parent.name]
    assert provers in found["tool"]


@pytest.mark.parametrize("name", house.MODELS)
def test_a_model_of_the_tests_gives_what_was_proved(name: str) -> None:
    found = [path for path in RECORDS if path.match(f"{name}.toml") or path.match(f"{name}-*.toml")]
    if not found:
        pytest.skip(f"it has no record: `make prove ONLY={name}` proves it")
    folder = house.made(name)
    names = house.record_names(name, folder)
    assert {path.stem for path in found} == set(names)
    for path in found:
        assert stale_sources(path) == ()
    _bodies_recorded(name, folder)


def test_every_source_of_an_example_is_in_its_record() -> None:
    assert sum(_bodies_recorded(name, folder) for name, folder in PROGRAMS.items()) >= 4


def _bodies_recorded(name: str, folder: Path) -> int:
    """All that is generated is recorded, and each body of the user whose spec is: their number."""
    texts = [tomllib.loads(_record(n).read_text()) for n in house.record_names(name, folder)]
    recorded = {source for record in texts for source in record["sources"]}
    made = [*(folder / "generated").rglob("*.ad[sb]")]
    specs = {path.stem for path in made if path.suffix == ".ads"}
    written = [p for p in (folder / "user").rglob("*.adb") if p.stem in specs]
    there = {str(path.relative_to(ROOT)) for path in (*made, *written)}
    assert there and there <= recorded, sorted(there - recorded)
    return len(written)


def _outside() -> dict[str, str]:
    """Unit to text, of the runtime and the HAL: what is wholly or partly outside SPARK."""
    found = {}
    for root in ("spark_runtime", "hw_can"):
        for path in (ROOT / root).rglob("*.ad[sb]"):
            text = path.read_text(encoding="utf-8")
            if "SPARK_Mode" not in text or "SPARK_Mode => Off" in text:
                found[path.stem.rpartition("-")[2]] = text
    return found


def test_the_ledger_names_every_unit_outside_spark() -> None:
    ledger = LEDGER.read_text(encoding="utf-8").lower()
    found = _outside()
    assert {"failures", "raw_sockets", "steps"} <= set(found)
    assert [unit for unit in found if unit not in ledger] == []


def test_the_ledger_names_every_unit_whose_contracts_are_never_executed() -> None:
    (entry,) = re.findall(r"^## ASM-009.*?(?=^## )", LEDGER.read_text(), re.S | re.M)
    found = {
        path.stem.removeprefix("ravenchart-").removeprefix("can-")
        for root in ("spark_runtime", "hw_can", "gen")
        for path in (ROOT / root).rglob("*.ad[sb]")
        if re.search(r"Assertion_Policy\s*\([^)]*Ignore", path.read_text(encoding="utf-8"))
    }
    assert found == {"rings", "policy_queues", "bus_queues", "networks"}
    assert [unit for unit in found if f"`{unit}`" not in entry.lower()] == []


def test_a_changed_source_is_noticed(tmp_path: Path) -> None:
    record = tmp_path / "record.toml"
    text = _record("three_components").read_text()
    name = next(iter(tomllib.loads(text)["sources"]))
    digest = tomllib.loads(text)["sources"][name]
    record.write_text(text.replace(digest, "0" * 64))
    assert stale_sources(record) == (name,)
