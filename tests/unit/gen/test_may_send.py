# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Ports on which a body of the user decides in each execution whether it sends (`may_send`)."""

from __future__ import annotations

import re
from pathlib import Path

import cantools
import pytest

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.findings.deadlines import findings
from ravenchart.analysis.system.depths import depths
from ravenchart.analysis.system.journeys import journeys
from ravenchart.analysis.system.observed import read_map, read_trace
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.emit.buses.dbc import emit_dbc
from ravenchart.gen.emit.clashes import clashes
from ravenchart.gen.emit.program import generate
from ravenchart.gen.emit.tables.trace_map import trace_json
from ravenchart.gen.language.terms import named
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.component import Activity
from ravenchart.gen.model.notation import shown_expression
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.independent.check import checked
from ravenchart.language_server.completing import proposals
from ravenchart.language_server.model import model
from ravenchart.language_server.renaming import renamed
from ravenchart.paths import ROOT
from tests.support.certificates import certificate, compiled
from tests.support.links import LINK

FEATURE = ROOT / "tests" / "feature" / "may_send" / "model.yaml"
TEXT = FEATURE.read_text(encoding="utf-8")
SENT = (
    ("          - if count = limit then sent(alarm) else true\n", ""),
    ("          - if count > limit then not sent(report) else true\n", ""),
)
"""The contract without what needs the list."""
LISTS = "sends: [level]\n        may_send: [alarm, report]"
MS = 1_000_000


def text_of(*changes: tuple[str, str], text: str = TEXT) -> str:
    for old, new in changes:
        assert text.count(old) == 1, (old, text.count(old))
        text = text.replace(old, new)
    return text


def system_of(text: str = TEXT) -> System:
    loaded = load(Path("model.yaml"), lambda path, limit: text.encode())
    assert loaded.system is not None, [one.message for one in loaded.diagnostics]
    return loaded.system


def errors(text: str) -> list[Diagnostic]:
    found = load(Path("model.yaml"), lambda path, limit: text.encode()).diagnostics
    return [one for one in found if one.is_error]


def sums(analysis: Analysis) -> list[str]:
    """The certificate without the digest of the model."""
    return [
        line for line in certificate(analysis).split("\n") if not re.search("[0-9a-f]{64}", line)
    ]


def measure(system: System) -> Activity:
    return named(system.components[0].activities, "measure")


# --- the language


def test_a_port_in_the_list_is_sent_on_in_some_executions_only() -> None:
    system = system_of()
    component, activity = system.components[0], measure(system)
    assert activity.sends == ("level", "alarm", "report")
    assert [component.renews(activity, port) for port in activity.sends] == [True, False, False]


@pytest.mark.parametrize(
    ("lists", "code", "message", "hint"),
    [
        (
            "sends: [level, report]\n        may_send: [alarm, report]",
            "RV-0303",
            "`report` appears in `sends` and in `may_send`",
            "remove it from `sends` if the body decides, else from `may_send`",
        ),
        (
            "sends: [level]\n        may_send: [alarm, report, Alarm]",
            "RV-0303",
            "`alarm` appears twice in `may_send`",
            "remove one of them",
        ),
        (
            "sends: [level]\n        may_send: [alarm, reprot]",
            "RV-0305",
            "there is no output port named `reprot`",
            "did you mean `report`?",
        ),
        (
            "sends: [level]\n        may_send: {alarm: report}",
            "RV-0203",
            "`may_send` must be a list, not a mapping",
            None,
        ),
    ],
)
def test_what_is_wrong_in_the_list_is_reported(
    lists: str, code: str, message: str, hint: str | None
) -> None:
    (found,) = errors(text_of((LISTS, lists)))
    assert (found.code, found.message, found.hint) == (code, message, hint)
    line, row = TEXT[: TEXT.index("may_send: [alarm")].count("\n") + 1, found.origin.line
    assert row == line


@pytest.mark.parametrize(
    "lists",
    ["sends: [level]\n        may_send: [alarm, report]", "sends: [level, report, alarm]"],
)
def test_the_hint_of_a_port_in_both_lists_works(lists: str) -> None:
    assert errors(text_of((LISTS, lists), *SENT)) == []


