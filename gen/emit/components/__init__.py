"""What all instances of a component share."""
