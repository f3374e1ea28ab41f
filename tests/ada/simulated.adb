--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Transmit_Buffers;

package body Simulated is

   use type Bus_Nodes.Node_Index;

   Clean : Networks.Network;

   -----------
   -- Start --
   -----------

   procedure Start (Nodes : Bus_Nodes.Node_Index) is
   begin
      Net.Bus     := Clean.Bus;
      Net.Babble  := Clean.Babble;
      Net.Cut_At  := Clean.Cut_At;
      for I in Bus_Nodes.Node_Index loop
         Transmit_Buffers.Reset
           (Net.Buffers (I), Transmit_Buffers.Order (Clean.Buffers (I)));
         if I <= Nodes then
            Line_Events.Join (Net, I);
         end if;
      end loop;
   end Start;

   ----------
   -- Send --
   ----------

   procedure Send
     (I     : Bus_Nodes.Node_Index;
      Frame : Bus_Frames.Bus_Frame;
      Tag   : Interfaces.Unsigned_32 := 1)
   is
      Status : Send_Status;
   begin
      Networks.Submit
        (Net, I, (Frame => Frame, Tag => Tag, Since => 0), Status);
      pragma Assert (Status = Queued);
   end Send;

   ----------
   -- Step --
   ----------

   procedure Step (Fault : Bus_Faults.Fault := Bus_Faults.No_Fault) is
      Moment : constant Networks.Moment := Networks.Next (Net);
   begin
      Result := (others => <>);
      if Moment.Known then
         Networks.Step (Net, Moment, Fault, Result, Receipts);
      end if;
   end Step;

   ------------
   -- Happen --
   ------------

   procedure Happen
     (Kind : Line_Events.Event_Kind; Node : Bus_Nodes.Node_Index := 1) is
   begin
      Line_Events.Apply
        (Net,
         (Kind => Kind, Start => 0, Node => Node, Frame => <>));
   end Happen;

end Simulated;
