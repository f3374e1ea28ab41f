# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a frame codec costs: generated Ada against the C that cantools generates from the DBC.

All messages of the Cartesian robot, the same values in one program, alternating. Ada is
built as the program is (-O2; proof stands for checks), the C with -O2. Two figures for C:

- bare: `pack` and `unpack` alone, between bytes and raw values. No range is checked and
  no offset added: less than the Ada does, which refuses frames that are out of range.
- with what an application adds for the same guarantee: `is_in_phys_range` and `encode`
  for each signal before `pack`, `is_in_range` and `decode` for each after `unpack`; these
  are in one file with the generated C, so that its compiler may inline all of it.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ravenchart.building import checking, generation, programs
from ravenchart.gen.emit.ada.naming import ada_case, type_name
from ravenchart.gen.emit.buses.codecs import codec_name
from ravenchart.gen.language.terms import EnumerationType
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.signals import Signal
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from ravenchart.tools import toolchain

VALUES = 256
"""Different values of each message, packed and unpacked one after the other."""
PASSES = 80
"""Over all values, in a round."""
WAYS = ("pack", "unpack")
KINDS = ("ada", "bare", "checked")
PEER = "robot_bus"
"""What cantools calls the C, after the bus of the robot."""

Figures = dict[str, dict[tuple[str, str], float]]
"""Nanoseconds by message, and by way and kind."""

MAIN = """\
with Ada.Real_Time;
with Ada.Text_IO;
with Interfaces;
with {system}.Codecs;

procedure Codecs_Bench is
   use Ada.Real_Time;
   use {system};
   use type Interfaces.Unsigned_64;

   subtype Word is Interfaces.Unsigned_64;
   type Words is array (1 .. {values}) of aliased Word
   with Convention => C;

   Rounds : constant := 50;
   Passes : constant := {passes};
   Wrong  : exception;

   Seed : Word := 16#9E37_79B9_7F4A_7C15#;

   function Random return Word is  --  Marsaglia's xorshift
   begin
      Seed := Seed xor Interfaces.Shift_Left (Seed, 13);
      Seed := Seed xor Interfaces.Shift_Right (Seed, 7);
      Seed := Seed xor Interfaces.Shift_Left (Seed, 17);
      return Seed;
   end Random;

   generic
      Name : String;
      type Item is private;
      with function Pack (From : Item) return Word;
      with procedure Unpack
        (From : Word; To : out Item; Valid : out Boolean);
      with procedure Bare_Pack (To : in out Words);
      with procedure Bare_Unpack (From : Words);
      with procedure Checked_Pack (To : in out Words);
      with procedure Checked_Unpack (From : Words);
   procedure Compare;

   procedure Compare is
      type Kind is (Ada_Pack, Bare_Pack_Of_C, Checked_Pack_Of_C,
                    Ada_Unpack, Bare_Unpack_Of_C, Checked_Unpack_Of_C);
      type Items is array (Words'Range) of Item;
      Given, Found : Items;
      Frames       : Words := (others => 0);
      By_C         : Words;
      Valid        : Boolean;
      All_Valid    : Boolean := True;
      Best : array (Kind) of Duration := (others => Duration'Last);

      procedure Run (What : Kind) is
         Start : constant Time := Clock;
      begin
         case What is
            when Ada_Pack =>
               for Unused in 1 .. Passes loop
                  for I in Words'Range loop
                     Frames (I) := Pack (Given (I));
                  end loop;
               end loop;
            when Ada_Unpack =>
               for Unused in 1 .. Passes loop
                  for I in Words'Range loop
                     Unpack (Frames (I), Found (I), Valid);
                     All_Valid := All_Valid and Valid;
                  end loop;
               end loop;
            when Bare_Pack_Of_C      => Bare_Pack (By_C);
            when Bare_Unpack_Of_C    => Bare_Unpack (Frames);
            when Checked_Pack_Of_C   => Checked_Pack (By_C);
            when Checked_Unpack_Of_C => Checked_Unpack (Frames);
         end case;
         Best (What) :=
           Duration'Min (Best (What), To_Duration (Clock - Start));
      end Run;
   begin
      for One of Given loop
         loop
            Unpack (Random, One, Valid);
            exit when Valid;
         end loop;
      end loop;
      Run (Ada_Pack);
      Run (Bare_Unpack_Of_C);
      Run (Checked_Unpack_Of_C);
      --  Now the C has the same values, and must make the same frames.
      for Unused in 1 .. Rounds loop
         for What in Kind loop
            if What in Bare_Pack_Of_C | Checked_Pack_Of_C then
               By_C := (others => 0);
            end if;
            Run (What);
            if What in Bare_Pack_Of_C | Checked_Pack_Of_C
              and then By_C /= Frames
            then
               raise Wrong with Name;
            end if;
         end loop;
      end loop;
      if not All_Valid or else Found /= Given then
         raise Wrong with Name;
      end if;
      Ada.Text_IO.Put (Name);
      for Spent of Best loop
         Ada.Text_IO.Put (Duration'Image (Spent));
      end loop;
      Ada.Text_IO.New_Line;
   end Compare;

{imports}
begin
{calls}
end Codecs_Bench;
"""

