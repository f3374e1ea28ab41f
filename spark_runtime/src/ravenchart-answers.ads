--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The ends of a call that goes to all elements of an array: of the call of
--  one element, and of the whole.

package Ravenchart.Answers
  with SPARK_Mode, Pure
is
   type Answer is (Replied, Refused, Timed_Out);
   --  The end of the call of one element, the worst last.

   type Outcome is (Not_Yet, All_Replied, Some_Refused, Some_Timed_Out);
   --  Not_Yet: the calls of other elements have not ended.

end Ravenchart.Answers;
