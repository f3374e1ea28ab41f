--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Remote_Reads
  with SPARK_Mode, Refined_State => (State => Copy)
is
   protected Copy
     with Priority => Ceiling
   is
      procedure Put (Item : Element_Type);

      procedure Tick (Status : out Calls.Wait_Status);

      function Value return Element_Type;

   private
      Last : Element_Type    := Initial;
      Left : Execution_Count := Limit;
   end Copy;

   protected body Copy is

      procedure Put (Item : Element_Type) is
      begin
         Last := Item;
         Left := Limit;
      end Put;

      procedure Tick (Status : out Calls.Wait_Status) is
      begin
         Calls.Count_Down (Left, Status);
      end Tick;

      function Value return Element_Type
      is (Last);

   end Copy;

   procedure Put (Item : Element_Type)
   with Refined_Global => (In_Out => Copy)
   is
   begin
      Copy.Put (Item);
   end Put;

   procedure Tick (Status : out Calls.Wait_Status)
   with Refined_Global => (In_Out => Copy)
   is
   begin
      Copy.Tick (Status);
   end Tick;

   procedure Read (Item : out Element_Type)
   with Refined_Global => Copy
   is
   begin
      Item := Copy.Value;
   end Read;

end Ravenchart.Remote_Reads;
