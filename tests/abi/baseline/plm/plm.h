/* clang-format off */
/* plm.h - libplm: piecewise-linear modes and harmonic balance for structures with intermittent contact.
 *
 * The whole C API. A typical host goes from top to bottom of this file:
 *
 *     plm_context  -> plm_model   hand over M, K, C, supports, contact pairs, pre-load, excitation; build
 *                  -> plm_sampler dominant mode, contact-area sweep, samples, frequency window
 *                  -> plm_basis   piecewise-linear modes (or Craig-Bampton, or the unreduced reference)
 *                  -> plm_hbm     harmonic balance with continuation
 *                  -> plm_branch  the response curve: amplitudes, contact, fields
 *                  -> plm_study   error against run time of several ways to that curve
 *
 * and plm_model_compute_response goes all that way in one call.
 *
 * Rules that hold for every function
 *   - It returns a plm_status: 0 done; > 0 done with an outcome to look at (results are valid as far as they go);
 *     < 0 failed, and then nothing has changed and no output has been written. What failed, or what should be looked
 *     at, waits as a text on the context (plm_context_get_error_text). Ask for status < 0 where a failure is meant:
 *     only functions that compute have outcomes.
 *   - Outputs come last. Pointers to outputs must not be NULL unless the declaration says "or NULL".
 *   - Handles are opaque. A child keeps its parents alive, and destroying a context destroys what is left in it;
 *     destroying what is gone already does nothing: any order is right. For any other use, a stale handle gives
 *     PLM_ERR_HANDLE, as a foreign or wrong-kind one always does.
 *   - The library never prints, exits, throws, or changes the floating-point environment, signals, locale, environment
 *     or working directory of its host, and opens no file but those plm_study_write,
 *     plm_branch_write_csv and plm_hbm_save_every are asked for.
 *   - One context belongs to one thread at a time (another one gets PLM_ERR_BUSY meanwhile); different contexts may
 *     run at once.
 *   - Dense arrays are column-major. DOFs and pairs are numbered from 0 unless the function takes an `index_base`.
 *   - Units are the caller's, consistent (mm-t-s, m-kg-s ...); frequencies are in Hz (1/time unit), angles in radian.
 *   - Text is copied into a buffer of `capacity` bytes, always ended by NUL and cut if it must be; `needed` (or NULL)
 *     receives the bytes the whole text takes with its NUL. With capacity 0 the buffer may be NULL.
 *
 * "paper" below: Zucca & Epureanu, Reduced order models for nonlinear dynamic analysis of structures with
 * intermittent contacts, J. Vibration and Control 24(12), 2018, doi 10.1177/1077546316689214.
 */
#ifndef PLM_PLM_H
#define PLM_PLM_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define PLM_API
#elif defined(__GNUC__)
#define PLM_API __attribute__((visibility("default")))
#else
#define PLM_API
#endif

/* Pass to plm_context_create: defaults that change answers are frozen per API version. */
#define PLM_API_VERSION 1

typedef struct plm_context plm_context;
typedef struct plm_model plm_model;
typedef struct plm_sampler plm_sampler;
typedef struct plm_basis plm_basis;
typedef struct plm_hbm plm_hbm;
typedef struct plm_branch plm_branch;
typedef struct plm_transient plm_transient;
typedef struct plm_study plm_study;

/* ---- Status ------------------------------------------------------------------------------------------------ */

typedef int32_t plm_status;

#define PLM_OK 0
/* finished with an outcome: results are valid as far as they go */
#define PLM_NOT_CONVERGED 1 /* a branch ended early because no corrector converged; see its "end_reason" */
#define PLM_TRUNCATED 2     /* a branch ended at the allowed number of points */
#define PLM_CANCELLED 3     /* the progress callback asked to stop; a branch holds what was found until then */
#define PLM_WARNING 4       /* done, but something should be looked at: the handle's "warning" text says what */
/* failed: nothing changed */
#define PLM_ERR_HANDLE (-1)    /* NULL, stale, foreign or wrong-kind handle */
#define PLM_ERR_ARGUMENT (-2)  /* an argument is out of its range, NaN, NULL or of the wrong size */
#define PLM_ERR_KEY (-3)       /* no option or result has this name (the text proposes the nearest) */
#define PLM_ERR_STATE (-4)     /* called too early, too late, or from inside a callback */
#define PLM_ERR_MEMORY (-5)    /* an allocation failed */
#define PLM_ERR_NOT_BUILT (-6) /* this part was left out of the build; the text names the build option */
#define PLM_ERR_MATRIX (-7)    /* matrix not symmetric, NaN or Inf inside, duplicate or out-of-range index */
#define PLM_ERR_NOT_POSITIVE_DEFINITE (-8) /* index: the DOF where the factorization broke down */
#define PLM_ERR_SINGULAR (-9)              /* a linear system has no unique solution */
#define PLM_ERR_EIGENSOLVER (-10)          /* ARPACK or LAPACK did not deliver the eigenpairs */
#define PLM_ERR_CONVERGENCE (-11)          /* an iteration did not converge and there is no partial result */
#define PLM_ERR_CALLBACK (-12)             /* a host callback reported a failure */
#define PLM_ERR_INTERNAL (-13)             /* a defect of libplm: please report the text */
#define PLM_ERR_BUSY (-14)                 /* another thread is inside a call of this context */

/* Reasons a program can branch on (plm_context_get_error_info; "end_reason" of a branch; "warning_reasons"). */
#define PLM_REASON_NONE 0
#define PLM_REASON_NOT_POSITIVE_DEFINITE 1
#define PLM_REASON_SINGULAR 2
#define PLM_REASON_RANGE_END 3       /* branch: reached the end of its range (the normal end) */
#define PLM_REASON_POINT_LIMIT 4     /* branch: "max_points" reached */
#define PLM_REASON_CANCELLED 5
#define PLM_REASON_STEP_MINIMUM 6    /* branch: step below its minimum */
#define PLM_REASON_CONTACT_CHATTER 7 /* Newton cycled between contact sets */
#define PLM_REASON_SINGULAR_TANGENT 8
#define PLM_REASON_START_FAILED 9    /* branch: no solution was found at the first frequency */
#define PLM_REASON_NO_EQUILIBRIUM 10 /* pre-load drives an unsupported rigid-body motion */
#define PLM_REASON_LOOP_CLOSED 11    /* branch: came back to its first point */
#define PLM_REASON_BASIS_TOO_SMALL 12
#define PLM_REASON_TURNED_BACK 13      /* branch: ran back to where it began, or to that end of its range */
#define PLM_REASON_NO_PEAK 14          /* the highest point stands at an end of the curve */
#define PLM_REASON_HARMONICS_TOO_FEW 15 /* "accuracy" asks for more harmonics than were allowed */
#define PLM_REASON_OUTSIDE_BASIS 16    /* frequencies, forces or motions the basis was not made for */
#define PLM_REASON_OTHER_BRANCH 17     /* the solution is not on the branch the start belongs to */
#define PLM_REASON_NO_CONTRACTION 18   /* the steps of an estimate do not contract: there is no number */
#define PLM_REASON_NOT_FINITE 19       /* overflow: a number is infinite or NaN */
#define PLM_REASON_UNVERIFIED 20       /* something that is checked by default could not be */
#define PLM_REASON_NO_SWITCHING 21     /* no pair opens or closes: this is a linear response */
#define PLM_REASON_LOST_MODE 22        /* a contact sample lost the mode that matches the dominant one */
#define PLM_REASON_MODEL 23            /* the model is probably not meant so, see plm_model_audit */
#define PLM_REASON_HOST_REDUCTION 24   /* what the host states of its superelement is too much for the accuracy */
#define PLM_REASON_UNSTABLE_PEAK 25    /* the structure does not stay on the motion of the peak */
#define PLM_REASON_CROSSED_OVER 26     /* branch: goes round a closed curve onto which one of its steps had crossed */
#define PLM_REASON_LARGER_MOTION 27    /* a larger stable motion exists at the same force, beside the curve */
#define PLM_REASON_TIE 28              /* another resonance is driven alike, or resembles the dominant mode alike */
#define PLM_REASON_ROUNDED 29          /* rows or loads that miss rigid-body motion by rounding are taken to mean it */
#define PLM_REASON_EFFORT 30           /* the work that the call may cost (plm_context_set_effort) is spent */
#define PLM_REASON_UNFINISHED 31       /* branch: saved while it was followed; plm_hbm_resume goes on with it */
#define PLM_REASON_NOT_SAVED 32        /* a curve could not be written to the file of plm_hbm_save_every */

/* What a point of a branch is ("bifurcation" of a branch). */
#define PLM_BIFURCATION_NONE 0
#define PLM_BIFURCATION_FOLD 1
#define PLM_BIFURCATION_BRANCH_POINT 2
#define PLM_BIFURCATION_PERIOD_DOUBLING 3
#define PLM_BIFURCATION_NEIMARK_SACKER 4 /* the first complex pair of multipliers crosses the unit circle */

/* Text that explains a status. Never fails on an unknown status: it says so. */
PLM_API plm_status plm_status_text(plm_status status, int64_t capacity, char *buffer, int64_t *needed);

PLM_API plm_status plm_version(int32_t *major, int32_t *minor, int32_t *patch);

/* One line: version, factorization, eigensolver, Fourier transform, BLAS, components built in, licence of the whole. */
PLM_API plm_status plm_build_info(int64_t capacity, char *buffer, int64_t *needed);

/* ---- Options and results by key ------------------------------------------------------------------------------
 * Every handle below has options (set before its build/run/sweep) and results (read after it), both named by string
 * keys listed in one table, which these functions expose and from which the reference (docs/keys.md) is made.
 * plm_X_set_int / _set_double / _set_string set an option (an int is taken for a double). An option set after a
 * build/run/sweep takes effect at the next one; a model is built once, so its options come before.
 * plm_X_get_int / _get_double / _get_string read an option or a scalar result. plm_X_get_array / _get_int_array copy
 * an array result: `count` receives its length; with values = NULL (capacity 0) only the length is asked; a capacity
 * too small is PLM_ERR_ARGUMENT.
 * An unknown key is PLM_ERR_KEY, a result asked for too early PLM_ERR_STATE. */

/* kinds of handle */
#define PLM_KIND_MODEL 1
#define PLM_KIND_SAMPLER 2
#define PLM_KIND_BASIS 3
#define PLM_KIND_HBM 4
#define PLM_KIND_BRANCH 5
#define PLM_KIND_TRANSIENT 6
#define PLM_KIND_STUDY 7
/* types of key */
#define PLM_TYPE_INT 1
#define PLM_TYPE_DOUBLE 2
#define PLM_TYPE_STRING 3
#define PLM_TYPE_ARRAY 4
#define PLM_TYPE_INT_ARRAY 5
/* texts of a key */
#define PLM_KEY_NAME 1
#define PLM_KEY_DESCRIPTION 2
#define PLM_KEY_DEFAULT 3 /* empty for results */
#define PLM_KEY_CHOICES 4 /* string options: the allowed words, separated by commas; else empty */

PLM_API plm_status plm_key_count(int32_t kind, int32_t *count);
/* is_option: 1 option, 0 result. minimum and maximum bound numeric options (both 0 for others). */
PLM_API plm_status plm_key_info(int32_t kind, int32_t index, int32_t *type, int32_t *is_option, double *minimum,
                                double *maximum);
PLM_API plm_status plm_key_text(int32_t kind, int32_t index, int32_t field, int64_t capacity, char *buffer,
                                int64_t *needed);

/* ---- Context -------------------------------------------------------------------------------------------------- */

/* Callbacks run on the calling thread, inside a call of this library. They must return (no longjmp, no exception, no
 * pthread_exit) and must not call functions of the same context. pthread_cancel waits until the call under way is over,
 * callbacks included; it takes place at the thread's next cancellation point, at the latest at the beginning of its next
 * call that is no destroy. */

/* level: 0 detail, 1 information, 2 warning. The text lives during the call only. */
typedef void (*plm_log_fn)(plm_context *ctx, int32_t level, const char *text, void *user);
/* stage: a word such as "modes" or "sweep"; fraction in [0, 1], of the call as far as its length is known: it never runs
 * backwards within one. Return non-zero to cancel. Between two calls passes less
 * than about half a second of the processor's time, but for what cannot be interrupted: one sparse factorization or one
 * dense eigenvalue problem of the libraries below, announced by its stage. On solids of 70,000 DOFs the factorization
 * of K takes 1.5 s (the count of the modes below the cutoff, "verify_counts", takes little more, and is interrupted
 * unless Eigen's solver or the host's counts). Dense eigenvalues of order n take 0.3 (n / 1000)^3 s, those of Hill's
 * method, of order 2 n (2 H + 1), three times as long. */
