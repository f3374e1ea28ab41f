--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ctu_Model;

package body Ravenchart.Can.Ctu_Cores
  with SPARK_Mode => Off
is
   pragma Assert (Behind = 0);

   procedure Open (Opened : out Boolean) is
   begin
      Opened := True;
   end Open;

   procedure Read
     (From : Ctu_Registers.Register; Value : out Ctu_Registers.Word) is
   begin
      Ctu_Model.Core.Read (From, Value);
   end Read;

   procedure Write
     (To : Ctu_Registers.Register; Value : Ctu_Registers.Word) is
   begin
      Ctu_Model.Core.Write (To, Value);
   end Write;

   procedure Read_Frame (I : out Ctu_Frames.Image) is
   begin
      I := (others => <>);
   end Read_Frame;

   procedure Write_Frame
     (Into : Ctu_Registers.Buffer; I : Ctu_Frames.Image) is
   begin
      Ctu_Model.Core.Put (Into, I);
   end Write_Frame;

end Ravenchart.Can.Ctu_Cores;
