--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces.C;
with System;

package body Aes_Cmac
  with SPARK_Mode => Off  --  calls the C library
is
   use Interfaces;
   use type System.Address;

   pragma Linker_Options ("-l:libcrypto.so.3");

   function Quick_Mac
     (Context, Name, Query, Cipher, Parameters : System.Address;
      Key                                      : Tag_Bytes;
      Key_Length                               : C.size_t;
      Data                                     : Input_Bytes;
      Data_Length                              : C.size_t;
      Result                                   : in out Tag_Bytes;
      Room                                     : C.size_t;
      Written                                  : in out C.size_t)
      return System.Address
   with Import, Convention => C, External_Name => "EVP_Q_mac";

   Name   : aliased constant C.char_array (0 .. 4) :=
     ('C', 'M', 'A', 'C', C.nul);
   Cipher : aliased constant C.char_array (0 .. 11) :=
     ('A', 'E', 'S', '-', '1', '2', '8', '-', 'C', 'B', 'C', C.nul);

   ----------
   -- Cmac --
   ----------

   function Cmac (Key : Tag_Bytes; Item : Mac_Input) return Mac_Answer is
      Result  : Mac_Answer;
      Written : C.size_t := 0;
      Found   : constant System.Address :=
        Quick_Mac
          (System.Null_Address,
           Name'Address,
           System.Null_Address,
           Cipher'Address,
           System.Null_Address,
           Key,
           Key'Length,
           Item.Bytes,
           C.size_t (Item.Length),
           Result.Tag,
           Result.Tag'Length,
           Written);
      use type C.size_t;
   begin
      Result.Is_Known :=
        Found /= System.Null_Address and then Written = Result.Tag'Length;
      return Result;
   end Cmac;

end Aes_Cmac;
