# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What gcov says of a program, by body: lines, branches, and the tracefile that is written."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from ravenchart.running.coverage import SourceOwner, number_ranges, read, tracefile

GENERATED, RUNTIME = Path("/home/model/source"), Path("/runtime/src")
PLACES = {GENERATED: SourceOwner.GENERATED, RUNTIME: SourceOwner.RUNTIME}


def _line(number: int, count: int, *branches: int, throw: bool = False) -> dict[str, object]:
    kept = [{"count": one, "throw": throw, "fallthrough": False} for one in branches]
    return {"line_number": number, "count": count, "branches": kept}


def _said(*files: tuple[Path, list[dict[str, object]]]) -> str:
    return "".join(
        json.dumps({"files": [{"file": str(path), "functions": [], "lines": lines}]}) + "\n"
        for path, lines in files
    )


def test_lines_and_branches_are_counted_by_body() -> None:
    said = _said(
        (GENERATED / "a.adb", [_line(3, 2, 2, 0), _line(4, 0), _line(9, 1, 1, throw=True)])
    )
    (body,) = read(said, PLACES)
    assert (body.path, body.origin) == (GENERATED / "a.adb", SourceOwner.GENERATED)
    assert (len(body.lines), body.executed(), body.left()) == (3, 2, [4])
    assert (len(body.branches), body.taken()) == (2, 1)


def test_instances_of_a_generic_and_several_objects_count_together() -> None:
    path = RUNTIME / "g.adb"
    said = _said((path, [_line(5, 0, 0, 1), _line(5, 7, 3, 0)]), (path, [_line(6, 0)]))
    (body,) = read(said, PLACES)
    assert body.lines == {5: 7, 6: 0} and body.branches == {(5, 0): 3, (5, 1): 1}


def test_of_a_spec_the_functions_count_that_were_called() -> None:
    functions = [
        {"name": "a___elabs", "start_line": 1, "execution_count": 3},
        {"name": "a__only_contracts_name_it", "start_line": 10, "execution_count": 0},
        {"name": "a__enabled", "start_line": 20, "execution_count": 5},
        {"name": "a__last", "start_line": 30, "execution_count": 0},
    ]
    lines = [_line(number, 0 if number == 22 else 5, 1, 0) for number in (5, 10, 12, 20, 22, 30)]
    spec = {"file": str(GENERATED / "a.ads"), "functions": functions, "lines": lines}
    (found,) = read(json.dumps({"files": [spec]}), PLACES)
    assert (sorted(found.lines), found.left()) == ([5, 20, 22], [22])
    assert len(found.branches) == 6
    body = spec | {"file": str(GENERATED / "a.adb")}
    assert len(read(json.dumps({"files": [body]}), PLACES)[0].lines) == 6


def test_other_places_and_the_main_program_of_the_simulation_do_not_count() -> None:
    names = [Path("/elsewhere/a.adb"), GENERATED / "system_simulation.adb"]
    assert read(_said(*((name, [_line(1, 1)]) for name in names)), PLACES) == []


def test_generated_bodies_come_before_those_of_the_runtime() -> None:
    names = [RUNTIME / "a.adb", GENERATED / "z.adb", GENERATED / "b.adb"]
    found = read(_said(*((name, [_line(1, 1)]) for name in names)), PLACES)
    assert [one.path.name for one in found] == ["b.adb", "z.adb", "a.adb"]


def test_the_tracefile_is_that_of_lcov(tmp_path: Path) -> None:
    body = tmp_path / "a.adb"
    body.write_bytes(b"body")
    said = _said((body, [_line(3, 2, 2, 0), _line(4, 0, 0, 0)]))
    assert tracefile(read(said, {tmp_path: SourceOwner.GENERATED})).splitlines() == [
        "TN:",
        f"SF:{body}",
        f"VER:{hashlib.sha256(b'body').hexdigest()}",
        "BRDA:3,0,0,2",
        "BRDA:3,0,1,0",
        "BRDA:4,0,0,-",
        "BRDA:4,0,1,-",
        "BRF:4",
        "BRH:1",
        "DA:3,2",
        "DA:4,0",
        "LF:2",
        "LH:1",
        "end_of_record",
    ]


def test_numbers_that_follow_each_other_stand_together() -> None:
    assert number_ranges([]) == ""
    assert number_ranges([3, 7, 8, 9, 11, 12]) == "3, 7-9, 11-12"