typedef int32_t (*plm_progress_fn)(plm_context *ctx, const char *stage, double fraction, void *user);
/* allocate returns NULL on failure; any alignment (at least that of void*) will do. */
typedef void *(*plm_allocate_fn)(int64_t bytes, void *user);
typedef void (*plm_release_fn)(void *block, void *user);
/* The host's own sparse symmetric solver: lower triangle by columns, base 0, rows ascending. positive_definite 0 asks
 * for a factorization of an indefinite matrix. Return 0 for success; any other number is a failure, PLM_ERR_CALLBACK
 * with that number as library_code, but for the first factorization of a K that turns out to be singular. x (n x nrhs,
 * leading dimension ldx) is overwritten by the solution. */
typedef int32_t (*plm_factor_fn)(plm_context *ctx, int64_t n, const int64_t *col_ptr, const int64_t *row,
                                 const double *value, int32_t positive_definite, void **factor, void *user);
typedef int32_t (*plm_solve_fn)(plm_context *ctx, void *factor, int64_t nrhs, double *x, int64_t ldx, void *user);
typedef void (*plm_free_factor_fn)(plm_context *ctx, void *factor, void *user);
/* negative: the number of negative eigenvalues of the matrix in `factor` (of the negative pivots in an LDL^T), or -1
 * when this factorization cannot tell. */
typedef int32_t (*plm_inertia_fn)(plm_context *ctx, void *factor, int64_t *negative, void *user);

/* From the DOFs of a superelement to those of the structure it was reduced from: full (n_full x n_columns) = T reduced
 * (n_dof x n_columns), both column-major without padding. It must be linear. Return 0 for success. */
typedef int32_t (*plm_recover_fn)(plm_context *ctx, int64_t n_dof, int64_t n_columns, const double *reduced,
                                  int64_t n_full, double *full, void *user);

/* The next n bytes of a state or text, in order, to wherever the host keeps them. Return 0, or a number that ends the
 * writing: PLM_ERR_CALLBACK with that number as library_code. */
typedef int32_t (*plm_write_fn)(plm_context *ctx, int64_t n, const void *bytes, void *user);

/* Tall operations: what a model does with things of n_dof rows where the host keeps these (in several processes, out of
 * core, without an assembled matrix) and implements the operations below in one function. One call does one operation;
 * calls never overlap and come on the thread that called the library. Return 0, or a number that fails the library's call
 * (PLM_ERR_CALLBACK, library_code); what an operation that failed was to write is undefined, all else stays.
 * Supports and constraints are the host's: a DOF that it holds is zero in every block, always, and empty in M, K and C.
 * Blocks x, y of columns and factors f are numbers > 0 that the library chooses, none twice. A block comes to be when it
 * is first written, and grows where columns behind its last are written. factor {m, k, c} stands for A = m M + k K + c C;
 * small_in and small_out are column-major without padding, small_out is zero on entry. number, factor and small_in live
 * during the call only, and are NULL where an operation has none. X: columns [x_first, x_first + x_cols) of x; Y alike.
 *  PLM_TALL_END        the last call for this model, from a destroy function; its answer is not looked at
 *  PLM_TALL_FREE       {n, handle[n]} are needed no longer; some may never have come to be. Its answer is not looked at
 *  PLM_TALL_FACTS      small_out[16], of the DOFs that are not held: [0] their number, [1] of these with M_ii > 0, traces of
 *                      [2] M and [3] K, [4] the least K_ii, [5] the median of K_ii / M_ii where both are > 0, 0: none; the
 *                      first DOF with neither K_ii > 0 nor M_ii > 0 [6] and an empty row of K, [7] with entries in it, -1:
 *                      none, [8] number of the latter; [9] 1: there is a C; [10] to [12] the largest absolute entries of
 *                      M, K and C, 0: not known
 *  PLM_TALL_FILL       {x, cols, seed}, factor {a, b, c}: entries a + b sin(i) + c r of DOF i, r in (-1, 1) without a
 *                      pattern, by the seed the same in every run
 *  PLM_TALL_COPY       {x, x_first, y, n, column[n]}: column[k] of y becomes column x_first + k of x
 *  PLM_TALL_COMBINE    {x, x_first, x_cols, y, y_first, y_cols, diagonal}, factor {beta, alpha}, small_in S: X = beta X +
 *                      alpha Y S, S y_cols x x_cols, or its diagonal alone. beta 0: X is not read. X and Y may share columns
 *                      where beta is 0, x_first = y_first and x_cols <= y_cols; other columns of Y hold anything then
 *  PLM_TALL_GRAM       {x, x_first, x_cols, y, y_first, y_cols, diagonal, absolute}: small_out = X^T Y, or its diagonal
 *                      alone; absolute: of the absolute values of all entries
 *  PLM_TALL_APPLY      {x, x_first, y, y_first, cols}, factor {m, k, c}: X = A Y
 *  PLM_TALL_FACTOR     {f, purpose, n_held, n_entries, held[n_held], row[n_entries], column[n_entries]}, factor {m, k, c},
 *                      small_in value[n_entries]: a factorization of A with these entries added (lower triangle, each
 *                      stands for its mirror image, too; several at one place are summed), the DOFs `held` kept at zero.
 *                      purpose 0: positive definite, for SOLVE; 1: only the count [0] is wanted. small_out[8]: [0] number
 *                      of negative eigenvalues, -1: cannot tell; [1] rough reciprocal condition, 1: cannot tell; [2] entries
 *                      of the factor, -1: not known; [3] 0, or what A turned out to be: 1 not positive definite, 2
 *                      singular; [4] the DOF where, or -1. Breaking down is an answer, not a failure, and leaves no f:
 *                      free bodies are found by it
 *  PLM_TALL_SOLVE      {f, x, x_first, x_cols}: X = f^-1 X, zero at what is held
 *  PLM_TALL_RESPONSES  {f, y, y_first, y_cols, s, n_entries, dof[n_entries], column[n_entries]}, small_in
 *                      value[n_entries]: F has s sparse columns and then those of Y, t in all; small_out[0] = 1, then F^T
 *                      f^-1 F and F^T f^-1 M f^-1 F, t x t each; left at 0: cannot, the library solves instead
 *  PLM_TALL_ROWS       {x, x_first, x_cols, n, dof[n]}: small_out (n x x_cols) = X at these DOFs; n = -1: at all, one column
 *  PLM_TALL_SET_ROWS   {x, x_first, x_cols, n, dof[n]}, factor {beta}, small_in (n x x_cols): X there = beta X + small_in
 *  PLM_TALL_LOOK       {x, x_first, x_cols}: small_out [0] 1: all entries are finite, [1] the largest Euclidean norm of a
 *                      row, [2] the first DOF that has it
 *  PLM_TALL_ENERGY     {x, x_first, x_cols}, factor {m, k, c}: small_out (2 x x_cols): x^T A x of each column, with as many
 *                      digits as can be had, and |x|^T |A| |x|
 *  PLM_TALL_RESIDUAL   {x, x_first, y, y_first, cols}, factor {rounding}, small_in lambda[cols]: small_out[cols] = the
 *                      Euclidean norm of what |K x - lambda y| exceeds rounding |K| |x| by, row by row
 *  PLM_TALL_DIAGONAL   {n, dof[n]}, factor {m, k, c}: small_out[n] = A_ii */
typedef int32_t (*plm_tall_fn)(plm_context *ctx, int32_t operation, const int64_t *number, const double *factor,
                               const double *small_in, double *small_out, void *user);

/* api_version: PLM_API_VERSION. */
PLM_API plm_status plm_context_create(int32_t api_version, plm_context **ctx);
/* All arrays of the library made for this context come from `allocate`, which must be able to serve until the context
 * is destroyed. (The factorization library and FFTW keep to malloc.) */
PLM_API plm_status plm_context_create_with_allocator(int32_t api_version, plm_allocate_fn allocate,
                                                     plm_release_fn release, void *user, plm_context **ctx);
/* Destroys the context and all that is left in it; NULL and *ctx == NULL are accepted; *ctx becomes NULL. */
PLM_API plm_status plm_context_destroy(plm_context **ctx);

/* fn NULL: silence, the default. */
PLM_API plm_status plm_context_set_log(plm_context *ctx, plm_log_fn fn, void *user);
PLM_API plm_status plm_context_set_progress(plm_context *ctx, plm_progress_fn fn, void *user);
/* How many threads a call in this context may use, the calling one among them: 1, the default, to 1024. Results are the same
 * to the last digit for any number. Shared out are solutions with the factored matrices and products with them, by blocks
 * of columns, and the modes of the contact samples of a basis. Other threads exist during a call alone, receive no signals
 * and call nothing of the host's: callbacks stay on the calling thread, so that with the host's allocator one thread does
 * everything, and with the host's solver one solves. Where the system refuses a thread there are fewer. The BLAS is apart
 * from this: that of a self-contained libplm.so works on the thread that calls it, one that is shared with the host as the
 * host has set it (OPENBLAS_NUM_THREADS; to 1 where this number is more). */
PLM_API plm_status plm_context_set_threads(plm_context *ctx, int32_t n);
/* What a call that searches may cost (plm_model_compute_response, plm_hbm_sweep, _solve, _find_..., _estimate_error,
 * _refine_basis, _switch_branch, _track_fold), in seconds of one core as its operations are counted: 10, the default, or
 * what making the model's basis took if that is more; 0: no limit. It is operations that count, not the clock, so that
 * results depend neither on the load nor on the number of threads; the time is about that, a few times as much at worst.
 * A call whose effort is spent returns the best it has, with PLM_REASON_EFFORT as reason or warning and what to do, or
 * PLM_ERR_CONVERGENCE with that reason where it has nothing yet. PLM_ERR_ARGUMENT for negative numbers, NaN or Inf. */
PLM_API plm_status plm_context_set_effort(plm_context *ctx, double seconds);
/* All three or none (NULL, NULL, NULL: the built-in solver). Takes effect for models built afterwards. */
PLM_API plm_status plm_context_set_solver(plm_context *ctx, plm_factor_fn factor, plm_solve_fn solve,
                                          plm_free_factor_fn release, void *user);
/* The inertia of the host's factorizations of indefinite matrices, by which the number of modes found is verified (one
 * factorization of K - w^2 M). NULL, as after plm_context_set_solver: it is not, and no such factorization is made;
 * "space_description" then says so. `user` is that of plm_context_set_solver, which comes first: else PLM_ERR_STATE. */
PLM_API plm_status plm_context_set_inertia(plm_context *ctx, plm_inertia_fn inertia);

/* Of the last call in this context that did not return PLM_OK: "function: what is wrong, or should be looked at; what to
 * do". After a failure (status < 0) and after an outcome (> 0) alike, the same below. Empty if there was none. */
PLM_API plm_status plm_context_get_error_text(plm_context *ctx, int64_t capacity, char *buffer, int64_t *needed);
PLM_API plm_status plm_context_get_error_function(plm_context *ctx, int64_t capacity, char *buffer, int64_t *needed);
PLM_API plm_status plm_context_get_error_argument(plm_context *ctx, int64_t capacity, char *buffer, int64_t *needed);
/* index: the offending position in the argument (its own base), -1 if none; library_code: of LAPACK, the
 * factorization or the host's callback, 0 if none. Each output may be NULL. */
PLM_API plm_status plm_context_get_error_info(plm_context *ctx, plm_status *status, int32_t *reason, int64_t *index,
                                              int64_t *library_code);

/* ---- Model: M q'' + C q' + K q = F(t) - B^T N, N = max(k_n u, 0), u = B q - g (paper, eq. (2), (3)) ------------- */

