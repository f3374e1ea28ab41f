# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands of tasks on other nodes: the messages that carry them, their chains and errors."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.present.report import render_report
from ravenchart.analysis.system.commands import command_times
from ravenchart.analysis.system.depths import depths
from ravenchart.analysis.system.timing import analyse
from ravenchart.gen.derive.completion import on_one_node, programs
from ravenchart.gen.diagnostics import render
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.commands import Remote, RemoteRead, Server
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.paths import ROOT
from tests.support.systems import stops_of

pytestmark = pytest.mark.clock

REQUESTS = ROOT / "tests" / "feature" / "requests" / "model.yaml"
MODEL = (ROOT / "tests" / "nodes" / "commands" / "model.yaml").read_text()
BUS = "  link: {bit_rate: 500 kbit/s, driver_wcet: 40 us, receive_depth: 8, transmit_depth: 8}\n"
RECEPTION = (
    "  reception: {released_by: link, period: 1 ms, stack: 32 KiB, activities: [link.receive]}\n"
)
TOGETHER = ("component: Mover, node: drive", "component: Mover, node: panel")


def _loaded(*replacements: tuple[str, str]) -> Loaded:
    text = MODEL
    for old, new in replacements:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return load(Path("model.yaml"), lambda path, limit: text.encode())


def _said(found: Loaded) -> str:
    return "\n".join(render(one, found.sources) for one in found.diagnostics)


def _system(*replacements: tuple[str, str]) -> System:
    found = _loaded(*replacements)
    assert found.system is not None, _said(found)
    return found.system


def _sources(system: System, node: str, unit: str) -> dict[str, str]:
    """The generated files of a unit and its children, without the folder of the node."""
    prefix = f"{node}/" if len(system.nodes) > 1 else ""
    files = generate(system, claims_of(analyse(system)))
    return {
        name.removeprefix(prefix): text
        for name, text in files.items()
        if name.startswith(f"{prefix}remote_requests-{unit}")
    }


def test_calls_have_the_period_of_their_caller_replies_and_reads_that_of_the_server() -> None:
    system = _system()
    assert [
        (m.name, str(m.source), [str(t) for t in m.targets], m.period) for m in system.messages
    ] == [
        ("boss_1_Set_Goal", "boss_1.Set_Goal", ["mover_1.Motion"], 20_000_000),
        ("boss_1_Home", "boss_1.Home", ["mover_1.Motion"], 20_000_000),
        ("boss_1_Home_Reply", "mover_1.boss_1_Home_Reply", ["boss_1.Home_Reply"], 10_000_000),
        ("boss_1_Get_Limit", "boss_1.Get_Limit", ["mover_1.Motion"], 20_000_000),
        (
            "boss_1_Get_Limit_Reply",
            "mover_1.boss_1_Get_Limit_Reply",
            ["boss_1.Get_Limit_Reply"],
            10_000_000,
        ),
        ("mover_1_Get_Place", "mover_1.Goal", ["boss_1.Get_Place"], 20_000_000),
    ]
    fields = {m.name: [(s.name, s.width) for s in m.signals] for m in system.messages}
    assert fields["boss_1_Home"] == [("number", 8)]
    assert fields["boss_1_Set_Goal"] == [("number", 8), ("value", 11)]


def test_a_reply_that_nobody_takes_does_not_travel_and_needs_no_limit() -> None:
    calm = (
        ("Get_Limit: {on_timeout: Alone}", "Get_Limit: {}"),
        ("when: Get_Limit_Reply = 1000", "after: 40 ms"),
        ("when: Get_Limit_Reply = 900", "after: 40 ms"),
        ('"min(Get_Limit_Reply, 900)"', "900"),
    )
    system = _system(*calm)
    assert "boss_1_Get_Limit_Reply" not in [m.name for m in system.messages]
    remote = system.bound["boss_1", "Get_Limit"].provider
    assert isinstance(remote, Remote)
    assert (remote.reply, remote.time_limit) == (None, 0)


