"""How long a fuzzer goes on and where its chance begins: as its arguments say; else for PLM_FUZZ_SECONDS of the environment
(tests/run.sh --all), or a moment, and the same in every run: a gate is not to fail by chance. By hand from another number."""
import os
import sys


def seconds_and_seed(seconds, seed):
    given = [float(x) for x in sys.argv[1:3] if x.replace(".", "", 1).isdigit()]
    if not given and "PLM_FUZZ_SECONDS" in os.environ:
        given = [float(os.environ["PLM_FUZZ_SECONDS"])]
    seconds, seed = (given + [seconds, seed][len(given):])[:2]
    return seconds, int(seed)
