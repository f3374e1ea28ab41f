--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Frames and error reports in the format of a raw CAN socket of Linux: struct
--  can_frame and struct canfd_frame of linux/can.h, and the error classes of
--  linux/can/error.h.
--
--  Guarantees   a frame that is converted there and back is the same; every
--               item of a socket has a meaning
--  Tasking      none: values
--  Timing       constant

with Interfaces;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;

package Ravenchart.Can.Socket_Frames
  with SPARK_Mode, Pure
is
   use type Interfaces.Unsigned_8;
   use type Interfaces.Unsigned_32;

   use type Fd_Frames.Bit_Rate_Use;
   use type Fd_Frames.Sender_State;

   type Data_Bytes is array (Fd_Frames.Fd_Index) of Interfaces.Unsigned_8
   with Convention => C;
   --  Byte 0 goes over the bus first.

   type Item is record
      Id       : Interfaces.Unsigned_32 := 0;
      Length   : Interfaces.Unsigned_8 := 0;
      Flags    : Interfaces.Unsigned_8 := 0;
      Reserved : Interfaces.Unsigned_8 := 0;
      Raw_Dlc  : Interfaces.Unsigned_8 := 0;
      Data     : Data_Bytes := (others => 0);
   end record
   with Convention => C;
   --  struct canfd_frame: 72 bytes, Id in the order of the machine. Unless
   --  Flags has the bit of CAN FD, the first 16 are a struct can_frame.

   Switch_Flag  : constant Interfaces.Unsigned_8 := 1;
   Passive_Flag : constant Interfaces.Unsigned_8 := 2;
   Fd_Flag      : constant Interfaces.Unsigned_8 := 4;
   --  CANFD_BRS, CANFD_ESI and CANFD_FDF, within Flags.

   Extended_Flag : constant Interfaces.Unsigned_32 := 16#8000_0000#;
   Remote_Flag   : constant Interfaces.Unsigned_32 := 16#4000_0000#;
   Error_Flag    : constant Interfaces.Unsigned_32 := 16#2000_0000#;
   --  CAN_EFF_FLAG, CAN_RTR_FLAG and CAN_ERR_FLAG, within Id.

   Extended_Bits : constant Interfaces.Unsigned_32 := 16#1FFF_FFFF#;
   Standard_Bits : constant Interfaces.Unsigned_32 := 16#7FF#;
   --  CAN_EFF_MASK and CAN_SFF_MASK.

   function Is_Error (I : Item) return Boolean
   is ((I.Id and Error_Flag) /= 0)
   with Global => null;
   --  Is it an error report, not a frame of the bus?

   function Is_Fd (I : Item) return Boolean
   is ((I.Flags and Fd_Flag) /= 0)
   with Global => null;
   --  Is it a CAN FD frame, not a classic one?

   function Is_Frame (I : Item) return Boolean
   is (not Is_Error (I)
       and then
         (if Is_Fd (I)
          then (I.Id and Remote_Flag) = 0
               and then Natural (I.Length) in Fd_Frames.Fd_Length
          else I.Length <= 8)
       and then ((I.Id and Extended_Flag) /= 0
                 or else (I.Id and Extended_Bits) <= Standard_Bits))
   with Global => null;
   --  Is it a frame of the bus?

   function Frame_Of (I : Item) return Frame
   with
     Global => null,
     Pre    => Is_Frame (I) and then not Is_Fd (I),
     Post   =>
       Frame_Of'Result.Length = Natural (I.Length)
       and then Frame_Of'Result.Id = Identifier (I.Id and Extended_Bits)
       and then (Frame_Of'Result.Format = Extended)
                = ((I.Id and Extended_Flag) /= 0)
       and then (Frame_Of'Result.Kind = Remote)
                = ((I.Id and Remote_Flag) /= 0)
       and then (if Frame_Of'Result.Kind = Data
                 then (for all B in Byte_Index =>
                         (if B < Frame_Of'Result.Length
                          then Byte (Frame_Of'Result, B) = I.Data (B))));
   --  The classic frame that was received.

   function Fd_Frame_Of (I : Item) return Fd_Frames.Fd_Frame
   with
     Global => null,
     Pre    => Is_Frame (I) and then Is_Fd (I),
     Post   =>
       Fd_Frame_Of'Result.Length = Natural (I.Length)
       and then Fd_Frame_Of'Result.Id = Identifier (I.Id and Extended_Bits)
       and then (Fd_Frame_Of'Result.Format = Extended)
                = ((I.Id and Extended_Flag) /= 0)
       and then (Fd_Frame_Of'Result.Rate = Fd_Frames.Switched_Rate)
                = ((I.Flags and Switch_Flag) /= 0)
       and then (Fd_Frame_Of'Result.Sender = Fd_Frames.Passive_Sender)
                = ((I.Flags and Passive_Flag) /= 0)
       and then
         (for all B in Fd_Frames.Fd_Index =>
            Fd_Frames.Byte (Fd_Frame_Of'Result, B)
            = (if B < Fd_Frame_Of'Result.Length then I.Data (B) else 0));
   --  The CAN FD frame that was received.

   function Any_Frame_Of (I : Item) return Any_Frames.Any_Frame
   is (if Is_Fd (I)
       then Any_Frames.To_Any (Fd_Frame_Of (I))
       else Any_Frames.To_Any (Frame_Of (I)))
   with Global => null, Pre => Is_Frame (I);
   --  The frame that was received.

   function Item_Of (F : Frame) return Item
   with
     Global => null,
     Post   =>
       Is_Frame (Item_Of'Result)
       and then not Is_Fd (Item_Of'Result)
       and then Natural (Item_Of'Result.Length) = F.Length
       and then (Item_Of'Result.Id and Extended_Bits)
                = Interfaces.Unsigned_32 (F.Id)
       and then ((Item_Of'Result.Id and Extended_Flag) /= 0)
                = (F.Format = Extended)
       and then ((Item_Of'Result.Id and Remote_Flag) /= 0)
                = (F.Kind = Remote)
       and then (for all B in Byte_Index =>
                   Item_Of'Result.Data (B) = Byte (F, B));
   --  The item that sends F through the socket.

   function Item_Of (F : Fd_Frames.Fd_Frame) return Item
   with
     Global => null,
     Post   =>
       Is_Frame (Item_Of'Result)
       and then Is_Fd (Item_Of'Result)
       and then Natural (Item_Of'Result.Length) = F.Length
       and then (Item_Of'Result.Id and Extended_Bits)
                = Interfaces.Unsigned_32 (F.Id)
       and then ((Item_Of'Result.Id and Extended_Flag) /= 0)
                = (F.Format = Extended)
       and then ((Item_Of'Result.Flags and Switch_Flag) /= 0)
                = (F.Rate = Fd_Frames.Switched_Rate)
       and then ((Item_Of'Result.Flags and Passive_Flag) /= 0)
                = (F.Sender = Fd_Frames.Passive_Sender)
       and then (for all B in Fd_Frames.Fd_Index =>
                   Item_Of'Result.Data (B) = Fd_Frames.Byte (F, B));
   --  The item that sends F through the socket.

   function Item_Of (F : Any_Frames.Any_Frame) return Item
   is (case F.Family is
         when Any_Frames.Classic  => Item_Of (F.Plain),
         when Any_Frames.Flexible => Item_Of (F.Fd))
   with Global => null;
   --  The item that sends F through the socket.

   --  Error reports

   Bus_Off_Class    : constant Interfaces.Unsigned_32 := 16#40#;
   Restarted_Class  : constant Interfaces.Unsigned_32 := 16#100#;
   Controller_Class : constant Interfaces.Unsigned_32 := 16#4#;
   Counters_Class   : constant Interfaces.Unsigned_32 := 16#200#;
   --  CAN_ERR_BUSOFF, _RESTARTED, _CRTL and _CNT, within Id.

   Passive_Bits : constant Interfaces.Unsigned_8 := 16#30#;
   --  CAN_ERR_CRTL_RX_PASSIVE and _TX_PASSIVE, in byte 1.

   Active_Bits : constant Interfaces.Unsigned_8 := 16#4C#;
   --  CAN_ERR_CRTL_ACTIVE and the two warning levels, in byte 1: a
   --  controller that warns is error-active.

   function State_After
     (Report : Item; Now : Controller_State) return Controller_State
   is (if not Is_Error (Report)
       then Now
       elsif (Report.Id and Bus_Off_Class) /= 0
       then Bus_Off
       elsif (Report.Id and Restarted_Class) /= 0
       then Error_Active
       elsif (Report.Id and Controller_Class) /= 0
         and then (Report.Data (1) and Passive_Bits) /= 0
       then Error_Passive
       elsif (Report.Id and Controller_Class) /= 0
         and then (Report.Data (1) and Active_Bits) /= 0
       then Error_Active
       else Now)
   with Global => null;
   --  The state of the controller after an error report; a frame changes
   --  nothing.

   function Has_Counters (Report : Item) return Boolean
   is (Is_Error (Report) and then (Report.Id and Counters_Class) /= 0)
   with Global => null;
   --  Does the report have the error counters: transmit in byte 6, receive in
   --  7?

end Ravenchart.Can.Socket_Frames;
