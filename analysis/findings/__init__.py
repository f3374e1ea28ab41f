"""What an analysis says of a model: missed deadlines, claims, advice."""
