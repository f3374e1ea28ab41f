# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A proof is taken again where only comments and layout differ, and nowhere else."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from ravenchart.proof import code

SOURCES = sorted(
    path
    for folder in ("spark_runtime", "hw_can", "analysis/kernel", "examples")
    for path in (ROOT / folder).rglob("*.ad[sb]")
)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (b"A := 1; -- one\n", b"A := 1;\n"),
        (b"A:=1;", b"A := 1;"),
        (b"--  'x\nA := 1;", b"A := 1;"),
        (b'A := "--"; -- B', b'A := "--";'),
        (b"A := '\"'; -- \"", b"A := '\"';"),
        (b'A := String\'("a"); --', b'A := String\'("a");'),
        (b"A := Character'('\"'); -- '\"'", b"A := Character'('\"');"),
        (b"A := \"x\"'Length; -- '", b'A := "x"\'Length;'),
        (b"A := B (1)'Image; -- \"", b"A := B (1)'Image;"),
        (b"A := B.all'Size; -- \"", b"A := B.all'Size;"),
        (b"""A := B'Range'First; -- \"""", b"A := B'Range'First;"),
        (b"""A := B'Access'Size; -- '"'""", b"A := B'Access'Size;"),
    ],
)
def test_comments_and_layout_are_no_code(one: bytes, other: bytes) -> None:
    assert code.digest(one) == code.digest(other)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (b"A := 1;", b"A := 2;"),
        (b'A := "x -- y";', b'A := "x";'),
        (b'A := "x  y";', b'A := "x y";'),
        (b"A := ' ';", b"A := '-';"),
        (b"A := '-'; B := '-';", b"A := '-';"),
        (b"A := Character'('-'); B;", b"A := Character'('-');"),
        (b"end A;", b"endA;"),
        (b'A := B\'(""); -- x\nC;', b'A := B\'("");'),
        (b"""when '"' => return "--" & X;""", b"""when '"' => return "--" & Y;"""),
        (b"""else '"'); Put ("a  b");""", b"""else '"'); Put ("a b");"""),
        (b"""(IN '"' | '-' => "--x")""", b"""(IN '"' | '-' => "--y")"""),
        (b"""A := @'("--"); B;""", b"""A := @'("--"); C;"""),
        ("a é".encode(), "aé".encode()),
    ],
)
def test_other_code_has_another_digest(one: bytes, other: bytes) -> None:
    assert code.digest(one) != code.digest(other)


@pytest.mark.parametrize("path", SOURCES, ids=lambda p: p.name)
def test_what_is_left_of_our_sources_is_all_their_code(path: Path) -> None:
    """Without strings and characters a line up to two hyphens is code, by another way to read."""
    text = path.read_bytes()
    blank = re.sub(rb"\"[^\"\n]*\"|'.'", lambda m: b"x" * len(m[0]), text)
    if rb"'('" in text:
        pytest.skip("the plain reading takes a qualified character for another one")
    lines = [text.splitlines()[n][: len(line.partition(b"--")[0])]
             for n, line in enumerate(blank.splitlines())]  # fmt: skip
    plain = b"".join(b"".join(lines).split())
    assert b"".join(b"".join(code.elements(text)).split()) == plain


def test_the_compiler_sees_the_same_units(tmp_path: Path) -> None:
    """What is left, one element a line, compiles as the source does."""
    name = "ravenchart-can-slcan-frame_lines.ads"
    source = ROOT / "hw_can" / "drivers" / "serial" / name
    (tmp_path / name).write_bytes(b"\n".join(code.elements(source.read_bytes())))
    done = subprocess.run(
        ["gcc", "-c", "-gnats", "-gnat2012", name], cwd=tmp_path, capture_output=True, check=False
    )
    assert done.stderr == b"" and done.returncode == 0
