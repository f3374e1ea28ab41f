--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated bus for tests, outside any stack, for its buffers are large.

with Interfaces;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Buses;
with Ravenchart.Can.Fault_Confinement;
with Ravenchart.Can.Line_Events;
with Ravenchart.Can.Networks;

package Simulated is
   use Ravenchart.Can;

   Bit : constant Ravenchart.Nanoseconds := 2_000;
   --  The bit time in ns at 500 kbit/s.

   Net      : Networks.Network;
   Result   : Buses.Outcome;
   Receipts : Networks.Receipt_List;

   procedure Start (Nodes : Bus_Nodes.Node_Index);
   --  Begin a new bus with so many nodes.

   procedure Send
     (I     : Bus_Nodes.Node_Index;
      Frame : Bus_Frames.Bus_Frame;
      Tag   : Interfaces.Unsigned_32 := 1);
   --  Request of node I to send a frame.

   procedure Step (Fault : Bus_Faults.Fault := Bus_Faults.No_Fault);
   --  Carry out the next event on the bus, into Result and Receipts; Silence
   --  if there is none.

   procedure Happen
     (Kind : Line_Events.Event_Kind; Node : Bus_Nodes.Node_Index := 1);
   --  Apply an event to the line; a node that babbles sends identifier 0.

   function Plain
     (Id : Identifier; Data : Interfaces.Unsigned_64 := 0)
      return Bus_Frames.Bus_Frame
   is (Family => Bus_Frames.Classic,
       Plain  => Data_Frame (Id, Ravenchart.Can.Standard, 8, Data));
   --  A classic frame of eight bytes.

   function Transmit_Errors (I : Bus_Nodes.Node_Index) return Error_Count
   is (Fault_Confinement.Transmit_Errors (Net.Bus.Nodes (I).Confinement));

   function Receive_Errors (I : Bus_Nodes.Node_Index) return Error_Count
   is (Fault_Confinement.Receive_Errors (Net.Bus.Nodes (I).Confinement));

   function State (I : Bus_Nodes.Node_Index) return Controller_State
   is (Fault_Confinement.State (Net.Bus.Nodes (I).Confinement));

end Simulated;
