--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Gatherings
  with SPARK_Mode, Refined_State => (State => Shared)
is
   use type Answers.Answer;
   use type Answers.Outcome;

   type Waiting_List is array (Element_Number) of Boolean;

   type Call is record
      Waits : Waiting_List := (others => False);
      --  The elements whose calls have not ended.
      Worst : Answers.Answer := Answers.Replied;
      --  Of the calls that have ended.
      Parts : Part_List := (others => No_Part);
      --  The replies.
   end record;

   function Is_Under_Way (Item : Call) return Boolean
   is (for some Element in Element_Number => Item.Waits (Element))
   with Global => null;

   function Outcome_Of (Worst : Answers.Answer) return Answers.Outcome
   is (case Worst is
         when Answers.Replied   => Answers.All_Replied,
         when Answers.Refused   => Answers.Some_Refused,
         when Answers.Timed_Out => Answers.Some_Timed_Out)
   with Global => null;

   procedure Start (Item : in out Call; Is_Refused : out Boolean)
   with
     Global => null,
     Post   =>
       Is_Refused = Is_Under_Way (Item'Old)
       and then
         (if Is_Refused
          then Item = Item'Old
          else
            Item.Worst = Answers.Replied
            and then (for all Element in Element_Number =>
                        Item.Waits (Element)));

   procedure Conclude
     (Item    : in out Call;
      Element : Element_Number;
      Given   : Answers.Answer;
      Part    : Part_Type;
      Result  : out Answers.Outcome)
   with
     Global => null,
     Post   =>
       (if not Item'Old.Waits (Element)
        then Item = Item'Old and then Result = Answers.Not_Yet
        else
          (for all Other in Element_Number =>
             Item.Waits (Other)
             = (Other /= Element and then Item'Old.Waits (Other)))
          and then Item.Worst = Answers.Answer'Max (Item'Old.Worst, Given)
          and then
            (for all Other in Element_Number =>
               Item.Parts (Other)
               = (if Other = Element and then Given = Answers.Replied
                  then Part
                  else Item'Old.Parts (Other)))
          and then
            Result
            = (if Is_Under_Way (Item)
               then Answers.Not_Yet
               else Outcome_Of (Item.Worst)));
   --  An answer that no call waits for changes nothing.

   protected Shared
     with Priority => Ceiling
   is
      procedure Start (Is_Refused : out Boolean);

      procedure Conclude
        (Element : Element_Number;
         Given   : Answers.Answer;
         Part    : Part_Type;
         Result  : out Answers.Outcome;
         Parts   : out Part_List);

   private
      Item : Call;
   end Shared;

   procedure Start (Item : in out Call; Is_Refused : out Boolean) is
   begin
      Is_Refused := Is_Under_Way (Item);
      if not Is_Refused then
         Item.Waits := (others => True);
         Item.Worst := Answers.Replied;
      end if;
   end Start;

   procedure Conclude
     (Item    : in out Call;
      Element : Element_Number;
      Given   : Answers.Answer;
      Part    : Part_Type;
      Result  : out Answers.Outcome) is
   begin
      Result := Answers.Not_Yet;
      if Item.Waits (Element) then
         Item.Waits (Element) := False;
         Item.Worst := Answers.Answer'Max (Item.Worst, Given);
         if Given = Answers.Replied then
            Item.Parts (Element) := Part;
         end if;
         if not Is_Under_Way (Item) then
            Result := Outcome_Of (Item.Worst);
         end if;
      end if;
   end Conclude;

   protected body Shared is

      procedure Start (Is_Refused : out Boolean) is
      begin
         Start (Item, Is_Refused);
      end Start;

      procedure Conclude
        (Element : Element_Number;
         Given   : Answers.Answer;
         Part    : Part_Type;
         Result  : out Answers.Outcome;
         Parts   : out Part_List) is
      begin
         Conclude (Item, Element, Given, Part, Result);
         Parts := Item.Parts;
      end Conclude;

   end Shared;

   procedure Start (Is_Refused : out Boolean)
   with Refined_Global => (In_Out => Shared)
   is
   begin
      Shared.Start (Is_Refused);
   end Start;

   procedure Conclude
     (Element : Element_Number;
      Given   : Answers.Answer;
      Part    : Part_Type;
      Result  : out Answers.Outcome;
      Parts   : out Part_List)
   with Refined_Global => (In_Out => Shared)
   is
   begin
      Shared.Conclude (Element, Given, Part, Result, Parts);
   end Conclude;

end Ravenchart.Gatherings;
