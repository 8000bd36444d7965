! plm_study.f90: error against run time of several ways to one response curve. DOFs, methods and force levels count from
! 1; method 0 is the reference.
module plm_studies
    use, intrinsic :: iso_c_binding, only: c_char
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_constants
    use plm_c
    use plm_errors, only: finish, c_text, f_text
    use plm_methods, only: plm_study_methods
    use plm_models, only: plm_model
    use plm_branches, only: plm_branch, measure_of, harmonic_of
    use plm_responses, only: plm_hbm
    use plm_motions, only: plm_transient
    implicit none
    private
    public :: plm_study

    ! Results by get are arrays with one entry per method: 'curve_error_l2', 'setup_seconds', 'basis_size', 'pareto' ...
    type, extends(plm_study_methods) :: plm_study
    contains
        procedure :: create
        procedure :: destroy
        procedure :: set_output
        procedure :: add_response
        procedure :: add_compressed
        procedure :: add_refined
        procedure :: add_marching
        procedure :: run
        procedure :: name => name_of
        procedure :: outcome
        procedure :: curve
        procedure :: points
        procedure :: write => write_files
    end type plm_study

contains

    subroutine create(self, model, stat, errmsg)
        class(plm_study), intent(inout) :: self
        type(plm_model), intent(in) :: model
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        self%context = model%context
        self%kind = PLM_KIND_STUDY
        call finish(self%context, plm_study_create(model%handle, self%handle), stat, errmsg)
    end subroutine create

    subroutine destroy(self, stat, errmsg)
        class(plm_study), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_study_destroy(self%handle), stat, errmsg)
    end subroutine destroy

    ! The amplitude looked at; must be set. measure: PLM_HALF_PEAK_TO_PEAK (if absent), PLM_PEAK, PLM_RMS, PLM_HARMONIC (of
    ! `harmonic`, 1 if absent).
    subroutine set_output(self, dof, measure, harmonic, stat, errmsg)
        class(plm_study), intent(inout) :: self
        integer, intent(in) :: dof
        integer(plm_status), intent(in), optional :: measure
        integer, intent(in), optional :: harmonic
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_study_set_output(self%handle, int(dof, int64) - 1, measure_of(measure), &
            harmonic_of(harmonic)), stat, errmsg)
    end subroutine set_output

    ! The curve of hbm by the options that it, its basis and its sampler hold now; index: of the method, here and below.
    subroutine add_response(self, name, hbm, index, stat, errmsg)
        class(plm_study), intent(inout) :: self
        character(len=*), intent(in) :: name
        type(plm_hbm), intent(in) :: hbm
        integer, intent(inout), optional :: index
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: at
        integer(plm_status) :: status
        at = 0
        status = plm_study_add_response(self%handle, c_text(name), hbm%handle, at)
        call added(self, status, at, index, stat, errmsg)
    end subroutine add_response

    ! The same on a basis of `columns` columns (by the 'pod_tolerance' of its basis, if absent) compressed from that response.
    subroutine add_compressed(self, name, hbm, columns, index, stat, errmsg)
        class(plm_study), intent(inout) :: self
        character(len=*), intent(in) :: name
        type(plm_hbm), intent(in) :: hbm
        integer, intent(in), optional :: columns
        integer, intent(inout), optional :: index
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: at, wanted
        integer(plm_status) :: status
        at = 0
        wanted = 0
        if (present(columns)) wanted = columns
        status = plm_study_add_compressed(self%handle, c_text(name), hbm%handle, wanted, at)
        call added(self, status, at, index, stat, errmsg)
    end subroutine add_compressed

    ! The same on the basis that hbm%refine_basis makes for `tolerance`.
    subroutine add_refined(self, name, hbm, tolerance, index, stat, errmsg)
        class(plm_study), intent(inout) :: self
        character(len=*), intent(in) :: name
        type(plm_hbm), intent(in) :: hbm
        real(real64), intent(in) :: tolerance
        integer, intent(inout), optional :: index
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: at
        integer(plm_status) :: status
        at = 0
        status = plm_study_add_refined(self%handle, c_text(name), hbm%handle, tolerance, at)
        call added(self, status, at, index, stat, errmsg)
    end subroutine add_refined

    ! Steady states by marching in time at n_frequencies frequencies; give the motion 'settled'.
    subroutine add_marching(self, name, motion, n_frequencies, index, stat, errmsg)
        class(plm_study), intent(inout) :: self
        character(len=*), intent(in) :: name
        type(plm_transient), intent(in) :: motion
        integer, intent(in) :: n_frequencies
        integer, intent(inout), optional :: index
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: at
        integer(plm_status) :: status
        at = 0
        status = plm_study_add_marching(self%handle, c_text(name), motion%handle, int(n_frequencies, int64), at)
        call added(self, status, at, index, stat, errmsg)
    end subroutine add_marching

    ! stat PLM_WARNING: a method failed or ended early, see outcome. PLM_CANCELLED: the methods run until then are there.
    subroutine run(self, stat, errmsg)
        class(plm_study), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_study_run(self%handle), stat, errmsg)
    end subroutine run

    subroutine name_of(self, method, value, stat, errmsg)
        class(plm_study), intent(in) :: self
        integer, intent(in) :: method
        character(len=:), allocatable, intent(inout) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call read_text(self, plm_study_get_name, method, value, stat, errmsg)
    end subroutine name_of

    ! How a method ended in the last run, or why it failed.
    subroutine outcome(self, method, value, stat, errmsg)
        class(plm_study), intent(in) :: self
        integer, intent(in) :: method
        character(len=:), allocatable, intent(inout) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call read_text(self, plm_study_get_outcome, method, value, stat, errmsg)
    end subroutine outcome

    subroutine read_text(self, get, method, value, stat, errmsg)
        class(plm_study), intent(in) :: self
        procedure(plm_study_get_name) :: get
        integer, intent(in) :: method
        character(len=:), allocatable, intent(inout) :: value
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        character(kind=c_char, len=:), allocatable :: buffer
        integer(plm_status) :: status
        integer(int64) :: needed
        needed = 0
        status = get(self%handle, int(method, int64) - 1, 0_int64, needed=needed)
        if (status >= 0) then
            allocate (character(kind=c_char, len=needed) :: buffer)
            status = get(self%handle, int(method, int64) - 1, needed, buffer, needed)
        end if
        if (status >= 0) value = f_text(buffer)
        call finish(self%context, status, stat, errmsg)
    end subroutine read_text

    ! The curve of a method at a force level (the first if absent). A method that marches in time has points only.
    subroutine curve(self, method, branch, level, stat, errmsg)
        class(plm_study), intent(in) :: self
        integer, intent(in) :: method
        type(plm_branch), intent(inout) :: branch
        integer, intent(in), optional :: level
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        branch%context = self%context
        branch%kind = PLM_KIND_BRANCH
        call finish(self%context, plm_study_get_curve(self%handle, int(method, int64) - 1, level_of(level), &
            branch%handle), stat, errmsg)
    end subroutine curve

    ! The same as points: frequency (Hz) and amplitude of the output.
    subroutine points(self, method, frequency_hz, amplitude, level, stat, errmsg)
        class(plm_study), intent(in) :: self
        integer, intent(in) :: method
        real(real64), allocatable, intent(inout) :: frequency_hz(:), amplitude(:)
        integer, intent(in), optional :: level
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        real(real64), allocatable :: hz(:), a(:)
        integer(plm_status) :: status
        integer(int64) :: n, at
        n = 0
        at = int(method, int64) - 1
        status = plm_study_get_points(self%handle, at, level_of(level), 0_int64, count=n)
        allocate (hz(n), a(n))
        if (status >= 0) status = plm_study_get_points(self%handle, at, level_of(level), n, hz, a, n)
        if (status >= 0) then
            call move_alloc(hz, frequency_hz)
            call move_alloc(a, amplitude)
        end if
        call finish(self%context, status, stat, errmsg)
    end subroutine points

    ! report.md, table.csv and a file for every curve, into the folder, which is made if its parent exists.
    subroutine write_files(self, folder, stat, errmsg)
        class(plm_study), intent(in) :: self
        character(len=*), intent(in) :: folder
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_study_write(self%handle, c_text(folder)), stat, errmsg)
    end subroutine write_files

    ! What every add_... does last.
    subroutine added(self, status, at, index, stat, errmsg)
        class(plm_study), intent(in) :: self
        integer(plm_status), intent(in) :: status
        integer(int64), intent(in) :: at
        integer, intent(inout), optional :: index
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (present(index) .and. status >= 0) index = int(at) + 1
        call finish(self%context, status, stat, errmsg)
    end subroutine added

    pure integer(int64) function level_of(level)
        integer, intent(in), optional :: level
        level_of = 0
        if (present(level)) level_of = int(level, int64) - 1
    end function level_of

end module plm_studies
