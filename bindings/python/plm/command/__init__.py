"""The command plm: from a deck or matrices to the curve, in a shell."""
from .run import main
