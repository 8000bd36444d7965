"""fortran/*_int64.inc: the procedures of the module plm for integer(int64) arrays, the twins of those for integer(int32) that
stand in the source by hand. Fortran has no way to write one procedure for two kinds."""
import re

from fortran_text import banner
from plm_header import ROOT

FILES = {"plm_model_int64.inc": "plm_model.f90", "plm_motion_int64.inc": "plm_motion.f90"}


def twin(procedure):
    """The procedure for the other kind."""
    for narrow, wide in ((r"_int32\b", "_int64"), (r"integer\(int32\)", "integer(int64)"), (r"_i32\b", "_i64")):
        procedure = re.sub(narrow, wide, procedure)
    return procedure


def written(file):
    source = (ROOT / "fortran" / FILES[file]).read_text(encoding="utf-8")
    procedures = [match[0] for match in re.finditer(r"^ *subroutine (\w+_int32)\(.*?^ *end subroutine \1\n", source, re.M | re.S)]
    return banner(file, f"the procedures of {FILES[file]} for integer(int64).") + "\n" + "\n".join(map(twin, procedures))
