# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The frames of a run's bus as others on the machine see them."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import can
import pytest

from ravenchart.hw_can.bench.bus_records import (
    MARK,
    VERSION,
    BusRecord,
    Greeting,
    RecordKind,
    encode,
    greeting_data,
)
from ravenchart.running import bus_log, bus_ring, held_files
from ravenchart.running.bus_ring import SLOTS, BusRing, RingReader, RunEndedError


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """Where rings stand beside."""
    (tmp_path / "checks").mkdir()
    return tmp_path / "checks" / "pump_main"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """An empty file."""
    made = tmp_path / "pump_main.bus-1"
    made.touch()
    return made


@pytest.fixture
def ring(path: Path) -> Iterator[BusRing]:
    made = BusRing(path)
    yield made
    made.close()


def rings(program: Path) -> list[Path]:
    """Those of a program that are written now."""
    return held_files.held_files([program.parent.parent], program.name, bus_ring.MARK)


def numbered(number: int) -> can.Message:
    """A frame that carries its number."""
    return can.Message(
        timestamp=1_700_000_000 + number / 1000, arbitration_id=0x111, is_extended_id=False,
        data=number.to_bytes(8, "big"),
    )  # fmt: skip


def taken(reader: RingReader) -> list[int]:
    """The numbers of the frames that wait."""
    found = []
    while (frame := reader.recv(0.0)) is not None:
        found.append(int.from_bytes(frame.data, "big"))
    return found


@pytest.mark.parametrize(
    "frame",
    [
        can.Message(arbitration_id=0x7FF, is_extended_id=False, data=[1, 2], timestamp=5.25),
        can.Message(arbitration_id=0x1FFFFFFF, data=bytes(8), timestamp=1.7e9),
        can.Message(arbitration_id=3, is_extended_id=False, is_remote_frame=True, dlc=8,
                    timestamp=1.0),
        can.Message(arbitration_id=3, is_fd=True, bitrate_switch=True, error_state_indicator=True,
                    data=bytes(64), timestamp=2.0),
        can.Message(is_error_frame=True, timestamp=3.0),
    ],
    ids=["standard", "extended", "remote", "fd", "error"],
)  # fmt: skip
def test_each_kind_of_frame_is_read_as_it_was(
    ring: BusRing, path: Path, frame: can.Message
) -> None:
    reader = RingReader(path)
    ring.take(frame)
    found = reader.recv(0.0)
    assert found is not None and found.equals(frame, timestamp_delta=1e-6, check_channel=False)
    assert reader.recv(0.0) is None
    reader.shutdown()


def test_a_reader_has_the_frames_from_its_start_on(ring: BusRing, path: Path) -> None:
    ring.take(numbered(1))
    first = RingReader(path)
    ring.take(numbered(2))
    second = RingReader(path)
    ring.take(numbered(3))
    assert (taken(first), taken(second)) == ([2, 3], [3])
    assert first.missed == second.missed == 0


def test_a_late_reader_misses_the_oldest_and_knows_how_many(ring: BusRing, path: Path) -> None:
    reader = RingReader(path)
    for number in range(SLOTS + 10):
        ring.take(numbered(number))
    assert taken(reader) == list(range(11, SLOTS + 10))  # one less than the ring has
    assert reader.missed == 11
    ring.take(numbered(7))
    assert (taken(reader), reader.missed) == ([7], 11)
    assert path.stat().st_size == (SLOTS + 1) * 88


