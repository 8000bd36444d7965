"""Other codes' files in, results out to viewers."""
from .hdf5 import write_hdf5
from .vtkhdf import write_vtkhdf
from .vtu import write_vtu, write_vtu_series
