"""Contact over the cycle, along the curve, and over the surface."""
import numpy

from .style import COLOURS, FAINT, axes, legend_above, length_unit, styled


@styled
def contact_over_frequency(branch, n_times=64, ax=None):
    """Share of the pairs that are closed, over frequency: mean over the period, and from the least to the most closed.

        plm.plot.contact_over_frequency(hbm.sweep())
    """
    ax = axes(ax, "frequency (Hz)", "closed pairs (%)")
    mean = [100 * branch.closed_share(i).mean() for i in range(len(branch))]
    area = 100 * numpy.array([branch.contact(i, n_times).closed.mean(axis=0) for i in range(len(branch))])
    frequency = branch.frequency_hz
    for limit, label, dashes in ((area.min(axis=1), "least in the period", "--"), (area.max(axis=1), "most in the period", "-.")):
        ax.plot(frequency, limit, lw=0.8, color=FAINT, ls=dashes, label=label)
    ax.plot(frequency, mean, color=COLOURS[0], label="mean over the period")
    ax.set_ylim(-3, 103)
    legend_above(ax)
    return ax


@styled
def contact_over_cycle(branch, point, n_times=256, ax=None):
    """Which pairs are closed during the period at a point of the branch (-1: the last one): a row for each pair, dark where it
    is closed, and over them the share of all that is.

        plm.plot.contact_over_cycle(peak.branch, 0)
    """
    ax = axes(ax, "time / period", "pair")
    contact = branch.contact(point, n_times)
    n_pairs = len(contact.closed)
    ax.imshow(contact.closed, aspect="auto", interpolation="nearest", cmap="Greys", vmin=0, vmax=2.4, origin="lower",
              extent=(0, 1, -0.5, n_pairs - 0.5), rasterized=True)
    ax.grid(False)
    ax.set_yticks(numpy.unique(numpy.linspace(0, n_pairs - 1, min(n_pairs, 6)).round().astype(int)))
    share = ax.twinx()
    share.plot(numpy.append(contact.time, 1), 100 * numpy.append(contact.closed.mean(axis=0), contact.closed[:, 0].mean()),
               color=COLOURS[1], drawstyle="steps-post")
    share.set_ylim(-3, 103)
    share.set_ylabel("closed pairs (%)", color=COLOURS[1])
    ax.set_title(f"{branch.frequency_hz[point]:.5g} Hz; grey: closed")
    return ax


@styled
def contact_area_over_cycle(branch, point, n_times=256, area=None, units="m", ax=None):
    """Contact area during the period at a point of the branch; area: that of each pair, in the square of the model's unit of
    length (None: the pairs are counted).

        plm.plot.contact_area_over_cycle(peak.branch, 0, area=areas, units="mm")
    """
    contact = branch.contact(point, n_times)
    counted = area is None
    area = numpy.ones(len(contact.closed)) if counted else numpy.asarray(area, dtype=float)
    unit = length_unit("" if counted else units, numpy.sqrt(area))
    label = "pairs in contact" if counted else f"contact area ({unit.name}²)" if unit.name else "contact area"
    ax = axes(ax, "time / period", label)
    total = unit.factor**2 * numpy.append(area @ contact.closed, area @ contact.closed[:, 0])
    ax.plot(numpy.append(contact.time, 1), total, drawstyle="steps-post", label=f"{branch.frequency_hz[point]:.5g} Hz")
    limit = unit.factor**2 * area.sum()
    ax.set_ylim(-0.03 * limit, 1.03 * limit)
    legend_above(ax)
    return ax


@styled
def contact_map(branch, point, xyz, units="m", time_fraction=None, ax=None):
    """The surface of contact seen from its normal: a square at each pair, in the colour of the share of the period that it is
    closed, or, at an instant (time_fraction of the period), filled where it is closed. xyz: n_pairs x 3 (or x 2), where the
    pairs are; they are drawn in the plane that fits them best.

        plm.plot.contact_map(peak.branch, 0, xyz, units="mm")
    """
    xyz = numpy.asarray(xyz, dtype=float)
    if xyz.ndim != 2 or len(xyz) != branch.n_pairs or xyz.shape[1] not in (2, 3):
        raise ValueError(f"xyz has shape {xyz.shape}; needed is {branch.n_pairs} x 3, or x 2: a row for each pair")
    place, names = _in_plane(xyz)
    unit = length_unit(units, numpy.ptp(place, axis=0))
    place = unit.factor * place
    ax = axes(ax, unit.label(names[0]), unit.label(names[1]))
    ax.grid(False)
    look = {"marker": "s", "s": _square(ax, place), "edgecolors": FAINT, "linewidths": 0.4}
    if time_fraction is None:
        drawn = ax.scatter(*place.T, c=100 * branch.closed_share(point), cmap="cividis", vmin=0, vmax=100, **look)
        ax.figure.colorbar(drawn, ax=ax, label="closed (% of the period)")
    else:
        n_times = 720
        closed = branch.contact(point, n_times).closed[:, int(round(time_fraction * n_times)) % n_times] == 1
        for which, colour, label in ((closed, COLOURS[0], "closed"), (~closed, "white", "open")):
            if which.any():
                ax.scatter(*place[which].T, c=colour, label=label, **look)
        legend_above(ax)
    ax.margins(0.12)
    ax.set_aspect("equal", adjustable="datalim")
    return ax


def _in_plane(xyz):
    """n x 2 coordinates in the plane that fits the points best, and the names of its axes."""
    if xyz.shape[1] == 2:
        return xyz, ("x", "y")
    flat = numpy.flatnonzero(numpy.ptp(xyz, axis=0) <= 1e-6 * numpy.ptp(xyz))
    if flat.size:  # a coordinate plane keeps its names
        kept = [i for i in range(3) if i != flat[0]]
        return xyz[:, kept], tuple("xyz"[i] for i in kept)
    _, _, axes_of_plane = numpy.linalg.svd(xyz - xyz.mean(axis=0), full_matrices=False)
    return (xyz - xyz.mean(axis=0)) @ axes_of_plane[:2].T, ("along the surface", "across it")


def _square(ax, place):
    """Area of a marker, in points squared, so that neighbours do not overlap."""
    from scipy.spatial import cKDTree
    if len(place) < 2:
        return 40.0
    nearest = numpy.median(cKDTree(place).query(place, k=2)[0][:, 1])
    size = ax.figure.get_size_inches() * 72 * (0.6, 0.7)  # of the axes, about
    extent = numpy.ptp(place, axis=0)
    per_unit = min(size / numpy.where(extent > 0, 1.15 * extent, numpy.inf).clip(min=1e-300)) if extent.any() else 1.0
    return float(numpy.clip(0.9 * nearest * per_unit, 2, 14)**2)
