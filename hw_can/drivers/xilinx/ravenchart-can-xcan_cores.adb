--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with System.Storage_Elements;

package body Ravenchart.Can.Xcan_Cores
  with SPARK_Mode, Refined_State => (Registers => Words)
is
   pragma Warnings
     (GNATprove, Off, "writing to * is assumed to have no effects on other*",
      Reason => "ASM-022, the words are those of the controller alone");
   pragma Warnings
     (GNATprove, Off, "address specification on * is imprecisely supported*",
      Reason => "ASM-022, each word is read and written whole");

   use type Xcan_Registers.Register;

   type Cell is mod 2**32
   with Size => 32, Volatile_Full_Access;

   type Cells is array (Xcan_Registers.Register) of Cell
   with Object_Size => 32 * 32;

   Words : Cells
   with
     Import,
     Volatile,
     Address => System.Storage_Elements.To_Address
       (System.Storage_Elements.Integer_Address (Base));

   ----------
   -- Read --
   ----------

   procedure Read
     (From : Xcan_Registers.Register; Value : out Xcan_Registers.Word) is
   begin
      Value := Xcan_Registers.Word (Words (From));
   end Read;

   -----------
   -- Write --
   -----------

   procedure Write
     (To : Xcan_Registers.Register; Value : Xcan_Registers.Word) is
   begin
      Words (To) := Cell (Value);
   end Write;

   ----------------
   -- Read_Frame --
   ----------------

   procedure Read_Frame (I : out Xcan_Frames.Image) is
   begin
      --  The read of the last word removes the frame.
      Read (Xcan_Registers.Rx_Fifo, I.Identity);
      Read (Xcan_Registers.Rx_Fifo + 1, I.Layout);
      Read (Xcan_Registers.Rx_Fifo + 2, I.Data_Low);
      Read (Xcan_Registers.Rx_Fifo + 3, I.Data_High);
   end Read_Frame;

   -----------------
   -- Write_Frame --
   -----------------

   procedure Write_Frame (I : Xcan_Frames.Image) is
   begin
      --  The write of the last word adds the frame.
      Write (Xcan_Registers.Tx_Fifo, I.Identity);
      Write (Xcan_Registers.Tx_Fifo + 1, I.Layout);
      Write (Xcan_Registers.Tx_Fifo + 2, I.Data_Low);
      Write (Xcan_Registers.Tx_Fifo + 3, I.Data_High);
   end Write_Frame;

   ---------------
   -- Configure --
   ---------------

   procedure Configure (Clock, Rate : Xcan_Registers.Hertz; Done : out Boolean)
   is
      Timing : Xcan_Registers.Bit_Timing;
   begin
      Write (Xcan_Registers.Srr, Xcan_Registers.Reset);
      Xcan_Registers.Choose_Timing (Clock, Rate, Timing, Done);
      if Done then
         Write (Xcan_Registers.Brpr, Xcan_Registers.Brpr_Of (Timing));
         Write (Xcan_Registers.Btr, Xcan_Registers.Btr_Of (Timing));
         Write (Xcan_Registers.Msr, 0);
         Write (Xcan_Registers.Afr, 0);
         Write (Xcan_Registers.Icr, Xcan_Registers.All_Causes);
         Write (Xcan_Registers.Srr, Xcan_Registers.Enable);
      end if;
   end Configure;

end Ravenchart.Can.Xcan_Cores;
