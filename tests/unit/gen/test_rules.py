# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules: what a valid model may do, and what is refused beside tests/bad_models."""

from __future__ import annotations

import pytest

from ravenchart.gen.language.terms import If, Literal, Name, Send, Set
from ravenchart.gen.model.component import Direction, PortKind
from ravenchart.gen.model.statechart import After, OnEvent, Overflow, TransitionKind
from ravenchart.gen.model.system import Work
from tests.support.pump import changed, codes, loaded, system_of

TELL = "          - {send: valve, with: {mode: wanted, level: level}}\n"
LOST = "          lost: {from: Filling, to: Idle, on: Lost}\n"
DATA = "      wanted: {type: Mode, initial: Off}\n"
SUBSTATES = "            initial: Slow\n            states: {Slow: {}, Fast: {}}\n"
STATES = "          Filling:\n            entry: [{set: wanted, to: Filling}]\n"


# --- Components ------------------------------------------------------------------


def test_component_has_its_parts_in_model_order() -> None:
    tank = system_of().components[0]
    assert [port.name for port in tank.ports] == ["level", "valve"]
    assert [port.direction for port in tank.ports] == [Direction.IN, Direction.OUT]
    region, activity = tank.regions[0], tank.activities[0]
    assert region.reads == ("level", "limit")
    assert region.writes == ("wanted",)
    assert activity.reads == ("wanted", "level")
    assert activity.sends == ("valve",)
    assert activity.timing.deadline == activity.timing.period == 20_000_000


def test_queued_port_keeps_what_it_was_given() -> None:
    port = (
        system_of(
            ("max_age: 100 ms, on_stale: Lost", "kind: queued, depth: 3, on_arrival: Lost"),
            ("{in: Level,", "{in: Level, overflow: drop_oldest,"),
        )
        .components[0]
        .port("level")
    )
    assert (port.kind, port.depth, port.overflow) == (PortKind.QUEUED, 3, Overflow.DROP_OLDEST)
    assert port.max_age is None


def test_delay_is_rounded_up_to_whole_executions() -> None:
    for delay, executions in (("1 ns", 1), ("10 ms", 1), ("10.1 ms", 2), ("1 s", 100)):
        region = system_of(
            (LOST, LOST + f"          late: {{from: Filling, to: Idle, after: {delay}}}\n")
        )
        trigger = region.components[0].regions[0].transitions[-1].trigger
        assert isinstance(trigger, After)
        assert trigger.executions == executions


def test_transition_without_target_is_internal() -> None:
    region = (
        system_of((LOST, LOST + "          stay: {from: Idle, on: Lost}\n"))
        .components[0]
        .regions[0]
    )
    stay = region.transitions[-1]
    assert (stay.kind, stay.source, stay.target) == (TransitionKind.INTERNAL, "Idle", "Idle")


def test_transition_to_its_source_is_external() -> None:
    region = (
        system_of((LOST, LOST + "          again: {from: Idle, to: Idle, on: Lost}\n"))
        .components[0]
        .regions[0]
    )
    assert region.transitions[-1].kind is TransitionKind.EXTERNAL


def test_states_stand_in_tree_order() -> None:
    region = (
        system_of(
            (
                STATES,
                STATES + SUBSTATES,
            ),
            (LOST, LOST + "          speed_up: {from: Slow, to: Fast, after: 1 s}\n"),
        )
        .components[0]
        .regions[0]
    )
    assert [
        (s.name, s.parent, s.regions[0].initial.target if s.regions else None)
        for s in region.states
    ] == [
        ("Idle", None, None),
        ("Filling", None, "Slow"),
        ("Slow", "Filling", None),
        ("Fast", "Filling", None),
    ]


def test_names_are_given_back_as_declared() -> None:
    region = (
        system_of(
            ("to: Idle, on: Lost}", "to: IDLE, on: LOST}"),
            ("set: wanted, to: Off", "set: Wanted, to: OFF"),
        )
        .components[0]
        .regions[0]
    )
    trigger = region.transitions[-1].trigger
    assert isinstance(trigger, OnEvent)
    assert (trigger.event, region.transitions[-1].target) == ("Lost", "Idle")
    action = region.states[0].entry[0]
    assert isinstance(action, Set)
    assert isinstance(action.value, Literal)
    assert (action.data, action.value.value) == ("wanted", "Off")


