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
      Status := Within_Limit;
      if Waits (Item) then
         Item.Left := Item.Left - 1;
         if not Waits (Item) then
            Status := Timed_Out;
         end if;
      end if;
   end Tick;

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

end Ravenchart.Calls;