/* which matrix */
#define PLM_MASS 1
#define PLM_STIFFNESS 2
#define PLM_DAMPING 3 /* viscous; adds to Rayleigh and modal damping */
/* tall operations, told at plm_tall_fn */
#define PLM_TALL_END 0
#define PLM_TALL_FREE 1
#define PLM_TALL_FACTS 2
#define PLM_TALL_FILL 3
#define PLM_TALL_COPY 4
#define PLM_TALL_COMBINE 5
#define PLM_TALL_GRAM 6
#define PLM_TALL_APPLY 7
#define PLM_TALL_FACTOR 8
#define PLM_TALL_SOLVE 9
#define PLM_TALL_RESPONSES 10
#define PLM_TALL_ROWS 11
#define PLM_TALL_SET_ROWS 12
#define PLM_TALL_LOOK 13
#define PLM_TALL_ENERGY 14
#define PLM_TALL_RESIDUAL 15
#define PLM_TALL_DIAGONAL 16
/* storage */
#define PLM_CSC 1 /* compressed columns; for a symmetric matrix stored in full also compressed rows */
#define PLM_TRIPLETS 2
#define PLM_CSR 3 /* compressed rows */
/* stored part */
#define PLM_FULL 1
#define PLM_LOWER 2
#define PLM_UPPER 3
/* ownership of the caller's arrays */
#define PLM_COPY 1   /* the arrays are copied now */
#define PLM_BORROW 2 /* the arrays stay the caller's, unchanged and alive until plm_model_build has returned 0 */
/* contact stiffness: let the library choose ten times the local stiffness (1 / median contact flexibility) */
#define PLM_AUTO_STIFFNESS (-1.0)
/* "no DOF" in DOF lists of node pairs, in the index base of the call: base - 1 or below */

PLM_API plm_status plm_model_create(plm_context *ctx, int64_t n_dof, plm_model **model);
PLM_API plm_status plm_model_destroy(plm_model **model);

/* M (positive semi-definite), K (positive semi-definite) or C (symmetric), n_dof x n_dof.
 * PLM_CSC: a[n_dof + 1] column pointers, b[nnz] row numbers. PLM_CSR: a row pointers, b column numbers.
 * PLM_TRIPLETS: a[nnz] row numbers, b[nnz] column numbers, duplicates are summed.
 * Pointers and numbers count from index_base (0 or 1). Checked: ranges, monotone pointers, duplicates (compressed
 * forms), NaN/Inf, wrong-triangle entries, and for PLM_FULL symmetry to 1e-8 of the largest entry.
 * PLM_ERR_MATRIX with the position in b or value as index. A second call for the same matrix replaces it. */
PLM_API plm_status plm_model_set_matrix_i32(plm_model *model, int32_t which, int32_t storage, int32_t part,
                                            int32_t index_base, int32_t ownership, int64_t nnz, const int32_t *a,
                                            const int32_t *b, const double *value);
PLM_API plm_status plm_model_set_matrix_i64(plm_model *model, int32_t which, int32_t storage, int32_t part,
                                            int32_t index_base, int32_t ownership, int64_t nnz, const int64_t *a,
                                            const int64_t *b, const double *value);

/* C = alpha M + beta K; alpha in 1/s, beta in s, both >= 0. */
PLM_API plm_status plm_model_set_rayleigh_damping(plm_model *model, double alpha, double beta);
/* ratio[j] (fraction of critical, in [0, 1)) for the j-th mode of the open system, the last one for all modes beyond: one
 * ratio damps every mode by it. C = sum 2 zeta omega (M phi)(M phi)^T over all modes of the structure; where only the lower
 * ones are computed, the contact attachment vectors stand for the others, each with its own frequency. The same C for
 * every basis; what follows without inertia is not damped. n = 0 removes it. */
PLM_API plm_status plm_model_set_modal_damping(plm_model *model, int64_t n, const double *ratio);
/* Structural (hysteretic) loss factor eta >= 0: K (1 + i eta) in every harmonic h >= 1. */
PLM_API plm_status plm_model_set_structural_damping(plm_model *model, double eta);

/* DOFs held at zero; repeated calls add up, repeated DOFs are accepted once. */
PLM_API plm_status plm_model_fix_dofs_i32(plm_model *model, int32_t index_base, int64_t n, const int32_t *dof);
PLM_API plm_status plm_model_fix_dofs_i64(plm_model *model, int32_t index_base, int64_t n, const int64_t *dof);

/* Constraints sum c_j q_j = 0 among DOFs (n rows, compressed: row_ptr[n + 1], dof[nnz], coefficient[nnz]): ties,
 * multi-point constraints, rigid links at small rotations, distributing couplings. Repeated calls add up; rows may use DOFs
 * that other rows give. The build eliminates one DOF by each row; motions, loads, gap rows and results stay in all DOFs of
 * the model, dependent ones among them, which may be loaded, looked at and in contact. Terms of fixed DOFs drop out; a row
 * that leaves one DOF alone holds it at zero. Rows that repeat others, to 1e-6 of their terms, are left out and counted
 * ("n_redundant_constraints"), with PLM_WARNING and PLM_REASON_ROUNDED beyond 1e-10. Where a state is set
 * (plm_transient_set_state) the free DOFs of it count, and the others follow from them. A row over thousands of DOFs, with
 * something at the DOF that it gives, is taken by way of sums over few of them, which keep the matrices sparse;
 * PLM_ERR_MEMORY of the build names the row where these DOFs are too far apart in their numbers for that. */
PLM_API plm_status plm_model_add_constraints_i32(plm_model *model, int32_t index_base, int64_t n,
                                                 const int32_t *row_ptr, const int32_t *dof,
                                                 const double *coefficient);
PLM_API plm_status plm_model_add_constraints_i64(plm_model *model, int32_t index_base, int64_t n,
                                                 const int64_t *row_ptr, const int64_t *dof,
                                                 const double *coefficient);

/* Rigid link: n dependent nodes move with a reference node as one rigid body, at small rotations: u = u_r + w_r x (x - x_r)
 * and w = w_r. per_reference and per_dependent tell how many DOFs a node has: 3 (x, y, z) or 6 (and the rotations about
 * x, y, z). reference_dof[per_reference], reference_xyz[3], dependent_dof: per_dependent x n, dependent_xyz: 3 x n; base - 1:
 * no such DOF. A reference node without rotations does not turn, and any that has not got a DOF does not move that way.
 * The rows become constraints as by plm_model_add_constraints_i32, and count among them: further links, couplings and
 * constraints may use the same DOFs, the dependent ones too. PLM_ERR_ARGUMENT with the position as index where a DOF comes
 * twice in one link. */
PLM_API plm_status plm_model_add_rigid_link_i32(plm_model *model, int32_t index_base, int32_t per_reference,
                                                const int32_t *reference_dof, const double *reference_xyz, int64_t n,
                                                int32_t per_dependent, const int32_t *dependent_dof,
                                                const double *dependent_xyz);
PLM_API plm_status plm_model_add_rigid_link_i64(plm_model *model, int32_t index_base, int32_t per_reference,
                                                const int64_t *reference_dof, const double *reference_xyz, int64_t n,
                                                int32_t per_dependent, const int64_t *dependent_dof,
                                                const double *dependent_xyz);

/* Where the DOFs are, so that the audit can tell more: n nodes with per_node DOFs each, 3 (x, y, z) or 6 (and the rotations
 * about x, y, z), in global axes. dof: per_node x n (base - 1: no such DOF), xyz: 3 x n, in the unit of length of the
 * matrices. DOFs without a node, as modal ones, may be left out. Results do not depend on it. Given again it replaces what
 * was given before; n = 0 takes it away. */
PLM_API plm_status plm_model_set_coordinates_i32(plm_model *model, int32_t index_base, int64_t n, int32_t per_node,
                                                 const int32_t *dof, const double *xyz);
PLM_API plm_status plm_model_set_coordinates_i64(plm_model *model, int32_t index_base, int64_t n, int32_t per_node,
                                                 const int64_t *dof, const double *xyz);

/* Distributing coupling (RBE3): the reference node moves as the rigid body that fits the translations of n nodes best, by
 * least squares with a weight for each; its forces and moments go to them in these shares. The nodes stay free to move
 * against one another. reference_dof, reference_xyz as for a rigid link; dof and xyz: 3 x n, weight[n] > 0 or NULL (all
 * alike). Nodes on a line, or one alone, leave open the rotation about it: PLM_ERR_ARGUMENT where the reference node has
 * that rotation, or stands off the line; with 3 DOFs on the line it is a mean. The DOFs of the reference node follow from
 * those of all the nodes: without stiffness and mass of its own, tens of thousands of nodes cost nothing. With any, or
 * held, it would couple each of them with all others, and is taken by way of sums over some twenty of them instead: 10,000
 * nodes cost about what as many nodes of a plate do. */
PLM_API plm_status plm_model_add_distributing_coupling_i32(plm_model *model, int32_t index_base, int32_t per_reference,
                                                           const int32_t *reference_dof, const double *reference_xyz,
                                                           int64_t n, const int32_t *dof, const double *xyz,
                                                           const double *weight);
PLM_API plm_status plm_model_add_distributing_coupling_i64(plm_model *model, int32_t index_base, int32_t per_reference,
                                                           const int64_t *reference_dof, const double *reference_xyz,
                                                           int64_t n, const int64_t *dof, const double *xyz,
                                                           const double *weight);

/* Tie: n nodes (dependent_dof, dependent_xyz: 3 x n) move as the points of a surface that are closest to them, q = sum N_i q_i
 * in every direction with the shape functions of its faces. surface_dof, surface_xyz: 3 x n_surface, a table of nodes;
 * faces by their places in it, compressed (face_ptr[n_faces + 1], face_node, both from index_base on): 3, 4, 6 or 8 nodes
 * each, the corners around, then those in the middle of the sides from the one between the first two corners on. base - 1: no
 * such DOF (it does not move that way). Rotations are not tied. Where a node stands off the surface, its force acts there
 * without the moment of that distance, so that a turn of the surface does not swing the node: fine for what meshes miss of
 * a curved interface, not for offsets that are meant. Nodes farther from all faces than the tolerance (> 0, length) stay
 * free: PLM_WARNING with PLM_REASON_MODEL and how many, "n_untied_nodes"; PLM_ERR_ARGUMENT where none is near enough.
 * distance[n] or NULL: of every node from the surface ("tie_distance": the largest of those tied). A node of the surface
 * itself needs no tie, and gets none. */
PLM_API plm_status plm_model_add_tie_i32(plm_model *model, int32_t index_base, int64_t n, const int32_t *dependent_dof,
                                         const double *dependent_xyz, int64_t n_surface, const int32_t *surface_dof,
                                         const double *surface_xyz, int64_t n_faces, const int32_t *face_ptr,
                                         const int32_t *face_node, double tolerance, double *distance);
PLM_API plm_status plm_model_add_tie_i64(plm_model *model, int32_t index_base, int64_t n, const int64_t *dependent_dof,
                                         const double *dependent_xyz, int64_t n_surface, const int64_t *surface_dof,
                                         const double *surface_xyz, int64_t n_faces, const int64_t *face_ptr,
                                         const int64_t *face_node, double tolerance, double *distance);

/* DOFs of the matrices that are Lagrange multipliers (n numbers; the second call replaces the first, n = 0 removes them): the
 * row of such a DOF in K holds the coefficients of a constraint, its diagonal is zero, and nothing of M and C stands at it.
 * The build makes constraints of these rows, behind all others, and takes the DOFs out of what moves: their values, the
 * forces of the constraints, are reported as 0. PLM_ERR_MATRIX of the build, with the DOF as index, where a row has a
 * diagonal, couples two multipliers or is empty (codes with two multipliers for each constraint: fix them, and hand over
 * plm_model_add_constraints_i32); PLM_ERR_ARGUMENT where a load acts on one. */
PLM_API plm_status plm_model_set_multipliers_i32(plm_model *model, int32_t index_base, int64_t n, const int32_t *dof);
PLM_API plm_status plm_model_set_multipliers_i64(plm_model *model, int32_t index_base, int64_t n, const int64_t *dof);

/* The host's tall operations (plm_tall_fn) in place of the model's matrices: n_dof counts the rows of its blocks. fn NULL:
 * none, the default. Gap rows, node pairs, loads, outputs and damping go with it as usual, by the DOFs of these rows; all
 * else that happens with M, K and C is asked of fn, from the build on until PLM_TALL_END: fn and user must live as long.
 * PLM_ERR_STATE of the build beside matrices, fixed DOFs, constraints, couplings, ties, multipliers, coordinates, an
 * elimination order or a motion of the base, which are the host's here, and of plm_model_estimate_memory and
 * "memory_limit". The audit says nothing that it would have to read from entries. All, or nearly all modes of a structure are found for up
 * to 2,000 DOFs. */
PLM_API plm_status plm_model_set_tall_operations(plm_model *model, plm_tall_fn fn, void *user);

