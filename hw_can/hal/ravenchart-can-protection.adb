--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Data_Crcs;

package body Ravenchart.Can.Protection
  with SPARK_Mode
is
   use type Data_Crcs.Data_Crc_Kind;

   function First_Data (P : Profile) return Fd_Frames.Fd_Index
   is (if P = Profile_5 then 2 else 1);
   --  The first byte behind the CRC.

   function Seed
     (S : Setting; Count : Counter_Value) return Data_Crcs.Register;
   --  The register before the data.

   function Final
     (S : Setting; R : Data_Crcs.Register; Count : Counter_Value)
      return Interfaces.Unsigned_16
   with Post => (if S.Kind /= Profile_5 then Final'Result <= 16#FF#);
   --  The CRC, from the register behind the data.

   function Kind_Of (P : Profile) return Data_Crcs.Data_Crc_Kind
   is (case P is
         when Profile_1 | Profile_11 => Data_Crcs.Crc_8_J1850,
         when Profile_2              => Data_Crcs.Crc_8_H2f,
         when Profile_5              => Data_Crcs.Crc_16_Ccitt);

   function With_Byte
     (F     : Any_Frames.Any_Frame;
      Index : Fd_Frames.Fd_Index;
      Value : Interfaces.Unsigned_8) return Any_Frames.Any_Frame
   with
     Pre  =>
       Index <= 2
       and then
         (if F.Family = Any_Frames.Classic
          then F.Plain.Kind = Can.Data and then Index < F.Plain.Length
          else Index < F.Fd.Length),
     Post =>
       With_Byte'Result.Family = F.Family
       and then With_Byte'Result.Plain.Kind = F.Plain.Kind
       and then With_Byte'Result.Plain.Length = F.Plain.Length
       and then With_Byte'Result.Fd.Length = F.Fd.Length
       and then Any_Frames.Id (With_Byte'Result) = Any_Frames.Id (F)
       and then
         Any_Frames.Format (With_Byte'Result) = Any_Frames.Format (F)
       and then
         (for all I in Fd_Frames.Fd_Index =>
            Any_Frames.Byte (With_Byte'Result, I)
            = (if I = Index then Value else Any_Frames.Byte (F, I)))
       and then
         First_Word (With_Byte'Result)
         = ((First_Word (F)
             and not Interfaces.Shift_Left
                       (Interfaces.Unsigned_64'(16#FF#), 8 * Index))
            or Interfaces.Shift_Left
                 (Interfaces.Unsigned_64 (Value), 8 * Index));
   --  F with another byte.

   function With_Counter
     (F : Any_Frames.Any_Frame; S : Setting; Count : Counter_Value)
      return Any_Frames.Any_Frame
   with
     Pre  =>
       Any_Frames.Carries (F, F.Family, S.Length)
       and then Count <= Last_Counter (S.Kind),
     Post =>
       Has_Same_Data (F, With_Counter'Result, S)
       and then With_Counter'Result.Family = F.Family
       and then Counter (With_Counter'Result, S.Kind) = Count
       and then Shows_Nibble (With_Counter'Result, S);
   --  F with this counter, and with the nibble of the data identifier.

   function With_Crc
     (F : Any_Frames.Any_Frame; S : Setting; Check : Interfaces.Unsigned_16)
      return Any_Frames.Any_Frame
   with
     Pre  =>
       Any_Frames.Carries (F, F.Family, S.Length)
       and then (if S.Kind /= Profile_5 then Check <= 16#FF#),
     Post =>
       Has_Same_Data (F, With_Crc'Result, S)
       and then With_Crc'Result.Family = F.Family
       and then Crc_Field (With_Crc'Result, S.Kind) = Check
       and then
         (for all I in First_Data (S.Kind) .. Fd_Frames.Fd_Index'Last =>
            Any_Frames.Byte (With_Crc'Result, I) = Any_Frames.Byte (F, I));
   --  F with this CRC.

   ----------
   -- Seed --
   ----------

   function Seed
     (S : Setting; Count : Counter_Value) return Data_Crcs.Register
   is
      Kind  : constant Data_Crcs.Data_Crc_Kind := Kind_Of (S.Kind);
      Start : constant Data_Crcs.Register :=
        (case S.Kind is
           when Profile_1 | Profile_11 => 0,
           when Profile_2              => 16#FF00#,
           when Profile_5              => 16#FFFF#);
      After_Low : constant Data_Crcs.Register :=
        Data_Crcs.After_Byte (Kind, Start, Low_Id (S));
   begin
      if S.Kind in Profile_2 | Profile_5 then
         return Start;
      end if;
      case S.Mode is
         when Both        =>
            return Data_Crcs.After_Byte (Kind, After_Low, High_Id (S));
         when Alternating =>
            return
              (if (Count and 1) = 0
               then After_Low
               else Data_Crcs.After_Byte (Kind, Start, High_Id (S)));
         when Nibble      =>
            return Data_Crcs.After_Byte (Kind, After_Low, 0);
      end case;
   end Seed;

   -----------
   -- Final --
   -----------

   function Final
     (S : Setting; R : Data_Crcs.Register; Count : Counter_Value)
      return Interfaces.Unsigned_16
   is
      Kind : constant Data_Crcs.Data_Crc_Kind := Kind_Of (S.Kind);
   begin
      case S.Kind is
         when Profile_1 | Profile_11 =>
            return Interfaces.Shift_Right (R, 8);
         when Profile_2              =>
            return
              Interfaces.Shift_Right
                (Data_Crcs.After_Byte (Kind, R, S.Ids (Count and 16#0F#)), 8)
              xor 16#FF#;
         when Profile_5              =>
            return
              Data_Crcs.After_Byte
                (Kind,
                 Data_Crcs.After_Byte (Kind, R, Low_Id (S)),
                 High_Id (S));
      end case;
   end Final;

   ---------
   -- Crc --
   ---------

   function Crc
     (S : Setting; Item : Fd_Frames.Fd_Bytes; Count : Counter_Value)
      return Interfaces.Unsigned_16
   is (Final
         (S,
          Data_Crcs.Run
            (Kind_Of (S.Kind),
             Seed (S, Count),
             Item,
             First_Data (S.Kind),
             S.Length),
          Count));

   ---------------
   -- With_Byte --
   ---------------

   function With_Byte
     (F     : Any_Frames.Any_Frame;
      Index : Fd_Frames.Fd_Index;
      Value : Interfaces.Unsigned_8) return Any_Frames.Any_Frame
   is
      Result : Any_Frames.Any_Frame := F;
   begin
      if F.Family = Any_Frames.Classic then
         Result.Plain.Bits :=
           (F.Plain.Bits
            and not Interfaces.Shift_Left
                      (Interfaces.Unsigned_64'(16#FF#), 8 * Index))
           or Interfaces.Shift_Left
                (Interfaces.Unsigned_64 (Value), 8 * Index);
      else
         Result.Fd.Bytes (Index) := Value;
      end if;
      return Result;
   end With_Byte;

   ------------------
   -- With_Counter --
   ------------------

   function With_Counter
     (F : Any_Frames.Any_Frame; S : Setting; Count : Counter_Value)
      return Any_Frames.Any_Frame
   is
      Kept : constant Interfaces.Unsigned_8 :=
        (if Has_Nibble (S)
         then Interfaces.Shift_Left (High_Id (S), 4)
         else Any_Frames.Byte (F, 1) and 16#F0#);
   begin
      return
        (if S.Kind = Profile_5
         then With_Byte (F, 2, Count)
         else With_Byte (F, 1, Kept or Count));
   end With_Counter;

   --------------
   -- With_Crc --
   --------------

   function With_Crc
     (F : Any_Frames.Any_Frame; S : Setting; Check : Interfaces.Unsigned_16)
      return Any_Frames.Any_Frame
   is
      Low : constant Any_Frames.Any_Frame :=
        With_Byte (F, 0, Interfaces.Unsigned_8 (Check and 16#FF#));
   begin
      return
        (if S.Kind = Profile_5
         then
           With_Byte
             (Low,
              1,
              Interfaces.Unsigned_8 (Interfaces.Shift_Right (Check, 8)))
         else Low);
   end With_Crc;

   ---------------------
   -- Protected_Frame --
   ---------------------

   function Protected_Frame
     (F : Any_Frames.Any_Frame; S : Setting; Count : Counter_Value)
      return Any_Frames.Any_Frame
   is
      Counted : constant Any_Frames.Any_Frame := With_Counter (F, S, Count);
      Check   : constant Interfaces.Unsigned_16 :=
        Crc (S, Any_Frames.Bytes (Counted), Count);
      Result  : constant Any_Frames.Any_Frame := With_Crc (Counted, S, Check);
   begin
      Data_Crcs.Lemma_Same_Register
        (Kind_Of (S.Kind),
         Seed (S, Count),
         Any_Frames.Bytes (Counted),
         Any_Frames.Bytes (Result),
         First_Data (S.Kind),
         S.Length);
      pragma Assert
        (Data_Crcs.Run
           (Kind_Of (S.Kind), Seed (S, Count), Any_Frames.Bytes (Counted),
            First_Data (S.Kind), S.Length)
         = Data_Crcs.Run
             (Kind_Of (S.Kind), Seed (S, Count), Any_Frames.Bytes (Result),
              First_Data (S.Kind), S.Length));
      pragma Assert (Crc (S, Any_Frames.Bytes (Result), Count) = Check);
      pragma Assert (Counter (Result, S.Kind) = Count);
      return Result;
   end Protected_Frame;

   -------------
   -- Protect --
   -------------

   procedure Protect
     (State : in out Sender; S : Setting; F : in out Any_Frames.Any_Frame)
   is
      Count : constant Counter_Value := Current (State, S.Kind);
   begin
      F          := Protected_Frame (F, S, Count);
      State.Next := Successor (Count, S.Kind);
   end Protect;

   -----------
   -- Check --
   -----------

   procedure Check
     (State  : in out Receiver;
      S      : Setting;
      F      : Any_Frames.Any_Frame;
      Result : out Status) is
   begin
      Result := Status_Of (State, S, F);
      case Result is
         when Error | Repeated         =>
            null;
         when Ok | Ok_Some_Lost        =>
            State := (True, Counter (F, S.Kind), 0);
         when Synchronizing            =>
            State := (True, Counter (F, S.Kind), State.Awaited - 1);
         when Initial | Wrong_Sequence =>
            State := (True, Counter (F, S.Kind), S.Sync - 1);
      end case;
   end Check;

   -------------------------
   -- Lemma_Late_Not_Used --
   -------------------------

   procedure Lemma_Late_Not_Used
     (State : Receiver;
      S     : Setting;
      F     : Any_Frames.Any_Frame;
      Age   : Natural)
   is null;

end Ravenchart.Can.Protection;
