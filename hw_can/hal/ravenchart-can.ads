--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Classic CAN frames, and the types that every controller shares.
--
--  Guarantees   the identifier of a Frame fits its format; Payload is 0 in
--               the bits beyond its length, and as a whole in a remote frame
--  Tasking      none: frames are values
--  Timing       constant

with Interfaces;

package Ravenchart.Can
  with SPARK_Mode, Pure
is
   use type Interfaces.Unsigned_64;

   type Frame_Format is (Standard, Extended);
   --  11 or 29 bits of identifier.

   type Frame_Kind is (Data, Remote);
   --  A remote frame requests data and carries none.

   type Identifier is range 0 .. 2**29 - 1;
   --  The smaller one wins arbitration, among frames of one format.

   subtype Standard_Identifier is Identifier range 0 .. 2**11 - 1;
   --  An identifier that fits the standard format.

   subtype Data_Length is Natural range 0 .. 8;
   --  Bytes in a classic frame.

   subtype Byte_Index is Data_Length range 0 .. 7;
   --  Byte 0 goes over the bus first.

   function Mask (Length : Data_Length) return Interfaces.Unsigned_64
   is (case Length is
         when 0 => 0,
         when 1 => 16#FF#,
         when 2 => 16#FFFF#,
         when 3 => 16#FF_FFFF#,
         when 4 => 16#FFFF_FFFF#,
         when 5 => 16#FF_FFFF_FFFF#,
         when 6 => 16#FFFF_FFFF_FFFF#,
         when 7 => 16#FF_FFFF_FFFF_FFFF#,
         when 8 => 16#FFFF_FFFF_FFFF_FFFF#)
   with Global => null;
   --  The bits that so many bytes can hold.

   function Fits (Id : Identifier; Format : Frame_Format) return Boolean
   is (Format = Extended or else Id in Standard_Identifier)
   with Global => null;
   --  Can a frame of this format carry Id?

   type Frame is record
      Id     : Identifier := 0;
      Format : Frame_Format := Standard;
      Kind   : Frame_Kind := Data;
      Length : Data_Length := 0;
      Bits   : Interfaces.Unsigned_64 := 0;
   end record
   with Predicate => Fits (Id, Format);
   --  Bits holds the data: byte 0 in the lowest eight bits, and so on, on
   --  every machine; read it by Payload or Byte. Length of a remote frame is
   --  the length that it requests.

   Null_Frame : constant Frame := (others => <>);
   --  Fills a place without a frame.

   function Payload (F : Frame) return Interfaces.Unsigned_64
   is (if F.Kind = Data then F.Bits and Mask (F.Length) else 0)
   with Global => null;
   --  The data as one word, byte 0 lowest; 0 beyond the length.

   function Byte (F : Frame; Index : Byte_Index) return Interfaces.Unsigned_8
   is (Interfaces.Unsigned_8
         (Interfaces.Shift_Right (Payload (F), 8 * Index) and 16#FF#))
   with Global => null;
   --  One byte of the data; 0 beyond the length.

   function Data_Frame
     (Id      : Identifier;
      Format  : Frame_Format;
      Length  : Data_Length;
      Payload : Interfaces.Unsigned_64) return Frame
   is ((Id     => Id,
        Format => Format,
        Kind   => Data,
        Length => Length,
        Bits   => Payload and Mask (Length)))
   with
     Global => null,
     Pre    => Fits (Id, Format),
     Post   =>
       Can.Payload (Data_Frame'Result) = (Payload and Mask (Length));
   --  A data frame; bits of Payload beyond Length are not carried.

   function Remote_Frame
     (Id     : Identifier;
      Format : Frame_Format;
      Length : Data_Length) return Frame
   is ((Id     => Id,
        Format => Format,
        Kind   => Remote,
        Length => Length,
        Bits   => 0))
   with
     Global => null,
     Pre    => Fits (Id, Format);
   --  A request for Length bytes of data.

   type Bits_Per_Second is range 0 .. 20_000_000;

   subtype Nominal_Rate is Bits_Per_Second range 1 .. 1_000_000;

   type Recovery_Policy is (Automatic, On_Request);
   --  The origin of the request to leave bus-off: the driver at once, or a
   --  caller of Request_Recovery. ISO 11898-1: the controller is back when it
   --  has seen 128 sequences of 11 recessive bits since.

   type Bus_Setting is record
      Bit_Rate  : Nominal_Rate := 500_000;
      Data_Rate : Bits_Per_Second := 0;
      Takes_Fd  : Boolean := False;
      Recovery  : Recovery_Policy := Automatic;
   end record;
   --  The configuration of a controller. Data_Rate: the bit rate of the data
   --  phase, 0 where no frame switches. Takes_Fd: the bus carries CAN FD
   --  frames. Recovery: the way out of bus-off.

   subtype Bus_Place is Positive range 1 .. 8;
   --  A bus of a node, by its place among them.

   type Send_Status is (Queued, Rejected_Full);
   --  The outcome of handing a frame to a controller.

   type Controller_State is (Stopped, Error_Active, Error_Passive, Bus_Off);
   --  Stopped: not connected to a bus; the others as in ISO 11898-1.

   type Error_Count is range 0 .. 256;
   --  An error counter of the controller; 256 means bus-off.

   type Counters is record
      Sent            : Event_Count := 0;
      Received        : Event_Count := 0;
      Lost_Out        : Event_Count := 0;
      Lost_In         : Event_Count := 0;
      Rejected_Lines  : Event_Count := 0;
      Transmit_Errors : Error_Count := 0;
      Receive_Errors  : Error_Count := 0;
   end record;
   --  Received counts accepted frames, also those lost for want of room;
   --  Lost_Out counts rejected frames, and frames sent while not connected.

end Ravenchart.Can;
