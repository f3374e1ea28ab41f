--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Root of the Ravenchart runtime: the few scalar types that the runtime, the
--  HAL and generated code share.
--
--  Guarantees   no state, no elaboration code
--  Tasking      none: any task may use these types
--  Timing       constant

package Ravenchart
  with SPARK_Mode, Pure
is

   type Nanoseconds is range 0 .. 2**62 - 1;
   --  A duration, or an instant counted from Epochs.Start; 146 years at most.

   subtype Positive_Nanoseconds is Nanoseconds range 1 .. Nanoseconds'Last;
   --  A period, a deadline or a separation.

   type Number is range -(2**62) .. 2**62 - 1;
   --  An integer of the model that has no unit; the sum of two fits 64 bits.

   type Element_Id is range 0 .. 2**31 - 1;
   --  A model element; trace.json gives its name and its location.

   type Execution_Count is range 0 .. 2**31 - 1;
   --  Executions of one activity, the unit of region time.

   type Event_Count is range 0 .. 2**62 - 1;
   --  How often something happened; it stays at its last value for ever.

   function Next (Count : Event_Count) return Event_Count
   is (if Count = Event_Count'Last then Count else Count + 1)
   with Global => null;
   --  One more, and no more than the last value.

   function Sum (A, B : Event_Count) return Event_Count
   is (if A > Event_Count'Last - B then Event_Count'Last else A + B)
   with Global => null;
   --  Both together, and no more than the last value.

   type Freshness is (Never_Received, Fresh, Stale);
   --  The state of an input port: has its value come, and is it still fresh?

end Ravenchart;
