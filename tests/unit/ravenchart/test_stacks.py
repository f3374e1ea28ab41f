# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Longest paths in call graphs of the compiler, and what gives them no bound."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import permutations

import pytest

from ravenchart.stacks import graph, machine, memory, symbols
from ravenchart.stacks.longest import (
    LIBRARY,
    Depths,
    Indirect,
    Missing,
    Recursion,
    Rules,
    StackBound,
    Unbounded,
)

HOST = Rules(library=100)


def _node(title: str, size: int, kind: str = "static", *objects: str) -> str:
    more = "".join(f"\\n {one}" for one in objects)
    label = f"{title}\\na.adb:1:1\\n{size} bytes ({kind})\\n{len(objects)} dynamic objects{more}"
    return f'node: {{ title: "{title}" label: "{label}" }}\n'


def _called(title: str) -> str:
    return f'node: {{ title: "{title}" label: "{title}\\nb.ads:2:2" shape : ellipse }}\n'


def _edge(caller: str, callee: str, place: str = "a.adb:5:7") -> str:
    return f'edge: {{ sourcename: "{caller}" targetname: "{callee}" label: "{place}" }}\n'


def _unit(*lines: str) -> str:
    return 'graph: { title: "a.adb"\n' + "".join(lines) + "}\n"


def _graph(frames: Mapping[str, int], calls: Sequence[tuple[str, str]]) -> graph.Graph:
    nodes = [_node(name, size) for name, size in frames.items()]
    return graph.read([_unit(*nodes, *(_edge(*pair) for pair in calls))])


def test_the_frame_and_the_calls_of_a_unit_are_read() -> None:
    text = _unit(
        _node("/x/a.adb:p__inner.3", 48, "dynamic", "T1b a.adb:9:3"),
        _called("q__leaf"),
        _edge("/x/a.adb:p__inner.3", "q__leaf", "a.adb:7:8"),
    )
    found = graph.read([text])
    assert list(found) == ["/x/a.adb:p__inner.3"]
    one = found["/x/a.adb:p__inner.3"]
    assert (one.name, one.size, one.frame) == ("p__inner.3", 48, graph.StackFrame.DYNAMIC)
    assert (one.place, one.objects) == ("a.adb:1:1", ("T1b a.adb:9:3",))
    assert one.calls == {"q__leaf": "a.adb:7:8"}


def test_a_call_of_another_unit_is_that_of_its_node() -> None:
    units = [_unit(_node("a", 10), _called("b"), _edge("a", "b")), _unit(_node("b", 20))]
    for texts in permutations(units):
        assert Depths(graph.read(texts), Rules()).depth("a") == 30


@pytest.mark.parametrize("text", ["", "node: {}", _unit(_called("a"), _edge("a", "b"))])
def test_what_is_no_call_graph_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"call"):
        graph.read([text])


def test_of_a_diamond_the_deeper_side_counts_once() -> None:
    calls = [("a", "b"), ("a", "c"), ("b", "d"), ("c", "d")]
    depths = Depths(_graph({"a": 1, "b": 20, "c": 300, "d": 4000}, calls), Rules())
    assert depths.depth("a") == 4301
    assert [one.title for one in depths.path("a")] == ["a", "c", "d"]
    assert [one.size for one in depths.path("a")] == [1, 300, 4000]
    assert not depths.problems


def test_a_long_chain_needs_no_recursion_of_ours() -> None:
    frames = {f"f{n}": 16 for n in range(5_000)}
    calls = [(f"f{n}", f"f{n + 1}") for n in range(4_999)]
    assert Depths(_graph(frames, calls), Rules()).depth("f0") == 80_000


def test_many_paths_are_looked_at_once() -> None:
    frames = {f"{side}{n}": 16 for side in "xy" for n in range(60)}
    calls = [(f"{a}{n}", f"{b}{n + 1}") for n in range(59) for a in "xy" for b in "xy"]
    assert Depths(_graph(frames, calls), Rules()).depth("x0") == 960  # 2 ** 59 paths


def test_the_library_is_an_allowance_once_on_a_path() -> None:
    depths = Depths(_graph({"a": 10, "b": 20}, [("a", "b"), ("a", "memcpy"), ("b", "read")]), HOST)
    assert depths.depth("a") == 130
    assert depths.path("a")[-1].title == LIBRARY


