# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The JSON Schemas of scenarios and event files: every file here fits, and a mistake does not."""

from __future__ import annotations

import json
import re

import pytest

from ravenchart.gen.files.located import grow, grow_list
from ravenchart.paths import ROOT

jsonschema = pytest.importorskip("jsonschema", reason="`make setup` installs jsonschema")

PAGE = (ROOT / "docs" / "scenarios.md").read_text(encoding="utf-8")
FILES = sorted(
    path
    for home in ("examples", "tests")
    for path in (ROOT / home).rglob("*.yaml")
    if "generated" not in path.parts
)
TEXTS = {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in FILES}
SCENARIOS = {name: text for name, text in TEXTS.items() if re.search(r"^scenario:", text, re.M)}
EVENTS = {name: text for name, text in TEXTS.items() if re.search(r"^- \{until:", text, re.M)}
for number, text in enumerate(re.findall(r"```yaml\n(.*?)```", PAGE, re.S)):
    if text.startswith("scenario:"):
        SCENARIOS[f"page {number}"] = text
    elif "until:" in text:
        EVENTS[f"page {number}"] = text


def errors(name: str, text: str) -> list[str]:
    """What the schema says of a file."""
    schema = json.loads((ROOT / "docs" / f"{name}.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    tree, found = (grow_list if name == "events" else grow)(text, "file.yaml")
    assert tree is not None and found == []
    plain = json.loads(json.dumps(tree))
    return [str(one.message) for one in jsonschema.Draft202012Validator(schema).iter_errors(plain)]


@pytest.mark.parametrize("name", SCENARIOS)
def test_a_scenario_fits_its_schema(name: str) -> None:
    assert errors("scenario", SCENARIOS[name]) == []


@pytest.mark.parametrize("name", EVENTS)
def test_an_event_file_fits_its_schema(name: str) -> None:
    assert errors("events", EVENTS[name]) == []


def test_there_are_files_of_both_kinds() -> None:
    assert len(SCENARIOS) >= 10 and len(EVENTS) >= 4


ONE = "scenario: S\nsteps:\n  - {wait_for: a.x, is: 1, within: 1 s}\n"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("scenario: S\n", ""),
        ("scenario: S\n", "scenario: S\nstep: []\n"),
        ("1 s", "1 h"),
        ("1 s", "1"),
        ("a.x", "x"),
        (", within: 1 s", ""),
        ("is: 1", "is: 1, at: 2 s"),
        ("wait_for", "waits_for"),
        ("steps:", "bus: [{at: 1 s, hold: both}]\nsteps:"),
        ("steps:", "expect: [{fault: Unknown, times: 1, because: x}]\nsteps:"),
    ],
)
def test_a_mistake_in_a_scenario_does_not_fit(old: str, new: str) -> None:
    assert errors("scenario", ONE) == [] and old in ONE
    assert errors("scenario", ONE.replace(old, new))


@pytest.mark.parametrize(
    "line",
    [
        "{at: 1 h, raise: a.b}",
        "{raise: a.b}",
        "{at: 1 s, raise: b}",
        "{at: 1 s, put: a.b}",
        "{at: 1 s, put: a.b, with: 1}",
        "{until: 1}",
    ],
)
def test_a_mistake_in_an_event_file_does_not_fit(line: str) -> None:
    assert errors("events", "- {at: 0, raise: a.b, with: 1}\n- {until: 1 s}\n") == []
    assert errors("events", f"- {line}\n")