def test_what_is_written_over_while_it_is_read_is_missed(
    ring: BusRing, path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The writer goes on between the records that a reader takes out."""
    reader = RingReader(path)
    for number in range(100):
        ring.take(numbered(number))
    plain, looks = os.pread, []

    def interrupted(file: int, length: int, place: int) -> bytes:
        looks.append(place)
        if len(looks) == 60:
            for number in range(100, SLOTS + 50):
                ring.take(numbered(number))
        return plain(file, length, place)

    monkeypatch.setattr(os, "pread", interrupted)
    found = taken(reader)
    assert found == list(range(51, SLOTS + 50)) and reader.missed == 51


def test_ten_thousand_frames_of_a_quick_writer_are_whole_or_missed(path: Path) -> None:
    ring, reader, last = BusRing(path), RingReader(path), 30_000

    def write() -> None:
        for number in range(last):
            octets = number.to_bytes(8, "big") * 8
            ring.put(encode(BusRecord(RecordKind.FRAME, 4 | 8, 64, identifier=5, data=octets)))
        ring.close()

    writing = threading.Thread(target=write)
    writing.start()
    found: list[int] = []
    with pytest.raises(RunEndedError):
        while True:
            frame = reader.recv(1.0)
            assert frame is not None
            words = {bytes(frame.data[at : at + 8]) for at in range(0, 64, 8)}
            assert len(words) == 1
            found.append(int.from_bytes(words.pop(), "big"))
    writing.join()
    assert found == sorted(set(found)) and found[-1] == last - 1
    assert len(found) + reader.missed == last


def test_the_end_of_a_run_is_told_after_its_last_frame(program: Path) -> None:
    with bus_ring.shown(program) as ring:
        assert ring is not None
        (path,) = rings(program)
        reader = RingReader(path)
        ring.take(numbered(4))
    assert rings(program) == [] and not path.exists()
    assert reader.recv(0.0) is not None
    with pytest.raises(RunEndedError):
        reader.recv(0.0)


def test_a_run_that_is_killed_has_ended_too(path: Path) -> None:
    text = (
        "import sys, time; from pathlib import Path; from ravenchart.running.bus_ring import *;"
        "ring = BusRing(Path(sys.argv[1])); print(flush=True); time.sleep(60)"
    )
    with subprocess.Popen([sys.executable, "-c", text, path], stdout=subprocess.PIPE) as run:
        assert run.stdout is not None
        run.stdout.readline()
        reader = RingReader(path)
        assert reader.recv(0.0) is None and held_files.is_held(path)
        run.send_signal(signal.SIGKILL)
        run.wait()
    with pytest.raises(RunEndedError):
        reader.recv(0.0)


def test_where_no_ring_can_be_a_run_goes_on_without(
    program: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with bus_ring.shown(None) as none, bus_ring.shown(Path("/proc/none/x")) as nowhere:
        assert none is None and nowhere is None

    def full(*_words: object) -> None:
        raise OSError("No space left on device")

    monkeypatch.setattr(os, "posix_fallocate", full)
    with bus_ring.shown(program) as ring:
        assert ring is None
    assert list(program.parent.iterdir()) == []


def test_a_second_writer_is_refused(ring: BusRing, path: Path) -> None:
    ring.take(numbered(1))
    with pytest.raises(OSError, match="unavailable"):
        BusRing(path)


# --- What writes it


def test_frames_of_the_bench_are_shown_with_a_log_and_without(
    program: Path, tmp_path: Path
) -> None:
    for log in (None, tmp_path / "bus.log"):
        with bus_log.recorded(log, "ward", program) as record:
            (path,) = rings(program)
            reader = RingReader(path)
            record(numbered(3))
            assert taken(reader) == [3]
    assert "ward 111#0000000000000003" in (tmp_path / "bus.log").read_text()


@pytest.mark.parametrize("is_logged", [False, True])
def test_records_of_the_bus_server_are_shown_with_their_times(
    program: Path, tmp_path: Path, *, is_logged: bool
) -> None:
    start = 1_700_000_000 * 10**9
    hello = BusRecord(
        RecordKind.WELCOME, length=4, code=VERSION, identifier=MARK, number=255,
        data=greeting_data(Greeting("can0", start=start)),
    )  # fmt: skip
    log = tmp_path / "bus.log" if is_logged else None
    with bus_log.written(log, program) as descriptor:
        (path,) = rings(program)
        reader = RingReader(path)
        os.write(descriptor, encode(hello))
        os.write(descriptor, encode(BusRecord(RecordKind.FRAME, identifier=9, time=2 * 10**9)))
        found = reader.recv(5.0)
    assert found is not None
    assert (found.arbitration_id, found.timestamp) == (9, 1_700_000_002)
    assert log is None or "can0 009#" in log.read_text()
