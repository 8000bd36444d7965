"""A curve with its harmonics and its contact in an HDF5 file, for MATLAB, Octave and whatever else reads HDF5."""
import numpy

from .. import _c
from .replacing import replacing
from .with_h5py import h5py_for

LARGEST = 2**28  # bytes; more must be asked for


def write_hdf5(path, branch, dofs=None, n_times=64, largest=LARGEST):
    """Everything that is known of a curve: its results by key (arrays with a value for each point; numbers and texts as
    attributes of the file), and of every point

        harmonics/dof            n                            the DOFs, from 0
        harmonics/coefficients   n_points x (2 H + 1) x n     a0, a1, b1, ..., aH, bH
        harmonics/amplitude      n_points x n                 half peak to peak
        contact/time             n_times                      fraction of the period
        contact/penetration, force, closed    n_points x n_pairs x n_times
        contact/closed_share     n_points x n_pairs           share of the period

    MATLAB and Octave show arrays with their dimensions in the opposite order. dofs: None, all DOFs. A file beyond `largest` bytes
    is refused: then name the DOFs, or give a larger number.
    path: of the file that is written. branch: a plm.Branch. n_times: instants of the period.

        plm.fe.write_hdf5("curve.h5", response.curve, dofs=[0, 1])
    """
    h5py = h5py_for("write_hdf5")
    dofs = range(branch.n_dof) if dofs is None else numpy.atleast_1d(dofs).tolist()
    n_points, rows, n_pairs = len(branch), 2 * branch.n_harmonics + 1, branch.n_pairs
    size = 8 * n_points * (rows + 1) * len(dofs) + 17 * n_points * n_pairs * n_times
    if size > largest:
        raise ValueError(f"{len(dofs)} DOFs and {n_pairs} pairs at {n_points} points would take {size / 1e6:.0f} MB in {path}; name "
                         f"fewer DOFs, or allow that by `largest`")
    with replacing(path) as beside, h5py.File(beside, "w") as file:
        _put_results(file, branch)
        _put_harmonics(file.create_group("harmonics"), branch, dofs)
        if n_pairs:
            _put_contact(file.create_group("contact"), branch, n_times)


def _put_results(file, branch):
    for name, key in branch.keys.items():
        value = branch.get(name)
        if key.type in (_c.TYPE_ARRAY, _c.TYPE_INT_ARRAY):
            file[name] = value
            file[name].attrs["description"] = key.description
        else:
            file.attrs[name] = value


def _put_harmonics(group, branch, dofs):
    n_points, rows = len(branch), 2 * branch.n_harmonics + 1
    group["dof"] = numpy.array(dofs, dtype=numpy.int64)
    coefficients = group.create_dataset("coefficients", (n_points, rows, len(dofs)), float)
    amplitude = group.create_dataset("amplitude", (n_points, len(dofs)), float)
    coefficients.dims[0].label, coefficients.dims[1].label, coefficients.dims[2].label = "point", "a0 a1 b1 ... aH bH", "dof"
    for point in range(n_points):
        if len(dofs) == branch.n_dof:
            coefficients[point] = branch.coefficients(point)[:, dofs]
        else:  # fields of large models are not made for a few of their DOFs
            coefficients[point] = numpy.stack([branch.coefficients(point, dof) for dof in dofs], axis=1)
    for j, dof in enumerate(dofs):
        amplitude[:, j] = branch.amplitude(dof)


def _put_contact(group, branch, n_times):
    shape = (len(branch), branch.n_pairs, n_times)
    group["time"] = numpy.arange(n_times) / n_times
    penetration, force = (group.create_dataset(name, shape, float) for name in ("penetration", "force"))
    closed = group.create_dataset("closed", shape, numpy.uint8)
    share = group.create_dataset("closed_share", shape[:2], float)
    for point in range(shape[0]):
        contact = branch.contact(point, n_times)
        penetration[point], force[point], closed[point] = contact.penetration, contact.force, contact.closed
        share[point] = branch.closed_share(point)
