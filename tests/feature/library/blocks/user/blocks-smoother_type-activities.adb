--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Blocks.Smoother_Type.Activities
with SPARK_Mode
is
   use type Ravenchart.Freshness;
   use type Ravenchart.Number;

   procedure Smoothen
     (Raw    : Smoother_Type.Raw_View;
      Kept   : in out Sample;
      Seen   : in out Count;
      Smooth : out Sample) is
   begin
      if Raw.State = Ravenchart.Fresh then
         Kept :=
           (Level   => (Kept.Level + Raw.Value.Level) / 2,
            Quality => Raw.Value.Quality);
         Seen := Count'Min (Count'Last - 1, Seen) + 1;
      end if;

      Smooth := Kept;
   end Smoothen;
end Blocks.Smoother_Type.Activities;
