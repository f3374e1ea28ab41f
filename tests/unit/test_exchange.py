"""MAST, Cheddar and pyCPA: what is written is well-formed, says the same, and is never unsafe."""

from __future__ import annotations

import random
import re
from dataclasses import replace
from typing import Any
from xml.etree import ElementTree as Xml

import pytest

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.bus import Bus, Errors, Frame
from ravenchart.analysis.core.chains import Chain, Hop, Step
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.tasks import Row, Task
from ravenchart.analysis.exchange import FORMATS, Unfit, cheddar, mast, pycpa
from ravenchart.analysis.exchange.mast_text import Attributes, Object, Value, parse, printed
from ravenchart.analysis.exchange.shapes import background, in_queues, spelled_out, unqueued
from tests.support.core_cases import REFERENCE, two_nodes
from tests.support.random_networks import random_network

MODEL = (REFERENCE / "two_nodes.mast").read_text(encoding="utf-8")

RESULTS = {
    "sense": 2_100,
    "frame_cmd": 2_640,
    "wheel": 3_350,
    "housekeeping": 3_960,
    "frame_hk": 4_500,
}
"""What MAST 1.7.0 says of two_nodes.mast, in us from the event."""


def by_kind(objects: tuple[Object, ...]) -> dict[str, list[Attributes]]:
    found: dict[str, list[Attributes]] = {}
    for one in objects:
        found.setdefault(one.kind, []).append(one.attributes)
    return found


def number(attributes: Attributes, name: str) -> float:
    return float(attributes.word(name))


def inner(value: Value | None) -> tuple[Attributes, ...]:
    assert isinstance(value, tuple)
    assert all(isinstance(one, Attributes) for one in value)
    return value  # type: ignore[return-value]


def words(attributes: Attributes, name: str) -> set[str]:
    """The words of a list; none where it is left out."""
    found = attributes.get(name) or ()
    assert isinstance(found, tuple)
    return {word for word in found if isinstance(word, str)}


# --- The text form --------------------------------------------------------------------


