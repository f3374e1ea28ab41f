--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Events of the line of a network at given times.
--
--  Guarantees   time continues where the bus is cut or mended
--  Tasking      none: one owner for each Network
--  Timing       linear in the nodes

with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Buses;
with Ravenchart.Can.Networks;

package Ravenchart.Can.Line_Events
  with SPARK_Mode, Pure
is
   use Bus_Nodes;
   use type Buses.Free_Times;

   type Event_Kind is
     (Cut, Mend, Hold_Dominant, Hold_Recessive, Let_Go, Babble, Hush);
   --  Cut: Node and the nodes above it are cut off from those below, until
   --  Mend. Hold: the line is shorted, until Let_Go. Babble: Node sends Frame
   --  again and again in place of its own frames, until Hush. The command
   --  line of the bus server has these names.

   type Event is record
      Kind  : Event_Kind := Mend;
      Start : Nanoseconds := 0;
      Node  : Node_Index := 1;
      Frame : Bus_Frames.Bus_Frame;
   end record;

   procedure Apply (N : in out Networks.Network; E : Event)
   with
     Global => null,
     Post   =>
       (for all S in Node_Index =>
          N.Bus.Free_At (S) >= N.Bus.Free_At'Old (S));
   --  Apply the event now.

   procedure Join (N : in out Networks.Network; I : Node_Index)
   with
     Global => null,
     Post   =>
       Takes_Part (N.Bus.Nodes (I))
       and then Networks.Waiting (N, I) = 0
       and then N.Bus.Free_At = N.Bus.Free_At'Old;
   --  A new controller, error-active, with nothing to send.

   procedure Leave (N : in out Networks.Network; I : Node_Index)
   with
     Global => null,
     Post   =>
       not Takes_Part (N.Bus.Nodes (I))
       and then Networks.Waiting (N, I) = 0
       and then N.Bus.Free_At = N.Bus.Free_At'Old;
   --  The frames that the node had still to send are removed with it.

end Ravenchart.Can.Line_Events;
