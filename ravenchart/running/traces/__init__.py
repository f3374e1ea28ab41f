"""The traces of runs and simulations, in the formats of other tools."""
