# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A message whose period is only a least distance: what is bounded, and what is not."""

from __future__ import annotations

import random
import re
from dataclasses import replace
from itertools import accumulate
from pathlib import Path

import pytest

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.bus import Bus, Frame
from ravenchart.analysis.core.chains import ChainStep, HopKind, Latency, TimedChain, latency
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.tasks import Task
from ravenchart.analysis.exchange import cheddar, mast, pycpa
from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.plain.build import PlainSystem, load_plain
from ravenchart.analysis.plain.results import analyse_plain
from ravenchart.analysis.simulation.engine import simulate
from ravenchart.analysis.simulation.phases import Phase, PhaseScenario
from tests.support.certificates import certificate, compiled
from tests.support.timing_models import QUEUE, analysed

RELEASED, SAMPLED, QUEUED = HopKind.RELEASED, HopKind.SAMPLED, HopKind.QUEUED


def network(*, sporadic: bool) -> Network:
    """A command on a busy bus, a reader of its last value, and one that takes each."""
    return Network(
        tasks=(
            Task("act", 1, 30, 30, 4, core="a"),
            Task("other", 2, 11, 11, 3, core="a"),
            Task("hear", 3, 100, 100, 2, core="a"),
        ),
        frames={
            "bus": (
                Frame("noise", 1, 20, 20, 7),
                Frame("command", 2, 100, 100, 5, sporadic=sporadic),
            )
        },
        buses={"bus": Bus(1)},
        released_by={"hear": "command"},
    )


def of(system: Network, *steps: tuple[str, HopKind]) -> Latency:
    chain = TimedChain("chain", tuple(ChainStep(name, hop) for name, hop in steps))
    return latency(chain, system, holistic.analyse(system))


HEARD = (("command", RELEASED), ("hear", RELEASED), ("act", SAMPLED))
FETCHED = (("command", SAMPLED), *HEARD[1:])


def seen(chance: random.Random, longer: int) -> tuple[int, int, int]:
    """Reaction to a command, reaction to an input that a command samples, and age, in a run.

    The command comes up to ``longer`` ticks later than after its period.
    """
    system = network(sporadic=True)
    more = [chance.randint(0, longer) for _ in range(60)]
    phases = {
        "command": Phase(chance.randrange(100), more=lambda k: more[k]),
        "noise": Phase(chance.randrange(20)),
        "act": Phase(chance.randrange(30)),
        "other": Phase(chance.randrange(11)),
    }
    events = list(accumulate((100 + m for m in more[:30]), initial=phases["command"].first))
    ran = simulate(system, PhaseScenario(phases), events[-1], record=True)
    heard = {s.number: s.end for s in ran.stretches if s.name == "hear"}
    begun: dict[int, int] = {}
    ended: dict[int, int] = {}
    for stretch in ran.stretches:
        if stretch.name == "act":
            begun.setdefault(stretch.number, stretch.start)
            ended[stretch.number] = stretch.end
    reactions, fetched, ages = [0], [0], [0]
    for number in sorted(set(begun) & set(ended)):
        last = max((k for k, end in heard.items() if end <= begun[number]), default=None)
        if last is not None:
            ages.append(ended[number] - events[last])
    for k, end in heard.items():
        first = min((n for n in begun if begun[n] >= end), default=None)
        if first is not None:
            reactions.append(ended[first] - events[k])
            if k:
                fetched.append(ended[first] - events[k - 1] - 1)
    return max(reactions), max(fetched), max(ages)


@pytest.mark.slow
@pytest.mark.parametrize("longer", [0, 40, 400])
def test_a_simulation_keeps_the_reaction_and_only_exact_periods_keep_the_age(longer: int) -> None:
    chance = random.Random(longer)
    runs = [seen(chance, longer) for _ in range(40)]
    reaction, fetched, age = (max(figures) for figures in zip(*runs, strict=True))
    exact, rare = network(sporadic=False), network(sporadic=True)
    bound, claim = of(exact, *HEARD), of(exact, *FETCHED)
    assert bound.reaction is not None and bound.age is not None and claim.reaction is not None
    assert reaction <= bound.reaction
    assert (fetched <= claim.reaction) == (age <= bound.age) == (longer == 0)
    assert of(rare, *HEARD).reaction == bound.reaction
    assert of(rare, *HEARD).age is None  # the last value is used for as long as none comes
    assert of(rare, *FETCHED).reaction is None  # an input just missed waits for the next one


