--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The driver of the CAN controller of Zynq on a model of its registers: the
--  frames that are lost when it is bus-off, and its recovery.

with Ada.Real_Time;
with Facts;
with Ravenchart.Can;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fault_Notices;
with Ravenchart.Epochs;
with Xcan_Driven;
with Xcan_Model;

procedure Test_Xcan_Driver is
   use type Ada.Real_Time.Time;
   use type Ravenchart.Can.Controller_State;
   use type Ravenchart.Can.Send_Status;
   use type Ravenchart.Event_Count;

   Next   : Ada.Real_Time.Time := Ravenchart.Epochs.Start;
   Log    : Ravenchart.Can.Fault_Notices.Fault_Log;
   Counts : Ravenchart.Can.Counters;

   procedure Look;
   --  Let the driver look many times, and read its results.

   procedure Send (Number : Positive);
   --  So many frames, which all find room.

   procedure Arrive (Id : Ravenchart.Can.Identifier; Number : Positive);
   --  So many frames come.

   ----------
   -- Look --
   ----------

   procedure Look is
   begin
      Next := Next + Ada.Real_Time.Milliseconds (100);
      delay until Next;
      Xcan_Driven.Controller.Read_Faults (Log);
      Xcan_Driven.Controller.Read_Counters (Counts);
   end Look;

   ----------
   -- Send --
   ----------

   procedure Send (Number : Positive) is
      Status : Ravenchart.Can.Send_Status;
      Right  : Boolean := True;
   begin
      for Nth in 1 .. Number loop
         Xcan_Driven.Controller.Send
           (Ravenchart.Can.Any_Frames.To_Any
              (Ravenchart.Can.Data_Frame
                 (7, Ravenchart.Can.Standard, 1, 5)),
            Status);
         Right := Right and then Status = Ravenchart.Can.Queued;
      end loop;
      Facts.Check ("frames are queued in every state", Right);
   end Send;

   ------------
   -- Arrive --
   ------------

   procedure Arrive (Id : Ravenchart.Can.Identifier; Number : Positive) is
   begin
      for Nth in 1 .. Number loop
         Xcan_Model.Controller.Arrive
           (Ravenchart.Can.Data_Frame (Id, Ravenchart.Can.Standard, 1, 5));
      end loop;
   end Arrive;

begin
   Look;
   Facts.Check
     ("the controller takes part",
      Log.State = Ravenchart.Can.Error_Active
      and then not Xcan_Model.Controller.Is_In_Reset);

   Send (10);
   Look;
   Facts.Check
     ("what is sent is counted",
      Counts.Sent = 10 and then Xcan_Model.Controller.Sent = 10);

   Arrive (3, 20);
   Arrive (1_500, 20);
   Look;
   Facts.Check ("the filter takes what it takes", Counts.Received = 20);

   Xcan_Model.Controller.Stand (Ravenchart.Can.Error_Passive);
   Look;
   Facts.Check
     ("error-passive is seen, with the counters",
      Log.State = Ravenchart.Can.Error_Passive
      and then Log.Passive_Entries = 1
      and then Counts.Transmit_Errors in 16#80#);
   Xcan_Model.Controller.Stand (Ravenchart.Can.Error_Active);

   Xcan_Model.Controller.Block (True);
   Send (5);
   Xcan_Driven.Controller.Request_Recovery;
   Look;
   Facts.Check ("blocked frames wait", Counts.Sent = 10);
   Xcan_Model.Controller.Stand (Ravenchart.Can.Bus_Off);
   Look;
   Facts.Check
     ("from bus-off nothing comes back before it is requested",
      Log.State = Ravenchart.Can.Bus_Off
      and then Log.Off_Entries = 1
      and then Xcan_Model.Controller.Is_In_Reset);
   Facts.Check
     ("frames in the FIFO of a controller that is held are lost and counted",
      Counts.Lost_Out = 5);

   Xcan_Model.Controller.Block (False);
   Send (3);
   Look;
   Facts.Check
     ("it is held until then", Xcan_Model.Controller.Is_In_Reset);
   Xcan_Driven.Controller.Request_Recovery;
   Look;
   Facts.Check
     ("a request brings it back",
      Log.State = Ravenchart.Can.Error_Active
      and then Log.Returns = 2
      and then not Xcan_Model.Controller.Is_In_Reset);
   Facts.Check
     ("what was queued meanwhile is sent then",
      Counts.Sent = 13 and then Counts.Lost_Out = 5);
   Facts.Finish;
end Test_Xcan_Driver;
