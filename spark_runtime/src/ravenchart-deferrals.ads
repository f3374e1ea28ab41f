--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The events that a region has deferred, and the choice of the next one.
--
--  A kept event is due while no active state defers it. The exit of a state
--  that defers it makes it due as well, even if the state is entered again.
--
--  Guarantees   order of arrival, no heap, total operations
--  Tasking      none of its own: the region's activity owns its store
--  Timing       linear in Capacity and in the number of event names

with Ravenchart.Event_Lists;

generic
   type Event is private;
   Null_Event : Event;
   --  Fills the places that hold no event.
   type Event_Name is (<>);
   with function Name_Of (Item : Event) return Event_Name;
   Capacity : Positive;
   --  The most events that are kept; a deferred event beyond them is lost.
   type Configuration is private;
   with function Is_Deferred
     (Name : Event_Name; Active : Configuration) return Boolean;
   --  Does an active state defer the event?
   type Domain is (<>);
   with function Is_Freed
     (Name : Event_Name; D : Domain; Active : Configuration) return Boolean;
   --  Does a transition that leaves D exit a state that defers the event?
package Ravenchart.Deferrals
  with SPARK_Mode, Pure
is
   package Lists is new Event_Lists
     (Event      => Event,
      Null_Event => Null_Event,
      Capacity   => Capacity);

   use type Lists.List;

   type Freed_Counts is array (Event_Name) of Lists.Length;

   type Store is record
      Kept  : Lists.List;
      Freed : Freed_Counts := (others => 0);
      Lost  : Boolean := False;
   end record;
   --  The events, oldest first. For each name, an exit freed the first Freed
   --  events of that name. Lost: an event found no room.

   function Is_Due
     (S : Store; Active : Configuration; Index : Lists.Length) return Boolean
   is (not Is_Deferred (Name_Of (Lists.Element (S.Kept, Index)), Active)
       or else Index <= S.Freed (Name_Of (Lists.Element (S.Kept, Index))))
   with
     Global => null,
     Pre    => Index in 1 .. Lists.Count (S.Kept);
   --  Does no active state defer the event, or did an exit free it?

   function Due (S : Store; Active : Configuration) return Lists.Length
   with
     Global => null,
     Post   =>
       Due'Result <= Lists.Count (S.Kept)
       and then (if Due'Result > 0 then Is_Due (S, Active, Due'Result))
       and then (for all I in 1 .. Lists.Count (S.Kept) =>
                   (if Due'Result = 0 or else I < Due'Result
                    then not Is_Due (S, Active, I)));
   --  The position of the oldest event that is due; 0 when none is.

   function Is_Taken
     (Before : Store; Active : Configuration; Item : Event; After : Store)
      return Boolean
   is (Due (Before, Active) > 0
       and then Item = Lists.Element (Before.Kept, Due (Before, Active))
       and then Lists.Is_Removed
                  (Before.Kept, Due (Before, Active), After.Kept)
       and then (for all N in Event_Name =>
                   After.Freed (N) =
                     (if Due (Before, Active) <= Before.Freed (N)
                      then Before.Freed (N) - 1
                      else Before.Freed (N)))
       and then After.Lost = Before.Lost)
   with
     Ghost,
     Global => null;
   --  Is Item the oldest event that was due, and the only one removed?

   procedure Take_Due
     (S      : in out Store;
      Active : Configuration;
      Item   : out Event;
      Taken  : out Boolean)
   with
     Global => null,
     Post   =>
       Taken = (Due (S'Old, Active) > 0)
       and then (if Taken
                 then Is_Taken (S'Old, Active, Item, S)
                 else S = S'Old);
   --  Take the oldest event that is due out of S; Null_Event when none is.

   function Is_Changed
     (Before, After : Store;
      Is_Deferral   : Boolean;
      Item          : Event;
      D             : Domain;
      Active        : Configuration) return Boolean
   is ((if Is_Deferral
        then Lists.Is_Appended (Before.Kept, Item, After.Kept)
             and then After.Lost =
               (Before.Lost or else Lists.Count (Before.Kept) = Capacity)
        else After.Kept = Before.Kept and then After.Lost = Before.Lost)
       and then (for all N in Event_Name =>
                   After.Freed (N) =
                     (if Is_Freed (N, D, Active)
                      then Lists.Count (Before.Kept)
                      else Before.Freed (N))))
   with
     Ghost,
     Global => null;
   --  Is After the result for Before of a transition from D to Active?

   procedure Change
     (S           : in out Store;
      Is_Deferral : Boolean;
      Item        : Event;
      D           : Domain;
      Active      : Configuration)
   with
     Global => null,
     Post   => Is_Changed (S'Old, S, Is_Deferral, Item, D, Active);
   --  The effect of a transition: a deferral keeps Item, and the exits in D
   --  free the events that their states defer.

end Ravenchart.Deferrals;
