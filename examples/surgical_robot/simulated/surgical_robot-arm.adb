--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with System;

package body Surgical_Robot.Arm
with SPARK_Mode => Off
is
   Lightness : constant := 8;
   --  Microradians in an execution for each milliampere.
   Stride    : constant := 6_000;
   --  Microradians that a drive goes on with each look at it.

   type Places is array (Joint) of Microradians;
   type Moves is array (Joint) of Integer;

   protected Joints
   with Priority => System.Priority'Last
   is
      procedure Move (Item : Joint; Distance : Integer);
      function Place (Item : Joint) return Microradians;
      function Moved (Item : Joint) return Integer;
   private
      At_Places : Places := (others => 0);
      Last      : Moves  := (others => 0);
   end Joints;

   protected body Joints is

      procedure Move (Item : Joint; Distance : Integer) is
         Before : constant Microradians := At_Places (Item);
      begin
         At_Places (Item) :=
           Integer'Max
             (Microradians'First,
              Integer'Min (Microradians'Last, Before + Distance));
         Last (Item) := At_Places (Item) - Before;
      end Move;

      function Place (Item : Joint) return Microradians
      is (At_Places (Item));

      function Moved (Item : Joint) return Integer
      is (Last (Item));

   end Joints;

   procedure Drive (Item : Joint; Milliamperes : Integer) is
   begin
      Joints.Move (Item, Lightness * Milliamperes);
   end Drive;

   procedure Approach (Item : Joint; Goal : Microradians) is
      Distance : constant Integer := Goal - Joints.Place (Item);
   begin
      Joints.Move
        (Item, Integer'Max (-Stride, Integer'Min (Stride, Distance)));
   end Approach;

   function Place (Item : Joint) return Microradians
   is (Joints.Place (Item));

   function Moved (Item : Joint) return Integer
   is (Joints.Moved (Item));
end Surgical_Robot.Arm;
