package body Nodes is

   use type Ravenchart.Can.Frame_Format;
   use type Ravenchart.Can.Identifier;

   function Accepts
     (Id : Ravenchart.Can.Identifier; Format : Ravenchart.Can.Frame_Format)
      return Boolean
   is (Format = Ravenchart.Can.Standard or else Id >= 16#100#);

end Nodes;
