# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Lists of requirements, results of tests, and which elements of a model can name ids."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.evidence import lists, results
from ravenchart.failures import Refused
from ravenchart.gen.files.links import links
from ravenchart.gen.files.load import read_model
from ravenchart.gen.files.reference import schema
from ravenchart.hw_can.bench.scenario import ScenarioError, parse_scenario

REQIF = """\
<?xml version="1.0" encoding="UTF-8"?>
<REQ-IF xmlns="http://www.omg.org/spec/ReqIF/20110401/reqif.xsd"
        xmlns:xhtml="http://www.w3.org/1999/xhtml">
  <CORE-CONTENT><REQ-IF-CONTENT>
    <SPEC-TYPES><SPEC-OBJECT-TYPE IDENTIFIER="t"><SPEC-ATTRIBUTES>
      <ATTRIBUTE-DEFINITION-STRING IDENTIFIER="a1" LONG-NAME="ReqIF.ForeignID"/>
      <ATTRIBUTE-DEFINITION-XHTML IDENTIFIER="a2" LONG-NAME="ReqIF.Text"/>
    </SPEC-ATTRIBUTES></SPEC-OBJECT-TYPE></SPEC-TYPES>
    <SPEC-OBJECTS>
      <SPEC-OBJECT IDENTIFIER="_u1"><VALUES>
        <ATTRIBUTE-VALUE-STRING THE-VALUE="R-7">
          <DEFINITION><ATTRIBUTE-DEFINITION-STRING-REF>a1</ATTRIBUTE-DEFINITION-STRING-REF></DEFINITION>
        </ATTRIBUTE-VALUE-STRING>
        <ATTRIBUTE-VALUE-XHTML><THE-VALUE><xhtml:div>Stop <xhtml:b>at
          once</xhtml:b></xhtml:div></THE-VALUE>
          <DEFINITION><ATTRIBUTE-DEFINITION-XHTML-REF>a2</ATTRIBUTE-DEFINITION-XHTML-REF></DEFINITION>
        </ATTRIBUTE-VALUE-XHTML>
      </VALUES></SPEC-OBJECT>
      <SPEC-OBJECT IDENTIFIER="R-8" LONG-NAME="By its name"/>
    </SPEC-OBJECTS>
  </REQ-IF-CONTENT></CORE-CONTENT>
</REQ-IF>
"""


def _read(tmp_path: Path, name: str, text: str) -> list[tuple[str, str, int]]:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return [(one.id, one.text, one.origin.line) for one in lists.read(path, name)]


def test_a_csv_file_is_read_with_quotes_blank_rows_and_more_columns(tmp_path: Path) -> None:
    text = '\ufeffID,Level,Text\nR-1,A,"One, two\nlines"\n,,\nR-2,B,Three\n'
    assert _read(tmp_path, "list.csv", text) == [("R-1", "One, two lines", 2), ("R-2", "Three", 5)]


def test_a_reqif_file_is_read_by_foreign_id_or_identifier(tmp_path: Path) -> None:
    found = _read(tmp_path, "list.reqif", REQIF)
    assert found == [("R-7", "Stop at once", 10), ("R-8", "By its name", 19)]


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.csv", "", "a.csv:1:1: error: a.csv has no requirement [RV-1401]"),
        ("a.csv", "id;text\n", "a.csv:1:1: error: the first row has no column `id` [RV-1401]"),
        ("a.csv", "id,text\nR-1,a,b\n", "a.csv:2:1: error: the row has 3 columns"),
        ("a.csv", 'id,text\nR-1,"a\n', "error: not CSV: unexpected end of data [RV-1401]"),
        ("a.csv", "id,text\nR 1,a\n", "a.csv:2:1: error: `R 1` is not the id of a requirement"),
        ("a.csv", "id,text\nR-1,a\nR-1,b\n", "a.csv:3:1: error: the id R-1 is given twice"),
        ("a.reqif", "<REQ-IF>", "error: not XML: no element found [RV-1401]"),
        ("a.reqif", "<html/>", "is no ReqIF"),
        ("a.reqif", "<!DOCTYPE a [<!ENTITY b 'c'>]><REQ-IF/>", "a DOCTYPE is not allowed"),
        ("a.reqif", "<a>" * 300, "nested more than 200 deep"),
    ],
)
def test_a_wrong_list_is_refused_with_its_place(
    tmp_path: Path, name: str, text: str, said: str
) -> None:
    with pytest.raises(Refused) as refused:
        _read(tmp_path, name, text)
    assert said in str(refused.value)


