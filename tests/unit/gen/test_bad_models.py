# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Every model under tests/bad_models gives exactly the text of its expect.txt."""

from __future__ import annotations

import pytest

from ravenchart.gen.diagnostics import CODES
from tests.support.bad_models import BAD_MODELS, CASES, loaded, messages


@pytest.mark.parametrize("name", CASES)
def test_bad_model_is_told_what_is_wrong_word_for_word(name: str) -> None:
    expected = (BAD_MODELS / name / "expect.txt").read_text(encoding="utf-8")
    assert messages(name) == expected


@pytest.mark.parametrize("name", CASES)
def test_bad_model_gives_a_system_only_when_there_are_warnings_only(name: str) -> None:
    result = loaded(name)
    assert (result.system is None) == any(item.is_error for item in result.diagnostics)


def test_nearly_every_code_is_shown_by_a_bad_model() -> None:
    shown = "\n".join((BAD_MODELS / name / "expect.txt").read_text() for name in CASES)
    unshown = [code for code in CODES if f"[{code}]" not in shown]
    # large or odd files, which the tests of the loader make in memory; then deadlines,
    # which the tests of the analysis show, and a check that has no time left
    late = [f"RV-{number:04}" for number in range(901, 913)]
    # what is analysed but not generated, which stops a generation only
    unready = ["RV-0804"]
    # files of events, which have tests of their own
    stimuli = [f"RV-{number}" for number in range(1001, 1011)]
    # and so have scenarios
    scenarios = [f"RV-{number}" for number in range(1301, 1307)]
    # and lists of requirements
    lists = [f"RV-{number}" for number in range(1401, 1407)]
    # and stacks, which are bounded in a build
    stacks = [f"RV-{number}" for number in range(1501, 1505)]
    read = ["RV-0102", "RV-0103", "RV-0113"]
    others = ["RV-1110", *scenarios, *lists, *stacks]
    assert unshown == [*read, *unready, *late, *stimuli, *others]
