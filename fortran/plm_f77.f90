! plm_f77.f90: the library for FORTRAN 77. Compile it, plm_c.f90, plm_f77_calls.f90, _keys and _bytes with the flags of
! the host (default integers, underscores). Every subroutine, with its arguments, is listed in plmf.inc. Here stand what
! they share, and the few that do not follow from src/capi/api.txt; each says why.
!
! Handles are INTEGER*8, numbers default INTEGER and DOUBLE PRECISION, texts CHARACTER*(*) with blanks behind. DOFs,
! pairs, points, columns and compressed pointers count from 1; 0 is "no DOF". The last argument IERR is the plm_status:
! 0 done, > 0 done with an outcome to look at, < 0 failed; PLMCET has the text after both.
module plm_f77_support
    use, intrinsic :: iso_c_binding, only: c_ptr, c_funptr, c_null_ptr, c_char, c_double, c_int32_t, c_int64_t, &
        c_null_char, c_f_procpointer
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_constants
    implicit none
    private
    public :: as_pointer, as_handle, c_text, to_blanks, narrow, narrow_array, forward_log, forward_progress
    public :: forward_bytes, write_subroutine, forward_recovery, log_subroutine, progress_subroutine, recover_subroutine

    abstract interface
        subroutine log_subroutine(level, text)
            implicit none
            integer, intent(in) :: level
            character(len=*), intent(in) :: text
        end subroutine log_subroutine
        subroutine progress_subroutine(stage, fraction, cancel)
            import :: real64
            implicit none
            character(len=*), intent(in) :: stage
            real(real64), intent(in) :: fraction
            integer, intent(inout) :: cancel
        end subroutine progress_subroutine
        subroutine recover_subroutine(ndof, ncol, q, nfull, full, ifail)
            import :: real64
            implicit none
            integer, intent(in) :: ndof, ncol, nfull
            real(real64), intent(in) :: q(ndof, *)
            real(real64), intent(inout) :: full(nfull, *)
            integer, intent(inout) :: ifail
        end subroutine recover_subroutine
        subroutine write_subroutine(nbytes, state, ifail)
            implicit none
            integer, intent(in) :: nbytes
            character(len=*), intent(in) :: state
            integer, intent(inout) :: ifail
        end subroutine write_subroutine
    end interface

contains

    pure type(c_ptr) function as_pointer(handle)
        integer(int64), intent(in) :: handle
        as_pointer = transfer(handle, c_null_ptr)
    end function as_pointer

    pure integer(int64) function as_handle(pointer)
        type(c_ptr), intent(in) :: pointer
        as_handle = transfer(pointer, 0_int64)
    end function as_handle

    pure function c_text(text) result(ended)
        character(len=*), intent(in) :: text
        character(kind=c_char, len=len_trim(text) + 1) :: ended
        ended = trim(text)//c_null_char
    end function c_text

    ! blanks from the NUL on
    pure subroutine to_blanks(buffer, text)
        character(kind=c_char, len=*), intent(in) :: buffer
        character(len=*), intent(inout) :: text
        integer :: ends
        ends = index(buffer, c_null_char)
        if (ends == 0) ends = len(buffer) + 1
        text = buffer(1:ends - 1)
    end subroutine to_blanks

    ! a number that a default INTEGER cannot hold is an error, not a wrong number
    pure subroutine narrow(wide, number, ierr)
        integer(int64), intent(in) :: wide
        integer, intent(inout) :: number, ierr
        if (abs(wide) > int(huge(number), int64)) then
            ierr = int(PLM_ERR_ARGUMENT)
        else
            number = int(wide)
        end if
    end subroutine narrow

    pure subroutine narrow_array(wide, numbers, ierr)
        integer(int64), intent(in) :: wide(:)
        integer, intent(inout) :: numbers(*), ierr
        integer :: i
        do i = 1, size(wide)
            call narrow(wide(i), numbers(i), ierr)
        end do
    end subroutine narrow_array

    ! `user` is the address of the host's subroutine
    subroutine forward_log(ctx, level, text, user) bind(c, name='')
        type(c_ptr), value :: ctx, user
        integer(c_int32_t), value :: level
        character(kind=c_char), intent(in) :: text(*)
        procedure(log_subroutine), pointer :: host
        if (as_handle(ctx) == 0) return
        call c_f_procpointer(transfer(user, as_function()), host)
        call host(int(level), collected(text))
    end subroutine forward_log

    integer(c_int32_t) function forward_progress(ctx, stage, fraction, user) bind(c, name='') result(code)
        type(c_ptr), value :: ctx, user
        character(kind=c_char), intent(in) :: stage(*)
        real(c_double), value :: fraction
        procedure(progress_subroutine), pointer :: host
        integer :: cancel
        code = 0
        if (as_handle(ctx) == 0) return
        call c_f_procpointer(transfer(user, as_function()), host)
        cancel = 0
        call host(collected(stage), real(fraction, real64), cancel)
        if (cancel /= 0) code = 1
    end function forward_progress

    integer(c_int32_t) function forward_recovery(ctx, n_dof, n_columns, reduced, n_full, full, user) &
        bind(c, name='') result(code)
        type(c_ptr), value :: ctx, user
        integer(c_int64_t), value :: n_dof, n_columns, n_full
        real(c_double), intent(in) :: reduced(*)
        real(c_double), intent(inout) :: full(*)
        procedure(recover_subroutine), pointer :: host
        integer :: failed
        code = 0
        if (as_handle(ctx) == 0) return
        call c_f_procpointer(transfer(user, as_function()), host)
        failed = 0
        call host(int(n_dof), int(n_columns), reduced, int(n_full), full, failed)
        code = int(failed, c_int32_t)
    end function forward_recovery

    integer(c_int32_t) function forward_bytes(ctx, n, bytes, user) bind(c, name='') result(code)
        type(c_ptr), value :: ctx, user
        integer(c_int64_t), value :: n
        character(kind=c_char), intent(in) :: bytes(n)
        procedure(write_subroutine), pointer :: host
        integer :: failed
        code = 0
        if (as_handle(ctx) == 0) return
        call c_f_procpointer(transfer(user, as_function()), host)
        failed = 0
        call host(int(n), collected(bytes), failed)
        code = int(failed, c_int32_t)
    end function forward_bytes

    pure type(c_funptr) function as_function()
        use, intrinsic :: iso_c_binding, only: c_null_funptr
        as_function = c_null_funptr
    end function as_function

    pure function collected(characters) result(text)
        character(kind=c_char), intent(in) :: characters(*)
        character(len=:), allocatable :: text
        integer :: n, i
        n = 0
        do while (characters(n + 1) /= c_null_char)
            n = n + 1
        end do
        allocate (character(len=n) :: text)
        do i = 1, n
            text(i:i) = characters(i)
        end do
    end function collected

