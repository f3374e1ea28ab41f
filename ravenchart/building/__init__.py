"""From a model to its program: checked, generated, compiled; and the tools outside."""
