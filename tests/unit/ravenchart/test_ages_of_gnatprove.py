# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The gnatprove of each age is told what it understands, and named with its provers."""

from __future__ import annotations

import pytest

from ravenchart.proof import ages

OLDER = """\
12.1.0
Why3 for gnatprove version 1.4.0+git
/opt/spark/libexec/spark/bin/alt-ergo: Alt-Ergo version 2.4.0
/opt/spark/libexec/spark/bin/cvc4: This is CVC4 version 1.8
compiled with GCC version 12.2.0
/opt/spark/libexec/spark/bin/z3: Z3 version 4.8.12 - 64 bit
"""
YOUNGER = """\
FSF 14.1
Why3 for gnatprove version 1.6.0
/opt/spark/libexec/spark/bin/cvc5: This is cvc5 version 1.1.2 [git tag 1.1.2 branch HEAD]
compiled with GCC version 14.2.0
/opt/spark/libexec/spark/bin/z3: Z3 version 4.13.3 - 64 bit
"""


@pytest.mark.parametrize(
    "version, age, switches",
    [
        (OLDER, "gnat-12", ("--prover=z3,cvc4", "--checks-as-errors")),
        (YOUNGER, "gnat-14", ("--prover=z3,cvc5", "--checks-as-errors=on", "--timeout=30")),
    ],
)
def test_each_age_has_switches_of_its_own(
    version: str, age: str, switches: tuple[str, ...]
) -> None:
    found = ages.age_of(version)
    assert found.name == age
    assert found.switches == switches


def test_the_tool_is_named_with_its_provers() -> None:
    older = "gnatprove 12.1.0, Why3 1.4.0+git, Alt-Ergo 2.4.0, CVC4 1.8, Z3 4.8.12"
    assert ages.tool_text(OLDER) == older
    assert ages.tool_text(YOUNGER) == "gnatprove FSF 14.1, Why3 1.6.0, cvc5 1.1.2, Z3 4.13.3"
