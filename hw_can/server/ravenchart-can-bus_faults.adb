--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Bus_Faults
  with SPARK_Mode
is
   use type Bus_Frames.Bus_Frame_Family;

   --------------
   -- As_Heard --
   --------------

   function As_Heard
     (F : Fault; Node : Positive; Frame : Bus_Frames.Bus_Frame)
      return Bus_Frames.Bus_Frame
   is
      Result : Bus_Frames.Bus_Frame := Frame;
   begin
      if Hits (F, Corrupted, Node) then
         if Result.Family = Bus_Frames.Flexible then
            if F.Index < Result.Fd.Length then
               Result.Fd.Bytes (F.Index) :=
                 Result.Fd.Bytes (F.Index) xor F.Mask;
            end if;
         elsif Result.Plain.Kind = Data
           and then F.Index < Result.Plain.Length
         then
            Result.Plain.Bits :=
              Result.Plain.Bits
              xor Interfaces.Shift_Left
                    (Interfaces.Unsigned_64 (F.Mask), 8 * F.Index);
         end if;
      end if;
      return Result;
   end As_Heard;

end Ravenchart.Can.Bus_Faults;
