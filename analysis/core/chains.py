# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""End-to-end latencies of cause-effect chains, hop by hop.

A chain is cut where data waits in a variable or a queue for a task that runs at its
own times. Between cuts each step is released by the one before. So a segment has
the response of its last step, from the arrival of its first, and one period T.

    reaction  from an input that was just missed until the first output that knows it:
              sum over segments of  wait + R, where the wait for a sampling task is at
              most T: data written just after it was read is read in the next job
              (Davare et al., DAC 2007). Where steps follow only some of the jobs before
              them, T is the period of the last of them
    age       from the arrival of the job that sampled an input until an output made of
              it: R of the last segment, and R + T for each one before it that is sampled:
              the value read was written by the last job completed before (Durr, von der
              Bruggen, Chen, Chen, TECS 2019). An output stays until the next one replaces
              it: `held` is the age then, and equals the reaction when all is sampled.

The period of a sporadic item bounds how soon its next job comes, not how late. So three times have
no bound: the wait until it samples, the wait until the n-th job that a step follows, and the
age of its output (Feiertag et al., CRTS 2008). Durr et al. need a greatest distance too. Steps
that it releases, and steps that sample or take its values, have a reaction all the same.

A queue may release the task that takes its items, no sooner than its period T after the
release before. Let items come no closer than T, apart from the lateness of their writer. Then no
item waits longer than the first one that finds the task delayed. This delay has put off the end
of the separation to less than R after that item came. So an item waits at most R. The n-th item
that one job of the writer puts in waits n - 1 periods more.

A queue hands each item over once. Its reader takes a fixed number in a job; an item waits
for those before it. A job that finds none repeats its output of the last item. So the output
is replaced as often as its writer puts an item in. The writer's T counts for the age,
whatever comes after, and the reader's own does not. These are bounds for any phasing
of any clocks.

A task with a logical execution time L makes its output visible L after its arrival (Henzinger,
Horowitz, Kirsch, Proc. IEEE 2003). L takes the place of R then, and the reader samples at its
arrival. Where both count from one epoch, the waits are those of two grids of instants
(Becker, Dasari, Mubeen, Behnam, Nolte, JSA 2017, for LET).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from .checks import positive
from .holistic import Holistic, Network


class HopKind(Enum):
    """How data reach a step."""

    RELEASED = "released"
    """The completion of the step before (or the chain's event) releases it."""

    SAMPLED = "sampled"
    """It reads the latest value at its own times."""

    QUEUED = "queued"
    """It takes the oldest items from a queue at its own times."""

    WOKEN = "woken"
    """An item in its queue releases it, its period after the release before at the earliest."""


@dataclass(frozen=True, slots=True)
class ChainStep:
    """A task or frame of a chain.

    The fields say how items reach the step, and how its outputs follow each other.

        ``takes``    items in a job, where the hop to it is queued
        ``puts``     items that a job of the step before puts into that queue; with more than
                     one, one is taken in a job
        ``waits``    why an input may wait inside the step without bound, once a job of
                     it has arrived; "" where it does not wait
        ``keeps``    why some of its jobs leave the old output in place, or make none, so that
                     the age of the next steps has no bound; "" where each makes a new one
        ``longest``  longest time between two of its outputs, where that is more than its
                     period; 0 where it is not
        ``delay``    how much longer an input may wait for the step, which is not free for each
        ``lasting``  how long after its arrival the step before makes its output visible, at
                     exactly that instant, where the hop to it is sampled; 0: when it completes
        ``saved``    how much shorter than both periods the longest distance is of these instants
                     and the arrivals of the step, where all of them are known
    """

    name: str
    hop: HopKind
    takes: int = 1
    puts: int = 1
    waits: str = ""
    keeps: str = ""
    longest: int = 0
    delay: int = 0
    lasting: int = 0
    saved: int = 0

    def __post_init__(self) -> None:
        """Refuse to take or put no items, or several of both, with a ValueError."""
        positive(f"step {self.name}", takes=self.takes, puts=self.puts)
        if self.takes > 1 and self.puts > 1:
            raise ValueError(f"step {self.name} takes several items or is given several, not both")