def test_results_of_tests_are_read_without_times(tmp_path: Path) -> None:
    path = tmp_path / "results.xml"
    path.write_text(
        '<testsuite><testcase classname="a" name="b" time="3"/>'
        '<testcase name="c"><failure message="x&#10;y"/></testcase>'
        '<testcase name="d"><properties><property name="req" value="R-1"/></properties>'
        "<skipped/></testcase></testsuite>",
        encoding="utf-8",
    )
    assert [(t.name, t.outcome, t.why, t.requirements) for t in results.junit(path)] == [
        ("a.b", "passed", "", ()),
        ("c", "failed", "x y", ()),
        ("d", "skipped", "", ("R-1",)),
    ]
    for text in ("", "<html/>", "<!DOCTYPE x><testsuite/>"):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(Refused):
            results.junit(path)


def test_every_form_of_a_model_takes_requirements() -> None:
    made = schema()
    for name, form in {"ModelFile": made, **made["$defs"]}.items():
        assert "req" in form["properties"], name


MODEL = """\
system: Demo
req: [R-0]
types: {Level: {range: [0, 9], req: [R-1]}}
components:
  Tank:
    req: [R-2]
    ports: {level: {in: Level, req: [R-3]}}
    events: {Lost: {req: [R-4]}}
    never: {full: {condition: true, req: [R-5]}}
    regions:
      Control:
        req: [R-6]
        period: 1 ms
        wcet: 1 us
        initial: {to: Idle, req: [R-7]}
        states: {Idle: {req: [R-8], entry: [{set: a, to: 1, req: [R-9]}]}}
        transitions: {go: {from: Idle, req: [R-10]}}
    activities: {work: {period: 1 ms, wcet: 1 us, body: user, req: [R-11]}}
nodes: {board: {context_switch: 1 us, critical_section: 1 us, req: [R-12]}}
instances: {tank: {component: Tank, node: board, req: [R-13]}}
connections: [{from: a.b, to: c.d, req: [R-14]}]
messages: {m: {bus: b, req: [R-15]}}
processors: {p: {stack: 1 KiB, activities: [a.b], req: [R-16]}}
chains: {c: {path: [a, b], req: [R-17]}}
shutdown: {raises: [], grace: 0 ms, req: [R-18]}
devices: {pump: {type: T, req: [R-19, R-20]}}
"""


def test_an_element_is_named_from_the_outside_to_the_inside() -> None:
    content = read_model(Path("model.yaml"), lambda path, limit: MODEL.encode())
    found = links(content.forms)
    assert {(one.element, one.kind): one.ids for one in found} == {
        ("Demo", "model"): ("R-0",),
        ("Level", "type: an integer range"): ("R-1",),
        ("Tank", "component"): ("R-2",),
        ("Tank.level", "port: input"): ("R-3",),
        ("Tank.Lost", "event"): ("R-4",),
        ("Tank.full", "invariant"): ("R-5",),
        ("Tank.Control", "region"): ("R-6",),
        ("Tank.Control.initial", "initial transition"): ("R-7",),
        ("Tank.Control.Idle", "state"): ("R-8",),
        ("Tank.Control.Idle.entry[1]", "action: set"): ("R-9",),
        ("Tank.Control.go", "transition"): ("R-10",),
        ("Tank.work", "activity"): ("R-11",),
        ("board", "node"): ("R-12",),
        ("tank", "instance"): ("R-13",),
        ("connections[1]", "connection"): ("R-14",),
        ("m", "message"): ("R-15",),
        ("p", "processor"): ("R-16",),
        ("c", "chain"): ("R-17",),
        ("shutdown", "shutdown"): ("R-18",),
        ("pump", "device"): ("R-19", "R-20"),
    }
    assert str(found[1].origin) == "model.yaml:3:9"


def test_a_scenario_names_requirements_too() -> None:
    text = "scenario: x\nreq: [R-1]\nsteps:\n  - {wait: 3 ms, req: [R-2]}\n"
    scenario = parse_scenario(text)
    assert [step.req for step in scenario.steps] == [("R-2",)]
    with pytest.raises(ScenarioError) as refused:
        parse_scenario(text.replace("R-2", "R 2"))
    assert "`req` must be the id of a requirement such as `R-12`, not `R 2`" in str(refused.value)
