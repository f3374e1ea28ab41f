--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces.C;
with System;

package body Ravenchart.Interrupt_Lines
  with SPARK_Mode => Off
is
   use type Interfaces.C.int;

   subtype C_Int is Interfaces.C.int;

   type Signal_Set is array (1 .. 16) of Interfaces.C.unsigned_long
   with Convention => C;
   --  sigset_t of Linux.

   function C_Empty (Set : out Signal_Set) return C_Int
   with Import, Convention => C, External_Name => "sigemptyset";

   function C_Add (Set : in out Signal_Set; Signal : C_Int) return C_Int
   with Import, Convention => C, External_Name => "sigaddset";

   function C_Mask
     (How : C_Int; Set : Signal_Set; Old : System.Address) return C_Int
   with Import, Convention => C, External_Name => "pthread_sigmask";

   function C_Wait (Set : Signal_Set; Signal : out C_Int) return C_Int
   with Import, Convention => C, External_Name => "sigwait";

   Block : constant C_Int := 0;
   --  SIG_BLOCK of Linux.

   procedure Only (Signal : Natural; Set : out Signal_Set);
   --  The set of this signal alone.

   procedure Only (Signal : Natural; Set : out Signal_Set) is
   begin
      if C_Empty (Set) /= 0 or else C_Add (Set, C_Int (Signal)) /= 0 then
         raise Program_Error with "the number of a signal is wrong";
      end if;
   end Only;

   procedure Open (Self : Line) is
      Set : Signal_Set;
   begin
      Only (Self.Signal, Set);
      if C_Mask (Block, Set, System.Null_Address) /= 0 then
         raise Program_Error with "a signal cannot be blocked";
      end if;
   end Open;

   procedure Wait (Self : in out Line) is
      Set    : Signal_Set;
      Taken  : C_Int := 0;
      Failed : C_Int;
   begin
      Only (Self.Signal, Set);
      loop
         Failed := C_Wait (Set, Taken);
         exit when Failed = 0;
      end loop;
   end Wait;

end Ravenchart.Interrupt_Lines;
