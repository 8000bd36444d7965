! plm_f77_bytes.f90: bases and branches as bytes for FORTRAN 77; see plmf.inc and docs/format.md. By hand, since C hands
! over addresses here, and the bytes are in a text.

! the basis as bytes: the number of bytes first, which need not fit
subroutine plmbwr(handle, state, nbytes, ierr)
    use, intrinsic :: iso_c_binding, only: c_loc, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int8, int64
    use plm_c, only: plm_basis_write
    use plm_f77_support, only: as_pointer, narrow
    implicit none
    integer(int64), intent(in) :: handle
    character(len=*), intent(inout) :: state
    integer, intent(inout) :: nbytes
    integer, intent(out) :: ierr
    integer(int8), allocatable, target :: bytes(:)
    integer(int64) :: needed
    integer :: i
    ierr = int(plm_basis_write(as_pointer(handle), 0_int64, c_null_ptr, needed))
    if (ierr < 0) return
    if (needed <= len(state)) then
        allocate (bytes(needed))
        ierr = int(plm_basis_write(as_pointer(handle), needed, c_loc(bytes), needed))
        if (ierr < 0) return
        do i = 1, int(needed)
            state(i:i) = transfer(bytes(i), 'a')
        end do
    end if
    call narrow(needed, nbytes, ierr)
end subroutine plmbwr

! a basis from them: texts are handed over without their length
subroutine plmbrd(parent, nbytes, state, handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_loc, c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int8, int64
    use plm_c, only: plm_basis_read
    use plm_constants, only: PLM_ERR_ARGUMENT
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: parent
    integer, intent(in) :: nbytes
    character(len=*), intent(in) :: state
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    integer(int8), allocatable, target :: bytes(:)
    type(c_ptr) :: found
    integer :: i
    ierr = int(PLM_ERR_ARGUMENT)
    if (nbytes < 1 .or. nbytes > len(state)) return
    allocate (bytes(nbytes))
    do i = 1, nbytes
        bytes(i) = transfer(state(i:i), 0_int8)
    end do
    found = c_null_ptr
    ierr = int(plm_basis_read(as_pointer(parent), int(nbytes, int64), c_loc(bytes), found))
    if (ierr >= 0) handle = as_handle(found)
end subroutine plmbrd

! a branch as bytes: the number of bytes first, which need not fit
subroutine plmrwr(handle, state, nbytes, ierr)
    use, intrinsic :: iso_c_binding, only: c_loc, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int8, int64
    use plm_c, only: plm_branch_write
    use plm_f77_support, only: as_pointer, narrow
    implicit none
    integer(int64), intent(in) :: handle
    character(len=*), intent(inout) :: state
    integer, intent(inout) :: nbytes
    integer, intent(out) :: ierr
    integer(int8), allocatable, target :: bytes(:)
    integer(int64) :: needed
    integer :: i
    ierr = int(plm_branch_write(as_pointer(handle), 0_int64, c_null_ptr, needed))
    if (ierr < 0) return
    if (needed <= len(state)) then
        allocate (bytes(needed))
        ierr = int(plm_branch_write(as_pointer(handle), needed, c_loc(bytes), needed))
        if (ierr < 0) return
        do i = 1, int(needed)
            state(i:i) = transfer(bytes(i), 'a')
        end do
    end if
    call narrow(needed, nbytes, ierr)
end subroutine plmrwr

! a branch from them: texts are handed over without their length
subroutine plmrfb(parent, nbytes, state, handle, ierr)
    use, intrinsic :: iso_c_binding, only: c_loc, c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int8, int64
    use plm_c, only: plm_branch_read
    use plm_constants, only: PLM_ERR_ARGUMENT
    use plm_f77_support, only: as_pointer, as_handle
    implicit none
    integer(int64), intent(in) :: parent
    integer, intent(in) :: nbytes
    character(len=*), intent(in) :: state
    integer(int64), intent(inout) :: handle
    integer, intent(out) :: ierr
    integer(int8), allocatable, target :: bytes(:)
    type(c_ptr) :: found
    integer :: i
    ierr = int(PLM_ERR_ARGUMENT)
    if (nbytes < 1 .or. nbytes > len(state)) return
    allocate (bytes(nbytes))
    do i = 1, nbytes
        bytes(i) = transfer(state(i:i), 0_int8)
    end do
    found = c_null_ptr
    ierr = int(plm_branch_read(as_pointer(parent), int(nbytes, int64), c_loc(bytes), found))
    if (ierr >= 0) handle = as_handle(found)
end subroutine plmrfb

! the basis to a subroutine of the host
subroutine plmbwt(handle, host, ierr)
    use, intrinsic :: iso_c_binding, only: c_funloc, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_basis_write_to
    use plm_f77_support, only: as_pointer, forward_bytes, write_subroutine
    implicit none
    integer(int64), intent(in) :: handle
    procedure(write_subroutine) :: host
    integer, intent(out) :: ierr
    ierr = int(plm_basis_write_to(as_pointer(handle), c_funloc(forward_bytes), transfer(c_funloc(host), c_null_ptr)))
end subroutine plmbwt

! a branch
subroutine plmrwt(handle, host, ierr)
    use, intrinsic :: iso_c_binding, only: c_funloc, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_branch_write_to
    use plm_f77_support, only: as_pointer, forward_bytes, write_subroutine
    implicit none
    integer(int64), intent(in) :: handle
    procedure(write_subroutine) :: host
    integer, intent(out) :: ierr
    ierr = int(plm_branch_write_to(as_pointer(handle), c_funloc(forward_bytes), transfer(c_funloc(host), c_null_ptr)))
end subroutine plmrwt

! the table of a branch
subroutine plmrcw(handle, idof, imeas, iharm, host, ierr)
    use, intrinsic :: iso_c_binding, only: c_funloc, c_int32_t, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_c, only: plm_branch_write_csv_to
    use plm_f77_support, only: as_pointer, forward_bytes, write_subroutine
    implicit none
    integer(int64), intent(in) :: handle
    integer, intent(in) :: idof
    integer, intent(in) :: imeas
    integer, intent(in) :: iharm
    procedure(write_subroutine) :: host
    integer, intent(out) :: ierr
    ierr = int(plm_branch_write_csv_to(as_pointer(handle), int(idof - 1, int64), int(imeas, c_int32_t), &
        int(iharm, c_int32_t), c_funloc(forward_bytes), transfer(c_funloc(host), c_null_ptr)))
end subroutine plmrcw
