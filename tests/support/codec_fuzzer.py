# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Random frames through the generated codecs of a model, as a program of their own.

For each message the program draws frames, half of them at random and half one bit away
from the last one that was accepted, and stops with an exception where a codec is wrong: a
value outside its type, a frame that packs into other bits than it was unpacked from, a
refused frame that leaves something behind. What bits count is taken from the layout,
not from the codec. It answers with a line for each message: name, frames, those
accepted, and a sum over all that was unpacked and packed.
"""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ravenchart.gen.emit.ada.expression_text import flat
from ravenchart.gen.emit.ada.naming import ada_case, default_value, type_name
from ravenchart.gen.emit.buses.codecs import WORDS, codec_name, words_of
from ravenchart.gen.emit.buses.coding import choice_of_value
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.signals import Signal
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from tests.support import compiler

CHECKED = ("-gnata", "-O0")
"""Every contract and check is on."""
UNCHECKED = ("-gnatp", "-O2")
"""None is."""


@dataclass(frozen=True, slots=True)
class Tally:
    """What became of the frames of one message."""

    message: str
    frames: int
    accepted: int
    total: int


def fuzzed(
    system: System, generated: Path, folder: Path, frames: int, switches: Sequence[str]
) -> tuple[Tally, ...]:
    """Frames through each codec; CalledProcessError where one is wrong."""
    folder.mkdir()
    source = folder / "fuzzer.adb"
    source.write_text(main_text(system, frames), encoding="ascii")
    places = (generated, ROOT / "spark_runtime" / "src", ROOT / "hw_can" / "hal")
    command = ["gnatmake", "-q", "-gnat2012", *switches, *compiler.options(), str(source)]
    command += [f"-aI{place}" for place in places]
    subprocess.run(command, cwd=folder, check=True)
    found = subprocess.run([folder / "fuzzer"], capture_output=True, text=True, check=True)
    lines = [line.split() for line in found.stdout.splitlines()]
    return tuple(Tally(name, *map(int, counts)) for name, *counts in lines)


def main_text(system: System, frames: int) -> str:
    """The program."""
    name = ada_case(system.name)
    return f"""
with Ada.Text_IO; with Interfaces; with Ravenchart.Can.Fd_Frames; with {name}.Codecs;
procedure Fuzzer is
   use {name}; use type Interfaces.Unsigned_64; use type {WORDS.text};
   subtype Bits is Interfaces.Unsigned_64;
   subtype Words is {WORDS.text};
   Wrong : exception;
   Seed : Bits := 16#9E37_79B9_7F4A_7C15#;
   Sum  : Bits := 0;
   function Random return Bits is  --  Marsaglia's xorshift, of period 2**64 - 1
   begin
      Seed := Seed xor Interfaces.Shift_Left (Seed, 13);
      Seed := Seed xor Interfaces.Shift_Right (Seed, 7);
      Seed := Seed xor Interfaces.Shift_Left (Seed, 17);
      return Seed;
   end Random;
   function Room (Length, Word : Natural) return Bits is  --  a mask of the bytes in that word
     (if Length >= 8 * Word + 8 then Bits'Last
      elsif Length <= 8 * Word then 0
      else Interfaces.Shift_Left (1, 8 * (Length - 8 * Word)) - 1);
   function Drawn (Near : Words; Length : Natural) return Words is
      Found : constant Bits := Random;
      Place : constant Natural := Natural (Found / 2 mod Bits'Max (1, Bits (8 * Length)));
      Made  : Words := Near;
   begin
      if Found mod 2 = 1 then
         Made (Place / 64) := Made (Place / 64) xor Interfaces.Shift_Left (1, Place mod 64);
      end if;
      for I in Made'Range loop
         if Found mod 2 = 0 then
            Made (I) := Random;
         end if;
         Made (I) := Made (I) and Room (Length, I);
      end loop;
      return Made;
   end Drawn;
   procedure Add (Frame : Words; Length : Natural) is
   begin
      for I in 0 .. (Length - 1) / 8 loop
         Sum := (Sum xor Frame (I)) * 16#100_0000_01B3#;
      end loop;
   end Add;
   procedure Expect (Fact : Boolean) is
   begin
      if not Fact then
         raise Wrong;
      end if;
   end Expect;
   procedure Tell (Message : String; Accepted : Natural) is
   begin
      Ada.Text_IO.Put_Line (Message & " {frames}" & Accepted'Image & Sum'Image);
   end Tell;
{"".join(_procedure(system, message, frames) for message in system.messages)}
begin
   {" ".join(f"Fuzz_{ada_case(message.name)};" for message in system.messages)}
end Fuzzer;
"""


def _procedure(system: System, message: Message, frames: int) -> str:
    codec, of_type = codec_name(message), type_name(system, message.type).text
    part = " (0)" if words_of(message) == 1 else ""
    in_range = " and then ".join(f"{_item(signal)}'Valid" for signal in message.signals)
    default = flat(default_value(system, message.type))
    return f"""
   procedure Fuzz_{ada_case(message.name)} is
      use type {of_type};
      Item : {of_type}; Valid : Boolean;
      Frame, Again, Near, Mask : Words := (others => 0);
      Accepted : Natural := 0;
   begin
      for I in 1 .. {frames} loop
         Frame := Drawn (Near, {message.length});
         Codecs.{codec}.Unpack (Frame{part}, Item, Valid);
         if Valid then
            Expect ({in_range});
            {_mask(system, message)}
            Again{part} := Codecs.{codec}.Pack (Item);
            for I in Mask'Range loop
               Mask (I) := Mask (I) and Frame (I);
            end loop;
            Expect (Again = Mask);
            Near := Frame;
            Accepted := Accepted + 1;
            Add (Again, {message.length});
         else
            Expect (Item = {default});
            Add (Frame, {message.length});
         end if;
      end loop;
      Tell ("{message.name}", Accepted);
   end Fuzz_{ada_case(message.name)};
"""


def _item(signal: Signal) -> str:
    return "Item" if signal.field is None else f"Item.{ada_case(signal.field)}"


def _mask(system: System, message: Message) -> str:
    """What sets Mask to the bits of the signals that are in the frame."""
    text = "Mask := (others => 0);"
    selector = next((s for s in message.signals if s.selects), None)
    for signal in message.signals:
        added = _added(signal)
        if selector is not None and signal.pages:
            values = [
                flat(choice_of_value(system, selector, selector.value(page)))
                for page in signal.pages
            ]
            added = f" if {_item(selector)} in {' | '.join(values)} then {added} end if;"
        text += added
    return text


def _added(signal: Signal) -> str:
    """What adds the bits of a signal to Mask."""
    bits = sum(1 << bit for bit in signal.bits())
    words = ((index, bits >> 64 * index & (1 << 64) - 1) for index in range(8))
    return " ".join(f"Mask ({i}) := Mask ({i}) or 16#{word:X}#;" for i, word in words if word)
