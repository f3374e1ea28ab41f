--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces.C;
with Ravenchart.Can.Linux_Calls;

package body Ravenchart.Can.Serial_Lines
  with SPARK_Mode => Off
--  ASM-005. Lines are reached through the C library, by address.
is
   use type Interfaces.C.int;
   use type Interfaces.C.long;
   use Linux_Calls;

   ----------
   -- Open --
   ----------

   procedure Open
     (Path   : String;
      First  : String;
      Line   : out Sockets.Socket;
      Result : out Outcome)
   is
      C_Path : String (1 .. Path_Limit + 1) := (others => ASCII.NUL);
      Modes  : aliased Line_Settings := (others => 0);
      File   : C_Int;
      Status : C_Int;
   begin
      C_Path (1 .. Path'Length) := Path;
      Line   := Sockets.No_Socket;
      Result := No_Device;
      File   := C_Open
        (C_Path'Address, Both_Directions + No_Terminal + Close_On_Exec);
      if File < 0 then
         return;
      end if;
      Status := C_Get_Line (File, Modes'Address);
      if Status = 0 then
         C_Make_Raw (Modes'Address);
         Status := C_Set_Line (File, At_Once, Modes'Address);
      end if;
      if Status = 0
        and then C_Write (File, First'Address, First'Length) = First'Length
      then
         Line   := Sockets.Socket (File);
         Result := Opened;
      else
         Status := C_Close (File);
         Result := No_Line;
      end if;
   end Open;

end Ravenchart.Can.Serial_Lines;
