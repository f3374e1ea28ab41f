--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Health_Counters
  with SPARK_Mode, Refined_State => (State => Counters)
is
   protected Counters
     with Priority => Ceiling
   is
      procedure Add (Kind : Health.Fault_Kind);

      function All_Counts return Health.Fault_Counts;

   private
      Counts : Health.Fault_Counts := (others => 0);
   end Counters;

   protected body Counters is

      procedure Add (Kind : Health.Fault_Kind) is
      begin
         Counts (Kind) := Next (Counts (Kind));
      end Add;

      function All_Counts return Health.Fault_Counts
      is (Counts);

   end Counters;

   procedure Record_Fault (Kind : Health.Fault_Kind)
   with Refined_Global => (In_Out => Counters)
   is
   begin
      Counters.Add (Kind);
   end Record_Fault;

   procedure Read (Counts : out Health.Fault_Counts)
   with Refined_Global => Counters
   is
   begin
      Counts := Counters.All_Counts;
   end Read;

end Ravenchart.Health_Counters;
