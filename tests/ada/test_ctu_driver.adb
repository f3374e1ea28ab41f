--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Frames between the driver "ctucanfd", on the core that the environment
--  names, and the core behind it, which the test accesses by its registers.
--  CAN FD and classic frames, of every length, both ways.

with Ada.Real_Time;
with Ctu_Pair;
with Facts;
with Interfaces;
with Nodes;
with Ravenchart;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Ctu_Frames;
with Ravenchart.Can.Ctu_Registers;
with Ravenchart.Can.Fd_Frames;

procedure Test_Ctu_Driver is
   use Ravenchart.Can;
   use Ravenchart.Can.Fd_Frames;
   use type Ada.Real_Time.Time;
   use type Any_Frames.Any_Frame;

   package Registers renames Ravenchart.Can.Ctu_Registers;

   Bits : constant Interfaces.Unsigned_64 := 16#8877_6655_4433_2211#;

   procedure Check_Crossing (F : Any_Frames.Any_Frame);
   --  From the driver to the other core, and back.

   There, Back, Total : Natural := 0;

   --------------------
   -- Check_Crossing --
   --------------------

   procedure Check_Crossing (F : Any_Frames.Any_Frame) is
      Status : Send_Status;
      I      : Ctu_Frames.Image;
      Good   : Boolean;
      Got    : Any_Frames.Any_Frame;
      Stamp  : Ravenchart.Nanoseconds;
   begin
      Total := Total + 1;
      Nodes.Node.Send (F, Status);
      Ctu_Pair.Come (I, Good);
      if Status = Queued
        and then Good
        and then Ctu_Frames.Any_Frame_Of (I) = F
      then
         There := There + 1;
      end if;
      Ctu_Pair.Far.Write_Frame (1, Ctu_Frames.Image_Of (F));
      Ctu_Pair.Far.Write (Registers.Tx_Command, Registers.Set_Ready (1));
      Nodes.Node.Wait_Frame (Got, Stamp);
      if Got = F then
         Back := Back + 1;
      end if;
   end Check_Crossing;

   Limit : constant Ada.Real_Time.Time :=
     Ada.Real_Time.Clock + Ada.Real_Time.Seconds (5);
   Good  : Boolean;
   State : Controller_State;
begin
   Ctu_Pair.Far.Open (Good);
   Facts.Check ("there are registers", Good);
   Ctu_Pair.Start_Far (Good);
   Facts.Check ("there is a core", Good);
   loop
      Nodes.Node.Read_State (State);
      exit when State = Error_Active or else Ada.Real_Time.Clock > Limit;
      delay until Ada.Real_Time.Clock + Ada.Real_Time.Milliseconds (1);
   end loop;
   Facts.Check ("the driver is error-active", State = Error_Active);
   for Format in Frame_Format loop
      for Code in Length_Code loop
         for Rate in Bit_Rate_Use loop
            Check_Crossing
              (Any_Frames.To_Any
                 (Fd_Data_Frame
                    (16#7F0#, Format, Length_Of (Code),
                     Words => (others => Bits), Rate => Rate)));
         end loop;
      end loop;
      for Length in Data_Length loop
         Check_Crossing
           (Any_Frames.To_Any (Data_Frame (16#123#, Format, Length, Bits)));
      end loop;
   end loop;
   Facts.Check
     ("frames of both families go out:" & There'Image & " of"
      & Total'Image, There = Total and then Total = 82);
   Facts.Check
     ("and come in:" & Back'Image & " of" & Total'Image, Back = Total);
   Facts.Finish;
end Test_Ctu_Driver;
