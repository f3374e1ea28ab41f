# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Logical execution times of a chain: its values do not depend on load, others beside it may."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from ravenchart.analysis.present.sentences import instant_lines
from ravenchart.analysis.system.timing import analyse
from ravenchart.building import checking, generation
from ravenchart.commands.simulate import build_simulation, executed, interpreted
from ravenchart.gen.diagnostics import render
from ravenchart.gen.draw.structure import structure_dot
from ravenchart.gen.model.logical import logical_links, logical_of
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.independent.check import checked as agreement
from ravenchart.paths import ROOT
from tests.support.interpreted import stimuli_of, system_of
from tests.support.short_runs import observed

FOLDER = ROOT / "tests" / "feature" / "chained"
TEXT = (FOLDER / "model.yaml").read_text(encoding="utf-8")
KEY = "    logical_execution_time: true\n"
ON_CHAIN = ("filter_1.late", "law_1.wanted")
LAST = TEXT.replace("  making: {stack", "  making: {priority: 1, stack")
"""The source runs after the others of its release."""
TWO = TEXT.replace("cell: {context", "cell: {cores: 2, context").replace(
    "filtering: {stack", "filtering: {core: 2, stack"
)

Values = dict[str, list[object]]


def _simulated(text: str) -> Values:
    system = system_of(text)
    found: Values = {}
    for one in interpreted(system, stimuli_of("- {until: 1 s}", system)).values:
        found.setdefault(one.element, []).append(one.value)
    return found


def _with(*replacements: tuple[str, str]) -> str:
    text = TEXT
    for old, new in replacements:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def _said(text: str) -> str:
    found = load(Path("model.yaml"), lambda path, limit: text.encode())
    return "\n".join(render(one, found.sources) for one in found.diagnostics)


def test_the_connections_of_the_chain_alone_have_instants() -> None:
    system = system_of(TEXT)
    links = {str(one.connection.target): one.lasting for one in logical_links(system)}
    assert links == {"filter_1.sample": 5_000_000, "law_1.filtered": 10_000_000}
    assert [logical_of(system, p.name) for p in system.processors] == [5_000_000, 10_000_000, None]


def test_report_and_drawing_say_that_chains_ask_for_it() -> None:
    system = system_of(TEXT)
    told = "Logical execution times: making 5 ms on chains, filtering 10 ms on chains."
    assert instant_lines(system) == (told,)
    assert "logical execution time 10 ms on chains" in structure_dot(system)


def test_a_value_is_seen_at_the_first_release_behind_the_period_of_its_sender() -> None:
    found = _simulated(TEXT)
    #  made at 0, 5, ...: visible 5 ms later, and taken at 0, 10, 20, ...
    assert found["filter_1.late"][:4] == [0, 2, 4, 6]
    #  of 10 and 30 ms, visible at 20 and 40
    assert found["law_1.wanted"][:3] == [0, 2, 6]


def test_priorities_change_values_beside_the_chain_only() -> None:
    one, other = _simulated(TEXT), _simulated(LAST)
    assert {name: one[name] for name in ON_CHAIN} == {name: other[name] for name in ON_CHAIN}
    assert one["filter_1.soon"] != other["filter_1.soon"]
    plain = [_simulated(text.replace(KEY, "")) for text in (TEXT, LAST)]
    assert plain[0]["filter_1.late"] != plain[1]["filter_1.late"]


def test_the_time_of_its_own_of_a_processor_stays() -> None:
    system = system_of(
        _with(("  making: {stack", "  making: {logical_execution_time: 4 ms, stack"))
    )
    links = {str(one.connection.target): one.lasting for one in logical_links(system)}
    assert links["filter_1.sample"] == links["filter_1.early"] == 4_000_000
    assert links["law_1.filtered"] == 10_000_000


def _reaction(system: System) -> int | None:
    ((_, found),) = analyse(system).limited
    return found.reaction


