--  A simulated bus for tests, outside any stack, for its buffers are large.

with Interfaces;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Buses;
with Ravenchart.Can.Line_Events;
with Ravenchart.Can.Networks;

package Simulated is
   use Ravenchart.Can;

   Net      : Networks.Network;
   Result   : Buses.Outcome;
   Receipts : Networks.Receipt_List;

   procedure Start (Nodes : Bus_Nodes.Node_Index);
   --  A new bus with so many nodes.

   procedure Send
     (I     : Bus_Nodes.Node_Index;
      Frame : Bus_Frames.Bus_Frame;
      Tag   : Interfaces.Unsigned_32 := 1);
   --  Node I wants to send.

   procedure Step (Fault : Bus_Faults.Fault := Bus_Faults.No_Fault);
   --  What begins next, into Result and Receipts; silence if nothing does.

   procedure Happen
     (Kind : Line_Events.Event_Kind; Node : Bus_Nodes.Node_Index := 1);
   --  Something happens to the line; who babbles sends identifier 0.

end Simulated;
