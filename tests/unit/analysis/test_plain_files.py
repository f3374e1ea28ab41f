# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Plain files: units and rounding, errors by line and column, hostile numbers, large sets."""

from __future__ import annotations

import json
import math
import random
import time
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from ravenchart.analysis.core import holistic
from ravenchart.analysis.plain.build import PlainSystem, load_plain
from ravenchart.analysis.plain.columns import KINDS, LARGEST
from ravenchart.analysis.plain.results import analyse_plain, everything
from ravenchart.analysis.units import ratio
from ravenchart.command_line import main
from tests.support.core_cases import two_nodes

HERE = Path(__file__).parents[2] / "plain"
CSV = (HERE / "two_nodes.csv").read_text(encoding="utf-8")
JSON = (HERE / "two_nodes.json").read_text(encoding="utf-8")


def system(text: str, file: str = "a.csv") -> PlainSystem:
    found = load_plain(text, file)
    assert isinstance(found, PlainSystem), [str(problem) for problem in found]
    return found


def problems(text: str, file: str = "a.csv") -> list[str]:
    found = load_plain(text, file)
    assert not isinstance(found, PlainSystem)
    return [str(problem) for problem in found]


def task_file(**columns: str) -> str:
    given = {"task": "a", "priority": "1", "period_us": "10", "wcet_us": "1"} | columns
    return f"{','.join(given)}\n{','.join(given.values())}\n"


# --- What is read -------------------------------------------------------------------------


def test_csv_and_json_hold_the_same_system_as_the_reference() -> None:
    from_csv, from_json = system(CSV), system(JSON, "a.json")
    assert from_csv == from_json
    found, reference = (
        holistic.analyse(from_csv.network),
        holistic.analyse(two_nodes()),
    )
    for name in reference.responses:
        needed = reference.from_event(name)
        assert needed is not None
        assert found.from_event(name) == 1_000 * needed


def test_times_are_rounded_to_the_safe_side() -> None:
    text = (
        "task,priority,period_us,deadline_us,wcet_us,jitter_us,best_us\n"
        "a,1,10.0009,9.9999,1.0001,0.0001,0.9999\n"
    )
    (task,) = system(text).network.tasks
    assert (task.period, task.deadline) == (10_000, 9_999)
    assert (task.wcet, task.jitter, task.best) == (1_001, 1, 999)


def test_an_offset_is_whole_ns_and_so_is_its_period() -> None:
    (task,) = system(task_file(offset_us="2.5")).network.tasks
    assert (task.offset, task.period) == (2_500, 10_000)
    (task,) = system(task_file()).network.tasks
    assert task.offset is None
    whole = "must be whole ns: it has an offset"
    assert problems(task_file(offset_us="0.0005")) == [f"a.csv:2: error: offset of task a {whole}"]
    (told,) = problems(task_file(offset_us="0", period_us="10.0005"))
    assert told == f"a.csv:2: error: period of task a {whole}"
    (told,) = problems(task_file(offset_us="0", sporadic="yes"))
    assert told == "a.csv:2: error: offset of task a has no meaning: it is sporadic"
    assert "offset_us of task a must be at least 0" in problems(task_file(offset_us="-1"))[0]
    follows = "task,priority,period_us,wcet_us,offset_us,released_by\na,1,10,1,,\nb,2,10,1,5,a\n"
    assert problems(follows) == ["a.csv:3: error: offset of b has no meaning: a releases it"]


def test_offsets_make_bounds_shorter_and_it_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "apart.csv"
    text = "task,priority,period_us,wcet_us,offset_us\na,2,10,4,0\nb,1,10,3,5\n"
    path.write_text(text)
    assert main(["analyse", str(path)]) == 0
    assert "By their offsets: R of b. All others hold for any offsets." in capsys.readouterr().out
    main(["analyse", str(path), "--json"])
    a, b = json.loads(capsys.readouterr().out)["tasks"]
    assert (a["by_offsets"], b["by_offsets"], b["response"], b["offset"]) == (
        False,
        True,
        3000,
        5000,
    )


