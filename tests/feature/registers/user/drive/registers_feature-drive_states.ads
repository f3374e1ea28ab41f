--  What the driver remembers of a drive: where its axis was calibrated to.

package Registers_Feature.Drive_States
with SPARK_Mode
is
   type State is record
      Zero : Angle := 0;
   end record;
end Registers_Feature.Drive_States;
