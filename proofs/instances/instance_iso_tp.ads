--  ISO-TP: what is no generic is proved as it is.

with Ravenchart.Can.Iso_Tp.Receivers;
with Ravenchart.Can.Iso_Tp.Senders;

package Instance_Iso_Tp
  with SPARK_Mode
is
   package Receivers renames Ravenchart.Can.Iso_Tp.Receivers;
   package Senders renames Ravenchart.Can.Iso_Tp.Senders;
end Instance_Iso_Tp;
