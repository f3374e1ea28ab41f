# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A run in which only tests failed that depend on the host's clock asks for a second, alone.

A test marked ``clock``, ``live`` or ``alone`` waits for processes: a host that withholds the core
for a second fails it. Any other test that fails fails the run at once, and so does one that fails
a second time.
"""

from __future__ import annotations

from pathlib import Path

import pytest

STATUS = 8
"""What pytest ends with where the Makefile runs the named tests once more, alone."""
MOST = 5
"""With more failures than these, something is broken."""
MARKS = frozenset({"clock", "live", "alone"})


class Again:
    """Hooks of the process that gives out the tests."""

    def __init__(self, path: Path) -> None:
        """The tests to run once more are named in the file ``path``, a line each."""
        self._path = path
        self._failed: dict[str, bool] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note what failed, and whether it depends on the clock."""
        if report.failed:
            self._failed[report.nodeid] = not MARKS.isdisjoint(report.keywords)

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Ask for the second run."""
        self._path.unlink(missing_ok=True)
        if session.exitstatus == pytest.ExitCode.TESTS_FAILED and self._asks:
            self._path.write_text("".join(f"{name}\n" for name in self._failed), encoding="utf-8")
            session.exitstatus = STATUS

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Say so."""
        if self._path.exists():
            failed = len(self._failed)
            terminalreporter.write_line(f"{failed} depend on the clock, and run once more, alone")

    @property
    def _asks(self) -> bool:
        return 0 < len(self._failed) <= MOST and all(self._failed.values())
