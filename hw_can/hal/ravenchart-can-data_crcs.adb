package body Ravenchart.Can.Data_Crcs
  with SPARK_Mode
is
   ---------
   -- Run --
   ---------

   function Run
     (Kind  : Crc_Kind;
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

end Ravenchart.Can.Data_Crcs;
