"""isolated_branch.py: the response that a sweep does not meet.

    PYTHONPATH=bindings/python PLM_LIBRARY=build/dev/src/libplm.so python3 examples/python/isolated_branch.py [figure.png]

A mass of 1 kg is pressed against a stop by 50 N and carries a second mass of 0.2 kg; 0.6 N drive it. As long as the
contact stays closed the structure is linear. Hit hard enough, it opens during the cycle and goes on at a much larger
amplitude, on a closed curve of its own that touches the main one nowhere. Printed: both curves, the forces between which
the isolated one exists, and whether a motion started on it stays there when it is marched in time.
"""
import sys

import numpy
import plm
import scipy.sparse

FORCE = 0.6          # N
PRELOAD = 50.0       # N, on the stop
DAMPING = 4e-3       # C = DAMPING / OMEGA K
OMEGA = 100.0        # rad/s, sets the stiffnesses
WINDOW = (14.0, 26.0)  # Hz


def make_model():
    k = OMEGA**2
    stiffness = k * numpy.array([[3.048, -2.048], [-2.048, 2.048]])
    model = plm.Model(scipy.sparse.diags([1.0, 0.2]).tocsc(), scipy.sparse.csc_matrix(stiffness))
    model.set_rayleigh_damping(0, DAMPING / OMEGA)
    model.add_gap_rows(scipy.sparse.csr_matrix([[1.0, 0.0]]), stiffness=[k])  # u = q_0, closed where u > 0
    model.set_preload([PRELOAD, 0])
    model.set_excitation([1.0, 0])
    return model.build()


def stays(basis, branch):
    """Largest departure in amplitude of the stable points after 200 periods of marching."""
    transient = plm.Transient(basis, periods=200)
    transient.observe([0])
    worst = 0.0
    for point in numpy.flatnonzero(branch.stable == 1)[::10]:
        transient.start_at(branch, int(point))
        transient.run()
        last = transient.history(0)[-200:]
        amplitude = (last.max() - last.min()) / 2
        worst = max(worst, abs(amplitude / branch.amplitude(0)[point] - 1))
    return worst


def draw(curves, labels, backbone, mode, path):
    figure, (response, over_force) = plm.plot.figure(1, 2, width=plm.plot.PAGE)
    plm.plot.response(curves, 0, labels=labels, name="mass 1", ax=response)
    response.plot(mode.frequency_hz, 1e3 * mode.amplitude(0), "k:", lw=1, label="nonlinear mode")
    response.set_xlim(17, 22)
    response.set_ylim(0, 1.2e3 * max(curve.amplitude(0).max() for curve in curves))
    plm.plot.legend_above(response)
    plm.plot.backbone(backbone, 0, force=1.0, name="mass 1", ax=over_force)
    over_force.axvline(FORCE, color="0.35", lw=1, ls="--", label=f"{FORCE:g} N, the force on the left")
    plm.plot.legend_above(over_force)
    print("pictures:", *plm.plot.save(figure, path))


def main():
    model = make_model()
    # two masses need no reduction, and a basis without a sampler needs a window
    basis = plm.Basis(model, kind="full", frequency_min_hz=WINDOW[0], frequency_max_hz=WINDOW[1]).build()
    hbm = plm.Hbm(basis, force_scale=FORCE)  # the excitation is 1 N: so that the backbone's force is in N
    main_curve = hbm.sweep()
    print(f"main curve:      {len(main_curve):3d} points, amplitude up to {1e3 * main_curve.amplitude(0).max():.3f} mm")
    isolated = hbm.find_isolated(main_curve)
    for found in isolated:
        low, high = found.force_range
        print(f"isolated branch: {len(found.branch):3d} points, amplitude up to {1e3 * found.branch.amplitude(0).max():.3f} mm, "
              f"exists from {low:.4f} to {high:.4f} N")
        folds = [b for b in found.branch.bifurcations if b.kind == "fold"]
        print("  folds at " + " and ".join(f"{found.branch.frequency_hz[b.point]:.4f}" for b in folds) + " Hz")
    if len(isolated) != 1:
        return 1
    loop = isolated[0].branch
    departure = stays(basis, loop)
    print(f"  after 200 periods of marching from its stable points the amplitude differs by {100 * departure:.3f} % at most")
    if len(sys.argv) > 1:
        backbone = hbm.find_backbones(force_max=2 * FORCE)[0]
        mode = hbm.nonlinear_mode(1, 0, 1.2 * loop.amplitude(0).max())
        draw([main_curve, loop], ["main curve", "isolated branch"], backbone, mode, sys.argv[1])
    return 0 if departure < 0.01 else 1


if __name__ == "__main__":
    sys.exit(main())
