"""fortran/plm_c.f90: the modules plm_constants and plm_c, every constant and every function in bind(C) interfaces."""
import re

from fortran_text import banner, wrapped

NUMBERS = {"int32_t": "integer(c_int32_t)", "int64_t": "integer(c_int64_t)", "double": "real(c_double)",
           "plm_status": "integer(plm_status)"}


def declaration(api, function, argument):
    """(declaration of the dummy argument, names it needs from iso_c_binding and plm_constants)"""
    name, optional = argument.name, ", optional" if argument.optional else ""
    if api.is_callback(argument):
        return f"type(c_funptr), value :: {name}", {"c_funptr"}
    if api.is_handle(argument) or argument.base == "void":
        return pointer(argument, optional, function.name.endswith("_fn")), {"c_ptr"}
    if argument.base == "char":
        return f"character(kind=c_char), intent({intent(argument)}){optional} :: {name}(*)", {"c_char"}
    number = NUMBERS[argument.base]
    needs = set(re.findall(r"\((\w+)\)", number))
    if argument.stars == 0:
        return f"{number}, value :: {name}", needs
    return f"{number}, intent({intent(argument)}){optional} :: {name}{'(*)' if argument.size else ''}", needs


def pointer(argument, optional, of_callback):
    """A handle, or an address of the host's."""
    if argument.stars == 1:
        return f"type(c_ptr), value :: {argument.name}"
    if of_callback:  # the host's procedure, which writes
        return f"type(c_ptr), intent(out) :: {argument.name}"
    return f"type(c_ptr), intent({intent(argument)}){optional} :: {argument.name}{'(*)' if argument.size else ''}"


def intent(argument):
    """A failed call leaves its outputs as they were: to Fortran they are inout."""
    return "in" if argument.intent == "in" else "inout"


def interface_body(api, function):
    pad = " " * 8
    declarations, needs = [], set()
    for argument in function.arguments:
        text, names = declaration(api, function, argument)
        declarations.append(text)
        needs |= names
    dummies = ", ".join(argument.name for argument in function.arguments)
    if function.returns == "void":
        head, tail = f"subroutine {function.name}({dummies}) bind(c)", "end subroutine"
    else:
        head, tail = f"function {function.name}({dummies}) bind(c) result(code)", "end function"
        text = "type(c_ptr)" if function.returns == "void *" else NUMBERS[function.returns]
        declarations.append(f"{text} :: code")
        needs |= set(re.findall(r"\((\w+)\)", text))
    lines = wrapped(pad + head, 8)
    lines.append(f"{pad}    import :: {', '.join(sorted(needs))}")
    lines.append(f"{pad}    implicit none")
    lines += [f"{pad}    {text}" for text in declarations]
    lines.append(f"{pad}{tail} {function.name}")
    return lines


def constants_module(constants):
    lines = ["module plm_constants",
             "    use, intrinsic :: iso_c_binding, only: c_int32_t, c_double",
             "    implicit none",
             "    private :: c_int32_t, c_double",
             "    integer, parameter :: plm_status = c_int32_t",
             ""]
    for name, value in constants.items():
        if "." in value:
            lines.append(f"    real(c_double), parameter :: {name} = {value}_c_double")
        else:
            lines.append(f"    integer(c_int32_t), parameter :: {name} = {value}_c_int32_t")
    return lines + ["end module plm_constants"]


def generics(functions):
    """plm_x for plm_x_i32 and plm_x_i64."""
    lines = []
    for name in (function.name for function in functions if function.name.endswith("_i32")):
        lines += [f"    interface {name[:-4]}", f"        procedure :: {name}, {name[:-3]}i64", "    end interface"]
    return lines


def written(api):
    """The text of the file."""
    lines = constants_module(api.constants)
    lines += ["", "module plm_c",
              "    use, intrinsic :: iso_c_binding, only: c_int32_t, c_int64_t, c_double, c_char, c_ptr, c_funptr",
              "    use plm_constants",
              "    implicit none",
              "    private :: c_int32_t, c_int64_t, c_double, c_char, c_ptr, c_funptr",
              "", "    ! what the host's callbacks look like: pass c_funloc(procedure), module procedures only",
              "    abstract interface"]
    for callback in api.callbacks:
        lines += interface_body(api, callback)
    lines += ["    end interface", "", "    interface"]
    for function in api.functions:
        lines += interface_body(api, function)
    lines += ["    end interface", "", "    ! by the kind of the integer arrays"]
    lines += generics(api.functions)
    lines += ["end module plm_c"]
    what = "the C API in bind(C) interfaces; a type(c_ptr) for every handle."
    return banner("plm_c.f90", what) + "\n".join(lines) + "\n"
