# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Arrays of instances: each is the same as its elements written out by hand."""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest
import yaml

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.timing import analyse
from ravenchart.evidence.tracing import instances_inside
from ravenchart.gen.draw.structure import structure_dot
from ravenchart.gen.emit.program import generate
from ravenchart.gen.files.links import links
from ravenchart.gen.files.load import read_model
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.paths import ROOT

FEATURE = (ROOT / "tests/feature/arrays/model.yaml").read_text(encoding="utf-8")

PAGE = (ROOT / "docs/arrays.md").read_text(encoding="utf-8")

BY_HAND = {
    "      gauge: {component: Gauge, count: 2, parameters: {weight: [weight, 30]}}\n": """\
      gauge_1: {component: Gauge, parameters: {weight: weight}}
      gauge_2: {component: Gauge, parameters: {weight: 30}}
""",
    "      - {from: load_*, to: gauge_*.load}\n": """\
      - {from: load_1, to: gauge_1.load}
      - {from: load_2, to: gauge_2.load}
""",
    "      - {from: gauge_*.weighed, to: adder.part_*}\n": """\
      - {from: gauge_1.weighed, to: adder.part_1}
      - {from: gauge_2.weighed, to: adder.part_2}
""",
    """\
  wheel:
    component: Wheel
    node: board
    count: 4
    parameters: {limit: [300, 300, 500, 500], slip: 10}
  shadow: {component: Follower, node: board, count: 4}
  axle: {component: Axle, node: board, count: 2, parameters: {weight: [20, 40]}}
""": """\
  wheel_1: {component: Wheel, node: board, parameters: {limit: 300, slip: 10}}
  wheel_2: {component: Wheel, node: board, parameters: {limit: 300, slip: 10}}
  wheel_3: {component: Wheel, node: board, parameters: {limit: 500, slip: 10}}
  wheel_4: {component: Wheel, node: board, parameters: {limit: 500, slip: 10}}
  shadow_1: {component: Follower, node: board}
  shadow_2: {component: Follower, node: board}
  shadow_3: {component: Follower, node: board}
  shadow_4: {component: Follower, node: board}
  axle_1: {component: Axle, node: board, parameters: {weight: 20}}
  axle_2: {component: Axle, node: board, parameters: {weight: 40}}
""",
    """\
  - {from: driver.wanted, to: wheel_*.wanted}
  - {from: wheel_*.speed, to: shadow_*.speed}
  - {from: wheel_*.speed, to: dashboard.speed_*}
  - {from: wheel_*.load, to: axle_*.load_*}
""": """\
  - {from: driver.wanted, to: wheel_1.wanted}
  - {from: driver.wanted, to: wheel_2.wanted}
  - {from: driver.wanted, to: wheel_3.wanted}
  - {from: driver.wanted, to: wheel_4.wanted}
  - {from: wheel_1.speed, to: shadow_1.speed}
  - {from: wheel_2.speed, to: shadow_2.speed}
  - {from: wheel_3.speed, to: shadow_3.speed}
  - {from: wheel_4.speed, to: shadow_4.speed}
  - {from: wheel_1.speed, to: dashboard.speed_1}
  - {from: wheel_2.speed, to: dashboard.speed_2}
  - {from: wheel_3.speed, to: dashboard.speed_3}
  - {from: wheel_4.speed, to: dashboard.speed_4}
  - {from: wheel_1.load, to: axle_1.load_1}
  - {from: wheel_2.load, to: axle_1.load_2}
  - {from: wheel_3.load, to: axle_2.load_1}
  - {from: wheel_4.load, to: axle_2.load_2}
""",
    "  - {from: wheel_*.Drive, to: Motor_*}\n": """\
  - {from: wheel_1.Drive, to: Motor_1}
  - {from: wheel_2.Drive, to: Motor_2}
  - {from: wheel_3.Drive, to: Motor_3}
  - {from: wheel_4.Drive, to: Motor_4}
""",
    "[driver.steer, wheel_*.ports, wheel_*.Rolling, wheel_*.control]": """[
      driver.steer, wheel_1.ports, wheel_2.ports, wheel_3.ports, wheel_4.ports,
      wheel_1.Rolling, wheel_2.Rolling, wheel_3.Rolling, wheel_4.Rolling,
      wheel_1.control, wheel_2.control, wheel_3.control, wheel_4.control]""",
    "on_deadline_miss: [wheel_*.Release]": "on_deadline_miss: "
    "[wheel_1.Release, wheel_2.Release, wheel_3.Release, wheel_4.Release]",
    """\
      - shadow_*.ports
      - shadow_*.follow
      - axle_*.gauge_*.ports
      - axle_*.gauge_*.weigh
      - axle_*.adder.ports
      - axle_*.adder.add
""": "".join(
        f"      - {row}\n"
        for row in (
            *(f"shadow_{n}.{name}" for name in ("ports", "follow") for n in range(1, 5)),
            *(
                f"axle_{n}.gauge_{k}.{name}"
                for name in ("ports", "weigh")
                for n in (1, 2)
                for k in (1, 2)
            ),
            *(f"axle_{n}.adder.{name}" for name in ("ports", "add") for n in (1, 2)),
        )
    ),
    "  turning: {path: [driver.steer, wheel_*.control, shadow_*.follow], age: 200 ms}\n": """\
  turning_1: {path: [driver.steer, wheel_1.control, shadow_1.follow], age: 200 ms}
  turning_2: {path: [driver.steer, wheel_2.control, shadow_2.follow], age: 200 ms}
  turning_3: {path: [driver.steer, wheel_3.control, shadow_3.follow], age: 200 ms}
  turning_4: {path: [driver.steer, wheel_4.control, shadow_4.follow], age: 200 ms}
""",
    "raises: [wheel_*.Release]": "raises: "
    "[wheel_1.Release, wheel_2.Release, wheel_3.Release, wheel_4.Release]",
}
"""What stands in the feature's model, and its elements written out."""


