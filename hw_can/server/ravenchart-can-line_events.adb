--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Line_Events
  with SPARK_Mode
is

   Upper : constant Node_Index := 2;
   --  The segment of the nodes above a cut; the others are on segment 1.

   procedure Divide (N : in out Networks.Network)
   with
     Global => null,
     Post   =>
       (for all S in Node_Index =>
          N.Bus.Free_At (S) >= N.Bus.Free_At'Old (S));
   --  Both segments continue from the later time of the two.

   ------------
   -- Divide --
   ------------

   procedure Divide (N : in out Networks.Network) is
      Later : constant Nanoseconds :=
        (if N.Bus.Free_At (1) < N.Bus.Free_At (Upper)
         then N.Bus.Free_At (Upper) else N.Bus.Free_At (1));
   begin
      N.Bus.Free_At (1) := Later;
      N.Bus.Free_At (Upper) := Later;
      N.Bus.Called := (others => False);
      for I in Node_Index loop
         N.Bus.Nodes (I).Segment :=
           (if Natural (I) >= N.Cut_At then Upper else 1);
      end loop;
   end Divide;

   -----------
   -- Apply --
   -----------

   procedure Apply (N : in out Networks.Network; E : Event) is
   begin
      case E.Kind is
         when Cut            =>
            N.Cut_At := Networks.Place_Of_Cut (E.Node);
            Divide (N);
         when Mend           =>
            N.Cut_At := Networks.Nowhere;
            Divide (N);
         when Hold_Dominant  =>
            N.Bus.Line := Buses.Held_Dominant;
         when Hold_Recessive =>
            N.Bus.Line := Buses.Held_Recessive;
         when Let_Go         =>
            N.Bus.Line := Buses.Sound;
         when Babble         =>
            N.Babble (E.Node) := (Frame => E.Frame, Present => True);
         when Hush           =>
            N.Babble (E.Node).Present := False;
      end case;
   end Apply;

   ----------
   -- Join --
   ----------

   procedure Join (N : in out Networks.Network; I : Node_Index) is
   begin
      Networks.Withdraw (N, I);
      N.Bus.Nodes (I) :=
        (Here    => Present,
         Segment => (if Natural (I) >= N.Cut_At then Upper else 1),
         others  => <>);
   end Join;

   -----------
   -- Leave --
   -----------

   procedure Leave (N : in out Networks.Network; I : Node_Index) is
   begin
      Networks.Withdraw (N, I);
      N.Bus.Nodes (I).Here := Absent;
      N.Babble (I).Present := False;
   end Leave;

end Ravenchart.Can.Line_Events;
