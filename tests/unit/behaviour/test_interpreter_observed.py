# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Why each transition from an active state fired or did not, as an observed region says it."""

from __future__ import annotations

from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.observed import FiringReason, ObservedRegion, ObservedStep
from tests.support.interpreted import chart_system, events_text, stimuli_of

Found = dict[str, tuple[str, tuple[str, ...]]]


def last_step(chart: str, *events: str, until: int = 0) -> ObservedStep:
    """The last step of a chart under some events."""
    system = chart_system(chart)
    machine = Machine(system, ObservedRegion)
    list(machine.run(stimuli_of(events_text(*events, until=until), system)))
    region = machine.instances["unit"].regions["Main"]
    assert isinstance(region, ObservedRegion)
    return region.steps[-1]


def reasons(step: ObservedStep) -> Found:
    """Transition to its reason and what that names."""
    return {one.transition.name: (one.reason.name, one.because) for one in step.verdicts}


GUARDED = """
data: {x: 3}
initial: A
states: {A: {}, B: {}}
transitions:
  small: {from: A, to: B, on: Go, guard: x < 3}
  big: {from: A, to: B, on: Go, guard: x > 2}
  later: {from: A, to: B, on: Go}
  other: {from: A, to: B, on: Other}
  back: {from: B, to: A, on: Go}
"""


def test_a_guard_an_earlier_transition_and_another_trigger() -> None:
    step = last_step(GUARDED, "10 Go", until=10)
    assert reasons(step) == {
        "small": ("GUARD_FALSE", ()), "big": ("FIRED", ()), "later": ("EARLIER", ("big",)),
        "other": ("OTHER_TRIGGER", ()),
    }  # fmt: skip
    ((_, reads),) = ((one.expression, one.reads) for one in step.verdicts[0].failed)
    assert [value for _, value in reads] == [3]


def test_the_first_step_enters_and_has_no_verdicts() -> None:
    step = last_step(GUARDED)
    assert step.started and step.verdicts == () and step.behaviours == ("A.entry",)


NESTED = """
initial: Whole
states:
  Whole: {initial: First, states: {First: {}, Next: {}}}
  Away: {}
transitions:
  inner: {from: First, to: Next, on: Go}
  outer: {from: Whole, to: Away, on: Go}
"""


def test_a_transition_inside_goes_first() -> None:
    assert reasons(last_step(NESTED, "10 Go", until=10)) == {
        "inner": ("FIRED", ()), "outer": ("INSIDE", ("inner",)),
    }  # fmt: skip
    assert reasons(last_step(NESTED, "10 Go", "20 Go", until=20)) == {"outer": ("FIRED", ())}


TIMED = """
initial: A
states: {A: {}, B: {}}
transitions:
  soon: {from: A, to: B, after: 30 ms}
  tick: {from: A, every: 20 ms}
  go: {from: A, to: B, on: Go}
"""


def test_a_time_out_has_executions_to_go() -> None:
    step = last_step(TIMED, until=10)
    assert [(one.reason.name, one.executions) for one in step.verdicts] == [
        ("NOT_DUE", 2), ("NOT_DUE", 1), ("OTHER_TRIGGER", 0),
    ]  # fmt: skip
    step = last_step(TIMED, "20 Go", until=20)
    assert reasons(step) == {
        "soon": ("NOT_DUE", ()), "tick": ("FIRED", ()), "go": ("LATER", ()),
    }  # fmt: skip


LOST = """
data: {x: 0}
initial: A
states: {A: {}, B: {}}
transitions:
  done: {from: A, to: B, guard: x > 0}
  late: {from: A, to: B, after: 10 ms, guard: x > 0}
  watch: {from: A, to: B, when: x > 1}
"""


def test_a_completion_a_time_out_and_a_condition_that_came_to_nothing() -> None:
    assert reasons(last_step(LOST, until=10)) == {
        "done": ("GUARD_FALSE", ()), "late": ("LATER", ()), "watch": ("OTHER_TRIGGER", ()),
    }  # fmt: skip
    assert reasons(last_step(LOST, until=20)) == {
        "done": ("COMPLETION_OVER", ()), "late": ("GUARD_FALSE", ()),
        "watch": ("OTHER_TRIGGER", ()),
    }  # fmt: skip
    assert reasons(last_step(LOST, until=30)) == {
        "done": ("COMPLETION_OVER", ()), "late": ("TIME_OUT_OVER", ()),
        "watch": ("CONDITION_FALSE", ()),
    }  # fmt: skip


DEFERRED = """
data: {x: 0}
initial: Busy
deferred: 2
states:
  Busy: {defer: [Order]}
  Ready: {}
transitions:
  take: {from: Busy, to: Ready, on: Order, guard: x > 0}
  finish: {from: Busy, to: Ready, on: Finish}
"""


def test_a_deferred_event_names_the_state_that_defers() -> None:
    step = last_step(DEFERRED, "10 Order", until=10)
    assert step.deferring == ("Busy",)
    assert reasons(step) == {"take": ("GUARD_FALSE", ()), "finish": ("OTHER_TRIGGER", ())}


REGIONS = """
initial: Both
states:
  Both:
    regions:
      Left: {initial: L1, states: {L1: {}, L2: {}}}
      Right: {initial: R1, states: {R1: {}, R2: {}}}
  Away: {}
transitions:
  step: {from: L1, to: L2, on: Go}
  leave: {from: R1, to: Away, on: Go}
  turn: {from: R1, to: R2, on: Turn}
  over: {from: Both, to: Away, on: Go}
"""


def test_a_conflict_names_what_was_taken_before() -> None:
    assert reasons(last_step(REGIONS, "10 Go", until=10)) == {
        "step": ("FIRED", ()), "leave": ("CONFLICT", ("step",)), "turn": ("OTHER_TRIGGER", ()),
        "over": ("INSIDE", ("step", "leave")),
    }  # fmt: skip


JUNCTION = """
data: {x: 0}
initial: A
states:
  A: {}
  B: {}
  J: {kind: junction}
transitions:
  first: {from: A, to: J, on: Go}
  one: {from: J, to: B, guard: x > 5}
  two: {from: J, to: B, guard: x > 7}
  second: {from: A, to: B, on: Go}
"""


def test_a_junction_without_a_way_on_names_its_guards() -> None:
    step = last_step(JUNCTION, "10 Go", until=10)
    assert reasons(step) == {"first": ("NO_WAY_ON", ()), "second": ("FIRED", ())}
    assert len(step.verdicts[0].failed) == 2
    assert step.verdicts[0].reason is FiringReason.NO_WAY_ON
