"""How long the rules of behaviour may take, and what says that it was not enough.

Apart from the rules, which import a solver: a result that is kept needs none.
"""

SECONDS = 10.0
"""What the check of a model may take."""

UNFINISHED = "RV-1110"
"""The code of a check that was not finished."""
