"""The package's tests call every C function. (abi.generated: the package's table of them is that of plm.h.)"""
import pathlib
import sys
import unittest

from plm import _c

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "src/capi/api"))
import plm_api  # noqa: E402


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
    called = record()
    api = plm_api.read()
    left_out = api.left_out_of("Python")  # on purpose, api.txt tells why
    suite = unittest.defaultTestLoader.loadTestsFromNames(
        ["test_run", "test_constraints", "test_couplings", "test_geometry", "test_surfaces", "test_moving_walls",
         "test_base_motion", "test_outputs", "test_changed_loads", "test_bytes", "test_resume", "test_refusals", "test_callbacks",
         "test_search", "test_transient", "test_study"])
    passed = unittest.TextTestRunner(verbosity=0).run(suite).wasSuccessful()
    by_rule = {function.name for function in api.by_rule_in("Python")}  # the rule is tested where it is called
    missing = sorted(set(_c.FUNCTIONS) - called - left_out.keys() - by_rule)
    for name in missing:
        print(f"never called: {name}")
    print(f"{len(_c.FUNCTIONS)} functions, {len(called)} called, {len(left_out)} left out on purpose")
    return 0 if passed and not missing else 1


if __name__ == "__main__":
    sys.exit(main())
