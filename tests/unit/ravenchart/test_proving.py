# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A proof speaks of the sources that gnatprove has read."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.failures import ToolFailed
from ravenchart.proof import ages, earlier, proving, spark_results
from ravenchart.proof.spark_results import Results
from ravenchart.tools.kept import file_digest


def test_sources_that_change_during_a_proof_give_no_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source, results = tmp_path / "unit.ads", tmp_path / "results"
    source.write_text("package Unit is\nend Unit;\n")
    task = proving.ProofTask(tmp_path / "unit.gpr", {}, (results,), (tmp_path,))
    empty = Results(1, 0, (), 0, (), frozenset({"unit.ads"}), ())
    stored: list[str] = []
    monkeypatch.setattr(ages, "version", lambda: "version")
    monkeypatch.setattr(ages, "tool_text", lambda _: "tool")
    monkeypatch.setattr(earlier, "load", lambda _: None)
    monkeypatch.setattr(earlier, "store", lambda key, _: stored.append(key))
    monkeypatch.setattr(spark_results, "read_results", lambda *_, with_bodies: empty)

    def run(_task: proving.ProofTask, _server: object, _tell: object) -> None:
        source.write_text(text)

    monkeypatch.setattr(proving, "_run", run)
    text = "package Unit is\n   X : Integer;\nend Unit;\n"
    with pytest.raises(ToolFailed, match=r"unit\.ads: error: it was changed during the proof"):
        proving.prove(task, fresh=True)
    assert stored == []
    proof = proving.prove(task, fresh=True)
    assert len(stored) == 1
    assert dict(proof.sources)[str(source)] == file_digest(source)
