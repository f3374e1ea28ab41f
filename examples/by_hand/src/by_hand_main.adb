--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Counting;
with Ravenchart.Epochs;
with Ravenchart.Hosts;

procedure By_Hand_Main with SPARK_Mode is
   Shown : Ravenchart.Event_Count;
begin
   Ravenchart.Hosts.Start;
   delay until Ravenchart.Epochs.Instant (495_000_000);
   Counting.Shown.Read (Shown);
   Ravenchart.Hosts.Finish (Success => Shown in 1 .. 50);
end By_Hand_Main;
