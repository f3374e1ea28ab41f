--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Blackboards
  with SPARK_Mode, Refined_State => (State => Board)
is
   protected Board
     with Priority => Ceiling
   is
      procedure Write (Item : Element_Type);

      function Value return Element_Type;

   private
      Last : Element_Type := Initial;
   end Board;

   protected body Board is

      procedure Write (Item : Element_Type) is
      begin
         Last := Item;
      end Write;

      function Value return Element_Type
      is (Last);

   end Board;

   procedure Write (Item : Element_Type)
   with Refined_Global => (In_Out => Board)
   is
   begin
      Board.Write (Item);
   end Write;

   procedure Read (Item : out Element_Type)
   with Refined_Global => Board
   is
   begin
      Item := Board.Value;
   end Read;

end Ravenchart.Blackboards;