def test_actions_have_no_such_list() -> None:
    acts = (
        "        body:\n          - {set: shut",
        "        may_send: []\n        body:\n          - {set: shut",
    )
    (found,) = errors(text_of(acts))
    assert (found.code, found.message) == (
        "RV-0210",
        "only a body of the user has `may_send`: actions send where they say so",
    )
    assert found.hint == "remove it; `if` makes a `send` depend on a condition"
    assert TEXT.split("\n")[found.origin.line - 1].strip().startswith("body:")


def test_a_command_is_called_and_not_sent() -> None:
    text = (ROOT / "tests" / "feature" / "contracts" / "model.yaml").read_text()
    wrong = text_of(("sends: [opening]", "sends: [opening]\n        may_send: [Beep]"), text=text)
    (found,) = errors(wrong)
    assert found.message == "`Beep` is a command to call, so it cannot stand in `may_send`"
    assert (found.code, found.hint) == ("RV-1206", "name it under `calls`")


def test_the_flag_cannot_have_the_name_of_another_port() -> None:
    text = TEXT.replace("report", "Send_Alarm")
    (found,) = clashes(system_of(text))
    assert found.code == "RV-0304"
    assert "clashes with another `Send_Alarm`" in found.message


def test_an_editor_knows_the_list() -> None:
    behind = "may_send: [al"
    offset = TEXT.index(behind) + len(behind)
    found = proposals(FEATURE, str(FEATURE), offset, {str(FEATURE): TEXT})
    assert [one.word for one in found] == ["level", "alarm", "report"]
    typed = text_of(("        may_send: [alarm, report]\n", "        may\n"))
    offset = typed.index("        may\n") + len("        may")
    found = proposals(FEATURE, str(FEATURE), offset, {str(FEATURE): typed})
    (key,) = [one for one in found if one.word == "may_send"]
    assert key.is_key and "Send_<Port>" in key.detail


def test_a_port_is_renamed_in_the_list_too() -> None:
    now = model(FEATURE, {})
    offset = TEXT.index("report: {out")
    found = now.symbols.at(str(FEATURE), offset)
    assert found is not None
    (changes,) = renamed(now, found[0], "Note", {}).values()
    assert TEXT.index("report]") in [start for start, _ in changes]


# --- the program


def files() -> dict[str, str]:
    return generate(system_of(), Claims())


def test_the_body_has_a_flag_beside_the_value() -> None:
    spec = files()["may_send_feature-gauge_type-activities.ads"]
    assert (
        "      Level       : out May_Send_Feature.Level;\n"
        "      Alarm       : out May_Send_Feature.Alarm;\n"
        "      Send_Alarm  : out Boolean;\n"
        "      Report      : out May_Send_Feature.Level;\n"
        "      Send_Report : out Boolean)\n"
    ) in spec


def test_the_glue_sends_where_the_flag_is_true_only() -> None:
    body = files()["may_send_feature-gauge.adb"]
    assert "      Send_Level (Level_Value);\n" in body
    for port in ("Alarm", "Report"):
        guarded = f"if Send_{port}_Asked then Send_{port} ({port}_Value); end if;"
        assert guarded in " ".join(body.split())
        assert body.count(f"Send_{port} ({port}_Value)") == 1


def test_what_is_ensured_of_a_value_holds_where_it_is_sent() -> None:
    spec = " ".join(files()["may_send_feature-gauge_type-activities.ads"].split())
    assert "and then (if Send_Alarm then Alarm.Level >= Limit)" in spec
    assert "(if Send_Report and then Send_Alarm then Report <= Alarm.Level)" in spec


def test_a_contract_says_when_a_value_is_sent() -> None:
    spec = " ".join(files()["may_send_feature-gauge_type-activities.ads"].split())
    assert "Post => Level = Count and then (if Count = Limit then Send_Alarm else True)" in spec
    assert "(if Count > Limit then not Send_Report else True)" in spec
    ensured = [shown_expression(clause.condition) for clause in measure(system_of()).ensures]
    assert ensured[1] == "if count = limit then sent(alarm) else true"


