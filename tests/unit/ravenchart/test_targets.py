# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Targets: what a folder says, what is missing to build for it, and what its clock demands."""

from __future__ import annotations

import re
import struct
from pathlib import Path

import pytest

from ravenchart.building import checking, images, programs, targets, variants
from ravenchart.failures import Refused, ToolFailed, Unusable
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from ravenchart.running import boards
from ravenchart.running.runs import RunRequest

MODEL = ROOT / "examples" / "three_components" / "model.yaml"
PERIOD = ("processor_1:\n", "processor_1:\n    offset: 1005 ns\n")
EXACT = 100_000_000
ODD = 99_999_000


def board(rate: int, **facts: object) -> targets.Board:
    """The board with a clock of that rate, whose file says otherwise what is given."""
    found = targets.target("zynqmp")
    changed = found.facts.model_copy(update=facts)
    return targets.Board(targets.Target(found.name, changed), "aarch64-elf", Path("/nowhere"), rate)


def model(tmp_path: Path, *changes: tuple[str, str]) -> System:
    """The three components, changed."""
    text = MODEL.read_text(encoding="utf-8")
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    path = tmp_path / "model.yaml"
    path.write_text(text, encoding="utf-8")
    return checking.check(path).system


def test_every_folder_with_a_file_is_a_target() -> None:
    assert variants.targets() == ("native", "zynqmp")
    for name in variants.targets():
        facts = targets.target(name).facts
        assert set(facts.drivers) <= set(variants.DRIVERS)
    assert set(targets.target("native").facts.drivers) == set(variants.DRIVERS) - {"xilinx"}
    with pytest.raises(Unusable, match="there is no target moon; the targets are native, zynqmp"):
        targets.target("moon")


def test_a_wrong_file_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "moon").mkdir()
    file = tmp_path / "moon" / "target.toml"
    file.write_text('run_time = "light"\ndrivers = []\nclock = 1\n', encoding="utf-8")
    monkeypatch.setattr(variants, "RUNTIME", tmp_path)
    with pytest.raises(Unusable, match=r"target\.toml: 2 validation errors"):
        targets.target("moon")


