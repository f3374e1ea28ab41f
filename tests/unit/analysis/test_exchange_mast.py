# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""MAST: models are read and printed back, exported ones say the same, and bounds agree."""

from __future__ import annotations

import random
import re
from typing import Any

import pytest

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.tasks import TableRow, Task
from ravenchart.analysis.exchange import Unfit, mast
from ravenchart.analysis.exchange.mast_text import Attributes, MastObject, parse, printed_model
from tests.support.core_cases import REFERENCE, two_nodes
from tests.support.mast_models import by_kind, check_references, inner, number
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
    assert parse(printed_model(model)) == model


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
def test_the_exported_model_of_the_published_system_says_the_same() -> None:
    text = mast.export(two_nodes(), (), "two nodes")
    assert max(map(len, text.splitlines())) < 1_000
    ours, theirs = parse(text), parse(MODEL)
    check_references(theirs)
    check_references(ours)

    def essence(model: tuple[MastObject, ...]) -> Any:
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
        assert parse(printed_model(model)) == model
        written += 1
    assert written > 60


def test_names_are_in_quotes_so_that_none_is_a_keyword_of_mast() -> None:
    text = mast.export(Network((Task("offset", 1, 100, 100, 10, core="link"),)), (), "model")
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
    rows = (TableRow("r", 3), TableRow("s", 4, 2, 1))
    network = Network((Task("a", 1, 100, 100, 1, rows=rows),), platforms={"": Platform(release=2)})
    model = parse(mast.export(network, (), "x"))
    check_references(model)
    costs = [number(a, "Worst_Case_Execution_Time") for a in by_kind(model)["Operation"]]
    assert costs == [8.0, 2.0]


def test_our_bounds_of_the_published_system_are_those_of_mast() -> None:
    found = holistic.analyse(two_nodes())
    assert {name: found.from_event(name) for name in RESULTS} == RESULTS
