# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The bad models, and what loading them, their program and their behaviour prints.

After a deliberate change of a message, `python -m tests.support.bad_models`
writes every expect.txt anew; read the difference before you keep it.
"""

from __future__ import annotations

from pathlib import Path

from ravenchart.behaviour.rules import behaviour
from ravenchart.gen.diagnostics import Diagnostic, in_order, render
from ravenchart.gen.emit.clashes import clashes
from ravenchart.gen.pipeline import Loaded, load

BAD_MODELS = Path(__file__).parent.parent / "bad_models"
CASES = sorted(path.name for path in BAD_MODELS.iterdir() if path.is_dir())


def loaded(name: str) -> Loaded:
    """The case, its files named as seen from its own directory."""

    def read(path: Path, limit: int) -> bytes:
        return (BAD_MODELS / name / path).read_bytes()[:limit]

    return load(Path("model.yaml"), read)


def messages(name: str) -> str:
    """What loading the case prints, and what its behaviour gets wrong."""
    result = loaded(name)
    late: tuple[Diagnostic, ...] = ()
    if result.system is not None:
        late = in_order(clashes(result.system), result.sources) or behaviour(result.system).found
    found = (*result.diagnostics, *late)
    return "\n".join(render(item, result.sources) for item in found) + "\n"


if __name__ == "__main__":
    for case in CASES:
        (BAD_MODELS / case / "expect.txt").write_text(messages(case), encoding="utf-8")
