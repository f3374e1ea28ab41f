--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Fd_Frames;

package body Ravenchart.Can.Bus_Records
  with SPARK_Mode
is
   use type Bus_Frames.Bus_Frame_Family;
   use type Fd_Frames.Bit_Rate_Use;
   use type Fd_Frames.Sender_State;

   function Read_Hello (Bytes : Image) return Request
   with
     Global => null,
     Post   =>
       Read_Hello'Result.Kind in Hello | Wrong_Version | Broken
       and then
         (if Read_Hello'Result.Kind = Hello
          then Read_Hello'Result.Number <= Longest_Restart);

   function Read_Frame (Bytes : Image) return Request
   with
     Global => null,
     Post   =>
       Read_Frame'Result.Kind in Frame_Request | Broken
       and then
         (if Read_Frame'Result.Kind = Frame_Request
          then Read_Frame'Result.Number > 0);

   ---------------------
   -- Number_At_Place --
   ---------------------

   function Number_At_Place
     (Bytes : Image; First : Position; Count : Width)
      return Interfaces.Unsigned_64
   is
      Result : Interfaces.Unsigned_64 := 0;
   begin
      for I in reverse 0 .. Count - 1 loop
         Result := Interfaces.Shift_Left (Result, 8)
           or Interfaces.Unsigned_64 (Bytes (First + I));
      end loop;
      return Result;
   end Number_At_Place;

   ---------
   -- Put --
   ---------

   procedure Put
     (Bytes : in out Image;
      First : Position;
      Count : Width;
      Value : Interfaces.Unsigned_64)
   is
      Rest : Interfaces.Unsigned_64 := Value;
   begin
      for I in 0 .. Count - 1 loop
         Bytes (First + I) := Byte (Rest and 16#FF#);
         Rest := Interfaces.Shift_Right (Rest, 8);
      end loop;
   end Put;

   -----------------
   -- Is_Greeting --
   -----------------

   function Is_Greeting (Bytes : Image) return Boolean is
      Length  : constant Byte := Bytes (Length_At);
      Nominal : constant Interfaces.Unsigned_64 :=
        Number_At_Place (Bytes, Nominal_At, 4);
      Fast    : constant Interfaces.Unsigned_64 :=
        Number_At_Place (Bytes, Fast_At, 4);
   begin
      return Number_At_Place (Bytes, Id_At, 4) = Mark
        and then (Bytes (Flags_At) and not Fd_Flag) = 0
        and then Length in 1 .. 16
        and then Is_Zero
                   (Bytes, Data_At + Natural (Length), Nominal_At - 1)
        and then Is_Zero (Bytes, Began_At + 8, Record_Bytes)
        and then Nominal <= 1_000_000
        and then Fast <= 20_000_000
        and then
          (for all I in Data_At .. Data_At + Natural (Length) - 1 =>
             Bytes (I) in 16#21# .. 16#7E#);
   end Is_Greeting;

   ----------------
   -- Read_Hello --
   ----------------

   function Read_Hello (Bytes : Image) return Request is
      Nominal : constant Interfaces.Unsigned_64 :=
        Number_At_Place (Bytes, Nominal_At, 4) and 16#FFFF_FFFF#;
      Fast    : constant Interfaces.Unsigned_64 :=
        Number_At_Place (Bytes, Fast_At, 4) and 16#FFFF_FFFF#;
      Restart : constant Interfaces.Unsigned_64 :=
        Number_At_Place (Bytes, Number_At, 4);
   begin
      if Number_At_Place (Bytes, Id_At, 4) /= Mark
        or else Bytes (Code_At) = 0
      then
         return (others => <>);
      elsif Bytes (Code_At) /= Version then
         return (Kind => Wrong_Version, others => <>);
      elsif not Is_Greeting (Bytes)
        or else not Is_Zero (Bytes, Time_At, Number_At - 1)
        or else Restart > Longest_Restart
        or else not Is_Zero (Bytes, Transmit_At, Data_At - 1)
        or else not Is_Zero (Bytes, Began_At, Began_At + 7)
      then
         return (others => <>);
      else
         return
           (Kind     => Hello,
            Takes_Fd => Bytes (Flags_At) = Fd_Flag,
            Nominal  => Bit_Rate (Nominal),
            Data     => Bit_Rate (Fast),
            Number   => Interfaces.Unsigned_32 (Restart),
            others   => <>);
      end if;
   end Read_Hello;

   --------------
   -- Frame_In --
   --------------

   function Frame_In (Bytes : Image) return Frame_Reading is
      Kind     : constant Byte := Bytes (Kind_At);
      Flags    : constant Byte := Bytes (Flags_At);
      Length   : constant Byte := Bytes (Length_At);
      Id       : constant Interfaces.Unsigned_64 :=
        Number_At_Place (Bytes, Id_At, 4);
      Format   : constant Frame_Format :=
        (if (Flags and Extended_Flag) /= 0 then Extended else Standard);
      Allowed  : constant Byte :=
        (if Kind = Error_Kind then Extended_Flag
         elsif (Flags and Fd_Flag) /= 0
         then Extended_Flag or Fd_Flag or Brs_Flag or Esi_Flag
         else Extended_Flag or Remote_Flag);
      Carried  : constant Natural :=
        (if (Flags and Remote_Flag) /= 0 then 0 else Natural (Length));
      Result   : Frame_Reading;
   begin
      if (Flags and not Allowed) /= 0
        or else Id > Interfaces.Unsigned_64 (Identifier'Last)
        or else not Fits (Identifier (Id), Format)
        or else Bytes (Code_At) /= 0
        or else not Is_Zero (Bytes, Transmit_At, Data_At - 1)
        or else Length > 64
        or else not Is_Zero (Bytes, Data_At + Carried, Record_Bytes)
      then
         return (others => <>);
      end if;
      Result.Is_Sound := True;
      if (Flags and Fd_Flag) /= 0 then
         if Natural (Length) not in Fd_Frames.Fd_Length then
            return (others => <>);
         end if;
         declare
            Data : Fd_Frames.Fd_Bytes;
         begin
            for I in Data'Range loop
               Data (I) := Bytes (Data_At + I);
            end loop;
            Result.Frame :=
              (Family => Bus_Frames.Flexible,
               Fd     => Fd_Frames.Fd_Data_Frame
                 (Identifier (Id), Format, Natural (Length), Data,
                  (if (Flags and Brs_Flag) /= 0
                   then Fd_Frames.Switched_Rate
                   else Fd_Frames.Constant_Rate),
                  (if (Flags and Esi_Flag) /= 0
                   then Fd_Frames.Passive_Sender
                   else Fd_Frames.Active_Sender)));
         end;
      elsif Length > 8 then
         return (others => <>);
      else
         declare
            Plain : constant Frame :=
              (if (Flags and Remote_Flag) /= 0
               then Remote_Frame
                      (Identifier (Id), Format, Natural (Length))
               else Data_Frame
                      (Identifier (Id), Format, Natural (Length),
                       Number_At_Place (Bytes, Data_At, 8)));
         begin
            Result.Frame :=
              (if Kind = Error_Kind
               then (Family => Bus_Frames.Asked_Error, Plain => Plain)
               else (Family => Bus_Frames.Classic, Plain => Plain));
         end;
      end if;
      return Result;
   end Frame_In;

   ----------------
   -- Read_Frame --
   ----------------

   function Read_Frame (Bytes : Image) return Request is
      Found  : constant Frame_Reading := Frame_In (Bytes);
      Number : constant Interfaces.Unsigned_64 :=
        Number_At_Place (Bytes, Number_At, 4) and 16#FFFF_FFFF#;
   begin
      if not Found.Is_Sound
        or else Number = 0
        or else not Is_Zero (Bytes, Time_At, Number_At - 1)
      then
         return (others => <>);
      else
         return
           (Kind   => Frame_Request,
            Number => Interfaces.Unsigned_32 (Number),
            Frame  => Found.Frame,
            others => <>);
      end if;
   end Read_Frame;

   ----------
   -- Read --
   ----------

   function Read (Bytes : Image) return Request is
   begin
      case Bytes (Kind_At) is
         when Hello_Kind                   =>
            return Read_Hello (Bytes);
         when Frame_Kind_Code | Error_Kind =>
            return Read_Frame (Bytes);
         when Recovery_Kind                =>
            return
              (Kind   =>
                 (if Is_Zero (Bytes, Kind_At + 1, Record_Bytes)
                  then Recovery_Request
                  else Broken),
               others => <>);
         when others                       =>
            return (others => <>);
      end case;
   end Read;

   -------------
   -- Welcome --
   -------------

   function Welcome
     (Name    : String;
      With_Fd : Boolean;
      Nominal : Bit_Rate;
      Data    : Bit_Rate;
      Began   : Nanoseconds;
      Now     : Nanoseconds;
      Node    : Node_Number) return Image
   is
      Result : Image := (others => 0);
   begin
      Result (Kind_At)   := Welcome_Kind;
      Result (Flags_At)  := (if With_Fd then Fd_Flag else 0);
      Result (Length_At) := Byte (Name'Length);
      Result (Code_At)   := Version;
      Put (Result, Id_At, 4, Mark);
      Put (Result, Time_At, 8, Interfaces.Unsigned_64 (Now));
      Put (Result, Number_At, 4, Interfaces.Unsigned_64 (Node));
      for I in Name'Range loop
         Result (Data_At + (I - Name'First)) :=
           Character'Pos (Name (I));
      end loop;
      Put (Result, Nominal_At, 4, Interfaces.Unsigned_64 (Nominal));
      Put (Result, Fast_At, 4, Interfaces.Unsigned_64 (Data));
      Put (Result, Began_At, 8, Interfaces.Unsigned_64 (Began));
      return Result;
   end Welcome;

   ------------------
   -- Frame_Record --
   ------------------

   function Frame_Record
     (Frame : Bus_Frames.Bus_Frame; Now : Nanoseconds) return Image
   is
      Result : Image := (others => 0);
      Format : Frame_Format;
      Id     : Identifier;
      Flags  : Byte;
   begin
      Result (Kind_At) :=
        (if Frame.Family = Bus_Frames.Asked_Error
         then Error_Kind else Frame_Kind_Code);
      Put (Result, Time_At, 8, Interfaces.Unsigned_64 (Now));
      if Frame.Family = Bus_Frames.Flexible then
         Id     := Frame.Fd.Id;
         Format := Frame.Fd.Format;
         Flags  := Fd_Flag
           or (if Frame.Fd.Rate = Fd_Frames.Switched_Rate
               then Brs_Flag else 0)
           or (if Frame.Fd.Sender = Fd_Frames.Passive_Sender
               then Esi_Flag else 0);
         Result (Length_At) := Byte (Frame.Fd.Length);
         for I in Fd_Frames.Fd_Index loop
            Result (Data_At + I) := Fd_Frames.Byte (Frame.Fd, I);
         end loop;
      else
         Id     := Frame.Plain.Id;
         Format := Frame.Plain.Format;
         Flags  := (if Frame.Plain.Kind = Remote then Remote_Flag else 0);
         Result (Length_At) := Byte (Frame.Plain.Length);
         Put (Result, Data_At, 8, Payload (Frame.Plain));
      end if;
      Result (Flags_At) :=
        Flags or (if Format = Extended then Extended_Flag else 0);
      Put (Result, Id_At, 4, Interfaces.Unsigned_64 (Id));
      return Result;
   end Frame_Record;

   ------------------
   -- State_Record --
   ------------------

   function State_Record
     (Node : Fault_Confinement.Node; Now : Nanoseconds) return Image
   is
      Result : Image := (others => 0);
   begin
      Result (Kind_At) := State_Kind;
      Result (Code_At) := State_Code (Fault_Confinement.State (Node));
      Put (Result, Time_At, 8, Interfaces.Unsigned_64 (Now));
      Put
        (Result, Transmit_At, 2,
         Interfaces.Unsigned_64 (Fault_Confinement.Transmit_Errors (Node)));
      Put
        (Result, Receive_At, 2,
         Interfaces.Unsigned_64 (Fault_Confinement.Receive_Errors (Node)));
      return Result;
   end State_Record;

   ------------------
   -- Confirmation --
   ------------------

   function Confirmation
     (Number : Interfaces.Unsigned_32; Now : Nanoseconds) return Image
   is
      Result : Image := (others => 0);
   begin
      Result (Kind_At) := Confirmation_Kind;
      Put (Result, Time_At, 8, Interfaces.Unsigned_64 (Now));
      Put (Result, Number_At, 4, Interfaces.Unsigned_64 (Number));
      return Result;
   end Confirmation;

   -------------
   -- Refusal --
   -------------

   function Refusal
     (Number : Interfaces.Unsigned_32; Why : Status) return Image
   is
      Result : Image := (others => 0);
   begin
      Result (Kind_At) := Status_Kind;
      Result (Code_At) := Status'Pos (Why) + 1;
      Put (Result, Number_At, 4, Interfaces.Unsigned_64 (Number));
      return Result;
   end Refusal;

   ------------------
   -- Error_Report --
   ------------------

   function Error_Report
     (Identifier : Can.Identifier;
      Details    : Interfaces.Unsigned_64;
      Now        : Nanoseconds) return Image
   is (Frame_Record
         ((Family => Bus_Frames.Asked_Error,
           Plain  => Data_Frame (Identifier, Extended, 8, Details)),
          Now));

end Ravenchart.Can.Bus_Records;
