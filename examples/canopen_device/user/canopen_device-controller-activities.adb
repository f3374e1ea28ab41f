--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The SDO server of the device, written by hand: expedited transfers from
--  and to an object dictionary (CiA 301, SDO services and protocols).

package body Canopen_Device.Controller.Activities
  with SPARK_Mode
is
   use Ravenchart;

   --  The object dictionary

   subtype Octets is Number range 1 .. 4;

   type Content is
     (Fixed, Of_Node, Heartbeat, Setpoint, Actual_Value, At_Setpoint);
   --  The source of a value; Of_Node adds the node number to a fixed one.

   subtype Writable is Content range Heartbeat .. Setpoint;

   type Object is record
      Index    : Canopen_Device.Index;
      Subindex : Octet;
      Size     : Octets;
      Holds    : Content;
      Value    : Number range 0 .. 16#7FFF_FFFF#;
   end record;

   Last : constant := 22;
   None : constant := 0;
   subtype Row is Natural range None .. Last;

   Dictionary : constant array (Row range 1 .. Last) of Object :=
     ((16#1000#, 0, 4, Fixed, 0),                --  no device profile
      (16#1001#, 0, 1, Fixed, 0),                --  error register
      (16#1017#, 0, 2, Heartbeat, 0),            --  producer heartbeat time
      (16#1018#, 0, 1, Fixed, 4),                --  identity
      (16#1018#, 1, 4, Fixed, 0),                --  no vendor
      (16#1018#, 2, 4, Fixed, 16#5256_0001#),    --  product
      (16#1018#, 3, 4, Fixed, 16#0001_0000#),    --  revision
      (16#1018#, 4, 4, Fixed, 1),                --  serial number
      (16#1400#, 0, 1, Fixed, 2),                --  receive PDO 1
      (16#1400#, 1, 4, Of_Node, 16#200#),        --  its identifier
      (16#1400#, 2, 1, Fixed, 16#FF#),           --  takes effect when it comes
      (16#1600#, 0, 1, Fixed, 1),                --  its mapping
      (16#1600#, 1, 4, Fixed, 16#2000_0010#),
      (16#1800#, 0, 1, Fixed, 2),                --  transmit PDO 1
      (16#1800#, 1, 4, Of_Node, 16#4000_0180#),  --  no remote frame
      (16#1800#, 2, 1, Fixed, 1),                --  after each SYNC
      (16#1A00#, 0, 1, Fixed, 2),                --  its mapping
      (16#1A00#, 1, 4, Fixed, 16#2001_0010#),
      (16#1A00#, 2, 4, Fixed, 16#2002_0008#),
      (16#2000#, 0, 2, Setpoint, 0),             --  in 0.1 degC
      (16#2001#, 0, 2, Actual_Value, 0),         --  in 0.1 degC
      (16#2002#, 0, 1, At_Setpoint, 0));         --  1: within 1 degC

   Default_Heartbeat : constant Heartbeat_Time := 200;
   Default_Setpoint  : constant Canopen_Device.Temperature := 200;

   --  Abort codes

   Unknown_Command  : constant Long := 16#0504_0001#;
   Is_Read_Only     : constant Long := 16#0601_0002#;
   Unknown_Object   : constant Long := 16#0602_0000#;
   Wrong_Length     : constant Long := 16#0607_0010#;
   Unknown_Subindex : constant Long := 16#0609_0011#;
   Too_High         : constant Long := 16#0609_0031#;
   Too_Low          : constant Long := 16#0609_0032#;
   No_Error         : constant Long := 0;

   --  Command specifiers

   Abort_Transfer : constant Octet := 16#80#;
   Downloaded     : constant Octet := 16#60#;

   function Is_Download (Command : Octet) return Boolean
   is (Command / 32 = 1);

   function Is_Upload (Command : Octet) return Boolean
   is (Command / 32 = 2);

   function Is_Expedited (Command : Octet) return Boolean
   is (Command / 2 mod 2 = 1);

   function Says_Size (Command : Octet) return Boolean
   is (Command mod 2 = 1);

   function Size_Of (Command : Octet) return Octets
   is (4 - Command / 4 mod 4);
   --  The size that an expedited transfer states.

   function Uploaded (Size : Octets) return Octet
   is (16#43# + 4 * (4 - Size));
   --  The command of an expedited response with so many octets.

   --  Values and their coding in a frame

   Signs : constant := 16#1_0000#;

   function Raw (Value : Canopen_Device.Temperature) return Long
   is (if Value < 0 then Number (Value) + Signs else Number (Value));

   function Signed (Data : Long) return Number
   is (if Data mod Signs >= Signs / 2
       then Data mod Signs - Signs
       else Data mod Signs)
   with Post => Signed'Result in -Signs / 2 .. Signs / 2 - 1;

   function Is_Near
     (Setpoint, Temperature : Canopen_Device.Temperature) return Boolean
   is (abs (Setpoint - Temperature) <= 10);

   function Row_Of
     (Index : Canopen_Device.Index; Subindex : Octet) return Row
   with
     Post =>
       (if Row_Of'Result /= None
        then
          Dictionary (Row_Of'Result).Index = Index
          and then Dictionary (Row_Of'Result).Subindex = Subindex
        else
          (for all Object of Dictionary =>
             Object.Index /= Index or else Object.Subindex /= Subindex));
   --  The row of the object, or None.

   function Has_Index (Index : Canopen_Device.Index) return Boolean
   is (for some Object of Dictionary => Object.Index = Index);

   function Value_Of
     (Object      : Activities.Object;
      Objects     : Canopen_Device.Objects;
      Temperature : Canopen_Device.Temperature;
      Node_Id     : Canopen_Device.Node_Id) return Long
   is (case Object.Holds is
         when Fixed        => Object.Value,
         when Of_Node      => Object.Value + Node_Id,
         when Heartbeat    => Number (Objects.Heartbeat),
         when Setpoint     => Raw (Objects.Setpoint),
         when Actual_Value => Raw (Temperature),
         when At_Setpoint  =>
           (if Is_Near (Objects.Setpoint, Temperature) then 1 else 0));

   procedure Write
     (Object  : Activities.Object;
      Data    : Long;
      Objects : in out Canopen_Device.Objects;
      Fault   : out Long)
   with
     Pre  => Object.Holds in Writable,
     Post => (if Fault /= No_Error then Objects = Objects'Old);
   --  Write the value, or return the reason in Fault.

   procedure Download
     (Request : Transfer;
      Object  : Activities.Object;
      Objects : in out Canopen_Device.Objects;
      Fault   : out Long)
   with
     Pre  => Is_Download (Request.Command),
     Post =>
       (if Fault /= No_Error
          or else Object.Holds not in Writable
          or else not Is_Expedited (Request.Command)
        then Fault /= No_Error and then Objects = Objects'Old);
   --  Write the value of a client's request, if possible.

   procedure Reply
     (Request     : Transfer;
      Temperature : Canopen_Device.Temperature;
      Node_Id     : Canopen_Device.Node_Id;
      Objects     : in out Canopen_Device.Objects;
      Answer      : out Transfer)
   with
     Post =>
       Answer.Index = Request.Index
       and then Answer.Subindex = Request.Subindex
       and then Answer.Number = Request.Number
       and then (if Answer.Command = Abort_Transfer
                 then Answer.Data /= No_Error and then Objects = Objects'Old)
       and then (if (Is_Upload (Request.Command)
                     or else Is_Download (Request.Command))
                   and then not Has_Index (Request.Index)
                 then
                   Answer.Command = Abort_Transfer
                   and then Answer.Data = Unknown_Object)
       and then (if Answer.Command /= Downloaded then Objects = Objects'Old);
   --  The answer to one request; only a download changes an object.

   ------------
   -- Row_Of --
   ------------

   function Row_Of (Index : Canopen_Device.Index; Subindex : Octet) return Row
   is
   begin
      for At_Row in Dictionary'Range loop
         if Dictionary (At_Row).Index = Index
           and then Dictionary (At_Row).Subindex = Subindex
         then
            return At_Row;
         end if;
         pragma
           Loop_Invariant
             (for all Before in 1 .. At_Row =>
                Dictionary (Before).Index /= Index
                or else Dictionary (Before).Subindex /= Subindex);
      end loop;
      return None;
   end Row_Of;

   -----------
   -- Write --
   -----------

   procedure Write
     (Object  : Activities.Object;
      Data    : Long;
      Objects : in out Canopen_Device.Objects;
      Fault   : out Long)
   is
      Wanted : constant Number := Signed (Data);
   begin
      Fault := No_Error;
      case Writable (Object.Holds) is
         when Heartbeat =>
            Objects.Heartbeat := Heartbeat_Time (Data mod Signs);

         when Setpoint  =>
            if Wanted > Number (Canopen_Device.Temperature'Last) then
               Fault := Too_High;
            elsif Wanted < Number (Canopen_Device.Temperature'First) then
               Fault := Too_Low;
            else
               Objects.Setpoint := Canopen_Device.Temperature (Wanted);
            end if;
      end case;
   end Write;

   --------------
   -- Download --
   --------------

   procedure Download
     (Request : Transfer;
      Object  : Activities.Object;
      Objects : in out Canopen_Device.Objects;
      Fault   : out Long) is
   begin
      if not Is_Expedited (Request.Command) then
         Fault := Unknown_Command;
      elsif Object.Holds not in Writable then
         Fault := Is_Read_Only;
      elsif Says_Size (Request.Command)
        and then Size_Of (Request.Command) /= Object.Size
      then
         Fault := Wrong_Length;
      else
         Write (Object, Request.Data, Objects, Fault);
      end if;
   end Download;

   -----------
   -- Reply --
   -----------

   procedure Reply
     (Request     : Transfer;
      Temperature : Canopen_Device.Temperature;
      Node_Id     : Canopen_Device.Node_Id;
      Objects     : in out Canopen_Device.Objects;
      Answer      : out Transfer)
   is
      Found : constant Row := Row_Of (Request.Index, Request.Subindex);
      Fault : Long;
   begin
      Answer := Request;
      if not Is_Upload (Request.Command)
        and then not Is_Download (Request.Command)
      then
         Fault := Unknown_Command;
      elsif not Has_Index (Request.Index) then
         Fault := Unknown_Object;
      elsif Found = None then
         Fault := Unknown_Subindex;
      elsif Is_Upload (Request.Command) then
         Fault := No_Error;
         Answer.Command := Uploaded (Dictionary (Found).Size);
         Answer.Data :=
           Value_Of (Dictionary (Found), Objects, Temperature, Node_Id);
      else
         Download (Request, Dictionary (Found), Objects, Fault);
         Answer.Command := Downloaded;
         Answer.Data := 0;
      end if;
      if Fault /= No_Error then
         Answer.Command := Abort_Transfer;
         Answer.Data := Fault;
      end if;
   end Reply;

   -----------
   -- Serve --
   -----------

   procedure Serve
     (Request     : Canopen_Device.Transfer;
      Order       : Canopen_Device.Order;
      Boots       : Canopen_Device.Count;
      Resets      : Canopen_Device.Count;
      Temperature : Canopen_Device.Temperature;
      Node_Id     : Canopen_Device.Node_Id;
      Objects     : in out Canopen_Device.Objects;
      Answer      : in out Canopen_Device.Transfer) is
   begin
      if Boots /= Objects.Boots then
         Objects.Boots := Boots;
         Objects.Heartbeat := Default_Heartbeat;
      end if;
      if Resets /= Objects.Resets then
         Objects.Resets := Resets;
         Objects.Setpoint := Default_Setpoint;
      end if;
      if Order.Number /= Objects.Orders then
         Objects.Orders := Order.Number;
         Objects.Setpoint := Order.Setpoint;
      end if;
      if Request.Number /= Answer.Number then
         Reply (Request, Temperature, Node_Id, Objects, Answer);
      end if;
   end Serve;
end Canopen_Device.Controller.Activities;
