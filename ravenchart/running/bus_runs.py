# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A scenario played to a controller that runs already, at the other end of any bus.

Only frames are seen there: no trace, no times of the controller, no count of its faults. An
expectation of a scenario about these neither passes nor fails.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ravenchart.hw_can.bench.interfaces import BusEnd, shown_ends
from ravenchart.hw_can.bench.runner import Progress, ScenarioResult, run_scenario
from ravenchart.hw_can.bench.scenario import Scenario, load_scenario

from . import bus_log, judge, result
from .attaching import attached, vocabulary_at
from .process import Ended, separate_cores
from .result import RunOutcome
from .runs import RunRequest
from .vocabulary import BusVocabulary

WHY = "only the frames on the bus are seen"

GOES_ON = Ended(exit_code=0, killed=False, real_time=True, warnings=())
"""Of a controller that is neither started nor stopped here."""


def run_on_bus(
    interfaces: Mapping[str, BusEnd], request: RunRequest, progress: Progress
) -> RunOutcome:
    """Play the scenario, and leave the controller as it is then; Unusable where there is no bus."""
    assert request.scenario is not None
    plan = load_scenario(request.scenario)
    vocabulary = vocabulary_at(request.analysis.system, interfaces)
    with bus_log.all_recorded(request.log, [*interfaces]) as record:
        peer = attached(interfaces, vocabulary, record)
        with separate_cores():
            played = run_scenario(plan, peer, progress=progress)
    unseen = {"expect_trace": plan.trace_checks, "expect": plan.expected}
    return RunOutcome(
        title=f"{plan.title}, on {shown_ends(interfaces)}",
        scenario=plan,
        scenario_result=played,
        observation=None,
        ended=GOES_ON,
        steps=judge.step_rows(played, ()),
        compared=(),
        journeys=(),
        failures=(
            *judge.failures(GOES_ON, played, None, (), ()),
            *_silence(vocabulary, interfaces, played),
        ),
        notes=(*result.notes(GOES_ON, played, None, (), ()), *_unjudged(plan)),
        clock_offset=None,
        not_judged=WHY,
        unseen=tuple(key for key, entries in unseen.items() if entries),
    )


def _silence(
    vocabulary: BusVocabulary, interfaces: Mapping[str, BusEnd], played: ScenarioResult
) -> Iterator[str]:
    """Nothing that the controller sends came: most likely it is on another bus, or on none."""
    outside = vocabulary.outside()
    for bus in vocabulary.buses:
        own = {m.name for m in vocabulary.system.messages if m.bus == bus.name}
        own = (own & vocabulary.messages.keys()) - set(outside)
        if own and not own & played.received.keys():
            yield (
                f"no frame of the controller came from {interfaces[bus.name]}: does it run there, "
                f"at {bus.bit_rate} bit/s?"
            )


def _unjudged(plan: Scenario) -> Iterator[str]:
    """Expectations of the scenario that frames do not show."""
    yield from (f"not judged: {check}" for check in plan.trace_checks)
    yield from (f"not judged: {one.limit} {one.name}" for one in plan.expected)
