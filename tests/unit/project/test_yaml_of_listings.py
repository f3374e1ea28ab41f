# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Every YAML listing of the docs is used by the tool, as part of a whole model or file.

A part of a model stands in a model of `tests/listings`, or is found in an example. Scenarios and
events are read against the model that their page is about.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from ravenchart.command_line import main
from ravenchart.paths import ROOT
from ravenchart.running import scenarios
from tests.support.far_end import system_of
from tests.support.listings import (
    MODELS,
    Filled,
    Listing,
    filled,
    joined,
    listings,
    one_of,
    tree_of,
)

PRINTED = pytest.CaptureFixture[str]
EXAMPLES = ROOT / "examples"
LISTINGS = tuple(one for one in listings() if one.language == "yaml")
WHOLE = [one for one in LISTINGS if one.text.startswith("system:")]
"""Whole models in one file."""
FILLED = [filled(path) for path in sorted(MODELS.glob("*.yaml"))]


def ids(one: Listing) -> str:
    """Names a test."""
    return f"{one.page}:{one.line}"


# --- Whole models --------------------------------------------------------------------


@pytest.mark.parametrize("model", WHOLE, ids=ids)
def test_a_whole_model_is_accepted(model: Listing, tmp_path: Path, capsys: PRINTED) -> None:
    assert len(WHOLE) == 8
    (tmp_path / "model.yaml").write_text(model.text, encoding="utf-8")
    assert main(["check", str(tmp_path / "model.yaml")]) == 0
    assert capsys.readouterr().err == ""


DEPLOYMENTS = {
    name[1]: one
    for one in LISTINGS
    if (name := re.match(r"# (\w+\.yaml)", one.text)) and one.page == "docs/deployments.md"
}
"""The files of a model with deployments, by their names."""


def test_the_model_with_deployments_is_the_one_that_other_tests_check() -> None:
    shown = {name: tree_of(one.text, name) for name, one in DEPLOYMENTS.items()}
    files = (ROOT / "tests" / "deployments" / "heater").glob("*.yaml")
    assert shown == {path.name: tree_of(path.read_text(), path.name) for path in files}


# --- Parts of models -----------------------------------------------------------------


@pytest.mark.parametrize("model", FILLED, ids=lambda one: one.name)
def test_a_model_with_listings_has_the_warnings_of_the_page_and_no_other(
    model: Filled, tmp_path: Path, capsys: PRINTED
) -> None:
    assert model.listings
    (tmp_path / "model.yaml").write_text(json.dumps(model.tree, indent=1), encoding="utf-8")
    assert main(["check", str(tmp_path / "model.yaml")]) == 0
    said = capsys.readouterr().err
    codes = re.findall(r"^\S+: warning: .* \[(RV-\d{4})\]$", said, re.M)
    assert set(codes) == model.warnings, said
    assert codes or said == ""


def test_a_value_that_the_model_has_already_is_refused() -> None:
    model = {"row": {"wcet": "1 ms", "reads": ["a"]}}
    whole = {"row": {"wcet": "1 ms", "reads": ["a", "b"], "body": "user"}}
    assert joined(model, {"row": {"reads": ["b"], "body": "user"}}) == whole
    with pytest.raises(AssertionError):
        joined(model, {"row": {"wcet": "1 ms"}})


OF_EXAMPLES = {
    **{one: ROOT / Path(one.page).parent for one in LISTINGS if one.page.startswith("examples/")},
    one_of("docs/devices.md", "time_limit: 60 ms"): ROOT / "tests" / "nodes" / "commands",
    one_of("docs/devices.md", "time_limit: 100 ms"): ROOT / "tests" / "nodes" / "forwarded",
    one_of("docs/libraries.md", "library: Blocks"): ROOT
    / "tests"
    / "feature"
    / "library"
    / "blocks",
    one_of("docs/libraries.md", "smoother:"): ROOT / "tests" / "feature" / "library",
    one_of("docs/arrays.md", "time_limit: 40 ms"): ROOT / "tests" / "feature" / "gathered",
}
"""Parts that stand in a model of the repository, which other tests check."""


@pytest.mark.parametrize(("part", "folder"), OF_EXAMPLES.items(), ids=map(ids, OF_EXAMPLES))
def test_a_part_of_an_example_stands_there(part: Listing, folder: Path) -> None:
    wanted = tree_of(part.text, part.page)
    trees = [tree_of(path.read_text(), path.name) for path in sorted(folder.rglob("*.yaml"))]
    assert any(has(node, wanted) for tree in trees for node in mappings(tree))


def mappings(node: Any) -> Iterator[Any]:
    """All mappings of a tree."""
    inside = node.values() if isinstance(node, dict) else node if isinstance(node, list) else ()
    for one in inside:
        yield from mappings(one)
    if isinstance(node, dict):
        yield node


