# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The automated build has an end: what it had no time to prove is named, never passed over."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from ravenchart.proof import ages, proving
from ravenchart.proof.spark_results import Results
from tests import house

SWEPT = Results(1, 0, (), 0, (), frozenset(), ())


@pytest.fixture
def three(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Three targets: one proved before, one not, one changed since its record; what was proved."""
    sources = tmp_path / "sources"
    (tmp_path / ages.GNAT_12.name).mkdir()
    sources.mkdir()
    found = []
    for name in ("before", "never", "changed"):
        source = sources / f"{name}.adb"
        source.write_text(name, encoding="utf-8")
        digest = hashlib.sha256(("old " * (name == "changed") + name).encode()).hexdigest()
        record = tmp_path / ages.GNAT_12.name / f"{name}.toml"
        record.write_text(f'[sources]\n"{source}" = "{digest}"\n', encoding="utf-8")
        task = proving.ProofTask(sources / f"{name}.gpr", {}, (), (sources,))
        found.append(house.Target(name, task))
    proved: list[str] = []

    def prove(task: proving.ProofTask, *, fresh: bool) -> proving.Proof:
        assert not fresh
        proved.append(task.project.stem)
        return proving.Proof(SWEPT, (), "gnatprove")

    monkeypatch.setattr(house, "RECORDS", tmp_path)
    monkeypatch.setattr(house, "targets", lambda _: iter(found))
    monkeypatch.setattr(ages, "version", lambda: "CVC4 version 1.8")
    monkeypatch.setattr(proving, "prove", prove)
    monkeypatch.setattr(proving, "is_kept", lambda task: task.project.stem == "before")
    return proved


def test_without_an_end_all_is_proved(three: list[str]) -> None:
    assert house.prove([])
    assert three == ["before", "never", "changed"]


def test_what_no_time_is_left_for_is_named_and_a_changed_source_fails(
    three: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PROOF_MINUTES", "0")
    assert not house.prove([])
    assert three == ["before"]
    told = capsys.readouterr().out
    assert "never: not proved here, the time was over; its record is that of its sources" in told
    assert "changed: not proved here, the time was over; its record differs: " in told


def test_records_of_the_sources_pass(
    three: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    targets = list(house.targets([]))[:2]
    monkeypatch.setattr(house, "targets", lambda _: iter(targets))
    monkeypatch.setenv("PROOF_MINUTES", "0")
    assert house.prove([])
    assert three == ["before"]
    assert capsys.readouterr().out.count("not proved here") == 1
