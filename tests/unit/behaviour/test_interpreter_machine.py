# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A whole system in virtual time: ports, queues, activities, processors."""

from __future__ import annotations

from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.gen.language.terms import Ns
from tests.support.interpreted import component_system, records, stimuli_of

LISTENER = """
ports:
  level: {{in: Small, {port}}}
port_region: {{period: 10 ms, wcet: 1 us}}
events: {{Came: {{type: Small}}, Old: {{}}, Lost: {{}}, Seen: {{}}}}
data: {{total: {{type: Small, initial: 0}}}}
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 8
    initial: S
    states: {{S: {{}}}}
    transitions:
      big: {{from: S, on: Came, guard: event > 4, effect: [{{set: total, to: event}}]}}
      small: {{from: S, on: Came, effect: [{{set: total, to: level}}]}}
      old: {{from: S, on: Old, guard: stale(level), effect: [{{raise: Seen}}]}}
      lost: {{from: S, on: Lost, effect: [{{raise: Seen}}]}}
"""
BUS = """
buses:
  can: {bit_rate: 500 kbit/s, driver_wcet: 1 us, receive_depth: 4, transmit_depth: 4}
messages:
  level_in: {bus: can, id: 0x100, to: unit.level, period: 10 ms}
processors:
  reception: {node: board, released_by: can, period: 10 ms, stack: 8 KiB,
              activities: [can.receive]}
  runner: {node: board, stack: 8 KiB, activities: [unit.ports, unit.Main]}
"""


def heard(port: str, events: str) -> list[str]:
    """What a listener does about values that are put into its port."""
    system = component_system(LISTENER.format(port=port), more=BUS)
    found = Machine(system).run(stimuli_of(events, system))
    return [f"{one.at // 10**6} {', '.join(one.behaviours)}" for one in found][1:]


def test_arrival_raises_its_event_with_the_value() -> None:
    events = """
    - {at: 5 ms, put: unit.level, value: 3}
    - {at: 15 ms, put: unit.level, value: 7}
    - {until: 50 ms}
    """
    assert heard("on_arrival: Came", events) == ["10 small.effect", "20 big.effect"]


def test_sampled_port_keeps_the_last_value_and_queued_all_it_can() -> None:
    events = """
    - {at: 5 ms, put: unit.level, value: 3}
    - {at: 5 ms, put: unit.level, value: 7}
    - {at: 5 ms, put: unit.level, value: 2}
    - {until: 50 ms}
    """
    queued = "kind: queued, depth: 2, on_arrival: Came"
    assert heard("on_arrival: Came", events) == ["10 small.effect"]
    assert heard(queued, events) == ["10 small.effect", "20 big.effect"]
    dropping = f"{queued}, overflow: drop_oldest, on_overflow: Lost"
    assert heard(dropping, events) == ["10 lost.effect", "20 big.effect", "30 small.effect"]


def test_value_becomes_stale_when_its_age_passes_the_limit() -> None:
    events = "[{at: 5 ms, put: unit.level, value: 3}, {until: 100 ms}]"
    assert heard("max_age: 30 ms, on_stale: Old", events) == ["50 old.effect"]
    assert heard("max_age: 30 ms, on_stale: Old", "[{until: 100 ms}]") == []


TALKERS = """
events: [Ping]
data: {mine: {type: Small, initial: 1}, both: {type: Pair, initial: {left: 1, right: 2}}}
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 2
    initial: A
    states: {A: {}, B: {}}
    transitions:
      go: {from: A, to: B, on: Ping, effect: [{set: both.left, to: 5}]}
      seen: {from: B, to: A, when: mine = 5}
  Other:
    period: 10 ms
    wcet: 1 us
    initial: X
    states: {X: {}, Y: {}}
    transitions:
      follow: {from: X, to: Y, when: in(Main.B) and both.right = 2}
activities:
  copy:
    period: 20 ms
    wcet: 1 us
    body: [{set: mine, to: both.left}]
  idle: {period: 20 ms, wcet: 1 us, raises: [Ping], body: user}
"""


def told(rows: str) -> list[str]:
    """The steps of the talkers after their start; Ping comes before 20 ms."""
    found = records(component_system(TALKERS, rows), "15 Ping", until=70)
    return [f"{one.at // 10**6} {one.region} {one.behaviours[0]}" for one in found if one.at]


def test_rows_run_in_table_order_and_see_what_was_published_before() -> None:
    assert told("[unit.Main, unit.Other, unit.copy, unit.idle]") == [
        "20 Main A.exit",
        "20 Other X.exit",
        "30 Main B.exit",
    ]
    assert told("[unit.Other, unit.copy, unit.idle, unit.Main]") == [
        "20 Main A.exit",
        "30 Other X.exit",
        "40 Main B.exit",
    ]


