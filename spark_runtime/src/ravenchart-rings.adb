--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Rings
  with SPARK_Mode
is
   function Length (R : Ring) return Length_Type
   is (R.Count);

   function Highest (R : Ring) return Length_Type
   is (R.Most);

   function Lost (R : Ring) return Event_Count
   is (R.Given_Up);

   function Place (R : Ring; Nth : Capacity_Type) return Capacity_Type
   is (if Nth - 1 <= R.Capacity - R.First
       then R.First + (Nth - 1)
       else Nth - 1 - (R.Capacity - R.First));
   --  Wraps by a branch, since provers dislike "mod".

   function Behind (R : Ring) return Capacity_Type
   is (if R.First < R.Capacity then R.First + 1 else 1)
   with Global => null;
   --  The place behind the oldest one.

   ---------
   -- Put --
   ---------

   procedure Put
     (R         : in out Ring;
      When_Full : Queueing.Overflow_Policy;
      Status    : out Queueing.Put_Status;
      Newest    : out Capacity_Type) is
   begin
      if R.Count < R.Capacity then
         R.Most  := Length_Type'Max (R.Most, R.Count + 1);
         R.Count := R.Count + 1;
         Status  := Queueing.Queued;
      elsif When_Full = Queueing.Drop_Oldest then
         R.First    := Behind (R);
         R.Given_Up := Next (R.Given_Up);
         Status     := Queueing.Dropped_Oldest;
      else
         R.Given_Up := Next (R.Given_Up);
         Status     := Queueing.Rejected_Full;
      end if;
      Newest := Place (R, R.Count);
   end Put;

   ----------
   -- Take --
   ----------

   procedure Take
     (R      : in out Ring;
      Status : out Queueing.Take_Status;
      Oldest : out Capacity_Type) is
   begin
      Oldest := R.First;
      if R.Count > 0 then
         R.First := Behind (R);
         R.Count := R.Count - 1;
         Status  := Queueing.Taken;
      else
         Status := Queueing.Empty;
      end if;
   end Take;

end Ravenchart.Rings;
