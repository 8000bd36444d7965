! plm_mpi.f90: a team of MPI ranks (plm_mpi.h) beside the module plm. It needs no module of MPI: the communicator is an integer,
! that of mpif.h and of the module mpi, or comm%mpi_val of mpi_f08.
!
!     call team%create(comm%mpi_val, n_dof)                    all ranks
!     call team%own_dofs(dof), add_entries, fix_dofs ...       all ranks, each its own part
!     if (rank == 0) then
!         call team%create_model(context, model)               then model%build() ... as ever
!         call team%dismiss(stat)
!     else
!         call team%serve(stat)                                until rank 0 dismisses
!     end if
!     call team%destroy()                                      all ranks
!
! DOFs and gap rows count from 1; integer arrays are of either kind. Without stat a failure ends the program, as in the module
! plm. On one rank of several that leaves the others to MPI's launcher: give stat.
module plm_mpi
    use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_double, c_f_pointer, c_funloc, c_funptr, c_int32_t, c_int64_t, &
        c_loc, c_null_char, c_null_funptr, c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int32, int64, real64
    use plm_constants
    use plm_c, only: plm_status_text
    use plm_mpi_c
    use plm_errors, only: f_text, finish_with, refuse
    use plm_contexts, only: plm_context
    use plm_models, only: plm_model
    implicit none
    private
    public :: plm_team, plm_receiver

    ! Extend it to receive fields: the values at the DOFs that this rank owns, ascending. failed is .false. on entry.
    type, abstract :: plm_receiver
    contains
        procedure(receive_procedure), deferred :: receive
    end type plm_receiver
    abstract interface
        subroutine receive_procedure(self, dof, value, failed)
            import :: int64, plm_receiver, real64
            implicit none
            class(plm_receiver), intent(inout) :: self
            integer(int64), intent(in) :: dof(:)
            real(real64), intent(in) :: value(:)
            logical, intent(inout) :: failed
        end subroutine receive_procedure
    end interface
    type :: receiver_box
        class(plm_receiver), pointer :: receiver => null()
    end type receiver_box

    type :: plm_team
        type(c_ptr) :: handle = c_null_ptr
        integer, private :: n_dof = 0
        type(receiver_box), pointer, private :: box => null()
    contains
        procedure :: create
        procedure :: destroy
        procedure, private :: own_dofs_int32, own_dofs_int64, add_entries_int32, add_entries_int64
        procedure, private :: fix_dofs_int32, fix_dofs_int64, add_gap_rows_int32, add_gap_rows_int64
        procedure, private :: add_preload_int32, add_preload_int64, add_excitation_int32, add_excitation_int64
        generic :: own_dofs => own_dofs_int32, own_dofs_int64
        generic :: add_entries => add_entries_int32, add_entries_int64
        generic :: fix_dofs => fix_dofs_int32, fix_dofs_int64
        generic :: add_gap_rows => add_gap_rows_int32, add_gap_rows_int64
        generic :: add_preload => add_preload_int32, add_preload_int64
        generic :: add_excitation => add_excitation_int32, add_excitation_int64
        procedure :: set_field
        procedure :: create_model
        procedure :: deliver
        procedure :: dismiss
        procedure :: serve
        procedure, private :: finish
    end type plm_team

