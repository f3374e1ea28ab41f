"""The one intermediate representation, and nothing that computes: `System` and its records."""
