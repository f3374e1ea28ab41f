# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Components inside components: each composite is the same as its parts written out by hand."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.plain.bounds import function_of
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.behaviour.interpreter import stimuli
from ravenchart.building import stacks
from ravenchart.editing.edits import Document
from ravenchart.editing.places import ModelPlaces
from ravenchart.evidence.tracing import instances_inside
from ravenchart.gen.draw.structure import structure_dot
from ravenchart.gen.draw.structure_text import mermaid, plantuml
from ravenchart.gen.emit.clashes import clashes
from ravenchart.gen.emit.program import generate
from ravenchart.gen.files.links import links
from ravenchart.gen.files.load import read_model
from ravenchart.gen.model.commands import Server
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.language_server.completing import proposals
from ravenchart.paths import ROOT
from ravenchart.proof.unproved import element_of

NESTED = (ROOT / "tests/feature/composites/model.yaml").read_text(encoding="utf-8")

FLAT_INSTANCES = """\
instances:
  operator: {component: Desk, node: board}
  robot_left_shoulder: {component: Joint, node: board, parameters: {reach: 400}}
  robot_left_elbow: {component: Joint, node: board, parameters: {reach: 500}}
  robot_left_coordinator: {component: Coordinator, node: board}
  robot_right_shoulder: {component: Joint, node: board, parameters: {reach: 300}}
  robot_right_elbow: {component: Joint, node: board, parameters: {reach: 500}}
  robot_right_coordinator: {component: Coordinator, node: board}
  left_observer: {component: Observer, node: board}
  right_observer: {component: Observer, node: board}
connections:
  - {from: operator.wanted, to: robot_left_coordinator.goal}
  - {from: operator.wanted, to: robot_right_coordinator.goal}
  - {from: robot_left_coordinator.shoulder_to, to: robot_left_shoulder.target}
  - {from: robot_left_coordinator.elbow_to, to: robot_left_elbow.target}
  - {from: robot_left_shoulder.position, to: robot_left_coordinator.shoulder_is}
  - {from: robot_left_elbow.position, to: robot_left_coordinator.elbow_is}
  - {from: robot_right_coordinator.shoulder_to, to: robot_right_shoulder.target}
  - {from: robot_right_coordinator.elbow_to, to: robot_right_elbow.target}
  - {from: robot_right_shoulder.position, to: robot_right_coordinator.shoulder_is}
  - {from: robot_right_elbow.position, to: robot_right_coordinator.elbow_is}
bindings:
  - {from: robot_left_shoulder.Drive, to: Axis_1}
  - {from: robot_left_elbow.Drive, to: Axis_2}
  - {from: robot_right_shoulder.Drive, to: Axis_3}
  - {from: robot_right_elbow.Drive, to: Axis_4}
  - {from: left_observer.Arm, to: robot_left_coordinator.Motion}
  - {from: right_observer.Arm, to: robot_right_coordinator.Motion}
"""

PAGE = (ROOT / "docs/composites.md").read_text(encoding="utf-8")

ARMS, PARTS = ("left", "right"), ("shoulder", "elbow", "coordinator")

ARM = """\
system: Nested
types:
  Level: {range: [0, 1000]}
components:
  Source:
    ports: {level: {out: Level}}
    activities:
      tell: {period: 10 ms, wcet: 20 us, body: [{send: level, with: 1}]}
  Sink:
    parameters: {limit: {type: Level, default: 5}}
    ports: {level: {in: Level}}
    port_region: {period: 10 ms, wcet: 20 us}
    data: {peak: {type: Level, initial: 0}}
    activities:
      note: {period: 10 ms, wcet: 20 us, body: [{set: peak, to: "min(limit, level)"}]}
  Pair:
    parameters: {most: {type: Level, default: 7}}
    ports: {told: {out: Level}, given: {in: Level}}
    instances:
      source: {component: Source}
      sink: {component: Sink, parameters: {limit: most}}
    connections:
      - {from: source.level, to: told}
      - {from: given, to: sink.level}
nodes:
  here: {context_switch: 5 us, critical_section: 2 us}
  there: {context_switch: 5 us, critical_section: 2 us}
buses:
  line: {bit_rate: 500 kbit/s, driver_wcet: 20 us, receive_depth: 8, transmit_depth: 8}
instances:
  one: {component: Pair, node: here}
  two: {component: Pair, node: there, parameters: {most: 9}}
connections:
  - {from: one.told, to: two.given}
messages:
  back: {bus: line, id: 0x10, from: two.told, to: one.given}
processors:
  reception: {released_by: line, period: 1 ms, stack: 16 KiB, activities: [line.receive]}
  first: {stack: 16 KiB, activities: [one.source.tell, one.sink.ports, one.sink.note]}
  second: {stack: 16 KiB, activities: [two.source.tell, two.sink.ports, two.sink.note]}
"""