def test_the_way_of_a_call_and_its_reply_is_a_chain_within_the_time_limit() -> None:
    system = _system()
    chain = next(chain for chain in system.chains if chain.name == "boss_1_Home")
    assert chain.reaction == 60_000_000
    assert chain.way == stops_of(
        "boss_1_Home",
        "mover_1.Motion",
        "mover_1.Serve",
        "mover_1.boss_1_Home_Reply",
        "boss_1_Home_Reply",
    )
    found = analyse(system)
    assert found.schedulable
    ((_, latency),) = [pair for pair in found.limited if pair[0].name == "boss_1_Home"]
    assert [hop.step.name for hop in latency.hops] == [
        "link.driver_tx.boss_1_Home",
        "link.boss_1_Home",
        "link.driver_rx.boss_1_Home",
        "link.boss_1_Home.reception",
        "mover_1.Serve",
        "link.driver_tx.boss_1_Home_Reply",
        "link.boss_1_Home_Reply",
        "link.driver_rx.boss_1_Home_Reply",
        "link.boss_1_Home_Reply.reception",
    ]
    #  at least the server's period, and it has to come before the caller gives up
    assert latency.reaction is not None
    assert 10_000_000 < latency.reaction <= 60_000_000


def test_a_time_limit_below_the_bound_is_an_error_with_both_figures() -> None:
    system = _system(("time_limit: 60 ms", "time_limit: 15 ms"))
    told = [one.message for one in findings(analyse(system))]
    assert "the reaction of boss_1_Home may take 20.8 ms; its limit is 15 ms" in told
    assert "the age of boss_1_Get_Place may take 26.1 ms; its limit is 15 ms" in told


@pytest.mark.parametrize(("limit", "executions"), [("60 ms", 3), ("61 ms", 4), ("20 ms", 1)])
def test_the_limit_is_counted_in_whole_executions_of_the_caller(
    limit: str, executions: int
) -> None:
    provider = _system(("time_limit: 60 ms", f"time_limit: {limit}")).bound["boss_1", "Home"]
    assert isinstance(provider.provider, Remote)
    assert provider.provider.executions == executions


def test_what_is_read_comes_to_all_readers_of_other_nodes_in_one_message() -> None:
    system = _system(*OTHERS)
    (message,) = [m for m in system.messages if m.every]
    assert (message.name, str(message.source)) == ("mover_1_Get_Place", "mover_1.Goal")
    assert [str(target) for target in message.targets] == ["boss_1.Get_Place", "boss_3.Get_Place"]
    assert isinstance(system.bound["boss_2", "Get_Place"].provider, Server)
    (chain,) = [chain for chain in system.chains if chain.name == "boss_3_Get_Place"]
    assert (chain.reaction, chain.age) == (None, 60_000_000)
    assert chain.way == stops_of("mover_1_Get_Place", "boss_3.Get_Place", "boss_3.Plan")


SERVED = "period: 10 ms\n        wcet: 200 us"
PLANNED = "period: 20 ms\n        wcet: 400 us"


@pytest.mark.parametrize(
    ("writer", "reader", "every"),
    [("10", "20", 2), ("10", "10", 1), ("20", "10", 1), ("5", "20", 4)],
)
def test_it_is_sent_as_often_as_its_fastest_reader_looks_or_its_writer_writes(
    writer: str, reader: str, every: int
) -> None:
    system = _system(
        (SERVED, SERVED.replace("10", writer)), (PLANNED, PLANNED.replace("20", reader))
    )
    (message,) = [m for m in system.messages if m.every]
    assert (message.every, message.period) == (every, every * int(writer) * 1_000_000)


LOOKING = """    activities:
      Look: {period: 40 ms, wcet: 50 us, reads: [Get_Place], writes: [Seen], body: user}
    data: {Seen: {type: Place, initial: 0}}
    regions:
"""


