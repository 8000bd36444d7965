! plm_reduction.f90: the sampler of contact sets, and the bases made from it.
module plm_reductions
    use, intrinsic :: iso_c_binding, only: c_ptr, c_int32_t, c_funloc, c_loc, c_null_ptr
    use, intrinsic :: iso_fortran_env, only: int8, int64, real64
    use plm_constants
    use plm_c
    use plm_errors, only: finish
    use plm_methods, only: plm_sampler_methods, plm_basis_methods
    use plm_contexts, only: plm_context, plm_writer, writer_box, forward_bytes
    use plm_models, only: plm_model
    use plm_branches, only: plm_branch, get_handles
    implicit none
    private
    public :: plm_sampler, plm_basis

    type, extends(plm_sampler_methods) :: plm_sampler
    contains
        procedure :: create => sampler_create
        procedure :: destroy => sampler_destroy
        procedure :: add_dominant_mode
        procedure :: run
    end type plm_sampler

    type, extends(plm_basis_methods) :: plm_basis
    contains
        procedure :: create => basis_create
        procedure :: destroy => basis_destroy
        procedure :: set_responses
        procedure :: build
        procedure :: vectors
        procedure :: residual
        procedure :: to_bytes => basis_to_bytes
        procedure :: write_to => basis_write_to
        procedure :: read => basis_read
        procedure :: read_branch
    end type plm_basis

contains

    subroutine sampler_create(self, model, stat, errmsg)
        class(plm_sampler), intent(inout) :: self
        type(plm_model), intent(in) :: model
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        self%context = model%context
        self%kind = PLM_KIND_SAMPLER
        call finish(self%context, plm_sampler_create(model%handle, self%handle), stat, errmsg)
    end subroutine sampler_create

    subroutine sampler_destroy(self, stat, errmsg)
        class(plm_sampler), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_sampler_destroy(self%handle), stat, errmsg)
    end subroutine sampler_destroy

    ! system: PLM_SYSTEM_OPEN, _SLIDING or _REST; mode: 1, 2, ...
    subroutine add_dominant_mode(self, system, mode, stat, errmsg)
        class(plm_sampler), intent(inout) :: self
        integer(plm_status), intent(in) :: system
        integer, intent(in) :: mode
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_sampler_add_dominant_mode(self%handle, system, int(mode, int64)), stat, errmsg)
    end subroutine add_dominant_mode

    subroutine run(self, stat, errmsg)
        class(plm_sampler), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_sampler_run(self%handle), stat, errmsg)
    end subroutine run

    subroutine basis_create(self, model, stat, errmsg)
        class(plm_basis), intent(inout) :: self
        type(plm_model), intent(in) :: model
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        self%context = model%context
        self%kind = PLM_KIND_BASIS
        call finish(self%context, plm_basis_create(model%handle, self%handle), stat, errmsg)
    end subroutine basis_create

    subroutine basis_destroy(self, stat, errmsg)
        class(plm_basis), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_basis_destroy(self%handle), stat, errmsg)
    end subroutine basis_destroy

    ! For kind pod: curves computed on the parent, whose motions span the basis; absent: none. They are read here and may
    ! be destroyed afterwards.
    subroutine set_responses(self, branches, stat, errmsg)
        class(plm_basis), intent(inout) :: self
        type(plm_branch), intent(in), optional :: branches(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        type(c_ptr), allocatable :: curves(:)
        call get_handles(curves, branches)
        call finish(self%context, plm_basis_set_responses(self%handle, size(curves, kind=int64), curves), stat, errmsg)
    end subroutine set_responses

    subroutine build(self, stat, errmsg)
        class(plm_basis), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_basis_build(self%handle), stat, errmsg)
    end subroutine build

    ! vector: n_dof x n receives the columns first, first + 1, ... (from 1) of P, or of P_0 when static is .true.
    subroutine vectors(self, vector, first, static, stat, errmsg)
        class(plm_basis), intent(inout) :: self
        real(real64), intent(inout), contiguous :: vector(:, :)
        integer, intent(in), optional :: first
        logical, intent(in), optional :: static
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: from
        from = 0
        if (present(first)) from = int(first, int64) - 1
        call finish(self%context, plm_basis_get_vectors(self%handle, flag(static), from, &
            size(vector, 2, int64), vector, size(vector, 1, int64)), stat, errmsg)
    end subroutine vectors

    ! How badly the basis represents q: |q - P eta| / |q| by least squares, in the norm of M when use_mass is .true.
    subroutine residual(self, q, r, static, use_mass, stat, errmsg)
        class(plm_basis), intent(inout) :: self
        real(real64), intent(in), contiguous :: q(:)
        real(real64), intent(inout) :: r
        logical, intent(in), optional :: static, use_mass
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_basis_get_residual(self%handle, flag(static), flag(use_mass), &
            size(q, kind=int64), q, r), stat, errmsg)
    end subroutine residual

    ! All that curves need of the basis, to be kept in a file (open it with access='stream').
    subroutine basis_to_bytes(self, bytes, stat, errmsg)
        class(plm_basis), intent(in) :: self
        integer(int8), allocatable, target, intent(inout) :: bytes(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: needed
        integer(plm_status) :: status
        status = plm_basis_write(self%handle, 0_int64, c_null_ptr, needed)
        if (status >= 0) then
            if (allocated(bytes)) deallocate (bytes)
            allocate (bytes(needed))
            status = plm_basis_write(self%handle, needed, c_loc(bytes), needed)
        end if
        call finish(self%context, status, stat, errmsg)
    end subroutine basis_to_bytes

    ! The same bytes to the writer, piece after piece.
    subroutine basis_write_to(self, writer, stat, errmsg)
        class(plm_basis), intent(in) :: self
        class(plm_writer), intent(inout), target :: writer
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        type(writer_box), target :: box
        box%writer => writer
        call finish(self%context, plm_basis_write_to(self%handle, c_funloc(forward_bytes), c_loc(box)), stat, errmsg)
    end subroutine basis_write_to

    ! In the place of create and build: the basis that to_bytes gave, without its model until attach.
    subroutine basis_read(self, context, bytes, stat, errmsg)
        class(plm_basis), intent(inout) :: self
        type(plm_context), intent(in) :: context
        integer(int8), contiguous, target, intent(in) :: bytes(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        self%context = context%handle
        self%kind = PLM_KIND_BASIS
        call finish(self%context, plm_basis_read(context%handle, size(bytes, kind=int64), c_loc(bytes), self%handle), &
            stat, errmsg)
    end subroutine basis_read

    ! A branch from what its to_bytes gave, on this basis, which it was computed on.
    subroutine read_branch(self, bytes, branch, stat, errmsg)
        class(plm_basis), intent(in) :: self
        integer(int8), contiguous, target, intent(in) :: bytes(:)
        type(plm_branch), intent(inout) :: branch
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        branch%context = self%context
        branch%kind = PLM_KIND_BRANCH
        call finish(self%context, plm_branch_read(self%handle, size(bytes, kind=int64), c_loc(bytes), branch%handle), &
            stat, errmsg)
    end subroutine read_branch

    pure integer(c_int32_t) function flag(given)
        logical, intent(in), optional :: given
        flag = 0
        if (present(given)) flag = merge(1_c_int32_t, 0_c_int32_t, given)
    end function flag

end module plm_reductions
