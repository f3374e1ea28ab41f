--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The messages of the coordinator to the operator, written by hand.

package body Cartesian_Robot.Robot_Coordinator.Activities
  with SPARK_Mode
is

   ---------------
   -- Summarise --
   ---------------

   procedure Summarise
     (Report_X : Cartesian_Robot.Robot_Coordinator.Report_X_View;
      Report_Y : Cartesian_Robot.Robot_Coordinator.Report_Y_View;
      Mission  : Robot_Coordinator.Mission_States.Leaf;
      Status   : out Cartesian_Robot.Robot_Report)
   is
      Condition : constant Robot_Condition :=
        (case Mission is
            when Mission_States.Waiting   => Waiting,
            when Mission_States.Homing    => Homing,
            when Mission_States.Ready     => Ready,
            when Mission_States.Departing |
                 Mission_States.Under_Way => Moving,
            when Mission_States.Failed |
                 Mission_States.Recovering => Failed,
            when Mission_States.Shut_Down => Stopped);
   begin
      Status :=
        (Condition => Condition,
         X         => Report_X.Value.Position,
         Y         => Report_Y.Value.Position);
   end Summarise;

end Cartesian_Robot.Robot_Coordinator.Activities;
