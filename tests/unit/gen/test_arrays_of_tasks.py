# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One interface bound to an array: a binding for each element, gathered replies, and limits."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.system.commands import command_times
from ravenchart.analysis.system.timing import analyse
from ravenchart.gen.derive.calls import element_bindings, gathers
from ravenchart.gen.derive.completion import on_one_node
from ravenchart.gen.diagnostics import render
from ravenchart.gen.draw.devices import DeviceLink, device_links
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.commands import Binding, Device, Gathered, Remote, RemoteRead, Server
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.paths import ROOT

pytestmark = pytest.mark.clock

TEXT = (ROOT / "tests" / "feature" / "gathered" / "model.yaml").read_text(encoding="utf-8")
APART = (ROOT / "tests" / "nodes" / "axes" / "model.yaml").read_text(encoding="utf-8")
STARRED = "{from: arm_1.Joints, to: joint_*.Motion, time_limit: 40 ms}"
MS = 1_000_000


def _loaded(text: str, *replacements: tuple[str, str]) -> Loaded:
    for old, new in replacements:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return load(Path("model.yaml"), lambda path, limit: text.encode())


def _said(found: Loaded) -> str:
    return "\n".join(render(one, found.sources) for one in found.diagnostics)


def _system(text: str, *replacements: tuple[str, str]) -> System:
    found = _loaded(text, *replacements)
    assert found.system is not None and not found.diagnostics, _said(found)
    return found.system


def _files(text: str, *replacements: tuple[str, str]) -> dict[str, str]:
    """The program, without the numbers that differ between two texts of one model."""
    system = _system(text, *replacements)
    files = generate(system, claims_of(analyse(system)))
    return {
        name: re.sub(r"[0-9a-f]{64}|yaml:\d+", "", made)
        for name, made in files.items()
        if name.endswith(("adb", "ads"))
    }


def _parts(system: System, command: str) -> tuple[Binding, ...]:
    binding = system.bound["arm_1", command]
    assert isinstance(binding.provider, Gathered)
    return element_bindings(system, binding)


# --- Bindings ------------------------------------------------------------------------


def test_an_array_has_a_binding_for_each_element() -> None:
    parts = _parts(_system(TEXT), "Move")
    assert [part.need.name for part in parts] == ["Move_1", "Move_2", "Move_3"]
    assert all(isinstance(part.provider, Server) for part in parts)
    owners = [part.provider.instance for part in parts if isinstance(part.provider, Server)]
    assert owners == ["joint_1", "joint_2", "joint_3"]
    assert {part.need.argument.name for part in parts if part.need.argument} == {"Place"}


def test_devices_of_several_kinds_are_called_one_by_one() -> None:
    system = _system(TEXT)
    names = [p.provider.name for p in _parts(system, "Close") if isinstance(p.provider, Device)]
    assert names == ["clamp_1", "clamp_2", "vice_1"]
    plan = next(slot for slot in system.slots_of("arm_1") if slot.name == "Plan")
    assert plan.timing.wcet == 200_000 + (4 + 4 + 3 + 2 + 2 + 2) * 1_000


def test_a_star_a_list_and_a_device_mean_the_same_array() -> None:
    listed = STARRED.replace("joint_*.Motion", "[joint_1.Motion, joint_2.Motion, joint_3.Motion]")
    named = STARRED.replace("joint_*.Motion", "All_Joints")
    device = "  Clamps: {array: [clamp_*, vice_1]}\n"
    starred = _files(TEXT)
    assert _files(TEXT, (STARRED, listed)) == starred
    declared = f"{device}  All_Joints: {{array: [joint_*.Motion]}}\n"
    assert _files(TEXT, (STARRED, named), (device, declared)) == starred


def test_elements_may_have_several_axes() -> None:
    wide = (
        (
            "axes: 3\n        commands:\n          Close",
            "axes: 4\n        commands:\n          Close",
        ),
    )
    clamp = ("  Clamp:\n    body", "  Clamp:\n    axes: 2\n    body")
    vice = ("  Vice:\n    body", "  Vice:\n    axes: 2\n    body")
    less = ("[clamp_*, vice_1]", "[clamp_1, vice_1]")
    argument = ("axis_2: 20, axis_3: 30", "axis_2: 20, axis_3: 30, axis_4: 40")
    files = _files(TEXT, *wide, clamp, vice, less, argument)
    body = files["gathered_feature-arm_1.adb"]
    assert "Call_Close_2 ((Axis_1 => Item.Axis_3, Axis_2 => Item.Axis_4));" in body
    assert "Axis_3 => Parts (2).Axis_1" in body and "Axis_4 => Part_2.Axis_2" in body


def test_an_optional_command_that_an_element_lacks_has_its_fallback() -> None:
    lacking = ("commands: [Home, Move, Limit]", "commands: [Home, Move]")
    found = _loaded(TEXT, lacking)
    assert "joint_1.Motion, joint_2.Motion, joint_3.Motion] does not provide Limit" in _said(found)
    system = _system(TEXT, lacking, ("          Limit: {}\n", "          Limit: {else: nothing}\n"))
    assert system.bound["arm_1", "Limit"].provider is None


# --- Replies -------------------------------------------------------------------------


