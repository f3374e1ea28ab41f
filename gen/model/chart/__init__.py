"""The geometry of charts: where vertices stand, what a transition leaves and enters."""
