--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The CRCs of end-to-end protection: the check values that are published
--  with them (AUTOSAR CP SWS_CRCLibrary).

with Facts;
with Interfaces;
with Ravenchart.Can.Data_Crcs;
with Ravenchart.Can.Fd_Frames;

procedure Test_Data_Crcs is
   use Interfaces;
   use Ravenchart.Can;
   use Ravenchart.Can.Data_Crcs;

   Digits_1_To_9 : constant Fd_Frames.Fd_Bytes :=
     (16#31#, 16#32#, 16#33#, 16#34#, 16#35#, 16#36#, 16#37#, 16#38#,
      16#39#, others => 0);
   Sample        : constant Fd_Frames.Fd_Bytes :=
     (16#33#, 16#22#, 16#55#, 16#AA#, 16#BB#, 16#CC#, 16#DD#, 16#EE#,
      16#FF#, others => 0);
   Ones          : constant Fd_Frames.Fd_Bytes := (others => 16#FF#);

   function Eight
     (Kind : Data_Crc_Kind; Item : Fd_Frames.Fd_Bytes; Past : Natural)
      return Register
   is (Shift_Right (Run (Kind, 16#FF00#, Item, 0, Past), 8) xor 16#FF#);

   function Sixteen
     (Item : Fd_Frames.Fd_Bytes; Past : Natural) return Register
   is (Run (Crc_16_Ccitt, 16#FFFF#, Item, 0, Past));
begin
   Facts.Check
     ("CRC-8 SAE J1850 of 123456789",
      Eight (Crc_8_J1850, Digits_1_To_9, 9) = 16#4B#);
   Facts.Check
     ("CRC-8 SAE J1850 of the published samples",
      Eight (Crc_8_J1850, Sample, 9) = 16#CB#
      and then Eight (Crc_8_J1850, Ones, 4) = 16#74#
      and then Eight (Crc_8_J1850, (others => 0), 4) = 16#59#);
   Facts.Check
     ("CRC-8H2F of 123456789",
      Eight (Crc_8_H2f, Digits_1_To_9, 9) = 16#DF#);
   Facts.Check
     ("CRC-8H2F of the published samples",
      Eight (Crc_8_H2f, Sample, 9) = 16#11#
      and then Eight (Crc_8_H2f, Ones, 4) = 16#6C#
      and then Eight (Crc_8_H2f, (others => 0), 4) = 16#12#);
   Facts.Check
     ("CRC-16 CCITT of 123456789", Sixteen (Digits_1_To_9, 9) = 16#29B1#);
   Facts.Check
     ("CRC-16 CCITT of the published samples",
      Sixteen (Sample, 9) = 16#F53F#
      and then Sixteen (Ones, 4) = 16#1D0F#
      and then Sixteen ((others => 0), 4) = 16#84C0#);
   Facts.Finish;
end Test_Data_Crcs;
