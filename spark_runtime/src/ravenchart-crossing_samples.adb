--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Crossing_Boards;

package body Ravenchart.Crossing_Samples
  with SPARK_Mode, Refined_State => (State => (Sent, Seen, Board.State))
is
   type Turn is mod 2**32;
   --  The number of a sample. That of one not taken comes again after 2**32
   --  others.

   type Sample is record
      Item  : Element_Type := Null_Element;
      Given : Turn         := 0;
   end record;

   package Board is new Crossing_Boards
     (Element_Type => Sample,
      Initial      => (others => <>));

   Sent : Turn := 0
   with Atomic, Async_Readers, Async_Writers;
   --  The number of the last sample: of the sender alone.

   Seen : Turn := 0
   with Atomic, Async_Readers, Async_Writers;
   --  The number of the sample taken last: of the receiver alone.

   procedure Put (Item : Element_Type)
   with Refined_Global => (In_Out => (Sent, Board.State))
   is
      Given : Turn;
   begin
      Given := Sent;
      Given := Given + 1;
      Sent  := Given;
      Board.Write ((Item, Given));
   end Put;

   procedure Take (Item : out Element_Type; Status : out Queueing.Take_Status)
   with Refined_Global => (In_Out => (Seen, Board.State))
   is
      Found : Sample;
      Last  : Turn;
   begin
      Board.Read (Found);
      Last := Seen;
      if Found.Given = Last then
         Item   := Null_Element;
         Status := Queueing.Empty;
      else
         Seen   := Found.Given;
         Item   := Found.Item;
         Status := Queueing.Taken;
      end if;
   end Take;

end Ravenchart.Crossing_Samples;
