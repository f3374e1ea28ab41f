"""An analysis as people read it: table, report, pictures, JSON."""
