# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A change of a hundred activities in the workbench: its analysis, and until the page shows it."""

from __future__ import annotations

import statistics
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ravenchart.workbench.session import Session
from tests.support.browser import CHROMIUM, launched
from tests.support.workbench_speed import ANALYSED, CHANGES, SHOWN, analysed, hundred, shown


def figure(what: str, taken: Sequence[float], aim: float) -> str:
    """Median and longest time in ms, beside the aim."""
    middle = statistics.median(taken)
    verdict = "" if middle < aim else " (missed)"
    return f"{what}: {middle:.0f} ms, longest {max(taken):.0f} ms; aim {aim:.0f} ms{verdict}"


def main() -> None:
    """Both figures."""
    print(f"a change of 100 activities in the workbench (medians of {CHANGES}):")
    with tempfile.TemporaryDirectory(prefix="ravenchart-changes-") as place:
        model = hundred(Path(place))
        taken = list(analysed(Session(model)))
        print(f"  {figure('analysis, processor time', taken, ANALYSED)}")
        if CHROMIUM is None:
            print("  Chromium is missing: `scripts/setup.sh browser` installs it")
            return
        with launched() as browser:
            print(f"  {figure('until the page shows it', shown(browser, model), SHOWN)}")


if __name__ == "__main__":
    main()
