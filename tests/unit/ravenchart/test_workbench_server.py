# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The server of the workbench: who may talk to it, what it refuses, and that it lives on."""

from __future__ import annotations

import json
import os
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from ravenchart.workbench import guard
from tests.support.can_frames import within
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

pytestmark = pytest.mark.clock

ROBOT = ROOT / "examples" / "cartesian_robot"
SECRET = b"Cartesian_Robot"


def copied(folder: Path) -> Path:
    """A copy of the robot's model."""
    for path in ROBOT.glob("*.yaml"):
        shutil.copy(path, folder)
    return folder / "model.yaml"


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The model that the workbench of these tests shows."""
    return copied(tmp_path_factory.mktemp("robot"))


@pytest.fixture(scope="module")
def running_bench(model: Path) -> Iterator[Running]:
    """One workbench for all tests of this file."""
    with running(model) as found:
        yield found


@pytest.fixture
def bench(running_bench: Running, model: Path) -> Iterator[Running]:
    """The workbench, which every test must leave alive and its files as they were."""
    before = {path: path.read_bytes() for path in model.parent.iterdir()}
    yield running_bench
    assert running_bench.process.poll() is None
    assert running_bench.state()["system"] == "Cartesian_Robot"
    assert {path: path.read_bytes() for path in model.parent.iterdir()} == before


READS = ("", "state", "events", "diff", "source?file=model.yaml", "growth?row=joint_x.ports",
         "drawing?name=structure", "live", "app.js")  # fmt: skip


@pytest.mark.parametrize("token", ["", "x", "A" * 32, "%00", ".."])
def test_nothing_is_read_without_the_token(bench: Running, token: str) -> None:
    for path in READS:
        reply = bench.request(path, token=token)
        assert reply.status == 403 and SECRET not in reply.body, path
        assert "token is wrong" in reply.json["error"]


def test_nothing_is_changed_without_the_token(bench: Running) -> None:
    number = bench.state()["number"]
    message = json.dumps({"kind": "undo", "number": number}).encode()
    assert bench.request("act", message, token="wrong").status == 403
    assert bench.request("/act", message, whole=True).status == 403
    assert bench.state()["number"] == number


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1:1", "evil.example:{port}",
                                  "127.0.0.1.evil.example:{port}", ""])  # fmt: skip
def test_a_name_that_leads_here_is_no_host_of_the_workbench(bench: Running, host: str) -> None:
    reply = bench.request("state", headers={"host": host.format(port=bench.port)})
    assert reply.status in (400, 421) and SECRET not in reply.body


@pytest.mark.parametrize("origin", ["https://evil.example", "null", "http://127.0.0.1",
                                    "http://localhost:1", "file://"])  # fmt: skip
def test_a_page_of_another_origin_is_refused(bench: Running, origin: str) -> None:
    message = json.dumps({"kind": "undo", "number": bench.state()["number"]}).encode()
    for body in (None, message):
        path = "state" if body is None else "act"
        reply = bench.request(path, body, {"origin": origin})
        assert reply.status == 403 and SECRET not in reply.body
        assert "access-control-allow-origin" not in reply.headers


def test_a_page_of_another_site_is_refused_by_what_the_browser_says(bench: Running) -> None:
    assert bench.request("state", headers={"sec-fetch-site": "cross-site"}).status == 403
    assert bench.request("state", headers={"sec-fetch-site": "same-site"}).status == 403
    assert bench.request("state", headers={"sec-fetch-site": "same-origin"}).status == 200
    own = {"origin": f"http://127.0.0.1:{bench.port}"}
    assert bench.request("state", headers=own).status == 200
    assert bench.request("state", headers={"host": f"localhost:{bench.port}"}).status == 200


def test_other_sites_are_never_allowed_by_a_preflight(bench: Running) -> None:
    asked = {"origin": "https://evil.example", "access-control-request-method": "POST"}
    reply = bench.request("act", headers=asked, method="OPTIONS")
    assert reply.status == 403
    assert not [name for name in reply.headers if name.startswith("access-control")]


@pytest.mark.parametrize("path", [
    "../state", "..%2fserver.py", "%2e%2e/server.py", "/etc/passwd", "....//server.py",
    "__init__.py",
    "app.js/../../server.py", "app.js%00.css", "assets/app.js", "..\\server.py", "page.html/x",
    "source?file=/etc/passwd", "source?file=../model.yaml", "source?file=model.yaml%00", "source",
    "source?file=file:///etc/passwd", "drawing?name=../../etc/passwd", "drawing?name=", "nothing",
])  # fmt: skip
def test_only_files_of_the_page_and_of_the_model_are_served(bench: Running, path: str) -> None:
    reply = bench.request(path)
    assert reply.status == 404 and b"root:" not in reply.body and b"import" not in reply.body


def test_every_answer_keeps_other_content_out(bench: Running) -> None:
    for path in ("", "state", "nothing", "app.js"):
        headers = bench.request(path).headers
        assert {name: headers[name] for name in guard.HEADERS} == guard.HEADERS
    refused = bench.request("state", token="x").headers
    assert {name: refused[name] for name in guard.HEADERS} == guard.HEADERS


def test_the_page_loads_nothing_from_elsewhere() -> None:
    folder = ROOT / "ravenchart" / "workbench" / "assets"
    own = [path for path in folder.iterdir() if path.name != "preact.js"]
    assert len(own) > 5
    for path in own:
        text = path.read_text(encoding="utf-8")
        assert re.findall(r"[a-z]+://\S*|url\(\S*|import\(\S*", text) == [], path.name
        assert all(name.startswith("./") for name in re.findall(r'from "(.*?)"', text)), path.name


def test_a_long_message_is_refused_however_it_is_sent(bench: Running) -> None:
    long = b'{"kind": "undo", "number": 0, "x": "' + b"a" * guard.LARGEST + b'"}'
    assert bench.request("act", long).status == 413
    chunks = b"".join(b"400\r\n" + b"a" * 0x400 + b"\r\n" for _ in range(20)) + b"0\r\n\r\n"
    chunked = {"transfer-encoding": "chunked", "content-type": "application/json"}
    assert bench.request("act", chunks, chunked).status == 413
    assert bench.request("act", b"", {"content-length": "9" * 30}).status in (400, 413)


MALFORMED = [
    b"", b"x", b"{}", b"[]", b"null", b"1", b'"move"', b"\xff\xfe", b"{" * 2000, b"[" * 8000,
    b'{"kind": "move"}', b'{"kind": "other", "number": 0}', b'{"kind": "undo", "number": -1}',
    b'{"kind": "undo", "number": 1e999}', b'{"kind": "undo", "number": "0"}',
    b'{"kind": "undo", "number": 0, "more": 1}', b'{"kind": "save", "number": 0, "late": "yes"}',
    b'{"kind": "move", "number": 0, "row": "a.b", "to": "c", "place": 1e6}',
    b'{"kind": "move", "number": 0, "row": 5, "to": "c", "place": 0}',
    b'{"kind": "time", "number": 0, "row": "a.b", "key": "stack", "value": "1 ms"}',
    b'{"kind": "processor", "number": 0, "processor": "p", "key": "priority", "value": [1]}',
    b'{"kind": "time", "number": 0, "row": "", "key": "wcet", "value": "1 ms"}',
]  # fmt: skip


@pytest.mark.parametrize("body", MALFORMED)
def test_a_malformed_message_is_refused_with_the_reason(bench: Running, body: bytes) -> None:
    refuses_malformed(bench, body)


def test_messages_are_json_of_the_right_method(bench: Running) -> None:
    refuses_other_types_and_methods(bench)


def test_a_message_about_an_earlier_state_is_refused(bench: Running) -> None:
    number = bench.state()["number"]
    reply = bench.request("act", json.dumps({"kind": "undo", "number": number + 1}).encode())
    assert reply.status == 409 and "look at the state now" in reply.json["error"]


def test_a_wrong_value_is_refused_in_words(bench: Running) -> None:
    reply = bench.act(kind="time", row="joint_x.ports", key="wcet", value="soon")
    assert reply.status == 422
    assert reply.json["error"] == (
        "`soon` is not a duration: write a number and ns, us, ms or s, such as `20 ms`"
    )


@pytest.mark.slow
def test_ten_thousand_malformed_messages_leave_all_as_it_was(bench: Running) -> None:
    chance = random.Random(23)
    number = bench.state()["number"]
    good = json.dumps(
        {"kind": "time", "number": number, "row": "joint_x.ports", "key": "wcet", "value": "1 ms"}
    ).encode()
    refused = 0
    for _ in range(10_000):
        body = bytearray(good)
        for _ in range(chance.randint(1, 8)):
            place = chance.randrange(len(body))
            body[place : place + chance.randint(0, 3)] = chance.randbytes(chance.randint(0, 3))
        reply = bench.request("act", bytes(body), {"content-type": "application/json"})
        assert reply.status in (200, 400, 409, 422), body
        refused += reply.status != 200
        if reply.status == 200:  # still a message: the state and its number are put right
            number = bench.act(kind="undo").json["number"]
            good = re.sub(rb'"number": \d+', b'"number": %d' % number, good)
    assert refused > 9_500


def test_what_is_no_http_is_refused(bench: Running) -> None:
    chance = random.Random(1)
    tricks = [b"GET / HTTP/1.1\r\n\r\n", b"\x00" * 500, b"GET /" + b"a" * 70_000, b"\x16\x03\x01",
              b"POST /x HTTP/1.1\r\nhost: x\r\ncontent-length: -1\r\n\r\n"]  # fmt: skip
    for trick in [*tricks, *(chance.randbytes(200) + b"\r\n\r\n" for _ in range(50))]:
        with socket.create_connection(("127.0.0.1", bench.port), PATIENCE) as line:
            line.sendall(trick)
            line.shutdown(socket.SHUT_WR)
            told = b""
            try:
                while more := line.recv(65536):
                    told += more
            except ConnectionResetError:
                pass
            assert told == b"" or told.startswith(
                (b"HTTP/1.1 400", b"HTTP/1.1 421", b"HTTP/1.1 403")
            )


def test_it_listens_on_this_machine_alone(bench: Running) -> None:
    listening = "0A"
    found = [
        line.split()[1]
        for table in ("tcp", "tcp6")
        for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]
        if line.split()[3] == listening
        and int(line.split()[1].rpartition(":")[2], 16) == bench.port
    ]
    assert found == [f"0100007F:{bench.port:04X}"]


def test_two_pages_see_the_same_states(bench: Running) -> None:
    one, other = bench.stream(), bench.stream()
    first = bench.state()["number"]
    assert until(one, first)["number"] == until(other, first)["number"] == first
    changed = bench.act(kind="time", row="joint_x.ports", key="wcet", value="130 us").json
    assert until(one, changed["number"]) == until(other, changed["number"])
    (control,) = [p for p in changed["processors"] if p["name"] == "control"]
    assert control["bound"] != control["saved"]
    undone = bench.act(kind="undo").json
    assert until(one, undone["number"])["dirty"] is until(other, undone["number"])["dirty"] is False


def test_advice_and_growth_come_after_the_state(bench: Running) -> None:
    page = bench.stream()
    state = until(page, bench.act(kind="time", row="joint_x.ports", key="wcet", value="140 us")
                  .json["number"])  # fmt: skip
    while state["room"] is None:
        state = page.get(timeout=PATIENCE)
    assert state["room"][0].startswith("all execution times may grow by ")
    growth = bench.request("growth?row=joint_x.ports").json
    assert growth["wcet"] > 140_000
    assert bench.request("growth?row=nothing.x").json["wcet"] is None
    assert bench.act(kind="undo").status == 200


@pytest.mark.slow
def test_a_search_shows_its_best_and_its_tables_become_a_change(bench: Running) -> None:
    page = bench.stream()
    assert bench.act(kind="adopt").status == bench.act(kind="stop").status == 422
    state = until(page, 0)
    assert bench.act(kind="search", strategy="fewest").json["search"]["running"]
    while not (state["search"] and not state["search"]["running"]):
        state = page.get(timeout=PATIENCE)
    best = state["search"]["best"]
    assert best["met"] and "every deadline is met" in best["verdict"]
    assert len(best["tables"]) < len(state["processors"])
    adopted = bench.act(kind="adopt").json
    assert adopted["search"] is None and adopted["undo"] == "rows allocated by fewest"
    tables = {one["name"]: [row["row"] for row in one["rows"]] for one in adopted["processors"]}
    assert tables == {table["name"]: table["rows"] for table in best["tables"]}
    assert bench.act(kind="undo").json["dirty"] is False


def test_a_search_is_stopped_and_what_has_changed_since_is_not_replaced(bench: Running) -> None:
    page = bench.stream()
    state = until(page, 0)
    bench.act(kind="search", strategy="period")
    while not (state["search"] and state["search"]["best"]):
        state = page.get(timeout=PATIENCE)
    bench.act(kind="time", row="joint_x.ports", key="wcet", value="135 us")
    assert bench.state()["search"]["old"]
    refused = bench.act(kind="adopt")
    assert refused.status == 422
    assert refused.json["error"] == "the model has changed since the search: search again"
    bench.act(kind="search", strategy="slack")
    state = bench.act(kind="stop").json
    while state["search"]["running"] or state["search"]["strategy"] != "slack":
        state = page.get(timeout=PATIENCE)
    assert not state["search"]["old"]
    assert bench.act(kind="undo").status == 200


def test_a_drawing_comes_with_the_locations_of_what_it_shows(bench: Running) -> None:
    found = bench.request("drawing?name=Joint.Motion").json
    assert found["svg"].startswith("<?xml") and "<title>Idle</title>" in found["svg"]
    (idle,) = [p for p in found["places"] if p["title"] == "Idle" and not p["text"]]
    line = (ROBOT / "joint.yaml").read_text(encoding="utf-8").splitlines()[idle["line"] - 1]
    assert Path(idle["file"]).name == "joint.yaml" and line.strip() == "Idle:"
    again = bench.request(
        f"drawing?name=Joint.Motion&mark={found['mark'].replace(' ', '%20')}"
    ).json
    assert "svg" not in again and again["mark"] == found["mark"]


# --- Start and end ---------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_ends_it_in_order_while_pages_are_open(
    tmp_path: Path, number: int, status: int
) -> None:
    with running(copied(tmp_path)) as bench:
        page = bench.stream()
        until(page, 0)
        assert bench.end(number) == status
        assert page.get(timeout=PATIENCE) is None or page.get(timeout=PATIENCE) is None
        assert "Traceback" not in "".join(bench.lines)
    children = Path("/proc").glob("[0-9]*/cmdline")
    assert not [path for path in children if _is_room(path, tmp_path)]


def test_advice_leaves_the_processor_to_changes(tmp_path: Path) -> None:
    copied(tmp_path)
    with running(tmp_path / "model.yaml") as bench:
        page = bench.stream()
        until(page, 0)
        own = os.getpriority(os.PRIO_PROCESS, bench.process.pid)

        def aside() -> list[int]:
            found = Path("/proc").glob("[0-9]*/cmdline")
            return [int(path.parent.name) for path in found if _is_room(path, tmp_path)]

        within(lambda: min(map(priority, aside()), default=own) > own)
        assert {priority(process) for process in aside()} == {min(own + 10, LARGEST_NICENESS)}


LARGEST_NICENESS = 19


def priority(process: int) -> int:
    """The niceness of a process."""
    return os.getpriority(os.PRIO_PROCESS, process)


def _is_room(path: Path, folder: Path) -> bool:
    try:
        return b"workbench.room" in path.read_bytes() and str(folder) == str(
            (path.parent / "cwd").readlink()
        )
    except OSError:
        return False


def called(*words: str) -> subprocess.CompletedProcess[str]:
    """A call that ends by itself."""
    return subprocess.run(
        command(*words, "--no-open"), env=environment(), capture_output=True, text=True,
        timeout=PATIENCE, check=False,
    )  # fmt: skip


def test_a_port_in_use_is_told_with_the_way_out(tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        done = called(str(copied(tmp_path)), "--port", str(port))
    assert done.returncode == 2
    assert without_progress(done.stderr) == (
        f"ravenchart: error: port {port} cannot be used: Address already in use; "
        "choose another by --port\n"
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", ["wrong.yaml", "missing.yaml"])
def test_a_model_that_check_refuses_is_refused_in_the_same_words(name: str, tmp_path: Path) -> None:
    (tmp_path / "wrong.yaml").write_text("system: X\nnodes: {a: {core: 1}}\n")
    mine = called(str(tmp_path / name))
    words = [sys.executable, "-P", "-m", "ravenchart.start", "check", str(tmp_path / name)]
    theirs = subprocess.run(words, env=environment(), capture_output=True, text=True, check=False)
    assert mine.returncode == theirs.returncode
    assert without_progress(mine.stderr) == without_progress(theirs.stderr)
    assert mine.returncode == 1 and mine.stdout == ""


@pytest.mark.parametrize("port", ["-1", "65536", "x", ""])
def test_a_port_that_is_none_is_refused(port: str, tmp_path: Path) -> None:
    done = called(str(tmp_path / "model.yaml"), "--port", port)
    assert done.returncode == 2 and "is not 0 .. 65535" in done.stderr


def test_the_help_does_not_wait_for_the_server(tmp_path: Path) -> None:
    code = """if True:
        import sys
        from ravenchart.command_line import main
        try:
            main(["workbench", "--help"])
        except SystemExit:
            print(sorted({"starlette", "uvicorn", "pydantic", "z3"} & set(sys.modules)))
    """
    done = subprocess.run(
        [sys.executable, "-P", "-c", code], env=environment(), capture_output=True, text=True,
        check=True,
    )  # fmt: skip
    assert done.stdout.endswith("[]\n")