def has(whole: Any, part: Any) -> bool:
    """Whether a tree has all that a part of it has."""
    if isinstance(whole, dict) and isinstance(part, dict):
        return all(key in whole and has(whole[key], value) for key, value in part.items())
    if isinstance(whole, list) and isinstance(part, list):
        return all(any(has(one, value) for one in whole) for value in part)
    return bool(whole == part)


def test_what_an_example_has_otherwise_is_noticed() -> None:
    whole = {"a": {"b": [{"c": 1, "d": 2}], "e": 3}}
    assert has(whole, {"a": {"b": [{"d": 2}]}})
    assert not has(whole, {"a": {"b": [{"d": 3}]}})
    assert not has(whole, {"a": {"f": 3}})


DATABASE = """\
VERSION ""
BU_: ecu other
BO_ 1 end: 2 other
 SG_ Level : 0|8@1+ (1,0) [0|255] "" ecu
 SG_ level : 8|8@1+ (1,0) [0|255] "" ecu
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 10000;
BA_DEF_DEF_ "GenMsgCycleTime" 0;
BA_ "GenMsgCycleTime" BO_ 1 50;
"""
IMPORTED = one_of("docs/databases.md", "end_2:")


def test_import_prints_the_message_of_its_page_in_a_model_that_is_accepted(
    tmp_path: Path, capsys: PRINTED
) -> None:
    (tmp_path / "line.dbc").write_text(DATABASE)
    assert main(["import", str(tmp_path / "line.dbc"), "--node", "ecu"]) == 0
    printed = capsys.readouterr().out
    assert has(tree_of(printed, "printed")["messages"], tree_of(IMPORTED.text, IMPORTED.page))
    (tmp_path / "model.yaml").write_text(printed)
    assert main(["check", str(tmp_path / "model.yaml")]) == 0
    assert capsys.readouterr().err == ""


# --- Scenarios and events ------------------------------------------------------------


def model_of(name: str, tmp_path: Path) -> Path:
    """A model of an example, of `tests/listings` or of the page about plants."""
    if (EXAMPLES / name / "model.yaml").is_file():
        return EXAMPLES / name / "model.yaml"
    if name == "plants":
        (tmp_path / "model.yaml").write_text(one_of("docs/plants.md", "system:").text)
        (tmp_path / "oven.py").write_text(one_of("docs/plants.md", "class Oven", "python").text)
    else:
        (tree,) = [one.tree for one in FILLED if one.name == name]
        (tmp_path / "model.yaml").write_text(json.dumps(tree))
    return tmp_path / "model.yaml"


SCENARIOS = {
    one_of("docs/plants.md", "expect_output: oven.temperature"): "plants",
    one_of("docs/scenarios.md", "scenario: The x axis homes"): "cartesian_robot",
    one_of("docs/scenarios.md", "wrong: corruption"): "protection",
    one_of("docs/scenarios.md", "scenario: The bus is cut"): "two_nodes",
    one_of("docs/scenarios.md", "{lost: panel.link.lost_out"): "two_nodes",
}
"""Scenarios and parts of some, each with its model."""


@pytest.mark.parametrize(("plan", "model"), SCENARIOS.items(), ids=map(ids, SCENARIOS))
def test_a_scenario_fits_its_model(plan: Listing, model: str, tmp_path: Path) -> None:
    least = {"scenario": "A part", "steps": [{"wait": "1 s"}]}
    whole = {**least, **tree_of(plan.text, plan.page)}
    (tmp_path / "scenario.yaml").write_text(json.dumps(whole))
    system = system_of(model_of(model, tmp_path))
    assert scenarios.checked(tmp_path / "scenario.yaml", system).steps


EVENTS = {
    one_of("docs/scenarios.md", "raise: bed.Sensor_Lost"): ("pump",),
    one_of("docs/scenarios.md", "put: supervisor.report"): ("two_nodes", "--alone", "supervisor"),
}
"""Files of events, each with its model and the options of `simulate`."""


@pytest.mark.parametrize(("events", "call"), EVENTS.items(), ids=map(ids, EVENTS))
def test_events_are_played(
    events: Listing, call: tuple[str, ...], tmp_path: Path, capsys: PRINTED
) -> None:
    model, *options = call
    (tmp_path / "events.yaml").write_text(events.text)
    words = [str(EXAMPLES / model / "model.yaml"), "--events", str(tmp_path / "events.yaml")]
    assert main(["simulate", *words, "--interpreter", *options]) == 0
    assert len(capsys.readouterr().out.splitlines()) > 1


# --- All of them ---------------------------------------------------------------------


def test_each_listing_is_used_by_one_test() -> None:
    """A new part of a model needs a place in a model of `tests/listings`."""
    placed = [one for model in FILLED for one in model.listings]
    files = [*WHOLE, *DEPLOYMENTS.values(), *SCENARIOS, *EVENTS]
    used = Counter([*files, *placed, *OF_EXAMPLES, IMPORTED])
    assert [ids(one) for one in LISTINGS if used[one] != 1] == []
