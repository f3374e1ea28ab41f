# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The licence of each file: lines at its head, by the REUSE specification, or a row of REUSE.toml.

`python -m tests.support.licences` writes the lines into the files that lack them. REUSE.toml has
what cannot or should not carry them: formats without comments, files that a program writes, models
whose lines are named in generated code, and pages.
"""

from __future__ import annotations

import re
import subprocess
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ravenchart.paths import ROOT

HOLDER, LICENCE = "Ravenchart contributors", "Apache-2.0"
LINES = (f"SPDX-FileCopyrightText: {HOLDER}", f"SPDX-License-Identifier: {LICENCE}")
"""What stands at the head of each file of ours, as comments."""

HASH, SLASHES, STARS, DASHES = ("# ", ""), ("// ", ""), ("/* ", " */"), ("--  ", "")
COMMENTS = {
    ".S": STARS,
    ".adb": DASHES,
    ".ads": DASHES,
    ".c": STARS,
    ".css": STARS,
    ".gpr": DASHES,
    ".js": SLASHES,
    ".ld": STARS,
    ".py": HASH,
    ".rs": SLASHES,
    ".sh": HASH,
    ".toml": HASH,
    ".yaml": HASH,
    ".yml": HASH,
}
"""How a comment begins and ends, by the ending of a file's name."""
NAMED = {".ci/run": HASH, "Makefile": HASH}
"""The same of files without an ending."""
EARLY = 5
"""Lines within which the head ends; a shell's first line is before it."""

TEXTS = ("LICENSE", "LICENSES/Apache-2.0.txt", "LICENSES/MIT.txt")
"""The licences themselves, which have none."""


@dataclass(frozen=True, slots=True)
class Annotation:
    """One table of REUSE.toml."""

    paths: tuple[str, ...]
    licence: str
    foreign: bool
    """Of others: it stands for what the files say themselves."""

    def covers(self, file: str) -> bool:
        """Whether one of its paths matches."""
        return any(_pattern(path).fullmatch(file) for path in self.paths)


@cache
def _pattern(path: str) -> re.Pattern[str]:
    """A path of REUSE.toml: `*` is anything but a slash, `**` is anything."""
    parts = re.split(r"(\*\*|\*)", path)
    words = {"**": ".*", "*": "[^/]*"}
    return re.compile("".join(words.get(part, re.escape(part)) for part in parts))


def annotated() -> tuple[Annotation, ...]:
    """Those of REUSE.toml."""
    read: dict[str, Any] = tomllib.loads((ROOT / "REUSE.toml").read_text(encoding="utf-8"))
    return tuple(
        Annotation(
            (one["path"],) if isinstance(one["path"], str) else tuple(one["path"]),
            one["SPDX-License-Identifier"],
            one.get("precedence") == "override",
        )
        for one in read["annotations"]
    )


def tracked() -> list[str]:
    """Every file of the repository that is no link."""
    done = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return [file for file in done.stdout.split("\0") if file and not (ROOT / file).is_symlink()]


def comment(file: str) -> tuple[str, str] | None:
    """How a comment begins and ends in a file, where that is known."""
    return NAMED.get(file) or COMMENTS.get(Path(file).suffix)


def wanting() -> Iterator[str]:
    """The files whose licence stands in themselves: neither a text of one nor in REUSE.toml."""
    own = annotated()
    for file in tracked():
        if file not in TEXTS and not any(one.covers(file) for one in own):
            yield file


def head(text: str) -> tuple[str, ...]:
    """The lines about the licence at the head of a file."""
    lines = text.splitlines()[:EARLY]
    found = (re.search(r"SPDX-[\w-]+: .*?(?= \*/|$)", line) for line in lines)
    return tuple(one[0] for one in found if one is not None)


def with_head(text: str, marks: tuple[str, str]) -> str:
    """The text with the lines of the licence, below the line that names its interpreter."""
    before, after = marks
    first, rest = "", text
    if text.startswith("#!"):
        first, _, rest = text.partition("\n")
        first += "\n"
    lines = "".join(f"{before}{line}{after}\n" for line in LINES)
    between = "\n" if rest and not rest.startswith("\n") else ""
    return f"{first}{lines}{between}{rest}"


def mend() -> list[str]:
    """Write what is missing; the files that have no known comments."""
    unknown = []
    for file in wanting():
        path, marks = ROOT / file, comment(file)
        text = path.read_text(encoding="utf-8")
        if head(text) == LINES:
            continue
        if marks is None:
            unknown.append(file)
        else:
            path.write_text(with_head(text, marks), encoding="utf-8")
    return unknown


def main() -> int:
    """Mend all files; 1 when one cannot be mended."""
    unknown = mend()
    for file in unknown:
        print(f"{file}: no licence, and no comments are known: see COMMENTS, or REUSE.toml")
    return 1 if unknown else 0


if __name__ == "__main__":
    raise SystemExit(main())