def test_so_does_one_of_actions_and_of_calls() -> None:
    text = (ROOT / "tests" / "feature" / "contracts" / "model.yaml").read_text()
    old = "ensures: Set_Lamp = Draining"
    system = system_of(text_of((old, "ensures: sent(Set_Lamp) = (cycles > 5)"), text=text))
    made = generate(system, Claims())["contracts_feature-plant-flows.ads"]
    assert "Post => Call_Set_Lamp = (Cycles > 5)" in " ".join(made.split())


@pytest.mark.parametrize(
    ("condition", "code", "message", "hint"),
    [
        (
            "sent(level)",
            "RV-0421",
            "measure sends on `level` in every execution",
            "leave it out, or name `level` in `may_send` instead of `sends`",
        ),
        *(
            (
                wrong,
                "RV-0409",
                "`sent` takes the name of an output port, or of a command to call",
                None,
            )
            for wrong in ("sent(count)", "sent(alarm.level)", "sent()", "sent(alarm, report)")
        ),
    ],
)
def test_only_a_port_on_which_it_may_send_is_asked(
    condition: str, code: str, message: str, hint: str | None
) -> None:
    (found,) = errors(text_of(("- level = count\n", f"- {condition}\n")))
    assert (found.code, found.message, found.hint) == (code, message, hint)


def test_what_is_asked_must_be_in_the_list() -> None:
    (found,) = errors(
        text_of((", report]", "]"), SENT[0], ("          - report <= alarm.level\n", ""))
    )
    assert (found.code, found.message) == ("RV-0420", "measure does not send on `report`")
    assert found.hint == "add `report` to `may_send`, or to `calls` if it is a command"


def test_the_hints_of_that_work() -> None:
    asked = ("- level = count\n", "- sent(level)\n")
    lists = (LISTS, "sends: []\n        may_send: [level, alarm, report]")
    assert errors(text_of(asked, lists)) == []
    assert errors(text_of(("          - level = count\n", ""))) == []


def test_nothing_is_sent_before_an_execution() -> None:
    (found,) = errors(
        text_of(("        ensures:\n", "        requires: sent(alarm)\n        ensures:\n"))
    )
    assert (found.code, found.message) == ("RV-0421", "`sent` has a meaning only in `ensures`")
    assert found.hint == "set a data item where you send, and read that"


# --- the analysis


ALWAYS = ((LISTS, "sends: [level, alarm, report]"), *SENT)
OLD = "shut: {path: [gauge.measure, valve.act], reaction: 40 ms}"


def test_times_and_queues_count_as_if_each_execution_sent() -> None:
    some, each = analyse(system_of()), analyse(system_of(text_of(*ALWAYS)))
    assert [(row.row.name, row.bound) for _, row in some.rows()] == [
        (row.row.name, row.bound) for _, row in each.rows()
    ]
    assert [(d.what, d.given, d.needed) for d in depths(some)] == [
        (d.what, d.given, d.needed) for d in depths(each)
    ]
    assert [found.reaction for _, found in some.limited] == [f.reaction for _, f in each.limited]
    assert sums(some) == sums(each)


def test_an_age_has_no_bound_and_the_reason_names_row_and_port() -> None:
    limited = (OLD, "shut: {path: [gauge.measure, valve.act], reaction: 40 ms, age: 900 ms}")
    (told,) = findings(analyse(system_of(text_of(limited))))
    assert (told.code, told.message) == (
        "RV-0905",
        "the age of shut has no bound; its limit is 900 ms",
    )
    why = "gauge.measure gives gauge.alarm a new value in some of its jobs only"
    assert [text for _, text in told.notes] == [why]
    assert told.hint == "limit the reaction instead"
    assert not list(findings(analyse(system_of(text_of(limited, *ALWAYS)))))
    assert not list(findings(analyse(system_of())))


# --- between nodes


NODES = LINK.replace(
    "body: [{send: o, with: cmd}]", "reads: [cmd], may_send: [o], body: user"
).replace(", age: 900 ms", "")
EACH = ("may_send: [o]", "sends: [o]")
AGE = ("reaction: 900 ms}", "age: 900 ms}")
BEHIND = ("path: [cmd, s.one, link, d.act, valve]", "path: [link, d.act, valve]")
BY_ACTIONS = (
    "reads: [cmd], may_send: [o], body: user",
    "body: [{if: cmd > 5, then: [{send: o, with: cmd}]}]",
)


