--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A frame of a bus: a classic one or a CAN FD one.
--
--  Guarantees   those of Can and of Fd_Frames; a property that the family does
--               not have reads as 0
--  Tasking      none: frames are values
--  Timing       constant; Bytes and Words are linear in the room for
--               data

with Interfaces;
with Ravenchart.Can.Fd_Frames;

package Ravenchart.Can.Any_Frames
  with SPARK_Mode, Pure
is
   use type Fd_Frames.Fd_Words;
   use type Interfaces.Unsigned_8;

   type Frame_Family is (Classic, Flexible);
   --  CAN 2.0 or CAN FD (the bit FDF of ISO 11898-1).

   type Any_Frame is record
      Family : Frame_Family := Classic;
      Plain  : Frame;
      Fd     : Fd_Frames.Fd_Frame;
   end record;
   --  Plain is the frame of the classic family, Fd that of the flexible one;
   --  the other component has no meaning. There is no discriminant, so that
   --  queues of any element take it.

   Null_Any_Frame : constant Any_Frame :=
     (others => <>);
   --  Fills a place without a frame.

   function To_Any (F : Frame) return Any_Frame
   is (Family => Classic, Plain => F, others => <>)
   with Global => null;

   function To_Any (F : Fd_Frames.Fd_Frame) return Any_Frame
   is (Family => Flexible, Fd => F, others => <>)
   with Global => null;

   function Id (F : Any_Frame) return Identifier
   is (if F.Family = Classic then F.Plain.Id else F.Fd.Id)
   with Global => null;

   function Format (F : Any_Frame) return Frame_Format
   is (if F.Family = Classic then F.Plain.Format else F.Fd.Format)
   with Global => null, Post => Fits (Id (F), Format'Result);

   function Fits (F : Any_Frame; Setting : Bus_Setting) return Boolean
   is (F.Family = Classic or else Setting.Takes_Fd)
   with Global => null;
   --  Can F be on a bus with this configuration?

   function Carries
     (F : Any_Frame; Family : Frame_Family; Length : Fd_Frames.Fd_Length)
      return Boolean
   is (F.Family = Family
       and then
         (if F.Family = Classic
          then F.Plain.Kind = Data and then F.Plain.Length = Length
          else F.Fd.Length = Length))
   with Global => null;
   --  Is it a data frame of this family with so many bytes?

   function Byte
     (F : Any_Frame; Index : Fd_Frames.Fd_Index) return Interfaces.Unsigned_8
   is (if F.Family = Flexible
       then Fd_Frames.Byte (F.Fd, Index)
       elsif Index in Byte_Index
       then Byte (F.Plain, Index)
       else 0)
   with Global => null;
   --  One byte of the data; 0 beyond the length.

   function Bytes (F : Any_Frame) return Fd_Frames.Fd_Bytes
   with
     Global => null,
     Post   =>
       (for all I in Fd_Frames.Fd_Index => Bytes'Result (I) = Byte (F, I));
   --  The data as bytes; 0 beyond the length.

   function Payload (F : Any_Frame) return Interfaces.Unsigned_64
   is (if F.Family = Classic then Payload (F.Plain) else 0)
   with Global => null;
   --  The data of a classic frame as one word, byte 0 lowest.

   function Words (F : Any_Frame) return Fd_Frames.Fd_Words
   is (if F.Family = Flexible then Fd_Frames.Words (F.Fd)
       else (others => 0))
   with Global => null;
   --  The data of a CAN FD frame.

   function Whole_Frame
     (Id      : Identifier;
      Format  : Frame_Format;
      Length  : Data_Length;
      Payload : Interfaces.Unsigned_64) return Any_Frame
   is (To_Any (Data_Frame (Id, Format, Length, Payload)))
   with
     Global => null,
     Pre    => Fits (Id, Format) and then (Payload and not Mask (Length)) = 0,
     Post   =>
       Carries (Whole_Frame'Result, Classic, Length)
       and then Any_Frames.Payload (Whole_Frame'Result) = Payload;
   --  A classic frame that is long enough for all bits of Payload.

   function Whole_Frame
     (Id     : Identifier;
      Format : Frame_Format;
      Length : Fd_Frames.Fd_Length;
      Words  : Fd_Frames.Fd_Words;
      Rate   : Fd_Frames.Bit_Rate_Use) return Any_Frame
   is (To_Any (Fd_Frames.Fd_Data_Frame (Id, Format, Length, Words, Rate)))
   with
     Global => null,
     Pre    =>
       Fits (Id, Format) and then Fd_Frames.Ends_Within (Words, Length),
     Post   =>
       Carries (Whole_Frame'Result, Flexible, Length)
       and then Any_Frames.Words (Whole_Frame'Result) = Words;
   --  A CAN FD frame that is long enough for all bits of Words.

end Ravenchart.Can.Any_Frames;
