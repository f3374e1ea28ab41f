"""CAN databases of others as parts of a model."""