def test_higher_priority_runs_first_and_offsets_count() -> None:
    more = """
processors:
  late: {{node: board, stack: 8 KiB, priority: {late}, activities: [unit.Main]}}
  soon: {{node: board, stack: 8 KiB, priority: 2, offset: {offset},
         activities: [unit.Other, unit.copy, unit.idle]}}
"""

    def order(late: int, offset: str) -> list[str]:
        system = component_system(TALKERS, more=more.format(late=late, offset=offset))
        found = records(system, "15 Ping", until=50)
        return [f"{one.at / 10**6:g} {one.region}" for one in found]

    assert order(1, "0 ms")[:4] == ["0 Other", "0 Main", "20 Main", "30 Other"]
    assert order(3, "0 ms")[:4] == ["0 Main", "0 Other", "20 Main", "20 Other"]
    assert order(3, "2.5 ms")[:4] == ["0 Main", "2.5 Other", "20 Main", "22.5 Other"]


DOING = """
events: [Leave]
data: {count: {type: Small, initial: 0}}
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 2
    initial: Work
    states: {Work: {}, Rest: {}}
    transitions:
      finished: {from: Work, to: Rest}
      again: {from: Rest, to: Work, on: Leave}
activities:
  count_up:
    period: 10 ms
    wcet: 1 us
    while: Main.Work
    body:
      - {set: count, to: "if count < 3 then count + 1 else 0"}
      - {if: count = 2, then: [{raise: done}]}
"""


def test_do_activity_works_in_its_state_and_completes_it() -> None:
    system = component_system(DOING, "[unit.Main, unit.count_up]")
    found = [(one.at // 10**6, one.behaviours[0]) for one in records(system, "45 Leave", until=120)]
    # it has worked at 0, 10 and, from 50 ms on, at 50, 60, 70 and 80
    assert found == [(0, "Work.entry"), (20, "Work.exit"), (50, "Rest.exit"), (90, "Work.exit")]


def test_sent_values_arrive_at_the_connected_port() -> None:
    more = """
components:
  Teller:
    ports: {out_port: {out: Pair}}
    data: {n: {type: Small, initial: 0}}
    activities:
      tell:
        period: 10 ms
        wcet: 1 us
        body:
          - {set: n, to: "min(n + 1, 9)"}
          - {send: out_port, with: {left: n, right: 0}}
  Hearer:
    ports: {in_port: {in: Pair}}
    port_region: {period: 10 ms, wcet: 1 us}
    regions:
      Main:
        period: 10 ms
        wcet: 1 us
        initial: A
        states: {A: {}, B: {}}
        transitions:
          first: {from: A, to: B, when: fresh(in_port) and in_port.left = 3}
instances:
  source: {component: Teller, node: board}
  sink: {component: Hearer, node: board}
connections: [{from: source.out_port, to: sink.in_port}]
processors:
  runner: {node: board, stack: 8 KiB, activities: [sink.ports, sink.Main, source.tell]}
"""
    system = component_system("{}", more=more)
    found = list(Machine(system).run(stimuli_of("[{until: 60 ms}]", system)))
    assert [one.text() for one in found] == [
        "0.000 sink.Main: A.entry",
        "0.030 sink.Main: A.exit, first.effect, B.entry",
    ]


OVERFLOWING = """
events: [Ping, Full]
regions:
  Main:
    period: 10 ms
    wcet: 1 us
    queue: 1
    on_overflow: Full
    initial: A
    states: {A: {}}
    transitions:
      ping: {from: A, on: Ping, effect: [{raise: Ping}]}
  Other:
    period: 10 ms
    wcet: 1 us
    queue: 2
    initial: X
    states: {X: {}, Y: {}}
    transitions: {full: {from: X, to: Y, on: Full}}
"""


def test_a_lost_event_is_told_to_who_waits_for_it() -> None:
    system = component_system(OVERFLOWING, "[unit.Main, unit.Other]")
    found = [one.text() for one in records(system, "5 Ping", "5 Ping", until=10)][2:]
    assert found == [
        "0.010 unit.Main: ping.effect",
        "0.010 unit.Other: X.exit, full.effect, Y.entry",
    ]


def test_the_same_events_give_the_same_steps() -> None:
    system = component_system(TALKERS, "[unit.Main, unit.Other, unit.copy, unit.idle]")
    assert list(records(system, "15 Ping")) == list(records(system, "15 Ping"))
    assert all(one.at <= Ns(100 * 10**6) for one in records(system))