def loaded(text: str, *replacements: tuple[str, str]) -> Loaded:
    for old, new in replacements:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return load(Path("model.yaml"), lambda _path, limit: text.encode()[:limit])


def system_of(text: str, *replacements: tuple[str, str]) -> System:
    found = loaded(text, *replacements)
    assert found.system is not None, found.diagnostics
    return found.system


def errors(text: str, *replacements: tuple[str, str]) -> list[tuple[str, str]]:
    return [(one.code, one.message) for one in loaded(text, *replacements).diagnostics]


def flat() -> System:
    """The feature's model with its composites written out by hand."""
    plain, _, rest = NESTED.partition("  Arm:\n")
    others = rest[rest.index("  Desk:\n") :]
    before, _, rest = others.partition("instances:\n")
    after = rest[rest.index("processors:\n") :]
    for path in re.findall(r"\brobot(?:\.\w+){2}", after):
        after = after.replace(path, path.replace(".", "_"))
    return system_of(plain + before + FLAT_INSTANCES + after)


def joined(text: str) -> str:
    """A text in which the paths of instances are one name."""
    return re.sub(r"\brobot\.(\w+)\.(\w+)\b", r"robot_\1_\2", text)


def words(text: str) -> list[str]:
    """What a unit says, without comments: they have the lines of the model."""
    return re.sub(r"--.*", "", text).split()


def test_the_program_is_that_of_the_model_written_out() -> None:
    nested, by_hand = system_of(NESTED), flat()
    made, wanted = (generate(one, claims_of(analyse(one))) for one in (nested, by_hand))
    assert list(made) == list(wanted)
    own, other = nested.digest, by_hand.digest
    for name, text in made.items():
        if name.endswith((".ads", ".adb", ".gpr")):
            assert words(joined(text)) == words(wanted[name].replace(other, own)), name


def test_the_bounds_are_those_of_the_model_written_out() -> None:
    nested, by_hand = analyse(system_of(NESTED)), analyse(flat())

    def bounds(of: Analysis) -> dict[str, int | None]:
        return {joined(row.row.name): row.bound for one in of.responses for row in one.rows}

    assert bounds(nested) == bounds(by_hand)
    assert len(bounds(nested)) == 21
    chains = [[found.reaction for _, found in of.limited] for of in (nested, by_hand)]
    assert chains[0] == chains[1]


def test_instances_are_called_by_their_paths_and_stand_where_their_composite_names_them() -> None:
    system = system_of(NESTED)
    shoulder = system.instance("robot.left.shoulder")
    lines = NESTED.splitlines()
    assert lines[shoulder.origin.line - 1].strip().startswith("shoulder: {component: Joint")
    assert shoulder.parameters == (("reach", 400),)
    assert system.instance("robot.right.shoulder").parameters == (("reach", 300),)
    assert {c.name for c in system.components} == {
        "Joint", "Coordinator", "Desk", "Observer",
    }  # fmt: skip


def test_ports_of_composites_are_ends_of_messages_between_nodes() -> None:
    system = system_of(ARM)
    assert not list(clashes(system))
    assert [(m.name, str(m.source), [str(t) for t in m.targets]) for m in system.messages] == [
        ("back", "two.source.level", ["one.sink.level"]),
        ("one_source_level", "one.source.level", ["two.sink.level"]),
    ]
    assert {i.name: i.node for i in system.instances} == {
        "one.source": "here", "one.sink": "here", "two.source": "there", "two.sink": "there",
    }  # fmt: skip
    assert analyse(system).schedulable


