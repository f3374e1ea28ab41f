--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces.C.Strings;

package body Ravenchart.Can.Ctu_Hosts
  with SPARK_Mode => Off
--  ASM-013. The core is reached through the C library, by address.
is
   use type Interfaces.C.int;
   use type Interfaces.C.Strings.chars_ptr;
   use type System.Address;

   subtype C_Int is Interfaces.C.int;

   --  The C library

   function C_Open
     (Name : Interfaces.C.char_array; Flags : C_Int) return C_Int
   with Import, Convention => C, External_Name => "open";

   function C_Map
     (Place      : System.Address;
      Length     : Interfaces.C.size_t;
      Protection : C_Int;
      Flags      : C_Int;
      File       : C_Int;
      Offset     : Interfaces.C.long) return System.Address
   with Import, Convention => C, External_Name => "mmap";

   function C_Close (File : C_Int) return C_Int
   with Import, Convention => C, External_Name => "close";

   function C_Write
     (File : C_Int; Data : System.Address; Length : Interfaces.C.size_t)
      return Interfaces.C.long
   with Import, Convention => C, External_Name => "write";

   function C_Signal
     (Number : C_Int; Handler : System.Address) return System.Address
   with Import, Convention => C, External_Name => "signal";

   function C_Get_Environment
     (Name : Interfaces.C.char_array) return Interfaces.C.Strings.chars_ptr
   with Import, Convention => C, External_Name => "getenv";

   --  The numbers of Linux

   Read_Write      : constant C_Int := 8#2#;
   Synchronous     : constant C_Int := 8#4010000#;
   Close_On_Exec   : constant C_Int := 8#2000000#;
   Both_Ways       : constant C_Int := 3;
   Shared_Map      : constant C_Int := 16#01#;
   Private_Map     : constant C_Int := 16#02#;
   Fixed_Map       : constant C_Int := 16#10#;
   Anonymous_Map   : constant C_Int := 16#20#;
   Bus_Error       : constant C_Int := 7;
   Standard_Output : constant C_Int := 1;
   Standard_Error  : constant C_Int := 2;

   type Window_List is array (1 .. 8) of System.Address;

   Mapped_Windows : Window_List := (others => System.Null_Address)
   with Volatile;
   --  The windows with a core; two are more than a controller has.

   Complained : Boolean := False
   with Volatile;
   --  The driver looks again for a core that is not there; one message is
   --  enough.

   function Setting (Name, Default : String) return String;
   --  The value of an environment variable, or Default without it.

   function Number (Text : String) return Ctu_Registers.Hertz;
   --  The number in Text, or 0 when it is no number in range.

   function Device return String
   is (Setting ("RAVENCHART_CTUCANFD", ""));

   function Names_Core return Boolean
   is (Device'Length > 2
       and then Device (Device'Last - 1) = ':'
       and then Device (Device'Last) in '0' .. '9');
   --  Does the setting end in the number of a core?

   function File_Name return String
   is (if Names_Core
       then Device (Device'First .. Device'Last - 2)
       else Device);

   function First_Core return Natural
   is (if Names_Core
       then Character'Pos (Device (Device'Last)) - Character'Pos ('0')
       else 0);

   procedure Say (File : C_Int; Text : String);
   --  Write Text to File, unbuffered.

   function Replace
     (Window : System.Address; Flags, File : C_Int; Offset : Natural)
      return Boolean;
   --  Replace the page at Window; the result is True when that succeeded.

   procedure On_Bus_Error (Number : C_Int)
   with Convention => C;
   --  An access found that a core has disappeared: make all windows memory
   --  again, and continue. Where no window is left, the next such signal ends
   --  the process as it would without this handler.

   -------------
   -- Setting --
   -------------

   function Setting (Name, Default : String) return String is
      Value : constant Interfaces.C.Strings.chars_ptr :=
        C_Get_Environment (Interfaces.C.To_C (Name));
   begin
      return
        (if Value = Interfaces.C.Strings.Null_Ptr
         then Default
         else Interfaces.C.Strings.Value (Value));
   end Setting;

   ------------
   -- Number --
   ------------

   function Number (Text : String) return Ctu_Registers.Hertz is
      use type Ctu_Registers.Hertz;
      Result : Ctu_Registers.Hertz := 0;
   begin
      if Text'Length > 10 then
         return 0;
      end if;
      for C of Text loop
         if C not in '0' .. '9' then
            return 0;
         end if;
         Result := 10 * Result + (Character'Pos (C) - Character'Pos ('0'));
      end loop;
      return Result;
   end Number;

   ---------
   -- Say --
   ---------

   procedure Say (File : C_Int; Text : String) is
      Line    : constant String := Text & ASCII.LF;
      Ignored : Interfaces.C.long;
   begin
      Ignored := C_Write (File, Line'Address, Line'Length);
   end Say;

   -------------
   -- Replace --
   -------------

   function Replace
     (Window : System.Address; Flags, File : C_Int; Offset : Natural)
      return Boolean
   is (C_Map
         (Window, Window_Bytes, Both_Ways, Fixed_Map + Flags, File,
          Interfaces.C.long (Offset))
       = Window);

   ------------------
   -- On_Bus_Error --
   ------------------

   procedure On_Bus_Error (Number : C_Int) is
      Ignored : System.Address;
      Healed  : Boolean := False;
   begin
      for Window of Mapped_Windows loop
         if Window /= System.Null_Address then
            Healed := Replace (Window, Private_Map + Anonymous_Map, -1, 0);
            Window := System.Null_Address;
         end if;
      end loop;
      if not Healed then
         Ignored := C_Signal (Number, System.Null_Address);
      end if;
   end On_Bus_Error;

   -----------
   -- Clock --
   -----------

   function Clock return Ctu_Registers.Hertz
   is (Number (Setting ("RAVENCHART_CTUCANFD_CLOCK", "100000000")));

   --------------
   -- Announce --
   --------------

   procedure Announce is
   begin
      Say (Standard_Output, "can: ctucanfd on " & Device);
   end Announce;

   --------------
   -- Complain --
   --------------

   procedure Complain (Reason : Obstacle) is
   begin
      if not Complained then
         Complained := True;
         Say
           (Standard_Error,
            "error: can: "
            & (case Reason is
                  when No_Device =>
                    (if Device = ""
                     then "RAVENCHART_CTUCANFD names no file of registers"
                     else "there are no registers in " & File_Name),
                  when No_Core =>
                    "there is no CTU CAN FD in " & Device
                    & ", or it is not enabled",
                  when No_Bit_Rate =>
                    "the bit rate cannot be had from the clock")
            & "; trying again");
      end if;
   end Complain;

   ---------
   -- Map --
   ---------

   procedure Map
     (Window : System.Address; Behind : Natural; Mapped : out Boolean)
   is
      File            : constant C_Int :=
        C_Open
          (Interfaces.C.To_C (File_Name),
           Read_Write + Synchronous + Close_On_Exec);
      Ignored         : C_Int;
      Ignored_Handler : System.Address;
   begin
      Mapped := False;
      if File < 0 then
         return;
      end if;
      Mapped := Replace
        (Window, Shared_Map, File,
         (First_Core + Behind) * Ctu_Registers.Span);
      Ignored := C_Close (File);
      if not Mapped then
         return;
      end if;
      for Place of Mapped_Windows loop
         if Place = Window or else Place = System.Null_Address then
            Place := Window;
            exit;
         end if;
      end loop;
      Ignored_Handler := C_Signal (Bus_Error, On_Bus_Error'Address);
   end Map;

end Ravenchart.Can.Ctu_Hosts;
