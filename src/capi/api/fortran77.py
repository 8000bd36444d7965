"""fortran/plm_f77_calls.f90 and plm_f77_keys.f90: the FORTRAN 77 subroutines that follow from the description. Those by hand
stand in plm_f77.f90."""
import re
from dataclasses import dataclass, field

from fortran_text import banner, wrapped

# What the layer says itself: the arrays are copied, and everything counts from 1.
SUPPLIED = {"api_version": "PLM_API_VERSION", "index_base": "int(1, c_int32_t)", "ownership": "PLM_COPY"}
KINDS = {"int32_t": "c_int32_t", "int64_t": "int64", "plm_status": "c_int32_t"}
HANDLE, INTEGER, REAL, TEXT, EXTERNAL = "INTEGER*8", "INTEGER", "DOUBLE PRECISION", "CHARACTER*(*)", "EXTERNAL"
DECLARED = {HANDLE: "integer(int64)", INTEGER: "integer", REAL: "real(real64)", TEXT: "character(len=*)"}
SUPPORT = ("as_pointer", "as_handle", "c_text", "narrow", "narrow_array", "to_blanks")


@dataclass
class Passed:
    """How one argument is handed to C: what stands in the call, what is done before it and after it went well."""
    actual: str
    before: list = field(default_factory=list)
    after: list = field(default_factory=list)
    local: list = field(default_factory=list)  # declarations


def visible(function):
    """The arguments of C that the subroutine has, too: a text has its own length."""
    has_text = any(argument.name == "buffer" for argument in function.arguments)
    return [argument for argument in function.arguments if argument.name not in SUPPLIED
            and not (has_text and argument.name in ("capacity", "needed"))]


def type_of(api, argument):
    """The type of the argument in FORTRAN 77."""
    if api.is_handle(argument):
        return HANDLE
    if api.is_callback(argument):
        return EXTERNAL
    return {"double": REAL, "char": TEXT, "void": TEXT}.get(argument.base, INTEGER)


def passed_handle(argument, name, dummies):
    local = f"c_{name}"
    if argument.size:
        n = dummies[argument.size]
        made = [f"allocate ({local}(max({n}, 0)))", f"{local}(:) = [(as_pointer({name}(i)), i = 1, {n})]"]
        return Passed(local, made, [], [f"type(c_ptr), allocatable :: {local}(:)", "integer :: i"])
    if argument.stars == 1:
        return Passed(f"as_pointer({name})")
    if argument.intent == "inout":
        return Passed(local, [f"{local} = as_pointer({name})"], [f"{name} = as_handle({local})"], [f"type(c_ptr) :: {local}"])
    # a call that ended early may have made nothing
    after = f"if (as_handle({local}) /= 0) {name} = as_handle({local})"
    return Passed(local, [f"{local} = c_null_ptr"], [after], [f"type(c_ptr) :: {local}"])


def passed_text(argument, name):
    if argument.intent == "in":
        return Passed(f"c_text({name})")
    return Passed("len(buffer, int64), buffer", [], [f"call to_blanks(buffer, {name})"],
                  [f"character(len=len({name}) + 1) :: buffer"])


def passed_integer(argument, name, dummies):
    kind, local = KINDS[argument.base], f"c_{name}"
    if argument.stars == 0:
        return Passed(f"int({name}{' - 1' if argument.is_position else ''}, {kind})")
    if argument.size:  # as many as there is room for, the number of all of them in COUNT
        n = dummies[argument.size]
        filled = f"{local}(1:min(c_{dummies['count']}, int({n}, int64)))"
        return Passed(local, [f"allocate ({local}(max({n}, 1)))"], [f"call narrow_array({filled}, {name}, ierr)"],
                      [f"integer({kind}), allocatable :: {local}(:)"])
    found = f"{local} + 1" if argument.is_position else local
    after = f"call narrow({found}, {name}, ierr)" if kind == "int64" else f"{name} = int({found})"
    return Passed(local, [f"{local} = 0"], [after], [f"integer({kind}) :: {local}"])