@pytest.mark.parametrize(
    ("title", "value", "ns"),
    [
        ("period_ns", "12", 12),
        ("period_us", "12", 12_000),
        ("period_ms", "0.1", 100_000),
        ("period_s", "1e-3", 1_000_000),
        ("period_us", "1.5E+2", 150_000),
        ("period_ns", str(LARGEST), LARGEST),
    ],
)
def test_units_are_exact(title: str, value: str, ns: int) -> None:
    text = f"task,priority,{title},wcet_ns\na,1,{value},1\n"
    assert system(text).network.tasks[0].period == ns


def test_tables_flags_identifiers_and_bit_rates() -> None:
    text = """\
task,priority,period_ms,sporadic
a,1,10,yes

row,task,wcet_us,every,phase
fast,a,5,,
slow,a,7,2,1

bus,bit_rate,data_rate,error_period_ms,error_burst
can,250000,,10,2
fd,500000,2000000,,

message,bus,identifier,extended,fd,bytes,cost_us,period_ms
m,can,0x1F,no,,8,,10
n,fd,0x1ABCDEF,yes,yes,64,,10
o,fd,7,,,,123,10
"""
    network = system(text).network
    (task,) = network.tasks
    assert (task.sporadic, task.deadline, len(task.frames)) == (True, 10**7, 2)
    assert network.frames["can"][0].transmission_time == 135 * 4_000
    assert network.buses["can"].bit_time == 4_000
    errors = network.buses["can"].errors
    assert errors is not None
    assert (errors.period, errors.burst) == (10**7, 2)
    n, o = network.frames["fd"]
    assert n.transmission_time < 64 * 8 * 2_000 and o.transmission_time == 123_000


