! plm_keys.f90: what all handles but the context have in common: options and results by key, generic in their type.
module plm_keyed_handles
    use, intrinsic :: iso_c_binding, only: c_ptr, c_null_ptr, c_char, c_null_char
    use, intrinsic :: iso_fortran_env, only: int32, int64, real32, real64
    use plm_constants
    use plm_c
    use plm_errors, only: finish, c_text, f_text
    implicit none
    private
    public :: plm_readable, plm_settable

    ! A handle with results. get(key, value): integer, real, logical (an integer that is not 0), allocatable character,
    ! allocatable arrays. Numbers of pairs, modes and samples inside results count as the C API tells.
    type, abstract :: plm_readable
        type(c_ptr) :: handle = c_null_ptr  ! for calls of the module plm_c
        type(c_ptr) :: context = c_null_ptr ! where the texts of failures are
        integer(plm_status) :: kind = 0     ! PLM_KIND_...
    contains
        procedure, private :: get_int32, get_int64, get_real, get_logical, get_text
        procedure, private :: get_reals, get_ints32, get_ints64
        generic :: get => get_int32, get_int64, get_real, get_logical, get_text, get_reals, get_ints32, get_ints64
    end type plm_readable

    ! A handle with options, too. set(key, value): integer, real, character, logical (1 or 0).
    type, abstract, extends(plm_readable) :: plm_settable
    contains
        procedure, private :: set_int32, set_int64, set_real32, set_real64, set_logical, set_text
        generic :: set => set_int32, set_int64, set_real32, set_real64, set_logical, set_text
    end type plm_settable