def test_without_allowance_what_has_no_code_is_missing() -> None:
    found = _graph({"a": 10}, [("a", "memcpy"), ("a", "weak")])
    depths = Depths(found, Rules(linked=frozenset({"memcpy"})))
    assert depths.depth("a") == 10
    assert list(depths.problems) == [Missing("memcpy", "a")]


@pytest.mark.parametrize(
    ("calls", "cycle"),
    [
        ([("a", "a")], ("a", "a")),
        ([("a", "b"), ("b", "a")], ("a", "b", "a")),
        ([("a", "b"), ("b", "c"), ("c", "b")], ("b", "c", "b")),
        ([("a", "c"), ("a", "b"), ("b", "c"), ("c", "b")], ("b", "c", "b")),
    ],
)
def test_recursion_has_no_bound(calls: list[tuple[str, str]], cycle: tuple[str, ...]) -> None:
    for order in permutations(calls):
        depths = Depths(_graph({"a": 1, "b": 2, "c": 3}, order), Rules())
        depths.depth("a")
        assert list(depths.problems) == [Recursion(cycle, "a.adb:5:7")]


def test_what_no_task_calls_does_not_count() -> None:
    depths = Depths(_graph({"a": 1, "b": 2}, [("b", "b")]), Rules())
    assert depths.depth("a") == 1
    assert not depths.problems


def test_an_ending_that_fails_calls_itself_and_is_no_recursion() -> None:
    calls = [("a", "end"), ("end", "put"), ("put", "end"), ("a", "put")]
    found = _graph({"a": 1, "end": 20, "put": 300}, calls)
    depths = Depths(found, Rules(endings=frozenset({"end"})))
    assert depths.depth("a") == 621  # what fails is on the stack while the ending puts its text
    assert [one.title for one in depths.path("a")] == ["a", "put", "end", "put"]
    assert not depths.problems


def test_a_call_through_a_pointer_has_no_bound() -> None:
    found = _graph({"a": 10, "b": 500}, [("a", graph.INDIRECT)])
    depths = Depths(found, HOST)
    depths.depth("a")
    assert list(depths.problems) == [Indirect("a", "a.adb:5:7")]


def test_a_soft_link_of_what_gnat_adds_is_a_call_of_the_library() -> None:
    found = _graph({"a___finalization_controller.3": 10}, [])
    found["a___finalization_controller.3"].calls[graph.INDIRECT] = "a.adb:5:7"
    depths = Depths(found, HOST)
    assert depths.depth("a___finalization_controller.3") == 110
    assert not depths.problems


def test_a_pointer_whose_targets_are_known_is_followed() -> None:
    found = _graph({"a": 10, "x_E1s": 500, "x_B2s": 7}, [("a", graph.INDIRECT)])
    depths = Depths(found, Rules(pointers={"a": ("*_[BE][0-9]s",)}))
    assert depths.depth("a") == 510
    assert not depths.problems


def test_a_frame_of_dynamic_size_needs_a_bound() -> None:
    text = _unit(
        _node("a", 10),
        _node("b", 20, "dynamic,bounded"),
        _node("c.constprop.0", 40, "dynamic", "T a.adb:3:4"),
        _edge("a", "b"),
        _edge("a", "c.constprop.0"),
    )
    depths = Depths(graph.read([text]), Rules())
    depths.depth("a")
    assert list(depths.problems) == [Unbounded("c.constprop.0", "a.adb:1:1", ("T a.adb:3:4",))]
    known = Depths(graph.read([text]), Rules(bounds={"c": StackBound(1000, "measured")}))
    assert known.depth("a") == 1050
    assert not known.problems


def test_a_bound_covers_the_statements_that_a_compiler_sets_apart() -> None:
    """GNAT from 13 on puts the statements of a subprogram with a postcondition into one inside."""
    inside = "a__tick___wrapped_statements.2"
    text = _unit(
        _node("a__tick", 20, "dynamic", "T a.ads:3:4"),
        _node(f"a.adb:{inside}", 40, "dynamic", "T a.adb:3:4"),
        _edge("a__tick", f"a.adb:{inside}"),
    )
    depths = Depths(graph.read([text]), Rules(bounds={"a__tick": StackBound(100, "three copies")}))
    assert depths.depth("a__tick") == 20 + 100 + 40 + 100
    assert not depths.problems
    assert graph.ada_name(inside) == "A.Tick"