def test_the_published_model_is_read_and_printed_back() -> None:
    model = parse(MODEL)
    kinds = by_kind(model)
    assert {kind: len(some) for kind, some in kinds.items()} == {
        "Model": 1,
        "Processing_Resource": 3,
        "Scheduler": 3,
        "Scheduling_Server": 5,
        "Shared_Resource": 1,
        "Operation": 7,
        "Transaction": 2,
    }
    timer = kinds["Processing_Resource"][0].get("system_timer")
    assert isinstance(timer, Attributes)
    assert (timer.word("Type"), number(timer, "Period")) == ("Ticker", 1000.0)
    assert parse(printed(model)) == model


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Model (\n Name => x", "line 2: , expected|line 2: \\) expected, not the end"),
        ("Model (Name => x)", "; expected, not the end"),
        ("Model (Name => x, y);", "line 1: a list holds attributes and values"),
        ("Model x;", "attributes expected, not ;"),
        ("Model (Name => &);", "line 1: '&' has no meaning"),
        ("Model " + "(" * 99, "parentheses are nested too deeply"),
        ("=> ( a => b );", "a word expected, not =>"),
    ],
)
def test_what_is_no_model_is_refused_by_line(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        parse(text)


# --- MAST ------------------------------------------------------------------------------

#  What the text grammar of MAST 1.7 lets each kind of object have; not all of it.
KNOWN = {
    "Model": "Model_Name Model_Date System_PiP_Behaviour",
    "Processing_Resource": "Type Name Speed_Factor Worst_ISR_Switch System_Timer "
    "Max_Interrupt_Priority Min_Interrupt_Priority Transmission Throughput Max_Blocking "
    "Max_Packet_Size Min_Packet_Size",
    "Scheduler": "Type Name Host Policy",
    "Scheduling_Server": "Type Name Server_Sched_Parameters Scheduler",
    "Shared_Resource": "Type Name Ceiling Preassigned",
    "Operation": "Type Name Worst_Case_Execution_Time Best_Case_Execution_Time "
    "Shared_Resources_List Composite_Operation_List Max_Message_Size Avg_Message_Size "
    "Min_Message_Size",
    "Transaction": "Type Name External_Events Internal_Events Event_Handlers",
}


def check_references(model: tuple[Object, ...]) -> None:
    """Every attribute is known, every name is there once, and whatever is named is there."""
    kinds = by_kind(model)
    names = {
        kind: [a.word("Name") for a in some] for kind, some in kinds.items() if kind != "Model"
    }
    for kind, some in names.items():
        assert len({name.lower() for name in some}) == len(some)
        for attributes in kinds[kind]:
            assert {key for key, _ in attributes.pairs} <= set(KNOWN[kind].split())
    for scheduler in kinds["Scheduler"]:
        assert scheduler.word("Host") in names["Processing_Resource"]
    for server in kinds["Scheduling_Server"]:
        assert server.word("Scheduler") in names["Scheduler"]
    for operation in kinds["Operation"]:
        assert words(operation, "Shared_Resources_List") <= set(names.get("Shared_Resource", ()))
        assert words(operation, "Composite_Operation_List") <= set(names["Operation"])
    for transaction in kinds["Transaction"]:
        external = {e.word("Name") for e in inner(transaction.get("External_Events"))}
        internal = {e.word("Name") for e in inner(transaction.get("Internal_Events"))}
        made: set[str] = set()
        for handler in inner(transaction.get("Event_Handlers")):
            assert handler.word("Input_Event") in external | made
            if handler.word("Type") == "Multicast":
                made |= words(handler, "Output_Events_List")
                continue
            made.add(handler.word("Output_Event"))
            assert handler.word("Activity_Operation") in names["Operation"]
            assert handler.word("Activity_Server") in names["Scheduling_Server"]
        assert made == internal
        for event in inner(transaction.get("Internal_Events")):
            wanted = event.get("Timing_Requirements")
            if isinstance(wanted, Attributes):
                assert wanted.word("Referenced_Event") in external


def test_the_exported_model_of_the_published_system_says_the_same() -> None:
    text = mast.export(two_nodes(), (), "two nodes")
    assert max(map(len, text.splitlines())) < 1_000
    ours, theirs = parse(text), parse(MODEL)
    check_references(theirs)
    check_references(ours)

    def essence(model: tuple[Object, ...]) -> Any:
        kinds = by_kind(model)
        return (
            sorted(
                (a.get("Worst_Case_Execution_Time"), a.word("Type"))
                for a in kinds["Operation"]
                if a.word("Type") != "Message_Transmission"
            ),
            sorted(
                [h.word("Type") for h in inner(t.get("Event_Handlers"))]
                for t in kinds["Transaction"]
            ),
            sorted(
                (e.word("Type"), e.get("Period"), e.get("Max_Jitter"), e.get("Min_Interarrival"))
                for t in kinds["Transaction"]
                for e in inner(t.get("External_Events"))
            ),
            kinds["Processing_Resource"][0].get("System_Timer"),
            [a.word("Type") for a in kinds["Shared_Resource"]],
        )

    assert essence(ours) == essence(theirs)


def test_every_random_network_becomes_a_valid_model_that_reads_back() -> None:
    written = 0
    for seed in range(200):
        network = random_network(random.Random(seed))
        try:
            text = mast.export(network, (), f"n{seed}")
        except Unfit:
            continue
        model = parse(text)
        check_references(model)
        assert parse(printed(model)) == model
        written += 1
    assert written > 60


def test_names_are_in_quotes_so_that_none_is_a_keyword_of_mast() -> None:
    text = mast.export(Network((replace(TASK, name="offset", core="link"),)), (), "model")
    assert {'"model"', '"link"', '"link_scheduler"', '"offset_server"'} <= set(
        re.findall(r'=> ("\w+")', text)
    )
    assert not re.search(r"(Name|Host|Scheduler|Server|Operation|_Event) => [^\"\n]", text)


def test_priorities_ceilings_and_sections_keep_their_order() -> None:
    network = Network(
        (Task("a", -5, 100, 90, 10), Task("b", 7, 50, 50, 5), Task("c", 90, 30, 30, 3)),
        sections=(Section("o", "a", 2), Section("o", "b", 1)),
        ceilings={"o": 50},
    )
    kinds = by_kind(parse(mast.export(network, (), "x")))
    levels = [
        a.get("Server_Sched_Parameters").word("The_Priority")  # type: ignore[union-attr]
        for a in kinds["Scheduling_Server"]
    ]
    assert levels == ["1", "2", "4"]
    assert kinds["Shared_Resource"][0].word("Ceiling") == "3"


def test_several_followers_are_released_by_a_multicast() -> None:
    network = Network(
        (
            Task("a", 3, 100, 100, 5, core="p"),
            Task("b", 2, 100, 100, 5, core="p"),
            Task("c", 1, 100, 100, 5, core="p"),
        ),
        released_by={"b": "a", "c": "a"},
    )
    model = parse(mast.export(network, (), "x"))
    check_references(model)
    (transaction,) = by_kind(model)["Transaction"]
    handlers = [h.word("Type") for h in inner(transaction.get("Event_Handlers"))]
    assert handlers == ["Activity", "Multicast", "Activity", "Activity"]


def test_a_table_counts_as_its_sum_and_releases_as_interrupts() -> None:
    rows = (Row("r", 3), Row("s", 4, 2, 1))
    network = Network((Task("a", 1, 100, 100, 1, rows=rows),), platforms={"": Platform(release=2)})
    model = parse(mast.export(network, (), "x"))
    check_references(model)
    costs = [number(a, "Worst_Case_Execution_Time") for a in by_kind(model)["Operation"]]
    assert costs == [8.0, 2.0]


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
                *(replace(FRAME, name=n, rank=k, cost=600, queue="q") for k, n in enumerate("ab")),
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
            "Cheddar's integers hold no",
        ),
        (
            Network(
                (replace(TASK, name="_tick"), TASK),
                platforms={"": Platform(tick_period=50, tick_cost=1)},
            ),
            "cheddar pycpa",
            "overheads become tasks of their own, and two tasks or messages have the name _tick",
        ),
    ],
)
def test_what_a_format_cannot_say_is_refused(network: Network, tool: str, message: str) -> None:
    for name in tool.split() or FORMATS:
        with pytest.raises(Unfit, match=message):
            FORMATS[name](network, (), "x")


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
            replace(task, rows=(), cost=task.plain_cost, timed=chance.random() < 0.5)
            for task in network.tasks
        )
        platforms = {
            core: Platform(chance.randint(0, 2), chance.randint(0, 2), 50, chance.randint(0, 1))
            for core in {t.core for t in tasks}
        }
        network = replace(network, tasks=tasks, platforms=platforms)
        found, spelled = holistic.analyse(network), holistic.analyse(spelled_out(network))
        for name in found.responses:
            assert spelled.from_event(name) == found.from_event(name), (seed, name)


def test_without_queues_no_bound_is_smaller() -> None:
    """Frames of a queue stand alone, with more jitter."""
    compared = 0
    for seed in range(150):
        chance = random.Random(seed)
        network = random_network(chance)
        frames = {
            bus: tuple(replace(f, queue="p", best=chance.choice((0, f.cost))) for f in some)
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
    rows = (Row("r", 1), Row("s", 1, 2))
    network = replace(on_bus(Bus(1), *frames), tasks=(replace(TASK, rows=rows, name="t"),))
    chain = Chain("way", (Step("a", Hop.RELEASED), Step("t", Hop.QUEUED)))
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
    chain = Chain("x", (Step("model", Hop.RELEASED), Step("class", Hop.SAMPLED)))
    text = pycpa.export(Network(tasks), (chain,), "x")
    calls = run_script(text, monkeypatch)
    names = [c["args"][0] for name, c in calls if name == "Task"]
    assert sorted(names) == ["class_2", "model_2", "n_1_b_c"]
    assert any(name == "EffectChain" for name, _ in calls)


def test_our_bounds_of_the_published_system_are_those_of_mast() -> None:
    found = holistic.analyse(two_nodes())
    assert {name: found.from_event(name) for name in RESULTS} == RESULTS