def passed(api, function, argument, dummies):
    if argument.name in SUPPLIED:
        return Passed(SUPPLIED[argument.name])
    name = dummies[argument.name]
    has_widths = function.name.endswith("_i32")  # a generic name takes the host's integers as they are
    if api.is_handle(argument):
        return passed_handle(argument, name, dummies)
    if argument.base == "char":
        return passed_text(argument, name)
    if argument.base == "double" or argument.size and argument.is_const and has_widths:
        return Passed(name)
    is_array_of_count = argument.size == "capacity" and argument.base == "int64_t"
    if argument.base in KINDS and (not argument.size or is_array_of_count):
        return passed_integer(argument, name, dummies)
    raise SystemExit(f"{function.name}: no rule passes {argument.type} {argument.name} from FORTRAN 77: write the subroutine by "
                     "hand in fortran/plm_f77.f90, and say so in api.txt")


def declaration(api, argument, name):
    intent = "in" if argument.intent == "in" else "inout"
    return f"{DECLARED[type_of(api, argument)]}, intent({intent}) :: {name}{'(*)' if argument.size and argument.base != 'char' else ''}"


def called_name(function):
    """plm_c has one generic name for both widths."""
    return re.sub(r"_i32$", "", function.name)


def uses(function, text):
    """The use statements for what the declarations and statements name."""
    def named(words):
        return [word for word in words if re.search(rf"\b{word}\b", text)]
    of_c = named(["c_int32_t", "c_null_ptr", "c_ptr"])
    lines = [f"    use, intrinsic :: iso_c_binding, only: {', '.join(of_c)}"] if of_c else []
    kinds = named(["int64", "real64"])
    if kinds:
        lines.append(f"    use, intrinsic :: iso_fortran_env, only: {', '.join(kinds)}")
    lines.append(f"    use plm_c, only: {', '.join([called_name(function)] + named(['PLM_API_VERSION', 'PLM_COPY']))}")
    support = named(SUPPORT)
    return lines + ([f"    use plm_f77_support, only: {', '.join(support)}"] if support else [])


def subroutine_lines(api, function, name, arguments):
    """arguments: their names in FORTRAN 77."""
    shown = visible(function)
    if len(shown) != len(arguments):
        raise SystemExit(f"api.txt: {name} has {len(arguments)} arguments, {function.name} needs {len(shown)}: "
                         f"{', '.join(argument.name for argument in shown)}")
    dummies = {argument.name: dummy.lower() for argument, dummy in zip(shown, arguments)}
    skipped = {argument.name for argument in function.arguments} - dummies.keys() - SUPPLIED.keys()
    parts = [passed(api, function, argument, dummies) for argument in function.arguments if argument.name not in skipped]
    call = ", ".join(part.actual for part in parts)
    body = [f"    {declaration(api, argument, dummies[argument.name])}" for argument in shown]
    body.append("    integer, intent(out) :: ierr")
    body += [f"    {line}" for part in parts for line in part.local]
    body += [f"    {line}" for part in parts for line in part.before]
    body += wrapped(f"    ierr = int({called_name(function)}({call}))", 4)
    after = [f"    {line}" for part in parts for line in part.after]
    body += (["    if (ierr < 0) return"] if after else []) + after
    head = wrapped(f"subroutine {name.lower()}({', '.join([*dummies.values(), 'ierr'])})", 0)
    return [*head, *uses(function, "\n".join(body)), "    implicit none", *body, f"end subroutine {name.lower()}", ""]


def generated(api, by_key):
    """(function, six letters, arguments) of the subroutines not by hand; by_key: those of options and results."""
    functions = {called_name(function): function for function in api.functions if not function.name.endswith("_i64")}
    for name, entry in api.description.functions.items():
        for subroutine in entry.subroutines:
            if subroutine.is_by_hand or by_key != name.startswith("plm_X_"):
                continue
            if not by_key:
                yield functions[name], subroutine.name, subroutine.arguments
                continue
            for noun, letter in api.description.letters.items():
                function = functions.get(name.replace("_X_", f"_{noun}_"))
                if function:
                    yield function, subroutine.name.replace("X", letter, 1), subroutine.arguments


def file_text(api, file, what, by_key):
    lines = [line for one in generated(api, by_key) for line in subroutine_lines(api, *one)]
    return banner(file, what) + "\n" + "\n".join(lines).rstrip() + "\n"


def written_calls(api):
    return file_text(api, "plm_f77_calls.f90", "the FORTRAN 77 subroutines but for the few in plm_f77.f90; see plmf.inc.", False)


def written_keys(api):
    return file_text(api, "plm_f77_keys.f90", "options and results by key for FORTRAN 77; see plmf.inc.", True)
