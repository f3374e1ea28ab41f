--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Error frames as values: the error that a node detected, and the flag that
--  it sends.
--
--  Guarantees   only the flag of an error-active node can be seen by the
--               others
--  Tasking      none: frames are values
--  Timing       constant
--
--  ISO 11898-1 (2015), error detection and error frame.

with Ravenchart.Can.Levels;

package Ravenchart.Can.Error_Frames
  with SPARK_Mode, Pure
is
   use type Levels.Level;

   type Error_Kind is
     (Bit_Error,
      Stuff_Error,
      Crc_Error,
      Form_Error,
      Acknowledgement_Error);
   --  Bit_Error: a bit is read back with the opposite level. Stuff_Error: six
   --  equal bits where a stuff bit belongs. Crc_Error: a check sequence or
   --  stuff count that differs. Form_Error: a dominant bit in a place of fixed
   --  form. Acknowledgement_Error: no node acknowledged the frame.

   type Node_Role is (Transmitter, Receiver);
   --  The role of the node in the frame that failed.

   type Error_Flag is (Active_Flag, Passive_Flag);
   --  Six dominant bits, or six recessive ones.

   function Flag_Of (State : Controller_State) return Error_Flag
   is (if State = Error_Active then Active_Flag else Passive_Flag)
   with
     Global => null,
     Pre    => State in Error_Active .. Error_Passive;
   --  The flag that a node in this state may send.

   function Flag_Level (Flag : Error_Flag) return Levels.Level
   is (if Flag = Active_Flag then Levels.Dominant else Levels.Recessive)
   with Global => null;
   --  The level of each bit of a flag.

   Flag_Bits : constant := 6;
   --  Length of one error flag.

   Delimiter_Bits : constant := 8;
   --  Recessive bits that end an error frame.

   subtype Echo_Bits is Natural range 0 .. Flag_Bits;
   --  Bits by which the flags of other nodes outlast the first one.

   type Error_Frame is record
      Kind : Error_Kind := Bit_Error;
      Role : Node_Role := Receiver;
      Flag : Error_Flag := Active_Flag;
      Echo : Echo_Bits := 0;
   end record
   with Predicate => (if Kind = Acknowledgement_Error
                      then Role = Transmitter);
   --  Only a transmitter can miss its acknowledgement.

   function Length (F : Error_Frame) return Positive
   is (Flag_Bits + F.Echo + Delimiter_Bits)
   with
     Global => null,
     Post   => Length'Result in 14 .. 20;
   --  The bits of the frame on the bus, without the intermission.

end Ravenchart.Can.Error_Frames;
