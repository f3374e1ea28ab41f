# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The generated codecs and cantools with the generated database agree, bit by bit."""

from __future__ import annotations

import os
import random
import subprocess
from collections.abc import Iterator, Mapping
from decimal import Decimal
from math import prod
from pathlib import Path

import cantools
import pytest
from cantools.database import Database
from cantools.database.can import Message as DbcMessage

from ravenchart.building import checking, generation
from ravenchart.gen.emit.program import generate
from ravenchart.gen.language.terms import IntegerType
from ravenchart.gen.language.units import count_of
from ravenchart.gen.model.authentication import FRESHNESS, MAC, REST
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.signals import Signal
from ravenchart.hw_can.bench.protection import HEADER
from ravenchart.paths import ROOT
from tests.hardware.machines import HERE, OTHERS, Machine
from tests.support.codec_runner import Runner, Values, boundaries, literal, runners_of
from tests.support.elsewhere import needed

pytestmark = pytest.mark.slow

FEATURES = ROOT / "tests" / "feature"
CASES = sorted(
    (
        path
        for pattern in ("examples/*/model.yaml", "tests/feature/*/model.yaml", "tests/nodes/*/*")
        for path in ROOT.glob(pattern)
        if path.name == "model.yaml"
        and "\nbuses:" in path.read_text(encoding="utf-8")
        and path.parent.name != "segmented"
    ),
    key=str,
)
"""Every model with a bus that some test builds. The values of `segmented` are in several frames,
of which a database knows nothing: tests/system/test_segmented_nodes.py sends them."""

DRAWN = 1_000 if "RAVENCHART_LONG_TESTS" in os.environ else 250
"""Random frames for each message, and as many next to a packed one."""

ADDED = HEADER | {FRESHNESS, MAC, REST}
"""Signals of a database that are no part of a value."""

ELSEWHERE = [
    *(FEATURES / name / "model.yaml" for name in ("signals", "pages", "flexible", "namesakes")),
    ROOT / "examples" / "cartesian_robot" / "model.yaml",
]
"""Those whose codecs are held against cantools on other machines too."""


class Peer:
    """The program of a node, for one machine, and the database of each bus of the model."""

    def __init__(self, runner: Runner, folder: Path) -> None:
        self.runner = runner
        self.system = runner.system
        self.databases: dict[str, Database] = {}
        for bus in self.system.buses:
            database = cantools.database.load_file(folder / f"{bus.name}.dbc", strict=True)
            assert isinstance(database, Database)
            self.databases[bus.name] = database

    def message(self, name: str) -> DbcMessage:
        """A message of the only bus."""
        (database,) = self.databases.values()
        return database.get_message_by_name(name)


def made(model: Path, folder: Path, machine: Machine = HERE) -> list[Peer]:
    """The peers of a model: one for each node whose program has codecs."""
    found = runners_of(checking.check(model), folder, machine)
    return [Peer(runner, place) for place, runner in found]


PEERS = [(case, HERE) for case in CASES]
PEERS += [(case, machine) for machine in OTHERS for case in ELSEWHERE]


