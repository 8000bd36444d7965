"""The table of C functions in the package is that of plm.h, and the package's tests call every one of them.

    test_every_function.py include/plm/plm.h
"""
import sys
import unittest

import header
from plm import _c

# Left out on purpose, with the reason.
EXCEPTIONS = {"plm_context_create_with_allocator": "Python's memory is not for hosts to hand out"}


def compare(declared, table, what):
    wrong = 0
    for name in sorted(set(declared) | set(table)):
        if declared.get(name) != table.get(name):
            wrong += 1
            print(f"{what} {name}: plm.h has {declared.get(name)}, the package {table.get(name)}")
    return wrong


def record():
    """Replaces every C function by one that notes its call."""
    called = set()

    def recorder(name, function):
        def call(*arguments):
            called.add(name)
            return function(*arguments)
        return call
    for name in [n for n in vars(_c.lib) if n.startswith("plm_")]:
        setattr(_c.lib, name, recorder(name, getattr(_c.lib, name)))
    return called


def main():
    declared = header.functions(sys.argv[1])
    wrong = compare(declared, dict(line.split() for line in _c.FUNCTIONS.split("\n") if line.strip()), "function")
    names = header.constants(sys.argv[1])
    wrong += compare(names, {n: getattr(_c, n, None) for n in names}, "constant")
    called = record()
    suite = unittest.defaultTestLoader.loadTestsFromNames(
        ["test_run", "test_refusals", "test_callbacks", "test_search", "test_transient", "test_study"])
    passed = unittest.TextTestRunner(verbosity=0).run(suite).wasSuccessful()
    missing = sorted(set(declared) - called - set(EXCEPTIONS))
    for name in missing:
        print(f"never called: {name}")
    print(f"{len(declared)} functions, {len(called)} called, {len(EXCEPTIONS)} left out on purpose")
    return 0 if declared and passed and not missing and not wrong else 1


if __name__ == "__main__":
    sys.exit(main())