/* The order in which the sparse factorization by cholmod eliminates the DOFs, in place of the library's: a permutation of
 * all of them, n = n_dof, for hosts that know their mesh; fixed and dependent ones are passed over. It changes time and memory, no
 * result. n = 0 removes it. Repeated and missing DOFs are PLM_ERR_ARGUMENT with the position as index. */
PLM_API plm_status plm_model_set_elimination_order_i32(plm_model *model, int32_t index_base, int64_t n,
                                                       const int32_t *dof);
PLM_API plm_status plm_model_set_elimination_order_i64(plm_model *model, int32_t index_base, int64_t n,
                                                       const int64_t *dof);

/* n contact pairs of nodes a and b. dof_a, dof_b: 3 x n, the x, y, z DOFs of the nodes (base - 1: no such DOF).
 * normal: 3 x n, unit, pointing out of a's body towards b. stiffness[n]: k_n > 0 (force/length) or PLM_AUTO_STIFFNESS.
 * gap[n] or NULL (zero): initial distance, > 0 open, < 0 interference.
 * penetration u = normal . (q_a - q_b) - gap, > 0 closed. */
PLM_API plm_status plm_model_add_node_pairs_i32(plm_model *model, int32_t index_base, int64_t n, const int32_t *dof_a,
                                                const int32_t *dof_b, const double *normal, const double *stiffness,
                                                const double *gap);
PLM_API plm_status plm_model_add_node_pairs_i64(plm_model *model, int32_t index_base, int64_t n, const int64_t *dof_a,
                                                const int64_t *dof_b, const double *normal, const double *stiffness,
                                                const double *gap);
/* Node against rigid ground; the normal points from the node's body into the ground: u = normal . q - gap. */
PLM_API plm_status plm_model_add_ground_contacts_i32(plm_model *model, int32_t index_base, int64_t n,
                                                     const int32_t *dof, const double *normal,
                                                     const double *stiffness, const double *gap);
PLM_API plm_status plm_model_add_ground_contacts_i64(plm_model *model, int32_t index_base, int64_t n,
                                                     const int64_t *dof, const double *normal,
                                                     const double *stiffness, const double *gap);
/* Raw rows of the gap matrix B (n x n_dof, compressed rows: row_ptr[n + 1], dof[nnz], coefficient[nnz]), for
 * non-matching meshes or rotational DOFs: u = B q - gap. */
PLM_API plm_status plm_model_add_gap_rows_i32(plm_model *model, int32_t index_base, int64_t n, const int32_t *row_ptr,
                                              const int32_t *dof, const double *coefficient, const double *stiffness,
                                              const double *gap);
PLM_API plm_status plm_model_add_gap_rows_i64(plm_model *model, int32_t index_base, int64_t n, const int64_t *row_ptr,
                                              const int64_t *dof, const double *coefficient, const double *stiffness,
                                              const double *gap);

/* Contact between surfaces, whose meshes need not match. First the surfaces: a table of n nodes (dof, xyz: 3 x n, base - 1:
 * no such DOF; none at all: a rigid wall, or ground, which nothing moves) and faces by their places in it, as those of
 * plm_model_add_tie, numbered so that their normals (right-hand rule around the corners) point out of the body. n_faces = 0
 * (face_ptr, face_node NULL): nodes alone, which can be a slave. area[n] or NULL: the areas that nodes stand for where the
 * faces do not tell or are not to (0: what the faces give). surface: its number, from 0 on. PLM_ERR_ARGUMENT for faces
 * without an area. */
PLM_API plm_status plm_model_add_surface_i32(plm_model *model, int32_t index_base, int64_t n, const int32_t *dof,
                                             const double *xyz, const double *area, int64_t n_faces,
                                             const int32_t *face_ptr, const int32_t *face_node, int64_t *surface);
PLM_API plm_status plm_model_add_surface_i64(plm_model *model, int32_t index_base, int64_t n, const int64_t *dof,
                                             const double *xyz, const double *area, int64_t n_faces,
                                             const int64_t *face_ptr, const int64_t *face_node, int64_t *surface);
/* options of a surface contact, added up */
#define PLM_SURFACE_POINTS 1    /* pairs at the points that integrate over the slave's faces, not at its nodes; with middle nodes ever */
#define PLM_SURFACE_SYMMETRIC 2 /* and the master's against the slave's faces, half the stiffness each; twins are one pair */
#define PLM_SURFACE_SMOOTH 4    /* normals and gaps of surfaces smooth across edges below 45 degrees, not those of faces */
#define PLM_SURFACE_TWO_SIDED 8 /* the master is a sheet, and each point stands on the side that it is on */
/* Then the contact: each node on the slave's faces (each node where it has none) is a contact pair with its projection onto
 * the nearest face of the master, u = normal . (q - sum N_i q_i) - gap, the normal being that of the master, turned into
 * it, and the gap the distance along it, < 0: interference, in which the model then rests; gaps and interferences up to
 * `closed` (a length >= 0) become 0. Faces of 3 and 4 nodes cut off the square of a cell by 8 radii from a curved interface:
 * where it is to be closed, that belongs to `closed`; where a gap or an interference counts (a press fit), ask for
 * PLM_SURFACE_SMOOTH, which gives it back.
 * stiffness: by area (force/length^3), times the area that each node stands for; of each pair (force/length) where the
 * slave has neither faces nor areas; or PLM_AUTO_STIFFNESS. Nodes farther than `search` from all faces, or beside them (by
 * more than half their gap and a hundredth of the face), have no partner. Nor have those that look the same way as the
 * nearest face does: PLM_WARNING with PLM_REASON_MODEL, for then faces are turned over, or a sheet has two sides. Where all
 * DOFs of both sides are fixed by then there is no pair either.
 * PLM_ERR_ARGUMENT where nobody has a partner. Rows are zero along rigid motions of both surfaces, rotations included,
 * whatever the gap: its lever arm lies along the normal. (A slave that leans over turns the force with its own
 * displacement no more than any small motion does.) What was found: "surface_report" in words, and "surface_point",
 * "_face", "_pair", "_gap", "_normal", "_area" of every point. The pairs stand behind those added before, in this order.
 * A uniform pressure passes exactly between plane matching meshes; between others the resultant and its moment are exact,
 * and so are the nodal forces of the slave. Cells of 3 x 2 against 5 x 3: single pairs are off by 12 to 17 % of the pressure
 * (nodes) or 13 to 31 % (points), displacements by 6 % of what the blocks give (nodes) or 0.3 % (points). Slaves whose faces
 * have middle nodes therefore take points, unless `area` says what their nodes stand for: shares that pass a pressure are not
 * positive there. With PLM_SURFACE_SYMMETRIC nodes that face each other exactly are one pair of the stiffness of both, and
 * "surface_pair" names it for both. */
PLM_API plm_status plm_model_add_surface_contact(plm_model *model, int64_t slave, int64_t master, int32_t options,
                                                 double stiffness, double search, double closed);

/* A contact force at rest, force[n], in place of the initial gap: pair i presses with force[i] >= 0 when the structure rests
 * under the pre-load, whatever its k_n, and the build finds the gap that does so ("initial_gap", mostly an interference);
 * PLM_KEEP_GAP: the pair keeps its gap. n is the number of pairs added so far, those added later keep theirs; NULL
 * removes it. Displacements count from the structure without loads and contact, as ever: where the matrices
 * are those of the state at rest, hand over B^T force as pre-load and they count from there. Motions are the same.
 * PLM_ERR_CONVERGENCE of the build with PLM_REASON_NO_EQUILIBRIUM where pre-load and forces push a loose body; where both
 * change after the build: NULL, the new pre-load, the new forces. */
#define PLM_KEEP_GAP (-1.0)
PLM_API plm_status plm_model_set_rest_force(plm_model *model, int64_t n, const double *force);

/* Outputs that are no DOFs: n sums of them, sum c_j q_j (compressed rows: row_ptr[n + 1], dof[nnz], coefficient[nnz]), such
 * as a stress at a point, a relative motion, the mean over a surface, the elastic force on a support (the rows of K there).
 * They are numbered on from the DOFs: first_dof is the number of the first one, n_dof when there are none yet, the others
 * follow. Wherever a function takes the DOF of an output (`dof`, `first_dof` of plm_branch_get_coefficients, what a transient
 * observes) such a number may stand: amplitudes with their exact extrema, peaks, error estimates, refinement, one call,
 * studies and histories all look at a sum as at a DOF, and no function of its own is needed for any of them. Results do not
 * depend on it otherwise, so outputs may be added before the build and after it, also for branches that are there already;
 * none is ever taken away. Terms of fixed DOFs are zero (of moving supports: see plm_model_set_base_motion). Fields (q[n_dof])
 * and loads are of the DOFs alone. */
PLM_API plm_status plm_model_add_outputs_i32(plm_model *model, int32_t index_base, int64_t n, const int32_t *row_ptr,
                                             const int32_t *dof, const double *coefficient, int64_t *first_dof);
PLM_API plm_status plm_model_add_outputs_i64(plm_model *model, int32_t index_base, int64_t n, const int64_t *row_ptr,
                                             const int64_t *dof, const double *coefficient, int64_t *first_dof);

/* What acts may be changed after plm_model_build: pre-load, forces at rest, excitation, gap motion, Rayleigh, modal and
 * structural damping (not a damping matrix, nor the motion of supports), by the same functions. Nothing is factored again.
 * They then return PLM_WARNING as the build does. Branches, studies that have run and what a transient has recorded stay
 * what they are, of the loads as they were, with their error measures; plm_model_get_modes and the state at rest follow
 * from the new ones. A sampler has to run again and a basis to be built again, in this order, before more is computed with
 * them, a transient to be made anew: PLM_ERR_STATE says so until then, and names the argument. PLM_ERR_STATE also where the
 * build had held DOFs that nothing moved and a load would move them now. (A force level alone is the option "force_scale",
 * which makes nothing stale.) */

/* Static pre-load, force[n_dof]; n must equal n_dof. NULL removes it. */
PLM_API plm_status plm_model_set_preload(plm_model *model, int64_t n, const double *force);
/* Harmonic h of the excitation: F(t) = sum_h Re(F_h exp(i h omega t)), F_h = real + i imag, each [n_dof], imag or
 * NULL (zero). h = 0 is a static part that comes and goes with the excitation (imag must be NULL).
 * real = NULL removes it. */
PLM_API plm_status plm_model_set_excitation(plm_model *model, int32_t harmonic, int64_t n, const double *real,
                                            const double *imag);
/* A part of harmonic h of the excitation that grows with a power of its frequency: omega^power Re(F exp(i h omega t)) is
 * added to what plm_model_set_excitation gives, omega in rad/s, power 1 or 2 (0 is that function's own part). F is what
 * the load is at omega = 1 rad/s: of an unbalance, power 2, h = 1, it is mass times eccentricity (in t mm where forces are
 * N, in kg m where they are N), turned with it by imag. n, real, imag, and what removes the part, as there. It is an
 * excitation: force_scale multiplies it. */
PLM_API plm_status plm_model_set_growing_excitation(plm_model *model, int32_t harmonic, int32_t power, int64_t n,
                                                    const double *real, const double *imag);
/* Moving walls: harmonic h of the gaps' motion, gap(t) = gap + sum_h Re(G_h exp(i h omega t)), G_h = real + i imag
 * (length), each [n], imag or NULL (zero); n is the number of pairs added so far, those added later stand still. A
 * casing that is out of round, a shaker's table, a travelling wave. Harmonic balance and motions in time take it
 * exactly. It is excitation: force_scale multiplies it as it does the forces, h = 0 included (imag must be NULL
 * then; what is not to be scaled belongs in the gap). Resonance is told by the phase against the forces, and so not
 * where walls move: plm_hbm_find_backbones and plm_hbm_find_isolated refuse such a model, and plm_model_compute_response
 * does not look for a larger motion beside the curve. real = NULL removes harmonic h. */
PLM_API plm_status plm_model_set_gap_motion(plm_model *model, int32_t harmonic, int64_t n, const double *real,
                                            const double *imag);

