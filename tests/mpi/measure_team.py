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


lines = [measured(1, "serial"), *(measured(n) for n in ranks)]
base = lines[1] if len(lines) > 1 else lines[0]
print(f"{lines[0][2]} DOFs\n\n| | ranks | hand-over | build | 30 modes | count | samples, basis | all, slowest rank | faster than one rank | MiB, largest rank "
      "| of one rank's | MiB, all |\n|--|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|")
for who, n, _, *steps, most, mib, total in lines:
    print(f"| {who} | {n} | {' | '.join(steps)} | {most} | {float(base[-3]) / float(most):.2f} | {mib} | {float(mib) / float(base[-2]):.2f} | {total} |")
