# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`alr` as a user calls it, without a network: its one index has the compiler of this machine."""

from __future__ import annotations

import os
import re
import subprocess
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

PROFILES = ("release", "validation", "development")
COMPILER = """\
name = "gnat_external"
description = "The GNAT on PATH"
maintainers = ["nobody@example.org"]
maintainers-logins = ["nobody"]

[[external]]
kind = "version-output"
version-command = ["gnat", "--version"]
version-regexp = "^GNAT ([\\\\d\\\\.]+).*"
provides = "gnat"
"""
"""Of https://alire.ada.dev/docs, "External releases": a crate that stands for a program on PATH."""


def manifest(crate: Path) -> dict[str, Any]:
    """The alire.toml of a crate."""
    return tomllib.loads((crate / "alire.toml").read_text(encoding="utf-8"))


@dataclass(frozen=True, slots=True)
class Alire:
    """An installation of `alr` of its own, so that the user's is not touched."""

    settings: Path

    @classmethod
    def installed(cls, folder: Path) -> Alire:
        """With an index in ``folder`` that has GNAT and nothing else."""
        index, found = folder / "index", cls(folder / "settings")
        release = index / "gn" / "gnat_external" / "gnat_external-external.toml"
        release.parent.mkdir(parents=True)
        release.write_text(COMPILER, encoding="utf-8")
        version = found.call(folder, "--version").split()[-1]
        (index / "index.toml").write_text(f'version = "{version}"\n', encoding="utf-8")
        found.call(folder, "index", "--add", f"file://{index}", "--name", "local")
        return found

    def call(self, folder: Path, *words: str, **variables: str) -> str:
        """What `alr` prints; AssertionError where it fails."""
        kept = {name: value for name, value in os.environ.items() if "RAVENCHART" not in name}
        done = subprocess.run(
            ["alr", "-n", "-c", str(self.settings), *words], cwd=folder, env=kept | variables,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout
        return done.stdout


def with_profile(crate: Path, profile: str) -> None:
    """Let a consumer compile its dependencies in a profile."""
    with (crate / "alire.toml").open("a", encoding="utf-8") as written:
        written.write(f'\n[build-profiles]\n"*" = "{profile}"\n')


def switches(crate: Path) -> list[str]:
    """Those that Alire wrote for a crate when it built a program with it."""
    name = manifest(crate)["name"]
    text = (crate / "config" / f"{name}_config.gpr").read_text(encoding="utf-8")
    return re.findall(r'"(-[^"]*)"', text)