/* Moving supports: harmonic h >= 1 of the motion of fixed DOFs, Re((real + i imag) exp(i h omega t)), each [n], n =
 * n_dof, imag or NULL (zero); entries of DOFs that are not fixed must be zero. Supports may move differently. DOFs that
 * constraints tie to them move with them (a shaker's table: fix and move the reference node of a rigid link);
 * plm_model_build refuses a DOF that moves without being fixed, and a motion that the constraints forbid. quantity:
 * PLM_DISPLACEMENT (length), PLM_VELOCITY (length/s) or PLM_ACCELERATION (length/s^2), rotations in rad; one of them for a
 * harmonic, the last one given.
 * Results are relative to the base: displacements less those with which the structure follows its supports at rest, L u_s,
 * L = -K_ff^-1 K_fs; supports, and what moves with them alone, stay at zero; what nothing but contact holds does not follow.
 * For absolute results set the option "absolute_outputs" to 1 before the build: outputs of plm_model_add_outputs then include
 * the motion of the supports (of supports themselves too), wherever an output may stand; DOFs, fields, states of a transient
 * and plm_model_recover_amplitude stay relative.
 * M, K and C act through the supports as they do among the free DOFs: a dashpot to a support needs its entries there. Modal
 * damping, structural damping and the stiffness part of Rayleigh's damp the relative motion, the mass part and the matrix C
 * the absolute one. A row of the gap matrix that the base moves, as against a wall that stands still, has a gap that moves
 * (plm_model_set_gap_motion says what follows), of a given velocity or acceleration by another amount at every frequency. A
 * row with a support in it is a wall that moves with the support. It is excitation: force_scale multiplies it; it belongs to
 * the build and is not changed after it. real = NULL removes harmonic h. */
#define PLM_DISPLACEMENT 0
#define PLM_VELOCITY 1
#define PLM_ACCELERATION 2
PLM_API plm_status plm_model_set_base_motion(plm_model *model, int32_t quantity, int32_t harmonic, int64_t n,
                                             const double *real, const double *imag);

/* Superelements: a structure that the host has reduced already (Craig and Bampton's method in any code, or modes and
 * contact attachment vectors, the columns of T) is a model like any other, whose DOFs are the coordinates of the
 * reduction: T^T M T, T^T K T, the gap rows B T, the loads T^T F. Small dense matrices go in as they are, and are factored
 * and multiplied as dense ones. Contact at retained DOFs needs no gap rows: plm_model_add_node_pairs takes them. All
 * results are in these DOFs; the recovery leads back to the structure. What the reduction itself leaves out this library
 * cannot see: state it by the option "reduction_error", and it is added to every estimated error that is a bound (of
 * plm_model_compute_response, plm_hbm_find_peak and plm_hbm_refine_basis), with PLM_WARNING and
 * PLM_REASON_HOST_REDUCTION where it takes more than half of the accuracy asked for and the sum is above. (The parts of
 * plm_hbm_estimate_error have signs, and this one has none.) */

/* M, K (positive semi-definite, checked) or C (symmetric), n_dof x n_dof, dense, column-major, ld >= n_dof; copied. part:
 * what of it is read. PLM_ERR_MATRIX with the position in value as index; PLM_ERR_NOT_POSITIVE_DEFINITE with the DOF where
 * a Cholesky factorization of M or K, scaled to unit diagonal, meets a pivot below -1e-8. Replaces an earlier matrix of
 * whatever form. n_dof <= 46340. */
PLM_API plm_status plm_model_set_dense_matrix(plm_model *model, int32_t which, int32_t part, const double *value,
                                              int64_t ld);
/* Raw rows of the gap matrix as plm_model_add_gap_rows, dense: row is n x n_dof, column-major, ld >= n. */
PLM_API plm_status plm_model_add_dense_gap_rows(plm_model *model, int64_t n, const double *row, int64_t ld,
                                                const double *stiffness, const double *gap);
/* The host's way from the model's DOFs to the n_full of the structure, before the build; fn NULL: none, the default. fn and
 * user must live as long as the model. It is called by the two functions below, on the calling thread. */
PLM_API plm_status plm_model_set_recovery(plm_model *model, int64_t n_full, plm_recover_fn fn, void *user);
/* Any motions in the model's DOFs (fields of branches, vectors of a basis, modes, the state at rest or of a transient) on
 * the whole structure: reduced is n_dof x n_columns, full n_full x n_columns. PLM_ERR_STATE without a recovery;
 * PLM_ERR_CALLBACK when it reports a failure (library_code: its number) or returns NaN. */
PLM_API plm_status plm_model_recover(plm_model *model, int64_t n_columns, const double *reduced, int64_t n_full,
                                     double *full);
/* As plm_branch_get_amplitude, of a DOF of the whole structure, 0 <= full_dof < n_full. branch: of this model. The
 * recovery is asked for the columns of the basis, not for every point. */
PLM_API plm_status plm_model_recover_amplitude(plm_model *model, plm_branch *branch, int64_t full_dof, int32_t measure,
                                               int32_t harmonic, int64_t capacity, double *amplitude, int64_t *count);

PLM_API plm_status plm_model_set_int(plm_model *model, const char *key, int64_t value);
PLM_API plm_status plm_model_set_double(plm_model *model, const char *key, double value);
PLM_API plm_status plm_model_set_string(plm_model *model, const char *key, const char *value);
PLM_API plm_status plm_model_get_int(plm_model *model, const char *key, int64_t *value);
PLM_API plm_status plm_model_get_double(plm_model *model, const char *key, double *value);
PLM_API plm_status plm_model_get_string(plm_model *model, const char *key, int64_t capacity, char *buffer,
                                        int64_t *needed);
PLM_API plm_status plm_model_get_array(plm_model *model, const char *key, int64_t capacity, double *values,
                                       int64_t *count);
PLM_API plm_status plm_model_get_int_array(plm_model *model, const char *key, int64_t capacity, int64_t *values,
                                           int64_t *count);

/* Before the build: bytes that the model, and what is usually made of it, will take at once at most, from the pattern of
 * the matrices (the factor's part is exact, an ordering and a symbolic factorization); by phase: "memory_matrices",
 * "memory_factorization", "memory_factor", "memory_modes", "memory_contact_space", "memory_basis". What the host's own
 * solver takes is not known, and not counted. With "memory_limit" set, plm_model_build fails by this estimate with
 * PLM_ERR_MEMORY, before anything is factored. PLM_ERR_STATE without M or K, and once the model is built. */
PLM_API plm_status plm_model_estimate_memory(plm_model *model, double *bytes);

/* Checks the whole, removes fixed DOFs and those that nothing moves, factors K. Then the model no longer changes.
 * PLM_WARNING when something is probably wrong ("warning"); what is only worth a look goes to the log (plm_model_audit);
 * with PLM_REASON_ROUNDED when gap rows or static loads miss rigid-body motion that nothing holds by what printed
 * coordinates are rounded to: they are taken to mean it, and the text says by how much. PLM_ERR_STATE without M or K;
 * PLM_ERR_MATRIX when they are exchanged; PLM_ERR_NOT_POSITIVE_DEFINITE if K + sigma M is not. Rigid-body modes are
 * allowed. */
PLM_API plm_status plm_model_build(plm_model *model);

/* Static equilibrium under the pre-load with unilateral contact (the minimum of the potential energy). Read it by
 * "rest_displacement", "rest_penetration", "rest_closed", "rest_force". Called by the sampler when needed.
 * PLM_ERR_CONVERGENCE with PLM_REASON_NO_EQUILIBRIUM when the load drives an unsupported motion. */
PLM_API plm_status plm_model_solve_rest(plm_model *model);

/* which linear system */
#define PLM_SYSTEM_OPEN 0    /* no pair coupled */
#define PLM_SYSTEM_SLIDING 1 /* every pair coupled by k_n along its normal */
#define PLM_SYSTEM_REST 2    /* the pairs closed at rest are coupled */
#define PLM_SYSTEM_GIVEN 3   /* the pairs with closed[i] != 0 are coupled */
/* The n lowest natural frequencies (Hz) of a linear system; shape: n_dof x n, mass-normalised, or NULL.
 * closed[n_pairs] for PLM_SYSTEM_GIVEN, else NULL. Relative accuracy: the model's "space_tolerance". Of large structures
 * with many pairs, and no "memory_limit", modes and rest come from another factorization, without a contact space. */
PLM_API plm_status plm_model_get_modes(plm_model *model, int32_t system, const int32_t *closed, int64_t n,
                                       double *frequency_hz, double *shape);
/* How many natural frequencies of the open structure lie below frequency_hz (Hz), rigid-body modes included, by
 * Sylvester's law of inertia: one factorization, no eigenvectors, none is missed. Use it to size a basis or to check a
 * modal analysis. PLM_ERR_STATE where the host's own solver does not tell the inertia (plm_context_set_inertia);
 * PLM_ERR_SINGULAR where frequency_hz is a natural frequency to working precision. */
PLM_API plm_status plm_model_count_modes(plm_model *model, double frequency_hz, int64_t *count);

/* Looks the built model over: mass per direction, rigid-body modes, symmetry, definiteness, gap signs, contact
 * stiffness against local stiffness, units that look off, an excitation that moves no low mode, gaps that the linear
 * response never closes. With coordinates (plm_model_set_coordinates_i32) also: the six motions of a rigid body through K
 * and the gap rows, mass, centre of gravity and moments of inertia, DOFs per node, density and speed of waves, gaps and
 * normals against where the nodes are. count: number of findings, read one by one below. */
PLM_API plm_status plm_model_audit(plm_model *model, int64_t *count);
/* severity: 0 fact, 1 worth a look, 2 probably wrong. value: the number the finding is about. */
PLM_API plm_status plm_model_get_finding(plm_model *model, int64_t index, int32_t *severity, double *value,
                                         int64_t capacity, char *buffer, int64_t *needed);

/* The whole way in one call, for a built model with an excitation: the response curve around the resonance that the
 * excitation drives most, and its peak at DOF `dof`. measure: PLM_PEAK, PLM_HALF_PEAK_TO_PEAK or PLM_RMS. accuracy: the
 * relative error that the peak may have, 1e-8 to 0.5 (1e-3 is usual); sampler, window, basis, motion and harmonics follow
 * from it: the curve is followed on the unreduced structure, as far as its motions need that, or on a basis that is refined,
 * until what either leaves out is estimated to be within. Outputs: frequency (Hz) and amplitude of the peak;
 * error: that estimate, NaN where there is none, or NULL; curve: or NULL; hbm: the solver that computed it, to go on with
 * (other points, isolated branches, stability), with its basis behind it, or NULL. With pre-load or gaps motions beside
 * the curve are looked for at the same force, for about as much work as the curve took: PLM_WARNING with
 * PLM_REASON_LARGER_MOTION where a stable one is larger than the peak; "larger_amplitude" and "larger_frequency_hz" of hbm
 * are the highest one, and its curve with the force scales between which that exists is the first of plm_hbm_get_found.
 * The same reason where the curve is not stable, beside its folds, and the structure, marched in time from there, comes to
 * more than the peak.
 * error is an upper bound of the relative error of amplitude and frequency, and NaN on a curve that ended early or has no
 * peak inside. PLM_WARNING says what of the accuracy was not reached and what else should be looked at, with the reasons of
 * plm_sampler_run, plm_basis_build, plm_hbm_sweep and plm_hbm_find_peak; PLM_TRUNCATED and PLM_NOT_CONVERGED as for a
 * sweep. Where more work than plm_context_set_effort allows would be needed, the answer is the best that it reached, with
 * PLM_REASON_EFFORT among the warnings: at least the peak of a curve with few harmonics.
 * PLM_ERR_STATE before plm_model_build and without contact pairs. */
PLM_API plm_status plm_model_compute_response(plm_model *model, int64_t dof, int32_t measure, double accuracy,
                                              double *frequency_hz, double *amplitude, double *error,
                                              plm_branch **curve, plm_hbm **hbm);

/* ---- Sampler: the evolution of the contact area (paper, 2.3.1 and 2.3.2) ---------------------------------------- */

PLM_API plm_status plm_sampler_create(plm_model *model, plm_sampler **sampler);
PLM_API plm_status plm_sampler_destroy(plm_sampler **sampler);
PLM_API plm_status plm_sampler_set_int(plm_sampler *sampler, const char *key, int64_t value);
PLM_API plm_status plm_sampler_set_double(plm_sampler *sampler, const char *key, double value);
PLM_API plm_status plm_sampler_set_string(plm_sampler *sampler, const char *key, const char *value);
PLM_API plm_status plm_sampler_get_int(plm_sampler *sampler, const char *key, int64_t *value);
PLM_API plm_status plm_sampler_get_double(plm_sampler *sampler, const char *key, double *value);
PLM_API plm_status plm_sampler_get_string(plm_sampler *sampler, const char *key, int64_t capacity, char *buffer,
                                          int64_t *needed);
