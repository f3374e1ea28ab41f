# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Models in MAST's text form: their objects by kind, and what these refer to."""

from __future__ import annotations

from ravenchart.analysis.exchange.mast_text import Attributes, MastObject, Value


def by_kind(objects: tuple[MastObject, ...]) -> dict[str, list[Attributes]]:
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


def check_references(model: tuple[MastObject, ...]) -> None:
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