def test_a_board_needs_a_run_time_library_and_a_compiler(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(variants.RTS_VARIABLE, raising=False)
    chosen = targets.target("zynqmp")
    with pytest.raises(Unusable, match="`--rts DIR` or RAVENCHART_RTS"):
        targets.board(chosen, None)
    monkeypatch.setenv(variants.RTS_VARIABLE, str(tmp_path))
    with pytest.raises(Unusable, match="is no Ada run-time library: it has no folder adalib"):
        targets.board(chosen, None)
    (tmp_path / "adalib").mkdir()
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(Unusable, match="zynqmp needs GNAT for aarch64-elf or aarch64-linux-gnu"):
        targets.board(chosen, None)


def test_a_time_between_two_ticks_needs_a_tick_of_the_node(tmp_path: Path) -> None:
    system = model(tmp_path, PERIOD)
    with pytest.raises(Refused) as refused:
        targets.check_system(board(EXACT), system)
    told, hint = str(refused.value).splitlines()
    assert told.endswith(
        "error: the offset of processor_1, 1005 ns, is no whole number of ticks of the clock of "
        "zynqmp, 100000000 Hz: releases are up to a tick late"
    )
    assert hint.endswith(
        "hint: give board `tick: {period: 10 ns, wcet: 0 ns}` or more; the analysis adds it"
    )
    tick = ("trace: 1024\n", "trace: 1024\n    tick: {period: 10 ns, wcet: 0 ns}\n")
    targets.check_system(board(EXACT), model(tmp_path, PERIOD, tick))
    with pytest.raises(Refused, match="period: 11 ns"):
        targets.check_system(board(ODD), model(tmp_path, PERIOD, tick))


def test_whole_numbers_of_ticks_need_none(tmp_path: Path) -> None:
    system = model(tmp_path)
    for rate in (EXACT, ODD, 168_000_000, 1_000_000_000):
        targets.check_system(board(rate), system)
    with pytest.raises(Refused, match="the period of processor_1, 10 ms, is no whole number"):
        targets.check_system(board(333_333_343), system)


def test_a_periodic_timer_must_be_in_the_model(tmp_path: Path) -> None:
    slow = board(168_000_000, tick=1_000_000)
    with pytest.raises(Refused, match="the timer of zynqmp ticks every 1 ms"):
        targets.check_system(slow, model(tmp_path))
    tick = ("trace: 1024\n", "trace: 1024\n    tick: {period: 1 ms, wcet: 5 us}\n")
    targets.check_system(slow, model(tmp_path, tick))


def test_figures_below_those_of_the_target_are_told(tmp_path: Path) -> None:
    warnings = targets.check_system(board(EXACT), model(tmp_path))
    (warning,) = warnings
    assert warning.endswith(
        "warning: `release` of board, 0 ns, is below the 4 us that zynqmp needs: the bounds do "
        "not hold there"
    )
    release = ("trace: 1024\n", "trace: 1024\n    release: 4 us\n")
    assert targets.check_system(board(EXACT), model(tmp_path, release)) == ()


def test_a_driver_must_be_one_of_the_target(tmp_path: Path) -> None:
    checked = checking.check(MODEL)
    chosen = targets.target("zynqmp")
    assert programs.default_driver(checked, chosen) == "loopback"
    with pytest.raises(Refused, match="the target zynqmp has no driver bus"):
        programs.check_driver(checked, "bus", chosen)


@pytest.mark.slow
def test_a_driver_without_can_fd_takes_none(tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    pump = ROOT / "examples" / "pump" / "model.yaml"
    text = pump.read_text(encoding="utf-8")
    changed = re.sub(r"(bit_rate: [^,}]+)", r"\1, data_rate: 2 Mbit/s", text, count=1)
    assert changed != text
    path.write_text(changed, encoding="utf-8")
    programs.check_driver(checking.check(pump), "xilinx")
    with pytest.raises(Refused, match="the driver xilinx have no CAN FD"):
        programs.check_driver(checking.check(path), "xilinx")


def test_the_driver_is_where_the_file_says() -> None:
    driver = ROOT / "hw_can" / "drivers" / "xilinx"
    text = (driver / "ravenchart-can-xcan_core.ads").read_text(encoding="ascii")
    base = re.search(r"Base => 16#([0-9A-F_]+)#", text)
    assert base is not None
    first = targets.target("zynqmp").facts.can[0]
    assert (first.controller, first.at) == ("xilinx", int(base[1].replace("_", ""), 16))


def image(wide: bool, order: str, *parts: tuple[int, int, int]) -> bytes:
    """The headers of an ELF file, with parts of a kind, an address and a size."""
    at, size, place = (64, 56, 54) if wide else (52, 32, 42)
    made = bytearray(at + size * len(parts))
    made[:6] = b"\x7fELF" + bytes((2 if wide else 1, 1 if order == "<" else 2))
    struct.pack_into(f"{order}{'Q' if wide else 'I'}", made, 32 if wide else 28, at)
    struct.pack_into(f"{order}HH", made, place, size, len(parts))
    for number, (kind, address, taken) in enumerate(parts):
        start = at + number * size
        struct.pack_into(f"{order}I", made, start, kind)
        if wide:
            struct.pack_into(f"{order}QQQ", made, start + 24, address, 0, taken)
        else:
            struct.pack_into(f"{order}III", made, start + 12, address, 0, taken)
    return bytes(made)


@pytest.mark.parametrize("wide", [True, False])
@pytest.mark.parametrize("order", ["<", ">"])
def test_an_image_must_lie_in_the_memory_of_the_target(
    wide: bool, order: str, tmp_path: Path
) -> None:
    chosen = targets.target("zynqmp")
    ram = chosen.facts.memory["ram"]
    path = tmp_path / "image"
    path.write_bytes(image(wide, order, (6, 0, 2**30), (1, ram.at, ram.size), (1, 2**31, 0)))
    images.check(path, chosen)
    path.write_bytes(image(wide, order, (1, ram.at, ram.size + 1)))
    with pytest.raises(ToolFailed, match="1879048193 bytes at 0x0 are outside the memory of zynq"):
        images.check(path, chosen)


def test_what_is_built_for_a_target_has_a_place_of_its_own() -> None:
    checked = checking.check(MODEL)
    here = programs.build_home(checked, "loopback")
    there = programs.build_home(checked, "loopback", "zynqmp")
    assert there == here.with_name(f"{here.name}-zynqmp")


def test_objects_for_another_run_time_library_have_another_place(tmp_path: Path) -> None:
    library = tmp_path / "adalib" / "libgnarl.a"
    library.parent.mkdir()
    library.write_bytes(b"!<arch>\n")

    def found() -> targets.Board:
        return targets.Board(targets.target("zynqmp"), "aarch64-elf", tmp_path, 10**8)

    board = found()
    before, objects = board.place, board.scenario()["RAVENCHART_OBJECTS"]
    assert found().place == before
    library.write_bytes(b"!<arch>\nchanged")
    board = found()
    assert board.place != before
    assert board.place.startswith("zynqmp-")
    assert board.scenario()["RAVENCHART_OBJECTS"] != objects


def test_an_emulator_starts_as_many_cores_as_a_node_has(tmp_path: Path) -> None:
    made = board(EXACT)
    emulator = made.target.facts.emulator
    assert emulator is not None
    for cores in (1, 2):
        words = boards.command(made, emulator, tmp_path, tmp_path, 1.0, cores)
        assert words[words.index("-smp") + 1] == str(cores)


def test_a_model_for_two_cores_is_refused_where_the_emulator_starts_one(tmp_path: Path) -> None:
    checked = checking.check(ROOT / "examples" / "seam_tracker" / "model.yaml")
    request = RunRequest(checked.analysis, (), tmp_path, None, 1.0, tmp_path)
    one = targets.Emulator(command=("emulate", "{image}"), time="none", hint="none")
    with pytest.raises(Unusable, match="the emulator of zynqmp starts one core only"):
        boards.run_board(board(EXACT, emulator=one), request, lambda text: None)