# --- What is wrong, and where ----------------------------------------------------------


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"period_us": "0"}, "a.csv:2: error: period_us of task a must be above 0, not 0"),
        ({"period_us": "-10"}, "a.csv:2: error: period_us of task a must be above 0, not -10"),
        ({"wcet_us": "0"}, "a.csv:2: error: wcet_us of task a must be above 0, not 0"),
        ({"period_us": "0.0001"}, "period_us of task a must be at least 1 ns, not 0.0001"),
        ({"jitter_us": "-1"}, "jitter_us of task a must be at least 0, not -1"),
        ({"period_us": ""}, "period_us of task a is missing"),
        ({"wcet_us": ""}, "wcet_us of task a is missing, and it has no rows"),
        ({"priority": ""}, "priority of task a is missing"),
        ({"priority": "1.5"}, "priority of task a must be a whole number, not 1.5"),
        ({"period_us": "ten"}, "period_us of task a must be a number such as 12.5, not ten"),
        ({"period_us": "1/3"}, "period_us of task a must be a number such as 12.5, not 1/3"),
        ({"period_us": "nan"}, "must be a number such as 12.5, not nan"),
        ({"period_us": "inf"}, "must be a number such as 12.5, not inf"),
        ({"period_us": "9e99"}, f"must be at most {LARGEST} ns, 292 years, not 9e99"),
        ({"period_us": "1e999999999"}, "must be a number such as 12.5, not 1e999999999"),
        ({"period_us": "9" * 50}, "must be a number such as 12.5, not 999999"),
        ({"period_s": str(2**63)}, "period is given twice"),
        ({"priority": str(2**63)}, f"priority of task a must be at most {LARGEST} (63 bits)"),
        ({"timed": "maybe"}, "timed of task a must be yes or no, not maybe"),
        ({"period": "5"}, "column period of task must say its unit: period_ns, _us, _ms or _s"),
        ({"cost_us": "5"}, "wcet is given twice"),
        ({"task": ""}, "task needs a name in the column task"),
        ({"released_by": "b"}, "released_by of task a: there is no task or message b"),
        ({"released_by": "a"}, "a is released by itself"),
    ],
)
def test_a_wrong_value_is_named_by_line_and_column(columns: dict[str, str], message: str) -> None:
    assert any(message in problem for problem in problems(task_file(**columns)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "a.csv: error: there are neither tasks nor messages"),
        ("tusk,period_us\na,1\n", "a.csv:2: error: tusk is none of core, task, row"),
        (task_file() + "a,2,10,1\n", "a.csv:3: error: the name a is already given in line 2"),
        (task_file() + "b,2,10,1,9\n", "a.csv:3: error: the row has 5 columns"),
        (
            task_file() + "\nsection,task,length_us\no,a,2\n",
            "a.csv:2: error: the section of a on o must be at most 1000, the WCET of the task",
        ),
        (task_file() + "\nsection,task,length_us\no,c,2\n", "a.csv:5: error: task of section o"),
        (task_file() + "\nrow,task,wcet_us\nr,a,2\nr,a,3\n", "two rows of task a have the name r"),
        (
            task_file() + "\nrow,task,wcet_us,every,phase\nr,a,2,2,2\n",
            "a.csv:5: error: phase of row r must be below 2, not 2",
        ),
        (task_file() + "\ncore,release_us\nx,1\n", "a.csv:5: error: no task is on core x"),
        ("task,priority,priority\na,1,2\n", "a.csv:1: error: there are two columns priority"),
        (task_file() + '\nchain,step,hop\nc,a,"sam', "not CSV: unexpected end of data"),
        (
            task_file() + "\nchain,step,hop\nc,a,sampling\n",
            "hop of chain c must be released, sampled or queued, not sampling",
        ),
        (
            task_file() + "b,2,20,1\n\nchain,step,hop\nc,a,released\nc,b,released\n",
            "step b of chain c is not released by a",
        ),
        (
            "bus,bit_rate\nb,125000\n\nmessage,bus,identifier,bytes,period_ms\nm,b,5,9,10\n",
            "a.csv:5: error: length of a classic frame must be at most 8, not 9",
        ),
        (
            "bus,bit_rate\nb,125000\n\nmessage,bus,identifier,bytes,period_ms\nm,b,5,8,9\nn,b,5,8,9\n",
            "a.csv:6: error: identifier of message n is already that of m on bus b",
        ),
        (
            "bus,bit_rate\nb,125000\n\nmessage,bus,bytes,period_ms\nm,b,8,9\n",
            "a.csv:5: error: message m must have either an identifier or a priority",
        ),
        (
            "bus,bit_rate\nb,125000\n\nmessage,bus,identifier,priority,bytes,period_ms\n"
            "m,b,5,,8,9\nn,b,,5,8,9\n",
            "a.csv:6: error: message n has a priority and m an identifier on bus b",
        ),
        (
            "bus,bit_rate\nb,125000\n\nmessage,bus,identifier,period_ms\nm,b,5,8\n",
            "message m must have either bytes or cost_us",
        ),
        (
            "bus,bit_rate\nb,125000\n\nmessage,bus,identifier,bytes,period_ms\nm,b,2048,8,9\n",
            "a.csv:5: error: identifier of a frame must fit 11 bits, not 2048",
        ),
    ],
)
def test_what_does_not_go_together_is_refused_by_line(text: str, message: str) -> None:
    try:
        found = load_plain(text, "a.csv")
        if isinstance(found, PlainSystem):
            analyse_plain(found)
            pytest.fail("accepted")
        shown = [str(problem) for problem in found]
    except ValueError as fault:
        shown = [str(fault)]
    assert any(message in one for one in shown), shown


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "a.json:1: error: not JSON"),
        ("[1]", "a.json:1: error: the file must hold an object"),
        ('{"task": 5}', "task must be a list of objects"),
        ('{"task": [{"task": "a", "task": "b"}]}', "task is given twice in one object"),
        ('{"task": [{"task": "a", "priority": NaN}]}', "NaN is no number"),
        (
            '{"task": [\n\n{"task": "a", "priority": [1]}]}',
            "a.json:3: error: priority must be",
        ),
        (
            '{"task": [{"task":"a"},\n{"task": "b", "period_us": 0}]}',
            "a.json:2: error: period_us",
        ),
        ("[" * 100_000, "nested too deeply"),
        (
            '{"task": [{"task": "a", "priority": 1, "wcet_us": 1, "period_us": %s}]}'
            % ("9" * 9_999),
            "must be a number such as 12.5",
        ),
    ],
)
def test_wrong_json_is_refused_by_line(text: str, message: str) -> None:
    assert any(message in problem for problem in problems(text, "a.json")), problems(text, "a.json")


