# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Completion scripts, executed by the shells themselves."""

from __future__ import annotations

import os
import pty
import select
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from ravenchart.command_line import COMMANDS, whole_parser
from ravenchart.grammar import grammar
from tests.support.processes import ROOT

SHELLS = ("bash", "zsh", "fish")


@cache
def script(shell: str) -> str:
    """The script, as the command prints it."""
    words = [sys.executable, "-P", "-m", "ravenchart.start", "completion", shell]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    return done.stdout


def shell_of(name: str) -> str:
    """The shell; the test is skipped where it is not installed."""
    if shutil.which(name) is None:
        pytest.skip(f"{name} is not on PATH")
    return name


BASH = """
source "$1"; shift
complete -p ravenchart >/dev/null || exit 9
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
_ravenchart ravenchart "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD-1]}"
((${#COMPREPLY[@]})) && printf '%s\\n' "${COMPREPLY[@]}"
exit 0
"""


def in_bash(folder: Path, *words: str) -> list[str]:
    """What bash proposes for the last word."""
    file = folder / ".script"
    file.write_text(script("bash"))
    done = subprocess.run(
        [shell_of("bash"), "--norc", "-c", BASH, "bash", file, "ravenchart", *words],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout.splitlines()


def in_fish(folder: Path, *words: str) -> list[str]:
    """What fish proposes for the last word."""
    file = folder / ".script"
    file.write_text(script("fish"))
    line = " ".join(["ravenchart", *words])
    done = subprocess.run(
        [shell_of("fish"), "--no-config", "-c", f'source {file}; complete -C "{line}"'],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stderr) == (0, "")
    return [line.partition("\t")[0] for line in done.stdout.splitlines()]


ZSH = """
zmodload zsh/zpty; autoload -Uz compinit; compinit -u -D
zstyle ':completion:*' list-prompt ''
setopt no_list_ambiguous; LISTMAX=9999; stty columns 300 rows 200
source .script
PS1='READY>'
"""


def in_zsh(folder: Path, words: str, wanted: set[str]) -> set[str]:
    """What zsh, at a terminal, shows when Tab is pressed twice behind the words.

    It is read until all is there that is wanted, and for a while longer.
    """
    (folder / ".script").write_text(script("zsh"))
    (folder / ".zshrc").write_text(ZSH)
    child, terminal = pty.fork()
    if child == 0:
        os.chdir(folder)
        environment = {**os.environ, "ZDOTDIR": str(folder), "TERM": "dumb"}
        os.execvpe("zsh", ["zsh", "-d", "-i"], environment)
    try:
        _read(terminal, lambda text: "READY>" in text)
        os.write(terminal, f"ravenchart {words}\t\t".encode())
        shown = _read(terminal, lambda text: wanted <= _words(text))
        shown += _read(terminal, lambda _: False, seconds=0.5)
    finally:
        os.kill(child, 9)
        os.waitpid(child, 0)
        os.close(terminal)
    return _words(shown)


def _words(text: str) -> set[str]:
    return set(text.replace("\x07", " ").split())


def _read(terminal: int, done: Callable[[str], bool], seconds: float = 30.0) -> str:
    text, end = "", time.monotonic() + seconds
    while not done(text) and time.monotonic() < end:
        if select.select([terminal], [], [], 0.1)[0]:
            text += os.read(terminal, 65536).decode(errors="replace")
    return text


Completed = Callable[..., list[str]]
EACH = pytest.mark.parametrize("completed", [in_bash, in_fish], ids=["bash", "fish"])


@EACH
def test_every_command_and_every_option_is_proposed(completed: Completed, tmp_path: Path) -> None:
    assert set(COMMANDS) <= set(completed(tmp_path, ""))
    assert completed(tmp_path, "expl") == ["explain"]
    for command in grammar(whole_parser()).commands:
        flags = {flag for word in command.options for flag in word.flags if flag[:2] == "--"}
        for name in command.names:
            assert flags <= set(completed(tmp_path, name, "--")), name


@EACH
def test_every_choice_is_proposed(completed: Completed, tmp_path: Path) -> None:
    count = 0
    for command in grammar(whole_parser()).commands:
        for word in command.options:
            if word.choices:
                count += 1
                found = completed(tmp_path, command.name, word.flags[0], "")
                assert sorted(found) == sorted(word.choices)
    assert count > 5
    assert completed(tmp_path, "completion", "f") == ["fish"]
    assert completed(tmp_path, "explain", "RV-0305") == ["RV-0305"]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with files of several kinds."""
    for name in ("model.yaml", "my model.yaml", "set.csv", "notes.txt"):
        (tmp_path / name).write_text("")
    (tmp_path / "models").mkdir()
    return tmp_path


def test_bash_proposes_models_files_and_folders(folder: Path) -> None:
    assert sorted(in_bash(folder, "check", "m")) == ["model.yaml", "models", "my model.yaml"]
    assert "notes.txt" not in in_bash(folder, "analyse", "")
    assert in_bash(folder, "run", "model.yaml", "--scenario", "n") == ["notes.txt"]
    assert in_bash(folder, "draw", "model.yaml", "--out", "") == ["models"]
    assert in_bash(folder, "run", "model.yaml", "--seconds", "") == []
    assert in_bash(folder, "nonsense", "") == []


def test_bash_completes_what_stands_behind_an_equals_sign(tmp_path: Path) -> None:
    assert in_bash(tmp_path, "draw", "--format", "=", "m") == ["mermaid"]
    assert in_bash(tmp_path, "draw", "--format", "=")[0] == "svg"


def test_fish_proposes_files_and_folders(folder: Path) -> None:
    assert "model.yaml" in in_fish(folder, "check", "m")
    assert in_fish(folder, "draw", "--out", "m") == ["models/"]


def test_zsh_completes_commands_options_choices_and_files(folder: Path) -> None:
    shell_of("zsh")
    for words, wanted in (
        ("expl", {"explain"}),
        ("build --driver ", {"loopback", "slcan", "socketcan"}),
        ("check --", {"--watch", "--json"}),
        ("check ", {"model.yaml"}),
    ):
        shown = in_zsh(folder, words, wanted)
        assert wanted <= shown and "notes.txt" not in shown


@pytest.mark.parametrize("shell", SHELLS)
def test_a_script_is_well_formed(shell: str, tmp_path: Path) -> None:
    file = tmp_path / "script"
    file.write_text(script(shell))
    done = subprocess.run([shell_of(shell), "-n", file], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_help_texts_have_no_marks_of_argparse() -> None:
    told = grammar(whole_parser())
    words = [*told.options, *(word for command in told.commands for word in command.words)]
    assert [word for word in words if "%" in word.help] == []
