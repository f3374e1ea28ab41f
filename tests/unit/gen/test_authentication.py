# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Authentication in the model, the analysis and the bench."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from ravenchart.analysis.present.figures import figures
from ravenchart.analysis.present.report import render_report
from ravenchart.analysis.system.authentication import authentications
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.gen.emit.buses.dbc import emit_dbc
from ravenchart.gen.emit.clashes import clashes
from ravenchart.gen.emit.program import first_versions, generate
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.hw_can.bench.peer import BenchError, Codec, FrameValues
from ravenchart.paths import ROOT
from tests.support.secoc import VALVE, cmac

MODEL = ROOT / "tests" / "feature" / "authenticated" / "model.yaml"
MS = 1_000_000
US = 1_000

NODES = """\
system: Two
types:
  Level: {range: [0, 1000]}
components:
  Source:
    ports: {level: {out: Level}, back: {in: Level}}
    port_region: {period: 10 ms, wcet: 50 us}
    activities:
      tell: {period: 10 ms, wcet: 50 us, reads: [back], body: [{send: level, with: back}]}
  Sink:
    ports: {level: {in: Level}, back: {out: Level}}
    port_region: {period: 10 ms, wcet: 50 us}
    activities:
      tell: {period: 10 ms, wcet: 50 us, reads: [level], body: [{send: back, with: level}]}
nodes:
  one: {context_switch: 5 us, critical_section: 2 us}
  two: {context_switch: 5 us, critical_section: 2 us}
buses:
  line: {bit_rate: 500 kbit/s, driver_wcet: 20 us, receive_depth: 8, transmit_depth: 8}
instances:
  pump: {component: Source, node: one}
  tank: {component: Sink, node: two}
messages:
  there:
    bus: line
    format: fd
    from: pump.level
    to: tank.level
    authentication: {profile: secoc, data_id: 1, key: shared, mac_wcet: 30 us}
  back: {bus: line, from: tank.back, to: pump.back}
processors:
  reception: {released_by: line, period: 1 ms, stack: 16 KiB, activities: [line.receive]}
  work_one: {node: one, stack: 16 KiB, activities: [pump.ports, pump.tell]}
  work_two: {node: two, stack: 16 KiB, activities: [tank.ports, tank.tell]}
shutdown: {raises: [], grace: 0 ms}
"""


def _loaded(path: Path) -> System:
    found = load(path)
    assert found.system is not None, found.diagnostics
    return found.system


@pytest.fixture(scope="module")
def system() -> System:
    """That of the feature."""
    return _loaded(MODEL)


@pytest.fixture(scope="module")
def analysis(system: System) -> Analysis:
    return analyse(system)


@pytest.fixture(scope="module")
def two(tmp_path_factory: pytest.TempPathFactory) -> System:
    path = tmp_path_factory.mktemp("two") / "model.yaml"
    path.write_text(NODES)
    return _loaded(path)


def test_the_independent_macs_are_those_of_rfc_4493() -> None:
    message = bytes.fromhex(
        "6bc1bee22e409f96e93d7e117393172aae2d8a571e03ac9c9eb76fac45af8e51"
        "30c81c46a35ce411e5fbc1191a0a52eff69f2445df4f9b17ad2b417be66c3710"
    )
    found = [cmac(VALVE, message[:size]).hex() for size in (0, 16, 40, 64)]
    assert found == [
        "bb1d6929e95937287fa37d129b756746",
        "070a16b46b4d4144f79bdd9dd04a287c",
        "dfa66747de9ae63030ca32611497c827",
        "51f0bebf7e3b9d92fc49741779363cfe",
    ]


def test_the_trailer_ends_the_frame_and_no_signal_is_in_it(system: System) -> None:
    sizes = {m.name: m.length for m in system.messages}
    assert sizes["first_in"] == 2 + 1 + 3
    assert sizes["second_in"] == 32  # 2 + 8 + 16, and the next frame that there is
    assert sizes["third_in"] == 64
    for message in system.messages:
        own = message.authentication
        assert own is not None
        fields = own.fields(message.length)
        last = fields[-1]
        assert last.byte + last.size == message.length
        taken = max(bit for signal in message.signals for bit in signal.bits())
        assert taken < 8 * fields[0].byte
        assert message.length - fields[0].byte == own.trailer


