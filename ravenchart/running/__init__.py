"""What a run of a controller on the bench is made of."""