def test_the_fastest_row_that_reads_notices_that_nothing_came() -> None:
    looking = (("    regions:\n", LOOKING), ("boss_1.View]", "boss_1.View, boss_1.Look]"))
    provider = _system(*looking).bound["boss_1", "Get_Place"].provider
    assert isinstance(provider, RemoteRead)
    #  60 ms are three executions; a value may have come just before the first
    assert (provider.watcher, provider.executions) == ("Plan", 4)
    slow = (("when: Get_Place = 900", "after: 100 ms"), *looking)
    provider = _system(*slow).bound["boss_1", "Get_Place"].provider
    assert isinstance(provider, RemoteRead)
    assert (provider.watcher, provider.executions) == ("Look", 3)


def test_what_nobody_reads_does_not_travel_and_needs_no_limit() -> None:
    system = _system(("when: Get_Place = 900", "after: 100 ms"))
    assert not [m for m in system.messages if m.every]
    assert system.bound["boss_1", "Get_Place"].provider is None


def test_its_age_is_bounded_by_how_often_it_is_sent_and_read() -> None:
    found = analyse(_system())
    ((chain, latency),) = [pair for pair in found.limited if pair[0].name == "boss_1_Get_Place"]
    assert chain.age == 60_000_000
    assert [hop.step.name for hop in latency.hops] == [
        "link.driver_tx.mover_1_Get_Place",
        "link.mover_1_Get_Place",
        "link.driver_rx.mover_1_Get_Place",
        "link.mover_1_Get_Place.reception",
        "boss_1.Plan",
    ]
    #  a value is replaced by the next one after the period of the message
    assert latency.age is not None
    assert 20_000_000 < latency.age <= 60_000_000
    (read,) = [one for one in command_times(found) if one.command == "Get_Place"]
    assert (read.how, read.provider, read.waits) == ("over link", "mover_1.Goal", False)
    assert (read.answered, read.limit) == (latency.age, 60_000_000)


def test_requests_from_other_nodes_are_counted_in_the_queue_of_their_server() -> None:
    (one,) = [d for d in depths(analyse(_system())) if "mover_1.Motion" in d.what]
    #  one call each of the two with a reply, and of the third what comes in 14 ms
    assert (one.given, one.needed) == (4, 3)
    short = analyse(_system(("queue: 4\n        served_by", "queue: 2\n        served_by")))
    assert [d.needed for d in depths(short) if not d.holds] == [3]


def _waiting(*replacements: tuple[str, str]) -> list[tuple[int, int | None]]:
    queues = depths(analyse(_system(*replacements)))
    return [(d.given, d.needed) for d in queues if "mover_1.Motion" in d.what]


def test_requests_of_the_own_node_are_counted_unless_a_caller_says_what_becomes_of_them() -> None:
    calm = ("on_reply: Homed, on_full: Hasty, on_timeout", "on_reply: Homed, on_timeout")
    hasty = (("on: Hasty", "after: 40 ms"), ("Hasty: {}, ", ""))
    #  the server's period is half of the caller's: of each of three commands one call waits
    assert _waiting(TOGETHER, calm, *hasty) == [(4, 3)]
    assert _waiting(TOGETHER) == []


def test_where_other_nodes_call_a_full_queue_is_an_error_whatever_a_near_caller_says() -> None:
    ((given, needed),) = _waiting(*OTHERS)
    #  three of boss_2, whose `Home` has an `on_full`; of two others four, `Set_Goal` twice
    assert (given, needed) == (16, 11)
    few = ("queue: 16\n        served", "queue: 8\n        served")
    told = [
        one.message for one in findings(analyse(_system(*OTHERS[:-1], (OTHERS[-1][0], few[1]))))
    ]
    assert [text for text in told if "up to 11 requests may wait in mover_1.Motion," in text]


