# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""gnatprove asks for verdicts that a prover gave before: here, and from the memcached of a team."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest

from ravenchart.proof import proving, verdicts
from ravenchart.proof.spark_results import Results
from ravenchart.proof.verdicts import Memcached
from ravenchart.tools import toolchain
from tests.unit.ravenchart.test_verdicts import memcached

pytestmark = pytest.mark.skipif(not toolchain.have("gnatprove"), reason="gnatprove is not on PATH")

SPEC = """\
package Means with SPARK_Mode is
   subtype Level is Integer range 0 .. 2000;
   function Mean (A, B : Level) return Level
   is ((A + B) / 2)
   with Post => Mean'Result in Level'Min (A, B) .. Level'Max (A, B);
end Means;
"""
WRONG_SPEC = SPEC.replace("(A + B) / 2", "(A + B) / 2 + 1")
PROJECT = """\
project Means is
   for Object_Dir use "obj";
   for Create_Missing_Dirs use "True";
   package Prove is
      for Proof_Switches ("Ada") use ("--level=1", "-j1");
   end Prove;
end Means;
"""


def _proof(folder: Path, spec: str, shared: str | None = None) -> Results:
    folder.mkdir(exist_ok=True)
    (folder / "means.gpr").write_text(PROJECT)
    (folder / "means.ads").write_text(spec)
    results = folder / "obj" / "gnatprove"
    task = proving.ProofTask(folder / "means.gpr", {}, (results,), (folder,))
    where = None if shared is None else Memcached(shared)
    return proving.prove(task, memcached=where).results


def _kept(home: Path) -> int:
    with sqlite3.connect(home / "ravenchart" / "verdicts" / "proved.db") as file:
        return int(file.execute("select count(*) from verdicts").fetchone()[0])


def test_a_second_machine_starts_no_prover_and_finds_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with memcached() as shared:
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "first"))
        first = _proof(tmp_path / "here", SPEC, shared)
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "second"))
        answered: list[bytes] = []  # by a prover of the second machine
        monkeypatch.setattr(
            verdicts.VerdictServer, "set", lambda *words: answered.append(words[-1])
        )
        second = _proof(tmp_path / "there", SPEC, shared)
    assert first == second
    assert first.checks > 0
    assert not first.unproved
    assert answered == []
    assert _kept(tmp_path / "second") > 0


def test_what_changed_is_proved_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    assert not _proof(tmp_path / "here", SPEC).unproved
    with pytest.raises(proving.NotProved) as left:
        _proof(tmp_path / "here", WRONG_SPEC)
    assert left.value.proof.results.unproved
