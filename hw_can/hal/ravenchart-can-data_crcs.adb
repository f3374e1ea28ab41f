--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Data_Crcs
  with SPARK_Mode
is
   -----------------
   -- After_Bytes --
   -----------------

   function After_Bytes
     (Kind  : Data_Crc_Kind;
      R     : Register;
      Data  : Fd_Frames.Fd_Bytes;
      First : Fd_Frames.Fd_Index;
      Past  : Natural) return Register
   is (if Past <= First
       then R
       else
         After_Byte
           (Kind,
            After_Bytes (Kind, R, Data, First, Past - 1),
            Data (Past - 1)));

   ---------
   -- Run --
   ---------

   function Run
     (Kind  : Data_Crc_Kind;
      R     : Register;
      Data  : Fd_Frames.Fd_Bytes;
      First : Fd_Frames.Fd_Index;
      Past  : Natural) return Register
   is
      Result : Register := R;
   begin
      pragma Assert (After_Bytes (Kind, R, Data, First, First) = R);
      for I in First .. Past - 1 loop
         Result := After_Byte (Kind, Result, Data (I));
         pragma Loop_Invariant
           (Result = After_Bytes (Kind, R, Data, First, I + 1));
      end loop;
      return Result;
   end Run;

   -------------------------
   -- Lemma_Same_Register --
   -------------------------

   procedure Lemma_Same_Register
     (Kind  : Data_Crc_Kind;
      R     : Register;
      A, B  : Fd_Frames.Fd_Bytes;
      First : Fd_Frames.Fd_Index;
      Past  : Natural)
   is
   begin
      pragma Assert
        (After_Bytes (Kind, R, A, First, First) = R
         and then After_Bytes (Kind, R, B, First, First) = R);
      for I in First .. Past - 1 loop
         pragma Loop_Invariant
           (After_Bytes (Kind, R, A, First, I + 1)
            = After_Bytes (Kind, R, B, First, I + 1));
      end loop;
   end Lemma_Same_Register;

end Ravenchart.Can.Data_Crcs;
