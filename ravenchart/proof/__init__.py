"""gnatprove run, what it found, and the record of it."""