PLM_API plm_status plm_sampler_get_array(plm_sampler *sampler, const char *key, int64_t capacity, double *values,
                                         int64_t *count);
PLM_API plm_status plm_sampler_get_int_array(plm_sampler *sampler, const char *key, int64_t capacity, int64_t *values,
                                             int64_t *count);
/* A further dominant mode whose sweep is sampled too. system: PLM_SYSTEM_OPEN, _SLIDING or _REST; mode: 1, 2, ... */
PLM_API plm_status plm_sampler_add_dominant_mode(plm_sampler *sampler, int32_t system, int64_t mode);
/* Finds the dominant mode, the sweep, the samples and the window. PLM_WARNING of what the build warned of, too, and with
 * PLM_REASON_TIE when two resonances are driven alike. PLM_ERR_STATE without a built model, or a contact pair in it. */
PLM_API plm_status plm_sampler_run(plm_sampler *sampler);

/* ---- Basis: reduction matrices (paper, 2.3.3 and 2.3.4) ----------------------------------------------------------
 * Option "kind": "plm" (needs a sampler), "craig_bampton" (contact DOFs retained), "full" (the unreduced structure,
 * represented to "space_tolerance" of the model by exact modes and contact attachment vectors), "pod" (the parent's
 * coordinates compressed to what its responses need: dense curves and sweeps of parameters then cost a fraction).
 * Published rivals on the same solver, which need no sampler (it gives them the window) but contact pairs:
 * "bilinear" (modes of the open and of the sliding system; Saito and Epureanu 2011, Zucca and Epureanu 2014),
 * "lelsm" (modes of equivalent linear systems, k_n scaled to the bilinear frequency of each; Butcher and Lu 2007),
 * "lelsm_updated" (modes of the system equivalent to the contact at the amplitude of the resonance, with static
 * responses to the excitation and to the contact forces; AL-Shudeifat and Butcher 2010; "equivalent_amplitude"),
 * "discontinuity" (modes with the contact as at rest, or closed where nothing decides, and a static field with a jump
 * for each pair; Segalman 2007; "n_discontinuities").
 * "snapshots" (needs a sampler; modes at rest up to "rest_factor" times the window's end that answer to the contact,
 * and the exact unilateral static solutions under the pre-load with the dominant mode's inertia on top, at
 * "n_snapshots" sizes, with the static response to their own inertia; small where contact is under pre-load and excites
 * few modes).
 * With any kind, "n_pairs_carried" leaves contact equations at some of the pairs only, chosen by "pair_rule" (node
 * sampling: Saito, Epureanu, Castanier & Pierre 2010; effective independence: Kammer 1991; master DOFs: Henshell & Ong
 * 1975). Each pair left out adds its k_n to the carried pair that moves most alike; results of a branch are of all
 * pairs, from the recovered field: those of a pair left out are its own gap and k_n times its own penetration. */

PLM_API plm_status plm_basis_create(plm_model *model, plm_basis **basis);
PLM_API plm_status plm_basis_destroy(plm_basis **basis);
PLM_API plm_status plm_basis_set_int(plm_basis *basis, const char *key, int64_t value);
PLM_API plm_status plm_basis_set_double(plm_basis *basis, const char *key, double value);
PLM_API plm_status plm_basis_set_string(plm_basis *basis, const char *key, const char *value);
PLM_API plm_status plm_basis_get_int(plm_basis *basis, const char *key, int64_t *value);
PLM_API plm_status plm_basis_get_double(plm_basis *basis, const char *key, double *value);
PLM_API plm_status plm_basis_get_string(plm_basis *basis, const char *key, int64_t capacity, char *buffer,
                                        int64_t *needed);
PLM_API plm_status plm_basis_get_array(plm_basis *basis, const char *key, int64_t capacity, double *values,
                                       int64_t *count);
PLM_API plm_status plm_basis_get_int_array(plm_basis *basis, const char *key, int64_t capacity, int64_t *values,
                                           int64_t *count);
/* The samples (and the window) the piecewise-linear modes are made from; it must have run before the build. Other kinds
 * but "pod" take the window from it. */
PLM_API plm_status plm_basis_set_sampler(plm_basis *basis, plm_sampler *sampler);
/* First reduction under the modes, as in the paper: a built basis of kind "craig_bampton" or "full"; NULL for none. For
 * kind "pod" the basis, of any kind, the responses were computed on. */
PLM_API plm_status plm_basis_set_parent(plm_basis *basis, plm_basis *parent);
/* For kind "pod": the points of n curves, all computed on the parent, whose motions span the basis (proper orthogonal
 * decomposition in the energy norm, each curve scaled by its largest response). The curves are read here and may be
 * destroyed afterwards; n = 0 forgets them. */
PLM_API plm_status plm_basis_set_responses(plm_basis *basis, int64_t n, plm_branch *const *branch);
/* PLM_WARNING (see "warning", "warning_reasons") when a sample does not keep the mode that matches the dominant one (the
 * selection by bands can lose the resonance), or the equivalent stiffnesses of "lelsm_updated" did not settle.
 * PLM_ERR_ARGUMENT for a rival kind when the model has no contact pair or fewer than "n_discontinuities", or nothing
 * sets an amplitude. */
PLM_API plm_status plm_basis_build(plm_basis *basis);
/* Columns [first, first + n) of P, or of P_0 if is_static: vector is n_dof x n with leading dimension ld >= n_dof. */
PLM_API plm_status plm_basis_get_vectors(plm_basis *basis, int32_t is_static, int64_t first, int64_t n, double *vector,
                                         int64_t ld);
/* r = |q - P eta| / |q| with eta by least squares (paper, eq. (12), (13)); use_mass: norm of M instead of the L2 norm
 * over free DOFs; is_static: P_0 instead of P. q: n_dof. */
PLM_API plm_status plm_basis_get_residual(plm_basis *basis, int32_t is_static, int32_t use_mass, int64_t n,
                                          const double *q, double *r);
/* The built basis as bytes, to be kept by the host and read by plm_basis_read() in this process or another, on any
 * machine, by this version of the library or a later one (docs/format.md). They hold the reduced equations and P, about
 * 8 n_dof (columns of P and P_0) bytes, not the matrices of the structure; P is formed for it. needed: their number, with
 * bytes = NULL and capacity = 0 all that is asked for; PLM_ERR_ARGUMENT where capacity is smaller. */
PLM_API plm_status plm_basis_write(plm_basis *basis, int64_t capacity, void *bytes, int64_t *needed);
/* The same bytes to a function of the host, for files, sockets and databases of its own: in pieces of 1 to 65,536 bytes, so
 * that no second copy of the basis is in memory. */
PLM_API plm_status plm_basis_write_to(plm_basis *basis, plm_write_fn fn, void *user);
/* The basis in n bytes, built: it sweeps, solves, finds peaks and other branches at once, with the numbers of the one it
 * was written from to the last digit, amplitudes of all DOFs included. What asks the structure itself (full residual,
 * error estimates of harmonic balance, refinement) answers PLM_ERR_STATE until plm_basis_attach(); a curve that would
 * have been compared with it is PLM_WARNING with PLM_REASON_UNVERIFIED. PLM_ERR_ARGUMENT for bytes that were cut,
 * damaged, of something else or of a later format version; nothing in them is believed unchecked. */
PLM_API plm_status plm_basis_read(plm_context *ctx, int64_t n, const void *bytes, plm_basis **basis);
/* Gives a basis that was read the model that it was made of, built, with its loads and damping as they were: all that
 * the structure is asked for works again. PLM_ERR_ARGUMENT for another model, told by a fingerprint of matrices, supports,
 * constraints and contact. Branches computed before stay without it: write them and read them again. */
PLM_API plm_status plm_basis_attach(plm_basis *basis, plm_model *model);

/* ---- HBM: the periodic response (paper, 2.2, eq. (10)) -------------------------------------------------------- */

PLM_API plm_status plm_hbm_create(plm_basis *basis, plm_hbm **hbm);
PLM_API plm_status plm_hbm_destroy(plm_hbm **hbm);
PLM_API plm_status plm_hbm_set_int(plm_hbm *hbm, const char *key, int64_t value);
PLM_API plm_status plm_hbm_set_double(plm_hbm *hbm, const char *key, double value);
PLM_API plm_status plm_hbm_set_string(plm_hbm *hbm, const char *key, const char *value);
PLM_API plm_status plm_hbm_get_int(plm_hbm *hbm, const char *key, int64_t *value);
PLM_API plm_status plm_hbm_get_double(plm_hbm *hbm, const char *key, double *value);
PLM_API plm_status plm_hbm_get_string(plm_hbm *hbm, const char *key, int64_t capacity, char *buffer,
                                      int64_t *needed);
/* Follows the response curve over [frequency_min_hz, frequency_max_hz] through its folds. PLM_NOT_CONVERGED,
 * PLM_TRUNCATED or PLM_CANCELLED still deliver the branch found so far, if it has a point. Where an end of the range is
 * a sampler's estimate and the response (its norm over the structure) is largest there, the curve goes on past it, to
 * one and a half times the window at most; PLM_WARNING with PLM_REASON_NO_PEAK when no peak comes inside. An end that
 * the host gave (frequency_min_hz, frequency_max_hz here or of the basis, window_min_hz, window_max_hz of the sampler)
 * stays. PLM_WARNING with PLM_REASON_OUTSIDE_BASIS when the largest response outside the basis' window misses the
 * equations of the whole structure by more than 1 % (plm_branch_get_full_residual); with PLM_REASON_BASIS_TOO_SMALL when
 * the largest inside it does, unless the error that the basis makes there can be estimated at little cost and is below
 * 1 %, and when so many pairs open and close that the curve was followed on a part of the basis' coordinates and more of
 * them change its highest motion by more than "accuracy"; with PLM_REASON_UNVERIFIED when, on such a curve, stability is
 * not as more coordinates have it; with PLM_REASON_NO_SWITCHING when no pair would open or close
 * under a hundred times the motion; with PLM_REASON_TURNED_BACK when a fold led back to the end where the curve began,
 * with PLM_REASON_LOOP_CLOSED when it began on a closed curve and came back to its first point. What comes back so, ends
 * early or finds no first motion is followed from the other end of the range ("direction"), and delivered from there if
 * it leads across. A
 * curve that goes round a closed one beside it, onto which a step had crossed, is followed anew with shorter steps,
 * twice; then PLM_NOT_CONVERGED with PLM_REASON_CROSSED_OVER. A structure in free flight, or free along a rail: mean
 * position zero; PLM_ERR_CONVERGENCE when the mean of the loads would carry it away. */
PLM_API plm_status plm_hbm_sweep(plm_hbm *hbm, plm_branch **branch);
/* From now on plm_hbm_sweep and plm_hbm_resume write the curve to the file `path` after every n_points more points and at
 * their end, as plm_branch_write gives it, so that a process that is killed leaves a branch to resume. The file is
 * replaced as a whole: it is written under another name beside, brought to the disk and renamed. n_points 0: no longer
 * (path may be NULL). PLM_ERR_ARGUMENT where no such file can be written. Where that fails later, as on a disk that is
 * full, the curve goes on, with PLM_WARNING and PLM_REASON_NOT_SAVED. */
PLM_API plm_status plm_hbm_save_every(plm_hbm *hbm, int64_t n_points, const char *path);
/* Goes on with a curve of plm_hbm_sweep or of this function that was cancelled, ended by "max_points" or for want of effort,
 * or was saved on its way (plm_hbm_save_every), in this process or from its bytes: resumed is the curve that the sweep
 * would have delivered, with the same points to the last bit where the library, its BLAS and the machine are the same.
 * branch stays as it is. hbm: with the options of the sweep; "max_points" alone may differ, and effort (plm_context_set_effort)
 * counts as if the sweep had never stopped: one that spent it needs more. What came before the curve (first solutions, the
 * model that a curve of many pairs is followed on) is made again, of the curve the ten steps or less since all had begun
 * anew. PLM_ERR_ARGUMENT for a curve that came to its end, of another function, or swept with other options, which are
 * named. Outcomes: as of plm_hbm_sweep. */
