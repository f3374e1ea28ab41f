# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The examples of charts do what their READMEs say, step by step."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from ravenchart.behaviour.limits import TO_THE_END
from ravenchart.behaviour.rules import findings
from ravenchart.commands import simulate
from ravenchart.gen.pipeline import Loaded, load
from ravenchart.paths import ROOT

EXAMPLES = ("crossing", "pump", "qhsmtst")


@dataclass(frozen=True)
class Example:
    """An example, loaded, with its README."""

    folder: Path
    loaded: Loaded
    readme: str

    @property
    def trace(self) -> str:
        """What the README expects of `simulate`."""
        found = re.search(r"^## The trace\n.*?^```text\n(.*?)^```\n", self.readme, re.S | re.M)
        assert found is not None
        return found.group(1)


def _example(name: str) -> Example:
    folder = ROOT / "examples" / name
    return Example(folder, load(folder / "model.yaml"), (folder / "README.md").read_text())


@pytest.fixture(scope="module", params=EXAMPLES)
def example(request: pytest.FixtureRequest) -> Example:
    """Each of the examples."""
    return _example(request.param)


@pytest.mark.parametrize(
    "name", [pytest.param("pump", marks=pytest.mark.slow), "crossing", "qhsmtst"]
)
def test_nothing_is_found_in_the_model(name: str) -> None:
    example = _example(name)
    assert example.loaded.system is not None
    found = findings(example.loaded.system, TO_THE_END)
    assert [str(one) for one in (*example.loaded.diagnostics, *found)] == []


def test_the_trace_is_that_of_the_readme(example: Example) -> None:
    system = example.loaded.system
    assert system is not None
    stimuli = simulate.stimuli_of(system, example.folder / "events.yaml")
    records = simulate.simulated_by_interpreter(system, stimuli)
    assert "".join(f"{record.text()}\n" for record in records) == example.trace


# --- The published order of QHsmTst -----------------------------------------------------


@dataclass(frozen=True)
class Handled:
    """One signal: the state that handles it, and what is left, entered and begun."""

    signal: str
    state: str
    order: tuple[str, ...]


def _published(readme: str) -> list[Handled]:
    rows = re.findall(r"^\| (start|[A-I]) \| (\w+) \| (?:`(.*?)` )?\|$", readme, re.M)
    return [Handled(signal, state, tuple(order.split())) for signal, state, order in rows]


def _told(trace: str) -> Iterator[Handled]:
    """The lines of the chart, in the words of the publication."""
    for line in trace.splitlines():
        behaviours = line.split(": ")[1].split(", ")
        if "test.Chart" not in line:
            continue
        signal, state = "start", "top"
        order = []
        for one in behaviours:
            name, _, what = one.rpartition(".")
            handled = re.fullmatch(r"(s\d*)_([a-i])", name)
            initial = re.fullmatch(r"initial\((\w+)\)|(\w+)_init", name)
            if handled is not None:
                state, signal = handled.group(1), handled.group(2).upper()
            elif initial is not None:
                of = (initial.group(1) or initial.group(2)).lower()
                order.append(f"*{'top' if of == 'chart' else of}")
            else:
                order.append(f"{'+' if what == 'entry' else '-'}{name.lower()}")
        yield Handled(signal, state, tuple(order))


def _states_of(rows: Iterable[Handled]) -> set[str]:
    return {row.state for row in rows}


def test_qhsmtst_has_the_published_order() -> None:
    own = _example("qhsmtst")
    published = _published(own.readme)
    assert len(published) == 22
    assert _states_of(published) == {"top", "s", "s1", "s11", "s2", "s21", "s211"}
    assert list(_told(own.trace)) == published


# --- What `check` finds when something is forgotten -------------------------------------


def _found(name: str, old: str, new: str) -> list[str]:
    """What the check of behaviour says of an example with one text replaced."""
    path = ROOT / "examples" / name / "model.yaml"
    text = path.read_text()
    assert text.count(old) == 1
    changed = load(path, lambda _, limit: text.replace(old, new).encode()[:limit])
    assert changed.system is not None, [str(one) for one in changed.diagnostics]
    return [one.message for one in findings(changed.system, TO_THE_END) if one.is_error]


def test_a_crossing_that_forgets_a_condition_is_refused_with_the_way_to_it() -> None:
    found = _found("crossing", "when: road_free and not requested", "when: road_free")
    start = "the invariant green_for_both of Crossing is violated: Blinking"
    assert any(one.startswith(start) for one in found)


@pytest.mark.slow
def test_a_pump_without_else_gets_stuck_and_check_says_so() -> None:
    found = _found(
        "pump", "          not_yet: {from: May_Go_On, to: Alarm, guard: else, req: [R-7]}\n", ""
    )
    assert any(one.startswith("Infusion may get stuck in May_Go_On") for one in found)
