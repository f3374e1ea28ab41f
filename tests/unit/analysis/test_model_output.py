# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`analyse --json` and `--export` of models: everything, by the same way as plain files."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree as Xml

import pytest

from ravenchart.analysis.exchange.mast_text import parse
from ravenchart.analysis.system.timing import analyse
from ravenchart.command_line import main
from ravenchart.failures import OK
from ravenchart.gen.pipeline import load

EXAMPLES = Path(__file__).parents[3] / "examples"
MODELS = [EXAMPLES / name / "model.yaml" for name in ("cartesian_robot", "three_components")]


@pytest.mark.parametrize("model", MODELS, ids=lambda path: path.parent.name)
def test_json_of_a_model_says_what_the_analysis_found(
    model: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["analyse", str(model), "--json"]) == OK
    told = json.loads(capsys.readouterr().out)
    system = load(model).system
    assert system is not None
    found = analyse(system)
    assert (told["system"], told["unit"], told["met"]) == (system.name, "ns", True)
    for kind, key in (("task", "tasks"), ("message", "messages")):
        for entry in told[key]:
            assert entry["response"] == found.found.from_event(entry[kind])
            assert entry["slack"] == found.slack(entry[kind])
    assert {entry["task"] for entry in told["tasks"]} == set(found.tasks)
    assert {entry["message"] for entry in told["messages"]} == set(found.messages)
    assert {entry["activity"]: entry["response"] for entry in told["activities"]} == {
        row.row.name: row.bound for _, row in found.rows()
    }
    assert [entry["chain"] for entry in told["chains"]] == [c.name for c in system.chains]
    assert len(told["ways"]) == len(found.chains)
    assert {entry["message"] for entry in told["receptions"]} == set(found.deliveries)


@pytest.mark.parametrize("model", MODELS, ids=lambda path: path.parent.name)
def test_a_model_is_exported_for_each_tool(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    system = load(model).system
    assert system is not None
    texts = {}
    for tool in ("mast", "cheddar", "pycpa"):
        assert main(["analyse", str(model), "--export", tool]) == OK
        texts[tool] = capsys.readouterr().out
    for chain in system.chains:
        assert all(f"Left out: chain {chain.name}," in text for text in texts.values())
    servers = [o for o in parse(texts["mast"]) if o.kind == "Scheduling_Server"]
    mains = any("main" in item.users for item in system.objects)
    assert len(servers) == len(system.tasks) + len(system.messages) + mains
    tasks = Xml.fromstring(texts["cheddar"].split("\n", 1)[1]).iter("periodic_task")
    assert len(list(tasks)) == len(system.tasks) + len(system.messages)
    compile(texts["pycpa"], "script.py", "exec")