def of_nodes(*changes: tuple[str, str]) -> Analysis:
    return analyse(system_of(text_of(*changes, text=NODES)))


def test_the_frame_has_the_period_of_the_row() -> None:
    some, each = of_nodes(), of_nodes(EACH)
    assert named(some.system.messages, "link").period == 10 * MS
    assert sums(some) == sums(each)


def test_the_reaction_over_the_bus_is_certified(tmp_path: Path) -> None:
    assert compiled(certificate(of_nodes()), tmp_path) == ""


@pytest.mark.parametrize("changes", [(), (BY_ACTIONS,)])
@pytest.mark.parametrize("start", [(), (BEHIND,)])
def test_an_age_over_the_bus_has_no_bound(
    changes: tuple[tuple[str, str], ...], start: tuple[tuple[str, str], ...]
) -> None:
    (told,) = findings(of_nodes(AGE, *changes, *start))
    assert [text for _, text in told.notes] == [
        "s.one gives s.o a new value in some of its jobs only"
    ]
    assert not list(findings(of_nodes(AGE, EACH, *start)))


def test_a_message_that_is_repeated_bounds_an_age_from_there_on() -> None:
    mixed = ("from: s.o,", "from: s.o, send: {mode: mixed, period: 200 ms},")
    assert not list(findings(of_nodes(AGE, BEHIND, mixed)))


def test_a_message_that_is_repeated_is_looked_at_in_every_execution() -> None:
    """The value is given where the flag is true only; the mode counts executions of the row."""
    mixed = ("from: s.o,", "from: s.o, send: {mode: mixed, period: 200 ms},")
    system = system_of(text_of(mixed, text=NODES))
    body = " ".join(generate(system, Claims())["cpu/sample-s.adb"].split())
    given = "if Send_O_Asked then Send_O (O_Value); end if;"
    assert f"{given} Can0.Transmit_Link;" in body


@pytest.mark.parametrize(
    ("change", "cycle"),
    [
        ((), None),
        ((EACH,), 10),
        ((("from: s.o,", "from: s.o, send: {mode: mixed, period: 200 ms},"),), 200),
    ],
)
def test_the_database_has_a_cycle_time_where_frames_come_in_time(
    change: tuple[tuple[str, str], ...], cycle: int | None
) -> None:
    system = system_of(text_of(*change, text=NODES))
    database = cantools.database.load_string(emit_dbc(system, system.buses[0]), "dbc")
    assert isinstance(database, cantools.database.Database)
    assert database.get_message_by_name("link").cycle_time == cycle


def test_a_message_of_its_own_is_the_same() -> None:
    text = text_of(("  link: {bus: can0, id: 0x111, from: s.o, to: d.i}\n", ""), text=NODES)
    text = text_of(("link, d.act", "d.act"), text=text)
    system = system_of(text.replace("messages:", "connections: [{from: s.o, to: d.i}]\nmessages:"))
    (made,) = [one for one in system.messages if one.name == "s_o"]
    assert made.period == 10 * MS


def test_the_independent_checker_knows_who_sends(tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    path.write_text(NODES)
    found = analyse(system_of(NODES))
    for name, text in generate(found.system, claims_of(found)).items():
        (tmp_path / "generated" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "generated" / name).write_text(text)
    assert checked(path).disagreements == []


def test_a_journey_ends_where_a_job_sends_nothing() -> None:
    found = of_nodes(("path: [cmd, s.one, link, d.act, valve]", "path: [s.one, link]"))
    known = read_map(trace_json(found.system))
    lines = ["E 0"]
    for time, what in (
        (10, "one"),
        (20, "one"),
        (21, "link"),
        (30, "one"),
        (40, "one"),
        (42, "link"),
    ):
        kind, name, row = (
            ("sent", what, "message") if what == "link" else ("activity", "s.one", "row")
        )
        lines.append(f"T {time * MS} {kind} {known.named(name, row).number} 0")
    (seen,) = journeys(found, read_trace([*lines, "L trace 0", "END"], known))
    #  from the executions at 10 and 30, whose inputs were just missed; those send nothing
    assert (seen.count, seen.observed) == (2, 12 * MS)