def test_record_may_be_sent_as_a_whole() -> None:
    system = system_of(
        (
            "      wanted: {type",
            "      last: {type: Report, initial: {level: 0, mode: Off}}\n      wanted: {type",
        ),
        (TELL, "          - {send: valve, with: last}\n"),
    )
    action = system.components[0].activities[0].flow
    assert action is not None and isinstance(action[0], Send)
    assert [field for field, _ in action[0].values] == ["mode", "level"]
    assert all(isinstance(value, Name) for _, value in action[0].values)
    assert system.components[0].data[0].initial == (("mode", "Off"), ("level", 0))


def test_if_has_both_branches() -> None:
    system = system_of(
        (TELL, f"          - if: level > 5\n            then:\n    {TELL}            else: []\n")
    )
    flow = system.components[0].activities[0].flow
    assert flow is not None and isinstance(flow[0], If)
    assert (len(flow[0].then), flow[0].otherwise) == (1, ())


def test_send_in_each_branch_is_one_send() -> None:
    branch = f"            then:\n    {TELL}            else:\n    {TELL}"
    assert codes((TELL, f"          - if: level > 5\n{branch}")) == []
    assert codes((TELL, f"          - if: level > 5\n{branch}{TELL}")) == ["RV-0413"]


def test_two_sends_in_an_activity_are_refused() -> None:
    assert codes((TELL, TELL + TELL)) == ["RV-0413"]


def test_two_sends_on_the_way_into_a_composite_are_refused() -> None:
    send = "[{send: valve, with: {mode: Off, level: 0}}]"
    inside = f"            initial: Slow\n            states: {{Slow: {{entry: {send}}}}}\n"
    outside = f"          Filling:\n            entry: {send}\n"
    assert codes((STATES, outside + inside)) == ["RV-0413", "RV-0611"]


def test_sends_in_exit_and_entry_of_one_transition_are_refused() -> None:
    send = "[{send: valve, with: {mode: Off, level: 0}}]"
    assert codes(
        ("            entry: [{set: wanted, to: Off}]\n", f"            exit: {send}\n"),
        ("            entry: [{set: wanted, to: Filling}]\n", f"            entry: {send}\n"),
        ("mode: wanted, level: level", "mode: Off, level: level"),
        (
            "      wanted: {type: Mode, initial: Off}\n",
            "      unused: {type: Mode, initial: Off}\n",
        ),
    ) == ["RV-0534", "RV-0413", "RV-0611"]


def test_state_left_by_a_transition_of_its_parent_is_reachable_from() -> None:
    assert (
        codes(
            (
                STATES,
                STATES + SUBSTATES,
            ),
            (LOST, LOST + "          speed_up: {from: Slow, to: Fast, after: 1 s}\n"),
        )
        == []
    )


def test_only_the_outermost_unreachable_state_is_named() -> None:
    nested = "          Deep:\n            initial: A\n            states: {A: {}, B: {}}\n"
    found = loaded(changed((STATES, STATES + nested))).diagnostics
    assert [item.code for item in found] == ["RV-0505"]
    assert "Deep" in found[0].message


def test_activity_may_not_be_named_like_the_port_region() -> None:
    assert "RV-0304" in codes(("      tell:\n", "      ports:\n"), ("north.tell", "north.ports"))


@pytest.mark.parametrize("key", ["on_deadline_miss", "on_overrun"])
def test_event_raised_by_a_processor_needs_no_other_source(key: str) -> None:
    assert codes(("events: [Lost]", "events: [Lost, Late]")) == ["RV-0509"]
    assert (
        codes(
            ("events: [Lost]", "events: [Lost, Late]"),
            (LOST, LOST + "          late: {from: Filling, to: Idle, on: Late}\n"),
            ("stack: 16 KiB,", f"stack: 16 KiB, {key}: [north.Late],"),
        )
        == []
    )


