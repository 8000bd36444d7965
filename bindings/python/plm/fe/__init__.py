"""Files of other codes: matrices in, and what a model needs beside them."""
from .errors import FileError
from .deck import Deck, read_deck
from .mesh import read_mesh
