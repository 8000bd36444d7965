"""fortran/plm_f77_keys.f90: the FORTRAN 77 subroutines that set options and get results by key, the same for all handles.
PLM + letter of the handle + two letters of the verb."""
import re

from fortran_text import banner

LETTERS = {"model": "M", "sampler": "S", "basis": "B", "hbm": "H", "branch": "R", "transient": "T", "study": "Y"}
VERBS = {  # C verb: (letters, dummy, its declaration, statements)
    "set_int": ("SI", "value", "integer, intent(in) :: value",
                ["ierr = int({c}(as_pointer(handle), c_text(key), int(value, int64)))"]),
    "set_double": ("SD", "value", "real(real64), intent(in) :: value",
                   ["ierr = int({c}(as_pointer(handle), c_text(key), value))"]),
    "set_string": ("SC", "value", "character(len=*), intent(in) :: value",
                   ["ierr = int({c}(as_pointer(handle), c_text(key), c_text(value)))"]),
    "get_int": ("GI", "value", "integer, intent(inout) :: value",
                ["ierr = int({c}(as_pointer(handle), c_text(key), number))",
                 "if (ierr >= 0) call narrow(number, value, ierr)"]),
    "get_double": ("GD", "value", "real(real64), intent(inout) :: value",
                   ["ierr = int({c}(as_pointer(handle), c_text(key), value))"]),
    "get_string": ("GC", "value", "character(len=*), intent(inout) :: value",
                   ["ierr = int({c}(as_pointer(handle), c_text(key), len(buffer, int64), buffer))",
                    "if (ierr >= 0) call to_blanks(buffer, value)"]),
    "get_array": ("GA", "n, values, count", "real(real64), intent(inout) :: values(*)",
                  ["ierr = int({c}(as_pointer(handle), c_text(key), int(n, int64), values, number))",
                   "if (ierr >= 0) call narrow(number, count, ierr)"]),
    "get_int_array": ("GN", "n, values, count", "integer, intent(inout) :: values(*)",
                      ["allocate(wide(max(n, 1)))",
                       "ierr = int({c}(as_pointer(handle), c_text(key), int(n, int64), wide, number))",
                       "if (ierr >= 0) call narrow_array(wide(1:min(number, int(n, int64))), values, ierr)",
                       "if (ierr >= 0) call narrow(number, count, ierr)"]),
}


def f77_subroutine(handle, verb):
    letters, dummies, declared, statements = VERBS[verb]
    c_name = f"plm_{handle}_{verb}"
    name = f"plm{LETTERS[handle]}{letters}".lower()
    body = " ".join(statements)
    used = [w for w in ("as_pointer", "c_text", "narrow", "narrow_array", "to_blanks") if re.search(rf"\b{w}\(", body)]
    kinds = ["int64"] + (["real64"] if "real64" in declared else [])
    lines = [f"subroutine {name}(handle, key, {dummies}, ierr)",
             f"    use, intrinsic :: iso_fortran_env, only: {', '.join(kinds)}",
             f"    use plm_c, only: {c_name}",
             f"    use plm_f77_support, only: {', '.join(used)}",
             "    implicit none",
             "    integer(int64), intent(in) :: handle",
             "    character(len=*), intent(in) :: key"]
    if dummies.startswith("n,"):
        lines += ["    integer, intent(in) :: n", "    integer, intent(inout) :: count"]
    lines += [f"    {declared}", "    integer, intent(out) :: ierr"]
    if "number" in body:
        lines.append("    integer(int64) :: number")
    if "buffer" in body:
        lines.append("    character(len=len(value) + 1) :: buffer")
    if "wide" in body:
        lines.append("    integer(int64), allocatable :: wide(:)")
    if "number" in body:
        lines.append("    number = 0")
    lines += ["    " + statement.format(c=c_name) for statement in statements]
    return lines + [f"end subroutine {name}", ""]


def written(api):
    """The text of the file."""
    functions = {function.name for function in api.functions}
    lines = []
    for handle in LETTERS:
        for verb in VERBS:
            if f"plm_{handle}_{verb}" in functions:
                lines += f77_subroutine(handle, verb)
    return banner("plm_f77_keys.f90", "options and results by key for FORTRAN 77; see plmf.inc.") + "\n" + "\n".join(lines).rstrip() + "\n"