def test_the_model_of_the_page_is_valid_and_in_time() -> None:
    (text,) = re.findall(r"```yaml\n(.*?)```", PAGE, re.S)
    found = loaded(text)
    assert found.system is not None and found.diagnostics == ()
    assert found.system.instance("lower_station.watch").parameters == (("limit", 700),)
    assert analyse(found.system).schedulable


def test_events_of_instances_inside_are_named_by_paths() -> None:
    event = "robot.left.coordinator.Goal_Came"
    system = system_of(
        NESTED,
        ("shutdown: {raises: []", f"shutdown: {{raises: [{event}]"),
        ("  joints:\n", f"  joints:\n    on_deadline_miss: [{event}]\n"),
    )
    assert system.shutdown.raises == (("robot.left.coordinator", "Goal_Came"),)
    assert system.processors[0].on_deadline_miss == system.shutdown.raises


def test_a_parameter_is_passed_or_has_the_default_of_the_composite() -> None:
    system = system_of(ARM)
    assert system.instance("one.sink").parameters == (("limit", 7),)
    assert system.instance("two.sink").parameters == (("limit", 9),)


def test_a_port_without_source_is_told_where_it_can_be_connected() -> None:
    found = loaded(ARM, ("  - {from: one.told, to: two.given}\n", "  []\n"))
    told = {(one.code, one.message, one.origin.line) for one in found.diagnostics}
    line = next(n for n, text in enumerate(ARM.splitlines(), 1) if text.startswith("  two: {"))
    assert ("RV-0602", "two.given has no source", line) in told
    assert (
        "RV-0604",
        "one.told is not connected: the values that it sends are lost",
        line - 1,
    ) in told


@pytest.mark.parametrize(
    ("draw", "frame", "inside"),
    [
        (
            plantuml,
            'component "robot.left : Arm" as robot_left {',
            'component "robot.left.shoulder : Joint" as robot_left_shoulder {',
        ),
        (
            mermaid,
            'subgraph instance_robot_left["robot.left : Arm"]',
            'instance_robot_left_shoulder["robot.left.shoulder : Joint"]',
        ),
        (
            structure_dot,
            'subgraph "cluster composite robot.left" {',
            '"robot.left.shoulder" [label=',
        ),
    ],
)
def test_drawings_frame_what_is_inside_a_composite(
    draw: Callable[[System], str], frame: str, inside: str
) -> None:
    text = draw(system_of(NESTED))
    assert text.index(frame) < text.index(inside)


def test_an_event_file_puts_a_value_to_an_instance_inside() -> None:
    text = "- {at: 10 ms, put: robot.left.shoulder.target, value: 5}\n- {until: 50 ms}\n"
    found, wrong = stimuli.read_stimuli(text, "events.yaml", system_of(NESTED))
    assert found is not None and not wrong
    assert "put: robot.left.shoulder.target" in stimuli.written_stimuli(found)


def test_a_component_of_ten_levels_is_flattened() -> None:
    levels = "".join(
        f"  Level_{n}:\n    ports: {{level: {{out: Level}}}}\n"
        f"    instances: {{in_it: {{component: {f'Level_{n + 1}' if n < 10 else 'Source'}}}}}\n"
        "    connections: [{from: in_it.level, to: level}]\n"
        for n in range(1, 11)
    )
    path = "deep" + ".in_it" * 10
    found = system_of(
        ARM,
        ("nodes:\n", f"{levels}nodes:\n"),
        ("  one: {", "  deep: {component: Level_1, node: here}\n  one: {"),
        ("[one.source.tell,", f"[{path}.tell, one.source.tell,"),
        ("  back: {", "  deep_out: {bus: line, id: 0x11, from: deep.level}\n  back: {"),
    )
    assert found.instance(path).component.name == "Source"
    assert [m.name for m in found.messages if m.source == End(path, "level")] == ["deep_out"]


def test_composites_that_grow_without_measure_are_refused() -> None:
    levels = "".join(
        f"  Level_{n}:\n    instances:\n"
        + "".join(
            f"      inner_{k}: {{component: {f'Level_{n + 1}' if n < 40 else 'Source'}}}\n"
            for k in range(2)
        )
        for n in range(1, 41)
    )
    found = errors(ARM, ("nodes:\n", f"{levels}nodes:\n"))
    assert found == [("RV-0209", "Level_30 has 2,048 instances inside; the limit is 1,024")]


