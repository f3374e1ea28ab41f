# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Messages whose hint depends on the case: each is what helps there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ravenchart.analysis.findings import advice
from ravenchart.analysis.system.timing import analyse
from ravenchart.behaviour.rules.invariants import Broken, OpenInvariant, _not_inductive
from ravenchart.building import checking
from ravenchart.command_line import main
from ravenchart.failures import Refused
from ravenchart.gen.language.terms import BUILT_IN
from ravenchart.gen.model.component import Invariant
from ravenchart.paths import ROOT
from tests.support.pump import loaded
from tests.support.systems import HERE

MODEL = """
system: Telling
types: {Level: {range: [0, 9]}}
components:
  Chooser:
    ports: {level: {in: Level%s}, told: {out: Level}}
    port_region: {period: 10 ms, wcet: 10 us}
    events: [Go]
    data: {busy: {type: Boolean, initial: false}}
    regions:
      Main:
        period: 10 ms
        wcet: 10 us
        queue: 4
        initial: Both
        states:
          Both:
            regions:
              Left: {initial: L1, states: {L1: {}, L2: {%s}}}
              Right: {initial: R1, states: {R1: {}, R2: {entry: [{send: told, with: 1}]}}}
        transitions:
          left: {from: L1, to: L2, on: Go}
          home: {from: L2, to: L1, after: 1 s}
          right: {from: R1, to: R2, on: Go%s}
          back: {from: R2, to: R1, after: 1 s%s}
nodes: {board: {context_switch: 1 us, critical_section: 1 us}}
buses: {line: {bit_rate: 500 kbit/s, driver_wcet: 20 us, receive_depth: 8, transmit_depth: 8}}
instances: {one: {component: Chooser, node: board}}
messages:
  incoming: {bus: line, to: one.level, period: 20 ms}
  outgoing: {bus: line, from: one.told}
processors:
  reception: {released_by: line, period: 1 ms, stack: 16 KiB, activities: [line.receive]}
  work: {node: board, stack: 16 KiB, activities: [one.ports, one.Main]}
chains: {through: {path: [incoming, outgoing], reaction: 90 ms}}
shutdown: {raises: [], grace: 0 ms}
"""
ASKS = ", effect: [{if: in(Main.L2), then: [{send: told, with: 1}]}]"


def model(port: str = "", state: str = "", right: str = "", back: str = "") -> str:
    return MODEL % (port, state, right, back)


def test_a_state_of_another_region_is_read_through_data_as_the_hint_says() -> None:
    (found,) = (d for d in loaded(model(right=ASKS)).diagnostics if d.code == "RV-0416")
    assert found.hint == "set a data item in `entry` and `exit` of L2, and read that"
    busy = "entry: [{set: busy, to: true}], exit: [{set: busy, to: false}]"
    hinted = loaded(model(", on_arrival: Go", busy, ", guard: busy"))
    assert not [d for d in hinted.diagnostics if d.is_error], hinted.diagnostics


def _refused(folder: Path, text: str) -> str:
    path = folder / "model.yaml"
    path.write_text(text)
    try:
        return checking.check(path).warnings
    except Refused as refused:
        return str(refused)


def test_a_chain_that_goes_by_an_event_names_it_and_its_hint_mends_it(tmp_path: Path) -> None:
    said = _refused(tmp_path, model(", on_arrival: Go"))
    assert "[RV-0904]" in said
    assert (
        "hint: the event Go leads from one.level to one.Main; a chain follows values: "
        "let one.Main read what one.level holds or writes"
    ) in said
    mended = model(", on_arrival: Go", right=", guard: level > 3")
    assert "RV-0904" not in _refused(tmp_path, mended)


def test_a_gap_that_no_event_bridges_has_its_two_ends_named(tmp_path: Path) -> None:
    assert (
        "hint: values of incoming end at one.level, and those of outgoing begin at one.Main: "
        "connect the two, or let a row read the one and make the other"
    ) in _refused(tmp_path, model())


