"""The whole API as data: what plm.h declares, with what src/capi/api.txt adds. Whoever generates or checks reads it here.

    api = plm_api.read()        functions, callbacks, handles, constants; every pointer with its intent and its size

Stops with a sentence where something is not described, and where the description names what does not exist."""
import re
from dataclasses import dataclass

import plm_header
from description import Description
from plm_header import PATH as HEADER
from plm_header import ROOT

DESCRIPTION = ROOT / "src/capi/api.txt"
NUMBERS = ("int32_t", "int64_t", "double", "plm_status")


@dataclass
class Api:
    functions: list
    callbacks: list
    handles: list
    constants: dict
    description: Description

    def is_handle(self, argument):
        return argument.base in self.handles

    def is_callback(self, argument):
        return argument.base in {callback.name for callback in self.callbacks}

    def entry(self, function):
        """What the description says of a function."""
        return self.description.functions[described_as(function.name, self.description)]

    def left_out_of(self, layer):
        """{function: reason}"""
        return {function.name: self.entry(function).left_out[layer] for function in self.functions
                if layer in self.entry(function).left_out}

    def by_rule_in(self, layer):
        """The functions whose method is generated."""
        return [function for function in self.functions if layer in self.entry(function).by_rule]


def described_as(name, description):
    """plm_x of plm_x_i32 and plm_x_i64; plm_X_set_int of plm_model_set_int where that has no description of its own."""
    name = re.sub(r"_i(32|64)$", "", name)
    shared = re.sub(r"^plm_[a-z]+_", "plm_X_", name)
    return shared if name not in description.functions and shared in description.functions else name


def needs_description(argument):
    """C does not tell one number from many, nor whether there may be none. A text with a length is as numbers are."""
    if argument.base in NUMBERS:
        return argument.stars > 0
    return argument.base == "char" and not argument.is_const or argument.stars == 2 and argument.is_const


def apply(function, description):
    """Completes the arguments of a function by what its own line and the names used everywhere say."""
    entry = description.functions.get(described_as(function.name, description))
    own = entry.arguments if entry else {}
    for name in own.keys() - {argument.name for argument in function.arguments}:
        raise SystemExit(f"{entry.where}: {function.name} has no argument '{name}'")
    for argument in function.arguments:
        said = own.get(argument.name)
        if not said and needs_description(argument):
            said = description.everywhere.get(argument.name)
            if not said:
                raise SystemExit(f"{function.name}: {argument.type} {argument.name} is not described: one value, or an array "
                                 f"of which size? Say it in {description.file}")
        if argument.stars and not argument.is_const and (argument.stars == 2 or needs_description(argument)):
            argument.intent = "inout" if function.name.endswith("_destroy") or said and said.is_inout else "out"
        argument.is_position = argument.stars == 0 and argument.name in description.positions
        if said:
            argument.size, argument.optional, argument.is_position = said.size, said.optional, said.is_position
            check_size(function, argument, description)


def check_size(function, argument, description):
    known = {other.name for other in function.arguments} | set(description.dimensions) | {"or"}
    for word in re.findall(r"[A-Za-z_]\w*", argument.size):
        if word not in known:
            raise SystemExit(f"{description.file}: {function.name}: {argument.name}[{argument.size}]: '{word}' is neither an "
                             "argument nor one of the dimensions")
    if argument.size and not argument.stars:
        raise SystemExit(f"{description.file}: {function.name}: {argument.name} is no pointer, so it is no array")


def check_names(declared, said):
    """The description speaks of what there is, and of all there is."""
    functions = declared.functions + declared.callbacks
    needed = {described_as(function.name, said) for function in declared.functions}
    known = needed | {callback.name for callback in declared.callbacks}
    for name in said.functions:
        if name not in known:
            raise SystemExit(f"{said.functions[name].where}: plm.h has no function {name}")
    for name in sorted(needed - said.functions.keys()):
        raise SystemExit(f"{name} is not described: write its line in {said.file}, with a FORTRAN 77 subroutine")
    arguments = {argument.name for function in functions for argument in function.arguments}
    for name in [*said.everywhere, *said.positions]:
        if name not in arguments:
            raise SystemExit(f"{said.file}: no function has an argument '{name}'")
    named = {name: entry for section in said.sections for name, _, entry in section.constants}
    for name in sorted(named.keys() - declared.constants.keys()):
        raise SystemExit(f"{named[name].where}: plm.h has no constant {name}")
    for name in sorted(declared.constants.keys() - named.keys()):
        raise SystemExit(f"{name} is not described: give it six letters in {said.file}")


def six_letters(said):
    """(name, its six letters or "", entry) of every function and every constant."""
    for name, entry in said.functions.items():
        if not name.endswith("_fn"):
            for six in [subroutine.name for subroutine in entry.subroutines] or [""]:
                yield name, six, entry
    for section in said.sections:
        yield from section.constants


def check_layers(said, declared):
    """What has no six letters of its own has a reason to have none; only handles have methods."""
    for name, entry in said.functions.items():
        if entry.by_rule and name.split("_")[1] not in said.letters:
            raise SystemExit(f"{entry.where}: {name} is no function of a handle with letters, so it is no method by rule")
    used = {}
    for name, six, entry in six_letters(said):
        if bool(six) == ("FORTRAN 77" in entry.left_out):
            raise SystemExit(f"{entry.where}: {name} needs six letters, or a reason: not in FORTRAN 77: ...")
        # an option by key has one subroutine for each kind of handle that has it: X stands for its letter
        with_letters = {six.replace("X", letter, 1) for noun, letter in said.letters.items()
                        if name.replace("_X_", f"_{noun}_") in declared}
        for one in with_letters if "_X_" in name else {six}:
            if one and used.setdefault(one, name) != name:
                raise SystemExit(f"{entry.where}: {one} is {used[one]} already")


def read(header=HEADER, description=DESCRIPTION):
    declared, said = plm_header.read(header), Description(description)
    for function in declared.functions + declared.callbacks:
        apply(function, said)
    check_names(declared, said)
    check_layers(said, {function.name for function in declared.functions})
    return Api(declared.functions, declared.callbacks, declared.handles, declared.constants, said)
