--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Hand_Written is
   use type Chart_Bench.Count;

   procedure Count (Value : in out Chart_Bench.Count) is
   begin
      Value := (if Value < 1000 then Value + 1 else 0);
   end Count;

   procedure Enter_One (Self : in out Machine; Where : Leaf) is
   begin
      Count (Self.Entries);
      Count (Self.Entries);
      Self.Where := Where;
   end Enter_One;

   procedure Exit_One (Self : in out Machine) is
   begin
      Count (Self.Exits);
      Count (Self.Exits);
   end Exit_One;

   procedure In_One_Outer
     (Self  : in out Machine;
      Item  : Event;
      Taken : out Boolean) is
   begin
      case Item is
         when Reset =>
            Exit_One (Self);
            Enter_One (Self, One_Leaf);
            Taken := True;
         when others =>
            Taken := False;
      end case;
   end In_One_Outer;

   procedure In_One_Inner
     (Self  : in out Machine;
      Item  : Event;
      Taken : out Boolean) is
   begin
      case Item is
         when Back =>
            Count (Self.Exits);
            Count (Self.Entries);
            Self.Where := One_Leaf;
            Taken      := True;
         when others =>
            In_One_Outer (Self, Item, Taken);
      end case;
   end In_One_Inner;

   procedure In_Two_Outer
     (Self  : in out Machine;
      Item  : Event;
      Taken : out Boolean) is
   begin
      case Item is
         when Reset =>
            Exit_One (Self);
            Enter_One (Self, Two_Leaf);
            Taken := True;
         when others =>
            Taken := False;
      end case;
   end In_Two_Outer;

   procedure Start (Self : in out Machine) is
   begin
      Enter_One (Self, One_Leaf);
   end Start;

   procedure Dispatch
     (Self  : in out Machine;
      Item  : Event;
      Taken : out Boolean) is
   begin
      case Self.Where is
         when One_Leaf =>
            case Item is
               when Go =>
                  Exit_One (Self);
                  Enter_One (Self, Two_Leaf);
                  Taken := True;
               when Tick =>
                  Count (Self.Ticks);
                  Taken := True;
               when Reset =>
                  Self.Where := One_Other;
                  Taken      := True;
               when others =>
                  In_One_Inner (Self, Item, Taken);
            end case;
         when One_Other =>
            In_One_Inner (Self, Item, Taken);
         when Two_Leaf =>
            case Item is
               when Back =>
                  Exit_One (Self);
                  Enter_One (Self, One_Leaf);
                  Taken := True;
               when Reset =>
                  Self.Where := Two_Other;
                  Taken      := True;
               when others =>
                  In_Two_Outer (Self, Item, Taken);
            end case;
         when Two_Other =>
            case Item is
               when Unknown =>
                  Taken := True;
               when others =>
                  In_Two_Outer (Self, Item, Taken);
            end case;
      end case;
   end Dispatch;

end Hand_Written;