@pytest.mark.parametrize(
    ("behind", "proposed"),
    [
        ("- robot.left.", {"shoulder", "elbow", "coordinator"}),
        ("- robot.left.shoulder.", {"ports", "follow"}),
        ("{from: operator.wanted, to: robot.", {"goal"}),
        ("{from: left.Shoulder_Drive, to: ", {
            "Left_Shoulder", "Left_Elbow", "Right_Shoulder", "Right_Elbow", "left", "right",
        }),
    ],
)  # fmt: skip
def test_an_editor_proposes_what_can_stand_behind_a_path(behind: str, proposed: set[str]) -> None:
    path = ROOT / "tests/feature/composites/model.yaml"
    offset = NESTED.index(behind) + len(behind)
    found = proposals(path, str(path), offset, {str(path): NESTED})
    assert {one.word for one in found} <= proposed
    assert found


def test_the_workbench_finds_the_rows_of_instances_inside_others() -> None:
    document = Document.of(NESTED)
    places = ModelPlaces({"model.yaml": document})
    joint = places.components["joint"]
    assert places.instances_of(joint) == [
        f"robot.{arm}.{joint}" for arm in ("left", "right") for joint in ("shoulder", "elbow")
    ]
    row = places.row("robot.right.coordinator.Motion_State")
    assert row is not None
    assert (row.owner, row.kind, row.text("period")) == ("Coordinator", "region", "10 ms")


def test_names_of_24_characters_fit_the_lines_where_rows_have_several_periods() -> None:
    text = NESTED.replace("left_observer", "l" * 24).replace("Watch", "W" * 24)
    system = system_of(text)
    made = generate(system, claims_of(analyse(system)))
    lines = [line for file, text in made.items() if file[-1] in "sb" for line in text.split("\n")]
    assert max(map(len, lines)) <= 79


def test_a_path_that_no_line_holds_is_refused_where_the_instance_stands() -> None:
    text = NESTED.replace("coordinator", "c" * 60)
    found = list(clashes(system_of(text)))
    assert {one.code for one in found} == {"RV-0304"}
    assert f"`robot.left.{'c' * 60}`" in found[0].message
    line = NESTED.splitlines()[found[0].origin.line - 1]
    assert line.strip() == "coordinator: {component: Coordinator}"


@pytest.mark.parametrize(
    ("element", "instances"),
    [
        ("  Arm:", {f"robot.{arm}.{part}" for arm in ARMS for part in PARTS}),
        ("      shoulder: {component: Joint", {f"robot.{arm}.shoulder" for arm in ARMS}),
        ("      left: {component: Arm", {f"robot.left.{part}" for part in PARTS}),
        ("  robot: {component: Robot", {f"robot.{arm}.{part}" for arm in ARMS for part in PARTS}),
        ("      - {from: goal, to: coordinator.goal",
         {f"robot.{arm}.{part}" for arm in ARMS for part in PARTS}),
        ("  Joint:", set()),
    ],
)  # fmt: skip
def test_a_requirement_of_a_composite_is_that_of_what_is_inside(
    element: str, instances: set[str]
) -> None:
    req = "\n    req: [R-1]" if element.endswith(":") else ", req: [R-1]"
    line = next(one for one in NESTED.splitlines() if one.startswith(element))
    marked = f"{line}{req}" if element.endswith(":") else f"{line.removesuffix('}')}{req}}}"
    text = NESTED.replace(f"{line}\n", f"{marked}\n")
    content = read_model(Path("model.yaml"), lambda _path, limit: text.encode()[:limit])
    (link,) = links(content.forms)
    assert {one.name for one in instances_inside(system_of(text), link)} == instances


