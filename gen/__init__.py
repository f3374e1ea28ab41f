"""Model to System to SPARK Ada: the generator half of Ravenchart."""
