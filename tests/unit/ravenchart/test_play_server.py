# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The server of the charts in motion: what it refuses, that it lives on, and what it hands out."""

from __future__ import annotations

import json
import random
import re
import shutil
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from ravenchart.command_line import main
from ravenchart.paths import ROOT
from ravenchart.workbench import guard
from tests.support.progress import without_progress
from tests.support.workbench import (
    PATIENCE,
    Running,
    command,
    environment,
    refuses_malformed,
    refuses_other_types_and_methods,
    running,
    until,
)

pytestmark = [pytest.mark.clock, pytest.mark.slow]

PUMP = ROOT / "examples" / "pump" / "model.yaml"
SECRET = b"Infusion"
PRINTED = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the pump's model."""
    return Path(shutil.copy(PUMP, tmp_path_factory.mktemp("pump")))


@pytest.fixture(scope="module")
def running_page(model: Path) -> Iterator[Running]:
    """One page for all tests of this file."""
    with running(model, name="simulate") as found:
        yield found


@pytest.fixture
def page(running_page: Running, model: Path) -> Iterator[Running]:
    """The page, which every test must leave alive and at its start; nothing is written."""
    yield running_page
    assert running_page.process.poll() is None
    while running_page.state()["undo"] is not None:
        assert running_page.act(kind="undo").status == 200
    assert [one.name for one in model.parent.iterdir()] == ["model.yaml"]


READS = ("", "state", "events", "drawing?name=Pump.Infusion", "events.yaml", "play.js")


@pytest.mark.parametrize("token", ["", "x", "A" * 32, "%00", ".."])
def test_nothing_is_read_or_done_without_the_token(page: Running, token: str) -> None:
    number = page.state()["number"]
    for path in READS:
        reply = page.request(path, token=token)
        assert reply.status == 403 and SECRET not in reply.body, path
    message = {"kind": "execution", "chart": "bed.Infusion", "number": number}
    assert page.request("act", json.dumps(message).encode(), token=token).status == 403
    assert page.state()["number"] == number


def test_pages_of_other_origins_and_hosts_are_refused(page: Running) -> None:
    number = page.state()["number"]
    message = json.dumps({"kind": "execution", "chart": "bed.Infusion", "number": number}).encode()
    for headers in (
        {"origin": "https://evil.example"}, {"origin": "null"}, {"sec-fetch-site": "cross-site"},
        {"host": "evil.example"}, {"host": f"evil.example:{page.port}"},
    ):  # fmt: skip
        for path, body in (("state", None), ("events.yaml", None), ("act", message)):
            reply = page.request(path, body, headers)
            assert reply.status in (403, 421) and SECRET not in reply.body
            assert "access-control-allow-origin" not in reply.headers
    assert page.state()["number"] == number


MALFORMED = [
    b"", b"x", b"{}", b"[]", b"null", b"\xff\xfe", b"{" * 2000, b"[" * 8000,
    b'{"kind": "execution"}', b'{"kind": "other", "number": 0}',
    b'{"kind": "execution", "chart": 5, "number": 0}',
    b'{"kind": "execution", "chart": "bed.Infusion", "number": 0, "more": 1}',
    b'{"kind": "execution", "chart": "bed.Infusion", "number": "0"}',
    b'{"kind": "raise", "instance": "bed", "number": 0}',
    b'{"kind": "raise", "instance": "bed", "event": "", "number": 0}',
    b'{"kind": "put", "instance": "bed", "port": "line", "number": 0}',
    b'{"kind": "put", "instance": "bed", "port": "line", "value": 1.5, "number": 0}',
    b'{"kind": "put", "instance": "bed", "port": "line", "value": [1], "number": 0}',
    b'{"kind": "put", "instance": "bed", "port": "line", "value": {"a": {"b": 1}}, "number": 0}',
    b'{"kind": "put", "instance": "bed", "port": "line", "value": "\\ud800", "number": 0}',
    b'{"kind": "wait", "duration": 5, "number": 0}',
    b'{"kind": "move", "number": 0, "row": "a.b", "to": "c", "place": 0}',
]  # fmt: skip


@pytest.mark.parametrize("body", MALFORMED)
def test_a_malformed_message_is_refused_with_the_reason(page: Running, body: bytes) -> None:
    refuses_malformed(page, body)


@pytest.mark.parametrize("value", [
    "x" * 200, "a: b", "- 1", "{}", "&a *a", "!!python/object:os.system", "\u0000",
    "\U0001f600", "'\"\n", "#", "2e9", "Clear\n- {at: 0, raise: bed.Stop}", True, -(10**15),
    10**300, {"x": 1}, {"": ""},
])  # fmt: skip
def test_a_value_that_is_none_is_refused_in_words(page: Running, value: object) -> None:
    for port in ("line", "panel"):
        reply = page.act(kind="put", instance="bed", port=port, value=value)
        assert reply.status in (400, 422) and reply.json["error"]
    assert page.state()["waiting"] == 0


def test_long_messages_other_types_and_methods_are_refused(page: Running) -> None:
    long = b'{"kind": "wait", "duration": "' + b"a" * guard.LARGEST + b'", "number": 0}'
    assert page.request("act", long).status == 413
    refuses_other_types_and_methods(page)


@pytest.mark.parametrize("path", [
    "../state", "..%2fserver.py", "/etc/passwd", "drawing?name=../../etc/passwd", "drawing?name=",
    "drawing?name=structure", "source?file=model.yaml", "diff", "growth?row=x", "play/session.py",
])  # fmt: skip
def test_only_files_of_the_page_are_served(page: Running, path: str) -> None:
    reply = page.request(path)
    assert reply.status == 404 and b"root:" not in reply.body and b"import" not in reply.body


