"""One motion of a branch: its field at an instant, its harmonics, its phase portrait."""
import numpy

from .style import COLOURS, FAINT, MARKERS, axes, figure, legend_above, length_unit, styled

_N_TIMES = 1024


@styled
def harmonics(branch, point, dofs, labels=None, most=20, units="m", ax=None):
    """Magnitude of the harmonics of some DOFs at a point of the branch, 0 (the mean) to `most`.

        plm.plot.harmonics(peak.branch, 0, [12, 15], labels=["tip", "root"])
    """
    dofs = numpy.atleast_1d(dofs)
    magnitudes = [numpy.abs(branch.harmonics(point, int(dof)))[:most + 1] for dof in dofs]
    unit = length_unit(units, numpy.concatenate(magnitudes))
    ax = axes(ax, "harmonic", unit.label("magnitude"))
    width = 0.8 / len(dofs)
    for i, (dof, magnitude) in enumerate(zip(dofs, magnitudes)):
        ax.bar(numpy.arange(len(magnitude)) + (i - (len(dofs) - 1) / 2) * width, unit.factor * magnitude, width,
               color=COLOURS[i % len(COLOURS)], edgecolor="k", linewidth=0.3, hatch=("", "///", "...", "xxx")[i % 4],
               label=labels[i] if labels else f"DOF {dof}")
    ax.set_yscale("log")
    legend_above(ax)
    return ax


@styled
def phase_portrait(branch, points, dof, units="m", labels=None, name=None, ax=None):
    """Velocity over displacement of a DOF during the period, at a point of the branch or several: a closed line each, an ellipse
    where the motion is harmonic. The marker is the beginning of the period.

        plm.plot.phase_portrait(peak.branch, 0, dof=12)
    """
    points = [int(point) for point in numpy.atleast_1d(points)]
    motions = [branch.history(point, dof, _N_TIMES) for point in points]
    unit = length_unit(units, numpy.concatenate(motions))
    name = f"DOF {dof}" if name is None else name
    velocities = [_derivative(q, branch.frequency_hz[point] / branch.period_multiple) for point, q in zip(points, motions)]
    of_time = length_unit(units, numpy.concatenate(velocities))
    ax = axes(ax, unit.label(f"displacement of {name}"), f"velocity ({of_time.name}/s)" if of_time.name else "velocity")
    for i, (point, q, v) in enumerate(zip(points, motions, velocities)):
        colour = COLOURS[i % len(COLOURS)]
        label = labels[i] if labels else f"{branch.frequency_hz[point]:.5g} Hz"
        ax.plot(unit.factor * numpy.append(q, q[0]), of_time.factor * numpy.append(v, v[0]), color=colour,
                ls=("-", (0, (6, 1.5)), (0, (3, 1, 1, 1)), ":")[i % 4], marker=MARKERS[i % len(MARKERS)], mfc="white",
                markevery=[0], label=label)
    legend_above(ax)
    return ax