IMPORTS = """\
   procedure {name}_Bare_Pack (To : in out Words)
   with
     Import,
     Convention    => C,
     External_Name => "bench_bare_pack_{c}";
   procedure {name}_Bare_Unpack (From : Words)
   with
     Import,
     Convention    => C,
     External_Name => "bench_bare_unpack_{c}";
   procedure {name}_Checked_Pack (To : in out Words)
   with
     Import,
     Convention    => C,
     External_Name => "bench_checked_pack_{c}";
   procedure {name}_Checked_Unpack (From : Words)
   with
     Import,
     Convention    => C,
     External_Name => "bench_checked_unpack_{c}";
   procedure Compare_{name} is new Compare
     (Name           => "{c}",
      Item           => {type},
      Pack           => Codecs.{codec}.Pack,
      Unpack         => Codecs.{codec}.Unpack,
      Bare_Pack      => {name}_Bare_Pack,
      Bare_Unpack    => {name}_Bare_Unpack,
      Checked_Pack   => {name}_Checked_Pack,
      Checked_Unpack => {name}_Checked_Unpack);
"""

APPLICATION = """\
bool send_{c}(uint8_t *frame, const struct values_{c} *values)
{{
    struct {peer}_{c}_t raw;
    if (!({phys_ranges}))
        return false;
{encoded}
    return {peer}_{c}_pack(frame, &raw, {length}) == {length};
}}

bool receive_{c}(struct values_{c} *values, const uint8_t *frame)
{{
    struct {peer}_{c}_t raw;
    if ({peer}_{c}_unpack(&raw, frame, {length}) != 0 || !({ranges}))
        return false;
{decoded}
    return true;
}}
"""
"""What an application writes around the C of a message."""

LOOPS = """\
static struct {peer}_{c}_t raw_{c}[{values}];
static struct values_{c} values_{c}[{values}];

void bench_bare_pack_{c}(uint8_t (*frames)[8])
{{
    for (int pass = 0; pass < {passes}; pass++)
        for (int i = 0; i < {values}; i++)
            {peer}_{c}_pack(frames[i], &raw_{c}[i], {length});
}}

void bench_bare_unpack_{c}(uint8_t (*frames)[8])
{{
    for (int pass = 0; pass < {passes}; pass++)
        for (int i = 0; i < {values}; i++)
            {peer}_{c}_unpack(&raw_{c}[i], frames[i], {length});
}}

void bench_checked_pack_{c}(uint8_t (*frames)[8])
{{
    bool good = true;
    for (int pass = 0; pass < {passes}; pass++)
        for (int i = 0; i < {values}; i++)
            good &= send_{c}(frames[i], &values_{c}[i]);
    if (!good)
        abort();
}}

void bench_checked_unpack_{c}(uint8_t (*frames)[8])
{{
    bool good = true;
    for (int pass = 0; pass < {passes}; pass++)
        for (int i = 0; i < {values}; i++)
            good &= receive_{c}(&values_{c}[i], frames[i]);
    if (!good)
        abort();
}}
"""


def ada_main(system: System) -> str:
    """The program around both."""
    imports, calls = [], []
    for message in system.messages:
        name = ada_case(message.name)
        imports.append(
            IMPORTS.format(
                name=name,
                c=message.name,
                type=type_name(system, message.type).text,
                codec=codec_name(message),
            )
        )
        calls.append(f"   Compare_{name};")
    return MAIN.format(
        system=ada_case(system.name),
        values=VALUES,
        passes=PASSES,
        imports="\n".join(imports),
        calls="\n".join(calls),
    )


def _coded(message: Message, signal: Signal) -> tuple[str, str]:
    """To raw and back, in C; an enumeration is its raw value."""
    function, field = f"{PEER}_{message.name}_{signal.name}", signal.name
    if isinstance(signal.type, EnumerationType):
        return f"    raw.{field} = values->{field};", f"    values->{field} = raw.{field};"
    return (
        f"    raw.{field} = {function}_encode(values->{field});",
        f"    values->{field} = {function}_decode(raw.{field});",
    )


