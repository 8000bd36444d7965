#!/usr/bin/env python3
"""measure_team.py PROGRAM [NX NY NZ [RANKS...]]: the set-up of a cracked block of bricks by the serial library and by teams, as a table in
Markdown. 70k DOFs (60 19 18; 1, 2 and 4 ranks) where nothing is given. Seconds are those of the processor, without those of ranks that wait.
Nothing else should run meanwhile: who shares memory with others has to wait for it."""
import os
import subprocess
import sys

program, words = sys.argv[1], sys.argv[2:]
block, ranks = words[:3] or ["60", "19", "18"], [int(r) for r in words[3:]] or [1, 2, 4]
environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
mpirun = ["mpirun", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"]


def measured(n, *more):
    line = subprocess.run([*mpirun, "-n", str(n), program, *block, *more], check=True, text=True, capture_output=True, env=environment, timeout=550).stdout
    return line.strip().splitlines()[-1].split(", ")


runs = [(1, "serial"), *((n,) for n in ranks)]
base = None
for run in runs:
    who, n, dofs, *steps, most, mib, total = measured(*run)
    if run == runs[0]:
        print(f"{dofs} DOFs\n\n| | ranks | hand-over | build | 30 modes | count | samples, basis | all, slowest rank | faster than one rank "
              "| MiB, largest rank | of one rank's | MiB, all |\n|--|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|")
    elif base is None:
        base = float(most), float(mib)
    compared = f"{base[0] / float(most):.2f} | {mib} | {float(mib) / base[1]:.2f}" if base else f" | {mib} | "
    print(f"| {who} | {n} | {' | '.join(steps)} | {most} | {compared} | {total} |", flush=True)
