"""The two lines of SPDX with which each of our sources begins.

``python -P -m tests.support.licences`` adds them where they are missing. Generated files have
none: they belong to those whose model they are of.
"""

from __future__ import annotations

import subprocess
import tomllib
from collections.abc import Iterator
from pathlib import Path

from ravenchart.paths import ROOT

COMMENTS = {
    ".adb": "--  ",
    ".ads": "--  ",
    ".gpr": "--  ",
}
"""For each ending of a file what begins a comment."""
GENERATED = "generated"
"""The folder of generated files, or how its name begins."""


def _own() -> dict[str, str]:
    """Holder and licence of our own files, as REUSE.toml gives them first."""
    read = tomllib.loads((ROOT / "REUSE.toml").read_text(encoding="utf-8"))
    first: dict[str, str] = read["annotations"][0]
    return first


def lines(comment: str) -> str:
    """The lines of a file whose comments begin so."""
    own = _own()
    tags = "SPDX-FileCopyrightText", "SPDX-License-Identifier"
    return "".join(f"{comment}{tag}: {own[tag]}\n" for tag in tags)


def sources() -> Iterator[Path]:
    """Our own sources of these endings."""
    command = ["git", "ls-files", "-z", *(f"*{ending}" for ending in COMMENTS)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    for name in filter(None, done.stdout.split("\0")):
        path = ROOT / name
        is_generated = any(part.startswith(GENERATED) for part in Path(name).parts)
        if not (is_generated or path.is_symlink()):
            yield path


def without_lines() -> list[Path]:
    """The sources that do not begin with their lines."""
    return [
        path
        for path in sources()
        if not path.read_text(encoding="utf-8").startswith(lines(COMMENTS[path.suffix]))
    ]


def main() -> None:
    """Add the lines where they are missing."""
    for path in without_lines():
        text = path.read_text(encoding="utf-8")
        path.write_text(f"{lines(COMMENTS[path.suffix])}\n{text}", encoding="utf-8")
        print(path.relative_to(ROOT))


if __name__ == "__main__":
    main()