# --- Verdicts --------------------------------------------------------------------------


def verdict(text: str, file: str = "a.csv") -> Any:
    return json.loads(json.dumps(everything(analyse_plain(system(text, file)))))


def test_a_blocking_of_the_literature_is_taken_as_it_stands() -> None:
    text = (
        "task,priority,period_us,wcet_us,blocking_ns\n"
        "a,2,10,2,1500.5\n"
        "b,1,20,4,\n"
    )  # fmt: skip
    assert [task.held for task in system(text).network.tasks] == [1501, 0]
    answer = verdict(text)["tasks"]
    assert [(one["blocked"], one["response"]) for one in answer] == [(1501, 3501), (0, 6000)]
    assert (answer[0]["blocker"], answer[0]["object"]) == (None, None)


def test_overload_and_misses_have_a_verdict_and_a_reason() -> None:
    over = verdict("task,priority,period_us,wcet_us\na,2,10,6\nb,1,10,6\n")
    assert (over["met"], over["load"]) == (False, {"": "6/5"})
    a, b = over["tasks"]
    assert (a["response"], a["met"]) == (6_000, True)
    assert b["response"] is None and b["reason"].startswith("what runs at its level needs more")
    missed = verdict("task,priority,period_us,deadline_us,wcet_us\na,1,10,5,6\n")
    assert (missed["met"], missed["tasks"][0]["slack"]) == (False, -1_000)
    full = verdict("task,priority,period_us,wcet_us\na,2,10,5\nb,1,10,5\n")
    assert (full["met"], full["scaling"]) == (True, "1/1")


BEST = "task,priority,period_ms,wcet_ms,best_ms,released_by\na,2,10,1,{},\nb,1,10,1,1,a\n"


def test_a_best_case_shrinks_with_the_wcets_and_is_never_above_them(tmp_path: Path) -> None:
    file = tmp_path / "best.csv"
    file.write_text(BEST.format(1), encoding="utf-8")
    assert main(["analyse", str(file)]) == 0
    assert problems(BEST.format(3)) == [
        "a.csv:2: error: best of task a is 3000000, above its worst case of 1000000"
    ]


