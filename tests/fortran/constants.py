#!/usr/bin/env python3
"""constants.py PLM_H PLMF_INC: plmf.inc has every constant of plm.h that a FORTRAN 77 host needs, with its value."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "api"))
import plm_header  # noqa: E402

# The six letters that stand for a C name. A constant of plm.h that is neither here nor below stops the test.
SIX = {
    "OK": "OK", "NOT_CONVERGED": "NCV", "TRUNCATED": "TRU", "CANCELLED": "CAN", "WARNING": "WRN",
    "ERR_HANDLE": "EHD", "ERR_ARGUMENT": "EAR", "ERR_KEY": "EKY", "ERR_STATE": "EST", "ERR_MEMORY": "EME",
    "ERR_NOT_BUILT": "ENB", "ERR_MATRIX": "EMX", "ERR_NOT_POSITIVE_DEFINITE": "EPD", "ERR_SINGULAR": "ESI",
    "ERR_EIGENSOLVER": "EEV", "ERR_CONVERGENCE": "ECV", "ERR_CALLBACK": "ECB", "ERR_INTERNAL": "EIN", "ERR_BUSY": "EBU",
    "REASON_NONE": "RNO", "REASON_NOT_POSITIVE_DEFINITE": "RPD", "REASON_SINGULAR": "RSI", "REASON_RANGE_END": "RRE",
    "REASON_POINT_LIMIT": "RPT", "REASON_CANCELLED": "RCN", "REASON_STEP_MINIMUM": "RSM", "REASON_CONTACT_CHATTER": "RCC",
    "REASON_SINGULAR_TANGENT": "RTA", "REASON_START_FAILED": "RSF", "REASON_NO_EQUILIBRIUM": "REQ",
    "REASON_LOOP_CLOSED": "RLC", "REASON_BASIS_TOO_SMALL": "RBS",
    "REASON_TURNED_BACK": "RTB", "REASON_NO_PEAK": "RNP", "REASON_HARMONICS_TOO_FEW": "RHF", "REASON_OUTSIDE_BASIS": "ROB",
    "REASON_OTHER_BRANCH": "ROT", "REASON_NO_CONTRACTION": "RNC", "REASON_NOT_FINITE": "RNF", "REASON_UNVERIFIED": "RUV",
    "REASON_NO_SWITCHING": "RNS", "REASON_LOST_MODE": "RLM", "REASON_MODEL": "RMO",
    "KIND_MODEL": "KMO", "KIND_SAMPLER": "KSA", "KIND_BASIS": "KBA", "KIND_HBM": "KHB", "KIND_BRANCH": "KBR",
    "KIND_TRANSIENT": "KTR", "KIND_STUDY": "KST",
    "KEY_NAME": "KNM", "KEY_DESCRIPTION": "KDS", "KEY_DEFAULT": "KDF", "KEY_CHOICES": "KCH",
    "MASS": "MAS", "STIFFNESS": "STF", "DAMPING": "DMP", "CSC": "CSC", "TRIPLETS": "TRI", "CSR": "CSR",
    "FULL": "FUL", "LOWER": "LOW", "UPPER": "UPP",
    "SYSTEM_OPEN": "OPN", "SYSTEM_SLIDING": "SLI", "SYSTEM_REST": "RST", "SYSTEM_GIVEN": "GIV",
    "PEAK": "PKM", "HALF_PEAK_TO_PEAK": "PPM", "RMS": "RMS", "HARMONIC": "HRM", "AUTO_STIFFNESS": "AUT",
    "BIFURCATION_NONE": "PNO", "BIFURCATION_FOLD": "PFO", "BIFURCATION_BRANCH_POINT": "PBP",
    "BIFURCATION_PERIOD_DOUBLING": "PPD", "BIFURCATION_NEIMARK_SACKER": "PNS",
}
NOT_NEEDED = {
    "API_VERSION": "PLMCCR passes it", "COPY": "the layer always copies", "BORROW": "the layer always copies",
    "TYPE_INT": "ITYPE of PLMKIN, 1 to 5", "TYPE_DOUBLE": "", "TYPE_STRING": "", "TYPE_ARRAY": "", "TYPE_INT_ARRAY": "",
}

include = open(sys.argv[2], encoding="utf-8").read()
wanted = {name[len("PLM_"):]: float(value) for name, value in plm_header.read(sys.argv[1]).constants.items()}
found = {name: float(value.replace("D", "E"))
         for name, value in re.findall(r"^      PARAMETER \((PLM\w+) = (-?[\d.D]+)\)$", include, re.M)}
declared = set(re.findall(r"PLM\w+", " ".join(re.findall(r"^      (?:INTEGER(?:\*8)?|DOUBLE PRECISION) (.*)$", include, re.M))))

failures = []
for name, value in wanted.items():
    six = "PLM" + SIX.get(name, "???")
    if name in NOT_NEEDED:
        continue
    if name not in SIX:
        failures.append(f"PLM_{name} has no six letters: add it to SIX in tests/fortran/constants.py and to plmf.inc "
                        "(or to NOT_NEEDED with the reason)")
    elif six not in found:
        failures.append(f"plmf.inc: {six} (PLM_{name} = {value:g}) is missing")
    elif found[six] != value:
        failures.append(f"plmf.inc: {six} is {found[six]:g}, PLM_{name} is {value:g}")
OWN = {"PLMNUL": 0}  # NULL: no macro of plm.h
failures += [f"plmf.inc: {six} should be {value}" for six, value in OWN.items() if found.pop(six, None) != value]
declared -= OWN.keys()
failures += [f"plmf.inc: {six} stands for no constant of plm.h"
             for six in sorted(found.keys() - {"PLM" + SIX[name] for name in wanted if name in SIX})]
failures += [f"plmf.inc: {six} has a value and no type, or a type and no value" for six in sorted(found.keys() ^ declared)]
print("\n".join(failures) or f"{len(found)} constants as in plm.h, {len(NOT_NEEDED)} not needed")
sys.exit(bool(failures) or len(found) < 40)
