--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Real_Time;
with Ravenchart.Can.Ctu_Registers;

package body Ctu_Pair is

   package Registers renames Ravenchart.Can.Ctu_Registers;

   use type Ada.Real_Time.Time;

   generic
      with procedure Read
        (From : Registers.Register; Value : out Registers.Word);
      with procedure Write
        (To : Registers.Register; Value : Registers.Word);
   procedure Start (Good : out Boolean);
   --  Start the core.

   -----------
   -- Start --
   -----------

   procedure Start (Good : out Boolean) is
      Id, Buffers : Registers.Word;
      Timing      : Registers.Bit_Timing;
      Found       : Boolean;
   begin
      Read (Registers.Device_Id_Version, Id);
      Write (Registers.Mode_Settings, Registers.Reset);
      Read (Registers.Tx_Status, Buffers);
      Registers.Choose_Timing
        (100_000_000, 500_000, Registers.Quanta_Count'Last, Timing, Found);
      Write (Registers.Btr, Registers.Btr_Of (Timing));
      Good := Registers.Is_Core (Id)
        and then Registers.Has_Buffers (Buffers)
        and then Found;
      Registers.Choose_Timing
        (100_000_000, 2_000_000, Registers.Data_Quanta, Timing, Found);
      Write (Registers.Btr_Fd, Registers.Btr_Of (Timing));
      Write (Registers.Mode_Settings, Registers.Fd_Mode);
      Write (Registers.Tx_Priority, Registers.Priorities (4, 3, 2, 1));
      Good := Good and then Found;
   end Start;

   procedure Start_One is new Start (Near.Read, Near.Write);

   procedure Start_Other is new Start (Far.Read, Far.Write);

   ----------------
   -- Start_Near --
   ----------------

   procedure Start_Near (Good : out Boolean) renames Start_One;

   ---------------
   -- Start_Far --
   ---------------

   procedure Start_Far (Good : out Boolean) renames Start_Other;

   ----------
   -- Come --
   ----------

   procedure Come
     (I : out Ravenchart.Can.Ctu_Frames.Image; Good : out Boolean)
   is
      Limit : constant Ada.Real_Time.Time :=
        Ada.Real_Time.Clock + Ada.Real_Time.Seconds (1);
      State : Registers.Word;
   begin
      I := (others => <>);
      loop
         Far.Read (Registers.Rx_Status_Settings, State);
         Good := Registers.Frames_Waiting (State) > 0;
         exit when Good or else Ada.Real_Time.Clock > Limit;
      end loop;
      if Good then
         Far.Read_Frame (I);
      end if;
   end Come;

end Ctu_Pair;
