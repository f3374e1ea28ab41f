--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Bus_Records.Client_Side
  with SPARK_Mode
is
   use type Any_Frames.Frame_Family;

   function Is_Time (Bytes : Image; First : Position) return Boolean
   is (Bytes (First + 7) < 128)
   with Global => null, Pre => First <= Record_Bytes - 7;
   --  Is a number of eight bytes below 2**63?

   function Number_In (Bytes : Image) return Interfaces.Unsigned_32
   is (Interfaces.Unsigned_32
         (Number_At_Place (Bytes, Number_At, 4) and 16#FFFF_FFFF#))
   with Global => null;
   --  The number of the request in an answer.

   function Read_Welcome (Bytes : Image) return Answer
   with
     Global => null,
     Post   => Read_Welcome'Result.Kind in Taken_In | Broken;

   function Read_Frame (Bytes : Image) return Answer
   with
     Global => null,
     Post   => Read_Frame'Result.Kind in Frame_Came | Noted | Broken;

   function Read_State (Bytes : Image) return Answer
   with
     Global => null,
     Post   => Read_State'Result.Kind in State_Told | Broken;

   function Read_Confirmation (Bytes : Image) return Answer
   with
     Global => null,
     Post   =>
       Read_Confirmation'Result.Kind in Confirmed | Broken
       and then
         (if Read_Confirmation'Result.Kind = Confirmed
          then Read_Confirmation'Result.Number > 0);

   function Read_Status (Bytes : Image) return Answer
   with
     Global => null,
     Post   =>
       Read_Status'Result.Kind in Refused | Closed | Turned_Away | Broken
       and then
         (if Read_Status'Result.Kind = Refused
          then Read_Status'Result.Number > 0);

   ------------------
   -- Read_Welcome --
   ------------------

   function Read_Welcome (Bytes : Image) return Answer
   is (Kind   =>
         (if Is_Greeting (Bytes)
            and then Bytes (Code_At) = Version
            and then Is_Time (Bytes, Time_At)
            and then Is_Time (Bytes, Began_At)
            and then Number_In (Bytes) in 1 .. 255
            and then Is_Zero (Bytes, Transmit_At, Data_At - 1)
          then Taken_In
          else Broken),
       others => <>);

   ----------------
   -- Read_Frame --
   ----------------

   function Read_Frame (Bytes : Image) return Answer is
      Found : constant Frame_Reading := Frame_In (Bytes);
   begin
      if not Found.Is_Sound
        or else Number_In (Bytes) /= 0
        or else not Is_Time (Bytes, Time_At)
      then
         return (others => <>);
      else
         case Found.Frame.Family is
            when Bus_Frames.Classic     =>
               return
                 (Kind   => Frame_Came,
                  Came   => Any_Frames.To_Any (Found.Frame.Plain),
                  others => <>);
            when Bus_Frames.Flexible    =>
               return
                 (Kind   => Frame_Came,
                  Came   => Any_Frames.To_Any (Found.Frame.Fd),
                  others => <>);
            when Bus_Frames.Asked_Error =>
               return (Kind => Noted, others => <>);
         end case;
      end if;
   end Read_Frame;

   ----------------
   -- Read_State --
   ----------------

   function Read_State (Bytes : Image) return Answer is
      Transmit : constant Interfaces.Unsigned_64 :=
        Number_At_Place (Bytes, Transmit_At, 2);
      Receive  : constant Interfaces.Unsigned_64 :=
        Number_At_Place (Bytes, Receive_At, 2);
   begin
      if not Is_Zero (Bytes, Flags_At, Length_At)
        or else not Is_Zero (Bytes, Id_At, Time_At - 1)
        or else not Is_Time (Bytes, Time_At)
        or else not Is_Zero (Bytes, Number_At, Transmit_At - 1)
        or else not Is_Zero (Bytes, Data_At, Record_Bytes)
        or else Transmit > 256
        or else Receive > 256
        or else Bytes (Code_At) /=
          State_Code
            (Fault_Confinement.State_For
               (Error_Count (Transmit), Error_Count (Receive)))
      then
         return (others => <>);
      else
         return
           (Kind            => State_Told,
            Transmit_Errors => Error_Count (Transmit),
            Receive_Errors  => Error_Count (Receive),
            others          => <>);
      end if;
   end Read_State;

   -----------------------
   -- Read_Confirmation --
   -----------------------

   function Read_Confirmation (Bytes : Image) return Answer
   is (if Is_Zero (Bytes, Flags_At, Time_At - 1)
         and then Is_Time (Bytes, Time_At)
         and then Number_In (Bytes) > 0
         and then Is_Zero (Bytes, Transmit_At, Record_Bytes)
       then (Kind => Confirmed, Number => Number_In (Bytes), others => <>)
       else (others => <>));

   -----------------
   -- Read_Status --
   -----------------

   function Read_Status (Bytes : Image) return Answer is
      Number : constant Interfaces.Unsigned_32 := Number_In (Bytes);
   begin
      if not Is_Zero (Bytes, Flags_At, Length_At)
        or else Bytes (Code_At) not in 1 .. Status'Pos (Status'Last) + 1
        or else not Is_Zero (Bytes, Id_At, Number_At - 1)
        or else not Is_Zero (Bytes, Transmit_At, Record_Bytes)
      then
         return (others => <>);
      elsif Number > 0 then
         return (Kind => Refused, Number => Number, others => <>);
      elsif Bytes (Code_At) = Status'Pos (Closing) + 1 then
         return (Kind => Closed, others => <>);
      else
         return (Kind => Turned_Away, others => <>);
      end if;
   end Read_Status;

   -----------
   -- Heard --
   -----------

   function Heard (Bytes : Image) return Answer
   is (case Bytes (Kind_At) is
         when Welcome_Kind                 => Read_Welcome (Bytes),
         when Frame_Kind_Code | Error_Kind => Read_Frame (Bytes),
         when State_Kind                   => Read_State (Bytes),
         when Confirmation_Kind            => Read_Confirmation (Bytes),
         when Status_Kind                  => Read_Status (Bytes),
         when others                       => (others => <>));

   -----------
   -- Hello --
   -----------

   function Hello (Name : String; Takes_Fd : Boolean) return Image is
      Result : Image := (others => 0);
   begin
      Result (Kind_At)   := Hello_Kind;
      Result (Flags_At)  := (if Takes_Fd then Fd_Flag else 0);
      Result (Length_At) := Byte (Name'Length);
      Result (Code_At)   := Version;
      Put (Result, Id_At, 4, Mark);
      for I in Name'Range loop
         Result (Data_At + (I - Name'First)) := Character'Pos (Name (I));
      end loop;
      return Result;
   end Hello;

   -------------
   -- Request --
   -------------

   function Request
     (F : Any_Frames.Any_Frame; Number : Interfaces.Unsigned_32) return Image
   is
      Result : Image :=
        Frame_Record
          ((if F.Family = Any_Frames.Classic
            then (Family => Bus_Frames.Classic, Plain => F.Plain)
            else (Family => Bus_Frames.Flexible, Fd => F.Fd)),
           Now => 0);
   begin
      Put (Result, Number_At, 4, Interfaces.Unsigned_64 (Number));
      return Result;
   end Request;

   --------------
   -- Recovery --
   --------------

   function Recovery return Image
   is (Kind_At => Recovery_Kind, others => 0);

end Ravenchart.Can.Bus_Records.Client_Side;
