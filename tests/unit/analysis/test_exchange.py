# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Cheddar and pyCPA, and what no format can say: what is written is never unsafe."""

from __future__ import annotations

import random
from dataclasses import replace
from typing import Any
from xml.etree import ElementTree as Xml

import pytest

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.bus import Bus, Errors, Frame
from ravenchart.analysis.core.chains import ChainStep, HopKind, TimedChain
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.tasks import TableRow, Task
from ravenchart.analysis.exchange import FORMATS, Unfit, cheddar, mast, pycpa
from ravenchart.analysis.exchange.mast_text import parse
from ravenchart.analysis.exchange.shapes import background, in_queues, spelled_out, unqueued
from tests.support.core_cases import two_nodes
from tests.support.mast_models import by_kind, check_references, inner
from tests.support.random_networks import random_network

FRAME = Frame("m", 1, 1_000, 1_000, 100)
TASK = Task("a", 1, 100, 100, 10)


def on_bus(bus: Bus, *frames: Frame) -> Network:
    return Network((), {"can": frames}, {"can": bus})


@pytest.mark.parametrize(
    ("network", "tool", "message"),
    [
        (
            Network((), {"can": (FRAME,)}, {"can": Bus(1, errors=Errors(99))}),
            "",
            "no errors on a bus",
        ),
        (
            on_bus(
                Bus(1),
                *(
                    replace(FRAME, name=n, rank=k, transmission_time=600, queue="q")
                    for k, n in enumerate("ab")
                ),
            ),
            "",
            "a has no bound in its queue, so there is none",
        ),
        (Network((replace(TASK, period=2**60),)), "mast", "104 days"),
        (Network((TASK,), sections=(Section("o", "main", 5),)), "mast", "no task uses o"),
        (
            Network((TASK, replace(TASK, name="b", jitter=3)), released_by={"b": "a"}),
            "mast pycpa",
            "no jitter of what is released by another: b",
        ),
        (on_bus(Bus(1, 50), FRAME), "pycpa", "unknown ones of bus can"),
        (
            Network((TASK, replace(TASK, name="b", period=2**60))),
            "cheddar",
            "Cheddar's integers cannot hold both",
        ),
        (
            Network(
                (replace(TASK, name="_tick"), TASK),
                platforms={"": Platform(tick_period=50, tick_wcet=1)},
            ),
            "cheddar pycpa",
            "overheads become tasks of their own, and two tasks or messages have the name _tick",
        ),
        (
            Network((replace(TASK, held=3),)),
            "mast",
            f"MAST computes blocking itself: give sections for task {TASK.name}",
        ),
    ],
)
def test_what_a_format_cannot_say_is_refused(network: Network, tool: str, message: str) -> None:
    for name in tool.split() or FORMATS:
        with pytest.raises(Unfit, match=message):
            FORMATS[name](network, (), "x")


def test_offsets_from_several_epochs_are_left_out_and_named() -> None:
    tasks = replace(TASK, offset=3), replace(TASK, name="b", offset=4, epoch="x")
    for name in ("mast", "cheddar"):
        text = FORMATS[name](Network(tasks), (), "x")
        assert "Left out: offsets on the core, which count from several epochs." in text
        free = FORMATS[name](Network(tuple(task.at_any_time() for task in tasks)), (), "x")
        assert [n for n in text.splitlines() if "several epochs" not in n] == free.splitlines()
    assert "Phase" in FORMATS["mast"](Network(tasks[:1]), (), "x")


# --- Cheddar ----------------------------------------------------------------------------


def cheddar_tasks(network: Network) -> dict[str, dict[str, str]]:
    root = Xml.fromstring(cheddar.export(network, (), "x"))
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(set(ids)) == len(ids)
    assert {e.get("ref") for e in root.iter("core")} == {
        e.get("id") for e in root.iter("core_unit")
    }
    places = {e.findtext("name") for e in root.iter("mono_core_processor")}
    spaces = {e.findtext("name") for e in root.iter("address_space")}
    found = {}
    for element in root.iter("periodic_task"):
        assert element.findtext("cpu_name") in places
        assert element.findtext("address_space_name") in spaces
        found[element.findtext("name") or ""] = {child.tag: child.text or "" for child in element}
    return found


