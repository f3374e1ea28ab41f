# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Results of tests in the form of JUnit, which most test runners write.

Times, dates and names of machines in the file are not read. The property `req` of a test names a
requirement that it tests; in pytest `record_property("req", "R-12")` writes it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree
from xml.parsers import expat

from ravenchart.failures import Refused

PASSED, FAILED, SKIPPED = "passed", "failed", "skipped"


@dataclass(frozen=True, slots=True)
class Test:
    """One test, how it ended, and the requirements that it names."""

    __test__ = False  # for pytest: this is no test itself

    name: str
    outcome: str
    why: str
    """Why it was skipped, or its failure in one line; "" where it passed."""
    requirements: tuple[str, ...]


def junit(path: Path) -> tuple[Test, ...]:
    """The tests of a file, in its order; Refused where it is none of that form."""
    content = path.read_bytes()
    if b"<!DOCTYPE" in content:
        raise Refused(f"{path}: error: a DOCTYPE is not allowed in results of tests")
    try:
        root = ElementTree.fromstring(content)
    except (ElementTree.ParseError, expat.ExpatError, ValueError) as problem:
        raise Refused(f"{path}: error: not XML: {problem}") from None
    if root.tag not in ("testsuites", "testsuite"):
        raise Refused(f"{path}: error: the outermost element must be `testsuites` or `testsuite`")
    return tuple(_test(case) for case in root.iter("testcase"))


def _test(case: ElementTree.Element) -> Test:
    name = ".".join(filter(None, (case.get("classname"), case.get("name"))))
    named = tuple(
        value
        for one in case.iter("property")
        if one.get("name") == "req" and (value := (one.get("value") or "").strip())
    )
    for tag, outcome in (("failure", FAILED), ("error", FAILED), ("skipped", SKIPPED)):
        found = case.find(tag)
        if found is not None:
            why = " ".join((found.get("message") or found.text or "").split())
            return Test(name, outcome, why[:200], named)
    return Test(name, PASSED, "", named)