@dataclass(frozen=True, slots=True)
class TimedChain:
    """Steps from input to output; the limits are in ticks, 0 where there is none."""

    name: str
    steps: tuple[ChainStep, ...]
    reaction_limit: int = 0
    age_limit: int = 0


@dataclass(frozen=True, slots=True)
class HopLatency:
    """The times of one step in a chain.

    They are in ticks; None where there is no bound.

        ``wait``      until the arrival of the job that reads the input, or of one that the
                      step follows
        ``response``  from there (or the step before, when released by it) to completion
        ``renewal``   longest time until the output of a job is replaced by the next one,
                      where that counts for the age: before a queue or a sampling step
        ``backlog``   places that a queue before the step must have to lose no item
    """

    step: ChainStep
    wait: int | None
    response: int | None
    renewal: int | None = 0
    backlog: int | None = 0


@dataclass(frozen=True, slots=True)
class Latency:
    """The latencies of a chain, with the hops that they are the sums of."""

    chain: TimedChain
    hops: tuple[HopLatency, ...]
    renewal: int | None
    """Longest time for which the last output stays; None where no next one is certain."""

    @property
    def reaction(self) -> int | None:
        """From an input to the first output that knows it: all waits and responses."""
        return _total([part for hop in self.hops for part in (hop.wait, hop.response)])

    @property
    def age(self) -> int | None:
        """From the sampling of an input to the output made of it.

        The sum of all responses and renewals, and of the waits in queues. The wait before
        other steps does not count, because their input is renewed meanwhile.
        """
        parts = []
        for hop in self.hops:
            parts += [hop.response, hop.renewal]
            if hop.step.hop in (HopKind.QUEUED, HopKind.WOKEN):
                parts.append(hop.wait)
        return _total(parts)

    @property
    def held(self) -> int | None:
        """From the sampling of an input until the output made of it is replaced."""
        return _total([self.age, self.renewal])

    @property
    def met(self) -> bool:
        """Whether both limits are met, where they are given; the age is that of the output."""
        pairs = (
            (self.reaction, self.chain.reaction_limit),
            (self.age, self.chain.age_limit),
        )
        return all(not limit or (v is not None and v <= limit) for v, limit in pairs)


def latency(chain: TimedChain, network: Network, found: Holistic) -> Latency:
    """The latencies of ``chain`` from the responses ``found`` for ``network``.

    ValueError for a step that the network does not have, and for a queue before the first
    step. ValueError also where the step before does not release a step of `HopKind.RELEASED`.
    """
    _check(chain, network)
    hops = []
    renewal: int | None = 0
    queued = False
    for number, step in enumerate(chain.steps):
        before = chain.steps[number - 1] if number else None
        after = chain.steps[number + 1] if number + 1 < len(chain.steps) else None
        response, cycle = _until_visible(step, after, found), _cycle(step.name, network)
        wait: int | None = 0
        backlog: int | None = 0
        if step.hop is HopKind.RELEASED and before is not None:
            response = _less(response, found.from_event(before.name))
            wait = network.items()[step.name].period - network.items()[before.name].period
            #  some items are not passed on; of sporadic ones the next may never come
            wait = None if wait and (queued or cycle is None) else wait
        elif step.hop is HopKind.SAMPLED:
            wait, queued = cycle, False
            wait = None if wait is None else wait - step.saved
        elif step.hop is HopKind.QUEUED and before is not None:
            wait, backlog = _queue(before.name, step, network, found)
            queued = True
        elif step.hop is HopKind.WOKEN and before is not None:
            wait, backlog = _woken(before.name, step, network, found)
        outputs = None if cycle is None else max(cycle, step.longest)
        if step.hop is HopKind.SAMPLED or before is None:
            renewal = outputs
        elif step.hop is not HopKind.WOKEN:  # that makes an output of each item
            renewal = None if renewal is None or outputs is None else max(renewal, outputs)
        renewal = None if step.keeps else renewal
        counted: int | None = 0
        if after is not None and (renewal is None or after.hop is HopKind.QUEUED or not queued):
            follows = after.hop in (HopKind.RELEASED, HopKind.WOKEN)
            counted = 0 if follows and not step.keeps else renewal
            if after.saved and renewal is not None and renewal == cycle and not queued:
                counted = renewal - after.saved
        wait = None if step.waits or wait is None else wait + step.delay
        hops.append(HopLatency(step, wait, response, counted, backlog))
    return Latency(chain, tuple(hops), renewal)


