"""The C ABI: the shared library, its functions and its constants. Nothing above this file uses ctypes types of functions."""
import ctypes
import ctypes.util
import numbers
import operator
import os
import pathlib

# Functions of plm.h with one letter per argument: i int32_t, q int64_t, d double, s text in, p any other pointer.
# A test compares this table with the header.
FUNCTIONS = """
plm_status_text iqpp
plm_version ppp
plm_build_info qpp
plm_key_count ip
plm_key_info iipppp
plm_key_text iiiqpp
plm_context_create ip
plm_context_create_with_allocator ipppp
plm_context_destroy p
plm_context_set_log ppp
plm_context_set_progress ppp
plm_context_set_solver ppppp
plm_context_set_inertia pp
plm_context_get_error_text pqpp
plm_context_get_error_function pqpp
plm_context_get_error_argument pqpp
plm_context_get_error_info ppppp
plm_model_create pqp
plm_model_destroy p
plm_model_set_matrix_i32 piiiiiqppp
plm_model_set_matrix_i64 piiiiiqppp
plm_model_set_rayleigh_damping pdd
plm_model_set_modal_damping pqp
plm_model_set_structural_damping pd
plm_model_fix_dofs_i32 piqp
plm_model_fix_dofs_i64 piqp
plm_model_add_node_pairs_i32 piqppppp
plm_model_add_node_pairs_i64 piqppppp
plm_model_add_ground_contacts_i32 piqpppp
plm_model_add_ground_contacts_i64 piqpppp
plm_model_add_gap_rows_i32 piqppppp
plm_model_add_gap_rows_i64 piqppppp
plm_model_set_preload pqp
plm_model_set_excitation piqpp
plm_model_set_int psq
plm_model_set_double psd
plm_model_set_string pss
plm_model_get_int psp
plm_model_get_double psp
plm_model_get_string psqpp
plm_model_get_array psqpp
plm_model_get_int_array psqpp
plm_model_build p
plm_model_solve_rest p
plm_model_get_modes pipqpp
plm_model_audit pp
plm_model_get_finding pqppqpp
plm_sampler_create pp
plm_sampler_destroy p
plm_sampler_set_int psq
plm_sampler_set_double psd
plm_sampler_set_string pss
plm_sampler_get_int psp
plm_sampler_get_double psp
plm_sampler_get_string psqpp
plm_sampler_get_array psqpp
plm_sampler_get_int_array psqpp
plm_sampler_add_dominant_mode piq
plm_sampler_run p
plm_basis_create pp
plm_basis_destroy p
plm_basis_set_int psq
plm_basis_set_double psd
plm_basis_set_string pss
plm_basis_get_int psp
plm_basis_get_double psp
plm_basis_get_string psqpp
plm_basis_get_array psqpp
plm_basis_get_int_array psqpp
plm_basis_set_sampler pp
plm_basis_set_parent pp
plm_basis_set_responses pqp
plm_basis_build p
plm_basis_get_vectors piqqpq
plm_basis_get_residual piiqpp
plm_hbm_create pp
plm_hbm_destroy p
plm_hbm_set_int psq
plm_hbm_set_double psd
plm_hbm_set_string pss
plm_hbm_get_int psp
plm_hbm_get_double psp
plm_hbm_get_string psqpp
plm_hbm_sweep pp
plm_hbm_solve pdpqp
plm_hbm_find_peak ppqiippp
plm_hbm_refine_basis pqiidpp
plm_hbm_estimate_error ppqqiipp
plm_hbm_switch_branch ppqip
plm_hbm_find_isolated ppdp
plm_hbm_find_backbones pdp
plm_hbm_get_found pqpp
plm_hbm_track_fold ppqddp
plm_hbm_find_by_marching pqpqqp
plm_hbm_find_nonlinear_mode pqqdp
plm_branch_destroy p
plm_branch_get_int psp
plm_branch_get_double psp
plm_branch_get_string psqpp
plm_branch_get_array psqpp
plm_branch_get_int_array psqpp
plm_branch_get_amplitude pqiiqpp
plm_branch_get_coefficients pqqqp
plm_branch_get_field pqdqp
plm_branch_get_contact pqqppp
plm_branch_get_closed_share pqqp
plm_branch_get_energy pqpp
plm_branch_get_multipliers pqqppp
plm_branch_get_periodicity_defect pqp
plm_branch_get_full_residual pqp
plm_transient_create ppp
plm_transient_destroy p
plm_transient_set_int psq
plm_transient_set_double psd
plm_transient_set_string pss
plm_transient_get_int psp
plm_transient_get_double psp
plm_transient_get_string psqpp
plm_transient_get_array psqpp
plm_transient_get_int_array psqpp
plm_transient_observe_i32 piqp
plm_transient_observe_i64 piqp
plm_transient_set_state pqpp
plm_transient_start_at ppq
plm_transient_run p
plm_transient_find_periodic p
plm_transient_get_state pqpp
plm_transient_get_history pqqpp
plm_transient_get_multipliers pqppp
plm_study_create pp
plm_study_destroy p
plm_study_set_int psq
plm_study_set_double psd
plm_study_set_string pss
plm_study_get_int psp
plm_study_get_double psp
plm_study_get_string psqpp
plm_study_get_array psqpp
plm_study_get_int_array psqpp
plm_study_set_output pqii
plm_study_set_force_levels pqp
plm_study_set_reference pp
plm_study_add_response pspp
plm_study_add_compressed pspqp
plm_study_add_refined pspdp
plm_study_add_marching pspqp
plm_study_run p
plm_study_get_name pqqpp
plm_study_get_outcome pqqpp
plm_study_get_curve pqqp
plm_study_get_points pqqqppp
plm_study_write ps
"""

