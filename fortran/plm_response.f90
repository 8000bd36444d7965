! plm_response.f90: harmonic balance, which follows response curves. DOFs and points count from 1.
module plm_responses
    use, intrinsic :: iso_c_binding, only: c_ptr, c_null_ptr, c_null_char, c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_constants
    use plm_c
    use plm_errors, only: finish
    use plm_methods, only: plm_hbm_methods
    use plm_branches, only: plm_branch, measure_of, harmonic_of, get_handles
    use plm_models, only: plm_model
    use plm_reductions, only: plm_basis
    implicit none
    private
    public :: plm_hbm, plm_compute_response

    type, extends(plm_hbm_methods) :: plm_hbm
    contains
        procedure :: create
        procedure :: destroy
        procedure :: sweep
        procedure :: save_every
        procedure :: resume
        procedure :: sweep_levels
        procedure :: solve
        procedure :: find_peak
        procedure :: estimate_error
        procedure :: refine_basis
        procedure :: switch_branch
        procedure :: find_isolated
        procedure :: find_backbones
        procedure :: find_by_marching
        procedure :: found
        procedure :: track_fold
        procedure :: find_nonlinear_mode
    end type plm_hbm

contains

    ! The whole way in one call, for a built model with an excitation: curve around the resonance that the excitation drives
    ! most, and its peak. measure: PLM_HALF_PEAK_TO_PEAK (if absent), PLM_PEAK, PLM_RMS; accuracy: relative error that the
    ! peak may have (if absent 1d-3); error: its estimate, NaN where there is none; hbm: what computed it.
    subroutine plm_compute_response(model, dof, frequency_hz, amplitude, curve, accuracy, measure, error, hbm, stat, errmsg)
        type(plm_model), intent(in) :: model
        integer, intent(in) :: dof
        real(real64), intent(inout) :: frequency_hz, amplitude
        type(plm_branch), intent(inout), optional :: curve
        real(real64), intent(in), optional :: accuracy
        integer(plm_status), intent(in), optional :: measure
        real(real64), intent(inout), optional :: error
        type(plm_hbm), intent(inout), optional :: hbm
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        type(c_ptr) :: made_curve, made_hbm
        real(real64) :: allowed, left
        integer(plm_status) :: status, gone
        made_curve = c_null_ptr
        made_hbm = c_null_ptr
        allowed = 1d-3
        if (present(accuracy)) allowed = accuracy
        left = 0
        status = plm_model_compute_response(model%handle, int(dof, int64) - 1, measure_of(measure), allowed, &
            frequency_hz, amplitude, left, made_curve, made_hbm)
        if (status >= 0) then
            if (present(error)) error = left
            if (present(curve)) then
                curve%context = model%context
                curve%kind = PLM_KIND_BRANCH
                curve%handle = made_curve
            else
                gone = plm_branch_destroy(made_curve)
            end if
            if (present(hbm)) then
                hbm%context = model%context
                hbm%kind = PLM_KIND_HBM
                hbm%handle = made_hbm
            else
                gone = plm_hbm_destroy(made_hbm)
            end if
        end if
        call finish(model%context, status, stat, errmsg)
    end subroutine plm_compute_response

    subroutine create(self, basis, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        type(plm_basis), intent(in) :: basis
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        self%context = basis%context
        self%kind = PLM_KIND_HBM
        call finish(self%context, plm_hbm_create(basis%handle, self%handle), stat, errmsg)
    end subroutine create

    subroutine destroy(self, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_hbm_destroy(self%handle), stat, errmsg)
    end subroutine destroy

    ! stat PLM_NOT_CONVERGED, PLM_TRUNCATED or PLM_CANCELLED: the branch holds what was found until then; it is left
    ! alone when that is not even one point. A branch that this one replaces lives on until its context goes: destroy
    ! it before.
    subroutine sweep(self, branch, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        type(plm_branch), intent(inout) :: branch
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call prepare(self, branch)
        call finish(self%context, plm_hbm_sweep(self%handle, branch%handle), stat, errmsg)
    end subroutine sweep

    ! From now on sweep and resume write the curve to the file `path` after every n_points more points and at their end; 0: no
    ! longer (path: any).
    subroutine save_every(self, n_points, path, stat, errmsg)
        class(plm_hbm), intent(in) :: self
        integer, intent(in) :: n_points
        character(len=*), intent(in) :: path
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_hbm_save_every(self%handle, int(n_points, int64), trim(path)//c_null_char), stat, errmsg)
    end subroutine save_every

    ! Goes on with a curve that was cancelled, ended by "max_points" or for want of effort, or was saved on its way.
    subroutine resume(self, branch, resumed, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        type(plm_branch), intent(in) :: branch
        type(plm_branch), intent(inout) :: resumed
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call prepare(self, resumed)
        call finish(self%context, plm_hbm_resume(self%handle, branch%handle, resumed%handle), stat, errmsg)
    end subroutine resume

    ! One frequency; start, point: a branch whose point (1 if absent) is the first guess.
    subroutine solve(self, frequency_hz, branch, start, point, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        real(real64), intent(in) :: frequency_hz
        type(plm_branch), intent(inout) :: branch
        type(plm_branch), intent(in), optional :: start
        integer, intent(in), optional :: point
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        type(c_ptr) :: guess
        integer(int64) :: at
        guess = c_null_ptr
        if (present(start)) guess = start%handle
        at = 0
        if (present(point)) at = int(point, int64) - 1
        call prepare(self, branch)
        call finish(self%context, plm_hbm_solve(self%handle, frequency_hz, guess, at, branch%handle), stat, errmsg)
    end subroutine solve

    ! The highest amplitude of a DOF on the exact curve. measure: PLM_HALF_PEAK_TO_PEAK (if absent), PLM_PEAK, PLM_RMS,
    ! PLM_HARMONIC (of `harmonic`, 1 if absent); peak: that point as a branch.
    subroutine find_peak(self, branch, dof, frequency_hz, amplitude, measure, harmonic, peak, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        type(plm_branch), intent(in) :: branch
        integer, intent(in) :: dof
        real(real64), intent(inout) :: frequency_hz, amplitude
        integer(plm_status), intent(in), optional :: measure
        integer, intent(in), optional :: harmonic
        type(plm_branch), intent(inout), optional :: peak
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        if (present(peak)) then
            call prepare(self, peak)
            status = plm_hbm_find_peak(self%handle, branch%handle, int(dof, int64) - 1, measure_of(measure), &
                harmonic_of(harmonic), frequency_hz, amplitude, peak%handle)
        else
            status = plm_hbm_find_peak(self%handle, branch%handle, int(dof, int64) - 1, measure_of(measure), &
                harmonic_of(harmonic), frequency_hz, amplitude)
        end if
        call finish(self%context, status, stat, errmsg)
    end subroutine find_peak

    ! How wrong a point of `branch` is, without the unreduced solution: corrected less computed amplitude of the DOF and
    ! frequency, by cause: basis, contact sets, harmonics; their sum is the estimate. measure and harmonic as in find_peak.
    subroutine estimate_error(self, branch, point, dof, amplitude, frequency_hz, measure, harmonic, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        type(plm_branch), intent(in) :: branch
        integer, intent(in) :: point, dof
        real(real64), intent(inout), optional :: amplitude(3), frequency_hz(3)
        integer(plm_status), intent(in), optional :: measure
        integer, intent(in), optional :: harmonic
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_hbm_estimate_error(self%handle, branch%handle, int(point, int64) - 1, &
            int(dof, int64) - 1, measure_of(measure), harmonic_of(harmonic), amplitude, frequency_hz), stat, errmsg)
    end subroutine estimate_error

    ! A small basis, of kind 'pod', on which the curve's error of reduction is estimated to be below `tolerance`, whatever
    ! the basis of this hbm. measure and harmonic as in find_peak; error: what is left. The status PLM_NOT_CONVERGED
    ! delivers the best basis found.
    subroutine refine_basis(self, dof, tolerance, refined, error, measure, harmonic, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        integer, intent(in) :: dof
        real(real64), intent(in) :: tolerance
        type(plm_basis), intent(inout) :: refined
        real(real64), intent(inout), optional :: error
        integer(plm_status), intent(in), optional :: measure
        integer, intent(in), optional :: harmonic
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64) :: left
        integer(plm_status) :: status
        refined%context = self%context
        refined%kind = PLM_KIND_BASIS
        left = 0
        status = plm_hbm_refine_basis(self%handle, int(dof, int64) - 1, measure_of(measure), harmonic_of(harmonic), &
            tolerance, refined%handle, left)
        if (present(error) .and. status >= 0) error = left
        call finish(self%context, status, stat, errmsg)
    end subroutine refine_basis

    ! The curve that crosses `branch` at its located branch point `point`, or leaves it at a period doubling; mirrored: on
    ! the other side. The points located are those where the result 'bifurcation' is not 0.
    subroutine switch_branch(self, branch, point, other, mirrored, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        type(plm_branch), intent(in) :: branch
        integer, intent(in) :: point
        type(plm_branch), intent(inout) :: other
        logical, intent(in), optional :: mirrored
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(c_int32_t) :: side
        side = 0
        if (present(mirrored)) side = merge(1_c_int32_t, 0_c_int32_t, mirrored)
        call prepare(self, other)
        call finish(self%context, plm_hbm_switch_branch(self%handle, branch%handle, int(point, int64) - 1, side, &
            other%handle), stat, errmsg)
    end subroutine switch_branch

    ! A curve at each of these force scales, in their order, read by found; count: as many as have a first motion.
    subroutine sweep_levels(self, force_scale, count, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        real(real64), intent(in) :: force_scale(:)
        integer, intent(inout) :: count
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: n
        integer(plm_status) :: status
        n = 0
        status = plm_hbm_sweep_levels(self%handle, size(force_scale, kind=int64), force_scale, n)
        if (status >= 0) count = int(n)
        call finish(self%context, status, stat, errmsg)
    end subroutine sweep_levels

    ! Isolated branches beside the curve main_branch; force_max: largest force scale looked at (if absent eight times
    ! the option 'force_scale'); count: branches found, read by found.
    subroutine find_isolated(self, main_branch, count, force_max, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        type(plm_branch), intent(in) :: main_branch
        integer, intent(inout) :: count
        real(real64), intent(in), optional :: force_max
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: n
        integer(plm_status) :: status
        n = 0
        status = plm_hbm_find_isolated(self%handle, main_branch%handle, force_of(force_max), n)
        if (status >= 0) count = int(n)
        call finish(self%context, status, stat, errmsg)
    end subroutine find_isolated

    ! The phase-resonant backbones, read by found; force_max as in find_isolated.
    subroutine find_backbones(self, count, force_max, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        integer, intent(inout) :: count
        real(real64), intent(in), optional :: force_max
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: n
        integer(plm_status) :: status
        n = 0
        status = plm_hbm_find_backbones(self%handle, force_of(force_max), n)
        if (status >= 0) count = int(n)
        call finish(self%context, status, stat, errmsg)
    end subroutine find_backbones

    ! Branches on none of the `known` curves, by marching in time at n_frequencies frequencies from rest and from
    ! n_states states (1, 2, 4, ... times the largest response on the known ones); read by found.
    subroutine find_by_marching(self, n_frequencies, n_states, count, known, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        integer, intent(in) :: n_frequencies, n_states
        integer, intent(inout) :: count
        type(plm_branch), intent(in), optional :: known(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        type(c_ptr), allocatable :: curves(:)
        integer(int64) :: n
        integer(plm_status) :: status
        call get_handles(curves, known)
        n = 0
        status = plm_hbm_find_by_marching(self%handle, size(curves, kind=int64), curves, int(n_frequencies, int64), &
            int(n_states, int64), n)
        if (status >= 0) count = int(n)
        call finish(self%context, status, stat, errmsg)
    end subroutine find_by_marching

    ! Branch number `index` (from 1) of the last find_... ("n_found" of them), or beside the curve of plm_compute_response
    ! ("larger_amplitude"); force_range: the force scales between which an isolated branch exists, NaN where unknown.
    subroutine found(self, index, branch, force_range, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        integer, intent(in) :: index
        type(plm_branch), intent(inout) :: branch
        real(real64), intent(inout), optional :: force_range(2)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call prepare(self, branch)
        call finish(self%context, plm_hbm_get_found(self%handle, int(index, int64) - 1, force_range, branch%handle), &
            stat, errmsg)
    end subroutine found

    ! The curve of folds over frequency and force scale from the located fold `point` of `branch`.
    subroutine track_fold(self, branch, point, force_min, force_max, folds, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        type(plm_branch), intent(in) :: branch
        integer, intent(in) :: point
        real(real64), intent(in) :: force_min, force_max
        type(plm_branch), intent(inout) :: folds
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call prepare(self, folds)
        call finish(self%context, plm_hbm_track_fold(self%handle, branch%handle, int(point, int64) - 1, force_min, &
            force_max, folds%handle), stat, errmsg)
    end subroutine track_fold

    ! Motion without excitation, from mode `mode` (1, 2, ...) about the contact at rest until the first harmonic of the
    ! DOF reaches amplitude_max; 0: to a hundred times the amplitude at which a pair first opens or closes.
    subroutine find_nonlinear_mode(self, mode, dof, amplitude_max, branch, stat, errmsg)
        class(plm_hbm), intent(inout) :: self
        integer, intent(in) :: mode, dof
        real(real64), intent(in) :: amplitude_max
        type(plm_branch), intent(inout) :: branch
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call prepare(self, branch)
        call finish(self%context, plm_hbm_find_nonlinear_mode(self%handle, int(mode, int64), int(dof, int64) - 1, &
            amplitude_max, branch%handle), stat, errmsg)
    end subroutine find_nonlinear_mode

    pure real(real64) function force_of(force_max)
        real(real64), intent(in), optional :: force_max
        force_of = 0
        if (present(force_max)) force_of = force_max
    end function force_of

    ! an output branch knows its context and kind before it has a handle
    subroutine prepare(self, branch)
        class(plm_hbm), intent(in) :: self
        type(plm_branch), intent(inout) :: branch
        branch%context = self%context
        branch%kind = PLM_KIND_BRANCH
    end subroutine prepare

end module plm_responses
