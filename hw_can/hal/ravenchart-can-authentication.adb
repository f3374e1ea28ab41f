--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Authentication
  with SPARK_Mode
is

   function Has_Tag
     (F : Any_Frames.Any_Frame; S : Setting; Tag : Tag_Bytes) return Boolean
   with Post => Has_Tag'Result = Shows_Tag (F, S, Tag);
   --  Shows_Tag, in a time that does not depend on the first difference.

   --------------
   -- Input_Of --
   --------------

   function Input_Of
     (F : Any_Frames.Any_Frame; S : Setting; Value : Freshness_Value)
      return Mac_Input
   is
      Data   : constant Data_Size := Data_Length (S);
      Result : Mac_Input := (Length => Data + 10, Bytes => (others => 0));
   begin
      Result.Bytes (0) := Octet (Freshness_Value (S.Data_Id), 1);
      Result.Bytes (1) := Octet (Freshness_Value (S.Data_Id), 0);
      for I in 0 .. Data - 1 loop
         Result.Bytes (I + 2) := Any_Frames.Byte (F, I);
         pragma Loop_Invariant (Result.Length = Data + 10);
         pragma Loop_Invariant
           (Result.Bytes (0) = Octet (Freshness_Value (S.Data_Id), 1)
            and then Result.Bytes (1)
              = Octet (Freshness_Value (S.Data_Id), 0));
         pragma Loop_Invariant
           (for all J in 2 .. Input_Index'Last =>
              Result.Bytes (J)
              = (if J <= I + 2 then Any_Frames.Byte (F, J - 2) else 0));
      end loop;
      for K in Octet_Index loop
         Result.Bytes (Data + 9 - K) := Octet (Value, K);
         pragma Loop_Invariant (Result.Length = Data + 10);
         pragma Loop_Invariant
           (for all J in Input_Index =>
              (if J < Data + 2 or else J > Data + 9
               then Result.Bytes (J) = Result.Bytes'Loop_Entry (J)));
         pragma Loop_Invariant
           (for all J in Data + 9 - K .. Data + 9 =>
              Result.Bytes (J) = Octet (Value, Data + 9 - J));
      end loop;
      return Result;
   end Input_Of;

   -----------------
   -- Begin_After --
   -----------------

   procedure Begin_After
     (State : in out Freshness_State; Last : Freshness_Value)
   is
   begin
      if not State.Is_Started then
         State := (Is_Started => True, Last => Last);
      end if;
   end Begin_After;

   ----------
   -- Take --
   ----------

   procedure Take
     (State : in out Freshness_State;
      Value : out Freshness_Value;
      Taken : out Boolean) is
   begin
      Taken := State.Last < Freshness_Value'Last;
      if Taken then
         State.Last := State.Last + 1;
      end if;
      Value := State.Last;
   end Take;

   ----------
   -- Seal --
   ----------

   procedure Seal
     (F      : in out Any_Frames.Any_Frame;
      S      : Setting;
      Value  : Freshness_Value;
      Answer : Mac_Answer)
   is
      Old   : constant Any_Frames.Any_Frame := F with Ghost;
      First : constant Fd_Frames.Fd_Index := S.Length - S.Mac_Bytes;
      --  The first byte of the MAC.
   begin
      for K in 0 .. S.Freshness_Bytes - 1 loop
         F.Fd.Bytes (First - 1 - K) := Octet (Value, K);
         pragma Loop_Invariant
           (for all J in Fd_Frames.Fd_Index =>
              F.Fd.Bytes (J)
              = (if J in First - 1 - K .. First - 1
                 then Octet (Value, First - 1 - J)
                 else Old.Fd.Bytes (J)));
         pragma Loop_Invariant (Has_Same_Header (F, Old));
      end loop;
      for I in 0 .. S.Mac_Bytes - 1 loop
         F.Fd.Bytes (First + I) := Answer.Tag (I);
         pragma Loop_Invariant
           (for all J in Fd_Frames.Fd_Index =>
              F.Fd.Bytes (J)
              = (if J in First .. First + I
                 then Answer.Tag (J - First)
                 elsif J in First - S.Freshness_Bytes .. First - 1
                 then Octet (Value, First - 1 - J)
                 else Old.Fd.Bytes (J)));
         pragma Loop_Invariant (Has_Same_Header (F, Old));
      end loop;
      pragma Assert
        (for all K in Octet_Index =>
           Shown_Octet (F, S, K)
           = (if K < S.Freshness_Bytes
              then Freshness_Value (Octet (Value, K))
              else 0));
      pragma Assert (Shown (F, S) = (Value and Mask (S)));
      pragma Assert
        (for all I in Input_Index =>
           Input_Of (F, S, Value).Bytes (I)
           = Input_Of (Old, S, Value).Bytes (I));
   end Seal;

   -----------------
   -- Reconstruct --
   -----------------

   procedure Reconstruct
     (State  : Freshness_State;
      S      : Setting;
      F      : Any_Frames.Any_Frame;
      Value  : out Freshness_Value;
      Result : out Status)
   is
      Low  : constant Freshness_Value := Shown (F, S);
      High : constant Freshness_Value := State.Last and not Mask (S);
   begin
      Value  := State.Last;
      Result := Not_Fresh;
      pragma Assert (Low = (Low and Mask (S)));
      if not Is_Whole (F, S) then
         Result := Malformed;
      elsif Low > (State.Last and Mask (S)) then
         Value  := High or Low;
         Result := Unverified;
      elsif High < not Mask (S) then
         Value  := (High + Mask (S) + 1) or Low;
         Result := Unverified;
      end if;
   end Reconstruct;

   -------------
   -- Has_Tag --
   -------------

   function Has_Tag
     (F : Any_Frames.Any_Frame; S : Setting; Tag : Tag_Bytes) return Boolean
   is
      Difference : Interfaces.Unsigned_8 := 0;
   begin
      for I in 0 .. S.Mac_Bytes - 1 loop
         Difference :=
           Difference
           or (Any_Frames.Byte (F, S.Length - S.Mac_Bytes + I) xor Tag (I));
         pragma Loop_Invariant
           ((Difference = 0)
            = (for all J in 0 .. I =>
                 Any_Frames.Byte (F, S.Length - S.Mac_Bytes + J) = Tag (J)));
      end loop;
      return Difference = 0;
   end Has_Tag;

   ------------
   -- Verify --
   ------------

   procedure Verify
     (State  : in out Freshness_State;
      S      : Setting;
      F      : Any_Frames.Any_Frame;
      Value  : Freshness_Value;
      Answer : Mac_Answer;
      Result : out Status) is
   begin
      if not Answer.Is_Known then
         Result := No_Mac;
      elsif Has_Tag (F, S, Answer.Tag) then
         State.Last := Value;
         Result     := Verified;
      else
         Result := Wrong_Mac;
      end if;
   end Verify;

   -----------------
   -- Lemma_Least --
   -----------------

   procedure Lemma_Least
     (State : Freshness_State;
      S     : Setting;
      F     : Any_Frames.Any_Frame;
      Value : Freshness_Value;
      Other : Freshness_Value)
   is null;

end Ravenchart.Can.Authentication;
