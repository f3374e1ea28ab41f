--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Both ends of ISO-TP on a line: the interoperation test gives it frames and
--  the progress of time, and it answers with frames and values.
--
--  iso_tp_line LENGTH BLOCK, then a command a line:
--    G HEX   give the sender a value
--    R HEX   a frame has come
--    T       the row has ended an execution, 1 ms after the last one
--  Answers: S HEX a frame to send, V HEX a value, E FAULT, and a dot.

with Ada.Command_Line;
with Ada.Text_IO;
with Interfaces;
with Ravenchart;
with Ravenchart.Can;
with Ravenchart.Can.Iso_Tp;
with Ravenchart.Can.Iso_Tp.Receivers;
with Ravenchart.Can.Iso_Tp.Senders;

procedure Iso_Tp_Line is
   use Ravenchart.Can.Iso_Tp;
   use Ravenchart.Can.Iso_Tp.Receivers;
   use Ravenchart.Can.Iso_Tp.Senders;
   use type Interfaces.Unsigned_64;
   use type Interfaces.Unsigned_8;
   use type Ravenchart.Event_Count;
   use type Ravenchart.Nanoseconds;

   S     : Senders.Setting;
   R     : Receivers.Setting;
   From  : Sender;
   To    : Receiver;
   Flow  : Flow_Notice;
   Fault : Transfer_Fault;
   Now   : Ravenchart.Nanoseconds := 0;

   procedure Put (Lead : Character; Item : Value_Bytes; Length : Byte_Count);

   procedure Put_Frame (Payload : Interfaces.Unsigned_64);

   procedure Take_Frame (Item : Value_Bytes; Length : Natural);

   function Bytes_In (Text : String) return Value_Bytes;

   ---------
   -- Put --
   ---------

   procedure Put (Lead : Character; Item : Value_Bytes; Length : Byte_Count)
   is
      Digit : constant String := "0123456789abcdef";
      Text  : String (1 .. 2 * Length);
   begin
      for I in 0 .. Length - 1 loop
         Text (2 * I + 1) := Digit (1 + Natural (Item (I) / 16));
         Text (2 * I + 2) := Digit (1 + Natural (Item (I) mod 16));
      end loop;
      Ada.Text_IO.Put_Line (Lead & " " & Text);
   end Put;

   ---------------
   -- Put_Frame --
   ---------------

   procedure Put_Frame (Payload : Interfaces.Unsigned_64) is
      Bytes : Value_Bytes := (others => 0);
   begin
      for I in Ravenchart.Can.Byte_Index loop
         Bytes (I) := Octet_Of (Payload, I);
      end loop;
      Put ('S', Bytes, 8);
   end Put_Frame;

   --------------
   -- Bytes_In --
   --------------

   function Bytes_In (Text : String) return Value_Bytes is
      Result : Value_Bytes := (others => 0);
   begin
      for I in 0 .. Text'Length / 2 - 1 loop
         Result (I) :=
           Octet'Value
             ("16#" & Text (Text'First + 2 * I .. Text'First + 2 * I + 1)
              & "#");
      end loop;
      return Result;
   end Bytes_In;

   ----------------
   -- Take_Frame --
   ----------------

   procedure Take_Frame (Item : Value_Bytes; Length : Natural) is
      Payload : Interfaces.Unsigned_64 := 0;
      Found   : Segment;
      Result  : Outcome;
      Reply   : Answer;
   begin
      for I in 0 .. Length - 1 loop
         Payload :=
           Payload
           or Interfaces.Shift_Left
                (Interfaces.Unsigned_64 (Item (I)), 8 * I);
      end loop;
      Found := Decoded (Payload, Length);
      if Found.Kind = Flow_Control then
         Flow :=
           (Flow.Count + 1, Found.Status, Found.Block, Found.Separation);
         return;
      end if;
      Take (To, R, Payload, Length, Now, Result, Reply);
      if Reply /= No_Answer then
         Put_Frame
           (Flow_Payload
              ((if Reply = Refuse then Overflow else Continue_To_Send),
               R.Block,
               2));
      end if;
      if Result = Complete then
         Put ('V', To.Data, To.Got);
      elsif Result in Receivers.Fault then
         Ada.Text_IO.Put_Line ("E " & Result'Image);
      end if;
   end Take_Frame;

begin
   S :=
     (Length   => Value_Length'Value (Ada.Command_Line.Argument (1)),
      Distance => 1,
      Timeout  => 100,
      Waits    => 2,
      Row      => 1_000);
   R :=
     (Length   => S.Length,
      Block    => Block_Size'Value (Ada.Command_Line.Argument (2)),
      Timeout  => 10**9,
      Patience => 2 * 10**9);
   while not Ada.Text_IO.End_Of_File loop
      declare
         Line : constant String := Ada.Text_IO.Get_Line;
         Rest : constant String := Line (Line'First + 2 .. Line'Last);
      begin
         case Line (Line'First) is
            when 'G'    =>
               Give (From, Bytes_In (Rest));
            when 'R'    =>
               Take_Frame (Bytes_In (Rest), Rest'Length / 2);
            when others =>
               Now := Now + 1_000_000;
               Count (From, S, Flow, Fault);
               if Fault /= None then
                  Ada.Text_IO.Put_Line ("E " & Fault'Image);
               end if;
               if Is_Due (From, S) then
                  Put_Frame (Next_Segment (From, S));
                  Record_Sent (From, S);
               end if;
         end case;
         Ada.Text_IO.Put_Line (".");
         Ada.Text_IO.Flush;
      end;
   end loop;
end Iso_Tp_Line;
