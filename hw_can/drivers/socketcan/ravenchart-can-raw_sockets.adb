--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces.C;
with System;
with Ravenchart.Can.Linux_Calls;

package body Ravenchart.Can.Raw_Sockets
  with SPARK_Mode => Off
--  ASM-011. Sockets are reached through the C library, by address.
is
   use type Interfaces.C.int;
   use type Interfaces.C.long;
   use type Interfaces.C.unsigned;
   use type Interfaces.Unsigned_8;

   use Linux_Calls;

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

   Can_Address_Length : constant C_Int := 24;

   function C_Index (Name : System.Address) return Interfaces.C.unsigned
   with Import, Convention => C, External_Name => "if_nametoindex";

   Raw_Protocol    : constant C_Int := 1;
   Raw_Level       : constant C_Int := 101;
   Error_Filter    : constant C_Int := 2;
   Fd_Frames_Too   : constant C_Int := 5;
   Frame_Length    : constant := 16;
   Fd_Frame_Length : constant := 72;
   --  Numbers of linux/can.h and linux/can/raw.h.

   function Failure return Outcome
   is (case C_Error is
         when No_Room | Try_Again => Busy,
         when Network_Down        => Down,
         when others              => Gone);
   --  The failure of the preceding call.

   ----------
   -- Open --
   ----------

   procedure Open
     (Name    : String;
      With_Fd : Boolean;
      Opened  : out Socket;
      Result  : out Opening)
   is
      All_Of  : aliased Interfaces.Unsigned_32 := 16#1FFF_FFFF#;
      Yes     : aliased C_Int := 1;
      Address : aliased Can_Address;
      File    : constant C_Int :=
        C_Socket (Can_Family, Raw_Socket + Close_On_Exec, Raw_Protocol);
      C_Name  : String (1 .. Name_Limit + 1) := (others => ASCII.NUL);
      Index   : Interfaces.C.unsigned;
      Status  : C_Int;
   begin
      Opened := No_Socket;
      Result := No_Can;
      if File < 0 then
         return;
      end if;
      C_Name (1 .. Name'Length) := Name;
      Index         := C_Index (C_Name'Address);
      Address.Index := C_Int (Index);
      Status := C_Set_Option
        (File, Raw_Level, Error_Filter, All_Of'Address, 4);
      if With_Fd and then Status = 0 then
         Status := C_Set_Option
           (File, Raw_Level, Fd_Frames_Too, Yes'Address, C_Int'Size / 8);
      end if;
      if Index /= 0 and then Status = 0 then
         Status := C_Bind (File, Address'Address, Can_Address_Length);
      end if;
      if Index /= 0 and then Status = 0 then
         Opened := Socket (File);
         Result := Joined;
      else
         Status := C_Close (File);
         Result := No_Interface;
      end if;
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
            --  The length gives the format, on kernels of any age.
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
         Result := Refused;
      else
         Result := Failure;
      end if;
   end Send;

end Ravenchart.Can.Raw_Sockets;
