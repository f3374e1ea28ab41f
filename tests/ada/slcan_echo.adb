--  Peer of a bench program that speaks slcan: each frame is sent back with
--  its identifier plus one. Two standard identifiers are orders: a remote
--  frame 7FE asks for the counters (one byte each: sent, received, lost out,
--  lost in, rejected lines, state), a data frame 7FD for a burst of as many
--  frames as its first two bytes say.

with Interfaces;
with Nodes;
with Ravenchart.Can;

procedure Slcan_Echo is
   use Ravenchart.Can;
   use type Interfaces.Unsigned_64;

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   function Low_Byte
     (Count : Ravenchart.Event_Count) return Interfaces.Unsigned_64
   is (Interfaces.Unsigned_64 (Count) and 16#FF#);

   procedure Send_Counters;

   procedure Send_Burst (Length : Interfaces.Unsigned_64);

   procedure Send_Counters is
      Count  : Counters;
      State  : Controller_State;
      Status : Send_Status;
   begin
      Nodes.Node.Read_Counters (Count);
      Nodes.Node.Read_State (State);
      Nodes.Node.Send
        (Data_Frame
           (16#7FE#, Base, 6,
            Low_Byte (Count.Sent)
            or Interfaces.Shift_Left (Low_Byte (Count.Received), 8)
            or Interfaces.Shift_Left (Low_Byte (Count.Lost_Out), 16)
            or Interfaces.Shift_Left (Low_Byte (Count.Lost_In), 24)
            or Interfaces.Shift_Left (Low_Byte (Count.Rejected_Lines), 32)
            or Interfaces.Shift_Left
                 (Interfaces.Unsigned_64 (Controller_State'Pos (State)), 40)),
         Status);
   end Send_Counters;

   procedure Send_Burst (Length : Interfaces.Unsigned_64) is
      Status : Send_Status;
   begin
      for I in 1 .. Length loop
         Nodes.Node.Send (Data_Frame (16#100#, Base, 8, I), Status);
      end loop;
   end Send_Burst;

   F      : Frame;
   Status : Send_Status;
begin
   loop
      Nodes.Node.Wait_Frame (F);
      if F.Id = 16#7FE# and then F.Kind = Remote then
         Send_Counters;
      elsif F.Id = 16#7FD# then
         Send_Burst (Payload (F) and 16#FFFF#);
      else
         F.Id := (if F.Id = 16#7FF# then 0 else (F.Id + 1) mod 2**29);
         Nodes.Node.Send (F, Status);
      end if;
   end loop;
end Slcan_Echo;