def _derivative(q, hz):
    """Of a periodic motion at equidistant times."""
    return numpy.fft.irfft(2j * numpy.pi * hz * numpy.arange(len(q) // 2 + 1) * numpy.fft.rfft(q), len(q))


@styled
def field(branch, point, xyz, dofs, time_fraction=0.0, scale=None, faces=None, view=(25, -60), units="m", ax=None):
    """The structure at an instant of the period (a fraction of it) at a point of the branch: where its nodes are, moved by their
    displacement times `scale` (None: the largest is a tenth of the structure), over where they were, in grey.

    xyz: n x 3 (or x 2, or n along a line). dofs: n x as many as a node has displacements, base 0, -1 where there is none; of
    nodes along a line n, the deflection. faces: rows of places of the corners in xyz, from 3 on, drawn as surfaces; without
    them nodes along a line are joined, others are dots. view: elevation and azimuth of a solid, degrees.

        plm.plot.field(peak.branch, 0, x, dofs=range(0, n_dof - 1, 2), units="m")
    """
    at = numpy.asarray(xyz, dtype=float)
    at = at.reshape(len(at), -1)
    dofs = numpy.asarray(dofs).reshape(len(at), -1)
    q = branch.field(point, time_fraction)
    if dofs.max() >= len(q) or dofs.min() < -1:
        raise ValueError(f"dofs has numbers from {dofs.min()} to {dofs.max()}; the model has DOFs from 0 to {len(q) - 1}, "
                         "-1 stands for none")
    moved = numpy.where(dofs >= 0, q[dofs], 0.0)
    far = numpy.linalg.norm(moved, axis=1)
    size, largest = numpy.ptp(at, axis=0).max(), far.max()
    scale = (0.1 * size / largest if largest else 1.0) if scale is None else scale
    unit, small = length_unit(units, numpy.ptp(at, axis=0)), length_unit(units, far)
    words = small.label(f"displacement, drawn {scale:.3g} times")
    if at.shape[1] == 1:
        return _draw_line(ax, at[:, 0], moved[:, -1], unit, small)
    if moved.shape[1] != at.shape[1]:
        raise ValueError(f"dofs has {moved.shape[1]} for each node, xyz {at.shape[1]}")
    draw = _draw_solid if at.shape[1] == 3 else _draw_plane
    return draw(ax, unit.factor * at, unit.factor * (at + scale * moved), small.factor * far, faces, unit, words, view)


def _draw_line(ax, x, w, unit, small):
    """The deflection over the place, which needs no scale."""
    order = numpy.argsort(x)
    ax = axes(ax, unit.label("place"), small.label("deflection"))
    ax.axhline(0, color=FAINT, lw=0.7)
    ax.plot(unit.factor * x[order], small.factor * w[order], color=COLOURS[0], marker="o", markersize=2.5, mfc="white")
    return ax


def _draw_plane(ax, before, after, far, faces, unit, words, _):
    from matplotlib.collections import PolyCollection
    ax = axes(ax, unit.label("x"), unit.label("y"))
    if faces is None:
        ax.plot(*before.T, ls="", marker=".", color="0.7", markersize=3)
        drawn = ax.scatter(*after.T, c=far, cmap="cividis", s=8)
    else:
        faces = [list(face) for face in faces]
        ax.add_collection(PolyCollection([before[face] for face in faces], facecolors="none", edgecolors="0.7", linewidths=0.4))
        drawn = ax.add_collection(PolyCollection([after[face] for face in faces], cmap="cividis", edgecolors="k", linewidths=0.3))
        drawn.set_array(numpy.array([far[face].mean() for face in faces]))
        ax.autoscale_view()
    ax.set_aspect("equal", adjustable="datalim")
    ax.figure.colorbar(drawn, ax=ax, label=words)
    return ax


def _draw_solid(ax, before, after, far, faces, unit, words, view):
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    if ax is None:
        _, ax = figure(subplot_kw={"projection": "3d", "proj_type": "ortho"})
    if faces is None:
        ax.scatter(*before.T, c="0.75", s=2, depthshade=False)
        drawn = ax.scatter(*after.T, c=far, cmap="cividis", s=6, depthshade=False)
    else:
        faces = [list(face) for face in faces]
        drawn = Poly3DCollection([after[face] for face in faces], cmap="cividis", edgecolors="k", linewidths=0.2)
        drawn.set_array(numpy.array([far[face].mean() for face in faces]))
        ax.add_collection3d(drawn)
    every = numpy.concatenate([before, after])
    low, high = every.min(axis=0), every.max(axis=0)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    ax.set_box_aspect(numpy.maximum(high - low, 0.05 * (high - low).max()))
    ax.view_init(*view)
    ax.set_axis_off()
    length = (high - low).max()
    ax.set_title(f"longest side: {length:.3g} {unit.name}".rstrip())
    ax.figure.colorbar(drawn, ax=ax, label=words, shrink=0.6, pad=0.02)
    return ax
