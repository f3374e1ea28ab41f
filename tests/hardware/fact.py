"""A test program in Ada, whose facts become JUnit XML.

Run as ``python -P -m tests.hardware.fact [--junit FILE] PROGRAM [WORD ...]``. The program
prints "ok <fact>" or "not ok <fact>" lines, as those of tests/ada do.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree


@dataclass(frozen=True, slots=True)
class Fact:
    """One line of a test program."""

    text: str
    holds: bool


def facts(output: str, status: int) -> tuple[Fact, ...]:
    """What a program found, and that it ended well: status 0 just when all its facts hold."""
    found = [
        Fact(line.removeprefix("not ").removeprefix("ok "), line.startswith("ok "))
        for line in output.splitlines()
        if line.startswith(("ok ", "not ok "))
    ]
    if not found:
        found.append(Fact("it says a fact", False))
    if status != 0 and all(fact.holds for fact in found):
        found.append(Fact(f"it ends well, not with status {status}", False))
    return tuple(found)


def junit(name: str, found: tuple[Fact, ...]) -> str:
    """JUnit XML, one test case for each fact."""
    failures = sum(not fact.holds for fact in found)
    suite = ElementTree.Element(
        "testsuite", name=name, tests=str(len(found)), failures=str(failures), errors="0",
        skipped="0",
    )  # fmt: skip
    for fact in found:
        case = ElementTree.SubElement(suite, "testcase", classname=name, name=fact.text)
        if not fact.holds:
            ElementTree.SubElement(case, "failure", message="does not hold")
    root = ElementTree.Element("testsuites")
    root.append(suite)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def main() -> int:
    """0 when every fact holds, 1 otherwise, 2 when the program cannot be run."""
    parser = argparse.ArgumentParser(prog="fact")
    parser.add_argument("--junit", type=Path, metavar="FILE", help="write JUnit XML there")
    parser.add_argument("command", nargs="+", metavar="PROGRAM")
    options = parser.parse_args()
    try:
        done = subprocess.run(
            options.command,
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, errors="replace", check=False,
        )  # fmt: skip
    except OSError as problem:
        print(f"fact: error: {problem}", file=sys.stderr)
        return 2
    print(done.stdout, end="")
    found = facts(done.stdout, done.returncode)
    if options.junit is not None:
        options.junit.write_text(junit(Path(options.command[0]).name, found), encoding="utf-8")
    return 0 if all(fact.holds for fact in found) else 1


if __name__ == "__main__":
    raise SystemExit(main())