def test_a_chain_the_wrong_way_round_is_told_the_order(tmp_path: Path) -> None:
    turned = model().replace("path: [incoming, outgoing]", "path: [outgoing, one.Main]")
    said = _refused(tmp_path, turned)
    assert "hint: values go from one.Main to outgoing: give the two in that order" in said


def test_without_a_search_no_number_of_situations_is_told() -> None:
    invariant = Invariant("bad", HERE, None)  # type: ignore[arg-type]
    broken = Broken("A -Go-> B", BUILT_IN, "")
    none, some = (
        _not_inductive(OpenInvariant(invariant, broken, None, looked)).hint or ""
        for looked in (0, 5)
    )
    assert "situations" not in none
    assert none.startswith("there was no time left to look for a way")
    assert "among 5 situations" in some


@pytest.mark.parametrize(
    ("kind", "article"), [("instance", "an"), ("component", "a"), ("processor", "a")]
)
def test_articles_fit_what_follows(kind: str, article: str) -> None:
    name = {"instance": "one", "component": "Chooser", "processor": "work"}[kind]
    text = model().replace("Level", name.capitalize())
    message = f"the type `{name.capitalize()}` is named like {article} {kind}"
    assert message in [d.message for d in loaded(text).diagnostics]


def test_a_number_in_quotes_is_told_to_lose_them() -> None:
    found = loaded(model().replace("queue: 4", 'queue: "0"')).diagnostics
    assert [(d.message, d.hint) for d in found] == [
        ("`queue` must be a whole number, not the text `0`", "write it without quotes")
    ]


def test_no_more_files_change_than_there_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (ROOT / "tests" / "feature" / "charts" / "model.yaml").read_text()
    (tmp_path / "model.yaml").write_text(text)
    assert main(["generate", str(tmp_path / "model.yaml")]) == 0
    counts = re.search(r": (\d+) files, (\d+) changed", capsys.readouterr().out)
    assert counts is not None
    assert counts[1] == counts[2]


def test_a_file_in_the_way_is_named_without_a_number(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (ROOT / "tests" / "feature" / "charts" / "model.yaml").read_text()
    (tmp_path / "model.yaml").write_text(text)
    (tmp_path / "generated").write_text("in the way")
    assert main(["generate", str(tmp_path / "model.yaml")]) == 2
    said = capsys.readouterr().err.strip()
    assert said == f"ravenchart: error: {tmp_path / 'generated'}: file exists"


def test_a_spec_that_the_user_writes_is_not_said_to_be_generated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (ROOT / "tests" / "feature" / "devices" / "model.yaml").read_text()
    (tmp_path / "model.yaml").write_text(re.sub(r"body: simulated", "body: user", text))
    assert main(["generate", str(tmp_path / "model.yaml")]) == 0
    notes = [line for line in capsys.readouterr().err.splitlines() if "_states.ads" in line]
    assert notes
    assert all("its spec is in" not in note for note in notes)


def test_a_system_is_not_named_like_a_parent_of_units_of_gnat() -> None:
    for name in "AGIS":
        found = loaded(model().replace("system: Telling", f"system: {name}")).diagnostics
        assert "RV-0304" in [d.code for d in found]


def test_where_a_chain_is_late_the_advice_speaks_of_limits() -> None:
    late = model(right=", guard: level > 3").replace("reaction: 90 ms", "reaction: 9 ms")
    found = loaded(late).system
    assert found is not None
    assert "keep all deadlines and limits" in advice.lines(advice.of_model(analyse(found)))[0]


def test_where_no_type_is_declared_the_hint_is_to_declare_it() -> None:
    text = model(right=", guard: level > 3").replace("types: {Level: {range: [0, 9]}}\n", "")
    hints = {d.hint for d in loaded(text).diagnostics if d.code == "RV-0305"}
    assert "declare it in `types:`" in hints
    assert not any(hint and "one of: Boolean" in hint for hint in hints)
