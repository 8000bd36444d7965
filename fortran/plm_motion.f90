! plm_motion.f90: motion in time of a reduced or of the full model. DOFs, points and observed DOFs count from 1.
module plm_motions
    use, intrinsic :: iso_c_binding, only: c_ptr, c_null_ptr, c_int32_t
    use, intrinsic :: iso_fortran_env, only: int32, int64, real64
    use plm_constants
    use plm_c
    use plm_errors, only: finish, refuse
    use plm_methods, only: plm_transient_methods
    use plm_models, only: plm_model
    use plm_reductions, only: plm_basis
    implicit none
    private
    public :: plm_transient

    ! The excitation is set by the options 'frequency_hz' and 'force_scale', the length of a run by 'periods'.
    type, extends(plm_transient_methods) :: plm_transient
        integer(int64), private :: n_dof = 0 ! of the model
    contains
        procedure :: create
        procedure :: destroy
        procedure, private :: observe_int32, observe_int64
        generic :: observe => observe_int32, observe_int64
        procedure :: set_state
        procedure :: run
        procedure :: find_periodic
        procedure :: state
        procedure :: history
        procedure :: multipliers
    end type plm_transient

contains

    ! basis: the reduced model; absent: the full one. At rest under the pre-load at first.
    subroutine create(self, model, basis, stat, errmsg)
        class(plm_transient), intent(inout) :: self
        type(plm_model), intent(in) :: model
        type(plm_basis), intent(in), optional :: basis
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        type(c_ptr) :: reduced
        integer(plm_status) :: status
        self%context = model%context
        self%kind = PLM_KIND_TRANSIENT
        reduced = c_null_ptr
        if (present(basis)) reduced = basis%handle
        status = plm_model_get_int(model%handle, 'n_dof'//char(0), self%n_dof)
        if (status >= 0) status = plm_transient_create(model%handle, reduced, self%handle)
        call finish(self%context, status, stat, errmsg)
    end subroutine create

    subroutine destroy(self, stat, errmsg)
        class(plm_transient), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_transient_destroy(self%handle), stat, errmsg)
    end subroutine destroy

    ! The DOFs whose motion the next runs record; an empty array: none.
    subroutine observe_int32(self, dof, stat, errmsg)
        class(plm_transient), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dof(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_transient_observe(self%handle, 1_c_int32_t, size(dof, kind=int64), dof), stat, &
            errmsg)
    end subroutine observe_int32

    ! q(n_dof), v(n_dof): displacement and velocity at the beginning of a period; absent: zero
    subroutine set_state(self, q, v, stat, errmsg)
        class(plm_transient), intent(inout) :: self
        real(real64), intent(in), contiguous, optional :: q(:), v(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: n
        n = self%n_dof
        if (present(v)) n = size(v, kind=int64)
        if (present(q)) n = size(q, kind=int64)
        if (present(v)) then
            if (size(v, kind=int64) /= n) then
                call refuse('set_state: q and v have different lengths', stat, errmsg)
                return
            end if
        end if
        ! an absent array is left out of the call: gfortran reads its address when it is handed on
        if (present(q) .and. present(v)) then
            call finish(self%context, plm_transient_set_state(self%handle, n, q, v), stat, errmsg)
        else if (present(q)) then
            call finish(self%context, plm_transient_set_state(self%handle, n, q), stat, errmsg)
        else if (present(v)) then
            call finish(self%context, plm_transient_set_state(self%handle, n, v=v), stat, errmsg)
        else
            call finish(self%context, plm_transient_set_state(self%handle, n), stat, errmsg)
        end if
    end subroutine set_state

    ! stat PLM_CANCELLED: what was marched until then is kept.
    subroutine run(self, stat, errmsg)
        class(plm_transient), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_transient_run(self%handle), stat, errmsg)
    end subroutine run

    ! The periodic motion nearest the present state. stat PLM_NOT_CONVERGED: the best one found.
    subroutine find_periodic(self, stat, errmsg)
        class(plm_transient), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_transient_find_periodic(self%handle), stat, errmsg)
    end subroutine find_periodic

    ! q(n_dof), v(n_dof) now
    subroutine state(self, q, v, stat, errmsg)
        class(plm_transient), intent(in) :: self
        real(real64), allocatable, intent(inout), optional :: q(:), v(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64), allocatable :: displacement(:), velocity(:)
        integer(plm_status) :: status
        allocate (displacement(self%n_dof), velocity(self%n_dof))
        status = plm_transient_get_state(self%handle, self%n_dof, displacement, velocity)
        if (status >= 0) then
            if (present(q)) call move_alloc(displacement, q)
            if (present(v)) call move_alloc(velocity, v)
        end if
        call finish(self%context, status, stat, errmsg)
    end subroutine state

    ! Displacement of the observed DOF number `observed` at the instants 'time' of the last run.
    subroutine history(self, observed, value, stat, errmsg)
        class(plm_transient), intent(in) :: self
        integer, intent(in) :: observed
        real(real64), allocatable, intent(inout) :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64), allocatable :: recorded(:)
        integer(plm_status) :: status
        integer(int64) :: n
        n = 0
        status = plm_transient_get_history(self%handle, int(observed, int64) - 1, 0_int64, count=n)
        allocate (recorded(n))
        if (status >= 0) status = plm_transient_get_history(self%handle, int(observed, int64) - 1, n, recorded, n)
        if (status >= 0) call move_alloc(recorded, value)
        call finish(self%context, status, stat, errmsg)
    end subroutine history

    ! Floquet multipliers of the motion find_periodic found, largest modulus first
    subroutine multipliers(self, value, stat, errmsg)
        class(plm_transient), intent(in) :: self
        complex(real64), allocatable, intent(inout) :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64), allocatable :: re(:), im(:)
        integer(plm_status) :: status
        integer(int64) :: n
        n = 0
        status = plm_transient_get_multipliers(self%handle, 0_int64, count=n)
        allocate (re(n), im(n))
        if (status >= 0) status = plm_transient_get_multipliers(self%handle, n, re, im, n)
        if (status >= 0) value = cmplx(re, im, real64)
        call finish(self%context, status, stat, errmsg)
    end subroutine multipliers

    ! the procedures *_int64, twins of those above
    include 'plm_motion_int64.inc'

end module plm_motions
