--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Crossing_Boards;
with Ravenchart.Histories;
with Ravenchart.Logical_Times;

package body Ravenchart.Logical_Samples
  with
    SPARK_Mode,
    Refined_State => (Kept => Sent, Seen => Next, State => Board.State)
is
   package Values is new Histories
     (Element_Type => Element_Type,
      Null_Element => Null_Element,
      Depth        => Depth);

   package Board is new Crossing_Boards
     (Element_Type => Values.History,
      Initial      => (others => <>));

   Sent : Values.History;
   --  The last values: of the sender alone.

   Next : Nanoseconds := 0;
   --  Values that become visible before it were taken, or left out: of the
   --  receiver alone.

   procedure Put (Item : Element_Type; Visible : Nanoseconds)
   with Refined_Global => (In_Out => (Sent, Board.State))
   is
   begin
      Values.Put (Sent, Item, Visible);
      Board.Write (Sent);
   end Put;

   procedure Take
     (Now    : Nanoseconds;
      Item   : out Element_Type;
      Status : out Queueing.Take_Status)
   with Refined_Global => (In_Out => (Next, Board.State))
   is
      Found : Values.History;
      Here  : Values.Place_Count;
   begin
      Board.Read (Found);
      Here := Values.Newest (Found, Now);
      if Here = 0 or else Found.Last (Here).Visible < Next then
         Item   := Null_Element;
         Status := Queueing.Empty;
      else
         Next   := Logical_Times.Later (Found.Last (Here).Visible, 1);
         Item   := Found.Last (Here).Item;
         Status := Queueing.Taken;
      end if;
   end Take;

end Ravenchart.Logical_Samples;
