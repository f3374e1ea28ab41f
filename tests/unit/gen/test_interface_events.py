# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Events of interfaces: a binding brings them, as a connection of both ports would."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.timing import analyse
from ravenchart.gen.derive.crossing import crossings
from ravenchart.gen.diagnostics import render
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT

MODEL = (ROOT / "tests" / "nodes" / "gripper" / "model.yaml").read_text()
TOGETHER = ("component: Boss, node: desk", "component: Boss, node: board")
BY_HAND = (
    ("        events: {Gripped: Told}\n", ""),
    ("        events: {Gripped: Has_It}\n", ""),
    ("bindings:\n", "connections:\n  - {from: grasp_1.Has_It, to: boss_1.Told}\nbindings:\n"),
)


def _system(*replacements: tuple[str, str]) -> System:
    text = MODEL
    for old, new in replacements:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    found = load(Path("model.yaml"), lambda path, limit: text.encode())
    said = "\n".join(render(one, found.sources) for one in found.diagnostics)
    assert found.system is not None, said
    assert not found.diagnostics, said
    return found.system


PLACE = re.compile(r" *--  \[\w+\] \S+:\d+$", re.M)
"""Where a transition or state stands in the model."""


def _program(system: System) -> dict[str, str]:
    """What is generated, but for the text of the model: its digest, and where elements stand."""
    system = replace(system, digest="")
    files = generate(system, claims_of(analyse(system)))
    return {n: PLACE.sub("", text) for n, text in files.items() if not n.endswith("trace.json")}


def test_an_event_is_brought_as_by_a_connection_on_one_node() -> None:
    system = _system(TOGETHER)
    assert [(str(c.source), str(c.target)) for c in system.connections] == [
        ("grasp_1.Has_It", "boss_1.Told")
    ]
    assert _program(system) == _program(_system(TOGETHER, *BY_HAND))


def test_an_event_is_brought_as_by_a_connection_between_nodes() -> None:
    system = _system()
    assert not system.connections
    (message,) = [m for m in system.messages if m.call is None and not m.every]
    assert (str(message.source), [str(t) for t in message.targets]) == (
        "grasp_1.Has_It",
        ["boss_1.Told"],
    )
    assert _program(system) == _program(_system(*BY_HAND))


def test_of_a_facade_the_one_that_is_chosen_tells() -> None:
    second = (
        ("  grasp_1: {", "  grasp_2: {component: Grasp, node: board}\n  grasp_1: {"),
        (
            "  - {from: grasp_1.Hand,",
            "  - {from: grasp_2.Hand, to: Hand}\n  - {from: grasp_1.Hand,",
        ),
        ("to: grasp_1.Work", "to: Both"),
        (
            "devices:\n",
            "devices:\n  Both: {facade: [grasp_2.Work, grasp_1.Work], choose: CHOSEN}\n",
        ),
        ("activities: [grasp_1.Serve]", "activities: [grasp_1.Serve, grasp_2.Serve]"),
        ("grasp_1.Life]", "grasp_1.Life, grasp_2.Guess, grasp_2.Life]"),
        ("CHOSEN", "{Gripped: grasp_1.Work, Grip: grasp_2.Work, Get_Heat: grasp_2.Work}"),
        TOGETHER,
    )
    text = MODEL
    for old, new in second:
        text = text.replace(old, new)
    found = load(Path("model.yaml"), lambda path, limit: text.encode())
    assert found.system is not None, [one.message for one in found.diagnostics]
    assert [str(c.source) for c in found.system.connections] == ["grasp_1.Has_It"]


ACROSS = """\
system: Eventful
types: {Width: {range: [0, 100], unit: mm}}
commands:
  Gripped: {kind: event, argument: Width}
components:
  Grasp:
    provides:
      Work: {events: {Gripped: has_it}}
    ports: {has_it: {out: Width}}
    activities:
      close: {period: 20 ms, wcet: 50 us, body: [{send: has_it, with: 40}]}
  Boss:
    requires:
      Hand: {events: {Gripped: told}}
    ports: {told: {in: Width, kind: queued, depth: 2, on_arrival: Held}}
    port_region: {period: 20 ms, wcet: 20 us}
    events: {Held: {type: Width}}
    regions:
      Work:
        period: 20 ms
        wcet: 50 us
        queue: 2
        initial: A
        states: {A: {}, B: {}}
        transitions: {go: {from: A, to: B, on: Held, guard: event > 10}}
nodes: {board: {cores: 2, context_switch: 5 us, critical_section: 2 us}}
instances:
  grasp_1: {component: Grasp, node: board}
  boss_1: {component: Boss, node: board}
bindings: [{from: boss_1.Hand, to: grasp_1.Work}]
processors:
  one: {stack: 16 KiB, activities: [boss_1.ports, boss_1.Work]}
  two: {core: 2, stack: 16 KiB, activities: [grasp_1.close]}
shutdown: {raises: [], grace: 0 ms}
"""


def test_an_event_goes_from_core_to_core() -> None:
    """It is a value of a port, so it has the mailbox of one."""
    system = load(Path("model.yaml"), lambda path, limit: ACROSS.encode()).system
    assert system is not None
    (crossing,) = crossings(system)
    assert (crossing.element, crossing.sent_on, crossing.taken_on) == ("boss_1.told", 2, 1)


def test_an_interface_has_commands_or_events() -> None:
    text = ACROSS.replace("Hand: {events: {Gripped: told}}", "Hand: {axes: 1}")
    found = load(Path("model.yaml"), lambda path, limit: text.encode())
    said = [one.message for one in found.diagnostics]
    assert "Hand needs the key `commands`, or `events`" in said
