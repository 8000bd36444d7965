"""The command line: what argparse makes of the table of settings."""
import argparse
import difflib
import pathlib

from .case_file import read_case
from .settings import SETTINGS, Wrong, settings_of, value_of

COMMANDS = {
    "response": ("the response curve around a resonance, its peak with an error, and the motion there",
                 "plm response blade.inp --force 1204 z 2.5 --damping-ratio 0.002 --out blade"),
    "resume": ("what plm response --save-every has left: goes on with the curve, with the arguments of the response",
               "plm resume blade.inp --force 1204 z 2.5 --damping-ratio 0.002 --out blade"),
    "modes": ("natural frequencies of a linear system, and its shapes", "plm modes blade.inp --count 6 --out shapes"),
    "audit": ("what is probably not meant so in a model", "plm audit K.mtx M.mtx --dofs dofs.txt --contact pairs.csv"),
    "rest": ("contact at rest under the pre-load", "plm rest joint.inp --out rest"),
    "study": ("error against run time of several ways to the response", "plm study blade.inp --force 1204 z 2.5 --out study"),
}
_STATUS = """exit status: 0 all is well; 1 done, but not to the accuracy asked for, or with a warning that matters; 2 wrong usage or a
wrong file; 3 failed; 130 stopped by Ctrl-C. Results go to the standard output, messages to the standard error."""


class _Parser(argparse.ArgumentParser):
    """Long options in full only, and the nearest one to a name that is none."""

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter, **options)

    def error(self, message):
        raise Wrong(f"{message}; {self.prog} --help tells more")

    def refuse_unknown(self, unknown):
        """What no option has taken."""
        name = unknown[0].split("=")[0]
        if not name.startswith("--"):
            raise Wrong(f"{name!r} is too much: files of the model stand before the options, and an option that takes several is written "
                        f"again for each; {self.prog} --help tells more")
        near = difflib.get_close_matches(name, self._option_string_actions, 1)
        raise Wrong(f"there is no option {name}" + (f"; did you mean {near[0]}?" if near else f"; {self.prog} --help lists them"))


class _Version(argparse.Action):
    def __call__(self, parser, namespace, values, option_string=None):
        from .._context import build_info
        print(f"plm, {build_info()}")
        parser.exit()


def make_parser():
    main = _Parser(prog="plm", description="Forced vibration of structures whose parts touch and separate, from the files of a "
                   "finite-element code to the curve.", epilog=f"example: {COMMANDS['response'][1]}\n\n{_STATUS}")
    main.add_argument("--version", action=_Version, nargs=0, help="the library, its parts and its licence")
    commands = main.add_subparsers(dest="command", metavar="COMMAND", parser_class=_Parser)
    parsers = {}
    for name, (text, example) in COMMANDS.items():
        parsers[name] = parser = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.",
                                                     epilog=f"example: {example}\n\n{_STATUS}")
        for setting in settings_of(name):
            _add(parser, setting)
        parser.add_argument("--quiet", action="store_true", help="no messages but failures and warnings")
    return main, parsers


def _add(parser, setting):
    if setting.kind == "flag":
        parser.add_argument("--" + setting.name, action="store_true", default=None, help=setting.text)
        return
    help_text = setting.text + (f" (default {_words(setting.default)})" if setting.default not in (None, []) else "")
    if setting.name == "model":
        parser.add_argument("model", nargs="+", metavar="FILE", help=setting.text + "; or a case file (.toml), which may have every "
                            "option below as a key, with _ in place of -")
        return
    kind = setting.kind.split()[0]
    several = {"action": "append"} if kind in ("dofs", "loads", "paths") else {}
    if several:
        help_text += "; again for each further one"
    words = {"nargs": len(setting.metavar)} if isinstance(setting.metavar, tuple) else {}
    if kind == "counts":
        help_text += ", separated by commas"
    parser.add_argument("--" + setting.name.replace("_", "-"), metavar=setting.metavar, help=help_text.replace("%", "%%"), **several,
                        **words)


def _words(default):
    return ",".join(map(str, default)) if isinstance(default, list) else f"{default:g}" if isinstance(default, float) else default


def read_arguments(arguments):
    """(command, settings, quiet): the defaults, then the case file, then the options."""
    main, parsers = make_parser()
    given, unknown = main.parse_known_args(arguments)
    if unknown:
        parsers.get(given.command, main).refuse_unknown(unknown)
    if given.command is None:
        raise Wrong(f"a command is needed: {', '.join(COMMANDS)}; plm --help tells more")
    settings = {setting.name: setting.default for setting in SETTINGS}
    files = given.model
    if pathlib.Path(files[0]).suffix.lower() == ".toml":
        settings.update(read_case(files[0]))
        files = files[1:]
    if files:
        settings["model"] = files
    if not settings["model"]:
        raise Wrong(f"{given.model[0]} names no model; it needs the key model, or its files behind it on the command line")
    for setting in settings_of(given.command):
        value = getattr(given, setting.name)
        if setting.name != "model" and value is not None:
            settings[setting.name] = value_of(setting, value)
    return given.command, settings, given.quiet
