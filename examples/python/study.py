"""study.py: error against run time of several ways to the response of the cracked cantilever of cracked_beam.py.

    PYTHONPATH=bindings/python PLM_LIBRARY=build/dev/src/libplm.so python3 examples/python/study.py [folder]

Every method is run and timed beside the unreduced structure and compared with it: piecewise-linear modes with more and more
harmonics, the same compressed, a basis for a tolerance, Craig-Bampton, bilinear modes, marching in time. Printed: the table.
Into the folder, if one is named: the report (report.md, table.csv, the curves) and its pictures. Harmonics are set, and
stability is off, because their price is what is compared: with one harmonic the peak is 0.4 % off, with nine 0.03 %, and the
curve takes several times as long. All of it takes about ten seconds on one core.
"""
import os
import sys

import plm
from cracked_beam import make_model

HARMONICS = [1, 3, 5, 7, 9]


def add_methods(study, model):
    sampler = plm.Sampler(model, system="open", mode=1)  # nothing need be run or built: only options are read

    def response(kind, n_harmonics):
        basis = plm.Basis(model, sampler, kind=kind, n_harmonics=n_harmonics)
        return plm.Hbm(basis, n_harmonics=n_harmonics, stability="off")

    for n_harmonics in HARMONICS:
        study.add_response(f"modes, H = {n_harmonics}", response("plm", n_harmonics))
    study.add_compressed("compressed", response("plm", 9), 4)
    study.add_refined("for 1e-3", response("plm", 9), 1e-3)
    study.add_response("Craig-Bampton", response("craig_bampton", 9))
    study.add_response("bilinear modes", response("bilinear", 9))
    basis = plm.Basis(model, sampler, n_harmonics=9)
    study.add_marching("marching", plm.Transient(basis, settled=1e-3, periods=1000), 4)
    study.set_reference(response("full", 15))


def show(study):
    print(f"{'method':18s} columns   set-up   curves   error of frequency      peak     curve")
    rows = zip(study.names, study.basis_size, study.setup_seconds, study.curve_seconds, study.frequency_error,
               study.amplitude_error, study.curve_error_l2, study.pareto)
    for name, size, setup, curves, frequency, peak, curve, is_best in rows:
        print(f"{name:18s} {size:7d} {setup:8.3f} {curves:8.3f} s {frequency:18.1e} {peak:9.1e} {curve:9.1e}"
              f"{'  Pareto' if is_best else ''}")
    print(f"{'reference':18s} {study.reference_size:7d} {study.reference_setup_seconds:8.3f} "
          f"{study.reference_curve_seconds:8.3f} s, with twice the harmonics {study.reference_harmonic_error:.1e} off")


def draw(study, folder):
    figure, ax = plm.plot.figure(1, 3, width=1.5 * plm.plot.PAGE)
    plm.plot.study_errors(study, ax=ax[0])
    plm.plot.study_curves(study, methods=["modes, H = 1", "modes, H = 9", "for 1e-3", "marching"], ax=ax[1])
    plm.plot.study_convergence(study, HARMONICS, methods=range(len(HARMONICS)), xlabel="harmonics", ax=ax[2])
    plm.plot.save(figure, os.path.join(folder, "study"))


def main():
    model, tip = make_model()
    study = plm.Study(model, repeats=1)
    study.set_output(tip)
    add_methods(study, model)
    study.run(progress=sys.stderr.isatty())
    show(study)
    if len(sys.argv) > 1:
        study.write(sys.argv[1])
        draw(study, sys.argv[1])
    errors = dict(zip(study.names, study.curve_error_l2))
    return 0 if study.status == plm.OK and errors["for 1e-3"] < errors["modes, H = 1"] else 1


if __name__ == "__main__":
    sys.exit(main())