contains

    ! communicator: collective over its ranks, and duplicated
    subroutine create(self, communicator, n_dof, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer, intent(in) :: communicator, n_dof
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        self%n_dof = n_dof
        self%handle = c_null_ptr
        call self%finish(plm_team_create(int(communicator, c_int32_t), int(n_dof, int64), self%handle), stat, errmsg)
    end subroutine create

    ! collective
    subroutine destroy(self, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%finish(plm_team_destroy(self%handle), stat, errmsg)
        if (associated(self%box)) deallocate (self%box)
    end subroutine destroy

    ! each DOF has one owner in the end
    subroutine own_dofs_int64(self, dof, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer(int64), intent(in), contiguous :: dof(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%finish(plm_team_own_dofs_i64(self%handle, 1_c_int32_t, size(dof, kind=int64), dof), stat, errmsg)
    end subroutine own_dofs_int64

    subroutine own_dofs_int32(self, dof, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dof(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%own_dofs(int(dof, int64), stat, errmsg)
    end subroutine own_dofs_int32

    ! which: PLM_MASS, PLM_STIFFNESS, PLM_DAMPING; part: PLM_FULL, PLM_LOWER, PLM_UPPER. Entries as this rank has
    ! assembled them, of any DOFs: those of one place are summed, over calls and ranks.
    subroutine add_entries_int64(self, which, part, row, column, value, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer(plm_status), intent(in) :: which
        integer(plm_status), intent(in) :: part
        integer(int64), intent(in), contiguous :: row(:)
        integer(int64), intent(in), contiguous :: column(:)
        real(real64), intent(in), contiguous :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(row) /= size(value) .or. size(column) /= size(value)) then
            call refuse('add_entries: the lengths of the arrays do not fit', stat, errmsg)
            return
        end if
        call self%finish(plm_team_add_entries_i64(self%handle, which, part, 1_c_int32_t, size(value, kind=int64), row, &
            column, value), stat, errmsg)
    end subroutine add_entries_int64

    subroutine add_entries_int32(self, which, part, row, column, value, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer(plm_status), intent(in) :: which
        integer(plm_status), intent(in) :: part
        integer(int32), intent(in), contiguous :: row(:)
        integer(int32), intent(in), contiguous :: column(:)
        real(real64), intent(in), contiguous :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%add_entries(which, part, int(row, int64), int(column, int64), value, stat, errmsg)
    end subroutine add_entries_int32

    ! held at zero; by any rank
    subroutine fix_dofs_int64(self, dof, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer(int64), intent(in), contiguous :: dof(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%finish(plm_team_fix_dofs_i64(self%handle, 1_c_int32_t, size(dof, kind=int64), dof), stat, errmsg)
    end subroutine fix_dofs_int64

    subroutine fix_dofs_int32(self, dof, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dof(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%fix_dofs(int(dof, int64), stat, errmsg)
    end subroutine fix_dofs_int32

    ! row_ptr(n + 1) from 1; dof, coefficient(row_ptr(n + 1) - 1); stiffness, gap(n)
    subroutine add_gap_rows_int64(self, row_ptr, dof, coefficient, stiffness, gap, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer(int64), intent(in), contiguous :: row_ptr(:)
        integer(int64), intent(in), contiguous :: dof(:)
        real(real64), intent(in), contiguous :: coefficient(:)
        real(real64), intent(in), contiguous :: stiffness(:)
        real(real64), intent(in), contiguous :: gap(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(row_ptr) /= size(stiffness) + 1 .or. size(gap) /= size(stiffness) .or. size(dof) /= size(coefficient)) then
            call refuse('add_gap_rows: the lengths of the arrays do not fit', stat, errmsg)
            return
        end if
        call self%finish(plm_team_add_gap_rows_i64(self%handle, 1_c_int32_t, size(stiffness, kind=int64), row_ptr - 1, &
            dof, coefficient, stiffness, gap), stat, errmsg)
    end subroutine add_gap_rows_int64

    subroutine add_gap_rows_int32(self, row_ptr, dof, coefficient, stiffness, gap, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer(int32), intent(in), contiguous :: row_ptr(:)
        integer(int32), intent(in), contiguous :: dof(:)
        real(real64), intent(in), contiguous :: coefficient(:)
        real(real64), intent(in), contiguous :: stiffness(:)
        real(real64), intent(in), contiguous :: gap(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%add_gap_rows(int(row_ptr, int64), int(dof, int64), coefficient, stiffness, gap, stat, errmsg)
    end subroutine add_gap_rows_int32

    ! static; what comes for one DOF is summed
    subroutine add_preload_int64(self, dof, force, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer(int64), intent(in), contiguous :: dof(:)
        real(real64), intent(in), contiguous :: force(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(dof) /= size(force)) then
            call refuse('add_preload: the lengths of the arrays do not fit', stat, errmsg)
            return
        end if
        call self%finish(plm_team_add_preload_i64(self%handle, 1_c_int32_t, size(force, kind=int64), dof, force), stat, errmsg)
    end subroutine add_preload_int64

    subroutine add_preload_int32(self, dof, force, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dof(:)
        real(real64), intent(in), contiguous :: force(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%add_preload(int(dof, int64), force, stat, errmsg)
    end subroutine add_preload_int32

    ! a harmonic from 0 on: real_part cos - imag_part sin, as plm_model%set_excitation
    subroutine add_excitation_int64(self, harmonic, dof, real_part, imag_part, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer, intent(in) :: harmonic
        integer(int64), intent(in), contiguous :: dof(:)
        real(real64), intent(in), contiguous :: real_part(:)
        real(real64), intent(in), contiguous, optional :: imag_part(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(dof) /= size(real_part)) then
            call refuse('add_excitation: the lengths of the arrays do not fit', stat, errmsg)
            return
        end if
        call self%finish(plm_team_add_excitation_i64(self%handle, int(harmonic, c_int32_t), 1_c_int32_t, &
            size(dof, kind=int64), dof, real_part, imag_part), stat, errmsg)
    end subroutine add_excitation_int64

    subroutine add_excitation_int32(self, harmonic, dof, real_part, imag_part, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer, intent(in) :: harmonic
        integer(int32), intent(in), contiguous :: dof(:)
        real(real64), intent(in), contiguous :: real_part(:)
        real(real64), intent(in), contiguous, optional :: imag_part(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%add_excitation(harmonic, int(dof, int64), real_part, imag_part, stat, errmsg)
    end subroutine add_excitation_int32

    ! receiver must live (target or pointer) until the team is destroyed or set_field is called again; absent: nobody
    subroutine set_field(self, receiver, stat, errmsg)
        class(plm_team), intent(inout) :: self
        class(plm_receiver), intent(inout), target, optional :: receiver
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        if (present(receiver)) then
            if (.not. associated(self%box)) allocate (self%box)
            self%box%receiver => receiver
            status = plm_team_set_field(self%handle, c_funloc(forward_field), c_loc(self%box))
        else
            status = plm_team_set_field(self%handle, c_null_funptr, c_null_ptr)
        end if
        call self%finish(status, stat, errmsg)
    end subroutine set_field

    ! rank 0
    subroutine create_model(self, context, model, stat, errmsg)
        class(plm_team), intent(inout) :: self
        type(plm_context), intent(in) :: context
        type(plm_model), intent(inout) :: model
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        type(c_ptr) :: made
        integer(plm_status) :: status
        made = c_null_ptr
        status = plm_team_create_model(self%handle, context%handle, made)
        if (status >= 0) call model%adopt(context, made, self%n_dof)
        call self%finish(status, stat, errmsg)
    end subroutine create_model

    ! rank 0: each rank's receiver gets its part of value(n_dof)
    subroutine deliver(self, value, stat, errmsg)
        class(plm_team), intent(inout) :: self
        real(real64), intent(in), contiguous :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%finish(plm_team_deliver(self%handle, size(value, kind=int64), value), stat, errmsg)
    end subroutine deliver

    ! rank 0: outcome is the status with which the others come back, PLM_OK if absent
    subroutine dismiss(self, outcome, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer, intent(in), optional :: outcome
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: told
        told = PLM_OK
        if (present(outcome)) told = int(outcome, plm_status)
        call self%finish(plm_team_dismiss(self%handle, told), stat, errmsg)
    end subroutine dismiss

    ! the other ranks: stat is what rank 0 gave as outcome
    subroutine serve(self, stat, errmsg)
        class(plm_team), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call self%finish(plm_team_serve(self%handle), stat, errmsg)
    end subroutine serve

    ! The team's own text; what the status says by itself where the team has none.
    subroutine finish(self, status, stat, errmsg)
        class(plm_team), intent(in) :: self
        integer(plm_status), intent(in) :: status
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        character(kind=c_char, len=2048) :: buffer
        integer(plm_status) :: code
        buffer = c_null_char
        if (status /= PLM_OK) code = plm_team_get_error_text(self%handle, len(buffer, int64), buffer)
        if (buffer(1:1) == c_null_char) code = plm_status_text(status, len(buffer, int64), buffer)
        call finish_with(f_text(buffer), status, stat, errmsg)
    end subroutine finish

    integer(c_int32_t) function forward_field(team, n, dof, value, user) bind(c, name='') result(code)
        type(c_ptr), value :: team, user
        integer(c_int64_t), value :: n
        integer(c_int64_t), intent(in) :: dof(n)
        real(c_double), intent(in) :: value(n)
        type(receiver_box), pointer :: box
        logical :: failed
        call c_f_pointer(user, box)
        failed = .not. c_associated(team)
        if (.not. failed) call box%receiver%receive(dof + 1, value, failed)
        code = merge(1_c_int32_t, 0_c_int32_t, failed)
    end function forward_field

end module plm_mpi
