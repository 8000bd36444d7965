"""fortran/plm_methods.f90: the types that the handles of the module plm extend, with the procedures that the description has
"by rule". A position counts from 1, an array brings its own size, and stat and errmsg come last, as everywhere in the module."""
import textwrap

from fortran_text import banner, wrapped

KINDS = {"int32_t": "c_int32_t", "int64_t": "int64"}
PARENTS = {"branch": "plm_readable"}  # a branch has no options
NEEDS = """\
    use, intrinsic :: iso_c_binding, only: c_int32_t, c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_constants, only: plm_status
    use plm_c
    use plm_errors, only: finish
    use plm_keyed_handles, only: plm_readable, plm_settable
    implicit none
    private
"""


def method_name(function):
    """full_residual of plm_branch_get_full_residual."""
    return function.name.split("_", 2)[2].removeprefix("get_")


def check_rule(api, function):
    told = function.told_sizes
    for argument in function.arguments[1:]:
        is_number = argument.base in ("int32_t", "int64_t", "double") and not argument.size and not argument.optional
        is_array = argument.base == "double" and told.get(argument.size) == argument.name
        is_handle = api.is_handle(argument) and argument.stars == 1
        if not (is_number or is_array or is_handle):
            raise SystemExit(f"{function.name}: no rule for {argument.type} {argument.name} in the module plm: write the "
                             "procedure by hand, and take the module out of 'by rule' in api.txt")


def declaration(api, argument):
    intent = "in" if argument.intent == "in" else "inout"
    if api.is_handle(argument):
        return f"class({argument.base}_methods), intent(in){', optional' if argument.optional else ''} :: {argument.name}"
    kind = "real(real64)" if argument.base == "double" else "integer"
    shape = ", contiguous" if argument.size else ""
    return f"{kind}, intent({intent}){shape} :: {argument.name}{'(:)' if argument.size else ''}"


def actual(api, function, argument, told):
    """What stands in the call of C."""
    if argument is function.arguments[0]:
        return "self%handle"
    if api.is_handle(argument):
        return f"c_{argument.name}" if argument.optional else f"{argument.name}%handle"
    if argument.name in told:
        return f"size({told[argument.name]}, kind={KINDS[argument.base]})"
    if argument.base == "double":
        return argument.name
    if argument.stars:
        return f"c_{argument.name}"
    return f"int({argument.name}, {KINDS[argument.base]})" + (" - 1" if argument.is_position else "")


def procedure_lines(api, function):
    check_rule(api, function)
    told, name = function.told_sizes, f"{function.noun}_{method_name(function)}"
    shown = [argument for argument in function.arguments[1:] if argument.name not in told]
    found = [argument for argument in shown if argument.stars and argument.base in KINDS]
    absent = [argument.name for argument in shown if api.is_handle(argument) and argument.optional]
    call = f"{function.name}({', '.join(actual(api, function, argument, told) for argument in function.arguments)})"
    body = [f"class({function.arguments[0].base}_methods), intent(in) :: self"]
    body += [declaration(api, argument) for argument in shown]
    body += ["integer, intent(out), optional :: stat", "character(len=*), intent(inout), optional :: errmsg",
             "integer(plm_status) :: status"]
    body += [f"integer({KINDS[argument.base]}) :: c_{argument.name}" for argument in found]
    body += [f"type(c_ptr) :: c_{handle}" for handle in absent]
    body += [f"c_{argument.name} = 0" for argument in found]
    for handle in absent:
        body += [f"c_{handle} = c_null_ptr", f"if (present({handle})) c_{handle} = {handle}%handle"]
    body.append(f"status = {call}")
    body += [f"if (status >= 0) {argument.name} = int(c_{argument.name})" for argument in found]
    body += ["call finish(self%context, status, stat, errmsg)"]
    dummies = ", ".join(["self"] + [argument.name for argument in shown] + ["stat", "errmsg"])
    lines = textwrap.wrap(function.comment, 114, initial_indent="    ! ", subsequent_indent="    ! ")
    lines += wrapped(f"    subroutine {name}({dummies})", 4)
    for line in body:
        lines += wrapped(" " * 8 + line, 8)
    return [*lines, f"    end subroutine {name}", ""]


def type_lines(noun, functions):
    lines = [f"    type, abstract, extends({PARENTS.get(noun, 'plm_settable')}) :: plm_{noun}_methods"]
    if functions:
        lines.append("    contains")
        lines += [f"        procedure :: {method_name(function)} => {noun}_{method_name(function)}" for function in functions]
    return [*lines, f"    end type plm_{noun}_methods", ""]


def written(api):
    """The text of the file."""
    ruled = api.by_rule_in("module plm")
    nouns = list(api.description.letters)
    lines = ["module plm_methods", *NEEDS.splitlines(),
             *wrapped(f"    public :: {', '.join(f'plm_{noun}_methods' for noun in nouns)}", 4), ""]
    for noun in nouns:
        lines += type_lines(noun, [function for function in ruled if function.noun == noun])
    lines += ["contains", ""]
    for function in ruled:
        lines += procedure_lines(api, function)
    lines.append("end module plm_methods")
    return banner("plm_methods.f90", "what the types of the module plm have by rule, in the words of plm.h.\n"
                  "! What counts from 0 there counts from 1 here, NULL is an absent argument.") + "\n".join(lines) + "\n"