def loaded(text: str, *replacements: tuple[str, str]) -> Loaded:
    for old, new in replacements:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return load(Path("model.yaml"), lambda _path, limit: text.encode()[:limit])


def system_of(text: str) -> System:
    found = loaded(text)
    assert found.system is not None, found.diagnostics
    return found.system


def program(system: System) -> dict[str, list[str]]:
    """What each unit says, without comments: they have the lines of the model."""
    made = generate(system, claims_of(analyse(system)))
    return {
        name: re.sub(r"--.*", "", text.replace(system.digest, "")).split()
        for name, text in made.items()
        if name.endswith((".ads", ".adb", ".gpr"))
    }


def by_hand(text: str) -> str:
    for old, new in BY_HAND.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    assert "*" not in text and "count" not in text
    return text


def test_the_program_is_that_of_the_model_written_out() -> None:
    array, wanted = system_of(FEATURE), system_of(by_hand(FEATURE))
    assert program(array) == program(wanted)
    assert [i.name for i in array.instances] == [i.name for i in wanted.instances]
    assert [i.parameters for i in array.instances] == [i.parameters for i in wanted.instances]


def test_bounds_chains_and_drawings_are_those_of_the_model_written_out() -> None:
    array, wanted = system_of(FEATURE), system_of(by_hand(FEATURE))
    assert structure_dot(array) == structure_dot(wanted)
    found, hand = analyse(array), analyse(wanted)
    assert [(one.name, one.age) for one in array.chains] == [
        (f"turning_{number}", 200_000_000) for number in range(1, 5)
    ]
    assert [(r.row.name, r.bound) for _, r in found.rows()] == [
        (r.row.name, r.bound) for _, r in hand.rows()
    ]
    assert [f.age for _, f in found.limited] == [f.age for _, f in hand.limited]


def test_elements_stand_where_the_array_is_declared() -> None:
    system, lines = system_of(FEATURE), FEATURE.splitlines()
    at = {lines[i.origin.line - 1].strip() for i in system.instances if i.name[:6] == "wheel_"}
    assert at == {"wheel:"}
    wires = [c for c in system.connections if c.target.instance == "wheel_3"]
    assert [lines[c.origin.line - 1] for c in wires] == [
        "  - {from: driver.wanted, to: wheel_*.wanted}"
    ]


LISTS = """\
buses:
  line: {bit_rate: 500 kbit/s, driver_wcet: 20 us, receive_depth: 8, transmit_depth: 8}
instances:
  probe: {component: Probe_Kind, node: board, count: 2, parameters: {gain: 1}}
  board_1: {component: Board, node: board}
connections: [{from: probe_*.level, to: board_1.level_*}]
messages:
  tick_in: {bus: line, id: 0x10, to: probe_*.tick, period: 10 ms}
processors:
  reception: {released_by: line, period: 1 ms, stack: 16 KiB, activities: [line.receive]}
  cyclic:
    stack: 16 KiB
    activities: [probe_*.ports, probe_*.work, board_1.ports, board_1.show]
record: [probe_*.level]
"""


