"""From entries, with rows or with labels, to symmetric sparse matrices on one list of DOFs."""
import numpy
import scipy.sparse

from .errors import FileError

SAME = 1e-9  # of the largest entry: further apart, two entries that mirror each other are not the same number
LABEL_LIMIT = 2**50
DIRECTIONS = 16  # of a key; node * 16 + direction


def symmetric(n, rows, columns, values, fail, notes=None, whole=False):
    """The whole symmetric matrix (CSR, n x n) of entries given by one triangle, either, or both.

    whole  both triangles are there, or the matrix is not symmetric; else it is found out
    fail   fail(k, text) refuses entry k, or the matrix as a whole where k is None
    notes  a list that takes what is worth saying
    """
    given = scipy.sparse.coo_matrix((values, (rows, columns)), shape=(n, n)).tocsr()
    if given.nnz < len(values) and notes is not None:
        notes.append(f"{len(values) - given.nnz} entries stand at a place that has one already: they were added")
    lower, upper = scipy.sparse.tril(given, -1, "csr"), scipy.sparse.triu(given, 1, "csr")
    lower.eliminate_zeros()
    upper.eliminate_zeros()
    if not whole and (not lower.nnz or not upper.nnz):
        return mirrored(given)
    difference = abs(lower - upper.T.tocsr())
    largest = abs(given).max() if given.nnz else 0.0
    if difference.max() <= SAME * largest:
        if difference.nnz and difference.max() > 0 and notes is not None:
            notes.append(f"the triangles differ by {difference.max() / largest:.1e} of the largest entry: their mean was taken")
        return clean((given + given.T) * 0.5)
    both = lower.astype(bool).multiply(upper.T.astype(bool)).nnz
    if both == 0 and not whole:  # each entry once, on whichever side
        return mirrored(given)
    if not lower.nnz or not upper.nnz:
        fail(None, "is said to be square, or general, but has entries in one triangle only; if it is symmetric, its header must "
             "say so")
    worst = difference.tocoo()
    k = int(numpy.argmax(worst.data))
    i, j = int(worst.row[k]), int(worst.col[k])
    at = numpy.flatnonzero((rows == i) & (columns == j) | (rows == j) & (columns == i))
    fail(int(at[-1]) if len(at) else None,
         f"not symmetric: {given[i, j]:.9g} in row {i + 1}, column {j + 1}, but {given[j, i]:.9g} in row {j + 1}, column {i + 1}")


def mirrored(triangle):
    """The whole matrix of entries given once each."""
    return clean(triangle + triangle.T - scipy.sparse.diags(triangle.diagonal(), format="csr"))


def clean(matrix):
    matrix = matrix.tocsr()
    matrix.sum_duplicates()
    matrix.sort_indices()
    return matrix


def key_of(nodes, directions):
    """One integer for a DOF. Scalars or arrays; |node| < 2^50, direction 0 .. 15."""
    return numpy.asarray(nodes, numpy.int64) * DIRECTIONS + numpy.asarray(directions, numpy.int64)


def dofs_of(keys):
    """(n, 2): node, direction of each key."""
    return numpy.column_stack([keys // DIRECTIONS, keys % DIRECTIONS])


def in_order(keys):
    """Distinct keys: nodes by label, then what has a label below one by how far below, each by direction."""
    keys = numpy.unique(keys)
    node, direction = keys // DIRECTIONS, keys % DIRECTIONS
    return keys[numpy.lexsort((direction, numpy.abs(node), node < 1))]


class Places:
    """Where keys stand in a list of distinct ones; -1: nowhere."""

    def __init__(self, among):
        self._order = numpy.argsort(among, kind="stable")
        self._sorted = numpy.asarray(among)[self._order]

    def __call__(self, keys):
        if not len(self._sorted):
            return numpy.full(len(keys), -1)
        at = numpy.minimum(numpy.searchsorted(self._sorted, keys), len(self._sorted) - 1)
        return numpy.where(self._sorted[at] == keys, self._order[at], -1)


def spread(matrix, keys, onto):
    """The matrix on the DOFs `keys` as one on the DOFs `onto`, which hold them all."""
    if len(keys) == len(onto) and (keys == onto).all():
        return matrix
    entries, at = matrix.tocoo(), Places(onto)(keys)
    return clean(scipy.sparse.coo_matrix((entries.data, (at[entries.row], at[entries.col])), shape=(len(onto), len(onto))))


def check_labels(path, dofs):
    """Refuses a list of DOFs that names one twice."""
    keys = key_of(dofs[:, 0], dofs[:, 1])
    _, first, counts = numpy.unique(keys, return_index=True, return_counts=True)
    if (counts > 1).any():
        node, direction = dofs[first[counts > 1][0]]
        raise FileError(path, 0, f"node {node}, direction {direction} stands twice in the list of DOFs")
