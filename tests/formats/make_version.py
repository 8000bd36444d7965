#!/usr/bin/env python3
"""make_version.py FOLDER: writes the files of the format as it is now: a basis, a curve, one that can go on, a table of the first.

What is in the folder of a version that was released stays for ever; a new version gets a folder of its own.
"""
import pathlib
import sys
import warnings

import plm

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import models  # noqa: E402

warnings.simplefilter("ignore")
folder = pathlib.Path(sys.argv[1])
folder.mkdir(exist_ok=True)
basis = models.between_stops()
curve = plm.Hbm(basis).sweep()
(folder / "basis.plm").write_bytes(basis.to_bytes())
(folder / "branch.plm").write_bytes(curve.to_bytes())
(folder / "unfinished.plm").write_bytes(plm.Hbm(basis, max_points=12).sweep().to_bytes())
curve.write_csv(folder / "curve.csv", 0)