def test_a_facade_chooses_what_a_composite_provides_by_the_name_that_it_has_outside() -> None:
    members = "facade: [robot.Left_Motion, robot.Right_Motion]"
    both = "\ncomponents:", f"  Both_Arms: {{{members}}}\n\ncomponents:"
    bound = (
        "{from: left_observer.Arm, to: robot.Left_Motion}",
        "{from: left_observer.Arm, to: Both_Arms}",
    )
    undecided = loaded(NESTED, both, bound).diagnostics
    assert [one.hint for one in undecided] == [
        f"say which is meant: `choose: {{{command}: robot.Left_Motion}}`"
        for command in ("Get_Sum", "Go_Home", "Arrived")
    ]
    every = ", ".join(f"{one}: robot.Left_Motion" for one in ("Get_Sum", "Go_Home", "Arrived"))
    chosen = members, f"{members}, choose: {{{every}}}"
    found = system_of(NESTED, both, bound, chosen).bindings
    (reading,) = (one for one in found if one.instance == "left_observer" and one.need.is_read)
    assert isinstance(reading.provider, Server)
    assert reading.provider.instance == "robot.left.coordinator"
    twice = "robot.Right_Motion]", "robot.Left_Motion]"
    assert ("RV-1210", "robot.Left_Motion appears twice in `facade`") in errors(
        NESTED, both, bound, twice
    )


THREE = (
    ("  two: {component: Pair, node: there, parameters: {most: 9}}\n",
     "  two: {component: Pair, node: there, parameters: {most: 9}}\n"
     "  three: {component: Pair, node: there}\n"),
    ("- {from: one.told, to: two.given}",
     "- {from: one.told, to: two.given}\n  - {from: one.told, to: three.given}"),
    ("second: {stack: 16 KiB, activities: [two.source.tell, two.sink.ports, two.sink.note]}",
     "second: {stack: 16 KiB, activities: [two.source.tell, two.sink.ports, two.sink.note, "
     "three.source.tell, three.sink.ports, three.sink.note]}"),
)  # fmt: skip
"""A third instance of the composite."""


@pytest.mark.parametrize(
    ("old", "new", "code", "message"),
    [
        ("limit: {type: Level, default: 5}}\n", "limit: {type: Level}, least: {type: Level}}\n",
         "RV-0314",
         "one.sink does not set the parameter `least`, which has no default "
         "(and 2 more instances)"),
        ("{limit: most}", "{limit: 1001}", "RV-0312", None),
    ],
)  # fmt: skip
def test_an_error_in_a_composite_is_reported_once_for_all_of_its_instances(
    old: str, new: str, code: str, message: str | None
) -> None:
    found = [one for one in loaded(ARM, *THREE, (old, new)).diagnostics if one.is_error]
    assert [one.code for one in found] == [code]
    if message is not None:
        assert found[0].message == message
        assert found[0].notes[-1] == (found[0].origin, "the others are in two, three")
    named = ARM.splitlines()[found[0].origin.line - 1]
    assert "source" in named or "sink" in named


def test_two_instances_with_errors_of_their_own_have_two() -> None:
    value = "{most: 9}", "{most: 1001}"
    other = (
        "one: {component: Pair, node: here}",
        "one: {component: Pair, node: here, parameters: {most: 2000}}",
    )
    assert [code for code, _ in errors(ARM, value, other)] == ["RV-0312", "RV-0312"]


def test_an_error_at_two_levels_counts_the_instances_of_the_inner_one() -> None:
    wire = "      - {from: shoulder.position, to: coordinator.shoulder_is}\n"
    lost, found = loaded(NESTED, (wire, "")).diagnostics
    assert (found.code, lost.code) == ("RV-0602", "RV-0604")
    assert found.message == "robot.left.coordinator.shoulder_is has no source (and 1 more instance)"
    assert found.notes[-1][1] == "the others are in robot.right"
    assert lost.message.startswith("robot.left.shoulder.position is not connected")
    assert lost.message.endswith("(and 1 more instance)")
    assert NESTED.splitlines()[found.origin.line - 1].startswith("      coordinator: {component")


def test_symbols_of_an_instance_inside_are_its_own() -> None:
    system = system_of(NESTED)
    symbol = "composites_feature__robot_left_shoulder__"
    assert stacks._owners(system)[symbol].startswith("robot.left.shoulder: ")
    slots = (slot for processor in system.processors for slot in processor.slots)
    functions = {slot.element: function_of(slot, system) for slot in slots}
    assert functions["robot.left.shoulder.follow"] == f"{symbol}run_follow"
    entity = "Composites_Feature.Robot_Left_Shoulder.Run_Follow"
    assert element_of(system, entity)[0] == "robot.left.shoulder"