def test_a_queue_gives_each_item_once_however_seldom_it_comes() -> None:
    way = (("command", RELEASED), ("hear", RELEASED), ("act", QUEUED))
    exact, rare = of(network(sporadic=False), *way), of(network(sporadic=True), *way)
    assert exact.reaction == rare.reaction is not None
    assert exact.age is not None and rare.age is None


def test_every_second_job_of_what_is_sporadic_may_never_come() -> None:
    for sporadic in (False, True):
        system = network(sporadic=sporadic)
        slow = replace(system.tasks[2], period=200, deadline=200)
        second = replace(system, tasks=(*system.tasks[:2], slow))
        found = of(second, ("command", RELEASED), ("hear", RELEASED))
        assert (found.reaction is None) == sporadic


def test_nothing_behind_a_sampling_step_is_sporadic_any_more() -> None:
    rare = network(sporadic=True)
    follower = Task("last", 1, 50, 50, 1, core="b")
    system = replace(rare, tasks=(*rare.tasks, follower))
    assert of(system, ("act", SAMPLED), ("last", SAMPLED)).age is not None


PLAIN = """\
bus,bit_rate
can0,500000

message,bus,identifier,bytes,period_ms,sporadic
command,can0,1,8,10,{}

task,priority,period_ms,cost_us
act,1,5,100

chain,step,hop
way,command,{}
way,act,sampled
"""


@pytest.mark.parametrize(
    ("word", "hop", "reaction", "age"),
    [
        ("no", "released", True, True),
        ("", "released", True, True),
        ("yes", "released", True, False),
        ("no", "sampled", True, True),
        ("yes", "sampled", False, False),
    ],
)
def test_a_plain_file_says_which_messages_are_sporadic(
    word: str, hop: str, reaction: bool, age: bool
) -> None:
    system = load_plain(PLAIN.format(word, hop), "a.csv")
    assert isinstance(system, PlainSystem), system
    (found,) = analyse_plain(system).latencies
    assert (found.reaction is not None, found.age is not None) == (reaction, age)


def test_exports_say_it_where_the_format_can() -> None:
    system = network(sporadic=True)
    assert len(re.findall(r"Type\s*=>\s*Sporadic", mast.export(system, (), "a"))) == 1
    word = "command is sporadic: its period is the least distance."
    assert word in pycpa.export(system, (), "a") and word in cheddar.export(system, (), "a")
    assert "sporadic" not in pycpa.export(network(sporadic=False), (), "a")
    rare = replace(system, tasks=(replace(system.tasks[0], sporadic=True), *system.tasks[1:]))
    chain = TimedChain("way", (ChainStep("other", SAMPLED), ChainStep("act", SAMPLED)))
    assert "EffectChain" in pycpa.export(system, (chain,), "a")
    assert "Left out: chain way" in pycpa.export(rare, (chain,), "a")


# --- Models ---------------------------------------------------------------------------


RARE = ("period: 100 ms, sporadic: no", "period: 100 ms")


def test_a_message_from_outside_is_sporadic_unless_the_model_says_more(tmp_path: Path) -> None:
    exact, rare = analysed(QUEUE), analysed(QUEUE, RARE)
    said = analysed(QUEUE, ("sporadic: no", "sporadic: yes"))
    assert [one.system.messages[0].sporadic for one in (exact, rare, said)] == [False, True, True]
    ((_, bounded),), ((_, open_),) = exact.limited, rare.limited
    assert bounded.age is not None and open_.age is None
    assert bounded.reaction == open_.reaction is not None
    (one,) = findings(rare)
    assert one.message == "the age of cmd has no bound; its limit is 200 ms"
    assert [note for _, note in one.notes] == [
        "can0.cmd is sporadic: its next value may come at any later time"
    ]
    assert one.hint is not None and "give it `sporadic: no`" in one.hint
    assert findings(exact) == ()
    assert compiled(certificate(exact), tmp_path) == ""
    (tmp_path / "rare").mkdir()
    assert "chain cmd can have any age: can0.cmd" in compiled(certificate(rare), tmp_path / "rare")


def test_the_reaction_to_a_sporadic_message_is_certified(tmp_path: Path) -> None:
    found = analysed(QUEUE, RARE, ("age: 200 ms, ", ""))
    assert findings(found) == ()
    assert compiled(certificate(found), tmp_path) == ""
