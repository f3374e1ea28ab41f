# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Activities that forward: a device behind a task, so that several nodes call it."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.depths import depths
from ravenchart.analysis.system.timing import analyse
from ravenchart.building import checking, generation
from ravenchart.gen.derive.alone import hindrance
from ravenchart.gen.diagnostics import render
from ravenchart.gen.emit.program import generate
from ravenchart.gen.language.terms import named
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.independent.check import checked
from ravenchart.paths import ROOT

FOLDER = ROOT / "tests" / "nodes" / "forwarded"
MODEL = (FOLDER / "model.yaml").read_text(encoding="utf-8")
SERVE = "serve: {period: 5 ms, wcet: 40 us, body: forward}"
BOUND = "{from: axis_1.Drive, to: Axis}"
"""The binding of the task to its device."""


def _loaded(*replacements: tuple[str, str]) -> Loaded:
    text = MODEL
    for old, new in replacements:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return load(Path("model.yaml"), lambda path, limit: text.encode())


def _system(*replacements: tuple[str, str]) -> System:
    found = _loaded(*replacements)
    assert found.system is not None, _said(found)
    return found.system


def _said(found: Loaded) -> str:
    return "\n".join(render(one, found.sources) for one in found.diagnostics)


def _on_one_node() -> str:
    """The model without a bus: all on the node of the device."""
    kept = [
        line
        for line in MODEL.splitlines(keepends=True)
        if not line.startswith(("buses:", "  line:", "  panel:", "  reception_"))
    ]
    return "".join(kept).replace("node: panel", "node: cabinet").replace(", time_limit: 100 ms", "")


def test_the_calls_of_a_forwarding_row_are_those_of_its_interface() -> None:
    component = named(_system().components, "Axis_Task")
    serve = named(component.activities, "serve")
    assert serve.sends == ("Set_Goal", "Release", "Reset", "Get_Limit")
    assert (serve.forwards, serve.by_user, serve.flow) == (True, False, None)


def test_each_request_is_one_call_and_a_reply_goes_to_whoever_asked() -> None:
    system = _system()
    files = generate(system, claims_of(analyse(system)))
    body = files["cabinet/forwarded_feature-axis_1.adb"]
    asked = body.partition("procedure Run_Serve")[2].partition("end Run_Serve")[0]
    assert "Call_Set_Goal (Asked.Set_Goal);" in asked
    assert "Axis.Get_Limit (Asked.Get_Limit, Get_Limit_Reply);" in asked
    assert asked.index("Axis.Reset (Reset_Reply);") < asked.index("Line.Send_Boss_1_Reset_Reply")
    #  nothing is written by hand, and no procedure stands there that nobody calls
    assert not any("axis_task-activities" in name for name in files)
    assert "procedure Call_Reset" not in body


def test_the_times_of_the_device_count_once_a_request_in_the_analysis_and_the_checker(
    tmp_path: Path,
) -> None:
    path = tmp_path / "model.yaml"
    path.write_text(_on_one_node(), encoding="utf-8")
    found = checking.check(path)
    wcets = {row.name: row.wcet for task in found.analysis.network.tasks for row in task.rows}
    assert wcets["axis_1.serve"] == 40_000 + 4 * (6_000 + 2_000 + 4_000 + 5_000)
    generation.write_program(found)
    assert checked(path).disagreements == []


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (
            "Drive: {commands: [Set_Goal, Release, Reset, Get_Limit, Get_Place]}\n    provides",
            "Drive: {commands: [Set_Goal, Release, Reset, Get_Place]}\n    provides",
            "serve forwards Get_Limit of Motion, but Axis_Task requires no Get_Limit",
        ),
        ("        served_by: serve\n", "        served_by: look\n", "look cannot serve Motion"),
        (
            SERVE,
            SERVE.replace("body", "calls: [Set_Goal], body"),
            "serve forwards requests, so `calls` has no meaning",
        ),
        (
            SERVE,
            SERVE.replace("body", "deadline: 4 ms, raises: [], body"),
            "serve forwards requests, so `raises` has no meaning",
        ),
        (
            "    activities:\n      serve",
            "    activities:\n      spare: {period: 5 ms, wcet: 1 us, body: forward}\n      serve",
            "spare forwards requests, but serves no interface",
        ),
        (SERVE, SERVE.replace("forward", "forwards"), "`body` must be `user` or `forward`"),
        (BOUND, "{from: axis_1.Drive, to: other.Motion}", "whose reply does not come at once"),
        (
            "  - {from: axis_1.Drive, to: Axis}\n",
            "  - {from: axis_1.Drive, to: Axis}\n  - {from: boss_2.Motion, to: Axis}\n",
            "forward the calls of others (`body: forward`)",
        ),
    ],
)
def test_what_is_wrong_has_its_place_and_a_hint(old: str, new: str, told: str) -> None:
    more = (("  guardian_1: {component", f"{OTHERS}  guardian_1: {{component"),)
    rows = (("  guarding: {stack", f"{ROWS}  guarding: {{stack"),)
    wanted = "other.Motion" in new or "boss_2" in new
    said = _said(_loaded((old, new), *((*more, *rows) if wanted else ())))
    assert told in said
    assert "error:" in said
    assert "hint:" in said or new.endswith("forwards}")


