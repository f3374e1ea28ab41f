package body Ravenchart.Monitors
  with SPARK_Mode, Refined_State => (State => Observed)
is
   protected Observed
     with Priority => Ceiling
   is
      procedure Add
        (Response : Nanoseconds; Missed : Boolean; Times : Execution_Times);

      function Summary return Statistics;

   private
      Sum : Statistics;
   end Observed;

   protected body Observed is

      procedure Add
        (Response : Nanoseconds; Missed : Boolean; Times : Execution_Times) is
      begin
         Sum.Releases := Next (Sum.Releases);
         if Missed then
            Sum.Misses := Next (Sum.Misses);
         end if;
         Sum.Worst_Response :=
           Nanoseconds'Max (Sum.Worst_Response, Response);
         for Activity in Activity_Id loop
            Sum.Worst_Execution (Activity) := Nanoseconds'Max
              (Sum.Worst_Execution (Activity), Times (Activity));
         end loop;
      end Add;

      function Summary return Statistics
      is (Sum);

   end Observed;

   procedure Record_Release
     (Response : Nanoseconds; Missed : Boolean; Times : Execution_Times)
   with Refined_Global => (In_Out => Observed)
   is
   begin
      Observed.Add (Response, Missed, Times);
   end Record_Release;

   procedure Read (S : out Statistics)
   with Refined_Global => Observed
   is
   begin
      S := Observed.Summary;
   end Read;

end Ravenchart.Monitors;