@pytest.mark.parametrize("to", ["probe_*.tick", "[probe_*.tick]"])
def test_a_message_goes_to_all_elements_and_their_values_are_recorded(to: str) -> None:
    head = (ROOT / "tests/unit/gen/test_arrays.yaml").read_text(encoding="utf-8")
    ports = "      level_1: {in: Level}\n      level_2: {in: Level}"
    head = head.replace("PORTS", ports).replace("LARGEST", "max(level_1, level_2)")
    head = head.replace("critical_section: 2 us", "critical_section: 2 us, trace: 64")
    system = system_of(head + LISTS.replace("to: probe_*.tick", f"to: {to}"))
    assert [str(end) for end in system.messages[0].targets] == ["probe_1.tick", "probe_2.tick"]
    assert [one.instance for one in system.recorded] == ["probe_1", "probe_2"]


# --- Mistakes --------------------------------------------------------------------------

WHEEL = "  wheel:\n    component: Wheel\n    node: board\n    count: 4\n"
"""The first keys of an array."""

MISTAKES = yaml.safe_load((ROOT / "tests/unit/gen/test_arrays_mistakes.yaml").read_text("utf-8"))


@pytest.mark.parametrize("made", MISTAKES, ids=lambda made: made["message"][:40])
def test_a_mistake_is_reported_once_at_its_line(made: dict[str, str]) -> None:
    text = FEATURE.replace(made["old"], made["new"])
    found = loaded(FEATURE, (made["old"], made["new"]))
    assert found.system is None
    code, wrong = made["code"], [one for one in found.diagnostics if one.is_error]
    same = [one for one in wrong if one.code == code and made["message"] in one.message]
    assert len(same) == 1, found.diagnostics
    assert made["line"] in text.splitlines()[same[0].origin.line - 1]
    others = [one for one in wrong if one.code != code]
    assert not others or code == "RV-0303", others  # of two instances only one is looked at


def test_one_element_only_is_wanted_where_a_processor_is_released() -> None:
    found = loaded(FEATURE, ("  wheels:\n", "  wheels:\n    released_by: wheel_*.wanted\n"))
    message = "`wheel_*.wanted` stands for several elements, but `released_by` takes one"
    assert ("RV-0306", message) in [(one.code, one.message) for one in found.diagnostics]


def test_too_many_rows_are_reported_where_the_list_is() -> None:
    stars = ", ".join(["wheel_*.control"] * 300)
    found = loaded(FEATURE, ("wheel_*.control]", f"{stars}]"))
    (one,) = (one for one in found.diagnostics if one.code == "RV-0209")
    assert "`activities` must have at most 1024 elements" in one.message


def test_an_array_may_be_declared_in_a_file_that_cannot_be_read() -> None:
    found = loaded(FEATURE.replace(WHEEL, "  other:\n    component: Wheel\n    node: board\n"))
    assert "RV-0305" in {one.code for one in found.diagnostics}
    text = FEATURE.replace(WHEEL, "  other:\n    component: Wheel\n    node: board\n").encode()

    def read(path: Path, limit: int) -> bytes:
        if path.name == "model.yaml":
            return b"include: [other.yaml]\n" + text[:limit]
        raise FileNotFoundError(2, "No such file or directory")

    assert {one.code for one in load(Path("model.yaml"), read).diagnostics} <= {
        "RV-0101",
        "RV-0203",
    }


def test_an_array_may_stand_in_another_file_than_its_stars() -> None:
    before, _, rest = FEATURE.partition("instances:\n  driver:")
    inside, _, after = rest.partition("\nconnections:\n")
    texts = {
        "model.yaml": f"include: [parts.yaml]\n{before}connections:\n{after}",
        "parts.yaml": f"instances:\n  driver:{inside}",
    }
    found = load(Path("model.yaml"), lambda path, limit: texts[path.name].encode()[:limit])
    assert found.system is not None, found.diagnostics
    assert program(found.system) == program(system_of(FEATURE))
    texts["parts.yaml"] = texts["parts.yaml"].replace("Follower, node: board, count: 4", "Nothing")
    found = load(Path("model.yaml"), lambda path, limit: texts[path.name].encode()[:limit])
    assert {one.code for one in found.diagnostics} == {"RV-0202"}


def test_an_array_does_not_lead_to_one_port() -> None:
    found = loaded(FEATURE, ("to: dashboard.speed_*}", "to: dashboard.speed_1}"))
    twice = [one for one in found.diagnostics if one.code == "RV-0603"]
    assert [one.message for one in twice] == ["dashboard.speed_1 has two sources"]


# --- Random models ---------------------------------------------------------------------


