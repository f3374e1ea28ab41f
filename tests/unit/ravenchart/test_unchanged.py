# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Where nothing has changed, nothing is done again, and all is said again; else all is done."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import pytest
import yaml

from ravenchart.building import checking, stacks, unchanged
from ravenchart.building.compilation import Compilation
from ravenchart.building.programs import Program
from ravenchart.command_line import main
from ravenchart.failures import OK, WRONG, ToolFailed
from ravenchart.paths import ROOT
from ravenchart.stacks.report import Memory, MemoryPart, PathStep, Stack
from ravenchart.tools import kept

UNIT = Path("user/canopen_device-controller-activities.adb")
SPEC = Path("generated/canopen_device.ads")
MANIFEST = Path("generated/generated.list")


@pytest.fixture
def checks(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[list[Path]]:
    """The models that are checked. There are an empty cache and a model of three files, with a
    warning and a unit of the user that does nothing, in the working folder.
    """
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    folder = tmp_path / "device"
    shutil.copytree(ROOT / "examples" / "canopen_device", folder)
    part = folder / "device.yaml"
    text = part.read_text(encoding="utf-8")
    part.write_text(
        text.replace("    data:\n", "    data:\n      idle: {type: Count, initial: 0}\n", 1)
    )
    (folder / UNIT).unlink()
    monkeypatch.chdir(folder)
    checked: list[Path] = []
    check = checking.check

    def counted(
        path: Path, *, deadlines: bool = True, finish: bool = False, library: bool = False
    ) -> checking.Checked:
        checked.append(path)
        return check(path, deadlines=deadlines, finish=finish, library=library)

    monkeypatch.setattr("ravenchart.building.checking.check", counted)
    unchanged._tool.cache_clear()
    yield checked
    unchanged._tool.cache_clear()


Said = tuple[str, str]


@pytest.fixture
def told(checks: list[Path], capsys: pytest.CaptureFixture[str]) -> Callable[..., Said]:
    """What a call of `generate`, or of another command, says."""

    def call(*words: str) -> Said:
        assert main([*(words or ("generate",)), "model.yaml"]) == OK
        said = capsys.readouterr()
        return said.out, said.err

    return call


@pytest.fixture
def last(checks: list[Path], told: Callable[..., Said]) -> Said:
    """What is said where nothing has changed; the next call does nothing again."""
    told()
    said = told()
    checks.clear()
    assert told() == said
    assert checks == []
    return said


def test_a_call_that_does_nothing_says_what_one_that_does_all_says(
    last: Said, told: Callable[..., Said]
) -> None:
    out, err = last
    assert out == f"generated: {len(MANIFEST.read_text().splitlines())} files, 0 changed\n"
    assert "[RV-0534]" in err
    assert err.endswith(f"note: {UNIT}: its bodies do nothing yet. Write them: the file is yours\n")
    answer = told("generate", "--json")
    for entry in kept.folder(unchanged.KIND).iterdir():
        entry.unlink()
    assert told("generate", "--json") == answer
    assert told() == last
    assert json.loads(answer[0])["result"]["untouched"] == [str(UNIT)]
    assert [one["severity"] for one in json.loads(answer[0])["diagnostics"]] == ["warning", "note"]


def _append(path: Path, text: str) -> Callable[[], object]:
    return lambda: path.write_text(path.read_text(encoding="utf-8") + text, encoding="utf-8")


def _of_each_entry(text: str) -> Callable[[], object]:
    return lambda: [e.write_text(text) for e in kept.folder(unchanged.KIND).iterdir()]


def _include() -> None:
    Path("more.yaml").write_text("types:\n  Extra: {range: [0, 1]}\n", encoding="utf-8")
    text = Path("model.yaml").read_text(encoding="utf-8")
    Path("model.yaml").write_text(text.replace("include: [", "include: [more.yaml, "))


def _unlisted() -> None:
    lines = MANIFEST.read_text().splitlines(keepends=True)
    MANIFEST.write_text("".join(lines[1:]))


def _as_listed() -> None:
    """A file that is edited, and the list too: the list is not what it was."""
    SPEC.write_text(SPEC.read_text() + "--  by hand\n")
    lines = [line for line in MANIFEST.read_text().splitlines() if not line.endswith(SPEC.name)]
    MANIFEST.write_text("\n".join([*lines, f"{unchanged._digest(SPEC)}  {SPEC.name}"]) + "\n")


CHANGES = {
    "the main file": _append(Path("model.yaml"), "# more\n"),
    "an included file": _append(Path("protocol.yaml"), "# more\n"),
    "one more included file": _include,
    "an edited file": _append(SPEC, "--  by hand\n"),
    "an edited file, and so listed": _as_listed,
    "a removed file": SPEC.unlink,
    "no list": MANIFEST.unlink,
    "a shorter list": _unlisted,
    "a body of the user": _append(UNIT, "--  begun\n"),
    "a removed body of the user": UNIT.unlink,
    "an empty record": _of_each_entry(""),
    "a record of another kind": _of_each_entry("[]"),
    "a record without content": _of_each_entry("{}"),
    "a record with other content": _of_each_entry('{"read": 1, "folder": 2, "manifest": 3}'),
}


@pytest.mark.slow
@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_a_change_is_seen(
    change: Callable[[], object], last: Said, checks: list[Path], told: Callable[..., Said]
) -> None:
    change()
    told()
    assert len(checks) == 1


@pytest.mark.slow
@pytest.mark.parametrize("what", ["modules", "libraries"])
def test_another_tool_takes_nothing_of_this_one(
    what: str,
    last: Said,
    checks: list[Path],
    told: Callable[..., Said],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if what == "modules":
        changed = [*kept.sources("")[1:], ("gen/pipeline.py", "another")]
        monkeypatch.setattr(kept, "sources", lambda *_: changed)
    else:
        there = {one.name for one in Path(yaml.__path__[0]).parent.glob("*.dist-info")}
        assert there <= set(unchanged._installed())
        monkeypatch.setattr(unchanged, "_installed", lambda: [*sorted(there)[1:], "x-2.dist-info"])
    unchanged._tool.cache_clear()
    told()
    assert len(checks) == 1


@pytest.mark.slow
def test_a_model_of_another_name_or_folder_is_another(
    last: Said, checks: list[Path], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Both are in what is said."""
    assert main(["generate", "./../device/model.yaml"]) == OK
    monkeypatch.chdir(tmp_path)
    shutil.copytree("device", "other")
    monkeypatch.chdir("other")
    assert main(["generate", "model.yaml"]) == OK
    assert len(checks) == 2


@pytest.mark.slow
def test_what_is_not_finished_is_not_kept(
    checks: list[Path], told: Callable[..., Said], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ravenchart.behaviour.limits.UNFINISHED", "RV-0534")
    told()
    told()
    assert len(checks) == 2


# --- Builds ------------------------------------------------------------------------


@dataclass
class Fake:
    """Stands for gprbuild and for the examination of stacks; counts what is asked of them."""

    image: Path
    fact: Path
    calls: list[tuple[str, ...]]
    examined: int = 0
    says: str = ""
    makes: str | None = None

    def build(self, program: Program, *switches: object, **_: object) -> Path:
        """All that a build does."""
        self.examined += 1
        self.image.write_text("image")
        return self.image

    def compilation(self, program: Program, *switches: object) -> Compilation:
        """The call of gprbuild alone."""
        return Compilation(("-P", "x.gpr"), Path("generated"), {"MODE": "checks"}, self.image)

    def run(self, compilation: Compilation, *more: str) -> str:
        """The same, made again."""
        self.calls.append(compilation.arguments)
        if self.makes is not None:
            self.image.write_text(self.makes)
        return self.says


MEMORY = Memory(
    "board", "native", "checks", 100,
    [Stack("device", 20, 0, 0, 40, [PathStep("Main", 20, "")])],
    [MemoryPart("trace", 1, 2)], 3, 4, {"a.ads": "00"},
)  # fmt: skip


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Fake:
    """In place of the real ones."""
    made = Fake(tmp_path / "image", tmp_path / "frames.toml", [])
    made.fact.write_text("")
    monkeypatch.setattr(Program, "build", lambda *a, **more: made.build(*a, **more))
    monkeypatch.setattr(Program, "compilation", lambda *a: made.compilation(*a))
    monkeypatch.setattr(Compilation, "run", lambda *a, **_: made.run(*a))
    monkeypatch.setattr(stacks, "kept", lambda _: MEMORY)
    monkeypatch.setattr(stacks, "facts_of", lambda _: (made.fact,))
    return made


@pytest.fixture
def built(fake: Fake, checks: list[Path], told: Callable[..., Said]) -> Said:
    """What a build says that has nothing to do; so it is."""
    told("build")
    said = told("build")
    checks.clear()
    assert (fake.examined, len(fake.calls)) == (1, 1)
    return said


@pytest.mark.slow
def test_a_build_that_does_nothing_says_what_one_that_does_all_says(
    built: Said, told: Callable[..., Said], fake: Fake, checks: list[Path]
) -> None:
    answer = told("build", "--json")
    assert (checks, fake.examined) == ([], 1)
    for entry in kept.folder(unchanged.KIND).iterdir():
        entry.unlink()
    assert told("build", "--json") == answer
    assert told("build") == built
    assert json.loads(answer[0])["result"]["programs"][0]["memory"] == asdict(MEMORY)


@pytest.mark.slow
@pytest.mark.parametrize(
    "more", [("--driver", "loopback"), ("--mode", "release"), ("--memory", "stacks.json")]
)
def test_other_switches_are_another_build(
    more: tuple[str, str], built: Said, told: Callable[..., Said], fake: Fake, checks: list[Path]
) -> None:
    told("build", *more)
    assert (len(checks), fake.examined) == (1, 2)


@pytest.mark.slow
@pytest.mark.parametrize("change", ["an included file", "an edited file", "an empty record"])
def test_a_change_is_seen_by_a_build(
    change: str,
    built: Said,
    told: Callable[..., Said],
    fake: Fake,
    checks: list[Path],
) -> None:
    CHANGES[change]()
    told("build")
    assert (len(checks), fake.examined) == (1, 2)


@pytest.mark.slow
@pytest.mark.parametrize("what", ["another image", "no image", "other facts"])
def test_another_program_is_examined(
    what: str, built: Said, told: Callable[..., Said], fake: Fake
) -> None:
    if what == "no image":
        fake.image.unlink()
    else:
        (fake.fact if what == "other facts" else fake.image).write_text("another")
    assert told("build") == built
    assert told("build") == built
    assert fake.examined == 2


@pytest.mark.slow
def test_a_program_that_gprbuild_makes_now_is_examined_and_told_once(
    built: Said, told: Callable[..., Said], fake: Fake
) -> None:
    fake.makes, fake.says = "another", "warning: compiled\n"
    assert told("build") == (built[0], f"{built[1]}warning: compiled\n")
    assert fake.examined == 2


@pytest.mark.slow
def test_gprbuild_that_fails_fails_the_build(
    built: Said, fake: Fake, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A source that is no part of the record, or another compiler."""

    def fails(*_: object, **__: object) -> str:
        raise ToolFailed('x.adb:1:1: error: missing ";"\n')

    monkeypatch.setattr(Compilation, "run", fails)
    assert main(["build", "model.yaml"]) == WRONG
    said = capsys.readouterr()
    assert said.out == built[0].splitlines(keepends=True)[0]
    assert said.err == f'{built[1]}x.adb:1:1: error: missing ";"\n'


@pytest.mark.slow
def test_a_real_build_is_made_again_by_gprbuild_alone(
    checks: list[Path], told: Callable[..., Said]
) -> None:
    told("build")
    checks.clear()
    first, second = told("build"), told("build")
    assert first == second
    assert checks == []
    helper = Path("user/helper.ads")
    helper.write_text("package Helper is\nend Helper;\n")
    UNIT.write_text(f"with Helper;\npragma Unreferenced (Helper);\n{UNIT.read_text()}")
    told("build")
    checks.clear()
    helper.write_text("package Helper is\n   X : Integer := 5;\nend Helper;\n")
    later = helper.stat().st_mtime + 2.0  # gprbuild compares whole seconds
    os.utime(helper, (later, later))
    assert "built" in told("build")[0]
    assert len(checks) == 1


# --- What is imported ---------------------------------------------------------------

MODULES = "import sys; from ravenchart.start import main; main(sys.argv[1:]); print(*sys.modules)"


def _imported(*words: str) -> set[str]:
    called = [sys.executable, "-P", "-c", MODULES, *words]
    done = subprocess.run(called, capture_output=True, text=True, check=True)
    return set(done.stdout.splitlines()[-1].split())


SEARCHED = {"networkx", "z3", "lark", "rich", "jinja2", "matplotlib", "can", "multiprocessing"}
"""What shows, searches, measures and works in parallel."""
READS = {"pydantic", "yaml", "ravenchart.gen.pipeline", "ravenchart.gen.model.system"}


@pytest.mark.slow
def test_a_check_imports_what_it_needs(checks: list[Path]) -> None:
    _imported("check", "model.yaml")
    imported = _imported("check", "model.yaml")
    assert imported >= READS
    assert imported & SEARCHED == set()
    assert {name for name in imported if name.startswith("ravenchart.gen.emit")} == set()


def test_a_generation_of_a_model_that_has_not_changed_reads_no_model(checks: list[Path]) -> None:
    _imported("generate", "model.yaml")
    assert _imported("generate", "model.yaml") & (SEARCHED | READS) == set()