@pytest.fixture(
    scope="module",
    params=PEERS,
    ids=lambda made: f"{made[0].parent.name}-{made[1].name}",
)
def peers(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> list[Peer]:
    case, machine = request.param
    return made(case, tmp_path_factory.mktemp("codecs"), needed(machine))


def test_every_model_with_messages_is_among_the_cases(peers: list[Peer]) -> None:
    assert peers
    assert all(peer.system.messages for peer in peers)


def messages_of(peers: list[Peer]) -> Iterator[tuple[Peer, Message]]:
    """Each message of each program."""
    for peer in peers:
        for message in peer.system.messages:
            yield peer, message


def sent(message: Message, values: Values) -> dict[str, int]:
    """What of a value is in its frame: raw values by signal."""
    raws = {s.name: s.raw(literal(s, v)) for s, v in zip(message.signals, values, strict=True)}
    page = next((raws[s.name] for s in message.signals if s.selects), None)
    return {s.name: raws[s.name] for s in message.signals if not s.pages or page in s.pages}


def samples(message: Message) -> list[Values]:
    """Each boundary value of each signal, the others at random."""
    chance = random.Random(message.name)
    choices = [boundaries(signal) for signal in message.signals]
    found: set[Values] = set()
    for index, values in enumerate(choices):
        for value in values:
            for _ in range(8):
                mixed = [chance.choice(other) for other in choices]
                mixed[index] = value
                found.add(tuple(mixed))
    return sorted(found)


def possible(message: Message) -> int:
    """How many values a message has."""
    ranges = (len(boundaries(signal)) for signal in message.signals)
    return prod(ranges)


def all_stand_for_values(message: Message) -> bool:
    """Do all bits of each signal stand for a value?"""
    return all(
        signal.other is not None
        or (signal.raw_range[1] - signal.raw_range[0] + 1 == 2**signal.width and not signal.codes)
        for signal in message.signals
    )


def has_signals(message: Message, values: Values) -> bool:
    """Does a database know the page? It knows none without a signal."""
    if not any(s.pages for s in message.signals):
        return True
    paged = {s.name for s in message.signals if s.pages}
    return bool(paged & set(sent(message, values)))


def physical(signal: Signal, raw: int) -> Decimal:
    """What a raw value counts, exactly."""
    scale = count_of(signal.type.unit)[0] if isinstance(signal.type, IntegerType) else Decimal(1)
    return (raw + signal.offset) * scale


def without_header(values: object) -> dict[str, int]:
    """The raw values but those of the message's protection: the codec leaves their bits 0."""
    assert isinstance(values, dict)
    return {name: _whole(value) for name, value in values.items() if name not in ADDED}


def _whole(value: object) -> int:
    assert isinstance(value, int)
    return value


def encoded(message: DbcMessage, raws: Mapping[str, int]) -> bytes:
    """The frame by the database, with all bits of the header 0."""
    zeros = {signal.name: 0 for signal in message.signals if signal.name in ADDED}
    return message.encode({**raws, **zeros}, scaling=False)


def test_every_boundary_value_is_packed_as_cantools_packs_it(peers: list[Peer]) -> None:
    for peer, message in messages_of(peers):
        values = [v for v in samples(message) if has_signals(message, v)]
        assert len(values) >= min(5, possible(message))
        other = peer.databases[message.bus].get_message_by_name(message.name)
        for value, frame in zip(values, peer.runner.packed(message, values), strict=True):
            raws = sent(message, value)
            assert frame == encoded(other, raws), (message.name, value)
            decoded = other.decode(frame, scaling=False, decode_choices=False)
            assert without_header(decoded) == raws
            shown = other.decode(frame, decode_choices=False)
            assert isinstance(shown, dict)
            for signal in message.signals:
                if signal.name in raws:
                    given = shown[signal.name]
                    assert isinstance(given, int | float)
                    assert given == pytest.approx(float(physical(signal, raws[signal.name])))


def test_what_is_packed_is_unpacked(peers: list[Peer]) -> None:
    for peer, message in messages_of(peers):
        values = samples(message)
        frames = peer.runner.packed(message, values)
        for value, back in zip(values, peer.runner.unpacked(message, frames), strict=True):
            assert back is not None
            assert sent(message, back) == sent(message, value), (message.name, value)


def test_random_frames_are_accepted_exactly_when_every_raw_value_is_in_range(
    peers: list[Peer],
) -> None:
    for peer, message in messages_of(peers):
        frames = drawn(peer, message)
        other = peer.databases[message.bus].get_message_by_name(message.name)
        accepted: list[Values] = []
        for frame, found in zip(frames, peer.runner.unpacked(message, frames), strict=True):
            wanted = expected(message, frame)
            if page_is_known(other, message, frame):
                assert by_database(message, other, frame) == wanted, (message.name, frame.hex())
            assert (found is not None) == (wanted is not None), (message.name, frame.hex())
            if found is not None:
                accepted.append(found)
                assert sent(message, found) == as_sent(message, wanted or {})
        assert accepted, message.name
        assert len(accepted) < len(frames) or all_stand_for_values(message), message.name
        for value, again in zip(accepted, peer.runner.packed(message, accepted), strict=True):
            if has_signals(message, value):
                assert again == encoded(other, sent(message, value))


def drawn(peer: Peer, message: Message) -> list[bytes]:
    """Random frames, frames one bit away from a packed value, and raw values just out of range."""
    chance = random.Random(message.name)
    packed = peer.runner.packed(message, samples(message))
    frames = [chance.randbytes(message.length) for _ in range(DRAWN)]
    for _ in range(DRAWN):
        near = int.from_bytes(chance.choice(packed)) ^ 1 << chance.randrange(8 * message.length)
        frames.append(near.to_bytes(message.length))
    for signal in message.signals:
        low, high = signal.raw_range
        frames += [with_raw(signal, raw, f) for raw in (low - 1, high + 1) for f in packed[::8]]
    return frames


def with_raw(signal: Signal, raw: int, frame: bytes) -> bytes:
    """The frame with another raw value."""
    changed = bytearray(frame)
    for index, bit in enumerate(signal.bits()):
        changed[bit // 8] &= ~(1 << bit % 8)
        changed[bit // 8] |= (raw >> index & 1) << bit % 8
    return bytes(changed)


def page_is_known(other: DbcMessage, message: Message, frame: bytes) -> bool:
    """Has the database signals on the frame's page? Else cantools refuses to decode it."""
    selector = next((s for s in message.signals if s.selects), None)
    if selector is None:
        return True
    paged = [s.multiplexer_ids or () for s in other.signals]
    return raw_of(selector, frame) in {page for pages in paged for page in pages}


def as_sent(message: Message, raws: dict[str, int]) -> dict[str, int]:
    """The raw values after Unpack and Pack: the literal of other values has one of its own."""
    signals = {s.name: s for s in message.signals}
    return {name: signals[name].raw(signals[name].value(raw)) for name, raw in raws.items()}


def by_database(message: Message, other: DbcMessage, frame: bytes) -> dict[str, int] | None:
    """The raw values that cantools reads; None where one is outside what the database says."""
    partial = {s.name for s in message.signals if s.other is not None}
    raws = without_header(other.decode(frame, scaling=False, decode_choices=False))
    for name, raw in raws.items():
        signal = other.get_signal_by_name(name)
        if name in partial:
            continue
        if signal.choices:  # one literal alone: [0|0], which a database has for no range at all
            if raw not in signal.choices:
                return None
            continue
        assert signal.minimum is not None and signal.maximum is not None
        low = round((signal.minimum - signal.offset) / signal.scale)
        high = round((signal.maximum - signal.offset) / signal.scale)
        if not low <= raw <= high:
            return None
    return {name: int(str(raw)) for name, raw in raws.items()}


def raw_of(signal: Signal, frame: bytes) -> int:
    """The raw value of a signal, bit by bit."""
    taken = [frame[bit // 8] >> bit % 8 & 1 for bit in signal.bits()]
    raw = sum(bit << index for index, bit in enumerate(taken))
    return raw - (taken[-1] << signal.width if signal.signed else 0)


def expected(message: Message, frame: bytes) -> dict[str, int] | None:
    """The raw values in a frame, bit by bit; None where one of them is no value's."""
    raws: dict[str, int] = {}
    for signal in message.signals:
        raws[signal.name] = raw_of(signal, frame)
    page = next((raws[s.name] for s in message.signals if s.selects), None)
    there = {s.name: s for s in message.signals if not s.pages or page in s.pages}
    for name, signal in there.items():
        try:
            valid = signal.value(raws[name])
        except (ValueError, IndexError):
            return None
        if raws[name] < 0 and not signal.signed:
            return None
        if isinstance(signal.type, IntegerType) and not (
            signal.type.first <= int(valid) <= signal.type.last
        ):
            return None
    return {name: raws[name] for name in there}


@pytest.mark.parametrize(
    "peers", [(FEATURES / "signals" / "model.yaml", HERE)], indirect=True, ids=["signals"]
)
def test_the_database_says_who_sends_what_how_often_with_which_codes(peers: list[Peer]) -> None:
    (peer,) = peers
    motion = peer.message("motion_out")
    assert (motion.senders, motion.cycle_time) == (["board"], 20)
    gear = peer.message("motion_in").get_signal_by_name("gear")
    assert gear.choices == {0: "Neutral", 17: "Forward", 3: "Backward"}


@pytest.mark.parametrize(
    "peers", [(FEATURES / "pages" / "model.yaml", HERE)], indirect=True, ids=["pages"]
)
def test_the_database_says_units_ranges_and_pages(peers: list[Peer]) -> None:
    (peer,) = peers
    inside = peer.message("status_in").get_signal_by_name("inside")
    assert (inside.unit, inside.scale, inside.offset) == ("degC", 0.1, 0)
    assert (inside.multiplexer_signal, inside.multiplexer_ids) == ("page", [0])
    assert (inside.minimum, inside.maximum, inside.receivers) == (-40, 125, ["board"])


def test_a_codec_that_agrees_with_itself_and_not_with_the_table_breaks_its_contract(
    tmp_path: Path,
) -> None:
    checked = checking.check(FEATURES / "signals" / "model.yaml")
    for name, text in generate(checked.system, generation.claims(checked)).items():
        if "codecs" in name:  # the byte of the load, read and written one further
            assert "16#FF#" in text or "40)" in text
            text = text.replace("Shift_Right (Word, 40)", "Shift_Right (Word, 56)")
            text = text.replace(
                "(Interfaces.Unsigned_64 (Local_Load), 40)",
                "(Interfaces.Unsigned_64 (Local_Load), 56)",
            )
        (tmp_path / name).write_text(text, encoding="utf-8")
    runner = Runner.built(checked.system, tmp_path, tmp_path)
    message = checked.system.messages[0]
    with pytest.raises(subprocess.CalledProcessError):
        runner.packed(message, samples(message)[:1])