def test_the_time_of_each_mac_is_in_the_row_that_has_it_computed(system: System) -> None:
    wcets = {s.element: s.timing.wcet for p in system.processors for s in p.slots}
    assert wcets["gate.answer"] == (200 + 40 + 40 + 60) * US
    assert wcets["line.receive"] == (20 + 60) * US
    assert wcets["gate.ports"] == 100 * US


def test_the_time_of_a_mac_counts_on_the_node_that_computes_it(two: System) -> None:
    wcets = {(p.node, s.work): s.timing.wcet for p in two.processors for s in p.slots}
    found = {f"{node} {work.value}": wcet // US for (node, work), wcet in wcets.items()}
    assert (found["one receive"], found["two receive"]) == (20, 50)


def test_both_nodes_share_the_unit_of_the_user(two: System) -> None:
    made = generate(two, Claims())
    specs = [made[f"{node}/two-authentication.ads"] for node in ("one", "two")]
    assert specs[0] == specs[1]
    assert [n for n in first_versions(two) if "authentication" in n] == [
        "user/two-authentication.adb"
    ]


def test_no_type_is_used_twice_where_classic_frames_are_sent_too(two: System) -> None:
    made = generate(two, Claims())
    use = "use type Interfaces.Unsigned_64;"
    assert use in made["two/two-line.ads"]
    assert use not in made["two/two-line-receiver.adb"]


def test_lines_with_names_of_24_characters_fit_and_a_long_key_is_reported(tmp_path: Path) -> None:
    path, wide = tmp_path / "model.yaml", "k" * 24
    path.write_text(NODES.replace("there:", f"{'m' * 24}:").replace("shared", wide))
    texts = generate(_loaded(path), Claims())
    units = (t for name, t in texts.items() if "-line" in name or "authentication" in name)
    lines = [line for text in units for line in text.splitlines()]
    assert any(wide in line.lower() for line in lines)
    assert [line for line in lines if len(line) > 79] == []
    path.write_text(NODES.replace("shared", "k" * 59))
    (found,) = clashes(_loaded(path))
    assert found.message.startswith(f"the key `{'k' * 59}` makes a line of Two.")


def test_a_first_version_knows_no_mac(two: System) -> None:
    (text,) = (t for n, t in first_versions(two).items() if "authentication" in n)
    assert "return (others => <>);" in text


def test_rates_and_times_of_a_message(analysis: Analysis) -> None:
    first, second, *_ = authentications(analysis)
    assert first.authentication.random == pytest.approx(2.0**-24)
    assert first.tolerated == 256 * 20 * MS
    assert second.tolerated is None
    (silence,) = first.silences
    delivered = analysis.deliveries["line.first_in"].bound
    response = analysis.found.from_event("work")
    assert delivered is not None
    assert response is not None
    assert silence.found == delivered + 7 * 20 * MS + response


def test_the_report_has_them(system: System, analysis: Analysis) -> None:
    found = json.loads(json.dumps(figures(analysis)))["authenticated"]
    assert [row["message"] for row in found] == [m.name for m in system.messages]
    assert found[1]["tolerated"] is None
    text = render_report(analysis)
    assert ">Authentication</h2>" in text
    assert "<td>first_in</td><td>valve</td>" in text


def test_the_bench_says_that_it_has_no_key(system: System, tmp_path: Path) -> None:
    path = tmp_path / "line.dbc"
    path.write_text(emit_dbc(system, system.buses[0]))
    codec = Codec.from_file(path)
    values: FrameValues = {"level": 5, "mode": "Stop", "ready": "True"}
    with pytest.raises(BenchError, match="no key for its MAC; give SecOC_Freshness and SecOC_MAC "):
        codec.encode("first_in", values)
    trailer = {"SecOC_Freshness": 0x12, "SecOC_MAC": 0x345678}
    assert codec.encode("first_in", values | trailer).data[2:] == bytes.fromhex("12345678")
