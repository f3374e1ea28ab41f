--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Frames in the format of Linux, converted both ways, and error reports.

with Facts;
with Interfaces;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Socket_Frames;

procedure Test_Socket_Frames is
   use Ravenchart.Can;
   use type Interfaces.Unsigned_32;
   use type Interfaces.Unsigned_64;

   package Sockets renames Ravenchart.Can.Socket_Frames;

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   Bits : constant Interfaces.Unsigned_64 := 16#8877_6655_4433_2211#;

   function Survives (F : Frame) return Boolean;
   --  Is F unchanged after the conversion both ways?

   function Survives (F : Fd_Frames.Fd_Frame) return Boolean
   is (Sockets.Is_Frame (Sockets.Item_Of (F))
       and then Sockets.Is_Fd (Sockets.Item_Of (F))
       and then Fd_Frames."=" (Sockets.Fd_Frame_Of (Sockets.Item_Of (F)), F));
   --  Is F unchanged after the conversion both ways?

   function Report
     (Class                     : Interfaces.Unsigned_32;
      Detail, Transmit, Receive : Interfaces.Unsigned_8 := 0)
      return Sockets.Item;
   --  An error report of a driver of Linux.

   procedure Check_Lengths;

   procedure Check_States;

   --------------
   -- Survives --
   --------------

   function Survives (F : Frame) return Boolean is
      Item : constant Sockets.Item := Sockets.Item_Of (F);
      Back : Frame;
   begin
      if not Sockets.Is_Frame (Item) then
         return False;
      end if;
      Back := Sockets.Frame_Of (Item);
      return Back.Id = F.Id
        and then Back.Format = F.Format
        and then Back.Kind = F.Kind
        and then Back.Length = F.Length
        and then Payload (Back) = Payload (F);
   end Survives;

   ------------
   -- Report --
   ------------

   function Report
     (Class                     : Interfaces.Unsigned_32;
      Detail, Transmit, Receive : Interfaces.Unsigned_8 := 0)
      return Sockets.Item
   is ((Id     => Sockets.Error_Flag or Class,
        Length => 8,
        Data   => (1 => Detail, 6 => Transmit, 7 => Receive, others => 0),
        others => 0));

   -------------------
   -- Check_Lengths --
   -------------------

   procedure Check_Lengths is
      Good : Boolean := True;
   begin
      for Length in Data_Length loop
         Good := Good
           and then Survives (Data_Frame (16#7FF#, Base, Length, Bits))
           and then Survives (Data_Frame (0, Extended, Length, Bits))
           and then Survives (Remote_Frame (16#123#, Base, Length))
           and then Survives (Remote_Frame (2**29 - 1, Extended, Length));
      end loop;
      Facts.Check ("frames of every length come back", Good);
      Good := True;
      for Code in Fd_Frames.Length_Code loop
         for Rate in Fd_Frames.Bit_Rate_Use loop
            Good := Good
              and then Survives
                (Fd_Frames.Fd_Data_Frame
                   (16#7FF#, Base, Fd_Frames.Length_Of (Code),
                    Words => (others => Bits), Rate => Rate))
              and then Survives
                (Fd_Frames.Fd_Data_Frame
                   (2**29 - 1, Extended, Fd_Frames.Length_Of (Code),
                    Bytes  => (others => 16#A5#),
                    Rate   => Rate,
                    Sender => Fd_Frames.Passive_Sender));
         end loop;
      end loop;
      Facts.Check ("CAN FD frames of every length come back", Good);
   end Check_Lengths;

   ------------------
   -- Check_States --
   ------------------

   procedure Check_States is
      function After
        (Class  : Interfaces.Unsigned_32;
         Detail : Interfaces.Unsigned_8;
         Now    : Controller_State) return Controller_State
      is (Sockets.State_After (Report (Class, Detail), Now));
   begin
      Facts.Check
        ("bus-off is reported", After (16#40#, 0, Error_Active) = Bus_Off);
      Facts.Check
        ("a restart ends bus-off", After (16#100#, 0, Bus_Off) = Error_Active);
      Facts.Check
        ("either counter makes error-passive",
         After (16#4#, 16#10#, Error_Active) = Error_Passive
         and then After (16#4#, 16#20#, Error_Active) = Error_Passive);
      Facts.Check
        ("a warning is error-active",
         After (16#4#, 16#08#, Error_Passive) = Error_Active);
      Facts.Check
        ("a lost arbitration changes nothing",
         After (16#2#, 0, Error_Passive) = Error_Passive);
   end Check_States;

   Data : constant Sockets.Item :=
     Sockets.Item_Of (Data_Frame (16#18FF_00AA#, Extended, 8, Bits));
begin
   Facts.Check
     ("an extended frame has the words of linux/can.h",
      Data.Id = 16#98FF_00AA#
      and then Interfaces."=" (Data.Length, 8)
      and then Interfaces."=" (Data.Data (0), 16#11#)
      and then Interfaces."=" (Data.Data (7), 16#88#));
   Facts.Check
     ("a remote frame carries no data",
      Sockets.Item_Of (Remote_Frame (1, Base, 8)).Id = 16#4000_0001#);
   Facts.Check
     ("an error report is no frame", not Sockets.Is_Frame (Report (16#40#)));
   Facts.Check
     ("an identifier beyond its format is no frame",
      not Sockets.Is_Frame ((Id => 16#800#, others => <>)));
   Facts.Check
     ("the counters are seen where they are",
      Sockets.Has_Counters (Report (16#200#, 0, 96, 127))
      and then not Sockets.Has_Counters (Report (16#4#, 0, 96, 127)));
   Facts.Check
     ("a CAN FD frame of ten bytes, or one that asks, is no frame",
      not Sockets.Is_Frame
        ((Length => 10, Flags => Sockets.Fd_Flag, others => <>))
      and then not Sockets.Is_Frame
        ((Id => Sockets.Remote_Flag, Flags => Sockets.Fd_Flag,
          others => <>)));
   Check_Lengths;
   Check_States;
   Facts.Finish;
end Test_Socket_Frames;