OTHERS = (
    "  other: {component: Axis_Task, node: cabinet}\n  boss_2: {component: Boss, node: panel}\n"
)
ROWS = "  more: {stack: 32 KiB, activities: [boss_2.Plan]}\n"


def test_an_interface_of_other_axes_is_refused() -> None:
    said = _said(
        _loaded(
            ("  Set_Goal: {kind: write, argument: Place}", SET_GOAL),
            (
                "      Motion:\n        queue: 4\n",
                "      Motion:\n        axes: 2\n        queue: 4\n",
            ),
        )
    )
    assert (
        "serve forwards Set_Goal of Motion, which has 2 axes, to Drive, which has one axis" in said
    )


SET_GOAL = "  Set_Goal: {kind: write, argument: Place, per_axis: true}"


def test_a_forwarding_component_does_not_run_alone() -> None:
    component = named(_system().components, "Axis_Task")
    assert hindrance(component) == "serve forwards the requests of Motion"


def test_receptions_of_one_bus_may_be_written_for_each_node() -> None:
    """Their rows have names of their own, as those of one processor on several nodes have."""
    rows = {p.name: p.slots[0].element for p in _system().processors if p.released_by}
    assert rows == {
        "reception_panel": "line.receive_panel",
        "reception_cabinet": "line.receive_cabinet",
    }
    shared = _system(
        (
            "  reception_panel: {released_by: line, node: panel, period: 2 ms, stack: 32 KiB, "
            "activities: [line.receive]}\n",
            "",
        ),
        ("reception_cabinet: {released_by: line, node: cabinet,", "reception: {released_by: line,"),
    )
    assert {p.name: p.slots[0].element for p in shared.processors if p.released_by} == rows


RELAYS = """\
system: Relayed
types: {Rate: {range: [0, 100]}}
commands:
  Stop: {kind: void}
  Give: {kind: write, argument: Rate}
components:
  Relay:
    requires:
      Next: {commands: [Stop, Give]}
    provides:
      Own: {queue: 2, served_by: serve, commands: [Stop, Give]}
    activities:
      serve: {period: 10 ms, wcet: 10 us, body: forward}
  Sink:
    provides:
      Own: {queue: 3, served_by: serve, commands: [Stop, Give]}
    activities:
      serve: {period: 20 ms, wcet: 10 us, body: user}
nodes: {board: {context_switch: 5 us, critical_section: 2 us}}
instances:
  relay_1: {component: Relay, node: board}
  sink_1: {component: Sink, node: board}
bindings: [{from: relay_1.Next, to: sink_1.Own}]
processors:
  one: {stack: 16 KiB, activities: [relay_1.serve, sink_1.serve]}
"""


def test_a_forwarded_request_is_one_call_of_whichever_command() -> None:
    """Six wait at most, two of each of three executions: two commands do not make them twelve."""
    system = load(Path("model.yaml"), lambda path, limit: RELAYS.encode()).system
    assert system is not None
    found = {one.what: one.needed for one in depths(analyse(system))}
    assert found == {"requests may wait in sink_1.Own": 6}


def test_a_lost_interface_is_one_error() -> None:
    text = RELAYS.replace("      Own: {queue: 2", "      Out: {queue: 2")
    said = _said(load(Path("model.yaml"), lambda path, limit: text.encode()))
    assert said.count("error:") == 1, said
