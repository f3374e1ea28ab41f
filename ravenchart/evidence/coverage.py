# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Claims about what test cases execute of charts and user bodies, by an LCOV tracefile.

A count is believed only of the text that stands there today.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence

from ravenchart.gen.emit.ada.naming import region_package
from ravenchart.gen.emit.program import simulation, source_folders
from ravenchart.running.coverage import GCOV, number_ranges

from .claim import Claim, ClaimKind, Shown
from .facts import Facts
from .tracefile import CountedBody


def coverage(facts: Facts) -> Iterator[Claim]:
    """A claim for each chart, and for each body of the user; none without a tracefile."""
    if facts.coverage is None or facts.ungenerated:
        return
    system = facts.checked.system
    counted = {body.path.name: body for body in facts.coverage}
    texts = simulation(system)
    for component in system.components:
        for region in component.regions:
            stem = region_package(system.home_of(component), component, region).file_stem
            name = f"{component.name}.{region.name}"
            files = [f"{stem}.adb", f"{stem}.ads"]
            given = [(file, texts[file].encode("utf-8")) for file in files]
            yield _claim(facts, f"coverage-{name}", (name,), given, counted)
    models = (*facts.checked.libraries, facts.checked)
    for place in (one.folder / place for one in models for place in source_folders(one.system)):
        for path in sorted(place.glob("*.adb")):
            id_ = f"coverage-{path.stem}"
            yield _claim(facts, id_, (), [(path.name, path.read_bytes())], counted)


def _claim(
    facts: Facts,
    id_: str,
    elements: tuple[str, ...],
    given: Sequence[tuple[str, bytes]],
    counted: Mapping[str, CountedBody],
) -> Claim:
    versions = {file: hashlib.sha256(text).hexdigest() for file, text in given}
    wrong: list[str] = []
    left: list[str] = []
    for file, version in versions.items():
        problems = _problems(file, version, counted.get(file))
        wrong += problems[0]
        left += problems[1]
    verdict = Shown.NOT_MET if wrong else Shown.PARTLY if left else Shown.MET
    counts = ""
    if bodies := [counted[file] for file in versions if file in counted]:
        lines = [count for body in bodies for count in body.lines.values()]
        branches = [count for body in bodies for _, count in body.branches]
        counts = f": lines {_executed(lines)}, branches {_executed(branches)}"
    files = " and ".join(versions)
    return Claim(
        id_, ClaimKind.COVERAGE, elements or (facts.checked.system.name,),
        f"Test cases execute every line with code of {files} and take every branch",
        f"executions in virtual time, as {GCOV} counts them without checks and contracts{counts}. "
        "Of a spec the functions count that a body calls. Where a body is generated, it is that of "
        "the simulation: with a note at each behaviour.",
        "test", GCOV, verdict, (*wrong, *left), (*facts.sources, *versions.items()),
    )  # fmt: skip


def _executed(counts: Sequence[int]) -> str:
    return f"{sum(count > 0 for count in counts)} of {len(counts)}"


def _problems(
    file: str, version: str, body: CountedBody | None
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Contradictions to the counts, and the lines and branches that were not executed."""
    if body is None:
        return (f"the tracefile has no counts of {file}",), ()
    if not body.version:
        return (f"the tracefile does not say of which text of {file} its counts are (VER)",), ()
    if body.version != version:
        return (f"{file} is not as it was when it was counted",), ()
    lines = sorted(line for line, count in body.lines.items() if not count)
    branches = sorted({line for line, count in body.branches if not count} - {*lines})
    left = []
    if lines:
        left.append(f"{file}: not executed: {number_ranges(lines)}")
    if branches:
        left.append(f"{file}: a branch is not taken: {number_ranges(branches)}")
    return (), tuple(left)
