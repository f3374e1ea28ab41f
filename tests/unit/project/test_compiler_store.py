# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The compiler of the tests copies what was compiled before, and only that."""

from __future__ import annotations

import shutil
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support import compiler

Call = Callable[..., subprocess.CompletedProcess[str]]

USER = "with Limits;\nfunction User return Integer is\nbegin\n   return Limits.Most;\nend User;\n"
LIMITS = "package Limits is\n   Most : constant := {};\nend Limits;\n"


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """A compiler of its own, whose store is empty."""
    if not compiler.options():
        pytest.skip("gprbuild is not on PATH (`make setup` installs it)")
    made = tmp_path / "home"
    made.mkdir()
    for name in ("compile", "compiler"):
        shutil.copy(compiler.HOME / name, made / name)
    return made


@pytest.fixture
def call(home: Path, tmp_path: Path) -> Call:
    """Compiles the function in a folder, with a limit of that value."""

    def called(
        folder: str, *options: str, limit: int = 1, text: str = USER
    ) -> subprocess.CompletedProcess[str]:
        place = tmp_path / folder
        place.mkdir(exist_ok=True)
        (place / "limits.ads").write_text(LIMITS.format(limit))
        (place / "user.adb").write_text(text)
        words = [str(home / "compile"), "-c", "-gnat2012", *options, str(place / "user.adb")]
        return subprocess.run(words, cwd=place, capture_output=True, text=True, check=False)

    return called


def stored(home: Path) -> int:
    return len(list(home.glob("store/*/*.read")))


def test_the_same_text_is_copied_and_has_the_times_of_its_own_files(
    call: Call, home: Path, tmp_path: Path
) -> None:
    assert call("first").returncode == 0
    (object_file,) = home.glob("store/*/*.o")
    object_file.write_bytes(b"from the store")
    time.sleep(1.1)  # an ALI file has whole seconds
    assert call("second").returncode == 0
    assert (tmp_path / "second" / "user.o").read_bytes() == b"from the store"
    first, second = ((tmp_path / f / "user.ali").read_text() for f in ("first", "second"))
    written = time.gmtime((tmp_path / "second" / "limits.ads").stat().st_mtime)
    assert time.strftime("limits.ads\t\t%Y%m%d%H%M%S ", written) in second
    assert first != second and len(first) == len(second)
    assert stored(home) == 1


def test_another_text_option_or_file_that_is_read_is_compiled(call: Call, home: Path) -> None:
    assert call("a").returncode == 0
    assert call("b", limit=2).returncode == 0
    assert call("c", "-O2").returncode == 0
    assert call("d", text=USER.replace("Most", "Most + 1")).returncode == 0
    assert stored(home) == 4
    assert call("e", limit=2).returncode == 0
    assert stored(home) == 4


def test_a_call_graph_is_copied_with_its_object(call: Call, home: Path, tmp_path: Path) -> None:
    for folder in ("plain", "first", "second"):
        options = () if folder == "plain" else ("-fcallgraph-info=su",)
        assert call(folder, *options).returncode == 0
    assert stored(home) == 2
    assert not (tmp_path / "plain" / "user.ci").exists()
    first, second = (tmp_path / f / "user.ci" for f in ("first", "second"))
    assert "(static)" in first.read_text() and first.read_text() == second.read_text()
    assert second.stat().st_mtime_ns >= second.with_suffix(".ali").stat().st_mtime_ns


def test_what_prints_anything_is_compiled_each_time(call: Call, home: Path) -> None:
    warned = USER.replace("with Limits;", "with Limits; with Ada.Text_IO;")
    for folder in ("a", "b"):
        done = call(folder, "-gnatwa", text=warned)
        assert done.returncode == 0 and "warning" in done.stderr
        done = call(folder, text=USER.replace("Most", "Least"))
        assert done.returncode == 1 and "not declared" in done.stderr
    assert stored(home) == 0


def test_a_file_of_pragmas_is_named_where_it_is_now(call: Call, home: Path, tmp_path: Path) -> None:
    for folder in ("here", "far away"):
        pragmas = tmp_path / folder / "some.adc"
        pragmas.parent.mkdir()
        pragmas.write_text("pragma Ada_2012;\n")
        assert call(folder, f"-gnatec={pragmas}").returncode == 0
    assert stored(home) == 1
    place = tmp_path / "far away"
    copied = (place / "user.ali").read_text()
    gcc = (home / "compiler").read_text().splitlines()[0]
    words = [gcc, "-c", "-gnat2012", f"-gnatec={pragmas}", str(place / "user.adb")]
    subprocess.run(words, cwd=place, check=True)
    assert copied == (place / "user.ali").read_text()


def test_what_is_no_compilation_goes_to_the_compiler(home: Path) -> None:
    done = subprocess.run([home / "compile", "-dumpversion"], capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.strip()[0].isdigit()
    assert stored(home) == 0