def test_a_message_about_an_earlier_state_is_refused(page: Running) -> None:
    first = page.state()["number"]
    assert page.act(kind="execution", chart="bed.Infusion").status == 200
    message = {"kind": "execution", "chart": "bed.Infusion", "number": first}
    reply = page.request("act", json.dumps(message).encode())
    assert reply.status == 409 and "look at the state now" in reply.json["error"]


def test_what_is_no_http_and_messages_with_errors_leave_it_alive(page: Running) -> None:
    chance = random.Random(5)
    for _ in range(20):
        with socket.create_connection(("127.0.0.1", page.port), PATIENCE) as line:
            line.sendall(chance.randbytes(200) + b"\r\n\r\n")
    good = json.dumps({"kind": "put", "instance": "bed", "port": "line", "value": "Clear",
                       "number": page.state()["number"]}).encode()  # fmt: skip
    for _ in range(300):
        body = bytearray(good)
        for _ in range(chance.randint(1, 8)):
            place = chance.randrange(len(body))
            body[place : place + chance.randint(0, 3)] = chance.randbytes(chance.randint(0, 3))
        assert page.request("act", bytes(body)).status in (200, 400, 409, 422), body


def test_two_pages_see_the_same_situations(page: Running) -> None:
    one, other = page.stream(), page.stream()
    changed = page.act(kind="firing", chart="bed.Infusion").json
    assert until(one, changed["number"]) == until(other, changed["number"])
    assert changed["charts"][0]["active"]


def done(page: Running) -> None:
    """Some acts: a portion, a step, air in the line, and time."""
    panel = {"key": "Portion_Key", "amount": 400}
    for message in (
        {"kind": "execution", "chart": "bed.Infusion"},
        {"kind": "time_out", "chart": "bed.Infusion"},
        {"kind": "put", "instance": "bed", "port": "panel", "value": panel},
        {"kind": "firing", "chart": "bed.Infusion"},
        {"kind": "put", "instance": "bed", "port": "line", "value": "Clear"},
        {"kind": "wait", "duration": "1500 ms"},
        {"kind": "raise", "instance": "bed", "event": "Stop"},
        {"kind": "undo"},
        {"kind": "put", "instance": "bed", "port": "line", "value": "Air"},
        {"kind": "execution", "chart": "bed.Keys"},
    ):
        reply = page.act(**message)
        assert reply.status == 200, reply.body


@pytest.mark.parametrize("more", [
    pytest.param(("--interpreter",), id="interpreter"),
    pytest.param((), id="program", marks=pytest.mark.slow),
])  # fmt: skip
def test_the_saved_event_file_is_replayed_with_the_same_trace(
    page: Running, tmp_path: Path, capsys: PRINTED, more: tuple[str, ...]
) -> None:
    assert page.request("events.yaml").status == 404
    done(page)
    reply = page.request("events.yaml")
    assert reply.headers["content-disposition"] == 'attachment; filename="events.yaml"'
    events = tmp_path / "events.yaml"
    events.write_bytes(reply.body)
    state = page.state()
    assert state["file"].encode() == reply.body and len(state["trace"]) > 5
    model = Path(shutil.copy(PUMP, tmp_path))
    assert main(["simulate", str(model), "--events", str(events), *more]) == 0
    assert capsys.readouterr().out.splitlines() == state["trace"]


def test_the_drawing_comes_with_what_draws_each_transition(page: Running) -> None:
    found = page.request("drawing?name=Pump.Infusion").json
    assert found["svg"].startswith("<?xml") and "<title>Turning</title>" in found["svg"]
    assert ["Self_Test to Programming", ""] in found["arrows"]["ready"]


# --- Start -----------------------------------------------------------------------------


def called(*words: str) -> subprocess.CompletedProcess[str]:
    """A call that ends by itself."""
    return subprocess.run(
        command(*words, name="simulate"), env=environment(), capture_output=True, text=True,
        timeout=PATIENCE, check=False,
    )  # fmt: skip


def test_an_event_file_is_the_start_and_the_answer_has_the_address(model: Path) -> None:
    events = str(PUMP.parent / "events.yaml")
    with running(model, "--events", events, name="simulate") as found:
        state = found.state()
        assert state["undo"] == "the event file" and state["now"] == "19.200 s"
        assert re.search(r"the charts are at http", "".join(found.lines))
        assert found.end() == 130


def test_without_events_and_page_the_call_is_wrong(model: Path) -> None:
    found = called(str(model))
    assert found.returncode == 2
    assert without_progress(found.stderr).endswith(
        "`simulate` needs an event file by --events, or --open for a page\n"
    )


def test_a_model_with_drivers_is_refused_with_the_way_out() -> None:
    model = ROOT / "examples" / "surgical_robot" / "model.yaml"
    found = called(str(model), "--no-open")
    assert found.returncode == 1
    assert "the interpreter knows no drivers" in found.stderr
    assert "simulate it without --open" in found.stderr


def test_a_wrong_event_file_is_refused_as_simulate_refuses_it(model: Path, tmp_path: Path) -> None:
    events = tmp_path / "events.yaml"
    events.write_text("- {at: 0, raise: bed.Nothing}\n- {until: 1 s}\n")
    mine = called(str(model), "--no-open", "--events", str(events))
    theirs = called(str(model), "--interpreter", "--events", str(events))
    assert mine.returncode == theirs.returncode == 1
    assert without_progress(mine.stderr) == without_progress(theirs.stderr)