def test_cheddar_gets_overheads_blocking_and_inherited_jitter() -> None:
    found = cheddar_tasks(two_nodes())
    columns = ("capacity", "period", "jitter", "blocking_time", "priority")
    shown = {name: tuple(int(task[c]) for c in columns) for name, task in found.items()}
    assert shown == {
        "sense": (91, 1_000, 105, 12, 2),
        "housekeeping": (301, 10_000, 0, 0, 1),
        "obc_tick": (1, 100, 0, 0, 3),
        "wheel": (71, 1_000, 264, 0, 1),
        "frame_cmd": (27, 1_000, 210, 27, 2),
        "frame_hk": (27, 10_000, 396, 0, 1),
    }


def test_cheddar_rounds_to_the_safe_side_where_it_must() -> None:
    tasks = (
        Task("a", 2, 10**9 + 7, 10**9 + 7, 10**8 + 1, jitter=11),
        Task("b", 1, 10**10 + 19, 10**10 + 19, 3),
    )
    found = cheddar_tasks(Network(tasks))
    assert {c: found["a"][c] for c in ("period", "deadline", "capacity", "jitter")} == {
        "period": str((10**9 + 7) // 5),
        "deadline": str((10**9 + 7) // 5),
        "capacity": str(10**8 // 5 + 1),
        "jitter": "3",
    }
    assert (found["b"]["capacity"], found["b"]["period"]) == ("1", str((10**10 + 19) // 5))
    apart = cheddar_tasks(Network((replace(tasks[0], offset=5), replace(tasks[1], offset=0))))
    assert apart["a"]["start_time"] == "0"


def test_offsets_are_start_times_and_phases_and_stand_in_the_head() -> None:
    tasks = Task("a", 2, 100, 100, 40, offset=0), Task("b", 1, 100, 100, 30, offset=50)
    network = Network((*tasks, Task("c", 0, 100, 100, 10)))
    start = {name: task["start_time"] for name, task in cheddar_tasks(network).items()}
    assert start == {"a": "0", "b": "5", "c": "0"}
    for name, export in FORMATS.items():
        assert "Offsets: bounds that make no use of them hold for any." in export(network, (), "x")
        blind = Network(tuple(replace(task, offset=None) for task in network.tasks))
        assert "Offsets" not in export(blind, (), "x"), name
    events = [
        inner(transaction.get("External_Events"))[0]
        for transaction in by_kind(parse(mast.export(network, (), "x")))["Transaction"]
    ]
    assert [event.get("Phase") for event in events] == [None, "50.0", None]


def test_what_is_spelled_out_has_the_same_bounds() -> None:
    """Overheads as costs and tasks; a table is left out, whose sum may be worse."""
    for seed in range(60):
        chance = random.Random(seed)
        network = random_network(chance)
        tasks = tuple(
            replace(task, rows=(), wcet=task.plain_wcet, timed=chance.random() < 0.5)
            for task in network.tasks
        )
        platforms = {
            core: Platform(chance.randint(0, 2), chance.randint(0, 2), 50, chance.randint(0, 1))
            for core in {t.core for t in tasks}
        }
        network = replace(network, tasks=tasks, platforms=platforms)
        found, spelled = (
            holistic.analyse(network),
            holistic.analyse(spelled_out(network)),
        )
        for name in found.responses:
            assert spelled.from_event(name) == found.from_event(name), (seed, name)


def test_without_queues_no_bound_is_smaller() -> None:
    """Frames of a queue stand alone, with more jitter."""
    compared = 0
    for seed in range(150):
        chance = random.Random(seed)
        network = random_network(chance)
        frames = {
            bus: tuple(
                replace(f, queue="p", best=chance.choice((0, f.transmission_time))) for f in some
            )
            for bus, some in network.frames.items()
        }
        network = replace(network, frames=frames)
        if len(in_queues(network)) < 2:
            continue
        try:
            told = unqueued(network)
        except Unfit:
            continue
        assert not any(frame.queue for some in told.frames.values() for frame in some)
        found, other = holistic.analyse(network), holistic.analyse(told)
        for name in found.responses:
            less, more = found.from_event(name), other.from_event(name)
            later = found.deadline(name) - other.deadline(name)
            if more is not None:
                assert less is not None and less <= more + later, (seed, name)
        compared += 1
    assert compared > 20


def test_a_frame_alone_in_its_queue_stays_where_it_is() -> None:
    network = on_bus(Bus(1), replace(FRAME, queue="q"), replace(FRAME, name="n", rank=2))
    assert unqueued(network) == on_bus(Bus(1), FRAME, replace(FRAME, name="n", rank=2))


def test_a_user_that_is_no_task_becomes_one_below_all_with_the_same_blocking() -> None:
    network = Network(
        (replace(TASK, core="p"), replace(TASK, name="b", core="q")),
        sections=(Section("o", "main", 5), Section("o", "a", 2), Section("n", "main", 3),
                  Section("n", "b", 1)),
    )  # fmt: skip
    found, told = holistic.analyse(network), holistic.analyse(background(network))
    for name in ("a", "b"):
        assert told.from_event(name) == found.from_event(name)
    model = parse(mast.export(network, (), "x"))
    check_references(model)
    servers = [a.word("Name") for a in by_kind(model)["Scheduling_Server"]]
    assert {"main_on_p_server", "main_on_q_server"} <= set(servers)


def test_what_is_said_in_other_words_stands_in_the_head() -> None:
    frames = [replace(FRAME, name=n, rank=k, queue="q") for k, n in enumerate("ab")]
    rows = (TableRow("r", 1), TableRow("s", 1, 2))
    network = replace(on_bus(Bus(1), *frames), tasks=(replace(TASK, rows=rows, name="t"),))
    chain = TimedChain("way", (ChainStep("a", HopKind.RELEASED), ChainStep("t", HopKind.QUEUED)))
    for name, export in FORMATS.items():
        text = export(network, (chain,), "x")
        assert "Of table t every row counts in every job." in text, name
        assert "b shares a first-in first-out queue" in text, name
        assert "Left out: chain way, through a, t." in text, name
        assert ("the last bit before a transmission" in text) == (name != "cheddar"), name


# --- pyCPA -------------------------------------------------------------------------------


class Recorder:
    """Stands in for pyCPA's modules: it runs the script and notes what is built."""

    def __init__(self) -> None:
        self.calls: list[tuple[str, dict[str, Any]]] = []

    def __getattr__(self, name: str) -> Any:
        def called(*args: Any, **named: Any) -> Recorder:
            self.calls.append((name, {"args": args, **named}))
            return self

        return called


def run_script(text: str, monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, dict[str, Any]]]:
    recorder = Recorder()
    package = type("pycpa", (), {"analysis": recorder, "model": recorder, "options": recorder})
    package.schedulers = type("s", (), {"SPPScheduler": object, "SPNPScheduler": dict})  # type: ignore[attr-defined]
    monkeypatch.setitem(__import__("sys").modules, "pycpa", package)
    exec(compile(text, "script.py", "exec"), {"__name__": "script"})
    return recorder.calls


def test_the_script_builds_the_system(monkeypatch: pytest.MonkeyPatch) -> None:
    """pyCPA 1.2 (IDA-TUBS/pycpa) runs this script and prints the bounds less the jitter:
    sense 1050, housekeeping 3960, wheel 710, both frames 540 (us)."""
    calls = run_script(pycpa.export(two_nodes(), (), "two nodes"), monkeypatch)
    tasks = {c["args"][0]: c for name, c in calls if name == "Task"}
    assert {n: (t["wcet"], t["scheduling_parameter"]) for n, t in tasks.items()} == {
        "obc_tick": (10, 1),
        "sense": (910, 2),
        "housekeeping": (3_010, 3),
        "wheel": (710, 1),
        "frame_cmd": (270, 1),
        "frame_hk": (270, 2),
    }
    events = [(c["P"], c["J"]) for name, c in calls if name == "PJdEventModel"]
    assert events == [(10_000, 1_050), (100_000, 0), (1_000, 0)]
    assert sum(name == "link_dependent_task" for name, _ in calls) == 3


def test_names_that_mean_something_to_the_script_are_changed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tasks = (Task("model", 1, 10, 10, 1), Task("class", 2, 10, 10, 1), Task("1 b-c", 3, 10, 10, 1))
    chain = TimedChain(
        "x", (ChainStep("model", HopKind.RELEASED), ChainStep("class", HopKind.SAMPLED))
    )
    text = pycpa.export(Network(tasks), (chain,), "x")
    calls = run_script(text, monkeypatch)
    names = [c["args"][0] for name, c in calls if name == "Task"]
    assert sorted(names) == ["class_2", "model_2", "n_1_b_c"]
    assert any(name == "EffectChain" for name, _ in calls)
