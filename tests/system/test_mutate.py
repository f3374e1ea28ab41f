"""A few breaks of generated code, of the kinds that proof and tests must notice: none survives."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart import toolchain
from ravenchart.mutate.__main__ import SUBJECTS, tried
from ravenchart.mutate.catalogue import mutants_of
from ravenchart.mutate.mutants import Mutant, sampled
from ravenchart.mutate.observing import Observer
from ravenchart.mutate.report import survivors
from ravenchart.mutate.workbench import Workbench

UNIT = "three_components-starter-starting.adb"
CAUGHT_BY = {
    ("target", False): "gnatprove",
    ("source", False): "gnatprove",
    ("trigger", True): "gnatprove",
    ("order", False): "gnatprove",
    ("time-out", False): "tests",
    ("certificate", False): "compiler",
}
"""Kind, whether the declared form is broken, and who notices first."""


def _chosen(files: dict[str, str]) -> list[Mutant]:
    """One mutant of each kind, the same every time."""
    spec = UNIT.removesuffix("b") + "s"
    places = (UNIT, spec, "three_components-timing_certificate.ads")
    wanted = [
        m
        for m in mutants_of(files)
        if m.file in places
        and (m.kind, m.declared) in CAUGHT_BY
        and (m.kind != "time-out" or m.rule == "later")
    ]
    return sampled(wanted, 1, seed=1)


@pytest.mark.skipif(not toolchain.have("gnatprove"), reason="gnatprove is not on PATH")
def test_no_mutant_of_a_small_sample_survives(tmp_path: Path) -> None:
    subject = next(s for s in SUBJECTS if s.name == "three_components")
    chosen = _chosen(dict(Workbench(subject.model, tmp_path, Observer).files))
    assert len(chosen) == len(CAUGHT_BY)
    outcomes = tried(subject, chosen, 1, ())
    assert survivors(outcomes) == ""
    caught = {(o.mutant.kind, o.mutant.declared): o.verdict.by for o in outcomes}
    assert caught == CAUGHT_BY
