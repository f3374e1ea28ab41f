--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Iso_Tp.Reassemblies
  with SPARK_Mode, Refined_State => (State => Store)
is
   use type Receivers.Answer;

   protected Store
     with Priority => Ceiling
   is
      procedure Take
        (Payload : Interfaces.Unsigned_64;
         Length  : Data_Length;
         Stamp   : Nanoseconds;
         Result  : out Receivers.Outcome);

      function Data return Value_Bytes;

      procedure Look
        (Now     : Nanoseconds;
         Wanted  : out Flow_Request;
         Expired : out Boolean);

   private
      Held : Receivers.Receiver;
      Flow : Flow_Request;
   end Store;

   protected body Store is

      ----------
      -- Take --
      ----------

      procedure Take
        (Payload : Interfaces.Unsigned_64;
         Length  : Data_Length;
         Stamp   : Nanoseconds;
         Result  : out Receivers.Outcome)
      is
         Reply : Receivers.Answer;
      begin
         Receivers.Take
           (Held, Segments, Payload, Length, Stamp, Result, Reply);
         if Reply /= Receivers.No_Answer then
            Flow :=
              (Count  => Next (Flow.Count),
               Status =>
                 (if Reply = Receivers.Refuse
                  then Overflow
                  else Continue_To_Send));
         end if;
      end Take;

      ----------
      -- Data --
      ----------

      function Data return Value_Bytes
      is (Held.Data);

      ----------
      -- Look --
      ----------

      procedure Look
        (Now     : Nanoseconds;
         Wanted  : out Flow_Request;
         Expired : out Boolean) is
      begin
         Receivers.Give_Up (Held, Segments, Now, Expired);
         Wanted := Flow;
      end Look;

   end Store;

   ----------
   -- Take --
   ----------

   procedure Take
     (Payload : Interfaces.Unsigned_64;
      Length  : Data_Length;
      Stamp   : Nanoseconds;
      Result  : out Receivers.Outcome)
   with Refined_Global => (In_Out => Store)
   is
   begin
      Store.Take (Payload, Length, Stamp, Result);
   end Take;

   ----------
   -- Read --
   ----------

   procedure Read (Value : out Value_Bytes)
   with Refined_Global => Store
   is
   begin
      Value := Store.Data;
   end Read;

   ----------
   -- Look --
   ----------

   procedure Look
     (Now     : Nanoseconds;
      Wanted  : out Flow_Request;
      Expired : out Boolean)
   with Refined_Global => (In_Out => Store)
   is
   begin
      Store.Look (Now, Wanted, Expired);
   end Look;

end Ravenchart.Can.Iso_Tp.Reassemblies;
