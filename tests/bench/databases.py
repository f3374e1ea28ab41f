# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What becomes of a collection of CAN databases: `python -P -m tests.bench.databases FOLDER...`.

Each file that cantools reads is imported, by a monitor and by the node that sends most messages,
and the model is checked. With ``--build`` programs are made of it, each with some of the messages,
and random frames go through their codecs: cantools, with the file itself, must read the same raw
values. A line a file, then the sums.
"""

from __future__ import annotations

import argparse
import random
import re
import sys
import tempfile
import traceback
from collections import Counter
from collections.abc import Iterable, Iterator, Set
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from cantools.database import Database, DecodeError
from cantools.database.can import Message as DbcMessage

from ravenchart.building import checking
from ravenchart.databases import database, exporting
from ravenchart.failures import Failure, Refused
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.system import System
from tests.support.codec_runner import Runner, literal, runners_of

FRAMES = 20
"""Random frames for each message."""
PERIOD = "100 ms"
MOST = 40
"""Messages of a program at the most, so that one compiles in a minute."""

Tally = Counter[str]


def files_in(places: Iterable[Path]) -> list[Path]:
    """The databases in these folders and below, the shortest ones first."""
    found = (
        path
        for place in places
        for path in place.rglob("*")
        if path.suffix.lower() in database.FORMATS
    )
    return sorted(found, key=lambda path: (path.stat().st_size, path))


def busiest(read: Database) -> str | None:
    """The node that sends most messages; None where no node sends."""
    sent = Counter(sender for message in read.messages for sender in message.senders)
    known = {node.name for node in read.nodes}
    return next((name for name, _ in sent.most_common() if name in known), None)


def _checked(text: str, folder: Path) -> checking.Checked:
    model = folder / "model.yaml"
    model.write_text(text, encoding="utf-8")
    return checking.check(model)


def _sent_of(names: Set[str], sends: re.Match[str]) -> str:
    """The key `sends` with those of these names."""
    return f"sends: [{', '.join(name for name in sends[1].split(', ') if name in names)}]"


def _parts(text: str) -> Iterator[str]:
    """The model with so many of its messages at a time, and with their ports."""
    head, messages = text.split("\nmessages:", 1)
    each = re.split(r"\n(?=  \w+:\n)", messages)[1:]
    for first in range(0, len(each), MOST):
        some = each[first : first + MOST]
        names = {one.strip().partition(":")[0] for one in some}
        ports = re.findall(r"^      (\w+): \{(?:in|out):", head, re.M)
        if names.isdisjoint(ports):
            continue
        kept = (
            line
            for line in head.splitlines()
            if not (port := re.match(r"      (\w+): \{(?:in|out):", line)) or port[1] in names
        )
        made = re.sub(r"sends: \[(.*)\]", partial(_sent_of, names), "\n".join(kept))
        yield made + "\nmessages:\n" + "\n".join(some)


def _built(text: str, folder: Path) -> list[Runner]:
    """The codecs of a model as programs."""
    folder.mkdir()
    return [runner for _, runner in runners_of(_checked(text, folder), folder)]


def _random_frame(drawn: random.Random, message: Message) -> bytes:
    """Bytes of a frame of one of its pages."""
    whole = drawn.getrandbits(8 * message.length)
    selector = next((s for s in message.signals if s.selects), None)
    pages = sorted({page for s in message.signals for page in s.pages})
    if selector is not None and pages:
        raw = drawn.choice(pages)
        for place, bit in enumerate(selector.bits()):
            whole = whole & ~(1 << bit) | ((raw >> place) & 1) << bit
    return whole.to_bytes(message.length, "little")


def _compared(runner: Runner, message: Message, like: DbcMessage, tally: Tally) -> None:
    """Frames that the codec and cantools read."""
    drawn = random.Random(f"{like.name} {like.frame_id}")
    frames = [_random_frame(drawn, message) for _ in range(FRAMES)]
    known = {s.name: s for s in like.signals}
    values = runner.unpacked(message, frames)
    taken = [(f, v) for f, v in zip(frames, values, strict=True) if v is not None]
    tally["frames"] += len(frames)
    tally["frames taken"] += len(taken)
    packed = runner.packed(message, [v for _, v in taken])
    again = runner.unpacked(message, packed) if packed else []
    for (frame, found), unpacked in zip(taken, again, strict=True):
        try:
            read = like.decode(
                frame[: like.length], decode_choices=False, scaling=False, allow_truncated=True
            )
        except DecodeError:
            tally["frames that cantools cannot read"] += 1
            continue
        assert isinstance(read, dict)
        tally["values packed again"] += len(found)
        tally["values packed again otherwise"] += sum(
            a != b for a, b in zip(found, unpacked or (), strict=unpacked is not None)
        )
        for signal, value in zip(message.signals, found, strict=True):
            same = known.get(signal.in_database)
            raw = read.get(signal.in_database)
            if same is None or same.length != signal.width or not isinstance(raw, int):
                continue
            tally["values"] += 1
            kept = literal(signal, value)
            if signal.other is not None and kept == signal.other:
                tally["values different"] += raw in signal.named_codes.values()
            else:
                mask = (1 << signal.width) - 1
                tally["values different"] += (signal.raw(kept) ^ raw) & mask != 0


def _model(path: Path, read: Database, node: str | None, tally: Tally, *, build: bool) -> None:
    """One import of a file: its model, its program, its frames."""
    kind = "all" if node is None else "node"
    tally[f"{kind}: files"] += 1
    given = database.Periods(PERIOD)
    found = database.imported(path, node, given, lenient=True)
    with tempfile.TemporaryDirectory() as folder:
        checked = _checked(found.text, Path(folder))
        tally[f"{kind}: checked"] += 1
        system = checked.system
        tally[f"{kind}: messages"] += len(read.messages)
        tally[f"{kind}: messages in models"] += len(system.frames)
        tally[f"{kind}: left out"] += len(found.problems)
        by_id = {(m.frame_id, m.is_extended_frame): m for m in read.messages}
        #  a part of what a node sends and receives may lack one of both
        build = build and (node is None or len(read.messages) <= MOST)
        for number, some in enumerate(_parts(found.text) if build else ()):
            runners = _built(some, Path(folder) / str(number))
            tally[f"{kind}: programs"] += 1
            for runner in runners:
                for message in runner.system.messages:
                    if message.signals:
                        like = by_id[message.identifier, message.extended]
                        tally["messages compared"] += 1
                        _compared(runner, message, like, tally)
        if node is None:
            _written_back(system, path, tally)


def _written_back(system: System, path: Path, tally: Tally) -> None:
    """Does `export-dbc --like` write what cantools reads again?"""
    made = exporting.exported(system, system.buses[0], path, lenient=True)
    with tempfile.TemporaryDirectory() as folder:
        back = Path(folder) / "back.dbc"
        back.write_text(made.text, encoding="cp1252", errors="replace")
        database.read(back, lenient=True)
    tally["written back"] += 1


def tried(path: Path, *, build: bool) -> tuple[Path, Tally, str]:
    """What becomes of one file, and what went wrong."""
    tally = Tally(files=1)
    try:
        read = database.read(path, lenient=True)
    except Refused:
        return path, tally, ""
    tally["cantools reads"] += 1
    faults = []
    sender = busiest(read)
    for node in [None] if sender is None else [None, sender]:
        try:
            _model(path, read, node, tally, build=build)
        except Failure as fault:
            faults.append(fault.shown())
        except Exception:  # a defect: the next file is tried all the same
            faults.append(traceback.format_exc())
    return path, tally, "\n".join(faults)


def main() -> int:
    """Try them all; the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", type=Path, nargs="+")
    parser.add_argument("--build", action="store_true", help="compile, and compare with cantools")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    sums = Tally()
    failed = 0
    with ProcessPoolExecutor(options.jobs) as pool:
        work = partial(tried, build=options.build)
        for path, tally, faults in pool.map(work, files_in(options.folders)):
            print(path, dict(tally), flush=True)
            if faults:
                failed += 1
                print(faults, flush=True)
            sums += tally
    for name, count in sums.items():
        print(f"{count:9,} {name}")
    print(f"{failed:9,} files with a fault")
    return 1 if failed or sums["values different"] else 0


if __name__ == "__main__":
    sys.exit(main())
