"""h5py, which only HDF5 files need."""
import importlib


def h5py_for(what):
    """The package, or an error that says how to get it."""
    try:
        return importlib.import_module("h5py")
    except ImportError as error:
        raise ImportError(f"{what} needs h5py: pip install plm[hdf5]") from error