API_VERSION = 1
OK, NOT_CONVERGED, TRUNCATED, CANCELLED, WARNING = range(5)
ERR_HANDLE, ERR_ARGUMENT, ERR_KEY, ERR_STATE, ERR_MEMORY, ERR_NOT_BUILT = range(-1, -7, -1)
ERR_MATRIX, ERR_NOT_POSITIVE_DEFINITE, ERR_SINGULAR, ERR_EIGENSOLVER = range(-7, -11, -1)
ERR_CONVERGENCE, ERR_CALLBACK, ERR_INTERNAL, ERR_BUSY = range(-11, -15, -1)

KIND_MODEL, KIND_SAMPLER, KIND_BASIS, KIND_HBM, KIND_BRANCH, KIND_TRANSIENT, KIND_STUDY = range(1, 8)
TYPE_INT, TYPE_DOUBLE, TYPE_STRING, TYPE_ARRAY, TYPE_INT_ARRAY = range(1, 6)
KEY_NAME, KEY_DESCRIPTION, KEY_DEFAULT, KEY_CHOICES = range(1, 5)

MASS, STIFFNESS, DAMPING = range(1, 4)
CSC, TRIPLETS, CSR = range(1, 4)
FULL, LOWER, UPPER = range(1, 4)
COPY, BORROW = 1, 2
AUTO_STIFFNESS = -1.0
SYSTEM_OPEN, SYSTEM_SLIDING, SYSTEM_REST, SYSTEM_GIVEN = range(4)
PEAK, HALF_PEAK_TO_PEAK, RMS, HARMONIC = range(1, 5)
BIFURCATION_NONE, BIFURCATION_FOLD, BIFURCATION_BRANCH_POINT = range(3)
BIFURCATION_PERIOD_DOUBLING, BIFURCATION_NEIMARK_SACKER = 3, 4

REASON_NONE, REASON_NOT_POSITIVE_DEFINITE, REASON_SINGULAR, REASON_RANGE_END, REASON_POINT_LIMIT = range(5)
REASON_CANCELLED, REASON_STEP_MINIMUM, REASON_CONTACT_CHATTER, REASON_SINGULAR_TANGENT = range(5, 9)
REASON_START_FAILED, REASON_NO_EQUILIBRIUM, REASON_LOOP_CLOSED, REASON_BASIS_TOO_SMALL = range(9, 13)
REASON_TURNED_BACK, REASON_NO_PEAK, REASON_HARMONICS_TOO_FEW, REASON_OUTSIDE_BASIS = range(13, 17)
REASON_OTHER_BRANCH, REASON_NO_CONTRACTION, REASON_NOT_FINITE, REASON_UNVERIFIED = range(17, 21)
REASON_NO_SWITCHING, REASON_LOST_MODE, REASON_MODEL = range(21, 24)

