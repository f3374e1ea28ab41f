--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A node of a served bus: the server reads the records of the node as they
--  were sent, the node those of the server, and the right consequences follow.

with Facts;
with Interfaces;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Members;
with Ravenchart.Can.Bus_Records;
with Ravenchart.Can.Bus_Records.Client_Side;
with Ravenchart.Can.Fault_Confinement;
with Ravenchart.Can.Fd_Frames;

procedure Test_Bus_Members is
   use Ravenchart.Can;
   use Ravenchart.Can.Bus_Members;
   use Ravenchart.Can.Bus_Records.Client_Side;
   use type Any_Frames.Frame_Family;
   use type Bus_Frames.Bus_Frame;
   use type Bus_Records.Byte;
   use type Bus_Records.Request_Kind;
   use type Interfaces.Unsigned_32;

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   Node : Fault_Confinement.Node;

   Welcome : constant Bus_Records.Image :=
     Bus_Records.Welcome ("can0", True, 500_000, 2_000_000, 7, 9, 255);

   function Is_Read (F : Any_Frames.Any_Frame) return Boolean;
   --  Does the server read the request of F unchanged?

   function Is_Read (F : Frame) return Boolean
   is (Is_Read (Any_Frames.To_Any (F)));

   function Is_Read (F : Fd_Frames.Fd_Frame) return Boolean
   is (Is_Read (Any_Frames.To_Any (F)));

   function Long_Frame
     (Code : Fd_Frames.Length_Code; Rate : Fd_Frames.Bit_Rate_Use)
      return Fd_Frames.Fd_Frame
   is (Fd_Frames.Fd_Data_Frame
         (16#123#, Base, Fd_Frames.Length_Of (Code),
          Words => (others => 16#8877_6655_4433_2211#), Rate => Rate));

   function Rejects
     (Bytes : Bus_Records.Image; First, Last : Bus_Records.Position)
      return Boolean;
   --  Is Bytes Broken after the inversion of any one bit from byte First to
   --  Last?

   function Told (Transmit, Receive : Error_Count) return Answer
   is (Kind            => State_Told,
       Transmit_Errors => Transmit,
       Receive_Errors  => Receive,
       others          => <>);

   procedure Check_Requests;

   procedure Check_Answers;

   procedure Check_Broken_Answers;

   procedure Check_A_Life;

   procedure Check_Wrong_Answers;

   -------------
   -- Is_Read --
   -------------

   function Is_Read (F : Any_Frames.Any_Frame) return Boolean is
      R : constant Bus_Records.Request :=
        Bus_Records.Read (Request (F, 16#8000_0001#));
   begin
      return R.Kind = Bus_Records.Frame_Request
        and then R.Number = 16#8000_0001#
        and then R.Frame =
          (if F.Family = Any_Frames.Classic
           then (Family => Bus_Frames.Classic, Plain => F.Plain)
           else (Family => Bus_Frames.Flexible, Fd => F.Fd));
   end Is_Read;

   -------------
   -- Rejects --
   -------------

   function Rejects
     (Bytes : Bus_Records.Image; First, Last : Bus_Records.Position)
      return Boolean is
   begin
      for I in First .. Last loop
         for Bit in 0 .. 7 loop
            declare
               Bad : Bus_Records.Image := Bytes;
            begin
               Bad (I) := Bad (I) xor 2**Bit;
               if Heard (Bad).Kind /= Broken then
                  return False;
               end if;
            end;
         end loop;
      end loop;
      return True;
   end Rejects;

   --------------------
   -- Check_Requests --
   --------------------

   procedure Check_Requests is
      R     : Bus_Records.Request;
      Right : Boolean := True;
   begin
      for Length in Data_Length loop
         Right := Right
           and then Is_Read
             (Data_Frame (16#7FF#, Base, Length, 16#8877_6655_4433_2211#))
           and then Is_Read (Data_Frame (2**29 - 1, Extended, Length, 1))
           and then Is_Read (Remote_Frame (0, Base, Length))
           and then Is_Read (Remote_Frame (16#800#, Extended, Length));
      end loop;
      for Code in Fd_Frames.Length_Code loop
         for Rate in Fd_Frames.Bit_Rate_Use loop
            Right := Right and then Is_Read (Long_Frame (Code, Rate));
         end loop;
      end loop;
      Facts.Check ("the server reads requests as they are meant", Right);
      R := Bus_Records.Read (Hello ("node~1", Takes_Fd => True));
      Facts.Check
        ("hello tells whether the node takes CAN FD",
         R.Kind = Bus_Records.Hello and then R.Takes_Fd);
      R := Bus_Records.Read (Hello ("node~1", Takes_Fd => False));
      Facts.Check
        ("hello is one of a classic node that takes any rate",
         R.Kind = Bus_Records.Hello and then not R.Takes_Fd
         and then R.Nominal = 0 and then R.Data = 0);
      R := Bus_Records.Read (Recovery);
      Facts.Check
        ("recovery is asked for", R.Kind = Bus_Records.Recovery_Request);
   end Check_Requests;

   -------------------
   -- Check_Answers --
   -------------------

   procedure Check_Answers is
      F      : constant Frame := Data_Frame (16#123#, Extended, 3, 16#321#);
      Silent : Answer;
      Right  : Boolean := True;
   begin
      Facts.Check
        ("a welcome is heard", Heard (Welcome) = (Taken_In, others => <>));
      Facts.Check
        ("a frame is heard as it was sent",
         Heard (Bus_Records.Frame_Record ((Bus_Frames.Classic, F), 5))
         = (Kind   => Frame_Came,
            Came   => Any_Frames.To_Any (F),
            others => <>));
      for Code in Fd_Frames.Length_Code loop
         Right := Right
           and then
             Heard
               (Bus_Records.Frame_Record
                  ((Family => Bus_Frames.Flexible,
                    Fd     => Long_Frame (Code, Fd_Frames.Switched_Rate)),
                   5))
             = (Kind   => Frame_Came,
                Came   => Any_Frames.To_Any
                            (Long_Frame (Code, Fd_Frames.Switched_Rate)),
                others => <>);
      end loop;
      Facts.Check ("CAN FD frames are heard as they were sent", Right);
      Right := True;
      Facts.Check
        ("a confirmation is heard",
         Heard (Bus_Records.Confirmation (7, 5))
         = (Kind => Confirmed, Number => 7, others => <>));
      for Why in Bus_Records.Status loop
         Silent :=
           (Kind   =>
              (if Bus_Records."=" (Why, Bus_Records.Closing)
               then Closed else Turned_Away),
            others => <>);
         Right := Right
           and then Heard (Bus_Records.Refusal (0, Why)) = Silent
           and then Heard (Bus_Records.Refusal (9, Why))
             = (Kind => Refused, Number => 9, others => <>);
      end loop;
      Facts.Check ("refusals are heard, and the end", Right);
      Right := True;
      for I in 1 .. 40 loop
         Right := Right
           and then Heard (Bus_Records.State_Record (Node, 5))
             = Told (Fault_Confinement.Transmit_Errors (Node), 0);
         Fault_Confinement.Count
           (Node, Fault_Confinement.Transmitter_Error);
         exit when Fault_Confinement.State (Node) = Bus_Off;
      end loop;
      Facts.Check
        ("each bus state is heard, bus-off too",
         Right
         and then Heard (Bus_Records.State_Record (Node, 5))
           = Told (256, 0));
   end Check_Answers;

   --------------------------
   -- Check_Broken_Answers --
   --------------------------

   procedure Check_Broken_Answers is
      State        : constant Bus_Records.Image :=
        Bus_Records.State_Record (Node, 5);
      Confirmation : constant Bus_Records.Image :=
        Bus_Records.Confirmation (7, 5);
      Refusal      : constant Bus_Records.Image :=
        Bus_Records.Refusal (9, Bus_Records.Closing);
      Frame_Heard  : constant Bus_Records.Image :=
        Bus_Records.Frame_Record
          ((Bus_Frames.Classic, Data_Frame (1, Base, 3, 16#321#)), 5);
      Bad          : Bus_Records.Image := Welcome;
   begin
      Facts.Check
        ("a welcome of another version, mark or form is broken",
         Rejects (Welcome, 3, 8) and then Rejects (Welcome, 18, 24)
         and then Rejects (Welcome, 29, 40)
         and then Rejects (Welcome, 57, 88));
      Bad (25) := 16#20#;
      Facts.Check
        ("a name with a blank is broken", Heard (Bad).Kind = Broken);
      Facts.Check
        ("a bus state that does not fit its counters is broken",
         Rejects (State, 2, 8) and then Rejects (State, 17, 22)
         and then Rejects (State, 25, 88));
      Facts.Check
        ("what a confirmation does not have is broken",
         Rejects (Confirmation, 2, 8)
         and then Rejects (Confirmation, 21, 88));
      Facts.Check
        ("what a status does not have is broken",
         Rejects (Refusal, 2, 3) and then Rejects (Refusal, 5, 16)
         and then Rejects (Refusal, 21, 88));
      Facts.Check
        ("what a frame does not have is broken",
         Rejects (Frame_Heard, 4, 4) and then Rejects (Frame_Heard, 7, 8)
         and then Rejects (Frame_Heard, 17, 24)
         and then Rejects (Frame_Heard, 28, 88));
   end Check_Broken_Answers;

   ------------------
   -- Check_A_Life --
   ------------------

   procedure Check_A_Life is
      M       : Member;
      Then_Do : Consequence;
      Number  : Request_Number;
      First   : Request_Number;
      Lost    : Open_Count;
   begin
      Facts.Check
        ("who has not joined is stopped and asks for nothing",
         State (M) = Stopped and then not May_Ask (M));
      Hear (M, Heard (Welcome), Then_Do);
      Facts.Check
        ("who is welcome is active",
         Then_Do = Note_Joined and then State (M) = Error_Active);
      M.Last := Request_Number'Last;
      for I in 1 .. Most_Open loop
         Facts.Check ("request" & I'Image & " may be made", May_Ask (M));
         Ask (M, Number);
         if I = 1 then
            First := Number;
         end if;
      end loop;
      Facts.Check
        ("numbers go on behind the last one", First = 1
         and then Number = Request_Number (Most_Open));
      Facts.Check ("no more may be made", not May_Ask (M));
      Hear (M, (Kind => Confirmed, Number => 3, others => <>), Then_Do);
      Facts.Check
        ("a confirmation closes its request and no other",
         Then_Do = Count_Sent
         and then not Is_Open (M, 3) and then Is_Open (M, 2)
         and then Is_Open (M, 4) and then Is_Open (M, Number)
         and then May_Ask (M));
      Hear (M, (Kind => Refused, Number => First, others => <>), Then_Do);
      Facts.Check
        ("what is refused is lost",
         Then_Do = Count_Lost and then not Is_Open (M, First));
      Hear (M, Told (128, 3), Then_Do);
      Facts.Check
        ("an error-passive node goes on",
         Then_Do = Note_State and then State (M) = Error_Passive
         and then May_Ask (M) and then M.Receive_Errors = 3);
      Hear (M, Told (256, 0), Then_Do);
      Facts.Check
        ("a node that is bus-off waits for its recovery",
         Then_Do = Note_State and then State (M) = Bus_Off
         and then not May_Ask (M));
      Leave (M, Lost);
      Facts.Check
        ("with the server goes what was open",
         State (M) = Stopped and then Lost = Most_Open - 2
         and then M.Transmit_Errors = 0);
   end Check_A_Life;

   -------------------------
   -- Check_Wrong_Answers --
   -------------------------

   procedure Check_Wrong_Answers is
      M       : Member;
      Then_Do : Consequence;
      Right   : Boolean := True;
   begin
      for Kind in Answer_Kind loop
         if Kind /= Taken_In then
            Hear (M, (Kind => Kind, Number => 2, others => <>), Then_Do);
            Right := Right
              and then Then_Do
                = (if Kind = Closed then End_Connection else Break_Off);
         end if;
      end loop;
      Facts.Check ("a welcome comes first", Right);
      Hear (M, Heard (Welcome), Then_Do);
      Hear (M, Heard (Welcome), Then_Do);
      Right := Then_Do = Break_Off;
      Hear (M, (Kind => Confirmed, Number => 2, others => <>), Then_Do);
      Facts.Check
        ("it comes once, and nothing is confirmed that nobody asked for",
         Right and then Then_Do = Break_Off);
   end Check_Wrong_Answers;

begin
   Check_Requests;
   Check_Answers;
   Check_Broken_Answers;
   Check_A_Life;
   Check_Wrong_Answers;
   Facts.Finish;
end Test_Bus_Members;
