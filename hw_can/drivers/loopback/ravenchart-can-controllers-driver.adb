--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Driver "loopback": a bus inside the process with this node only, which
--  receives the frames that it sends.
--
--  Guarantees   frames come back in the order sent; none is corrupted; the
--               node is error-active, and never has to recover
--  Tasking      one task, the bus
--  Timing       a frame takes no time on the bus

separate (Ravenchart.Can.Controllers)
package body Driver is
   pragma Refined_State ((State => Bus));
   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Bus
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Carries each frame from the transmit queue to the receive queue.

   task body Bus is
      F : Any_Frames.Any_Frame;
   begin
      Upper.Note (Error_Active);
      loop
         Upper.Wait_Queued (F);
         Upper.Count (Upper.Sent);
         Upper.Receive (F);
      end loop;
   end Bus;

end Driver;
