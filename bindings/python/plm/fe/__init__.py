"""Files of other codes: matrices in, and what a model needs beside them."""
from .errors import FileError
from .matrices import Matrices, read_matrices, write_matrices
from .deck import Deck, read_deck
from .mesh import read_mesh