def test_replies_are_gathered_where_the_client_waits_for_them() -> None:
    system = _system(TEXT)
    waits = {name: gathers(system, system.bound["arm_1", name]) for name in ("Home", "Move")}
    assert waits == {"Home": True, "Move": False}
    assert system.has_object("arm_1.Home.gathering")
    ceiling = system.object("arm_1.Home.gathering").ceiling
    servers = ("driving", "apart", "planning")
    assert ceiling == max(task.priority for task in system.tasks if task.element in servers)
    nobody = TEXT.replace("Home: {on_reply: Homed, on_full: Busy}", "Home: {on_full: Busy}")
    found = load(Path("model.yaml"), lambda path, limit: nobody.encode()).system
    assert found is None or not found.has_object("arm_1.Home.gathering")


def test_the_program_ends_a_call_with_its_last_element() -> None:
    body = _files(APART)["panel/distributed_axes-arm_1.adb"]
    for text in (
        "Conclude_Home (1, Ravenchart.Answers.Replied, Reply);",
        "Conclude_Home (2, Ravenchart.Answers.Timed_Out,",
        "Conclude_Home (3, Ravenchart.Answers.Refused,",
        "Home_Gathering.Start (Is_Refused);",
    ):
        assert text in body
    #  the fault tells which element is late
    assert body.count("Elements.Arm_1_Home_2);") == 1


# --- Limits --------------------------------------------------------------------------


def test_a_limit_holds_for_each_element_on_the_node_of_the_client() -> None:
    analysis = analyse(_system(TEXT))
    bounds = {chain.name: found.reaction for chain, found in analysis.limited}
    times = [one for one in command_times(analysis) if one.command == "Home"]
    assert [one.provider for one in times] == ["joint_1.Serve", "joint_2.Serve", "joint_3.Serve"]
    assert [one.answered for one in times] == [bounds[f"arm_1_Home_{n}"] for n in (1, 2, 3)]
    assert {one.limit for one in times} == {40 * MS}
    assert all(5 * MS < (one.answered or 0) < 7 * MS for one in times)
    assert findings(analysis) == ()


def test_a_limit_that_one_element_may_exceed_is_an_error() -> None:
    text = TEXT.replace("time_limit: 40 ms", "time_limit: 5.85 ms")
    found = load(Path("model.yaml"), lambda path, limit: text.encode())
    assert found.system is not None
    (late,) = findings(analyse(found.system))
    assert late.code == "RV-0905" and "arm_1_Home_3" in late.message


def test_a_limit_to_another_node_is_that_of_each_call() -> None:
    system = _system(APART)
    kinds = [type(part.provider) for part in _parts(system, "Home")]
    assert kinds == [Server, Remote, Remote]
    assert [type(part.provider) for part in _parts(system, "Get_Place")][1:] == [RemoteRead] * 2
    analysis = analyse(system)
    names = {chain.name: found.met for chain, found in analysis.limited}
    assert names == dict.fromkeys(
        [*(f"arm_1_Home_{n}" for n in (1, 2, 3)), *(f"arm_1_Get_Place_{n}" for n in (2, 3))], True
    )
    found = _loaded(APART, (", time_limit: 60 ms", ""))
    assert "arm_1.Home_2 has its replies from drive: the binding needs" in _said(found)


def test_the_same_arm_on_one_node_has_no_messages() -> None:
    system = on_one_node(_system(APART))
    assert all(isinstance(part.provider, Server) for part in _parts(system, "Home"))


# --- Drawing -------------------------------------------------------------------------


def test_the_drawing_leads_to_each_element() -> None:
    links = device_links(_system(TEXT))
    joints = [DeviceLink("arm_1", "Joints", f"joint_{n}", "Motion") for n in (1, 2, 3)]
    clamps = [DeviceLink("arm_1", "Grip", n, None) for n in ("clamp_1", "clamp_2", "vice_1")]
    assert list(links) == [*joints, *clamps]


# --- Released by calls ---------------------------------------------------------------

GATE = """\
system: Gates
commands:
  Press: {kind: write, argument: Force, per_axis: true}
  Open: {kind: void}
types:
  Force: {range: [0, 50], unit: N}
device_types:
  Clamp: {body: simulated, provides: {Press: 4 us}}
  Vice: {body: simulated, provides: {Press: 3 us}}
devices:
  clamp_1: {type: Clamp}
  vice_1: {type: Vice}
components:
  Holder:
    provides: {Holding: {queue: 2, served_by: hold, commands: [Press]}}
    activities:
      hold: {period: 10 ms, wcet: 20 us, body: user}
  Gate:
    requires: {Grip: {axes: 2, commands: [Press]}}
    provides: {Gating: {queue: 2, served_by: open, commands: [Open]}}
    activities:
      open: {period: 10 ms, wcet: 20 us, calls: [Press], body: user}
  Guard:
    requires: {Way: {commands: [Open]}}
    activities:
      watch: {period: 20 ms, wcet: 20 us, calls: [Open], body: user}
nodes: {board: {context_switch: 5 us, critical_section: 2 us}}
instances:
  holder: {component: Holder, node: board, count: 2}
  gate_1: {component: Gate, node: board}
  guard_1: {component: Guard, node: board}
bindings:
  - {from: gate_1.Grip, to: [clamp_1, vice_1]}
  - {from: guard_1.Way, to: gate_1.Gating}
processors:
  gating: {released_by: gate_1.Gating, period: 10 ms, stack: 16 KiB, activities: [gate_1.open]}
  rest: {stack: 16 KiB, activities: [holder_*.hold, guard_1.watch]}
"""


def test_a_released_server_may_call_an_array_of_devices_and_none_of_tasks() -> None:
    found = _loaded(GATE)
    assert found.system is not None, _said(found)
    said = _said(_loaded(GATE, ("[clamp_1, vice_1]", "holder_*.Holding")))
    assert said.count("calls `Press` of another component") == 1
