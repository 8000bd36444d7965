"""help() of every function: each argument with its meaning, shape and unit, and an example that calls the function; all of them run."""
import contextlib
import inspect
import io
import re
import tempfile
import unittest
import warnings

import plm
from plm import _examples, _help

CLASSES = (plm.Context, plm.Model, plm.Sampler, plm.Basis, plm.Hbm, plm.Branch, plm.Transient, plm.Study)
OF_THE_PACKAGE = {"call", "run", "finish", "destroy", "is_busy"}  # of Context: for the other classes
READ_ONLY = {"set", "set_options", "options"}  # a branch has no options


def public():
    """(name in an example, what is called there, function)."""
    for one in CLASSES:
        if one is not plm.Branch:
            yield one.__name__, f"plm.{one.__name__}(", one
        for name, member in inspect.getmembers(one, lambda m: inspect.isfunction(m) or inspect.ismethod(m)):
            if name.startswith("_") or one is plm.Context and name in OF_THE_PACKAGE or one is plm.Branch and name in READ_ONLY:
                continue
            yield f"{one.__name__}.{name}", f".{name}(", member
    for name in plm.__all__:
        if inspect.isfunction(getattr(plm, name)):
            yield name, f"plm.{name}(", getattr(plm, name)


class Help(unittest.TestCase):
    def test_every_function_has_an_example(self):
        shown = _help.examples()
        known = set()
        for name, call, function in public():
            found = shown.get(name) or shown.get(f"Handle.{name.rpartition('.')[2]}", "")
            self.assertIn(call, found, f"{name}: no example in plm/_examples.py between two lines '# [{name}]'")
            self.assertIn(found.splitlines()[0], function.__doc__, f"help({name}) does not show it")
            known |= {name, f"Handle.{name.rpartition('.')[2]}"}
        self.assertEqual(set(shown) - known, set(), "examples of no function")

    def test_every_argument_is_explained(self):
        count, used = 0, set()
        for name, _, function in public():
            owner, _, method = name.rpartition(".")
            code = function.__init__ if inspect.isclass(function) else function
            for argument in inspect.signature(code).parameters:
                if argument in ("self", "cls"):
                    continue
                said = _help.meaning(owner if not inspect.isclass(function) else name, "__init__" if inspect.isclass(function) else method, argument)
                self.assertTrue(said, f"{name}: {argument} is not explained in plm/_help.py")
                used.add(argument)
                count += 1
                if argument != "options":
                    self.assertRegex(function.__doc__, rf"(?m)^    {argument}: ", f"help({name})")
        self.assertGreater(count, 200)
        self.assertEqual(set(_help.ARGUMENTS) - used, set(), "of no function")

    def test_units(self):
        """What has a unit says which."""
        for name in ("frequency_hz", "gap", "force", "xyz", "stiffness", "mass", "alpha", "beta", "v", "q", "area", "search"):
            self.assertRegex(_help.ARGUMENTS[name], r"\((Hz|length|force|mass|1/time|time|[\w/^]+)\)", name)

    def test_the_examples_run(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as printed, warnings.catch_warnings():
            warnings.simplefilter("ignore", plm.PlmWarning)
            for example in _examples.ALL:
                with self.subTest(example.__name__):
                    example(folder)
        defined = re.findall(r"^def (\w+)\(folder\)", _help.EXAMPLES.read_text(encoding="utf-8"), re.M)
        self.assertEqual(defined, [example.__name__ for example in _examples.ALL])
        self.assertGreater(len(printed.getvalue().splitlines()), 20)


if __name__ == "__main__":
    unittest.main()