@pytest.mark.slow
def test_the_report_says_of_each_command_how_it_is_provided_and_when_it_is_done() -> None:
    found = analyse(_system(*OTHERS))
    told = {(one.caller, one.command): one for one in command_times(found)}
    assert [told[f"boss_{n}.Plan", "Home"].how for n in (1, 2, 3)] == [
        "over link",
        "queued",
        "over link",
    ]
    near, far = told["boss_2.Plan", "Home"], told["boss_1.Plan", "Home"]
    assert (near.answered, near.limit, far.limit) == (None, None, 60_000_000)
    assert near.executed is not None
    assert far.executed is not None
    assert far.answered is not None
    #  the server's period, then the frames of both ways besides
    assert 10_000_000 < near.executed < far.executed < far.answered < 60_000_000
    assert "<td>boss_1.Plan</td><td>Home</td>" in render_report(found)
    local = load(REQUESTS)
    assert local.system is not None
    direct = {one.command: one for one in command_times(analyse(local.system))}
    assert (direct["Reset"].how, direct["Reset"].wcet) == ("direct", 4_000)
    assert (direct["Get_Place"].how, direct["Get_Place"].provider) == ("copied", "mover_1.Now")


def test_one_line_puts_both_on_one_node_and_no_component_changes() -> None:
    apart, together = _system(), _system(TOGETHER)
    assert not together.messages
    assert isinstance(together.bound["boss_1", "Home"].provider, Server)
    home = {"boss-": "panel", "boss.": "panel", "mover-": "drive", "mover.": "drive"}
    for unit, node in home.items():
        found = _sources(apart, node, unit)
        assert found
        assert found == _sources(together, "panel", unit)


def test_what_no_classic_frame_can_carry_is_can_fd_where_the_bus_has_a_rate() -> None:
    rate = (BUS, BUS.replace("500 kbit/s,", "500 kbit/s, data_rate: 2 Mbit/s,"))
    system = _system(("range: [-1000, 1000]", f"range: {WIDE}"), rate)
    assert {m.name: (m.fd, m.length) for m in system.messages} == {
        "boss_1_Set_Goal": (True, 12),
        "boss_1_Home": (False, 1),
        "boss_1_Home_Reply": (False, 2),
        "boss_1_Get_Limit": (False, 2),
        "boss_1_Get_Limit_Reply": (True, 12),
        "mover_1_Get_Place": (False, 8),
    }
    for made in programs(system):
        assert all(line.takes_fd for line in made.buses)


def test_each_node_has_its_program_and_the_objects_of_its_side() -> None:
    panel, drive = programs(_system())
    assert panel.object("boss_1.Home.call").users == ("planning", "reception_panel")
    assert panel.object("boss_1.Get_Place.read").users == ("planning", "reception_panel")
    assert drive.object("mover_1.Motion.queue").users == ("reception_drive", "moving")
    assert not drive.has_object("boss_1.Home.call")


OTHERS = (
    ("  drive: {", "  desk: {context_switch: 10 us, critical_section: 5 us}\n  drive: {"),
    ("  mover_1: {", "  boss_2: {component: Boss, node: drive}\n"
     "  boss_3: {component: Boss, node: desk}\n  mover_1: {"),
    ("  - {from: boss_1", "  - {from: boss_2.Motion, to: mover_1.Motion}\n"
     "  - {from: boss_3.Motion, to: mover_1.Motion, time_limit: 60 ms}\n  - {from: boss_1"),
    ("  planning:", "  planning_2: {stack: 32 KiB, activities: [boss_2.Plan, boss_2.View]}\n"
     "  planning_3: {stack: 32 KiB, activities: [boss_3.Plan, boss_3.View]}\n  planning:"),
    ("queue: 4\n        served", "queue: 16\n        served"),
)  # fmt: skip


def test_a_reply_goes_to_whoever_called_from_whichever_node() -> None:
    system = _system(*OTHERS)
    assert [part.nodes[0].name for part in programs(system)] == ["panel", "desk", "drive"]
    text = _sources(system, "drive", "mover_1.adb")["remote_requests-mover_1.adb"]
    for test, then in (
        ("= 1", "Boss_2.Take_Home (Home_Reply)"),
        ("= 2", "Boss_2.Take_Get_Limit (Get_Limit_Reply)"),
        ("in 259 .. 514", "Link.Send_Boss_1_Home_Reply\n"),
        ("in 1_027 .. 1_282", "Link.Send_Boss_3_Home_Reply\n"),
    ):
        assert re.search(rf"if Asked.Caller {test} then\n +{re.escape(then)}", text), then


