"""The terms of a model in Ada: types, events, expressions, configurations."""
