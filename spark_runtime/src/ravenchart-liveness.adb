--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Liveness
  with SPARK_Mode
is

   --------------------------------
   -- Lemma_Later_Is_Not_Overdue --
   --------------------------------

   procedure Lemma_Later_Is_Not_Overdue
     (Beat : Rhythm; First, Later : Event_Count; Elapsed : Nanoseconds) is
   begin
      if Nanoseconds (Later) <= Elapsed / Beat.Period then
         pragma Assert
           (Nanoseconds (First) * Beat.Period
            <= Nanoseconds (Later) * Beat.Period);
      end if;
   end Lemma_Later_Is_Not_Overdue;

   -------------------------
   -- Lemma_Stays_Overdue --
   -------------------------

   procedure Lemma_Stays_Overdue
     (Beat : Rhythm; Release : Event_Count; Before, After : Nanoseconds)
   is
      Whole : constant Nanoseconds := After / Beat.Period;
      Count : constant Nanoseconds := Nanoseconds (Release);
   begin
      pragma Assert (Count * Beat.Period <= Before);
      pragma Assert (After - Whole * Beat.Period < Beat.Period);
      if Count > Whole then
         pragma Assert ((Count - Whole) * Beat.Period >= Beat.Period);
         pragma Assert (False);
      end if;
   end Lemma_Stays_Overdue;

   ----------
   -- Note --
   ----------

   procedure Note
     (Reported : in out Boolean; Is_Silent : Boolean; Found : out Finding) is
   begin
      if Reported then
         Found := Was_Silent;
      elsif Is_Silent then
         Found    := Falls_Silent;
         Reported := True;
      else
         Found := In_Time;
      end if;
   end Note;

end Ravenchart.Liveness;
