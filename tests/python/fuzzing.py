"""How long a fuzzer goes on and where its chance begins: as its arguments say; else for PLM_FUZZ_SECONDS of the environment
(tests/run.sh --all) from a number of its own, which is printed; else for a moment, the same in every run."""
import os
import sys
import time


def seconds_and_seed(seconds, seed):
    given = [float(x) for x in sys.argv[1:3] if x.replace(".", "", 1).isdigit()]
    if not given and "PLM_FUZZ_SECONDS" in os.environ:
        given = [float(os.environ["PLM_FUZZ_SECONDS"]), time.time_ns() % 10**6]
        print(f"{sys.argv[0]} {given[0]:g} {given[1]:.0f}", flush=True)
    seconds, seed = (given + [seconds, seed][len(given):])[:2]
    return seconds, int(seed)
