--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Calls
  with SPARK_Mode
is
   -----------
   -- Start --
   -----------

   procedure Start
     (Item   : in out Call;
      Limit  : Execution_Limit;
      Status : out Queueing.Put_Status) is
   begin
      if Waits (Item) then
         Status := Queueing.Rejected_Full;
      else
         Item   := (Last => Following (Item.Last), Left => Limit);
         Status := Queueing.Queued;
      end if;
   end Start;

   ------------
   -- Finish --
   ------------

   procedure Finish
     (Item   : in out Call;
      Number : Call_Number;
      Status : out Reply_Status) is
   begin
      if Waits (Item) and then Number = Item.Last then
         Item.Left := 0;
         Status    := Awaited;
      else
         Status := Late;
      end if;
   end Finish;

   ----------
   -- Tick --
   ----------

   procedure Tick (Item : in out Call; Status : out Wait_Status) is
   begin
      Count_Down (Item.Left, Status);
   end Tick;

   ----------------
   -- Count_Down --
   ----------------

   procedure Count_Down
     (Left : in out Execution_Count; Status : out Wait_Status) is
   begin
      Status := (if Left = 1 then Timed_Out else Within_Limit);
      if Left > 0 then
         Left := Left - 1;
      end if;
   end Count_Down;

   ----------
   -- Hear --
   ----------

   procedure Hear
     (Item   : in out Heard;
      Number : Call_Number;
      Status : out Hearing) is
   begin
      Status :=
        (if Item.Any and then Item.Last = Number
         then Repeated
         else Heard_First);
      Item   := (Any => True, Last => Number);
   end Hear;

   ---------------
   -- Take_Turn --
   ---------------

   procedure Take_Turn
     (Left   : in out Execution_Count;
      Every  : Execution_Limit;
      Is_Due : out Boolean) is
   begin
      Is_Due := Left = 0;
      Left   := (if Is_Due then Every - 1 else Left - 1);
   end Take_Turn;

end Ravenchart.Calls;