pointer = ctypes.c_void_p
LOG_FN = ctypes.CFUNCTYPE(None, pointer, ctypes.c_int32, ctypes.c_char_p, pointer)
PROGRESS_FN = ctypes.CFUNCTYPE(ctypes.c_int32, pointer, ctypes.c_char_p, ctypes.c_double, pointer)
FACTOR_FN = ctypes.CFUNCTYPE(ctypes.c_int32, pointer, ctypes.c_int64, pointer, pointer, pointer, ctypes.c_int32,
                             ctypes.POINTER(pointer), pointer)
SOLVE_FN = ctypes.CFUNCTYPE(ctypes.c_int32, pointer, pointer, ctypes.c_int64, pointer, ctypes.c_int64, pointer)
INERTIA_FN = ctypes.CFUNCTYPE(ctypes.c_int32, pointer, pointer, ctypes.POINTER(ctypes.c_int64), pointer)
FREE_FACTOR_FN = ctypes.CFUNCTYPE(None, pointer, pointer, pointer)


def _candidates():
    """Where the library may be: $PLM_LIBRARY, beside this package, where the system keeps its libraries."""
    if os.environ.get("PLM_LIBRARY"):
        yield os.environ["PLM_LIBRARY"]
        return
    here = pathlib.Path(__file__).resolve().parent
    for folder in (here, here.parent):
        for name in ("libplm.so.0", "libplm.so", "libplm.dylib", "plm.dll"):
            if (folder / name).exists():
                yield str(folder / name)
    found = ctypes.util.find_library("plm")
    if found:
        yield found
    yield "libplm.so.0"


def _load():
    failures = []
    for name in _candidates():
        try:
            return ctypes.CDLL(name)
        except OSError as error:
            failures.append(str(error))
    raise ImportError("libplm was not found; install it, or let the environment variable PLM_LIBRARY name the shared "
                      "library (" + "; ".join(failures) + ")")


class _Integer:
    """An argument that holds an integer of this type; ctypes by itself would cut off what does not fit."""

    def __init__(self, c_type):
        self.limit, self.c_type = 2**(8 * ctypes.sizeof(c_type) - 1), c_type

    def from_param(self, value):
        try:
            number = operator.index(value)
        except TypeError:
            raise TypeError(f"an integer is needed, not {type(value).__name__}") from None
        if not -self.limit <= number < self.limit:
            raise TypeError(f"{number} does not fit into the library's integers, {-self.limit} to {self.limit - 1}")
        return self.c_type(number)


class _Real:
    """An argument that holds a double; any real number will do, of NumPy's too."""

    @staticmethod
    def from_param(value):
        if not isinstance(value, numbers.Real):
            raise TypeError(f"a real number is needed, not {type(value).__name__}")
        return ctypes.c_double(float(value))


class _Functions:
    """The C functions as attributes, with their argument types."""

    def __init__(self, library):
        letters = {"i": _Integer(ctypes.c_int32), "q": _Integer(ctypes.c_int64), "d": _Real, "s": ctypes.c_char_p, "p": pointer}
        self.path = library._name
        for line in FUNCTIONS.split("\n"):
            if not line.strip():
                continue
            name, arguments = line.split()
            try:
                function = getattr(library, name)
            except AttributeError:
                raise ImportError(f"{library._name} has no {name}: it is not the libplm of this package") from None
            function.argtypes = [letters[a] for a in arguments]
            function.restype = ctypes.c_int32
            setattr(self, name, function)


lib = _Functions(_load())


def text_of(function, *arguments):
    """A text the library copies out: function(*arguments, capacity, buffer, needed). Empty when it has none."""
    needed = ctypes.c_int64(0)
    if function(*arguments, 0, None, ctypes.byref(needed)) != OK:
        return ""
    buffer = ctypes.create_string_buffer(max(needed.value, 1))
    function(*arguments, len(buffer), buffer, None)
    return buffer.value.decode("utf-8", "replace")
