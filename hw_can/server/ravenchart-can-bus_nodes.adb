--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Levels;

package body Ravenchart.Can.Bus_Nodes
  with SPARK_Mode
is

   -----------
   -- Count --
   -----------

   procedure Count
     (N : in out Bus_Node; Event : Fault_Confinement.Fault_Event) is
   begin
      Fault_Confinement.Count (N.Confinement, Event);
      if Fault_Confinement.State (N.Confinement) = Bus_Off then
         N.Way_Back := Waits;
      end if;
   end Count;

   ----------------------
   -- Request_Recovery --
   ----------------------

   procedure Request_Recovery (N : in out Bus_Node; Start : Nanoseconds) is
   begin
      if N.Here = Present
        and then Fault_Confinement.State (N.Confinement) = Bus_Off
        and then (N.Way_Back = Waits or else N.Ready_At > Start)
      then
         N.Way_Back := Recovers;
         N.Ready_At := Start;
      end if;
   end Request_Recovery;

   ----------
   -- Rest --
   ----------

   procedure Rest (N : in out Bus_Node; Bits : Nanoseconds) is
      Start : constant Bus_Node := N
      with Ghost;
   begin
      for I in 1 .. Fault_Confinement.Whole_Recovery loop
         exit when not Comes_Back (N) or else Nanoseconds (I) > Bits;
         Fault_Confinement.Monitor (N.Confinement, Levels.Recessive);
         pragma Loop_Invariant (Is_Same_But_Counts (N, Start));
         pragma Loop_Invariant (Comes_Back (Start));
      end loop;
   end Rest;

   ---------------
   -- Interrupt --
   ---------------

   procedure Interrupt (N : in out Bus_Node) is
   begin
      if Comes_Back (N) then
         Fault_Confinement.Monitor (N.Confinement, Levels.Dominant);
      end if;
   end Interrupt;

end Ravenchart.Can.Bus_Nodes;
