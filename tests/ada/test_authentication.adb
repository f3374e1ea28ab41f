--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Authentication: the layout of a frame, and attacks between sender and
--  receiver.
--
--  The first argument is the number of attacks of each kind, 10 by default.
--  With "print" as the argument: sealed frames of every setting, a line each,
--  for a comparison with another implementation.

with Ada.Text_IO;
with Aes_Cmac;
with Example_Key;
with Facts;
with Hex_Frames;
with Interfaces;
with Random_Numbers;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Authentication;
with Ravenchart.Can.Fd_Frames;
with Trials;

procedure Test_Authentication is
   use Example_Key;
   use Interfaces;
   use Random_Numbers;
   use Ravenchart.Can.Any_Frames;
   use Ravenchart.Can.Authentication;
   use Ravenchart.Can.Fd_Frames;

   Base : constant Ravenchart.Can.Frame_Format := Ravenchart.Can.Standard;

   Settings : constant array (Positive range <>) of Setting :=
     ((16#0123#, 8, 1, 3),
      (16#FEDC#, 12, 2, 4),
      (16#0001#, 24, 8, 8),
      (16#8000#, 64, 4, 16),
      (16#1234#, 64, 8, 16));

   type Attack is
     (Altered, Cut, Repeated, Replayed, Late, Forged, Other_Key,
      Other_Message, Set_Back, Lost);
   --  Altered: one to three bits. Cut: a shorter or longer frame. Repeated: at
   --  once; Replayed: any of the last 40; Late: behind up to ten others.
   --  Forged: all bytes are random, except perhaps the next freshness value.
   --  Other_Key, Other_Message: sealed with the next value, but another key or
   --  data identifier. Set_Back: sealed with the right key and an older value,
   --  as by a sender that has lost its value. Lost: up to 200 frames.

   function Blank (S : Setting; Number : Natural) return Any_Frame
   is (To_Any
         (Fd_Data_Frame
            (16#100#, Base, S.Length,
             Fd_Words'(0 => Unsigned_64 (Number), others => 0),
             Constant_Rate)));
   --  A frame before it is sealed: its data hold its number.

   function Sealed
     (S      : Setting;
      Number : Natural;
      Value  : Freshness_Value;
      Secret : Tag_Bytes := Key) return Any_Frame;
   --  A frame with that freshness value and its MAC.

   procedure Receive
     (State  : in out Freshness_State;
      S      : Setting;
      F      : Any_Frame;
      Result : out Status);
   --  Receive a frame as generated code does.

   procedure Flip (F : in out Any_Frame; Bit : Natural);
   --  Invert a bit of the data.

   function Image (S : Setting) return String
   is (Natural'Image (S.Length) & Natural'Image (S.Freshness_Bytes)
       & Natural'Image (S.Mac_Bytes));

   procedure Check_Layout;
   --  The position of each part.

   procedure Check_Freshness;
   --  The freshness value of a frame, from its low bytes.

   procedure Check_Statuses;
   --  The condition of each status.

   procedure Check_Attacks (S : Setting; Kind : Attack; Times : Positive);
   --  Attacks of one kind, with good frames between them.

   procedure Print;

   ------------
   -- Sealed --
   ------------

   function Sealed
     (S      : Setting;
      Number : Natural;
      Value  : Freshness_Value;
      Secret : Tag_Bytes := Key) return Any_Frame
   is
      Result : Any_Frame := Blank (S, Number);
   begin
      Seal
        (Result, S, Value,
         Aes_Cmac.Cmac (Secret, Input_Of (Result, S, Value)));
      return Result;
   end Sealed;

   -------------
   -- Receive --
   -------------

   procedure Receive
     (State  : in out Freshness_State;
      S      : Setting;
      F      : Any_Frame;
      Result : out Status)
   is
      Value : Freshness_Value;
   begin
      Begin_After (State, 0);
      Reconstruct (State, S, F, Value, Result);
      if Result = Unverified then
         Verify
           (State, S, F, Value,
            Aes_Cmac.Cmac (Key, Input_Of (F, S, Value)), Result);
      end if;
   end Receive;

   ----------
   -- Flip --
   ----------

   procedure Flip (F : in out Any_Frame; Bit : Natural) is
   begin
      F.Fd.Bytes (Bit / 8) :=
        F.Fd.Bytes (Bit / 8) xor Shift_Left (1, Bit mod 8);
   end Flip;

   ------------------
   -- Check_Layout --
   ------------------

   procedure Check_Layout is
      S     : constant Setting := (16#A1B2#, 12, 2, 4);
      Frame : Any_Frame := Blank (S, 16#332211#);
      Value : constant Freshness_Value := 16#0102_0304_0506_0708#;
      Input : constant Mac_Input := Input_Of (Frame, S, Value);
      Tag   : Tag_Bytes := (others => 0);
   begin
      Facts.Check
        ("the MAC is of data identifier, data and whole freshness value",
         Input.Length = 16
         and then
           Input.Bytes (0 .. 15)
           = (16#A1#, 16#B2#, 16#11#, 16#22#, 16#33#, 0, 0, 0,
              1, 2, 3, 4, 5, 6, 7, 8));
      for I in Tag'Range loop
         Tag (I) := Unsigned_8 (16#C0# + I);
      end loop;
      Seal (Frame, S, Value, (True, Tag));
      Facts.Check
        ("low bytes of the freshness value, first bytes of the MAC",
         Frame.Fd.Bytes (0 .. 11)
         = (16#11#, 16#22#, 16#33#, 0, 0, 0, 7, 8,
            16#C0#, 16#C1#, 16#C2#, 16#C3#));
      Facts.Check
        ("a sealed frame is authentic by this MAC alone",
         Is_Authentic (Frame, S, Value, (True, Tag))
         and then not Is_Authentic (Frame, S, Value, (False, Tag))
         and then not Is_Authentic (Frame, S, Value + 1, (True, Tag)));
   end Check_Layout;

   ---------------------
   -- Check_Freshness --
   ---------------------

   procedure Check_Freshness is
      procedure Hold
        (Size       : Freshness_Size;
         Last, Sent : Freshness_Value;
         Expected   : Status);

      procedure Hold
        (Size       : Freshness_Size;
         Last, Sent : Freshness_Value;
         Expected   : Status)
      is
         S      : constant Setting := (1, 24, Size, 4);
         State  : constant Freshness_State := (True, Last);
         Value  : Freshness_Value;
         Result : Status;
      begin
         Reconstruct (State, S, Sealed (S, 7, Sent), Value, Result);
         Facts.Check
           ("after" & Last'Image & " comes" & Sent'Image & " in"
            & Size'Image & " bytes",
            Result = Expected
            and then (if Result = Unverified then Value = Sent));
      end Hold;

      Most : constant Freshness_Value := Freshness_Value'Last;
   begin
      Hold (1, 0, 1, Unverified);
      Hold (1, 0, 256, Unverified);
      Hold (1, 255, 256, Unverified);
      Hold (1, 16#1FE#, 16#2FE#, Unverified);
      Hold (3, 16#FF_FFFF#, 16#100_0000#, Unverified);
      Hold (4, 16#1_FFFF_FFFF#, 16#2_0000_0000#, Unverified);
      Hold (7, 0, 16#FF_FFFF_FFFF_FFFF#, Unverified);
      Hold (8, 5, 6, Unverified);
      Hold (8, 5, Most, Unverified);
      Hold (8, 5, 5, Not_Fresh);
      Hold (8, 5, 4, Not_Fresh);
      Hold (8, Most, Most, Not_Fresh);
      Hold (1, Most - 1, Most, Unverified);
      Hold (1, Most, 5, Not_Fresh);
      declare
         State : Freshness_State;
         Value : Freshness_Value;
         Taken : Boolean;
      begin
         Begin_After (State, Most - 1);
         Begin_After (State, 0);
         Take (State, Value, Taken);
         Facts.Check ("the last value is sent", Taken and then Value = Most);
         Take (State, Value, Taken);
         Facts.Check ("and none after it", not Taken);
      end;
   end Check_Freshness;

   --------------------
   -- Check_Statuses --
   --------------------

   procedure Check_Statuses is
      S      : constant Setting := (16#0123#, 24, 2, 4);
      State  : Freshness_State;
      Before : Freshness_State;
      Result : Status;

      procedure Hold (Fact : String; F : Any_Frame; Expected : Status);

      procedure Hold (Fact : String; F : Any_Frame; Expected : Status) is
      begin
         Before := State;
         Receive (State, S, F, Result);
         Facts.Check
           (Fact,
            Result = Expected
            and then (Result = Verified or else State = Before));
      end Hold;

      Wrong : Any_Frame := Sealed (S, 9, 8);
   begin
      Hold ("the first frame is verified", Sealed (S, 1, 5), Verified);
      Hold ("a replayed one is not", Sealed (S, 1, 5), Wrong_Mac);
      Hold ("the next one is verified", Sealed (S, 2, 6), Verified);
      Hold
        ("another data identifier is refused",
         Sealed ((16#0124#, 24, 2, 4), 3, 7), Wrong_Mac);
      Hold
        ("a classic frame is malformed",
         To_Any (Ravenchart.Can.Data_Frame (16#100#, Base, 8, 0)),
         Malformed);
      Hold
        ("a longer frame is malformed",
         Sealed ((16#0123#, 32, 2, 4), 3, 7), Malformed);
      Flip (Wrong, 0);
      Hold ("an altered frame is refused", Wrong, Wrong_Mac);
      Hold
        ("after 65,536 values one is used", Sealed (S, 9, 65_542), Verified);
      Hold
        ("after one more it is not", Sealed (S, 9, 65_542 + 65_537),
         Wrong_Mac);
      Before := State;
      declare
         Next  : constant Any_Frame := Sealed (S, 10, 65_543);
         Value : Freshness_Value;
      begin
         Reconstruct (State, S, Next, Value, Result);
         Verify
           (State, S, Next, Value,
            (Is_Known => False,
             Tag      =>
               Aes_Cmac.Cmac (Key, Input_Of (Next, S, Value)).Tag),
            Result);
         Facts.Check
           ("without a MAC nothing is verified",
            Result = No_Mac and then State = Before);
      end;
   end Check_Statuses;

   -------------------
   -- Check_Attacks --
   -------------------

   procedure Check_Attacks (S : Setting; Kind : Attack; Times : Positive) is
      Room : constant := 40;

      Old    : array (0 .. Room) of Any_Frame;
      Sent   : Natural := 0;
      To     : Freshness_State;
      From   : Freshness_State;
      Used   : Natural := 0;
      Wrong  : Natural := 0;
      Newest : Natural := 0;

      procedure Make;
      --  The next frame of the sender: Old (Sent mod 41).

      procedure Arrive (F : Any_Frame; Number : Natural);
      --  The frame arrives. Number is 0 for a frame that may never be used.

      procedure Strike;
      --  An attack.

      function Newest_Frame return Any_Frame
      is (Old (Sent mod Old'Length));

      ----------
      -- Make --
      ----------

      procedure Make is
         Value : Freshness_Value;
         Taken : Boolean;
      begin
         Sent := Sent + 1;
         Take (To, Value, Taken);
         Old (Sent mod Old'Length) := Sealed (S, Sent, Value);
      end Make;

      ------------
      -- Arrive --
      ------------

      procedure Arrive (F : Any_Frame; Number : Natural) is
         Result : Status;
      begin
         Receive (From, S, F, Result);
         if Result = Verified then
            Used := Used + 1;
            if Number <= Newest
              or else Natural (Words (F) (0) and 16#FFFF_FFFF#) mod 2 ** 24
                      /= Number mod 2 ** 24
            then
               Wrong := Wrong + 1;
            end if;
            Newest := Natural'Max (Newest, Number);
         end if;
      end Arrive;

      ------------
      -- Strike --
      ------------

      procedure Strike is
         Next  : constant Freshness_Value := To.Last + 1;
         Other : Setting := S;
         Frame : Any_Frame;
         Value : Freshness_Value;
         Taken : Boolean;
      begin
         case Kind is
            when Altered       =>
               Make;
               Frame := Newest_Frame;
               for I in 1 .. Random (1, 3) loop
                  Flip (Frame, Random (0, 8 * S.Length - 1));
               end loop;
               if Frame /= Newest_Frame then
                  Arrive (Frame, 0);
               end if;
            when Cut           =>
               Make;
               Frame := Newest_Frame;
               Frame.Fd.Length :=
                 Length_Of
                   (Length_Code
                      ((Natural (Code (S.Length)) + Random (1, 15)) mod 16));
               Arrive (Frame, 0);
            when Repeated      =>
               Arrive (Newest_Frame, 0);
            when Replayed      =>
               Arrive (Old (Random (0, Room)), 0);
            when Late          =>
               Make;
               Frame := Newest_Frame;
               for J in 1 .. Random (1, 10) loop
                  Make;
                  Arrive (Newest_Frame, Sent);
               end loop;
               Arrive (Frame, 0);
            when Forged        =>
               Frame := Sealed (S, 0, Next);
               for I in 0 .. S.Length - 1 loop
                  if I not in Data_Length (S)
                              .. Data_Length (S) + S.Freshness_Bytes - 1
                    or else Random (0, 1) = 0
                  then
                     Frame.Fd.Bytes (I) := Unsigned_8 (Random (0, 255));
                  end if;
               end loop;
               Arrive (Frame, 0);
            when Other_Key     =>
               declare
                  Secret : Tag_Bytes := Key;
               begin
                  Secret (Random (0, 15)) := Unsigned_8 (Random (0, 255));
                  if Secret /= Key then
                     Arrive (Sealed (S, Sent + 1, Next, Secret), 0);
                  end if;
               end;
            when Other_Message =>
               Other.Data_Id := S.Data_Id xor Unsigned_16 (Random (1, 65535));
               Arrive (Sealed (Other, Sent + 1, Next), 0);
            when Set_Back      =>
               Arrive
                 (Sealed
                    (S, Sent + 1,
                     Next - 1 - Unsigned_64 (Random (0, Sent - 1))),
                  0);
            when Lost          =>
               for J in 1 .. Random (1, 200) loop
                  Take (To, Value, Taken);
                  Sent := Sent + 1;
               end loop;
         end case;
      end Strike;
   begin
      Begin_After (To, 0);
      for I in 0 .. Room loop
         Make;
         Arrive (Newest_Frame, Sent);
      end loop;
      for I in 1 .. Times loop
         Strike;
         Make;
         Arrive (Newest_Frame, Sent);
      end loop;
      Facts.Check
        (Attack'Image (Kind) & ": nothing wrong is used, the rest is:"
         & Image (S),
         Wrong = 0 and then Newest = Sent and then Used > Times + Room);
   end Check_Attacks;

   -----------
   -- Print --
   -----------

   procedure Print is
   begin
      for S of Settings loop
         for I in 1 .. 200 loop
            declare
               Value : constant Freshness_Value :=
                 Shift_Right (Random, Random (0, 63));
               Frame : constant Any_Frame :=
                 Sealed (S, Random (0, 1_000_000), Value);
            begin
               Ada.Text_IO.Put_Line
                 (S.Data_Id'Image & S.Freshness_Bytes'Image
                  & S.Mac_Bytes'Image & Value'Image & " "
                  & Hex_Frames.Image (Frame, S.Length));
            end;
         end loop;
      end loop;
   end Print;

begin
   if Trials.Prints then
      Print;
      return;
   end if;
   Check_Layout;
   Check_Freshness;
   Check_Statuses;
   for S of Settings loop
      for Kind in Attack loop
         Check_Attacks (S, Kind, Trials.Times);
      end loop;
   end loop;
   Facts.Finish;
end Test_Authentication;
