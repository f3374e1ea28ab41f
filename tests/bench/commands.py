# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a command costs: a plain call of a driver, a direct one of its device, a queued one.

All in one run of one program, alternating, built with -O2 and checks off.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

from ravenchart.building import checking, generation, programs
from ravenchart.paths import ROOT
from ravenchart.tools import toolchain

MOST_OF_PLAIN = 1.05
"""What a direct call may cost, as a multiple of a plain call."""

CALLS = 20_000
"""In a round, as the program below has it."""

MAIN = """\
with Ada.Real_Time;
with Ada.Text_IO;
with Kept;
with Requests_Feature.Brake;
with Requests_Feature.Brake_1;
with Requests_Feature.Mover;
with Requests_Feature.Mover_1;
with Ravenchart.Queueing;

procedure Commands_Bench is
   use Ada.Real_Time;

   Rounds : constant := 50;
   Calls  : constant := 20_000;

   Reply : Requests_Feature.Outcome;
   Full  : Ravenchart.Queueing.Put_Status;
   Row   : Ravenchart.Element_Id;

   type Kind is (Plain, Direct, Queued);
   Best : array (Kind) of Duration := (others => Duration'Last);

   procedure Run (What : Kind) is
      Start : constant Time := Clock;
   begin
      case What is
         when Plain =>
            for Unused in 1 .. Calls loop
               Requests_Feature.Brake.Reset (Kept.State, Reply);
            end loop;
         when Direct =>
            for Unused in 1 .. Calls loop
               Requests_Feature.Brake_1.Reset (Reply);
            end loop;
         when Queued =>
            for Unused in 1 .. Calls loop
               Requests_Feature.Mover_1.Put_Motion
                 ((Name   => Requests_Feature.Mover.Motion_Requests.Hold_Asked,
                   others => <>),
                  Full);
               Row := 0;
               Requests_Feature.Mover_1.Run_Serve (Row);
            end loop;
      end case;
      Best (What) :=
        Duration'Min (Best (What), To_Duration (Clock - Start));
   end Run;
begin
   for Unused in 1 .. Rounds loop
      for What in Kind loop
         Run (What);
      end loop;
   end loop;
   for What in Kind loop
      Ada.Text_IO.Put_Line (Duration'Image (Best (What)));
   end loop;
end Commands_Bench;
"""

KEPT = """\
with Requests_Feature.Brake_States;

package Kept is
   State : Requests_Feature.Brake_States.State;
   --  What the plain call works on: in memory, as that of a device is.
end Kept;
"""


def nanoseconds() -> tuple[float, float, float]:
    """One plain, one direct and one queued command, put and executed; the best rounds."""
    with tempfile.TemporaryDirectory(prefix="ravenchart-commands-") as place:
        folder = Path(place) / "requests"
        shutil.copytree(ROOT / "tests" / "feature" / "requests", folder)
        checked = checking.check(folder / "model.yaml")
        generation.write_program(checked)
        (folder / "user" / "commands_bench.adb").write_text(MAIN, encoding="utf-8")
        (folder / "user" / "kept.ads").write_text(KEPT, encoding="utf-8")
        (made,) = programs.programs_of(checked)
        given = {**made.scenario("release", "loopback"), "RAVENCHART_BUILD": place}
        options = ["-p", "-q", "-P", made.project.name, "commands_bench.adb"]
        toolchain.run("gprbuild", options, made.generated, given)
        program = Path(place) / "release" / "commands_bench"
        done = subprocess.run([program], capture_output=True, text=True, timeout=300, check=True)
    plain, direct, queued = (float(line) * 1e9 / CALLS for line in done.stdout.split())
    return plain, direct, queued


def main() -> None:
    """The figures."""
    plain, direct, queued = nanoseconds()
    verdict = "" if direct <= MOST_OF_PLAIN * plain else f" (more than {MOST_OF_PLAIN} times)"
    print("commands (-O2, ceiling locking; best of 50 rounds):")
    print(f"  a plain call of the driver: {plain:.2f} ns")
    print(f"  a direct command of its device: {direct:.2f} ns, {direct / plain:.2f} times{verdict}")
    print(f"  a queued command, put and executed: {queued:.1f} ns, {queued / plain:.0f} times")


if __name__ == "__main__":
    main()