def test_huge_hyperperiods_and_numbers_near_64_bits_end_at_once() -> None:
    start = time.perf_counter()
    primes = (10**9 + 7, 10**9 + 9, 10**9 + 21, 10**9 + 33, 10**9 + 87)
    lines = [f"t{n},{n},{p},{p // 6}" for n, p in enumerate(primes)]
    assert verdict("task,priority,period_ns,wcet_ns\n" + "\n".join(lines))["met"] is True
    lines = [f"t{n},{n},{LARGEST - n},{LARGEST // 5}" for n in range(4)]
    big = verdict("task,priority,period_ns,wcet_ns\n" + "\n".join(lines))
    assert [task["response"] for task in big["tasks"]] == [k * (LARGEST // 5) for k in (4, 3, 2, 1)]
    tight = [f"t{n},{n},{p},{p // 5}" for n, p in enumerate(primes)] + ["last,-1,999999937,3"]
    assert isinstance(verdict("task,priority,period_ns,wcet_ns\n" + "\n".join(tight))["met"], bool)
    assert time.perf_counter() - start < 20


@pytest.mark.slow
def test_five_thousand_tasks_are_analysed_in_seconds(tmp_path: Path) -> None:
    lines = [f"t{n},{5_000 - n},{100 + n},0.01" for n in range(5_000)]
    file = tmp_path / "many.csv"
    file.write_text("task,priority,period_ms,wcet_ms\n" + "\n".join(lines), encoding="utf-8")
    start = time.process_time()
    assert main(["analyse", str(file)]) == 0
    assert main(["analyse", str(file), "--json"]) == 0
    assert time.process_time() - start < 30


# --- The command -----------------------------------------------------------------------


def test_the_command_prints_a_verdict_a_table_and_json(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = HERE / "two_nodes.csv"
    assert main(["analyse", str(file)]) == 0
    text = capsys.readouterr().out
    assert text.startswith("every deadline is met\nall execution times can be multiplied by 3.9")
    assert "chain control: reaction 13.4 ms, age 3.35 ms" in text
    assert main(["analyse", str(file), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [task["response"] for task in found["tasks"]] == [2_100_000, 3_960_000, 3_350_000]
    assert found["chains"][0]["reaction"] == 13_350_000
    for tool in ("mast", "cheddar", "pycpa"):
        assert main(["analyse", str(file), "--export", tool]) == 0
        assert "sense" in capsys.readouterr().out


def test_a_wrong_bit_rate_is_one_line_and_the_names_that_it_leaves_without_a_bound(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "slow.csv"
    text = (HERE / "two_nodes.csv").read_text(encoding="utf-8")
    file.write_text(text.replace("can,500000", "can,10000"), encoding="utf-8")
    assert main(["analyse", str(file)]) == 1
    assert capsys.readouterr().out.splitlines()[:4] == [
        "can is overloaded: what runs on it needs 149 % of its time",
        "without a bound because of that: wheel, frame_cmd, frame_hk",
        "chain control has no bound",
        "all execution times can be multiplied by 0.31, then wheel fails",
    ]


def test_the_command_fails_with_what_is_wrong(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "bad.csv"
    file.write_text(task_file(period_us="0"), encoding="utf-8")
    assert main(["analyse", str(file)]) == 1
    assert (
        capsys.readouterr().err == f"{file}:2: error: period_us of task a must be above 0, not 0\n"
    )
    file.write_text("task,priority,period_us,wcet_us\na,1,10,11\n", encoding="utf-8")
    assert main(["analyse", str(file)]) == 1
    assert capsys.readouterr().out.startswith(
        "the core is overloaded: what runs on it needs 110 % of its time\n"
        "without a bound because of that: a\n"
    )
    file.write_bytes(b"\xff\xfe")
    assert main(["analyse", str(file)]) == 1
    assert "must be UTF-8" in capsys.readouterr().err


def test_what_to_change_is_told_and_is_in_the_json(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "late.csv"
    file.write_text(
        "task,priority,period_ms,wcet_us\nfast,1,2,400\nslow,2,10,1700\n", encoding="utf-8"
    )
    assert main(["analyse", str(file)]) == 1
    text = capsys.readouterr().out
    assert "one of these is enough:\n  priorities of the core in this order: fast, slow\n" in text
    assert max(map(len, text.splitlines())) <= 80
    assert main(["analyse", str(file), "--json"]) == 1
    first, second, *_ = json.loads(capsys.readouterr().out)["changes"]
    assert (first["change"], first["order"]) == ("order", ["fast", "slow"])
    assert (second["of"], second["factor"]) == ("slow", "941/1000")


TABLE = """\
task,priority,period_ms,wcet_us
a,1,10,5

row,task,wcet_us,every
r,a,20,1
s,a,30,2
"""


@pytest.mark.parametrize(
    ("seen", "status", "told"),
    [
        ("task,observed_us\na,55\n", 0, "a: 55 us, within its WCET of 55 us"),
        ("task,observed_us\na,54.9999\na,55.0001\n", 1, "a: 55.001 us, ABOVE its WCET of 55 us"),
        ("row,task,observed_ns\ns,a,30001\n", 1, "a.s: 30.001 us, ABOVE its WCET of 30 us"),
        ("row,task,observed_us\ns,a,30\n", 0, "a.r: not executed in this run"),
        ("task,observed_us\nb,1\n", 1, "seen.csv:2: error: there is no task b"),
        ("core,tick_us\nb,1\n", 1, "error: core is none of task, row, message"),
        ("task,observed\na,1\n", 1, "must say its unit"),
        ("", 1, "no execution time was observed"),
    ],
)
def test_observed_times_are_held_against_wcets(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], seen: str, status: int, told: str
) -> None:
    model, times = tmp_path / "a.csv", tmp_path / "seen.csv"
    model.write_text(TABLE, encoding="utf-8")
    times.write_text(seen, encoding="utf-8")
    assert main(["analyse", str(model), "--observed", str(times)]) == status
    assert told in "".join(capsys.readouterr())


def log_uniform(chance: random.Random) -> list[int]:
    """5,000 periods from 1 ms to 1000 s."""
    return [int(math.exp(chance.uniform(math.log(10**6), math.log(10**12)))) for _ in range(5_000)]


def huge_and_coprime(chance: random.Random) -> list[int]:
    """500 periods near 10^15 ns, of which few share large factors."""
    return [10**15 + 2 * number + 1 for number in chance.sample(range(10**6), 500)]


@pytest.mark.slow
@pytest.mark.parametrize("periods", [log_uniform, huge_and_coprime])
def test_a_load_of_any_number_of_digits_is_printed_and_no_smaller_than_it_is(
    periods: Callable[[random.Random], list[int]],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    lines = ["task,priority,period_ns,wcet_ns,deadline_ns"]
    given = [(period, period // 20_000) for period in periods(random.Random(5))]
    lines += [f"t{n},{len(given) - n},{p},{c},{p}" for n, (p, c) in enumerate(given)]
    (tmp_path / "set.csv").write_text("\n".join(lines) + "\n")
    main(["analyse", str(tmp_path / "set.csv"), "--json"])
    (text,) = json.loads(capsys.readouterr().out)["load"].values()
    top, bottom = map(int, text.split("/"))
    exact = sum(Fraction(wcet, period) for period, wcet in given)
    assert exact.denominator > 10**4300
    assert exact <= Fraction(top, bottom) < exact + Fraction(1, 10**18)


def test_a_load_of_few_digits_is_exact() -> None:
    assert ratio(Fraction(1, 3)) == "1/3"
    assert ratio(Fraction(2, 10**18 - 1)) == f"2/{10**18 - 1}"
    assert ratio(Fraction(1, 3 * 10**18)) == f"1/{10**18}"


def test_every_column_is_described() -> None:
    page = (HERE.parents[1] / "docs" / "plain-files.md").read_text(encoding="utf-8")
    for kind, columns in KINDS.items():
        section = page.split(f"### {kind}\n")[1].split("\n### ")[0]
        for name, column in columns.items():
            suffix = "_us" if column.form.timed else ""
            assert f"| `{name}{suffix}` |" in section, (kind, name)


def test_messages_of_one_priority_may_go_before_each_other() -> None:
    text = "bus,bit_rate\nb,1000000\n\nmessage,bus,priority,cost_us,period_ms\n"
    found = load_plain(text + "m,b,7,100,9\nn,b,7,200,9\nk,b,-1,50,9\n", "a.csv")
    assert isinstance(found, PlainSystem)
    responses = analyse_plain(found).found.responses
    assert [responses[name].bound for name in "mnk"] == [350_000, 350_000, 350_000]


def test_files_of_earlier_versions_say_cost() -> None:
    text = "task,priority,period_us,{}\na,1,10,3\n\nrow,task,{},every\nr,a,2,1\n"
    now, before = (load_plain(text.format(name, name), "a.csv") for name in ("wcet_us", "cost_us"))
    assert isinstance(now, PlainSystem), now
    assert before == now
