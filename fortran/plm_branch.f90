! plm_branch.f90: the response curves that harmonic balance follows. DOFs, points and pairs count from 1.
module plm_branches
    use, intrinsic :: iso_c_binding, only: c_char, c_ptr, c_funloc, c_int32_t, c_loc, c_null_char, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int8, int64, real64
    use plm_constants
    use plm_c
    use plm_contexts, only: plm_writer, writer_box, forward_bytes
    use plm_errors, only: finish, f_text
    use plm_methods, only: plm_branch_methods
    use plm_models, only: plm_model
    implicit none
    private
    public :: plm_branch, measure_of, harmonic_of, get_handles

    type, extends(plm_branch_methods) :: plm_branch
    contains
        procedure :: destroy => branch_destroy
        procedure :: amplitude
        procedure :: recovered_amplitude
        procedure :: coefficients
        procedure :: contact
        procedure :: closed_share
        procedure :: energy
        procedure :: multipliers
        procedure :: to_bytes => branch_to_bytes
        procedure :: write_to => branch_write_to
        procedure :: write_csv
        procedure :: write_csv_to
        procedure :: describe
    end type plm_branch

contains

    pure integer(c_int32_t) function measure_of(measure)
        integer(plm_status), intent(in), optional :: measure
        measure_of = PLM_HALF_PEAK_TO_PEAK ! as in C++ and Python
        if (present(measure)) measure_of = measure
    end function measure_of

    pure integer(c_int32_t) function harmonic_of(harmonic)
        integer, intent(in), optional :: harmonic
        harmonic_of = 1
        if (present(harmonic)) harmonic_of = int(harmonic, c_int32_t)
    end function harmonic_of

    subroutine branch_destroy(self, stat, errmsg)
        class(plm_branch), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_branch_destroy(self%handle), stat, errmsg)
    end subroutine branch_destroy

    ! Points and ending, to be kept in a file (open it with access='stream') and read by read_branch of the basis.
    subroutine branch_to_bytes(self, bytes, stat, errmsg)
        class(plm_branch), intent(in) :: self
        integer(int8), allocatable, target, intent(inout) :: bytes(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: needed
        integer(plm_status) :: status
        status = plm_branch_write(self%handle, 0_int64, c_null_ptr, needed)
        if (status >= 0) then
            if (allocated(bytes)) deallocate (bytes)
            allocate (bytes(needed))
            status = plm_branch_write(self%handle, needed, c_loc(bytes), needed)
        end if
        call finish(self%context, status, stat, errmsg)
    end subroutine branch_to_bytes

    ! The same bytes to the writer, piece after piece.
    subroutine branch_write_to(self, writer, stat, errmsg)
        class(plm_branch), intent(in) :: self
        class(plm_writer), intent(inout), target :: writer
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        type(writer_box), target :: box
        box%writer => writer
        call finish(self%context, plm_branch_write_to(self%handle, c_funloc(forward_bytes), c_loc(box)), stat, errmsg)
    end subroutine branch_write_to

    ! The curve as a file of comma-separated text, replaced as a whole.
    subroutine write_csv(self, path, dof, measure, harmonic, stat, errmsg)
        class(plm_branch), intent(in) :: self
        character(len=*), intent(in) :: path
        integer, intent(in) :: dof
        integer(plm_status), intent(in), optional :: measure
        integer, intent(in), optional :: harmonic
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_branch_write_csv(self%handle, int(dof, int64) - 1, measure_of(measure), &
            harmonic_of(harmonic), trim(path)//c_null_char), stat, errmsg)
    end subroutine write_csv

    ! The same text to the writer.
    subroutine write_csv_to(self, writer, dof, measure, harmonic, stat, errmsg)
        class(plm_branch), intent(in) :: self
        class(plm_writer), intent(inout), target :: writer
        integer, intent(in) :: dof
        integer(plm_status), intent(in), optional :: measure
        integer, intent(in), optional :: harmonic
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        type(writer_box), target :: box
        box%writer => writer
        call finish(self%context, plm_branch_write_csv_to(self%handle, int(dof, int64) - 1, measure_of(measure), &
            harmonic_of(harmonic), c_funloc(forward_bytes), c_loc(box)), stat, errmsg)
    end subroutine write_csv_to

    ! A page of text about the curve: peak, stability, error, warnings and the rest; lines end with new_line('a').
    subroutine describe(self, value, stat, errmsg)
        class(plm_branch), intent(in) :: self
        character(len=:), allocatable, intent(inout) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        character(kind=c_char, len=:), allocatable :: buffer
        integer(plm_status) :: status
        integer(int64) :: needed
        needed = 0
        status = plm_branch_describe(self%handle, 0_int64, needed=needed)
        if (status >= 0) then
            allocate (character(kind=c_char, len=needed) :: buffer)
            status = plm_branch_describe(self%handle, needed, buffer, needed)
        end if
        if (status >= 0) value = f_text(buffer)
        call finish(self%context, status, stat, errmsg)
    end subroutine describe

    ! value(n_points); measure: PLM_HALF_PEAK_TO_PEAK (if absent), PLM_PEAK, PLM_RMS, PLM_HARMONIC (of `harmonic`, 1 if
    ! absent)
    subroutine amplitude(self, dof, value, measure, harmonic, stat, errmsg)
        class(plm_branch), intent(in) :: self
        integer, intent(in) :: dof
        real(real64), allocatable, intent(inout) :: value(:)
        integer(plm_status), intent(in), optional :: measure
        integer, intent(in), optional :: harmonic
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64), allocatable :: found(:)
        integer(plm_status) :: status
        integer(int64) :: n
        status = size_by_key(self, 'n_points', n)
        allocate (found(n))
        if (status >= 0) status = plm_branch_get_amplitude(self%handle, int(dof, int64) - 1, measure_of(measure), &
            harmonic_of(harmonic), n, found, n)
        if (status >= 0) call move_alloc(found, value)
        call finish(self%context, status, stat, errmsg)
    end subroutine amplitude

    ! The same of a DOF of the structure that the model, a superelement with a recovery, was reduced from.
    subroutine recovered_amplitude(self, model, full_dof, value, measure, harmonic, stat, errmsg)
        class(plm_branch), intent(in) :: self
        type(plm_model), intent(in) :: model
        integer, intent(in) :: full_dof
        real(real64), allocatable, intent(inout) :: value(:)
        integer(plm_status), intent(in), optional :: measure
        integer, intent(in), optional :: harmonic
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64), allocatable :: found(:)
        integer(plm_status) :: status
        integer(int64) :: n
        status = size_by_key(self, 'n_points', n)
        allocate (found(n))
        if (status >= 0) status = plm_model_recover_amplitude(model%handle, self%handle, int(full_dof, int64) - 1, &
            measure_of(measure), harmonic_of(harmonic), n, found, n)
        if (status >= 0) call move_alloc(found, value)
        call finish(self%context, status, stat, errmsg)
    end subroutine recovered_amplitude

    ! value(2 H + 1, n): a0, a1, b1, ..., aH, bH of the DOFs first_dof, ..., first_dof + n - 1 (n is 1 if absent)
    subroutine coefficients(self, point, first_dof, value, n, stat, errmsg)
        class(plm_branch), intent(in) :: self
        integer, intent(in) :: point, first_dof
        real(real64), allocatable, intent(inout) :: value(:, :)
        integer, intent(in), optional :: n
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64), allocatable :: found(:, :)
        integer(plm_status) :: status
        integer(int64) :: h, count
        count = 1
        if (present(n)) count = n
        status = size_by_key(self, 'n_harmonics', h)
        allocate (found(2*h + 1, max(count, 0_int64)))
        if (status >= 0) status = plm_branch_get_coefficients(self%handle, int(point, int64) - 1, &
            int(first_dof, int64) - 1, count, found)
        if (status >= 0) call move_alloc(found, value)
        call finish(self%context, status, stat, errmsg)
    end subroutine coefficients

    ! At n_times equidistant times from 0, each n_pairs x n_times.
    subroutine contact(self, point, n_times, penetration, force, closed, stat, errmsg)
        class(plm_branch), intent(in) :: self
        integer, intent(in) :: point, n_times
        real(real64), allocatable, intent(inout), optional :: penetration(:, :), force(:, :)
        logical, allocatable, intent(inout), optional :: closed(:, :)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64), allocatable :: u(:, :), f(:, :)
        integer(c_int32_t), allocatable :: flags(:, :)
        integer(plm_status) :: status
        integer(int64) :: pairs
        integer :: times
        status = size_by_key(self, 'n_pairs', pairs)
        times = max(n_times, 0)
        allocate (u(pairs, times), f(pairs, times), flags(pairs, times))
        if (status >= 0) status = plm_branch_get_contact(self%handle, int(point, int64) - 1, int(n_times, int64), &
            u, f, flags)
        if (status >= 0) then
            if (present(penetration)) call move_alloc(u, penetration)
            if (present(force)) call move_alloc(f, force)
            if (present(closed)) closed = flags /= 0
        end if
        call finish(self%context, status, stat, errmsg)
    end subroutine contact

    ! share(n_pairs): the part of the period during which each pair is closed
    subroutine closed_share(self, point, share, stat, errmsg)
        class(plm_branch), intent(in) :: self
        integer, intent(in) :: point
        real(real64), allocatable, intent(inout) :: share(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64), allocatable :: found(:)
        integer(plm_status) :: status
        integer(int64) :: pairs
        status = size_by_key(self, 'n_pairs', pairs)
        allocate (found(pairs))
        if (status >= 0) status = plm_branch_get_closed_share(self%handle, int(point, int64) - 1, pairs, found)
        if (status >= 0) call move_alloc(found, share)
        call finish(self%context, status, stat, errmsg)
    end subroutine closed_share

    ! mean mechanical energy over the period, less that of the structure at rest, and mean closed share of the pairs
    subroutine energy(self, point, mean_energy, contact_area, stat, errmsg)
        class(plm_branch), intent(in) :: self
        integer, intent(in) :: point
        real(real64), intent(inout), optional :: mean_energy, contact_area
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_branch_get_energy(self%handle, int(point, int64) - 1, mean_energy, contact_area), &
            stat, errmsg)
    end subroutine energy

    ! Floquet multipliers, largest modulus first; none where they were not computed (option 'stability')
    subroutine multipliers(self, point, value, stat, errmsg)
        class(plm_branch), intent(in) :: self
        integer, intent(in) :: point
        complex(real64), allocatable, intent(inout) :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64), allocatable :: re(:), im(:)
        integer(plm_status) :: status
        integer(int64) :: n
        n = 0
        status = plm_branch_get_multipliers(self%handle, int(point, int64) - 1, 0_int64, count=n)
        allocate (re(n), im(n))
        if (status >= 0) status = plm_branch_get_multipliers(self%handle, int(point, int64) - 1, n, re, im, n)
        if (status >= 0) value = cmplx(re, im, real64)
        call finish(self%context, status, stat, errmsg)
    end subroutine multipliers

    ! n is 0 on failure
    function size_by_key(self, key, n) result(status)
        class(plm_branch), intent(in) :: self
        character(len=*), intent(in) :: key
        integer(int64), intent(out) :: n
        integer(plm_status) :: status
        n = 0
        status = plm_branch_get_int(self%handle, key//char(0), n)
        if (status < 0) n = 0
    end function size_by_key

    ! none when the branches are absent
    subroutine get_handles(handles, branches)
        type(c_ptr), allocatable, intent(out) :: handles(:)
        type(plm_branch), intent(in), optional :: branches(:)
        integer :: i, n
        n = 0
        if (present(branches)) n = size(branches)
        allocate (handles(n))
        do i = 1, n
            handles(i) = branches(i)%handle
        end do
    end subroutine get_handles

end module plm_branches
