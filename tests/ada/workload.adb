--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Processor_Clocks;

package body Workload is

   use type Ravenchart.Nanoseconds;

   Late_Releases : Natural := 0;
   --  Used by the one task of Late.

   Request : Natural := 0;
   --  Used by the one task of Sporadic.

   protected body Log is

      procedure Add (Item : Entry_Record) is
      begin
         if Used < Log_Index'Last then
            Used           := Used + 1;
            Entries (Used) := Item;
         end if;
      end Add;

      function Count return Natural
      is (Used);

      function Item (Index : Log_Index) return Entry_Record
      is (Entries (Index));

   end Log;

   procedure Run_Cyclic (Activity : Job) is
   begin
      Cyclic_Log.Add ((Activity, 0, Ada.Real_Time.Clock));
   end Run_Cyclic;

   procedure Run_Late (Activity : Job) is
      Busy  : constant := 35_000_000;
      Begun : Ravenchart.Nanoseconds;
      Now   : Ravenchart.Nanoseconds;
   begin
      Late_Log.Add ((Activity, 0, Ada.Real_Time.Clock));
      if Activity = Each_Release then
         if Late_Releases = 3 then
            --  Work for three and a half periods.
            Ravenchart.Processor_Clocks.Read (Begun);
            loop
               Ravenchart.Processor_Clocks.Read (Now);
               exit when Now - Begun > Busy;
            end loop;
         end if;
         Late_Releases := Late_Releases + 1;
      end if;
   end Run_Late;

   procedure Wait_Sporadic is
   begin
      Requests.Wait (Request);
   end Wait_Sporadic;

   procedure Run_Sporadic (Activity : Job) is
   begin
      Sporadic_Log.Add ((Activity, Request, Ada.Real_Time.Clock));
   end Run_Sporadic;

   procedure Note_Miss is
   begin
      Missed_Log.Add ((Each_Release, 0, Ada.Real_Time.Clock));
   end Note_Miss;

   procedure Note_Overrun (Activity : Job; Used : Ravenchart.Nanoseconds) is
   begin
      if Used > 20_000_000 then
         Overrun_Log.Add
           ((Activity, Natural (Used / 1_000_000), Ada.Real_Time.Clock));
      end if;
   end Note_Overrun;

   procedure Ignore_Miss is null;

end Workload;
