# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The size of the generated Ada of the examples, and the warnings that it switches off.

Of some, beside the figures before the rooms of the generator were made. Both are to fall.
"""

from __future__ import annotations

import re

from ravenchart.paths import ROOT

OFF = re.compile(r"^ *pragma Warnings \(Off", re.M)
BEFORE = {
    "cartesian_robot": (10_905, 0),
    "crossing": (4_564, 98),
    "pump": (6_350, 106),
    "qhsmtst": (2_459, 92),
    "three_components": (3_333, 0),
}
"""Lines, and pragmas that switch warnings off."""
EXAMPLES = tuple(sorted(path.parent.name for path in (ROOT / "examples").glob("*/generated/")))


def counted(example: str) -> tuple[int, int]:
    """The same of an example now."""
    files = sorted((ROOT / "examples" / example / "generated").rglob("*.ad?"))
    texts = [path.read_text(encoding="utf-8") for path in files]
    lines = sum(text.count("\n") for text in texts)
    return lines, sum(len(OFF.findall(text)) for text in texts)


def _before(example: str) -> str:
    if example not in BEFORE:
        return ""
    lines, off = BEFORE[example]
    return f"  before {lines:6,} lines {off:4} off"


def main() -> None:
    """The figures."""
    print("generated Ada (lines; warnings switched off):")
    for example in EXAMPLES:
        lines, off = counted(example)
        print(f"  {example:<16} now {lines:6,} lines {off:4} off{_before(example)}")
    lines, off = (sum(part) for part in zip(*map(counted, EXAMPLES), strict=True))
    print(f"  {'all':<16} now {lines:6,} lines {off:4} off")


if __name__ == "__main__":
    main()