end module plm_f77_support

! callbacks: the host's EXTERNAL is not what the library calls, and "none" is a subroutine of its own
subroutine plmcsl(handle, host, ierr)
    use, intrinsic :: iso_c_binding, only: c_funloc, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_context_set_log
    use plm_f77_support, only: as_pointer, forward_log, log_subroutine
    implicit none
    integer(int64), intent(in) :: handle
    procedure(log_subroutine) :: host
    integer, intent(out) :: ierr
    ierr = int(plm_context_set_log(as_pointer(handle), c_funloc(forward_log), transfer(c_funloc(host), c_null_ptr)))
end subroutine plmcsl

subroutine plmcnl(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_funptr, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_context_set_log
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(out) :: ierr
    ierr = int(plm_context_set_log(as_pointer(handle), c_null_funptr, c_null_ptr))
end subroutine plmcnl

subroutine plmcsp(handle, host, ierr)
    use, intrinsic :: iso_c_binding, only: c_funloc, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_context_set_progress
    use plm_f77_support, only: as_pointer, forward_progress, progress_subroutine
    implicit none
    integer(int64), intent(in) :: handle
    procedure(progress_subroutine) :: host
    integer, intent(out) :: ierr
    ierr = int(plm_context_set_progress(as_pointer(handle), c_funloc(forward_progress), transfer(c_funloc(host), &
        c_null_ptr)))
end subroutine plmcsp

subroutine plmcnp(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_funptr, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_context_set_progress
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(out) :: ierr
    ierr = int(plm_context_set_progress(as_pointer(handle), c_null_funptr, c_null_ptr))
end subroutine plmcnp

subroutine plmmrv(handle, nfull, host, ierr)
    use, intrinsic :: iso_c_binding, only: c_funloc, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_model_set_recovery
    use plm_f77_support, only: as_pointer, forward_recovery, recover_subroutine
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: nfull
    procedure(recover_subroutine) :: host
    integer, intent(out) :: ierr
    ierr = int(plm_model_set_recovery(as_pointer(handle), int(nfull, int64), c_funloc(forward_recovery), &
        transfer(c_funloc(host), c_null_ptr)))
end subroutine plmmrv

subroutine plmmnv(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_funptr, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_model_set_recovery
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(out) :: ierr
    ierr = int(plm_model_set_recovery(as_pointer(handle), 0_int64, c_null_funptr, c_null_ptr))
end subroutine plmmnv

! DIMAG is not read for harmonic 0, where C wants NULL
subroutine plmmex(handle, iharm, ndof, dreal, dimag, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_set_excitation
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: iharm
    integer, intent(in) :: ndof
    real(real64), intent(in) :: dreal(*)
    real(real64), intent(in) :: dimag(*)
    integer, intent(out) :: ierr
    if (iharm == 0) then
        ierr = int(plm_model_set_excitation(as_pointer(handle), int(iharm, c_int32_t), int(ndof, int64), dreal))
    else
        ierr = int(plm_model_set_excitation(as_pointer(handle), int(iharm, c_int32_t), int(ndof, int64), dreal, &
            dimag))
    end if
end subroutine plmmex

! the same
subroutine plmmeg(handle, iharm, ipower, ndof, dreal, dimag, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_set_growing_excitation
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: iharm
    integer, intent(in) :: ipower
    integer, intent(in) :: ndof
    real(real64), intent(in) :: dreal(*)
    real(real64), intent(in) :: dimag(*)
    integer, intent(out) :: ierr
    if (iharm == 0) then
        ierr = int(plm_model_set_growing_excitation(as_pointer(handle), int(iharm, c_int32_t), &
            int(ipower, c_int32_t), int(ndof, int64), dreal))
    else
        ierr = int(plm_model_set_growing_excitation(as_pointer(handle), int(iharm, c_int32_t), &
            int(ipower, c_int32_t), int(ndof, int64), dreal, dimag))
    end if
end subroutine plmmeg

! the same
subroutine plmmgm(handle, iharm, n, dreal, dimag, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_set_gap_motion
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: iharm
    integer, intent(in) :: n
    real(real64), intent(in) :: dreal(*)
    real(real64), intent(in) :: dimag(*)
    integer, intent(out) :: ierr
    if (iharm == 0) then
        ierr = int(plm_model_set_gap_motion(as_pointer(handle), int(iharm, c_int32_t), int(n, int64), dreal))
    else
        ierr = int(plm_model_set_gap_motion(as_pointer(handle), int(iharm, c_int32_t), int(n, int64), dreal, &
            dimag))
    end if
end subroutine plmmgm

! flags of another width, as many as the model has pairs, read for one system only
subroutine plmmmo(handle, isys, iclosd, n, freq, shape, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_get_int, plm_model_get_modes, PLM_SYSTEM_GIVEN
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: isys
    integer, intent(in) :: iclosd(*)
    integer, intent(in) :: n
    real(real64), intent(inout) :: freq(*)
    real(real64), intent(inout) :: shape(*)
    integer, intent(out) :: ierr
    integer(int64) :: pairs
    if (isys == PLM_SYSTEM_GIVEN) then
        ierr = int(plm_model_get_int(as_pointer(handle), 'n_pairs'//char(0), pairs))
        if (ierr < 0) return
        ierr = int(plm_model_get_modes(as_pointer(handle), int(isys, c_int32_t), int(iclosd(1:pairs), c_int32_t), &
            int(n, int64), freq, shape))
    else
        ierr = int(plm_model_get_modes(as_pointer(handle), int(isys, c_int32_t), n=int(n, int64), frequency_hz=freq, &
            shape=shape))
    end if
end subroutine plmmmo

! no C function of its own: the modes without their shapes
subroutine plmmfr(handle, isys, n, freq, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_get_modes
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: isys
    integer, intent(in) :: n
    real(real64), intent(inout) :: freq(*)
    integer, intent(out) :: ierr
    ierr = int(plm_model_get_modes(as_pointer(handle), int(isys, c_int32_t), n=int(n, int64), frequency_hz=freq))
end subroutine plmmfr

! IPOINT is 0 where there is no START
subroutine plmhso(handle, freq, start, ipoint, branch, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_hbm_solve
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: handle
    real(real64), intent(in) :: freq
    integer(int64), intent(in) :: start
    integer, intent(in) :: ipoint
    integer(int64), intent(inout) :: branch
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_hbm_solve(as_pointer(handle), freq, as_pointer(start), max(int(ipoint, int64) - 1, 0_int64), &
        made))
    if (as_handle(made) /= 0) branch = as_handle(made)
end subroutine plmhso

! flags of another width, as many as the model has pairs
subroutine plmrct(handle, ipoint, ntimes, pen, force, iclosd, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_branch_get_contact, plm_branch_get_int
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: ipoint
    integer, intent(in) :: ntimes
    real(real64), intent(inout) :: pen(*)
    real(real64), intent(inout) :: force(*)
    integer, intent(inout) :: iclosd(*)
    integer, intent(out) :: ierr
    integer(int64) :: pairs
    integer(c_int32_t), allocatable :: closed(:)
    pairs = 0
    ierr = int(plm_branch_get_int(as_pointer(handle), 'n_pairs'//char(0), pairs))
    if (ierr < 0) return
    allocate(closed(max(1_int64, pairs * max(ntimes, 0))))
    closed = 0
    ierr = int(plm_branch_get_contact(as_pointer(handle), int(ipoint, int64) - 1, int(ntimes, int64), pen, force, &
        closed))
    if (ierr >= 0) iclosd(1:pairs * ntimes) = int(closed(1:pairs * ntimes))
end subroutine plmrct
