--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces;
with Nodes;
with Ravenchart;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;

package body Echoes is

   use Ravenchart.Can;
   use type Any_Frames.Frame_Family;
   use type Interfaces.Unsigned_64;

   procedure Send_Burst (Length : Interfaces.Unsigned_64);

   task Echo;

   ----------------
   -- Send_Burst --
   ----------------

   procedure Send_Burst (Length : Interfaces.Unsigned_64) is
      Status : Send_Status;
   begin
      for I in 1 .. Length loop
         Nodes.Send
           (Data_Frame (16#102#, Ravenchart.Can.Standard, 8, I), Status);
      end loop;
   end Send_Burst;

   ----------
   -- Echo --
   ----------

   task body Echo is
      Any    : Any_Frames.Any_Frame;
      Stamp  : Ravenchart.Nanoseconds;
      F      : Frame;
      Fd     : Fd_Frames.Fd_Frame;
      Status : Send_Status;
   begin
      loop
         Nodes.Node.Wait_Frame (Any, Stamp);
         F  := Any.Plain;
         Fd := Any.Fd;
         if Any.Family = Any_Frames.Flexible then
            if Fd.Id mod 4 = Identifier (Number) then
               Fd.Id := Fd.Id + 1;
               Nodes.Node.Send (Any_Frames.To_Any (Fd), Status);
            end if;
         elsif F.Id = 16#7F0# + Identifier (Number)
           and then F.Format = Ravenchart.Can.Standard
         then
            Send_Burst (Payload (F) and 16#FFFF#);
         elsif F.Id mod 4 = Identifier (Number) then
            F.Id := F.Id + 1;
            Nodes.Send (F, Status);
         end if;
      end loop;
   end Echo;

end Echoes;
