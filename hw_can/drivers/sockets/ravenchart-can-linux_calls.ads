--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The calls of the C library and the numbers of Linux for the drivers by
--  sockets and serial lines.
--
--  Guarantees   none: callers keep to the manual pages, sections 2 and 3
--  Tasking      each call is independent
--  Timing       that of the system

with Interfaces.C.Strings;
with System;

private package Ravenchart.Can.Linux_Calls
  with SPARK_Mode => Off
is
   subtype C_Int is Interfaces.C.int;

   type Socket_Address is record
      Family  : Interfaces.Unsigned_16 := 2;
      Port    : Interfaces.Unsigned_16 := 0;
      Host    : Interfaces.Unsigned_32 := 0;
      Padding : Interfaces.Unsigned_64 := 0;
   end record
   with Convention => C;
   --  struct sockaddr_in; Port and Host in the order of the network.

   Address_Length : constant C_Int := 16;

   function C_Socket (Domain, Kind, Protocol : C_Int) return C_Int
   with Import, Convention => C, External_Name => "socket";

   function C_Set_Option
     (File, Level, Name : C_Int; Value : System.Address; Length : C_Int)
      return C_Int
   with Import, Convention => C, External_Name => "setsockopt";

   function C_Bind
     (File : C_Int; Name : System.Address; Length : C_Int) return C_Int
   with Import, Convention => C, External_Name => "bind";

   function C_Connect
     (File : C_Int; Name : System.Address; Length : C_Int) return C_Int
   with Import, Convention => C, External_Name => "connect";

   function C_Listen (File, Backlog : C_Int) return C_Int
   with Import, Convention => C, External_Name => "listen";

   function C_Get_Name
     (File : C_Int; Name, Length : System.Address) return C_Int
   with Import, Convention => C, External_Name => "getsockname";

   function C_Accept
     (File : C_Int; Name, Length : System.Address) return C_Int
   with Import, Convention => C, External_Name => "accept";

   function C_Receive
     (File   : C_Int;
      Data   : System.Address;
      Length : Interfaces.C.size_t;
      Flags  : C_Int) return Interfaces.C.long
   with Import, Convention => C, External_Name => "recv";

   function C_Send
     (File   : C_Int;
      Data   : System.Address;
      Length : Interfaces.C.size_t;
      Flags  : C_Int) return Interfaces.C.long
   with Import, Convention => C, External_Name => "send";

   function C_Write
     (File : C_Int; Data : System.Address; Length : Interfaces.C.size_t)
      return Interfaces.C.long
   with Import, Convention => C, External_Name => "write";

   function C_Read
     (File : C_Int; Data : System.Address; Length : Interfaces.C.size_t)
      return Interfaces.C.long
   with Import, Convention => C, External_Name => "read";

   function C_Open (Path : System.Address; Flags : C_Int) return C_Int
   with Import, Convention => C, External_Name => "open";

   function C_Get_Line (File : C_Int; To : System.Address) return C_Int
   with Import, Convention => C, External_Name => "tcgetattr";

   procedure C_Make_Raw (Line : System.Address)
   with Import, Convention => C, External_Name => "cfmakeraw";

   function C_Set_Line
     (File, When_To : C_Int; From : System.Address) return C_Int
   with Import, Convention => C, External_Name => "tcsetattr";

   function C_Shutdown (File, How : C_Int) return C_Int
   with Import, Convention => C, External_Name => "shutdown";

   function C_Close (File : C_Int) return C_Int
   with Import, Convention => C, External_Name => "close";

   function C_Get_Environment
     (Name : Interfaces.C.char_array) return Interfaces.C.Strings.chars_ptr
   with Import, Convention => C, External_Name => "getenv";

   function C_Error return C_Int
   with Import, Convention => C, External_Name => "__get_errno";
   --  errno of the calling task, by the Ada run-time library.

   function C_To_Network
     (Value : Interfaces.Unsigned_16) return Interfaces.Unsigned_16
   with Import, Convention => C, External_Name => "htons";
   --  The same function converts in both directions.

   function C_Host_To_Network
     (Value : Interfaces.Unsigned_32) return Interfaces.Unsigned_32
   with Import, Convention => C, External_Name => "htonl";

   Internet        : constant C_Int := 2;
   Can_Family      : constant C_Int := 29;
   Stream          : constant C_Int := 1;
   Raw_Socket      : constant C_Int := 3;
   Close_On_Exec   : constant C_Int := 8#2000000#;
   Socket_Level    : constant C_Int := 1;
   Reuse_Address   : constant C_Int := 2;
   Receive_Limit   : constant C_Int := 20;
   Tcp_Level       : constant C_Int := 6;
   No_Delay        : constant C_Int := 1;
   No_Signal       : constant C_Int := 16#4000#;
   Wait_For_All    : constant C_Int := 16#100#;
   No_Wait         : constant C_Int := 16#40#;
   Both_Ways       : constant C_Int := 2;
   Standard_Output : constant C_Int := 1;
   Standard_Error  : constant C_Int := 2;
   Local_Host      : constant := 16#7F00_0001#;

   Interrupted     : constant C_Int := 4;
   Try_Again       : constant C_Int := 11;
   Invalid         : constant C_Int := 22;
   Not_A_Socket    : constant C_Int := 88;
   Network_Down    : constant C_Int := 100;
   No_Room         : constant C_Int := 105;
   --  Values of errno.

   Both_Directions : constant C_Int := 2;
   No_Terminal     : constant C_Int := 8#400#;
   At_Once         : constant C_Int := 0;

   type Line_Settings is array (1 .. 32) of Interfaces.Unsigned_64;
   --  Larger than a struct termios.

end Ravenchart.Can.Linux_Calls;