def _until_visible(step: ChainStep, after: ChainStep | None, found: Holistic) -> int | None:
    """From the event of a step until its output can be read; None where it may come too late."""
    done = found.from_event(step.name)
    if after is None or not after.lasting or done is None:
        return done
    return after.lasting if done <= after.lasting else None


def _check(chain: TimedChain, network: Network) -> None:
    """Refuse a chain that does not fit the network."""
    items = network.items()
    if not chain.steps or chain.steps[0].hop in (HopKind.QUEUED, HopKind.WOKEN):
        raise ValueError(f"steps of chain {chain.name} must begin with a step without a queue")
    for number, step in enumerate(chain.steps):
        if step.name not in items:
            raise ValueError(f"step {step.name} of chain {chain.name} is no task or message")
        if number and step.hop is HopKind.RELEASED:
            before = chain.steps[number - 1].name
            if network.released_by.get(step.name) != before:
                raise ValueError(
                    f"step {step.name} of chain {chain.name} is not released by {before}"
                )


def _cycle(name: str, network: Network) -> int | None:
    """The longest time between two of its events; None where they are sporadic."""
    items = network.items()
    root = items[(name, *network.releasers(name))[-1]]
    return None if root.sporadic else items[name].period


def _queue(
    writer: str, step: ChainStep, network: Network, found: Holistic
) -> tuple[int | None, int | None]:
    """The wait of an item for the arrival of the job that takes it, and how many items wait.

    The items of job k (from 1) of a burst come no earlier than (k - 1) T - J of the writer.
    Item n has its turn in job ceil(n / takes) of the reader from then on. The wait is
    longest for the last item that jitter can make come at once, or for the next one
    that needs one more job of the reader.
    """
    items = network.items()
    period, takes, puts = items[writer].period, step.takes, step.puts
    cycle, read = _cycle(step.name, network), found.from_event(step.name)
    written = found.from_event(writer)
    if cycle is None or read is None or written is None or puts * cycle > takes * period:
        return None, None
    jitter = written - found.best[writer] - network.least()[writer]
    burst = puts * (jitter // period + 1)
    later = -(-burst // takes) * takes + puts
    wait = max(
        -(-item // takes) * cycle - max(0, (item // puts - 1) * period - jitter)
        for item in (burst, later)
    )
    return wait, puts * ((wait + read + jitter) // period + 1)


def _woken(
    writer: str, step: ChainStep, network: Network, found: Holistic
) -> tuple[int | None, int | None]:
    """The wait of an item for the release that takes it, and how many items wait.

    The step is the first row of its task, or the task itself. Its delay after the release
    is at most its response.
    """
    items = network.items()
    period, separation = items[writer].period, items[step.name].period
    read, written = found.from_event(step.name), found.from_event(writer)
    if read is None or written is None or step.puts * separation > period:
        return None, None
    jitter = written - found.best[writer] - network.least()[writer]
    wait = read + (step.puts - 1) * separation
    return wait, step.puts * ((wait + read + jitter) // period + 1)


def _less(longer: int | None, shorter: int | None) -> int | None:
    return None if longer is None or shorter is None else longer - shorter


def _total(parts: list[int | None]) -> int | None:
    """The sum; None where a part has no bound."""
    known = [part for part in parts if part is not None]
    return sum(known) if len(known) == len(parts) else None
