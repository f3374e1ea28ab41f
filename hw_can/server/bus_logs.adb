--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Streams.Stream_IO;
with Ada.Text_IO;
with Bus_Options;
with Ravenchart.Can.Bus_Clients;
with Ravenchart.Can.Bus_Names;
with Ravenchart.Can.Bus_Queues;
with Ravenchart.Can.Bus_Records;

package body Bus_Logs is

   use Ravenchart.Can;
   use type Bus_Records.Bit_Rate;

   Queue   : Bus_Queues.Queue renames Bus_Options.Bus.Log.Records;
   Profile : Bus_Clients.Profile renames Bus_Options.Bus.Profile;
   File    : Ada.Streams.Stream_IO.File_Type;

   procedure Put (Bytes : Bus_Records.Image);
   --  Write one record.

   ---------
   -- Put --
   ---------

   procedure Put (Bytes : Bus_Records.Image) is
      use Ada.Streams;
      Elements : Stream_Element_Array (1 .. Bytes'Length);
   begin
      for I in Bytes'Range loop
         Elements (Stream_Element_Offset (I)) := Stream_Element (Bytes (I));
      end loop;
      Ada.Streams.Stream_IO.Write (File, Elements);
   end Put;

   ----------
   -- Open --
   ----------

   procedure Open is
      Name : constant String := Bus_Options.Log_File;
   begin
      if Name /= "" then
         Ada.Streams.Stream_IO.Create
           (File, Ada.Streams.Stream_IO.Out_File, Name);
         Put
           (Bus_Records.Welcome
              (Bus_Names.Text (Profile.Name), Profile.Data > 0,
               Profile.Nominal, Profile.Data, Profile.Began, 0, 255));
      end if;
   exception
      when Ada.Streams.Stream_IO.Name_Error
         | Ada.Streams.Stream_IO.Use_Error =>
         Ada.Text_IO.Put_Line
           (Ada.Text_IO.Standard_Error,
            "error: " & Name & " cannot be written");
         raise Bus_Options.Wrong;
   end Open;

   -----------
   -- Write --
   -----------

   procedure Write is
   begin
      if Ada.Streams.Stream_IO.Is_Open (File) and then Queue.Count > 0 then
         while Queue.Count > 0 loop
            Put (Bus_Queues.Item (Queue, 1).Bytes);
            Bus_Queues.Drop_Head (Queue);
         end loop;
         Ada.Streams.Stream_IO.Flush (File);
      end if;
   end Write;

   -----------
   -- Close --
   -----------

   procedure Close is
   begin
      if Ada.Streams.Stream_IO.Is_Open (File) then
         Ada.Streams.Stream_IO.Close (File);
      end if;
   end Close;

end Bus_Logs;
