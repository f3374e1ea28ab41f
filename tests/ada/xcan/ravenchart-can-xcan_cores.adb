--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Xcan_Model;

package body Ravenchart.Can.Xcan_Cores
  with SPARK_Mode => Off
is
   use type Interfaces.Unsigned_32;

   Is_Can_0 : constant Boolean := Base = 16#FF06_0000#;
   --  At other addresses there is no controller.

   procedure Read
     (From : Xcan_Registers.Register; Value : out Xcan_Registers.Word) is
   begin
      if Is_Can_0 then
         Xcan_Model.Controller.Read (From, Value);
      else
         Value := Xcan_Registers.Word'Last;
      end if;
   end Read;

   procedure Write
     (To : Xcan_Registers.Register; Value : Xcan_Registers.Word) is
   begin
      Xcan_Model.Controller.Write (To, Value);
   end Write;

   procedure Read_Frame (I : out Xcan_Frames.Image) is
   begin
      Xcan_Model.Controller.Take (I);
   end Read_Frame;

   procedure Write_Frame (I : Xcan_Frames.Image) is
   begin
      Xcan_Model.Controller.Put (I);
   end Write_Frame;

   procedure Configure (Clock, Rate : Xcan_Registers.Hertz; Done : out Boolean)
   is
      pragma Unreferenced (Clock, Rate);
   begin
      Write (Xcan_Registers.Srr, Xcan_Registers.Reset);
      Write (Xcan_Registers.Srr, Xcan_Registers.Enable);
      Done := True;
   end Configure;

end Ravenchart.Can.Xcan_Cores;
