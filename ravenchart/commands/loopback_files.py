# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The loopback test as JUnit XML and as one HTML file that needs nothing else."""

from __future__ import annotations

from xml.etree import ElementTree

from jinja2 import PackageLoader

from ravenchart.analysis.present.page import environment
from ravenchart.hw_can.conformance.suite import CaseVerdict, SuiteResult, histogram


def facts(result: SuiteResult) -> tuple[tuple[str, str], ...]:
    """The tested setup, as names and values."""
    setup = result.setup
    other = "the same bus object" if setup.echo else setup.receive_interface
    return (
        ("interface", setup.interface),
        ("channel", setup.channel),
        ("receive interface", other),
        ("receive channel", setup.receive_channel),
        ("bit rate", "of the interface" if setup.bitrate is None else f"{setup.bitrate} bit/s"),
        ("CAN FD", "yes" if setup.fd else "no"),
    )


def junit(result: SuiteResult) -> str:
    """JUnit XML, one test case for each case; a skipped one is never a passed one."""
    suite = ElementTree.Element(
        "testsuite",
        name=f"loopback {result.setup.interface}",
        tests=str(len(result.cases)),
        failures=str(result.count(CaseVerdict.FAILED)),
        errors="0",
        skipped=str(result.count(CaseVerdict.SKIPPED)),
        time=f"{result.seconds:.3f}",
    )
    properties = ElementTree.SubElement(suite, "properties")
    for name, value in facts(result):
        ElementTree.SubElement(properties, "property", name=name, value=value)
    for case in result.cases:
        element = ElementTree.SubElement(
            suite,
            "testcase",
            classname=f"loopback.{result.setup.interface}",
            name=case.name,
            time=f"{case.seconds:.3f}",
        )
        if case.verdict is CaseVerdict.PASSED:
            ElementTree.SubElement(element, "system-out").text = case.detail
        else:
            tag = "failure" if case.verdict is CaseVerdict.FAILED else "skipped"
            ElementTree.SubElement(element, tag, message=case.detail)
    root = ElementTree.Element("testsuites")
    root.append(suite)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def html(result: SuiteResult) -> str:
    """The report, in the style of the timing report."""
    pages = environment(PackageLoader("ravenchart.commands", "."))
    bars = histogram(result.latencies)
    return pages.get_template("loopback.html").render(
        result=result,
        facts=facts(result),
        counts=[(verdict.value.lower(), result.count(verdict)) for verdict in CaseVerdict],
        bars=bars,
        highest=max((count for _, count in bars), default=1),
    )