def test_event_raised_at_shutdown_needs_no_other_source() -> None:
    assert (
        codes(
            ("events: [Lost]", "events: [Lost, Stop]"),
            (LOST, LOST + "          stop: {from: Filling, to: Idle, on: Stop}\n"),
            ("\nprocessors:", "\nshutdown: {raises: [north.Stop], grace: 1 s}\n\nprocessors:"),
        )
        == []
    )


@pytest.mark.parametrize("inner", ["Filling", "filling", "FILLING"])
def test_state_that_is_its_own_initial_state_is_an_error_not_an_exception(inner: str) -> None:
    inside = f"            initial: {inner}\n            states: {{{inner}: {{}}}}\n"
    assert codes((STATES, STATES + inside))[0] == "RV-0303"
    own = f"            initial: {inner}\n            states: {{Slow: {{}}}}\n"
    assert codes((STATES, STATES + own)) == ["RV-0501"]


# --- Deployment ------------------------------------------------------------------


def test_parameter_of_an_instance_overrides_the_default() -> None:
    system = system_of(("node: board}\n\nmess", "node: board, parameters: {LIMIT: 5}}\n\nmess"))
    assert system.instances[0].parameters == (("limit", 5),)
    assert system_of().instances[0].parameters == (("limit", 900),)


@pytest.mark.parametrize(("given", "code"), [("limit: 1001", "RV-0312"), ("limt: 5", "RV-0305")])
def test_wrong_parameter_of_an_instance_is_refused(given: str, code: str) -> None:
    assert codes(("node: board}\n\nmess", f"node: board, parameters: {{{given}}}}}\n\nmess")) == [
        code
    ]


def test_signals_are_packed_in_field_order_from_bit_0() -> None:
    message = system_of().messages[1]
    assert [(s.field, s.start, s.width, s.offset) for s in message.signals] == [
        ("mode", 0, 1, 0),
        ("level", 1, 10, 0),
    ]
    assert message.length == 2


def test_single_value_takes_one_bit() -> None:
    message = system_of(("[0, 1000]", "[7, 7]"), ("default: 900", "default: 7")).messages[0]
    assert [(s.width, s.offset) for s in message.signals] == [(1, 7)]
    assert message.length == 1


def test_message_has_the_period_of_its_fastest_sender() -> None:
    assert system_of().messages[1].period == 20_000_000
    assert system_of().messages[0].period == 10_000_000


def test_identifiers_of_11_and_29_bits_do_not_meet() -> None:
    assert codes(("id: 0x101", "id: 0x100, extended: true")) == []


def test_message_may_have_several_receivers() -> None:
    system = system_of(
        ("  north: {component", "  south: {component: Tank, node: board}\n  north: {component"),
        ("to: north.level", "to: [north.level, south.level]"),
        (
            "from: north.valve}",
            "from: north.valve}\n  more: {bus: can_bus, id: 0x102, from: south.valve}",
        ),
        ("north.tell]", "north.tell, south.ports, south.Control, south.tell]"),
    )
    assert [str(end) for end in system.messages[0].targets] == ["north.level", "south.level"]


def test_reception_row_has_the_time_of_the_driver() -> None:
    slot = system_of().processors[0].slots[0]
    assert slot.work is Work.BUS_RECEIVE
    assert slot.element == "can_bus.receive"
    assert (slot.timing.period, slot.timing.wcet, slot.timing.deadline) == (
        1_000_000,
        20_000,
        1_000_000,
    )


def test_reception_without_messages_is_refused() -> None:
    assert "RV-0706" in codes(
        ("  level_in: {bus: can_bus, id: 0x100, to: north.level, period: 10 ms}\n", "")
    )


def test_period_of_a_processor_may_be_given_when_it_is_the_shortest() -> None:
    assert codes(("stack: 16 KiB,", "stack: 16 KiB, period: 10 ms,")) == []


def test_probe_that_takes_longer_than_its_period_is_refused() -> None:
    probe = "critical_section: 2 us, probe: {period: 1 ms, wcet: 2 ms}"
    assert codes(("critical_section: 2 us", probe)) == ["RV-0703"]