def random_pair(seed: int) -> tuple[str, str]:
    """A model with arrays, and the same with all elements written out."""
    dice = random.Random(seed)
    short, long = dice.randint(2, 4), dice.randint(2, 9)
    sizes = {"probe": short, "lamp": short, "relay": long}
    values = {name: [dice.randint(0, 9) for _ in range(n)] for name, n in sizes.items()}
    listed = {name: dice.random() < 0.5 for name in sizes}
    order = list(sizes)
    dice.shuffle(order)
    head = (ROOT / "tests/unit/gen/test_arrays.yaml").read_text(encoding="utf-8")
    ports = "".join(f"      level_{n + 1}: {{in: Level}}\n" for n in range(long))
    largest = "level_1"
    for number in range(2, long + 1):
        largest = f"max({largest}, level_{number})"
    arrays, plain = [], []
    for name in order:
        start = f"{{component: {name.capitalize()}_Kind, node: board"
        given = values[name] if listed[name] else values[name][0]
        arrays.append(f"  {name}: {start}, count: {sizes[name]}, parameters: {{gain: {given}}}}}")
        plain += [
            f"  {name}_{n + 1}: {start}, parameters: "
            f"{{gain: {values[name][n if listed[name] else 0]}}}}}"
            for n in range(sizes[name])
        ]
    joins = [("probe_*.level", "lamp_*.level"), ("clock_1.tick", "probe_*.tick"),
             ("relay_*.level", "board_1.level_*"), ("clock_1.tick", "relay_*.tick")]  # fmt: skip
    dice.shuffle(joins)
    rows = ["clock_1.beat", "board_1.ports", "board_1.show"]
    for name in sizes:
        rows += [f"{name}_*.{row}" for row in ("ports", "work")]
    dice.shuffle(rows)

    def element(text: str, number: int) -> str:
        return text.replace("_*", f"_{number}")

    def size(*texts: str) -> int:
        return max(sizes.get(text.partition("_*")[0], 1) if "_*" in text else 1 for text in texts)

    def text(instances: list[str], wires: list[tuple[str, str]], table: list[str]) -> str:
        return head.replace("PORTS", ports.rstrip()).replace("LARGEST", largest) + "\n".join(
            ["instances:", "  clock_1: {component: Clock, node: board}",
             "  board_1: {component: Board, node: board}", *instances, "connections:",
             *(f"  - {{from: {a}, to: {b}}}" for a, b in wires),
             "processors:", "  cyclic:", "    stack: 16 KiB", "    activities:",
             *(f"      - {row}" for row in table), ""]
        )  # fmt: skip

    wires = [(element(a, n), element(b, n)) for a, b in joins for n in range(1, size(a, b) + 1)]
    table = [element(row, n) for row in rows for n in range(1, size(row) + 1)]
    return text(arrays, joins, rows), text(plain, wires, table)


@pytest.mark.parametrize("seed", range(20))
def test_random_arrays_are_their_elements(seed: int) -> None:
    array, plain = random_pair(seed)
    assert program(system_of(array)) == program(system_of(plain))


def test_the_model_of_the_page_is_valid_and_in_time() -> None:
    (text,) = re.findall(r"```yaml\n(system:.*?)```", PAGE, re.DOTALL)
    found = loaded(text)
    assert found.system is not None
    assert found.diagnostics == ()
    assert found.system.instance("wheel_3").parameters == (("limit", 500),)
    assert analyse(found.system).schedulable


def test_a_model_without_arrays_is_read_as_before() -> None:
    models = sorted((ROOT / "examples").glob("*/model.yaml"))
    without = [path for path in models if "count:" not in path.read_text(encoding="utf-8")]
    assert len(without) > 5
    for path in without:
        content = read_model(path)
        assert all(a is b for a, b in zip(content.forms, content.written, strict=True)), path


# --- Requirements ----------------------------------------------------------------------


def test_a_requirement_of_an_array_is_one_of_all_its_elements() -> None:
    text = FEATURE.replace("count: 4}", "count: 4, req: [R-1]}").replace(
        "count: 2, parameters: {weight: [weight",
        "count: 2, req: [R-2], parameters: {weight: [weight",
    )
    content = read_model(Path("model.yaml"), lambda _path, limit: text.encode()[:limit])
    inner, outer = links(content.written)
    assert (inner.element, outer.element) == ("Axle.gauge", "shadow")
    system = system_of(text)
    assert [i.name for i in instances_inside(system, outer)] == [f"shadow_{n}" for n in range(1, 5)]
    assert [i.name for i in instances_inside(system, inner)] == [
        "axle_1.gauge_1", "axle_1.gauge_2", "axle_2.gauge_1", "axle_2.gauge_2",
    ]  # fmt: skip
