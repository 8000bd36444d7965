"""Files of other codes: matrices in, what a model needs beside them, and results out to viewers."""
from .deck import Deck, read_deck
from .errors import FileError
from .hdf5 import write_hdf5
from .matrices import Matrices, read_matrices, write_matrices
from .mesh import read_mesh
from .vtkhdf import write_vtkhdf
from .vtu import write_vtu, write_vtu_series
