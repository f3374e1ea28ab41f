with Interfaces.C.Strings;
with System;

package body Ravenchart.Can.Raw_Sockets
  with SPARK_Mode => Off
--  ASM-011. Sockets are reached through the C library, by address.
is
   use type Interfaces.C.int;
   use type Interfaces.C.long;
   use type Interfaces.C.Strings.chars_ptr;
   use type Interfaces.C.unsigned;
   use type Interfaces.Unsigned_8;

   subtype C_Int is Interfaces.C.int;

   --  The C library

   type Padding is array (1 .. 4) of Interfaces.Unsigned_32
   with Convention => C;

   type Can_Address is record
      Family : Interfaces.Unsigned_16 := 29;
      Unused : Interfaces.Unsigned_16 := 0;
      Index  : C_Int := 0;
      Rest   : Padding := (others => 0);
   end record
   with Convention => C;
   --  struct sockaddr_can: the number of an interface.

   Address_Length : constant C_Int := 24;

   function C_Socket (Domain, Kind, Protocol : C_Int) return C_Int
   with Import, Convention => C, External_Name => "socket";

   function C_Set_Option
     (File, Level, Name : C_Int; Value : System.Address; Length : C_Int)
      return C_Int
   with Import, Convention => C, External_Name => "setsockopt";

   function C_Bind
     (File : C_Int; Name : System.Address; Length : C_Int) return C_Int
   with Import, Convention => C, External_Name => "bind";

   function C_Index
     (Name : Interfaces.C.char_array) return Interfaces.C.unsigned
   with Import, Convention => C, External_Name => "if_nametoindex";

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

   function C_Close (File : C_Int) return C_Int
   with Import, Convention => C, External_Name => "close";

   function C_Error return C_Int
   with Import, Convention => C, External_Name => "__get_errno";
   --  errno of the calling task, by the Ada run-time library.

   function C_Get_Environment
     (Name : Interfaces.C.char_array) return Interfaces.C.Strings.chars_ptr
   with Import, Convention => C, External_Name => "getenv";

   --  The numbers of Linux

   Can_Family      : constant C_Int := 29;
   Raw_Socket      : constant C_Int := 3;
   Close_On_Exec   : constant C_Int := 8#2000000#;
   Raw_Protocol    : constant C_Int := 1;
   Raw_Level       : constant C_Int := 101;
   Error_Filter    : constant C_Int := 2;
   No_Wait         : constant C_Int := 16#40#;
   Fd_Frames_Too   : constant C_Int := 5;
   Frame_Length    : constant := 16;
   Fd_Frame_Length : constant := 72;
   Standard_Output : constant C_Int := 1;
   Standard_Error  : constant C_Int := 2;
   No_Room         : constant C_Int := 105;
   Try_Again       : constant C_Int := 11;
   Interrupted     : constant C_Int := 4;
   Network_Down    : constant C_Int := 100;
   Invalid         : constant C_Int := 22;

   Complained : Boolean := False
   with Atomic;
   --  An open that fails is tried again; one message is enough.

   function Interface_Name return String;
   --  What RAVENCHART_CAN_INTERFACE says, or can0.

   procedure Say (File : C_Int; Text : String);
   --  Write Text to File, unbuffered.

   procedure Complain (Reason : String);
   --  Say once on standard error why there is no socket.

   function Failure return Outcome
   is (case C_Error is
         when No_Room | Try_Again => Busy,
         when Network_Down        => Down,
         when others              => Gone);
   --  What the call before it has failed of.

   --------------------
   -- Interface_Name --
   --------------------

   function Interface_Name return String is
      Setting : constant Interfaces.C.Strings.chars_ptr :=
        C_Get_Environment
          (Interfaces.C.To_C ("RAVENCHART_CAN_INTERFACE"));
   begin
      return
        (if Setting = Interfaces.C.Strings.Null_Ptr
         then "can0"
         else Interfaces.C.Strings.Value (Setting));
   end Interface_Name;

   ---------
   -- Say --
   ---------

   procedure Say (File : C_Int; Text : String) is
      Line    : constant String := Text & ASCII.LF;
      Ignored : Interfaces.C.long;
   begin
      Ignored := C_Write (File, Line'Address, Line'Length);
   end Say;

   --------------
   -- Complain --
   --------------

   procedure Complain (Reason : String) is
   begin
      if not Complained then
         Complained := True;
         Say (Standard_Error, "error: can: " & Reason);
      end if;
   end Complain;

   ----------
   -- Open --
   ----------

   procedure Open (With_Fd : Boolean; Opened : out Socket) is
      Name    : constant String := Interface_Name;
      All_Of  : aliased Interfaces.Unsigned_32 := 16#1FFF_FFFF#;
      Yes     : aliased C_Int := 1;
      Address : aliased Can_Address;
      File    : constant C_Int :=
        C_Socket (Can_Family, Raw_Socket + Close_On_Exec, Raw_Protocol);
      Index   : constant Interfaces.C.unsigned :=
        C_Index (Interfaces.C.To_C (Name));
      Result  : C_Int;
   begin
      Opened := No_Socket;
      if File < 0 then
         Complain ("this system has no SocketCAN; trying again");
         return;
      end if;
      Address.Index := C_Int (Index);
      Result := C_Set_Option
        (File, Raw_Level, Error_Filter, All_Of'Address, 4);
      if With_Fd and then Result = 0 then
         Result := C_Set_Option
           (File, Raw_Level, Fd_Frames_Too, Yes'Address, C_Int'Size / 8);
      end if;
      if Index /= 0 and then Result = 0 then
         Result := C_Bind (File, Address'Address, Address_Length);
      end if;
      if Index = 0 or else Result /= 0 then
         Complain ("there is no CAN interface " & Name & "; trying again");
         Result := C_Close (File);
         return;
      end if;
      Say (Standard_Output, "can: socketcan on " & Name);
      Opened := Socket (File);
   end Open;

   -------------
   -- Receive --
   -------------

   procedure Receive
     (From   : Socket;
      Item   : out Socket_Frames.Item;
      Result : out Outcome)
   is
      Read : Interfaces.C.long;
   begin
      loop
         Item := (others => <>);
         Read := C_Receive
           (C_Int (From), Item'Address, Fd_Frame_Length, 0);
         if Read in Frame_Length | Fd_Frame_Length then
            --  The length tells the format, on kernels of any age.
            Item.Flags :=
              (if Read = Fd_Frame_Length
               then Item.Flags or Socket_Frames.Fd_Flag else 0);
            Result     := Done;
            return;
         end if;
         exit when Read >= 0
           or else C_Error not in Interrupted | No_Room | Try_Again;
      end loop;
      Item   := (others => <>);
      Result := (if Read < 0 and then Failure = Down then Down else Gone);
   end Receive;

   ----------
   -- Send --
   ----------

   procedure Send
     (To : Socket; Item : Socket_Frames.Item; Result : out Outcome)
   is
      Copy   : aliased constant Socket_Frames.Item := Item;
      Length : constant Interfaces.C.size_t :=
        (if Socket_Frames.Is_Fd (Item)
         then Fd_Frame_Length else Frame_Length);
      Sent   : constant Interfaces.C.long :=
        C_Send (C_Int (To), Copy'Address, Length, No_Wait);
   begin
      if Sent = Interfaces.C.long (Length) then
         Result := Done;
      elsif Socket_Frames.Is_Fd (Item) and then C_Error = Invalid then
         Complain (Interface_Name & " is not set up for CAN FD (fd on)");
         Result := Refused;
      else
         Result := Failure;
      end if;
   end Send;

   -----------
   -- Close --
   -----------

   procedure Close (Old : Socket) is
      Ignored : C_Int;
   begin
      Ignored := C_Close (C_Int (Old));
   end Close;

end Ravenchart.Can.Raw_Sockets;
