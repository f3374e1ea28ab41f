--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Calls of a command on another node, distinguished by their numbers. The
--  caller keeps the call that waits for a reply, the provider the last call
--  received. The same package counts how long a reader waits for a value of
--  another node, and when the provider sends one.
--
--  Guarantees   at most one call waits; a reply is accepted only while the
--               call of its number waits; a repeated call is recognised
--  Tasking      none of its own
--  Timing       constant

with Ravenchart.Queueing;

package Ravenchart.Calls
  with SPARK_Mode, Pure
is
   use type Queueing.Put_Status;

   subtype Call_Number is Number range 0 .. 255;
   --  The number of a call, one byte of a frame.

   function Following (Item : Call_Number) return Call_Number
   is (if Item = Call_Number'Last then 0 else Item + 1)
   with Global => null;
   --  The number of the next call.

   --  The caller

   subtype Execution_Limit is Execution_Count range 1 .. Execution_Count'Last;
   --  Executions of the caller after which a call is given up.

   type Call is record
      Last : Call_Number     := Call_Number'Last;
      Left : Execution_Count := 0;
   end record;
   --  The number of the last call, and the executions for which it still
   --  waits; with 0, no call waits.

   type Reply_Status is (Awaited, Late);
   --  Late: the call was given up, or an earlier frame brought its reply.

   type Wait_Status is (Within_Limit, Timed_Out);
   --  Timed_Out: no reply has come, and the call is given up.

   function Waits (Item : Call) return Boolean
   is (Item.Left > 0)
   with Global => null;
   --  Is there a call without a reply?

   procedure Start
     (Item   : in out Call;
      Limit  : Execution_Limit;
      Status : out Queueing.Put_Status)
   with
     Global => null,
     Post   =>
       (if Waits (Item'Old)
        then Status = Queueing.Rejected_Full and then Item = Item'Old
        else Status = Queueing.Queued
             and then Item = (Following (Item'Old.Last), Limit));
   --  Begin a call, unless one waits.

   procedure Finish
     (Item   : in out Call;
      Number : Call_Number;
      Status : out Reply_Status)
   with
     Global => null,
     Post   =>
       (if Waits (Item'Old) and then Number = Item'Old.Last
        then Status = Awaited and then Item = (Item'Old.Last, 0)
        else Status = Late and then Item = Item'Old);
   --  A reply has come to the call with this number.

   procedure Tick (Item : in out Call; Status : out Wait_Status)
   with
     Global => null,
     Post   =>
       Item.Last = Item'Old.Last
       and then (if Waits (Item'Old)
                 then Item.Left = Item'Old.Left - 1
                      and then (Status = Timed_Out) = not Waits (Item)
                 else not Waits (Item) and then Status = Within_Limit);
   --  One more execution of the caller has begun.

   --  The reader

   procedure Count_Down
     (Left : in out Execution_Count; Status : out Wait_Status)
   with
     Global => null,
     Post   =>
       (if Left'Old > 0
        then Left = Left'Old - 1 and then (Status = Timed_Out) = (Left = 0)
        else Left = 0 and then Status = Within_Limit);
   --  One of the executions that were left has begun.

   --  The provider

   type Heard is record
      Any  : Boolean     := False;
      Last : Call_Number := 0;
   end record;
   --  Any: a call has come from the caller. Last: the number of the last one.

   type Hearing is (Heard_First, Repeated);
   --  Repeated: the frame repeats the last call, which is not executed again.

   procedure Hear
     (Item   : in out Heard;
      Number : Call_Number;
      Status : out Hearing)
   with
     Global => null,
     Post   =>
       Item = (True, Number)
       and then (Status = Repeated) = (Item'Old = (True, Number));
   --  A call with this number has come.

   procedure Take_Turn
     (Left   : in out Execution_Count;
      Every  : Execution_Limit;
      Is_Due : out Boolean)
   with
     Global => null,
     Post   =>
       Is_Due = (Left'Old = 0)
       and then Left = (if Is_Due then Every - 1 else Left'Old - 1);
   --  One more execution of the provider has ended. Is_Due: it sends the
   --  value, as the first execution does and then every Every-th one. Left
   --  counts the executions before the next one that sends.

end Ravenchart.Calls;
