--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The records of the bus protocol (docs/bus-protocol.md): 88 bytes each, in
--  both directions.
--
--  Guarantees   reading is total: any bytes give a record that keeps every
--               rule of the page, or none; each field that a kind does not
--               have is 0
--  Tasking      none: records are values
--  Timing       constant

with Interfaces;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Fault_Confinement;

package Ravenchart.Can.Bus_Records
  with SPARK_Mode, Pure
is
   use type Interfaces.Unsigned_8;
   use type Interfaces.Unsigned_32;

   subtype Byte is Interfaces.Unsigned_8;

   type Octets is array (Positive range <>) of Byte;

   Record_Bytes : constant := 88;

   subtype Position is Positive range 1 .. Record_Bytes;
   --  A byte of a record. The page counts from 0.

   subtype Image is Octets (Position);
   --  One record as it goes over the wire.

   type Request_Kind is
     (Hello, Frame_Request, Recovery_Request, Broken, Wrong_Version);
   --  The kinds of records of a client; Broken is none of them.

   Version : constant := 1;

   subtype Bit_Rate is Interfaces.Unsigned_32;
   --  A bit rate in bit/s; 0 accepts that of the bus.

   Longest_Restart : constant := 600_000;
   --  The longest time in ms from bus-off to the request for recovery.

   type Request is record
      Kind      : Request_Kind := Broken;
      Takes_Fd  : Boolean := False;
      Nominal   : Bit_Rate := 0;
      Data      : Bit_Rate := 0;
      Number    : Interfaces.Unsigned_32 := 0;
      Frame     : Bus_Frames.Bus_Frame;
   end record;
   --  Takes_Fd and the rates belong to a hello, Number and Frame to a request.
   --  The Number of a hello is the restart delay in ms; 0 takes that of the
   --  bus.

   function Read (Bytes : Image) return Request
   with
     Global => null,
     Post   =>
       (case Read'Result.Kind is
          when Frame_Request => Read'Result.Number > 0,
          when Hello         => Read'Result.Number <= Longest_Restart,
          when others        => True);
   --  The content of a record of a client.

   type Status is
     (Version_Is_Wrong,
      Malformed,
      No_Room,
      Is_Bus_Off,
      Not_Supported,
      Wrong_Bit_Rate,
      Closing,
      No_Hello_In_Time);
   --  The codes 1 to 8.

   subtype Name_Length is Positive range 1 .. 16;

   function Is_Name (Text : String) return Boolean
   is (Text'Length in Name_Length
       and then (for all C of Text => C in '!' .. '~'))
   with Global => null;
   --  Is Text a valid name of a bus or a node?

   subtype Node_Number is Positive range 1 .. 255;
   --  The number of a node on the bus.

   function Welcome
     (Name    : String;
      With_Fd : Boolean;
      Nominal : Bit_Rate;
      Data    : Bit_Rate;
      Began   : Nanoseconds;
      Now     : Nanoseconds;
      Node    : Node_Number) return Image
   with
     Global => null,
     Pre    =>
       Is_Name (Name)
       and then Nominal <= 1_000_000
       and then Data <= 20_000_000;
   --  The answer to hello. Began: the time of bus time 0 in ns since 1970, or
   --  0 in virtual time.

   function Frame_Record
     (Frame : Bus_Frames.Bus_Frame; Now : Nanoseconds) return Image
   with Global => null;
   --  A frame or an error frame that came over the bus.

   function State_Record
     (Node : Fault_Confinement.Node; Now : Nanoseconds) return Image
   with Global => null;
   --  The bus state of a node.

   function Confirmation
     (Number : Interfaces.Unsigned_32; Now : Nanoseconds) return Image
   with Global => null, Pre => Number > 0;
   --  Confirms that this request was transmitted.

   function Refusal
     (Number : Interfaces.Unsigned_32; Why : Status) return Image
   with Global => null;
   --  Refuses this request; with number 0, the connection ends.

   function Error_Report
     (Identifier : Can.Identifier;
      Details    : Interfaces.Unsigned_64;
      Now        : Nanoseconds) return Image
   with Global => null;
   --  An error frame on the bus: class and details as in Linux's can/error.h.

private

   Mark : constant := 16#4E56_4152#;

   Extended_Flag : constant Byte := 1;
   Remote_Flag   : constant Byte := 2;
   Fd_Flag       : constant Byte := 4;
   Brs_Flag      : constant Byte := 8;
   Esi_Flag      : constant Byte := 16;

   Hello_Kind        : constant Byte := 1;
   Welcome_Kind      : constant Byte := 2;
   Frame_Kind_Code   : constant Byte := 3;
   Error_Kind        : constant Byte := 4;
   State_Kind        : constant Byte := 5;
   Confirmation_Kind : constant Byte := 6;
   Status_Kind       : constant Byte := 7;
   Recovery_Kind     : constant Byte := 8;

   --  The positions of the fields, from 1

   Kind_At     : constant := 1;
   Flags_At    : constant := 2;
   Length_At   : constant := 3;
   Code_At     : constant := 4;
   Id_At       : constant := 5;
   Time_At     : constant := 9;
   Number_At   : constant := 17;
   Transmit_At : constant := 21;
   Receive_At  : constant := 23;
   Data_At     : constant := 25;
   Nominal_At  : constant := Data_At + 16;
   Fast_At     : constant := Data_At + 20;
   Began_At    : constant := Data_At + 24;

   subtype Width is Positive range 1 .. 8;

   function Number_At_Place
     (Bytes : Image; First : Position; Count : Width)
      return Interfaces.Unsigned_64
   with
     Global => null,
     Pre    => First <= Record_Bytes - Count + 1;
   --  Little-endian.

   procedure Put
     (Bytes : in out Image;
      First : Position;
      Count : Width;
      Value : Interfaces.Unsigned_64)
   with
     Global => null,
     Pre    => First <= Record_Bytes - Count + 1;
   --  Little-endian.

   function Is_Zero
     (Bytes : Image; First : Positive; Last : Natural) return Boolean
   is (for all I in First .. Last => Bytes (I) = 0)
   with Global => null, Pre => Last <= Record_Bytes;
   --  Are these bytes all 0?

   function State_Code
     (State : Fault_Confinement.Connected_State) return Byte
   is (case State is
         when Error_Active  => 0,
         when Error_Passive => 1,
         when Bus_Off       => 2)
   with Global => null;
   --  The code of the state in a bus state.

   function Is_Greeting (Bytes : Image) return Boolean
   with
     Global => null,
     Post   =>
       (if Is_Greeting'Result then Bytes (Length_At) in 1 .. 16);
   --  Do the flags, the mark, the name and the rates follow the rules of hello
   --  and welcome, and are the bytes behind them 0?

   type Frame_Reading is record
      Is_Sound : Boolean := False;
      Frame    : Bus_Frames.Bus_Frame;
   end record;

   function Frame_In (Bytes : Image) return Frame_Reading
   with Global => null;
   --  The frame or error frame in a record of one of these kinds, if its
   --  fields except time and number follow the rules.

end Ravenchart.Can.Bus_Records;
