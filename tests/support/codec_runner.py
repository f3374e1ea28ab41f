# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The generated codecs of a model as a program, beside cantools with the generated database.

The program reads lines ``P n value...`` and ``U n byte...``, where n is the number of a
message, and answers with the bytes of the packed value, or with whether the bytes are
valid and the values in them. Enumerations are given by position.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ravenchart.building import checking, generation
from ravenchart.gen.derive.completion import programs
from ravenchart.gen.emit.ada.naming import ada_case, type_name
from ravenchart.gen.emit.buses.codecs import WORDS, codec_name, words_of
from ravenchart.gen.emit.program import folder_of, generate, library_files
from ravenchart.gen.language.terms import EnumerationType
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.signals import Signal
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from tests.hardware.machines import HERE, Machine

Values = tuple[int, ...]


def _read(system: System, message: Message, signal: Signal) -> str:
    name = type_name(system, signal.type).text
    target = "Item" if signal.field is None else f"Item.{ada_case(signal.field)}"
    made = f"{name}'Val (N)" if isinstance(signal.type, EnumerationType) else f"{name} (N)"
    return f"Get (N); {target} := {made};"


def _shown(system: System, signal: Signal) -> str:
    source = "Item" if signal.field is None else f"Item.{ada_case(signal.field)}"
    if isinstance(signal.type, EnumerationType):
        of_type = type_name(system, signal.type).text
        return f"Put ({of_type}'Pos ({source}), Width => 1); Put (' ');"
    return f"Put (Long_Long_Integer ({source}), Width => 1); Put (' ');"


def _cases(system: System, message: Message) -> tuple[str, str]:
    codec, of_type = codec_name(message), type_name(system, message.type).text
    single = words_of(message) == 1
    frame = "F (0)" if single else "F"
    start = f"Item : {of_type}"
    reads = "\n".join(_read(system, message, s) for s in message.signals)
    shows = "\n".join(_shown(system, s) for s in message.signals)
    pack = (
        f"declare {start}; begin {reads} {frame} := Codecs.{codec}.Pack (Item);"
        f" Put_Bytes ({message.length}); end;"
    )
    unpack = (
        f"declare {start}; Valid : Boolean; begin Get_Bytes ({message.length});"
        f" Codecs.{codec}.Unpack ({frame}, Item, Valid);"
        f' Put (if Valid then "1 " else "0 "); {shows} end;'
    )
    return pack, unpack


def main_text(system: System) -> str:
    """The program."""
    packs, unpacks = zip(*(_cases(system, m) for m in system.messages), strict=True)
    arms = [
        "\n".join(f"when {index} => {text}" for index, text in enumerate(texts))
        for texts in (packs, unpacks)
    ]
    return f"""
with Ada.Text_IO; with Ada.Long_Long_Integer_Text_IO; with Interfaces;
with Ravenchart.Can.Fd_Frames; with {ada_case(system.name)}.Codecs;
procedure Runner is
   use Ada.Text_IO; use Ada.Long_Long_Integer_Text_IO; use {ada_case(system.name)};
   use type Interfaces.Unsigned_64;
   F : {WORDS.text} := (others => 0);
   Kind : Character;
   Number, N : Long_Long_Integer;
   procedure Put_Bytes (Length : Natural) is
   begin
      for I in 0 .. Length - 1 loop
         Put (Long_Long_Integer
              (Interfaces.Shift_Right (F (I / 8), 8 * (I mod 8)) and 255), Width => 1);
         Put (' ');
      end loop;
   end Put_Bytes;
   procedure Get_Bytes (Length : Natural) is
      B : Long_Long_Integer;
   begin
      F := (others => 0);
      for I in 0 .. Length - 1 loop
         Get (B);
         F (I / 8) := F (I / 8)
           or Interfaces.Shift_Left (Interfaces.Unsigned_64 (B), 8 * (I mod 8));
      end loop;
   end Get_Bytes;
begin
   while not End_Of_File loop
      Get (Kind); Get (Number);
      F := (others => 0);
      if Kind = 'P' then
         case Number is
            {arms[0]}
            when others => null;
         end case;
      else
         case Number is
            {arms[1]}
            when others => null;
         end case;
      end if;
      Skip_Line; New_Line;
   end loop;
end Runner;
"""


@dataclass(frozen=True, slots=True)
class Runner:
    """The program, built."""

    system: System
    command: tuple[str, ...]

    @staticmethod
    def built(system: System, generated: Path, folder: Path, machine: Machine = HERE) -> Runner:
        """Built in ``folder`` from the files of a generation, to run on ``machine``."""
        source = folder / "runner.adb"
        source.write_text(main_text(system), encoding="ascii")
        places = (generated, ROOT / "spark_runtime" / "src", ROOT / "hw_can" / "hal")
        machine.build([source], places, folder)
        return Runner(system, machine.command(folder / "runner"))

    def _answers(self, lines: Sequence[str]) -> list[list[int]]:
        text = "\n".join(lines) + "\n"
        found = subprocess.run(
            self.command, input=text, capture_output=True, text=True, check=True, timeout=100
        )
        return [[int(word) for word in line.split()] for line in found.stdout.splitlines()]

    def packed(self, message: Message, values: Sequence[Values]) -> list[bytes]:
        """The bytes of each value."""
        number = self.system.messages.index(message)
        return [
            bytes(answer)
            for answer in self._answers([f"P {number} {' '.join(map(str, v))}" for v in values])
        ]

    def unpacked(self, message: Message, frames: Sequence[bytes]) -> list[Values | None]:
        """The value in each frame; None where the frame is not valid."""
        number = self.system.messages.index(message)
        answers = self._answers([f"U {number} {' '.join(map(str, f))}" for f in frames])
        return [tuple(values) if valid else None for valid, *values in answers]


def runners_of(
    checked: checking.Checked, folder: Path, machine: Machine = HERE
) -> Iterator[tuple[Path, Runner]]:
    """The codecs of each node of a model that has some, and their folder below ``folder``.

    The folder has the databases of the model too.
    """
    files = generate(checked.system, generation.claims(checked))
    databases = {name: text for name, text in files.items() if name.endswith(".dbc")}
    libraries = {n: t for one in checked.system.libraries for n, t in library_files(one).items()}
    for part in programs(checked.system):
        if part.messages:
            at = folder_of(part, checked.system)
            own = {n.removeprefix(at): t for n, t in files.items() if n.startswith(at)}
            place = folder / part.nodes[0].name
            place.mkdir(parents=True)
            for name, text in {**libraries, **own, **databases}.items():
                if "/" not in name:
                    (place / name).write_text(text, encoding="utf-8")
            yield place, Runner.built(part, place, place, machine)


def boundaries(signal: Signal) -> list[int]:
    """The values of a signal where something may go wrong; of an enumeration all, by position."""
    if isinstance(signal.type, EnumerationType):
        return list(range(len(signal.type.literals)))
    low, high = signal.type.first, signal.type.last
    near = {low, low + 1, high - 1, high, -1, 0, 1, (low + high) // 2}
    return sorted(value for value in near if low <= value <= high)


def literal(signal: Signal, value: int) -> int | str:
    """The value as the model has it."""
    if isinstance(signal.type, EnumerationType):
        return signal.type.literals[value]
    return value