def test_the_bound_counts_periods_and_known_waits() -> None:
    """Sampling 5, visible after 5, wait 5, visible after 10, wait 10, and the response at last."""
    analysis = analyse(system_of(TEXT))
    last = analysis.found.responses["steering"].bound
    assert last is not None
    assert _reaction(analysis.system) == (5 + 5 + 5 + 10 + 10) * 1_000_000 + last
    assert _reaction(system_of(TEXT.replace(KEY, ""))) != _reaction(analysis.system)


def test_the_independent_checker_agrees(tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    path.write_text(TEXT, encoding="utf-8")
    generation.write_program(checking.check(path))
    report = agreement(path)
    assert report.disagreements == []
    assert "which processors send on chains with logical execution times" in report.not_derived
    certificate = next((tmp_path / "generated").glob("*timing_certificate.ads"))
    text = certificate.read_text(encoding="utf-8")
    certificate.write_text(
        text.replace("Making_Let : constant := 5_000_000", "Making_Let : constant := 6_000_000")
    )
    assert any("Making_Let" in one.text for one in agreement(path).disagreements)


@pytest.mark.parametrize(
    ("replacements", "told"),
    [
        (
            [
                (
                    "      sample: {in: Count}\n",
                    "      sample: {in: Count, kind: queued, depth: 9}\n",
                )
            ],
            "values go from source_1.make on making to filter_1.filter on filtering without",
        ),
        (
            [
                ("[filter_1.ports, filter_1.filter]", "[filter_1.filter]"),
                ("[law_1.ports, ", "[filter_1.ports, law_1.ports, "),
                ("    port_region: {period: 10 ms", "    port_region: {period: 20 ms"),
            ],
            "filter_1.ports on steering takes the values that filter_1.filter on filtering reads",
        ),
        (
            [
                ("    port_region: {period: 10 ms", "    port_region: {period: 2 s"),
                (
                    "        period: 10 ms\n        wcet: 3 ms",
                    "        period: 2 s\n        wcet: 3 ms",
                ),
            ],
            "filter_1.sample would keep 402 values, and may keep 256",
        ),
        ([("time: true", "time: false")], "`logical_execution_time`"),
        ([("time: true", "time: 5 ms")], "`logical_execution_time`"),
    ],
)
def test_what_has_no_instants_is_refused(replacements: list[tuple[str, str]], told: str) -> None:
    said = _said(_with(*replacements))
    assert told in said, said


def test_the_simulated_program_does_the_same_as_the_interpreter(tmp_path: Path) -> None:
    system = system_of(TEXT)
    program = build_simulation(system, tmp_path, tmp_path / "simulation")
    stimuli = stimuli_of("- {at: 33 ms, put: source_1.back, value: 7}\n- {until: 500 ms}", system)
    assert executed(system, program, stimuli) == interpreted(system, stimuli)


@pytest.mark.slow
@pytest.mark.clock
@pytest.mark.parametrize("text", [TEXT, TWO, LAST], ids=["one core", "two cores", "priorities"])
def test_a_run_records_what_the_simulation_does(text: str, tmp_path: Path) -> None:
    folder = tmp_path / "chained"
    shutil.copytree(FOLDER, folder)
    (folder / "model.yaml").write_text(text, encoding="utf-8")
    checked = checking.check(folder / "model.yaml")
    if not os.sched_getaffinity(0).issuperset(range(checked.system.most_cores)):
        pytest.skip(f"needs the first {checked.system.most_cores} processors of the machine")
    seen = observed(checked, folder, 1)
    missed = {name: one.misses for name, one in seen.processors.items()}
    assert not any(missed.values()), f"the host withheld the processor: {missed}"
    wanted = _simulated(TEXT)
    for element in ON_CHAIN:
        found = [one.value for one in seen.values if one.element.name == element]
        assert len(found) >= 20 and found == wanted[element][: len(found)], element
