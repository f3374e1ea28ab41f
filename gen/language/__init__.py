"""What a model is written in: terms, types, expressions, intervals, units and names."""