PLM_API plm_status plm_hbm_resume(plm_hbm *hbm, plm_branch *branch, plm_branch **resumed);
/* The same at several levels of the excitation, force_scale[n] in place of the option "force_scale", in any order. count:
 * curves found, read by plm_hbm_get_found in the order of their levels; each says its "force_scale", its warnings and how it
 * ended, and may cost what plm_context_set_effort allows a sweep. The largest level is followed first, each of the others
 * along the one before it, checked as in a sweep of it alone: where that shows the way its steps are up to three times as
 * long as "max_step", so that it has fewer points, and where many pairs open and close it goes on from the coordinates that
 * the motions before it needed. Less work than as many sweeps. PLM_NOT_CONVERGED or PLM_TRUNCATED, with the level in the
 * words, where a curve ended early or a level (without a curve then) has no first motion; PLM_CANCELLED with those found
 * before. */
PLM_API plm_status plm_hbm_sweep_levels(plm_hbm *hbm, int64_t n, const double *force_scale, int64_t *count);
/* Response at one frequency. start: branch whose point `point` is the first guess (same basis), or NULL for a cold
 * start. PLM_ERR_CONVERGENCE when no strategy converges; PLM_WARNING with PLM_REASON_OUTSIDE_BASIS as for a sweep. */
PLM_API plm_status plm_hbm_solve(plm_hbm *hbm, double frequency_hz, plm_branch *start, int64_t point,
                                 plm_branch **branch);
/* The curve's highest amplitude of a DOF (see plm_branch_get_amplitude), located on the exact curve by corrected steps
 * around the highest point of `branch` (which this hbm's basis computed), with twice its harmonics where they are chosen
 * automatically and the next ones would show. peak: that point as a branch, or NULL. PLM_WARNING with
 * PLM_REASON_NO_PEAK when the highest point stands at an end of the curve (also of one that was cut off): frequency and
 * amplitude are those of that point, and the peak lies elsewhere; with PLM_REASON_BASIS_TOO_SMALL when the error that the
 * basis makes is estimated to be above "accuracy", or, where an estimate would cost more than some points of the curve,
 * as for a sweep; with PLM_REASON_NO_CONTRACTION when the steps of that estimate do not contract; with
 * PLM_REASON_UNVERIFIED when no solution was found around the highest point of `branch`, which is then the result, and
 * the peak may be higher by more than "accuracy"; with PLM_REASON_UNSTABLE_PEAK when the motion of the peak is known to
 * be unstable ("stable" of the branch) and no stable motion of the curve is as high within "accuracy". A closed curve
 * has no ends. */
PLM_API plm_status plm_hbm_find_peak(plm_hbm *hbm, plm_branch *branch, int64_t dof, int32_t measure, int32_t harmonic,
                                     double *frequency_hz, double *amplitude, plm_branch **peak);

/* The curve that crosses `branch` at a located branch point, or leaves it at a period doubling (with twice the period:
 * "period_multiple" of *other). point: its position on the branch, see "bifurcation". mirrored: 0 or 1, the side on
 * which it is left. PLM_ERR_CONVERGENCE when no other curve is found there. */
PLM_API plm_status plm_hbm_switch_branch(plm_hbm *hbm, plm_branch *branch, int64_t point, int32_t mirrored,
                                         plm_branch **other);
/* Isolated branches at "force_scale" beside the curve `main_branch` (of plm_hbm_sweep with the same options over the
 * whole range), without a hint: where the phase-resonant backbone (displacement in quadrature to the force) needs a
 * force that falls with growing amplitude, a closed branch exists; it is entered there and traced. force_max: largest
 * force scale looked at, 0: eight times "force_scale". count: branches found, read by plm_hbm_get_found. Where curves are
 * made of exact motions ("motion"), the backbone of this search has few harmonics, branches and the forces between which
 * they exist are exact, and what exists only with few harmonics is left out. Where plm_hbm_find_peak found the peak of
 * main_branch before, the one with the largest stable motion above it comes first: "larger_amplitude" and
 * "larger_frequency_hz" of hbm are that motion. */
PLM_API plm_status plm_hbm_find_isolated(plm_hbm *hbm, plm_branch *main_branch, double force_max, int64_t *count);
/* The phase-resonant backbones in the frequency range: frequency and amplitude of the resonance against the force. The
 * points of each carry their own "point_force_scale". Exact where curves are made of exact motions ("motion"), with their
 * stability at that force and frequency; else of as many harmonics as the hbm has, few where it is to choose them. None
 * without pre-load and gap (the force changes nothing then). */
PLM_API plm_status plm_hbm_find_backbones(plm_hbm *hbm, double force_max, int64_t *count);
/* What the last plm_hbm_find_... or plm_hbm_sweep_levels of this hbm found ("n_found"), or what lies beside the curve of the
 * plm_model_compute_response that made it. force_range[2] or NULL: force scales between which an isolated
 * branch exists, NaN where unknown or meaningless. */
PLM_API plm_status plm_hbm_get_found(plm_hbm *hbm, int64_t index, double *force_range, plm_branch **branch);
/* The curve of folds over (frequency, force) through a located fold of `branch`, to both sides of it as far as the range
 * of force scales given goes; the side that begins towards smaller forces comes first. Its points of "bifurcation"
 * PLM_BIFURCATION_FOLD are extrema of the force: an isolated branch is born or merges there. Folds of exact motions where
 * the point is one, else of as many harmonics as it has. */
PLM_API plm_status plm_hbm_track_fold(plm_hbm *hbm, plm_branch *branch, int64_t point, double force_min,
                                      double force_max, plm_branch **folds);

/* Independent of any continuation: motions are marched from rest and from n_states states (1, 2, 4, ... times the
 * largest response on the n_known curves) at n_frequencies frequencies of the range until they are periodic; those that
 * lie on none of the known curves are traced. count: branches found, read by plm_hbm_get_found. */
PLM_API plm_status plm_hbm_find_by_marching(plm_hbm *hbm, int64_t n_known, plm_branch *const *known,
                                            int64_t n_frequencies, int64_t n_states, int64_t *count);
/* How wrong a point of `branch` is. An exact motion is compared with that of the unreduced structure beside it, across the
 * curve, which is found from the point's own state, nothing cut off. Where that would take more than some seconds, and for
 * harmonic balance, the contact forces are applied to the unreduced structure, and one step with the tangent of the latter,
 * across the curve, tells what the defect does. amplitude[3] (of a DOF, as in plm_branch_get_amplitude) and frequency_hz[3]
 * (shift of the curve), corrected less computed, by cause: basis, contact sets, harmonics beyond those solved for; the sum
 * is the estimate. It measures errors that are small against the width of the resonance. Where the tangent does not hold as
 * far as its step leads it is renewed; a part whose steps do not contract even then is NaN, with PLM_WARNING
 * (PLM_REASON_NO_CONTRACTION): the error may be large. Away from a peak, amplitude and frequency belong together: one shift
 * across the curve. Each output may be NULL. PLM_ERR_STATE when the model has no contact pairs. The first call of an hbm
 * prepares the unreduced structure. */
PLM_API plm_status plm_hbm_estimate_error(plm_hbm *hbm, plm_branch *branch, int64_t point, int64_t dof, int32_t measure,
                                          int32_t harmonic, double *amplitude, double *frequency_hz);
/* A basis for one number, the tolerance. From the basis of this hbm, however poor, and its curve: the motions, corrected
 * as by plm_hbm_estimate_error, are compressed (kind "pod") to the basis of the next curve, until the estimated error of
 * the reduction on it (of the DOF's amplitude over the curve's highest, of the frequency over itself) is below tolerance.
 * refined: that basis, built, to be used with a new hbm and destroyed by the caller; error or NULL: what is left, infinite
 * where the estimate does not converge. PLM_NOT_CONVERGED: not met in eight curves, or no estimate on three in a row;
 * refined is the best one. */
PLM_API plm_status plm_hbm_refine_basis(plm_hbm *hbm, int64_t dof, int32_t measure, int32_t harmonic, double tolerance,
                                        plm_basis **refined, double *error);
/* Nonlinear mode (motion without excitation, extended periodic motion concept): from elastic mode `mode` (1, 2, ...) of
 * the structure about its contact at rest until the first harmonic of `dof` reaches `amplitude_max`; 0: to a hundred
 * times the amplitude at which a pair first opens or closes. Energy and contact area: plm_branch_get_energy; result
 * "damping_ratio": xi of the force 2 xi omega M q' that makes up for what the damping takes, at a small amplitude the
 * linear mode's share of critical damping. */
PLM_API plm_status plm_hbm_find_nonlinear_mode(plm_hbm *hbm, int64_t mode, int64_t dof, double amplitude_max,
                                               plm_branch **branch);

/* ---- Branch: points of a response curve, read-only ------------------------------------------------------------- */

/* measures of amplitude over the period */
#define PLM_PEAK 1              /* max |q(t)| */
#define PLM_HALF_PEAK_TO_PEAK 2 /* (max q - min q) / 2 */
#define PLM_RMS 3               /* root mean square, static part included */
#define PLM_HARMONIC 4          /* magnitude of one harmonic (0: the mean, with its sign) */

PLM_API plm_status plm_branch_destroy(plm_branch **branch);
PLM_API plm_status plm_branch_get_int(plm_branch *branch, const char *key, int64_t *value);
PLM_API plm_status plm_branch_get_double(plm_branch *branch, const char *key, double *value);
PLM_API plm_status plm_branch_get_string(plm_branch *branch, const char *key, int64_t capacity, char *buffer,
                                         int64_t *needed);
PLM_API plm_status plm_branch_get_array(plm_branch *branch, const char *key, int64_t capacity, double *values,
                                        int64_t *count);
PLM_API plm_status plm_branch_get_int_array(plm_branch *branch, const char *key, int64_t capacity, int64_t *values,
                                            int64_t *count);
/* Amplitude of a DOF at every point: n_points values. harmonic is used by PLM_HARMONIC only. Exact extrema of the
 * motion: of an exact one piece by piece, else of the trigonometric polynomial; not of samples. */
PLM_API plm_status plm_branch_get_amplitude(plm_branch *branch, int64_t dof, int32_t measure, int32_t harmonic,
                                            int64_t capacity, double *amplitude, int64_t *count);
/* Fourier coefficients a0, a1, b1, ..., aH, bH (q = a0 + sum a_h cos h omega t + b_h sin h omega t) of DOFs
 * [first_dof, first_dof + n): coefficient is (2H + 1) x n. */
PLM_API plm_status plm_branch_get_coefficients(plm_branch *branch, int64_t point, int64_t first_dof, int64_t n,
                                               double *coefficient);
/* Motion of a DOF at n_times equidistant times from 0 over the period of the response: q[n_times], n_times up to
 * 1048576. Of an exact motion itself, not of its harmonics. */
PLM_API plm_status plm_branch_get_history(plm_branch *branch, int64_t point, int64_t dof, int64_t n_times, double *q);
/* All DOFs at time t = time_fraction * period: q[n_dof] (recovery q = P eta, paper, eq. (11)). */
PLM_API plm_status plm_branch_get_field(plm_branch *branch, int64_t point, double time_fraction, int64_t n, double *q);
/* Contact over the cycle at n_times equidistant times from 0: penetration, force, closed are n_pairs x n_times,
 * each may be NULL. */
PLM_API plm_status plm_branch_get_contact(plm_branch *branch, int64_t point, int64_t n_times, double *penetration,
                                          double *force, int32_t *closed);
/* Share of the period during which each pair is closed, from its exact switching instants: share[n_pairs]. */
PLM_API plm_status plm_branch_get_closed_share(plm_branch *branch, int64_t point, int64_t n, double *share);
/* Mean mechanical energy over the period (kinetic, elastic, contact, potential of the pre-load), less that of the
 * structure at rest, and the mean closed share of the pairs in [0, 1]. Each output may be NULL. */
PLM_API plm_status plm_branch_get_energy(plm_branch *branch, int64_t point, double *energy, double *contact_area);
/* Floquet multipliers of a point over one period of the response, largest modulus first; count 0 where they were not
 * computed (option "stability") or no exact motion was found beside the point. real, imag: each `capacity` values, or
 * NULL with capacity 0. */
PLM_API plm_status plm_branch_get_multipliers(plm_branch *branch, int64_t point, int64_t capacity, double *real,
                                              double *imag, int64_t *count);
/* |state after a period - state| over the size of the motion, by the exact flow of the reduced model from the point's
 * own state: how nearly the point is a periodic motion in time. */
