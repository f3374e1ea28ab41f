--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Any_Frames
  with SPARK_Mode
is

   -----------
   -- Bytes --
   -----------

   function Bytes (F : Any_Frame) return Fd_Frames.Fd_Bytes is
      Result : Fd_Frames.Fd_Bytes := (others => 0);
   begin
      for I in Result'Range loop
         Result (I) := Byte (F, I);
         pragma Loop_Invariant
           (for all J in 0 .. I => Result (J) = Byte (F, J));
      end loop;
      return Result;
   end Bytes;

end Ravenchart.Can.Any_Frames;
