--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  End-to-end protection: error patterns one by one, and faults of the bus
--  between sender and receiver.
--
--  The first argument is the number of faults of each kind, 10 by default.
--  From 1_000 on the error patterns have three bits where the profile finds as
--  many, else two. With "print" as the argument: protected frames of every
--  setting, a line each, for a comparison with another implementation.

with Ada.Text_IO;
with Facts;
with Hex_Frames;
with Interfaces;
with Random_Numbers;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Protection;
with Trials;

procedure Test_Protection is
   use Interfaces;
   use Random_Numbers;
   use Ravenchart.Can;
   use Ravenchart.Can.Any_Frames;
   use Ravenchart.Can.Protection;

   Base : constant Frame_Format := Ravenchart.Can.Standard;

   Ids : constant Id_List :=
     (16#01#, 16#D3#, 16#2A#, 16#97#, 16#6C#, 16#45#, 16#B8#, 16#0F#,
      16#E1#, 16#72#, 16#5D#, 16#C4#, 16#39#, 16#A6#, 16#8B#, 16#F0#);

   Settings : constant array (Positive range <>) of Setting :=
     ((Profile_1, Both, 16#0123#, Ids, 8, 1, 1),
      (Profile_1, Alternating, 16#0123#, Ids, 8, 2, 1),
      (Profile_1, Nibble, 16#0123#, Ids, 8, 3, 2),
      (Profile_2, Both, 0, Ids, 8, 2, 1),
      (Profile_5, Both, 16#1234#, Ids, 8, 5, 1),
      (Profile_11, Both, 16#0123#, Ids, 6, 1, 3),
      (Profile_11, Nibble, 16#0123#, Ids, 8, 4, 1),
      (Profile_5, Both, 16#FEDC#, Ids, 64, 1, 1),
      (Profile_2, Both, 0, Ids, 12, 3, 1),
      (Profile_11, Both, 16#0123#, Ids, 24, 2, 1));

   function Found_Bits (P : Profile) return Positive
   is (if P in Profile_1 | Profile_11 then 2 else 3);
   --  The number of wrong bits that the CRC always finds in frames of these
   --  lengths, except bits of a counter on which the data identifier depends.

   function Is_Tied (S : Setting; Bit : Natural) return Boolean
   is (Bit in 8 .. 11
       and then
         (S.Kind = Profile_2
          or else (S.Kind = Profile_1 and then S.Mode = Alternating)));
   --  Is it a bit of the counter, and does the data identifier depend on the
   --  counter?

   type Fault is
     (Corruption, Repetition, Loss, Insertion, Delayed, Resequencing,
      Masquerade);
   --  IEC 61784-3: corruption, unintended repetition, loss, insertion,
   --  unacceptable delay, incorrect sequence, masquerade.

   function Blank (S : Setting; Value : Unsigned_64) return Any_Frame
   is (if S.Length <= 8
       then To_Any (Data_Frame (16#100#, Base, S.Length, Value))
       else
         To_Any
           (Fd_Frames.Fd_Data_Frame
              (16#100#, Base, S.Length,
               Fd_Frames.Fd_Words'
                 (0      => Value,
                  others =>
                    (if S.Length = 64 then Value else 0)),
               Fd_Frames.Constant_Rate)));
   --  A frame before it is protected.

   procedure Flip (F : in out Any_Frame; Bit : Natural);
   --  Invert a bit of the data.

   function Image (S : Setting) return String
   is (Profile'Image (S.Kind) & " " & Id_Mode'Image (S.Mode)
       & Natural'Image (S.Length));

   procedure Check_Examples;
   --  The examples of PRS_E2EProtocol: all data 0, two frames.

   procedure Check_Statuses;
   --  The condition of each status.

   procedure Check_Patterns (S : Setting; Bits : Positive);
   --  All errors of one bit to so many bits, 3 at most.

   procedure Check_Faults (S : Setting; Kind : Fault; Times : Positive);
   --  Faults of one kind, with six good frames or more between them.

   procedure Check_Noise (S : Setting; Times : Positive);
   --  Frames of random data.

   procedure Print;

   ----------
   -- Flip --
   ----------

   procedure Flip (F : in out Any_Frame; Bit : Natural) is
   begin
      if F.Family = Classic then
         F.Plain.Bits := F.Plain.Bits xor Shift_Left (1, Bit);
      else
         F.Fd.Bytes (Bit / 8) :=
           F.Fd.Bytes (Bit / 8) xor Shift_Left (1, Bit mod 8);
      end if;
   end Flip;

   --------------------
   -- Check_Examples --
   --------------------

   procedure Check_Examples is
      procedure Hold (Fact : String; S : Setting; First, Next : Unsigned_64);

      procedure Hold (Fact : String; S : Setting; First, Next : Unsigned_64)
      is
         State : Sender;
         Frame : Any_Frame := Blank (S, 0);
         Right : Boolean;
      begin
         Protect (State, S, Frame);
         Right := Payload (Frame) = First;
         Frame := Blank (S, 0);
         Protect (State, S, Frame);
         Facts.Check (Fact, Right and then Payload (Frame) = Next);
      end Hold;

      Id : constant := 16#0123#;
   begin
      Hold ("profile 1A", (Profile_1, Both, Id, Ids, 8, 1, 1),
            16#00CC#, 16#0191#);
      Hold ("profile 1B", (Profile_1, Alternating, Id, Ids, 8, 1, 1),
            16#00CE#, 16#0102#);
      Hold ("profile 1C", (Profile_1, Nibble, Id, Ids, 8, 1, 1),
            16#102A#, 16#1177#);
      Hold ("profile 2",
            (Profile_2, Both, 0,
             (1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16),
             8, 1, 1),
            16#000E#, 16#011B#);
      Hold ("profile 5", (Profile_5, Both, 16#1234#, Ids, 8, 1, 1),
            16#00CA1C#, 16#018DCF#);
      Hold ("profile 11A", (Profile_11, Both, Id, Ids, 8, 1, 1),
            16#00CC#, 16#0191#);
      Hold ("profile 11C", (Profile_11, Nibble, Id, Ids, 8, 1, 1),
            16#102A#, 16#1177#);
   end Check_Examples;

   --------------------
   -- Check_Statuses --
   --------------------

   procedure Check_Statuses is
      S     : constant Setting := (Profile_1, Both, 7, Ids, 8, 2, 2);
      State : Receiver;
      Right : Boolean := True;

      procedure Next (Count : Counter_Value; Expected : Status);

      procedure Next (Count : Counter_Value; Expected : Status) is
         Found : Status;
      begin
         Check
           (State, S, Protected_Frame (Blank (S, 16#AB0000#), S, Count),
            Found);
         Right := Right and then Found = Expected;
      end Next;
   begin
      Next (3, Initial);
      Next (4, Synchronizing);
      Next (5, Ok);
      Next (7, Ok_Some_Lost);
      Next (7, Repeated);
      Next (8, Ok);
      Next (11, Wrong_Sequence);
      Next (12, Synchronizing);
      Next (14, Ok_Some_Lost);
      Next (0, Ok);
      Next (14, Wrong_Sequence);
      Facts.Check ("statuses by the counter", Right);

      declare
         Before : constant Receiver := State;
         Other  : Setting := S;
         Found  : Status;
      begin
         Other.Data_Id := 8;
         Check
           (State, S, Protected_Frame (Blank (S, 16#AB0000#), Other, 0),
            Found);
         Facts.Check
           ("another data identifier is an error", Found = Error);
         Check
           (State, S,
            To_Any (Remote_Frame (16#100#, Base, 8)), Found);
         Facts.Check ("a remote frame is an error", Found = Error);
         Check
           (State, S,
            To_Any (Data_Frame (16#100#, Base, 7, 0)), Found);
         Facts.Check ("a shorter frame is an error", Found = Error);
         Facts.Check
           ("an error leaves what is known", State = Before);
      end;
   end Check_Statuses;

   --------------------
   -- Check_Patterns --
   --------------------

   procedure Check_Patterns (S : Setting; Bits : Positive) is
      Sound  : constant Any_Frame :=
        Protected_Frame (Blank (S, Random), S, 5);
      Last   : constant Natural := 8 * S.Length - 1;
      Missed : Natural := 0;
   begin
      for A in 0 .. Last loop
         for B in A .. Last loop
            for C in B .. (if A = B or else Bits < 3 then B else Last) loop
               declare
                  Wrong : Any_Frame := Sound;
               begin
                  Flip (Wrong, A);
                  if B > A then
                     Flip (Wrong, B);
                  end if;
                  if C > B then
                     Flip (Wrong, C);
                  end if;
                  if not (Is_Tied (S, A)
                          or else Is_Tied (S, B)
                          or else Is_Tied (S, C))
                    and then Is_Intact (Wrong, S)
                  then
                     Missed := Missed + 1;
                  end if;
               end;
            end loop;
         end loop;
      end loop;
      Facts.Check
        ("all errors of few bits are found: " & Image (S), Missed = 0);
   end Check_Patterns;

   ------------------
   -- Check_Faults --
   ------------------

   procedure Check_Faults (S : Setting; Kind : Fault; Times : Positive) is
      Room : constant Positive :=
        Positive'Min
          (20, Integer (Last_Counter (S.Kind)) - Integer (S.Max_Delta));
      --  The oldest age at which the counter identifies a frame.

      Old     : array (0 .. 20) of Any_Frame;
      Sent    : Natural := 0;
      To      : Sender;
      From    : Receiver;
      Used    : Natural := 0;
      Wrong   : Natural := 0;
      Newest  : Natural := 0;

      procedure Make;
      --  The next frame of the sender: Old (Sent mod 21). Its data hold its
      --  number.

      procedure Arrive (F : Any_Frame; Number : Natural);
      --  The frame arrives. Number is 0 for a frame that may never be used.

      ----------
      -- Make --
      ----------

      procedure Make is
      begin
         Sent := Sent + 1;
         Old (Sent mod Old'Length) :=
           Blank (S, Shift_Left (Unsigned_64 (Sent), 24));
         Protect (To, S, Old (Sent mod Old'Length));
      end Make;

      ------------
      -- Arrive --
      ------------

      procedure Arrive (F : Any_Frame; Number : Natural) is
         Result : Status;
      begin
         Check (From, S, F, Result);
         if Result in Usable then
            Used := Used + 1;
            if Number <= Newest then
               Wrong := Wrong + 1;
            end if;
            Newest := Natural'Max (Newest, Number);
         end if;
      end Arrive;
   begin
      for I in 1 .. Times loop
         for J in 1 .. Random (6, 9) + (if I = 1 then 20 else 0) loop
            Make;
            Arrive (Old (Sent mod Old'Length), Sent);
         end loop;
         case Kind is
            when Corruption   =>
               Make;
               declare
                  Frame : Any_Frame := Old (Sent mod Old'Length);
                  First : constant Natural := Random (0, 8 * S.Length - 3);
                  Next  : constant Natural :=
                    Random (First + 1, 8 * S.Length - 1);
               begin
                  if not Is_Tied (S, First) then
                     Flip (Frame, First);
                  end if;
                  if Random (0, 1) = 1 and then not Is_Tied (S, Next) then
                     Flip (Frame, Next);
                  end if;
                  if Frame /= Old (Sent mod Old'Length) then
                     Arrive (Frame, 0);
                  end if;
               end;
            when Repetition   =>
               for J in 1 .. Random (1, 3) loop
                  Arrive (Old (Sent mod Old'Length), 0);
               end loop;
            when Loss         =>
               for J in 1 .. Random (1, 30) loop
                  Make;
               end loop;
            when Insertion    =>
               Arrive
                 (Old ((Sent - Random (1, Room)) mod Old'Length), 0);
            when Delayed      =>
               Make;
               declare
                  Number : constant Positive := Sent;
                  Frame  : constant Any_Frame := Old (Sent mod Old'Length);
               begin
                  for J in 1 .. Random (1, Room) loop
                     Make;
                     Arrive (Old (Sent mod Old'Length), Sent);
                  end loop;
                  Arrive (Frame, Number);
               end;
            when Resequencing =>
               Make;
               Make;
               Arrive (Old (Sent mod Old'Length), Sent);
               Arrive (Old ((Sent - 1) mod Old'Length), Sent - 1);
            when Masquerade   =>
               declare
                  Other : Setting := S;
               begin
                  Other.Data_Id :=
                    S.Data_Id xor Unsigned_16 (Random (1, 255));
                  Other.Ids (To.Next and 15) :=
                    S.Ids (To.Next and 15) xor Unsigned_8 (Random (1, 255));
                  if S.Mode = Alternating then
                     Other.Data_Id := Other.Data_Id xor 16#5500#;
                  end if;
                  Arrive
                    (Protected_Frame
                       (Blank (S, Random), Other, To.Next),
                     0);
               end;
         end case;
      end loop;
      Facts.Check
        (Fault'Image (Kind) & ": nothing wrong is used, the rest is: "
         & Image (S),
         Wrong = 0 and then Used >= 2 * Times);
   end Check_Faults;

   -----------------
   -- Check_Noise --
   -----------------

   procedure Check_Noise (S : Setting; Times : Positive) is
      State  : constant Receiver := (True, 3, 0);
      Passed : Natural := 0;
   begin
      for I in 1 .. Times loop
         if Status_Of (State, S, Blank (S, Random)) in Usable then
            Passed := Passed + 1;
         end if;
      end loop;
      --  One of 256 has the right CRC, and of these Max_Delta of 16 counters
      --  fit; three times that number is practically impossible.
      Facts.Check
        ("of random frames no more are used than the bound says: "
         & Image (S),
         Passed
         <= 3 * (Times / 4096 + 1) * Natural (S.Max_Delta));
   end Check_Noise;

   -----------
   -- Print --
   -----------

   procedure Print is
   begin
      for Index in Settings'Range loop
         declare
            S     : constant Setting := Settings (Index);
            State : Sender;
         begin
            for I in 1 .. 300 loop
               declare
                  Frame : Any_Frame := Blank (S, Random);
               begin
                  Protect (State, S, Frame);
                  Ada.Text_IO.Put_Line
                    (Profile'Image (S.Kind) & " " & Id_Mode'Image (S.Mode)
                     & Unsigned_16'Image (S.Data_Id) & " "
                     & Hex_Frames.Image (Frame, S.Length));
               end;
            end loop;
         end;
      end loop;
   end Print;

begin
   if Trials.Prints then
      Print;
      return;
   end if;
   Check_Examples;
   Check_Statuses;
   for S of Settings loop
      for Kind in Fault loop
         Check_Faults (S, Kind, Trials.Times);
      end loop;
      if S.Length <= 8 then
         Check_Patterns
           (S, (if Trials.Times >= 1_000 then Found_Bits (S.Kind) else 2));
         Check_Noise (S, 100 * Trials.Times);
      end if;
   end loop;
   Facts.Finish;
end Test_Protection;