def test_a_function_that_calls_itself_can_have_a_bound() -> None:
    found = _graph({"a": 10, "b": 20, "c": 7}, [("a", "b"), ("b", "b"), ("b", "c")])
    depths = Depths(found, Rules(bounds={"b": StackBound(0, "once for each byte", depth=65)}))
    assert depths.depth("a") == 10 + 65 * 20 + 7
    assert not depths.problems
    found["c"].calls["b"] = "a.adb:6:6"  # in a circle with another one it has none
    wrong = Depths(found, Rules(bounds={"b": StackBound(0, "once for each byte", depth=65)}))
    wrong.depth("a")
    assert list(wrong.problems) == [Recursion(("b", "c", "b"), "a.adb:6:6")]


@pytest.mark.parametrize(
    ("symbol", "name"),
    [
        ("robot__control__processor__processorTKB", "Robot.Control.Processor.Processor"),
        ("robot__bus__controller__driver__readerTKBXnn", "Robot.Bus.Controller.Driver.Reader"),
        ("robot__joint_x__run_position_control", "Robot.Joint_X.Run_Position_Control"),
        ("robot__joint__fire__enter_idle.21", "Robot.Joint.Fire.Enter_Idle"),
        ("memcpy", "memcpy"),
    ],
)
def test_a_symbol_is_shown_as_ada_has_it(symbol: str, name: str) -> None:
    assert graph.ada_name(symbol) == name


CODE = """
0000000000001000 <start>:
    1000:\tstp\tx29, x30, [sp, #-48]!
    1004:\tsub\tsp, sp, #0x20
    1008:\tbl\t2000 <leaf>
    100c:\tcbz\tx0, 1010 <start+0x10>
    1010:\tadd\tsp, sp, #0x20
    1014:\tldp\tx29, x30, [sp], #48
    1018:\tb\t3000 <tail>

0000000000002000 <leaf>:
    2000:\tsub\tsp, sp, #0x1, lsl #12
    2004:\tblr\tx1
    2008:\tret

0000000000003000 <tail>:
    3000:\tsub\tsp, sp, x2
    3004:\tadr\tx1, 3010 <tail+0x10>
    3008:\tbr\tx1
"""


def test_frames_and_calls_of_a_library_are_read_in_its_code() -> None:
    found = machine.read(CODE.splitlines())
    assert (found["start"].size, set(found["start"].calls)) == (80, {"leaf", "tail"})
    assert (found["leaf"].size, set(found["leaf"].calls)) == (4096, {graph.INDIRECT})
    assert found["tail"].frame is graph.StackFrame.DYNAMIC
    assert not found["tail"].calls  # a table of jumps is no call


NM = """0000000000001000 0000000000000100 T sys__control__execute
0000000000001100 0000000000000040 t sys__codecs__pack
0000000000001140 0000000000000010 r memcpy_table
0000000000002000 0000000000000008 D sys__control__x
0000000000002000 0000000000000008 D sys__control__x_alias
0000000000002010 0000000000000200 b sys__control__task
                 U printf@GLIBC_2.2.5
"""
SIZES = """image :
section   size  addr
.text     400   4096
.rodata   32    4400
.data     16    8192
.bss      520   8208
.comment  99    0
Total     1067
"""


def test_memory_is_counted_by_parts_and_sums_up() -> None:
    sections = memory.sections(SIZES)
    found = memory.parts(
        symbols.read(NM), {"sys__": "rest", "sys__control__": "control", "sys__codecs__": "codecs"},
        sections,
    )  # fmt: skip
    assert {one.name: (one.flash, one.ram) for one in found} == {
        "control": (256 + 8, 512 + 8),
        "codecs": (64, 0),
        memory.LIBRARY: (16, 0),
        memory.REST: (400 + 32 + 16 - 344, 16 + 520 - 520),
    }
    flash, ram = memory.totals(sections)
    assert (flash, ram) == (448, 536)
    assert (sum(one.flash for one in found), sum(one.ram for one in found)) == (flash, ram)
