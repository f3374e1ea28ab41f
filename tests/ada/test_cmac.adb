--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  AES-CMAC, which the tests of authentication use: the examples of RFC 4493.

with Aes_Cmac;
with Example_Key;
with Facts;
with Ravenchart.Can.Authentication;

procedure Test_Cmac is
   use Ravenchart.Can.Authentication;

   Message : constant Input_Bytes :=
     (16#6B#, 16#C1#, 16#BE#, 16#E2#, 16#2E#, 16#40#, 16#9F#, 16#96#,
      16#E9#, 16#3D#, 16#7E#, 16#11#, 16#73#, 16#93#, 16#17#, 16#2A#,
      16#AE#, 16#2D#, 16#8A#, 16#57#, 16#1E#, 16#03#, 16#AC#, 16#9C#,
      16#9E#, 16#B7#, 16#6F#, 16#AC#, 16#45#, 16#AF#, 16#8E#, 16#51#,
      16#30#, 16#C8#, 16#1C#, 16#46#, 16#A3#, 16#5C#, 16#E4#, 16#11#,
      16#E5#, 16#FB#, 16#C1#, 16#19#, 16#1A#, 16#0A#, 16#52#, 16#EF#,
      16#F6#, 16#9F#, 16#24#, 16#45#, 16#DF#, 16#4F#, 16#9B#, 16#17#,
      16#AD#, 16#2B#, 16#41#, 16#7B#, 16#E6#, 16#6C#, 16#37#, 16#10#,
      others => 0);

   procedure Hold (Length : Natural; Expected : Tag_Bytes);

   procedure Hold (Length : Natural; Expected : Tag_Bytes) is
      Found : constant Mac_Answer :=
        Aes_Cmac.Cmac (Example_Key.Key, (Length, Message));
   begin
      Facts.Check
        ("RFC 4493, a message of" & Natural'Image (Length) & " bytes",
         Found.Is_Known and then Found.Tag = Expected);
   end Hold;
begin
   Hold
     (0,
      (16#BB#, 16#1D#, 16#69#, 16#29#, 16#E9#, 16#59#, 16#37#, 16#28#,
       16#7F#, 16#A3#, 16#7D#, 16#12#, 16#9B#, 16#75#, 16#67#, 16#46#));
   Hold
     (16,
      (16#07#, 16#0A#, 16#16#, 16#B4#, 16#6B#, 16#4D#, 16#41#, 16#44#,
       16#F7#, 16#9B#, 16#DD#, 16#9D#, 16#D0#, 16#4A#, 16#28#, 16#7C#));
   Hold
     (40,
      (16#DF#, 16#A6#, 16#67#, 16#47#, 16#DE#, 16#9A#, 16#E6#, 16#30#,
       16#30#, 16#CA#, 16#32#, 16#61#, 16#14#, 16#97#, 16#C8#, 16#27#));
   Hold
     (64,
      (16#51#, 16#F0#, 16#BE#, 16#BF#, 16#7E#, 16#3B#, 16#9D#, 16#92#,
       16#FC#, 16#49#, 16#74#, 16#17#, 16#79#, 16#36#, 16#3C#, 16#FE#));
   Facts.Finish;
end Test_Cmac;
