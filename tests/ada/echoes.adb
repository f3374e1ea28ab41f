with Interfaces;
with Nodes;
with Ravenchart.Can;

package body Echoes is

   use Ravenchart.Can;
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
         Nodes.Node.Send
           (Data_Frame (16#102#, Ravenchart.Can.Standard, 8, I), Status);
      end loop;
   end Send_Burst;

   ----------
   -- Echo --
   ----------

   task body Echo is
      F      : Frame;
      Status : Send_Status;
   begin
      loop
         Nodes.Node.Wait_Frame (F);
         if F.Id = 16#7F0# + Identifier (Number)
           and then F.Format = Ravenchart.Can.Standard
         then
            Send_Burst (Payload (F) and 16#FFFF#);
         elsif F.Id mod 4 = Identifier (Number) then
            F.Id := F.Id + 1;
            Nodes.Node.Send (F, Status);
         end if;
      end loop;
   end Echo;

end Echoes;