def test_in_a_simulation_the_server_is_local() -> None:
    one = on_one_node(_system())
    assert isinstance(one.bound["boss_1", "Home"].provider, Server)


LONG = "Boss_that_lives_in_the_house_on_the_hill_beside_the_sea_1"
WIDE = "[-1000000000000000000, 1000000000000000000]"


PROVIDED = """    provides:
      Orders: {queue: 2, served_by: Obey, commands: [Home]}
    requires:
"""
OBEY = """    activities:
      Obey: {period: 20 ms, wcet: 100 us, calls: [Set_Goal], body: user}
    regions:
"""


@pytest.mark.parametrize(
    ("replacements", "message"),
    [
        ([(", time_limit: 60 ms", "")], "boss_1.Home has its replies from drive"),
        (
            [
                (", time_limit: 60 ms", ""),
                ("Home: {on_reply: Homed, on_full: Hasty, on_timeout: Alone}", "Home: {}"),
                ("{call: Get_Limit, with: High}", "{call: Set_Goal, with: 1}"),
                ("{call: Get_Limit, with: Low}", "{call: Set_Goal, with: 2}"),
                ("Get_Limit: {on_timeout: Alone}", "Get_Limit: {}"),
                ("when: Get_Limit_Reply = 1000", "after: 40 ms"),
                ("when: Get_Limit_Reply = 900", "after: 40 ms"),
                ('"min(Get_Limit_Reply, 900)"', "900"),
                (
                    "on: Homed, guard: event = Well}\n          known",
                    "after: 60 ms}\n          known",
                ),
            ],
            "boss_1.Get_Place is read from drive: the binding needs the key `time_limit`",
        ),
        (
            [("reads: [Goal]\n        writes: [Goal]", "reads: [Goal]")],
            "which provides it, on drive; nothing writes Goal, so nothing sends it",
        ),
        (
            [("types:\n", "types:\n  mover_1_Get_Place: {range: [0, 1]}\n")],
            "boss_1.Get_Place is carried as `mover_1_Get_Place`, and the model has that name",
        ),
        (
            [("Get_Place: {on_timeout: Blind}", "Get_Place: {on_full: Blind}")],
            "`on_full` has no meaning for Get_Place, which is read",
        ),
        (
            [(f"buses:\n{BUS}", ""), (RECEPTION, "")],
            "declare a bus: between nodes, calls travel as its messages",
        ),
        (
            [("range: [-1000, 1000]", f"range: {WIDE}")],
            "boss_1_Set_Goal needs 69 bits for boss_1_Set_Goal_Call; a frame has 64",
        ),
        (
            [("types:\n", "types:\n  boss_1_Home_Call: {range: [0, 1]}\n")],
            "boss_1.Home is carried as `boss_1_Home_Call`, and the model has that name",
        ),
        (
            [
                ("  boss_1: {comp", f"  {LONG}: {{comp"),
                ("from: boss_1", f"from: {LONG}"),
                ("boss_1.Plan, boss_1.View", f"{LONG}.Plan, {LONG}.View"),
            ],
            "a name has at most 60 characters",
        ),
        (
            [("queue: 4\n        initial", "queue: 4\n        steps: 2\n        initial")],
            "so boss_1_Home may be sent more often than once in its period",
        ),
        (
            [
                ("    requires:\n", PROVIDED),
                ("    regions:\n", OBEY),
                ("[boss_1.Plan, boss_1.View]", "[boss_1.Plan, boss_1.View, boss_1.Obey]"),
            ],
            "Obey serves up to 2 requests in one execution, so boss_1_Set_Goal may be sent more",
        ),
        (
            [("on_full: Hasty, on_timeout: Alone", "on_full: Hasty, on_timeout: Homed")],
            "`on_timeout` of Home gives no value",
        ),
        (
            [("Set_Goal: {}", "Set_Goal: {on_timeout: Alone}")],
            "`on_timeout` has no meaning for Set_Goal",
        ),
    ],
)
def test_what_cannot_be_is_refused(replacements: list[tuple[str, str]], message: str) -> None:
    found = _loaded(*replacements)
    assert found.system is None
    assert message in _said(found)
