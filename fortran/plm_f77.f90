! plm_f77.f90: the library for FORTRAN 77. Compile it, plm_c.f90 and plm_f77_keys.f90 with the flags of the host
! (default integers, underscores). Every subroutine, with its arguments, is listed in plmf.inc.
!
! Handles are INTEGER*8, numbers default INTEGER and DOUBLE PRECISION, texts CHARACTER*(*) with blanks behind. DOFs,
! pairs, points, columns and compressed pointers count from 1; 0 is "no DOF". The last argument IERR is the plm_status:
! 0 done, > 0 done with an outcome to look at, < 0 failed; PLMCET has the text after both.
module plm_f77_support
    use, intrinsic :: iso_c_binding, only: c_ptr, c_funptr, c_null_ptr, c_char, c_double, c_int32_t, c_null_char, &
        c_f_procpointer
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_constants
    implicit none
    private
    public :: as_pointer, as_handle, c_text, to_blanks, narrow, narrow_array, forward_log, forward_progress
    public :: log_subroutine, progress_subroutine

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

subroutine plmver(major, minor, patch, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use plm_c, only: plm_version
    implicit none
    integer, intent(inout) :: major
    integer, intent(inout) :: minor
    integer, intent(inout) :: patch
    integer, intent(out) :: ierr
    integer(c_int32_t) :: part(3)
    part = 0
    ierr = int(plm_version(part(1), part(2), part(3)))
    major = int(part(1))
    minor = int(part(2))
    patch = int(part(3))
end subroutine plmver

subroutine plmbld(text, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_build_info
    use plm_f77_support, only: to_blanks
    implicit none
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr
    character(len=len(text) + 1) :: buffer
    buffer = ' '
    ierr = int(plm_build_info(len(buffer, int64), buffer))
    if (ierr >= 0) call to_blanks(buffer, text)
end subroutine plmbld

subroutine plmstx(istat, text, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_status_text
    use plm_f77_support, only: to_blanks
    implicit none
    integer, intent(in) :: istat
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr
    character(len=len(text) + 1) :: buffer
    buffer = ' '
    ierr = int(plm_status_text(int(istat, c_int32_t), len(buffer, int64), buffer))
    if (ierr >= 0) call to_blanks(buffer, text)
end subroutine plmstx

subroutine plmkcn(kind, count, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use plm_c, only: plm_key_count
    implicit none
    integer, intent(in) :: kind
    integer, intent(inout) :: count
    integer, intent(out) :: ierr
    integer(c_int32_t) :: n
    n = 0
    ierr = int(plm_key_count(int(kind, c_int32_t), n))
    if (ierr >= 0) count = int(n)
end subroutine plmkcn

subroutine plmkin(kind, number, itype, isopt, dmin, dmax, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: real64
    use plm_c, only: plm_key_info
    implicit none
    integer, intent(in) :: kind
    integer, intent(in) :: number
    integer, intent(inout) :: itype
    integer, intent(inout) :: isopt
    real(real64), intent(inout) :: dmin
    real(real64), intent(inout) :: dmax
    integer, intent(out) :: ierr
    integer(c_int32_t) :: type, option
    type = 0
    option = 0
    ierr = int(plm_key_info(int(kind, c_int32_t), int(number - 1, c_int32_t), type, option, dmin, dmax))
    if (ierr >= 0) then
        itype = int(type)
        isopt = int(option)
    end if
end subroutine plmkin

subroutine plmktx(kind, number, ifield, text, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_key_text
    use plm_f77_support, only: to_blanks
    implicit none
    integer, intent(in) :: kind
    integer, intent(in) :: number
    integer, intent(in) :: ifield
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr
    character(len=len(text) + 1) :: buffer
    buffer = ' '
    ierr = int(plm_key_text(int(kind, c_int32_t), int(number - 1, c_int32_t), int(ifield, c_int32_t), len(buffer, &
        int64), buffer))
    if (ierr >= 0) call to_blanks(buffer, text)
end subroutine plmktx

subroutine plmccr(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_context_create, PLM_API_VERSION
    use plm_f77_support, only: as_handle
    implicit none
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_context_create(PLM_API_VERSION, made))
    if (ierr >= 0) handle = as_handle(made)
end subroutine plmccr

subroutine plmcde(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_context_destroy
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: gone
    gone = as_pointer(handle)
    ierr = int(plm_context_destroy(gone))
    if (ierr >= 0) handle = as_handle(gone)
end subroutine plmcde

subroutine plmcet(handle, text, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_context_get_error_text
    use plm_f77_support, only: as_pointer, to_blanks
    implicit none
    integer(int64), intent(in) :: handle
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr
    character(len=len(text) + 1) :: buffer
    buffer = ' '
    ierr = int(plm_context_get_error_text(as_pointer(handle), len(buffer, int64), buffer))
    if (ierr >= 0) call to_blanks(buffer, text)
end subroutine plmcet

subroutine plmcef(handle, text, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_context_get_error_function
    use plm_f77_support, only: as_pointer, to_blanks
    implicit none
    integer(int64), intent(in) :: handle
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr
    character(len=len(text) + 1) :: buffer
    buffer = ' '
    ierr = int(plm_context_get_error_function(as_pointer(handle), len(buffer, int64), buffer))
    if (ierr >= 0) call to_blanks(buffer, text)
end subroutine plmcef

subroutine plmcea(handle, text, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_context_get_error_argument
    use plm_f77_support, only: as_pointer, to_blanks
    implicit none
    integer(int64), intent(in) :: handle
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr
    character(len=len(text) + 1) :: buffer
    buffer = ' '
    ierr = int(plm_context_get_error_argument(as_pointer(handle), len(buffer, int64), buffer))
    if (ierr >= 0) call to_blanks(buffer, text)
end subroutine plmcea

subroutine plmcei(handle, istat, ireasn, index, icode, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_context_get_error_info
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(inout) :: istat
    integer, intent(inout) :: ireasn
    integer, intent(inout) :: index
    integer, intent(inout) :: icode
    integer, intent(out) :: ierr
    integer(c_int32_t) :: status, reason
    integer(int64) :: place, code
    status = 0
    reason = 0
    place = -1
    code = 0
    ierr = int(plm_context_get_error_info(as_pointer(handle), status, reason, place, code))
    if (ierr >= 0) then
        istat = int(status)
        ireasn = int(reason)
        index = int(place)
        icode = int(code)
    end if
end subroutine plmcei

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

subroutine plmmcr(parent, ndof, handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_model_create
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: parent
    integer, intent(in) :: ndof
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_model_create(as_pointer(parent), int(ndof, int64), made))
    if (ierr >= 0) handle = as_handle(made)
end subroutine plmmcr

subroutine plmmde(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_model_destroy
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: gone
    gone = as_pointer(handle)
    ierr = int(plm_model_destroy(gone))
    if (ierr >= 0) handle = as_handle(gone)
end subroutine plmmde

subroutine plmmmx(handle, iwhich, istore, ipart, nnz, ia, ib, value, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_set_matrix, PLM_COPY
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: iwhich
    integer, intent(in) :: istore
    integer, intent(in) :: ipart
    integer, intent(in) :: nnz
    integer, intent(in) :: ia(*)
    integer, intent(in) :: ib(*)
    real(real64), intent(in) :: value(*)
    integer, intent(out) :: ierr
    ierr = int(plm_model_set_matrix(as_pointer(handle), int(iwhich, c_int32_t), int(istore, c_int32_t), int(ipart, &
        c_int32_t), 1_c_int32_t, PLM_COPY, int(nnz, int64), ia, ib, value))
end subroutine plmmmx

subroutine plmmrd(handle, alpha, beta, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_set_rayleigh_damping
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    real(real64), intent(in) :: alpha
    real(real64), intent(in) :: beta
    integer, intent(out) :: ierr
    ierr = int(plm_model_set_rayleigh_damping(as_pointer(handle), alpha, beta))
end subroutine plmmrd

subroutine plmmmd(handle, n, ratio, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_set_modal_damping
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: n
    real(real64), intent(in) :: ratio(*)
    integer, intent(out) :: ierr
    ierr = int(plm_model_set_modal_damping(as_pointer(handle), int(n, int64), ratio))
end subroutine plmmmd

subroutine plmmhd(handle, eta, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_set_structural_damping
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    real(real64), intent(in) :: eta
    integer, intent(out) :: ierr
    ierr = int(plm_model_set_structural_damping(as_pointer(handle), eta))
end subroutine plmmhd

subroutine plmmfx(handle, n, idof, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_model_fix_dofs
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: n
    integer, intent(in) :: idof(*)
    integer, intent(out) :: ierr
    ierr = int(plm_model_fix_dofs(as_pointer(handle), 1_c_int32_t, int(n, int64), idof))
end subroutine plmmfx

subroutine plmmnp(handle, n, idofa, idofb, dnorm, stiff, gap, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_add_node_pairs
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: n
    integer, intent(in) :: idofa(*)
    integer, intent(in) :: idofb(*)
    real(real64), intent(in) :: dnorm(*)
    real(real64), intent(in) :: stiff(*)
    real(real64), intent(in) :: gap(*)
    integer, intent(out) :: ierr
    ierr = int(plm_model_add_node_pairs(as_pointer(handle), 1_c_int32_t, int(n, int64), idofa, idofb, dnorm, stiff, &
        gap))
end subroutine plmmnp

subroutine plmmrg(handle, n, idof, dnorm, stiff, gap, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_add_ground_contacts
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: n
    integer, intent(in) :: idof(*)
    real(real64), intent(in) :: dnorm(*)
    real(real64), intent(in) :: stiff(*)
    real(real64), intent(in) :: gap(*)
    integer, intent(out) :: ierr
    ierr = int(plm_model_add_ground_contacts(as_pointer(handle), 1_c_int32_t, int(n, int64), idof, dnorm, stiff, gap))
end subroutine plmmrg

subroutine plmmgr(handle, n, irow, idof, coeff, stiff, gap, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_add_gap_rows
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: n
    integer, intent(in) :: irow(*)
    integer, intent(in) :: idof(*)
    real(real64), intent(in) :: coeff(*)
    real(real64), intent(in) :: stiff(*)
    real(real64), intent(in) :: gap(*)
    integer, intent(out) :: ierr
    ierr = int(plm_model_add_gap_rows(as_pointer(handle), 1_c_int32_t, int(n, int64), irow, idof, coeff, stiff, gap))
end subroutine plmmgr

subroutine plmmpl(handle, ndof, force, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_set_preload
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: ndof
    real(real64), intent(in) :: force(*)
    integer, intent(out) :: ierr
    ierr = int(plm_model_set_preload(as_pointer(handle), int(ndof, int64), force))
end subroutine plmmpl

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

subroutine plmmbu(handle, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_model_build
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(out) :: ierr
    ierr = int(plm_model_build(as_pointer(handle)))
end subroutine plmmbu

subroutine plmmre(handle, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_model_solve_rest
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(out) :: ierr
    ierr = int(plm_model_solve_rest(as_pointer(handle)))
end subroutine plmmre

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

subroutine plmmau(handle, count, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_model_audit
    use plm_f77_support, only: as_pointer, narrow
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(inout) :: count
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_model_audit(as_pointer(handle), found))
    if (ierr >= 0) call narrow(found, count, ierr)
end subroutine plmmau

subroutine plmmfi(handle, number, isever, value, text, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_model_get_finding
    use plm_f77_support, only: as_pointer, to_blanks
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: number
    integer, intent(inout) :: isever
    real(real64), intent(inout) :: value
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr
    integer(c_int32_t) :: severity
    character(len=len(text) + 1) :: buffer
    severity = 0
    buffer = ' '
    ierr = int(plm_model_get_finding(as_pointer(handle), int(number, int64) - 1, severity, value, len(buffer, int64), &
        buffer))
    if (ierr >= 0) then
        isever = int(severity)
        call to_blanks(buffer, text)
    end if
end subroutine plmmfi

subroutine plmscr(parent, handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_sampler_create
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: parent
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_sampler_create(as_pointer(parent), made))
    if (ierr >= 0) handle = as_handle(made)
end subroutine plmscr

subroutine plmsde(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_sampler_destroy
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: gone
    gone = as_pointer(handle)
    ierr = int(plm_sampler_destroy(gone))
    if (ierr >= 0) handle = as_handle(gone)
end subroutine plmsde

subroutine plmsam(handle, isys, mode, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_sampler_add_dominant_mode
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: isys
    integer, intent(in) :: mode
    integer, intent(out) :: ierr
    ierr = int(plm_sampler_add_dominant_mode(as_pointer(handle), int(isys, c_int32_t), int(mode, int64)))
end subroutine plmsam

subroutine plmsru(handle, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_sampler_run
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(out) :: ierr
    ierr = int(plm_sampler_run(as_pointer(handle)))
end subroutine plmsru

subroutine plmbcr(parent, handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_basis_create
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: parent
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_basis_create(as_pointer(parent), made))
    if (ierr >= 0) handle = as_handle(made)
end subroutine plmbcr

subroutine plmbde(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_basis_destroy
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: gone
    gone = as_pointer(handle)
    ierr = int(plm_basis_destroy(gone))
    if (ierr >= 0) handle = as_handle(gone)
end subroutine plmbde

subroutine plmbss(handle, sampler, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_basis_set_sampler
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer(int64), intent(in) :: sampler
    integer, intent(out) :: ierr
    ierr = int(plm_basis_set_sampler(as_pointer(handle), as_pointer(sampler)))
end subroutine plmbss

subroutine plmbsp(handle, basis, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_basis_set_parent
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer(int64), intent(in) :: basis
    integer, intent(out) :: ierr
    ierr = int(plm_basis_set_parent(as_pointer(handle), as_pointer(basis)))
end subroutine plmbsp

subroutine plmbsr(handle, n, curves, ierr)
    use, intrinsic :: iso_c_binding, only: c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_basis_set_responses
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: n
    integer(int64), intent(in) :: curves(*)
    integer, intent(out) :: ierr
    type(c_ptr), allocatable :: branches(:)
    integer :: i
    allocate(branches(max(n, 0)))
    do i = 1, n
        branches(i) = as_pointer(curves(i))
    end do
    ierr = int(plm_basis_set_responses(as_pointer(handle), int(n, int64), branches))
end subroutine plmbsr

subroutine plmbbu(handle, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_basis_build
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(out) :: ierr
    ierr = int(plm_basis_build(as_pointer(handle)))
end subroutine plmbbu

subroutine plmbve(handle, istat, ifirst, n, vector, ld, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_basis_get_vectors
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: istat
    integer, intent(in) :: ifirst
    integer, intent(in) :: n
    real(real64), intent(inout) :: vector(*)
    integer, intent(in) :: ld
    integer, intent(out) :: ierr
    ierr = int(plm_basis_get_vectors(as_pointer(handle), int(istat, c_int32_t), int(ifirst, int64) - 1, int(n, &
        int64), vector, int(ld, int64)))
end subroutine plmbve

subroutine plmbre(handle, istat, imass, ndof, q, r, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_basis_get_residual
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: istat
    integer, intent(in) :: imass
    integer, intent(in) :: ndof
    real(real64), intent(in) :: q(*)
    real(real64), intent(inout) :: r
    integer, intent(out) :: ierr
    ierr = int(plm_basis_get_residual(as_pointer(handle), int(istat, c_int32_t), int(imass, c_int32_t), int(ndof, &
        int64), q, r))
end subroutine plmbre

subroutine plmhcr(parent, handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_hbm_create
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: parent
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_hbm_create(as_pointer(parent), made))
    if (ierr >= 0) handle = as_handle(made)
end subroutine plmhcr

subroutine plmhde(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_hbm_destroy
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: gone
    gone = as_pointer(handle)
    ierr = int(plm_hbm_destroy(gone))
    if (ierr >= 0) handle = as_handle(gone)
end subroutine plmhde

subroutine plmhsw(handle, branch, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_hbm_sweep
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: handle
    integer(int64), intent(inout) :: branch
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_hbm_sweep(as_pointer(handle), made))
    if (as_handle(made) /= 0) branch = as_handle(made)
end subroutine plmhsw

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

subroutine plmhpk(handle, branch, idof, imeas, iharm, freq, ampl, peak, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t, c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_hbm_find_peak
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: handle
    integer(int64), intent(in) :: branch
    integer, intent(in) :: idof
    integer, intent(in) :: imeas
    integer, intent(in) :: iharm
    real(real64), intent(inout) :: freq
    real(real64), intent(inout) :: ampl
    integer(int64), intent(inout) :: peak
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_hbm_find_peak(as_pointer(handle), as_pointer(branch), int(idof, int64) - 1, int(imeas, c_int32_t), &
        int(iharm, c_int32_t), freq, ampl, made))
    if (as_handle(made) /= 0) peak = as_handle(made)
end subroutine plmhpk

subroutine plmhee(handle, branch, ipoint, idof, imeas, iharm, ampl, freq, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_hbm_estimate_error
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer(int64), intent(in) :: branch
    integer, intent(in) :: ipoint
    integer, intent(in) :: idof
    integer, intent(in) :: imeas
    integer, intent(in) :: iharm
    real(real64), intent(inout) :: ampl(*)
    real(real64), intent(inout) :: freq(*)
    integer, intent(out) :: ierr
    ierr = int(plm_hbm_estimate_error(as_pointer(handle), as_pointer(branch), int(ipoint, int64) - 1, &
        int(idof, int64) - 1, int(imeas, c_int32_t), int(iharm, c_int32_t), ampl, freq))
end subroutine plmhee

subroutine plmhrb(handle, idof, imeas, iharm, tol, refined, err, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t, c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_hbm_refine_basis
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: idof
    integer, intent(in) :: imeas
    integer, intent(in) :: iharm
    real(real64), intent(in) :: tol
    integer(int64), intent(inout) :: refined
    real(real64), intent(inout) :: err
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_hbm_refine_basis(as_pointer(handle), int(idof, int64) - 1, int(imeas, c_int32_t), &
        int(iharm, c_int32_t), tol, made, err))
    if (as_handle(made) /= 0) refined = as_handle(made)
end subroutine plmhrb

subroutine plmhsb(handle, branch, ipoint, mirror, other, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t, c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_hbm_switch_branch
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: handle
    integer(int64), intent(in) :: branch
    integer, intent(in) :: ipoint
    integer, intent(in) :: mirror
    integer(int64), intent(inout) :: other
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_hbm_switch_branch(as_pointer(handle), as_pointer(branch), int(ipoint, int64) - 1, &
        int(mirror, c_int32_t), made))
    if (as_handle(made) /= 0) other = as_handle(made)
end subroutine plmhsb

subroutine plmhfi(handle, branch, fmax, count, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_hbm_find_isolated
    use plm_f77_support, only: as_pointer, narrow
    implicit none
    integer(int64), intent(in) :: handle
    integer(int64), intent(in) :: branch
    real(real64), intent(in) :: fmax
    integer, intent(inout) :: count
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_hbm_find_isolated(as_pointer(handle), as_pointer(branch), fmax, found))
    if (ierr >= 0) call narrow(found, count, ierr)
end subroutine plmhfi

subroutine plmhfb(handle, fmax, count, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_hbm_find_backbones
    use plm_f77_support, only: as_pointer, narrow
    implicit none
    integer(int64), intent(in) :: handle
    real(real64), intent(in) :: fmax
    integer, intent(inout) :: count
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_hbm_find_backbones(as_pointer(handle), fmax, found))
    if (ierr >= 0) call narrow(found, count, ierr)
end subroutine plmhfb

subroutine plmhfm(handle, nknown, curves, nfreq, nstate, count, ierr)
    use, intrinsic :: iso_c_binding, only: c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_hbm_find_by_marching
    use plm_f77_support, only: as_pointer, narrow
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: nknown
    integer(int64), intent(in) :: curves(*)
    integer, intent(in) :: nfreq
    integer, intent(in) :: nstate
    integer, intent(inout) :: count
    integer, intent(out) :: ierr
    integer(int64) :: found
    type(c_ptr), allocatable :: known(:)
    integer :: i
    allocate(known(max(nknown, 0)))
    do i = 1, nknown
        known(i) = as_pointer(curves(i))
    end do
    found = 0
    ierr = int(plm_hbm_find_by_marching(as_pointer(handle), int(nknown, int64), known, int(nfreq, int64), &
        int(nstate, int64), found))
    if (ierr >= 0) call narrow(found, count, ierr)
end subroutine plmhfm

subroutine plmhgf(handle, number, frange, branch, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_hbm_get_found
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: number
    real(real64), intent(inout) :: frange(*)
    integer(int64), intent(inout) :: branch
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_hbm_get_found(as_pointer(handle), int(number, int64) - 1, frange, made))
    if (as_handle(made) /= 0) branch = as_handle(made)
end subroutine plmhgf

subroutine plmhtf(handle, branch, ipoint, fmin, fmax, folds, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_hbm_track_fold
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: handle
    integer(int64), intent(in) :: branch
    integer, intent(in) :: ipoint
    real(real64), intent(in) :: fmin
    real(real64), intent(in) :: fmax
    integer(int64), intent(inout) :: folds
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_hbm_track_fold(as_pointer(handle), as_pointer(branch), int(ipoint, int64) - 1, fmin, fmax, made))
    if (as_handle(made) /= 0) folds = as_handle(made)
end subroutine plmhtf

subroutine plmhnm(handle, mode, idof, amax, branch, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_hbm_find_nonlinear_mode
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: mode
    integer, intent(in) :: idof
    real(real64), intent(in) :: amax
    integer(int64), intent(inout) :: branch
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_hbm_find_nonlinear_mode(as_pointer(handle), int(mode, int64), int(idof, int64) - 1, amax, made))
    if (as_handle(made) /= 0) branch = as_handle(made)
end subroutine plmhnm

subroutine plmrde(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_branch_destroy
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: gone
    gone = as_pointer(handle)
    ierr = int(plm_branch_destroy(gone))
    if (ierr >= 0) handle = as_handle(gone)
end subroutine plmrde

subroutine plmram(handle, idof, imeas, iharm, n, ampl, count, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_branch_get_amplitude
    use plm_f77_support, only: as_pointer, narrow
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: idof
    integer, intent(in) :: imeas
    integer, intent(in) :: iharm
    integer, intent(in) :: n
    real(real64), intent(inout) :: ampl(*)
    integer, intent(inout) :: count
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_branch_get_amplitude(as_pointer(handle), int(idof, int64) - 1, int(imeas, c_int32_t), int(iharm, &
        c_int32_t), int(n, int64), ampl, found))
    if (ierr >= 0) call narrow(found, count, ierr)
end subroutine plmram

subroutine plmrco(handle, ipoint, idof, n, coeff, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_branch_get_coefficients
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: ipoint
    integer, intent(in) :: idof
    integer, intent(in) :: n
    real(real64), intent(inout) :: coeff(*)
    integer, intent(out) :: ierr
    ierr = int(plm_branch_get_coefficients(as_pointer(handle), int(ipoint, int64) - 1, int(idof, int64) - 1, int(n, &
        int64), coeff))
end subroutine plmrco

subroutine plmrfi(handle, ipoint, tfrac, ndof, q, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_branch_get_field
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: ipoint
    real(real64), intent(in) :: tfrac
    integer, intent(in) :: ndof
    real(real64), intent(inout) :: q(*)
    integer, intent(out) :: ierr
    ierr = int(plm_branch_get_field(as_pointer(handle), int(ipoint, int64) - 1, tfrac, int(ndof, int64), q))
end subroutine plmrfi

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

subroutine plmrcs(handle, ipoint, npairs, share, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_branch_get_closed_share
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: ipoint
    integer, intent(in) :: npairs
    real(real64), intent(inout) :: share(*)
    integer, intent(out) :: ierr
    ierr = int(plm_branch_get_closed_share(as_pointer(handle), int(ipoint, int64) - 1, int(npairs, int64), share))
end subroutine plmrcs

subroutine plmren(handle, ipoint, energy, area, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_branch_get_energy
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: ipoint
    real(real64), intent(inout) :: energy
    real(real64), intent(inout) :: area
    integer, intent(out) :: ierr
    ierr = int(plm_branch_get_energy(as_pointer(handle), int(ipoint, int64) - 1, energy, area))
end subroutine plmren

subroutine plmrmu(handle, ipoint, n, dreal, dimag, count, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_branch_get_multipliers
    use plm_f77_support, only: as_pointer, narrow
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: ipoint
    integer, intent(in) :: n
    real(real64), intent(inout) :: dreal(*)
    real(real64), intent(inout) :: dimag(*)
    integer, intent(inout) :: count
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_branch_get_multipliers(as_pointer(handle), int(ipoint, int64) - 1, int(n, int64), dreal, dimag, found))
    if (ierr >= 0) call narrow(found, count, ierr)
end subroutine plmrmu

subroutine plmrdf(handle, ipoint, defect, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_branch_get_periodicity_defect
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: ipoint
    real(real64), intent(inout) :: defect
    integer, intent(out) :: ierr
    ierr = int(plm_branch_get_periodicity_defect(as_pointer(handle), int(ipoint, int64) - 1, defect))
end subroutine plmrdf

subroutine plmrfr(handle, ipoint, r, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_branch_get_full_residual
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: ipoint
    real(real64), intent(inout) :: r
    integer, intent(out) :: ierr
    ierr = int(plm_branch_get_full_residual(as_pointer(handle), int(ipoint, int64) - 1, r))
end subroutine plmrfr

subroutine plmtcr(parent, basis, handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_transient_create
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: parent
    integer(int64), intent(in) :: basis
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_transient_create(as_pointer(parent), as_pointer(basis), made))
    if (ierr >= 0) handle = as_handle(made)
end subroutine plmtcr

subroutine plmtde(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_transient_destroy
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: gone
    gone = as_pointer(handle)
    ierr = int(plm_transient_destroy(gone))
    if (ierr >= 0) handle = as_handle(gone)
end subroutine plmtde

subroutine plmtob(handle, n, idof, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_transient_observe
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: n
    integer, intent(in) :: idof(*)
    integer, intent(out) :: ierr
    ierr = int(plm_transient_observe(as_pointer(handle), 1_c_int32_t, int(n, int64), idof))
end subroutine plmtob

subroutine plmtss(handle, ndof, q, v, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_transient_set_state
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: ndof
    real(real64), intent(in) :: q(*)
    real(real64), intent(in) :: v(*)
    integer, intent(out) :: ierr
    ierr = int(plm_transient_set_state(as_pointer(handle), int(ndof, int64), q, v))
end subroutine plmtss

subroutine plmtsa(handle, branch, ipoint, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_transient_start_at
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer(int64), intent(in) :: branch
    integer, intent(in) :: ipoint
    integer, intent(out) :: ierr
    ierr = int(plm_transient_start_at(as_pointer(handle), as_pointer(branch), int(ipoint, int64) - 1))
end subroutine plmtsa

subroutine plmtrn(handle, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_transient_run
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(out) :: ierr
    ierr = int(plm_transient_run(as_pointer(handle)))
end subroutine plmtrn

subroutine plmtfp(handle, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_transient_find_periodic
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(out) :: ierr
    ierr = int(plm_transient_find_periodic(as_pointer(handle)))
end subroutine plmtfp

subroutine plmtgs(handle, ndof, q, v, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_transient_get_state
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: ndof
    real(real64), intent(inout) :: q(*)
    real(real64), intent(inout) :: v(*)
    integer, intent(out) :: ierr
    ierr = int(plm_transient_get_state(as_pointer(handle), int(ndof, int64), q, v))
end subroutine plmtgs

subroutine plmthi(handle, number, n, value, count, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_transient_get_history
    use plm_f77_support, only: as_pointer, narrow
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: number
    integer, intent(in) :: n
    real(real64), intent(inout) :: value(*)
    integer, intent(inout) :: count
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_transient_get_history(as_pointer(handle), int(number, int64) - 1, int(n, int64), value, found))
    if (ierr >= 0) call narrow(found, count, ierr)
end subroutine plmthi

subroutine plmtmu(handle, n, dreal, dimag, count, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_transient_get_multipliers
    use plm_f77_support, only: as_pointer, narrow
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: n
    real(real64), intent(inout) :: dreal(*)
    real(real64), intent(inout) :: dimag(*)
    integer, intent(inout) :: count
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_transient_get_multipliers(as_pointer(handle), int(n, int64), dreal, dimag, found))
    if (ierr >= 0) call narrow(found, count, ierr)
end subroutine plmtmu

subroutine plmycr(parent, handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_create
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: parent
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_study_create(as_pointer(parent), made))
    if (ierr >= 0) handle = as_handle(made)
end subroutine plmycr

subroutine plmyde(handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_destroy
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    type(c_ptr) :: gone
    gone = as_pointer(handle)
    ierr = int(plm_study_destroy(gone))
    if (ierr >= 0) handle = as_handle(gone)
end subroutine plmyde

subroutine plmyso(handle, idof, imeas, iharm, ierr)
    use, intrinsic :: iso_c_binding, only: c_int32_t
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_set_output
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: idof
    integer, intent(in) :: imeas
    integer, intent(in) :: iharm
    integer, intent(out) :: ierr
    ierr = int(plm_study_set_output(as_pointer(handle), int(idof, int64) - 1, int(imeas, c_int32_t), &
        int(iharm, c_int32_t)))
end subroutine plmyso

subroutine plmyfl(handle, n, scale, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_study_set_force_levels
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: n
    real(real64), intent(in) :: scale(*)
    integer, intent(out) :: ierr
    ierr = int(plm_study_set_force_levels(as_pointer(handle), int(n, int64), scale))
end subroutine plmyfl

subroutine plmyrf(handle, lhbm, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_set_reference
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer(int64), intent(in) :: lhbm
    integer, intent(out) :: ierr
    ierr = int(plm_study_set_reference(as_pointer(handle), as_pointer(lhbm)))
end subroutine plmyrf

subroutine plmyar(handle, key, lhbm, number, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_add_response
    use plm_f77_support, only: as_pointer, c_text, narrow
    implicit none
    integer(int64), intent(in) :: handle
    character(len=*), intent(in) :: key
    integer(int64), intent(in) :: lhbm
    integer, intent(inout) :: number
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_study_add_response(as_pointer(handle), c_text(key), as_pointer(lhbm), found))
    if (ierr >= 0) call narrow(found + 1, number, ierr)
end subroutine plmyar

subroutine plmyac(handle, key, lhbm, n, number, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_add_compressed
    use plm_f77_support, only: as_pointer, c_text, narrow
    implicit none
    integer(int64), intent(in) :: handle
    character(len=*), intent(in) :: key
    integer(int64), intent(in) :: lhbm
    integer, intent(in) :: n
    integer, intent(inout) :: number
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_study_add_compressed(as_pointer(handle), c_text(key), as_pointer(lhbm), int(n, int64), found))
    if (ierr >= 0) call narrow(found + 1, number, ierr)
end subroutine plmyac

subroutine plmyaf(handle, key, lhbm, tol, number, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_study_add_refined
    use plm_f77_support, only: as_pointer, c_text, narrow
    implicit none
    integer(int64), intent(in) :: handle
    character(len=*), intent(in) :: key
    integer(int64), intent(in) :: lhbm
    real(real64), intent(in) :: tol
    integer, intent(inout) :: number
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_study_add_refined(as_pointer(handle), c_text(key), as_pointer(lhbm), tol, found))
    if (ierr >= 0) call narrow(found + 1, number, ierr)
end subroutine plmyaf

subroutine plmyam(handle, key, motion, nfreq, number, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_add_marching
    use plm_f77_support, only: as_pointer, c_text, narrow
    implicit none
    integer(int64), intent(in) :: handle
    character(len=*), intent(in) :: key
    integer(int64), intent(in) :: motion
    integer, intent(in) :: nfreq
    integer, intent(inout) :: number
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_study_add_marching(as_pointer(handle), c_text(key), as_pointer(motion), int(nfreq, int64), found))
    if (ierr >= 0) call narrow(found + 1, number, ierr)
end subroutine plmyam

subroutine plmyrn(handle, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_run
    use plm_f77_support, only: as_pointer
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(out) :: ierr
    ierr = int(plm_study_run(as_pointer(handle)))
end subroutine plmyrn

subroutine plmynm(handle, number, text, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_get_name
    use plm_f77_support, only: as_pointer, to_blanks
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: number
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr
    character(len=len(text) + 1) :: buffer
    ierr = int(plm_study_get_name(as_pointer(handle), int(number, int64) - 1, len(buffer, int64), buffer))
    if (ierr >= 0) call to_blanks(buffer, text)
end subroutine plmynm

subroutine plmyou(handle, number, text, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_get_outcome
    use plm_f77_support, only: as_pointer, to_blanks
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: number
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr
    character(len=len(text) + 1) :: buffer
    ierr = int(plm_study_get_outcome(as_pointer(handle), int(number, int64) - 1, len(buffer, int64), buffer))
    if (ierr >= 0) call to_blanks(buffer, text)
end subroutine plmyou

subroutine plmycu(handle, number, level, branch, ierr)
    use, intrinsic :: iso_c_binding, only: c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_get_curve
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: number
    integer, intent(in) :: level
    integer(int64), intent(inout) :: branch
    integer, intent(out) :: ierr
    type(c_ptr) :: made
    made = c_null_ptr
    ierr = int(plm_study_get_curve(as_pointer(handle), int(number, int64) - 1, int(level, int64) - 1, made))
    if (as_handle(made) /= 0) branch = as_handle(made)
end subroutine plmycu

subroutine plmypt(handle, number, level, n, freq, ampl, count, ierr)
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_c, only: plm_study_get_points
    use plm_f77_support, only: as_pointer, narrow
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: number
    integer, intent(in) :: level
    integer, intent(in) :: n
    real(real64), intent(inout) :: freq(*)
    real(real64), intent(inout) :: ampl(*)
    integer, intent(inout) :: count
    integer, intent(out) :: ierr
    integer(int64) :: found
    found = 0
    ierr = int(plm_study_get_points(as_pointer(handle), int(number, int64) - 1, int(level, int64) - 1, int(n, int64), &
        freq, ampl, found))
    if (ierr >= 0) call narrow(found, count, ierr)
end subroutine plmypt

subroutine plmywr(handle, text, ierr)
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_study_write
    use plm_f77_support, only: as_pointer, c_text
    implicit none
    integer(int64), intent(in) :: handle
    character(len=*), intent(in) :: text
    integer, intent(out) :: ierr
    ierr = int(plm_study_write(as_pointer(handle), c_text(text)))
end subroutine plmywr