contains

    subroutine set_int64(self, key, value, stat, errmsg)
        class(plm_settable), intent(inout) :: self
        character(len=*), intent(in) :: key
        integer(int64), intent(in) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        select case (self%kind)
        case (PLM_KIND_MODEL)
            status = plm_model_set_int(self%handle, c_text(key), value)
        case (PLM_KIND_SAMPLER)
            status = plm_sampler_set_int(self%handle, c_text(key), value)
        case (PLM_KIND_BASIS)
            status = plm_basis_set_int(self%handle, c_text(key), value)
        case (PLM_KIND_HBM)
            status = plm_hbm_set_int(self%handle, c_text(key), value)
        case (PLM_KIND_TRANSIENT)
            status = plm_transient_set_int(self%handle, c_text(key), value)
        case (PLM_KIND_STUDY)
            status = plm_study_set_int(self%handle, c_text(key), value)
        case default
            status = PLM_ERR_HANDLE
        end select
        call finish(self%context, status, stat, errmsg)
    end subroutine set_int64

    subroutine set_int32(self, key, value, stat, errmsg)
        class(plm_settable), intent(inout) :: self
        character(len=*), intent(in) :: key
        integer(int32), intent(in) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%set_int64(key, int(value, int64), stat, errmsg)
    end subroutine set_int32

    subroutine set_logical(self, key, value, stat, errmsg)
        class(plm_settable), intent(inout) :: self
        character(len=*), intent(in) :: key
        logical, intent(in) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%set_int64(key, merge(1_int64, 0_int64, value), stat, errmsg)
    end subroutine set_logical

    subroutine set_real64(self, key, value, stat, errmsg)
        class(plm_settable), intent(inout) :: self
        character(len=*), intent(in) :: key
        real(real64), intent(in) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        select case (self%kind)
        case (PLM_KIND_MODEL)
            status = plm_model_set_double(self%handle, c_text(key), value)
        case (PLM_KIND_SAMPLER)
            status = plm_sampler_set_double(self%handle, c_text(key), value)
        case (PLM_KIND_BASIS)
            status = plm_basis_set_double(self%handle, c_text(key), value)
        case (PLM_KIND_HBM)
            status = plm_hbm_set_double(self%handle, c_text(key), value)
        case (PLM_KIND_TRANSIENT)
            status = plm_transient_set_double(self%handle, c_text(key), value)
        case (PLM_KIND_STUDY)
            status = plm_study_set_double(self%handle, c_text(key), value)
        case default
            status = PLM_ERR_HANDLE
        end select
        call finish(self%context, status, stat, errmsg)
    end subroutine set_real64

    subroutine set_real32(self, key, value, stat, errmsg)
        class(plm_settable), intent(inout) :: self
        character(len=*), intent(in) :: key
        real(real32), intent(in) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%set_real64(key, real(value, real64), stat, errmsg)
    end subroutine set_real32

    subroutine set_text(self, key, value, stat, errmsg)
        class(plm_settable), intent(inout) :: self
        character(len=*), intent(in) :: key, value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        select case (self%kind)
        case (PLM_KIND_MODEL)
            status = plm_model_set_string(self%handle, c_text(key), c_text(value))
        case (PLM_KIND_SAMPLER)
            status = plm_sampler_set_string(self%handle, c_text(key), c_text(value))
        case (PLM_KIND_BASIS)
            status = plm_basis_set_string(self%handle, c_text(key), c_text(value))
        case (PLM_KIND_HBM)
            status = plm_hbm_set_string(self%handle, c_text(key), c_text(value))
        case (PLM_KIND_TRANSIENT)
            status = plm_transient_set_string(self%handle, c_text(key), c_text(value))
        case (PLM_KIND_STUDY)
            status = plm_study_set_string(self%handle, c_text(key), c_text(value))
        case default
            status = PLM_ERR_HANDLE
        end select
        call finish(self%context, status, stat, errmsg)
    end subroutine set_text

    subroutine get_int64(self, key, value, stat, errmsg)
        class(plm_readable), intent(in) :: self
        character(len=*), intent(in) :: key
        integer(int64), intent(inout) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        select case (self%kind)
        case (PLM_KIND_MODEL)
            status = plm_model_get_int(self%handle, c_text(key), value)
        case (PLM_KIND_SAMPLER)
            status = plm_sampler_get_int(self%handle, c_text(key), value)
        case (PLM_KIND_BASIS)
            status = plm_basis_get_int(self%handle, c_text(key), value)
        case (PLM_KIND_HBM)
            status = plm_hbm_get_int(self%handle, c_text(key), value)
        case (PLM_KIND_BRANCH)
            status = plm_branch_get_int(self%handle, c_text(key), value)
        case (PLM_KIND_TRANSIENT)
            status = plm_transient_get_int(self%handle, c_text(key), value)
        case (PLM_KIND_STUDY)
            status = plm_study_get_int(self%handle, c_text(key), value)
        case default
            status = PLM_ERR_HANDLE
        end select
        call finish(self%context, status, stat, errmsg)
    end subroutine get_int64

    subroutine get_int32(self, key, value, stat, errmsg)
        class(plm_readable), intent(in) :: self
        character(len=*), intent(in) :: key
        integer(int32), intent(inout) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: wide
        wide = value
        call self%get_int64(key, wide, stat, errmsg)
        value = int(wide, int32)
    end subroutine get_int32

    subroutine get_logical(self, key, value, stat, errmsg)
        class(plm_readable), intent(in) :: self
        character(len=*), intent(in) :: key
        logical, intent(inout) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: wide
        wide = merge(1_int64, 0_int64, value)
        call self%get_int64(key, wide, stat, errmsg)
        value = wide /= 0
    end subroutine get_logical

    subroutine get_real(self, key, value, stat, errmsg)
        class(plm_readable), intent(in) :: self
        character(len=*), intent(in) :: key
        real(real64), intent(inout) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        select case (self%kind)
        case (PLM_KIND_MODEL)
            status = plm_model_get_double(self%handle, c_text(key), value)
        case (PLM_KIND_SAMPLER)
            status = plm_sampler_get_double(self%handle, c_text(key), value)
        case (PLM_KIND_BASIS)
            status = plm_basis_get_double(self%handle, c_text(key), value)
        case (PLM_KIND_HBM)
            status = plm_hbm_get_double(self%handle, c_text(key), value)
        case (PLM_KIND_BRANCH)
            status = plm_branch_get_double(self%handle, c_text(key), value)
        case (PLM_KIND_TRANSIENT)
            status = plm_transient_get_double(self%handle, c_text(key), value)
        case (PLM_KIND_STUDY)
            status = plm_study_get_double(self%handle, c_text(key), value)
        case default
            status = PLM_ERR_HANDLE
        end select
        call finish(self%context, status, stat, errmsg)
    end subroutine get_real

    function copy_text(self, key, capacity, buffer, needed) result(status)
        class(plm_readable), intent(in) :: self
        character(len=*), intent(in) :: key
        integer(int64), intent(in) :: capacity
        character(kind=c_char), intent(inout), optional :: buffer(*)
        integer(int64), intent(inout) :: needed
        integer(plm_status) :: status
        select case (self%kind)
        case (PLM_KIND_MODEL)
            status = plm_model_get_string(self%handle, c_text(key), capacity, buffer, needed)
        case (PLM_KIND_SAMPLER)
            status = plm_sampler_get_string(self%handle, c_text(key), capacity, buffer, needed)
        case (PLM_KIND_BASIS)
            status = plm_basis_get_string(self%handle, c_text(key), capacity, buffer, needed)
        case (PLM_KIND_HBM)
            status = plm_hbm_get_string(self%handle, c_text(key), capacity, buffer, needed)
        case (PLM_KIND_BRANCH)
            status = plm_branch_get_string(self%handle, c_text(key), capacity, buffer, needed)
        case (PLM_KIND_TRANSIENT)
            status = plm_transient_get_string(self%handle, c_text(key), capacity, buffer, needed)
        case (PLM_KIND_STUDY)
            status = plm_study_get_string(self%handle, c_text(key), capacity, buffer, needed)
        case default
            status = PLM_ERR_HANDLE
        end select
    end function copy_text

    subroutine get_text(self, key, value, stat, errmsg)
        class(plm_readable), intent(in) :: self
        character(len=*), intent(in) :: key
        character(len=:), allocatable, intent(inout) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        character(kind=c_char, len=:), allocatable :: buffer
        integer(plm_status) :: status
        integer(int64) :: needed
        needed = 0
        status = copy_text(self, key, 0_int64, needed=needed)
        if (status >= 0) then
            allocate (character(kind=c_char, len=needed) :: buffer)
            status = copy_text(self, key, needed, buffer, needed)
        end if
        if (status >= 0) value = f_text(buffer)
        call finish(self%context, status, stat, errmsg)
    end subroutine get_text

    function copy_reals(self, key, capacity, values, n) result(status)
        class(plm_readable), intent(in) :: self
        character(len=*), intent(in) :: key
        integer(int64), intent(in) :: capacity
        real(real64), intent(inout), optional :: values(*)
        integer(int64), intent(inout) :: n
        integer(plm_status) :: status
        select case (self%kind)
        case (PLM_KIND_MODEL)
            status = plm_model_get_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_SAMPLER)
            status = plm_sampler_get_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_BASIS)
            status = plm_basis_get_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_BRANCH)
            status = plm_branch_get_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_TRANSIENT)
            status = plm_transient_get_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_STUDY)
            status = plm_study_get_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_HBM)
            status = PLM_ERR_KEY ! has no arrays
        case default
            status = PLM_ERR_HANDLE
        end select
    end function copy_reals

    subroutine get_reals(self, key, value, stat, errmsg)
        class(plm_readable), intent(in) :: self
        character(len=*), intent(in) :: key
        real(real64), allocatable, intent(inout) :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64), allocatable :: values(:)
        integer(plm_status) :: status
        integer(int64) :: n
        n = 0
        status = copy_reals(self, key, 0_int64, n=n)
        if (status >= 0) then
            allocate (values(n))
            if (n > 0) status = copy_reals(self, key, n, values, n)
        end if
        if (status >= 0) call move_alloc(values, value)
        call finish(self%context, status, stat, errmsg)
    end subroutine get_reals

    function copy_ints(self, key, capacity, values, n) result(status)
        class(plm_readable), intent(in) :: self
        character(len=*), intent(in) :: key
        integer(int64), intent(in) :: capacity
        integer(int64), intent(inout), optional :: values(*)
        integer(int64), intent(inout) :: n
        integer(plm_status) :: status
        select case (self%kind)
        case (PLM_KIND_MODEL)
            status = plm_model_get_int_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_SAMPLER)
            status = plm_sampler_get_int_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_BASIS)
            status = plm_basis_get_int_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_BRANCH)
            status = plm_branch_get_int_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_TRANSIENT)
            status = plm_transient_get_int_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_STUDY)
            status = plm_study_get_int_array(self%handle, c_text(key), capacity, values, n)
        case (PLM_KIND_HBM)
            status = PLM_ERR_KEY
        case default
            status = PLM_ERR_HANDLE
        end select
    end function copy_ints

    subroutine get_ints64(self, key, value, stat, errmsg)
        class(plm_readable), intent(in) :: self
        character(len=*), intent(in) :: key
        integer(int64), allocatable, intent(inout) :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64), allocatable :: values(:)
        integer(plm_status) :: status
        integer(int64) :: n
        n = 0
        status = copy_ints(self, key, 0_int64, n=n)
        if (status >= 0) then
            allocate (values(n))
            if (n > 0) status = copy_ints(self, key, n, values, n)
        end if
        if (status >= 0) call move_alloc(values, value)
        call finish(self%context, status, stat, errmsg)
    end subroutine get_ints64

    subroutine get_ints32(self, key, value, stat, errmsg)
        class(plm_readable), intent(in) :: self
        character(len=*), intent(in) :: key
        integer(int32), allocatable, intent(inout) :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64), allocatable :: wide(:)
        call self%get_ints64(key, wide, stat, errmsg)
        if (allocated(wide)) value = int(wide, int32)
    end subroutine get_ints32

end module plm_keyed_handles
