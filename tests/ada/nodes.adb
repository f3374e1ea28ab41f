--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Any_Frames;

package body Nodes is

   package Any_Frames renames Ravenchart.Can.Any_Frames;

   use type Ravenchart.Can.Frame_Format;
   use type Ravenchart.Can.Identifier;

   function Accepts
     (Id : Ravenchart.Can.Identifier; Format : Ravenchart.Can.Frame_Format)
      return Boolean
   is (Format = Ravenchart.Can.Standard or else Id >= 16#100#);

   ----------
   -- Send --
   ----------

   procedure Send
     (F : Ravenchart.Can.Frame; Status : out Ravenchart.Can.Send_Status) is
   begin
      Node.Send (Any_Frames.To_Any (F), Status);
   end Send;

   ----------------
   -- Wait_Frame --
   ----------------

   procedure Wait_Frame
     (F : out Ravenchart.Can.Frame; Stamp : out Ravenchart.Nanoseconds)
   is
      Next : Any_Frames.Any_Frame;
   begin
      Node.Wait_Frame (Next, Stamp);
      F := Next.Plain;
   end Wait_Frame;

end Nodes;