PLM_API plm_status plm_branch_get_periodicity_defect(plm_branch *branch, int64_t point, double *defect);
/* How well the recovered field satisfies the full (unreduced) harmonic-balance equations: the residual in the norm of
 * the inverse stiffness over the energy norm of the field. One solve per harmonic with the full matrices. */
PLM_API plm_status plm_branch_get_full_residual(plm_branch *branch, int64_t point, double *relative_residual);
/* The branch as bytes, as plm_basis_write() gives those of a basis: its points with all their digits, what they need to be
 * asked for amplitudes, fields and contact, how it ended, and what plm_hbm_resume goes on from where it did not come to its
 * end. Not the basis that it was computed on. */
PLM_API plm_status plm_branch_write(plm_branch *branch, int64_t capacity, void *bytes, int64_t *needed);
/* The same bytes to a function of the host, as by plm_basis_write_to(). */
PLM_API plm_status plm_branch_write_to(plm_branch *branch, plm_write_fn fn, void *user);
/* The branch in n bytes, on the basis that it was computed on or on one read from the bytes of that: it is what it was to
 * every function that takes a branch. Points are the same to the last digit; extrema of exact motions, which are found
 * anew, to rounding. PLM_ERR_ARGUMENT for bytes that are damaged, and for another basis, told by a fingerprint. */
PLM_API plm_status plm_branch_read(plm_basis *basis, int64_t n, const void *bytes, plm_branch **branch);
/* The branch as comma-separated text: a header of keys, then a line a point with 17 digits and a decimal point whatever
 * the locale: frequency_hz, amplitude (of this DOF, as plm_branch_get_amplitude), arclength, force_scale, stable,
 * bifurcation, residual, iterations, n_harmonics, harmonic_error, n_switching. The file is replaced as a whole: it is
 * written under another name beside, brought to the disk and renamed. PLM_ERR_ARGUMENT where that cannot be. */
PLM_API plm_status plm_branch_write_csv(plm_branch *branch, int64_t dof, int32_t measure, int32_t harmonic,
                                        const char *path);
/* The same text to a function of the host, as by plm_basis_write_to(). */
PLM_API plm_status plm_branch_write_csv_to(plm_branch *branch, int64_t dof, int32_t measure, int32_t harmonic,
                                           plm_write_fn fn, void *user);
/* A page of text about the curve, to be printed or kept with the results: model and what was left out, basis, curve with
 * its folds and bifurcations, peak, stability, other motions at this force, error and by what it was judged, warnings with
 * their remedies, times. Peak, error and larger motions are those that earlier calls found of this curve:
 * plm_model_compute_response(), else plm_hbm_find_peak(), and plm_hbm_estimate_error() at that peak and
 * plm_hbm_find_isolated() after it; of what no call has looked for it says so. Lines end with a newline and have about a hundred characters at most; DOFs count from 0. */
PLM_API plm_status plm_branch_describe(plm_branch *branch, int64_t capacity, char *buffer, int64_t *needed);

/* ---- Transient: motion in time ----------------------------------------------------------------------------------
 * Of a reduced model by its exact piecewise-linear flow (nothing is discretised), or of the full model by Newmark's
 * method with the numerical damping of Hilber, Hughes and Taylor ("hht_alpha"), contact included. Options:
 * "frequency_hz" and "force_scale" of the excitation, "periods" of a run, ... */

/* basis: the reduced model, or NULL for the full one. The first state is at rest under the pre-load. */
PLM_API plm_status plm_transient_create(plm_model *model, plm_basis *basis, plm_transient **transient);
PLM_API plm_status plm_transient_destroy(plm_transient **transient);
PLM_API plm_status plm_transient_set_int(plm_transient *transient, const char *key, int64_t value);
PLM_API plm_status plm_transient_set_double(plm_transient *transient, const char *key, double value);
PLM_API plm_status plm_transient_set_string(plm_transient *transient, const char *key, const char *value);
PLM_API plm_status plm_transient_get_int(plm_transient *transient, const char *key, int64_t *value);
PLM_API plm_status plm_transient_get_double(plm_transient *transient, const char *key, double *value);
PLM_API plm_status plm_transient_get_string(plm_transient *transient, const char *key, int64_t capacity, char *buffer,
                                            int64_t *needed);
PLM_API plm_status plm_transient_get_array(plm_transient *transient, const char *key, int64_t capacity, double *values,
                                           int64_t *count);
PLM_API plm_status plm_transient_get_int_array(plm_transient *transient, const char *key, int64_t capacity,
                                               int64_t *values, int64_t *count);
/* DOFs whose motion the next runs record; replaces an earlier list, n = 0 records none. */
PLM_API plm_status plm_transient_observe_i32(plm_transient *transient, int32_t index_base, int64_t n,
                                             const int32_t *dof);
PLM_API plm_status plm_transient_observe_i64(plm_transient *transient, int32_t index_base, int64_t n,
                                             const int64_t *dof);
/* Displacement and velocity of all DOFs, q[n_dof] and v[n_dof] or NULL (zero), at the beginning of a period. A reduced
 * model takes their projection in the norm of M. */
PLM_API plm_status plm_transient_set_state(plm_transient *transient, int64_t n, const double *q, const double *v);
/* State, "frequency_hz" and "force_scale" of a point of a response curve (of any basis of the same model for a full
 * model, of this basis for a reduced one). */
PLM_API plm_status plm_transient_start_at(plm_transient *transient, plm_branch *branch, int64_t point);
/* Marches "periods" periods of the excitation from the present state, less when "settled" stops it earlier; a next run
 * goes on where this one ended. PLM_CANCELLED keeps what was marched. */
PLM_API plm_status plm_transient_run(plm_transient *transient);
/* The periodic motion nearest the present state, by Newton's method on the exact flow over "period_multiple" periods
 * (reduced models only). PLM_NOT_CONVERGED: the state is the best one found, see "periodicity_defect". */
PLM_API plm_status plm_transient_find_periodic(plm_transient *transient);
/* The present state: q and v are n = n_dof long, each may be NULL. */
PLM_API plm_status plm_transient_get_state(plm_transient *transient, int64_t n, double *q, double *v);
/* Displacement of the observed DOF number `observed` (from 0, in the order of plm_transient_observe) at the instants
 * "time" of the last run. */
PLM_API plm_status plm_transient_get_history(plm_transient *transient, int64_t observed, int64_t capacity,
                                             double *values, int64_t *count);
/* Floquet multipliers of the motion plm_transient_find_periodic found, as plm_branch_get_multipliers. */
PLM_API plm_status plm_transient_get_multipliers(plm_transient *transient, int64_t capacity, double *real, double *imag,
                                                 int64_t *count);

/* ---- Study: error against run time -------------------------------------------------------------------------------
 * Methods, each a way to the same response curve, are run and timed beside a reference and compared with it. A method
 * holds copies of options, taken when it is added: later changes of the handles do nothing to it. Everything is made
 * anew from these options, the model and, with "share_space", its contact space excepted: sampler, basis, curve. Results
 * by key are arrays with one entry per method, in the order they were added; NaN (or -1) stands where a method failed or a
 * figure has no meaning. */

/* model must be built before plm_study_run. PLM_ERR_NOT_BUILT in a build without PLM_WITH_STUDY. */
PLM_API plm_status plm_study_create(plm_model *model, plm_study **study);
PLM_API plm_status plm_study_destroy(plm_study **study);
PLM_API plm_status plm_study_set_int(plm_study *study, const char *key, int64_t value);
PLM_API plm_status plm_study_set_double(plm_study *study, const char *key, double value);
PLM_API plm_status plm_study_set_string(plm_study *study, const char *key, const char *value);
PLM_API plm_status plm_study_get_int(plm_study *study, const char *key, int64_t *value);
PLM_API plm_status plm_study_get_double(plm_study *study, const char *key, double *value);
PLM_API plm_status plm_study_get_string(plm_study *study, const char *key, int64_t capacity, char *buffer,
                                        int64_t *needed);
PLM_API plm_status plm_study_get_array(plm_study *study, const char *key, int64_t capacity, double *values,
                                       int64_t *count);
PLM_API plm_status plm_study_get_int_array(plm_study *study, const char *key, int64_t capacity, int64_t *values,
                                           int64_t *count);
/* The amplitude looked at, as in plm_branch_get_amplitude: dof from 0. Must be set. */
PLM_API plm_status plm_study_set_output(plm_study *study, int64_t dof, int32_t measure, int32_t harmonic);
/* n >= 1 factors, > 0, on the "force_scale" of every method; 1 unless set. Each method runs all of them: errors are the
 * worst, times the sum. */
PLM_API plm_status plm_study_set_force_levels(plm_study *study, int64_t n, const double *scale);
/* What all methods are compared with: the recipe of plm_study_add_response, read from this hbm. NULL: the default, which
 * is the unreduced structure (basis of kind "full") with the other options of the first method that does not march. Its
 * frequency range is the range of every method whose hbm leaves its own at 0. */
PLM_API plm_status plm_study_set_reference(plm_study *study, plm_hbm *hbm);
/* A method: the curve of hbm, its basis and its basis' sampler, by the options these three hold now (and those of the
 * basis' parent, for kind "plm"). The basis need not be built, the sampler need not have run. Not for kind "pod". A
 * sampler that only gives the window to a basis of another kind is no part of the set-up time. name: not empty, used once,
 * not "reference". index: of the method, from 0, or NULL; the same below. */
PLM_API plm_status plm_study_add_response(plm_study *study, const char *name, plm_hbm *hbm, int64_t *index);
/* The response of that recipe at the lowest and the highest force level (at the highest alone where neither a pre-load nor
 * an initial gap keeps it from being proportional to the force), then a basis of kind "pod" from it, of `size` columns
 * (0: by "pod_tolerance" of the basis), and its curve. All before that curve is set-up. */
PLM_API plm_status plm_study_add_compressed(plm_study *study, const char *name, plm_hbm *hbm, int64_t size,
                                            int64_t *index);
/* plm_hbm_refine_basis from that recipe, for the study's output at the highest force level; tolerance in (0, 1). */
PLM_API plm_status plm_study_add_refined(plm_study *study, const char *name, plm_hbm *hbm, double tolerance,
                                         int64_t *index);
/* Steady states by marching in time, by the options of `transient` and of its basis, at n_frequencies spread over the
 * range with its ends, downwards, each from the one before; the first from rest. Give it "settled". Its peak is the
 * highest of its points, and its error of the curve that of its points. PLM_ERR_NOT_BUILT without PLM_WITH_TRANSIENT. */
PLM_API plm_status plm_study_add_marching(plm_study *study, const char *name, plm_transient *transient,
                                          int64_t n_frequencies, int64_t *index);
/* Each method once to warm up, then "repeats" times for the times (medians). PLM_WARNING: a method failed or ended early,
 * see plm_study_get_outcome. PLM_CANCELLED: the methods run until then are there, if the reference was complete; otherwise
 * the study is as it was. A reference that cannot be computed is a failure. */
PLM_API plm_status plm_study_run(plm_study *study);
/* index: of a method, or -1 for the reference, the same below. */
PLM_API plm_status plm_study_get_name(plm_study *study, int64_t index, int64_t capacity, char *buffer, int64_t *needed);
/* How the method ended in the last run, or why it failed. */
PLM_API plm_status plm_study_get_outcome(plm_study *study, int64_t index, int64_t capacity, char *buffer,
                                         int64_t *needed);
/* The curve of a method at a force level (from 0) in the last run. Its basis is the study's own. PLM_ERR_STATE for a
 * method that failed or that marches in time: that has points only. */
PLM_API plm_status plm_study_get_curve(plm_study *study, int64_t index, int64_t level, plm_branch **branch);
/* The same as points of frequency and amplitude of the output: `capacity` values each, or both NULL with capacity 0.
 * Those of a curve are so many as "curve_tolerance" asks for (chords between them are good for pictures, about 1e-3);
 * those of a marching method are its steady states. */
PLM_API plm_status plm_study_get_points(plm_study *study, int64_t index, int64_t level, int64_t capacity,
                                        double *frequency_hz, double *amplitude, int64_t *count);
/* Writes the last run to files of the folder, which is made if its parent exists: report.md, table.csv, and for each
 * method and level curve_<index>_<name>_<level>.csv (curve_reference_<level>.csv). Files of these names are overwritten,
 * others left alone. PLM_ERR_ARGUMENT when a file cannot be written; some may have been by then. */
PLM_API plm_status plm_study_write(plm_study *study, const char *folder);

#ifdef __cplusplus
}
#endif
#endif /* PLM_PLM_H */
