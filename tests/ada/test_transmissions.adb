--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Transmission modes: every sequence of values up to a length, in each mode,
--  with each minimum delay and period, compared with the definitions.

with Facts;
with Interfaces;
with Ravenchart;
with Ravenchart.Can;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Transmissions;

procedure Test_Transmissions is
   use Ravenchart.Can.Transmissions;
   use type Ravenchart.Execution_Count;

   Length : constant := 7;
   --  The number of executions of the row.

   subtype Choice is Natural range 0 .. 3;
   --  In an execution the row sends nothing, value 0, or value 1; with 3 it
   --  sends value 1, and the controller has no room.

   type Choice_List is array (1 .. Length) of Choice;

   function Frame_With
     (Value : Natural) return Ravenchart.Can.Any_Frames.Any_Frame
   is (Ravenchart.Can.Any_Frames.Whole_Frame
         (16#100#,
          Ravenchart.Can.Standard,
          1,
          Interfaces.Unsigned_64 (Value)));

   function Sequence (Number : Natural) return Choice_List;
   --  The sequence with this number, from 0.

   function Follows (Given : Choice_List; S : Setting) return Boolean;
   --  Does the sender send in the executions that the definitions name?

   --------------
   -- Sequence --
   --------------

   function Sequence (Number : Natural) return Choice_List is
      Left   : Natural := Number;
      Result : Choice_List;
   begin
      for Item of Result loop
         Item := Left mod 4;
         Left := Left / 4;
      end loop;
      return Result;
   end Sequence;

   -------------
   -- Follows --
   -------------

   function Follows (Given : Choice_List; S : Setting) return Boolean is
      State : Sender;
      Last  : Natural := 0;
      --  The execution of the last frame, from 1; 0: none yet.
      Sent  : Natural := 0;
      --  The value of that frame.
      Value : Natural := 0;
      Known : Boolean := False;
      Asked : Boolean := False;
      Due   : Boolean;
      Right : Boolean := True;
   begin
      for Now in Given'Range loop
         if Given (Now) > 0 then
            Value := (if Given (Now) = 1 then 0 else 1);
            Known := True;
            Asked := True;
            Give (State);
         end if;
         Count (State);
         Due :=
           Known
           and then
             (Last = 0
              or else
                (Now - Last >= Natural (S.Minimum)
                 and then
                   (case S.Mode is
                      when On_Change => Value /= Sent,
                      when On_Event  => Asked,
                      when Mixed     =>
                        Value /= Sent
                        or else Now - Last >= Natural (S.Period))));
         Right := Right and then Is_Due (State, S, Frame_With (Value)) = Due;
         if Due and then Given (Now) /= 3 then
            Record_Sent (State, Frame_With (Value));
            Last  := Now;
            Sent  := Value;
            Asked := False;
         end if;
      end loop;
      return Right;
   end Follows;

begin
   for Mode in Transmission_Mode loop
      declare
         Wrong : Natural := 0;
      begin
         for Number in 0 .. 4**Length - 1 loop
            for Minimum in Distance range 1 .. 3 loop
               for Period in Minimum .. 4 loop
                  if not Follows
                           (Sequence (Number), (Mode, Minimum, Period))
                  then
                     Wrong := Wrong + 1;
                  end if;
               end loop;
            end loop;
         end loop;
         Facts.Check
           ("mode " & Mode'Image & " sends when its definition says:"
            & Wrong'Image, Wrong = 0);
      end;
   end loop;
   declare
      State : Sender;
   begin
      Give (State);
      Record_Sent (State, Frame_With (0));
      State.Since := Ravenchart.Execution_Count'Last;
      Count (State);
      Facts.Check
        ("a count of executions stays at its last value",
         State.Since = Ravenchart.Execution_Count'Last);
   end;
   Facts.Finish;
end Test_Transmissions;