def c_texts(messages: Sequence[Message]) -> dict[str, str]:
    """The C around that of cantools: values, what works on them, and the loops."""
    header = [f'#include "{PEER}.h"\n#include <stdlib.h>\n']
    application = [f'#include "values.h"\n#include "{PEER}.c"\n']
    loops = ['#include "values.h"\n']
    for message in messages:
        c = message.name
        fields = "".join(
            f"    {'uint8_t' if isinstance(s.type, EnumerationType) else 'double'} {s.name};\n"
            for s in message.signals
        )
        header.append(
            f"struct values_{c} {{\n{fields}}};\n"
            f"bool send_{c}(uint8_t *frame, const struct values_{c} *values);\n"
            f"bool receive_{c}(struct values_{c} *values, const uint8_t *frame);\n"
        )
        checks = [
            (f"{PEER}_{c}_{s.name}_is_in_phys_range(values->{s.name})",
             f"{PEER}_{c}_{s.name}_is_in_range(raw.{s.name})")
            for s in message.signals
        ]  # fmt: skip
        encoded, decoded = zip(*(_coded(message, s) for s in message.signals), strict=True)
        application.append(
            APPLICATION.format(
                c=c,
                peer=PEER,
                length=message.length,
                phys_ranges=" && ".join(phys for phys, _ in checks),
                ranges=" && ".join(raw for _, raw in checks),
                encoded="\n".join(encoded),
                decoded="\n".join(decoded),
            )
        )
        loops.append(
            LOOPS.format(c=c, peer=PEER, values=VALUES, passes=PASSES, length=message.length)
        )
    texts = {"values.h": header, "application.c": application, "loops.c": loops}
    return {name: "\n".join(parts) for name, parts in texts.items()}


def c_objects(system: System, database: Path, place: Path) -> list[str]:
    """The C, generated and compiled."""
    command = [sys.executable, "-P", "-m", "cantools", "generate_c_source", "--database-name", PEER]
    subprocess.run([*command, database], cwd=place, capture_output=True, check=True)
    texts = c_texts(system.messages)
    for name, text in texts.items():
        (place / name).write_text(text, encoding="ascii")
    sources = [name for name in texts if name.endswith(".c")]
    subprocess.run(["gcc", "-O2", "-std=c11", "-c", *sources], cwd=place, check=True)
    return [str(place / name.replace(".c", ".o")) for name in sources]


def nanoseconds() -> Figures:
    """What each message takes each way; the best rounds."""
    with tempfile.TemporaryDirectory(prefix="ravenchart-codecs-") as place:
        folder = Path(place) / "robot"
        shutil.copytree(ROOT / "examples" / "cartesian_robot", folder)
        checked = checking.check(folder / "model.yaml")
        generation.write_program(checked)
        system = checked.system
        (made,) = programs.programs_of(checked)
        database = made.generated / f"{system.buses[0].name}.dbc"
        objects = c_objects(system, database, Path(place))
        (folder / "user" / "codecs_bench.adb").write_text(ada_main(system), encoding="ascii")
        given = {**made.scenario("release", "loopback"), "RAVENCHART_BUILD": place}
        options = ["-p", "-q", "-P", made.project.name, "codecs_bench.adb"]
        linked = [*options, "-largs", *objects, "-gargs"]
        toolchain.run("gprbuild", linked, made.generated, given)
        program = Path(place) / "release" / "codecs_bench"
        done = subprocess.run([program], capture_output=True, text=True, timeout=300, check=True)
    columns = [(way, kind) for way in WAYS for kind in KINDS]
    figures: Figures = {}
    for line in done.stdout.splitlines():
        name, *spent = line.split()
        each = (float(seconds) * 1e9 / (VALUES * PASSES) for seconds in spent)
        figures[name] = dict(zip(columns, each, strict=True))
    return figures


def main() -> None:
    """The figures."""
    figures = nanoseconds()
    print("codecs of the Cartesian robot, generated Ada against C of cantools (-O2; best of 50")
    print("rounds); C bare, and with the ranges checked and units as the Ada has them:")
    for name, spent in figures.items():
        for way in WAYS:
            _line(f"{way} {name}", *(spent[way, kind] for kind in KINDS))
    whole = [sum(spent[way, k] for spent in figures.values() for way in WAYS) for k in KINDS]
    _line("the whole", *whole)


def _line(what: str, ada: float, bare: float, checked: float) -> None:
    verdict = "" if ada <= bare else " (slower)"
    print(
        f"  {what}: {ada:.2f} ns, C {bare:.2f}: {ada / bare:.2f} times{verdict};"
        f" checked {checked:.2f}: {ada / checked:.2f} times"
    )


if __name__ == "__main__":
    main()
