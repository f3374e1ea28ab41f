--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Ctu_Hosts;

package body Ravenchart.Can.Ctu_Cores
  with SPARK_Mode, Refined_State => (Registers => Words)
is
   type Cell is mod 2**32
   with Size => 32, Volatile_Full_Access;

   type Cells is array (Ctu_Registers.Register) of Cell;

   Words : Cells
   with Volatile, Alignment => Ctu_Hosts.Window_Bytes;
   --  A page of its own, which the core replaces.

   ----------
   -- Open --
   ----------

   procedure Open (Opened : out Boolean)
   with SPARK_Mode => Off
   --  ASM-013. The page is handed over by its address.
   is
   begin
      Ctu_Hosts.Map (Words'Address, Behind, Opened);
   end Open;

   ----------
   -- Read --
   ----------

   procedure Read
     (From : Ctu_Registers.Register; Value : out Ctu_Registers.Word) is
   begin
      Value := Ctu_Registers.Word (Words (From));
   end Read;

   -----------
   -- Write --
   -----------

   procedure Write
     (To : Ctu_Registers.Register; Value : Ctu_Registers.Word) is
   begin
      Words (To) := Cell (Value);
   end Write;

   ----------------
   -- Read_Frame --
   ----------------

   procedure Read_Frame (I : out Ctu_Frames.Image) is
      Value : Ctu_Registers.Word;
   begin
      I := (others => <>);
      Read (Ctu_Registers.Rx_Data, I.Layout);
      for Index in 1 .. Ctu_Frames.Words (I.Layout) - 1 loop
         Read (Ctu_Registers.Rx_Data, Value);
         case Index is
            when 1 =>
               I.Identity := Value;
            when 2 =>
               I.Stamp_Low := Value;
            when 3 =>
               I.Stamp_High := Value;
            when 4 .. 19 =>
               I.Data (Index - 4) := Value;
            when others =>
               null;  --  no frame is so long
         end case;
      end loop;
   end Read_Frame;

   -----------------
   -- Write_Frame --
   -----------------

   procedure Write_Frame
     (Into : Ctu_Registers.Buffer; I : Ctu_Frames.Image)
   is
      Count : constant Ctu_Frames.Word_Count := Ctu_Frames.Words (I.Layout);
   begin
      Write (Ctu_Registers.Word_Of (Into, 0), I.Layout);
      Write (Ctu_Registers.Word_Of (Into, 1), I.Identity);
      Write (Ctu_Registers.Word_Of (Into, 2), I.Stamp_Low);
      Write (Ctu_Registers.Word_Of (Into, 3), I.Stamp_High);
      for Index in Ctu_Frames.Data_Word loop
         exit when Index + 4 >= Count;
         Write
           (Ctu_Registers.Word_Of
              (Into, Ctu_Registers.Frame_Word (Index + 4)),
            I.Data (Index));
      end loop;
   end Write_Frame;

end Ravenchart.Can.Ctu_Cores;
