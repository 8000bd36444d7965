! plm_model.f90: the finite-element model: matrices, supports, contact pairs, loads. DOFs count from 1.
module plm_models
    use, intrinsic :: iso_c_binding, only: c_char, c_funloc, c_int32_t, c_loc, c_null_funptr, c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: int32, int64, real64
    use plm_constants
    use plm_c
    use plm_errors, only: finish, refuse, f_text
    use plm_contexts, only: plm_context, plm_recoverer, recoverer_box, forward_recovery
    use plm_methods, only: plm_model_methods
    implicit none
    private
    public :: plm_model

    ! Integer arrays may be of either kind. Everything is copied: no argument needs to outlive its call.
    type, extends(plm_model_methods) :: plm_model
        integer, private :: n_dof = 0 ! as given to create
        type(recoverer_box), pointer, private :: box => null()
    contains
        procedure :: create
        procedure :: adopt
        procedure :: destroy
        procedure, private :: set_csc_int32, set_csc_int64, set_csr_int32, set_csr_int64
        procedure, private :: set_triplets_int32, set_triplets_int64
        procedure, private :: fix_dofs_int32, fix_dofs_int64, add_node_pairs_int32, add_node_pairs_int64
        procedure, private :: set_elimination_order_int32, set_elimination_order_int64
        procedure, private :: add_ground_contacts_int32, add_ground_contacts_int64
        procedure, private :: add_gap_rows_int32, add_gap_rows_int64
        procedure, private :: add_constraints_int32, add_constraints_int64
        procedure, private :: add_outputs_int32, add_outputs_int64
        procedure, private :: add_rigid_link_int32, add_rigid_link_int64
        procedure, private :: add_distributing_coupling_int32, add_distributing_coupling_int64
        procedure, private :: set_coordinates_int32, set_coordinates_int64
        procedure, private :: add_tie_int32, add_tie_int64
        procedure, private :: add_surface_int32, add_surface_int64
        procedure, private :: set_multipliers_int32, set_multipliers_int64
        procedure, private :: set_excitation_real, set_excitation_complex
        procedure, private :: set_growing_excitation_real, set_growing_excitation_complex
        procedure, private :: set_base_motion_real, set_base_motion_complex
        procedure, private :: set_gap_motion_real, set_gap_motion_complex
        generic :: set_csc => set_csc_int32, set_csc_int64
        generic :: set_csr => set_csr_int32, set_csr_int64
        generic :: set_triplets => set_triplets_int32, set_triplets_int64
        generic :: fix_dofs => fix_dofs_int32, fix_dofs_int64
        generic :: set_elimination_order => set_elimination_order_int32, set_elimination_order_int64
        generic :: add_node_pairs => add_node_pairs_int32, add_node_pairs_int64
        generic :: add_ground_contacts => add_ground_contacts_int32, add_ground_contacts_int64
        generic :: add_gap_rows => add_gap_rows_int32, add_gap_rows_int64
        generic :: add_constraints => add_constraints_int32, add_constraints_int64
        generic :: add_outputs => add_outputs_int32, add_outputs_int64
        generic :: add_rigid_link => add_rigid_link_int32, add_rigid_link_int64
        generic :: set_coordinates => set_coordinates_int32, set_coordinates_int64
        generic :: set_multipliers => set_multipliers_int32, set_multipliers_int64
        generic :: add_surface => add_surface_int32, add_surface_int64
        generic :: add_tie => add_tie_int32, add_tie_int64
        generic :: add_distributing_coupling => add_distributing_coupling_int32, add_distributing_coupling_int64
        procedure :: set_dense_matrix
        procedure :: add_dense_gap_rows
        procedure :: set_recovery
        procedure :: recover
        procedure :: set_preload
        generic :: set_excitation => set_excitation_real, set_excitation_complex
        generic :: set_growing_excitation => set_growing_excitation_real, set_growing_excitation_complex
        generic :: set_base_motion => set_base_motion_real, set_base_motion_complex
        generic :: set_gap_motion => set_gap_motion_real, set_gap_motion_complex
        procedure :: build
        procedure :: solve_rest
        procedure :: modes
        procedure :: finding
    end type plm_model

contains

    subroutine create(self, context, n_dof, stat, errmsg)
        class(plm_model), intent(inout) :: self
        type(plm_context), intent(in) :: context
        integer, intent(in) :: n_dof
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        self%context = context%handle
        self%kind = PLM_KIND_MODEL
        self%n_dof = n_dof
        call finish(self%context, plm_model_create(self%context, int(n_dof, int64), self%handle), stat, errmsg)
    end subroutine create

    ! A model that a C function has made in the context.
    subroutine adopt(self, context, handle, n_dof)
        class(plm_model), intent(inout) :: self
        type(plm_context), intent(in) :: context
        type(c_ptr), intent(in) :: handle
        integer, intent(in) :: n_dof
        self%context = context%handle
        self%kind = PLM_KIND_MODEL
        self%handle = handle
        self%n_dof = n_dof
    end subroutine adopt

    subroutine destroy(self, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        status = plm_model_destroy(self%handle)
        if (status >= 0 .and. associated(self%box)) deallocate (self%box)
        call finish(self%context, status, stat, errmsg)
    end subroutine destroy

    ! which: PLM_MASS, PLM_STIFFNESS, PLM_DAMPING; part: PLM_FULL, PLM_LOWER, PLM_UPPER; col_ptr(n_dof + 1), row(nnz)
    subroutine set_csc_int32(self, which, part, col_ptr, row, value, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(plm_status), intent(in) :: which, part
        integer(int32), intent(in), contiguous :: col_ptr(:), row(:)
        real(real64), intent(in), contiguous :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(row) /= size(value) .or. size(col_ptr) < 1) then
            call refuse('set_csc: the lengths of the arrays do not fit', stat, errmsg)
            return
        end if
        if (self%n_dof > 0 .and. size(col_ptr) /= self%n_dof + 1) then
            call refuse('set_csc: col_ptr must have n_dof + 1 entries', stat, errmsg)
            return
        end if
        call finish(self%context, plm_model_set_matrix(self%handle, which, PLM_CSC, part, 1_c_int32_t, PLM_COPY, &
            size(value, kind=int64), col_ptr, row, value), stat, errmsg)
    end subroutine set_csc_int32

    ! compressed rows: row_ptr(n_dof + 1), column(nnz)
    subroutine set_csr_int32(self, which, part, row_ptr, column, value, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(plm_status), intent(in) :: which, part
        integer(int32), intent(in), contiguous :: row_ptr(:), column(:)
        real(real64), intent(in), contiguous :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(column) /= size(value) .or. size(row_ptr) < 1) then
            call refuse('set_csr: the lengths of the arrays do not fit', stat, errmsg)
            return
        end if
        if (self%n_dof > 0 .and. size(row_ptr) /= self%n_dof + 1) then
            call refuse('set_csr: row_ptr must have n_dof + 1 entries', stat, errmsg)
            return
        end if
        call finish(self%context, plm_model_set_matrix(self%handle, which, PLM_CSR, part, 1_c_int32_t, PLM_COPY, &
            size(value, kind=int64), row_ptr, column, value), stat, errmsg)
    end subroutine set_csr_int32

    ! Entries in any order; those of the same place are summed.
    subroutine set_triplets_int32(self, which, part, row, column, value, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(plm_status), intent(in) :: which, part
        integer(int32), intent(in), contiguous :: row(:), column(:)
        real(real64), intent(in), contiguous :: value(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(row) /= size(value) .or. size(column) /= size(value)) then
            call refuse('set_triplets: the lengths of the arrays do not fit', stat, errmsg)
            return
        end if
        call finish(self%context, plm_model_set_matrix(self%handle, which, PLM_TRIPLETS, part, 1_c_int32_t, PLM_COPY, &
            size(value, kind=int64), row, column, value), stat, errmsg)
    end subroutine set_triplets_int32

    subroutine fix_dofs_int32(self, dof, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dof(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_fix_dofs(self%handle, 1_c_int32_t, size(dof, kind=int64), dof), &
            stat, errmsg)
    end subroutine fix_dofs_int32

    ! Constraints: sum of coefficient x q(dof) = 0 in every row.
    subroutine add_constraints_int32(self, row_ptr, dof, coefficient, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: row_ptr(:), dof(:)
        real(real64), intent(in), contiguous :: coefficient(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(row_ptr) < 1 .or. size(dof) /= size(coefficient)) then
            call refuse('add_constraints: the shapes of the arrays do not fit', stat, errmsg)
            return
        end if
        if (row_ptr(size(row_ptr)) /= size(dof) + 1) then
            call refuse('add_constraints: the last of row_ptr is not the number of entries of dof, and one', stat, errmsg)
            return
        end if
        call finish(self%context, plm_model_add_constraints(self%handle, 1_c_int32_t, size(row_ptr, kind=int64) - 1, &
            row_ptr, dof, coefficient), stat, errmsg)
    end subroutine add_constraints_int32

    ! Outputs, sum of coefficient x q(dof) in every row: first_dof is the number of the first, to stand for a DOF.
    subroutine add_outputs_int32(self, row_ptr, dof, coefficient, first_dof, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: row_ptr(:), dof(:)
        real(real64), intent(in), contiguous :: coefficient(:)
        integer, intent(out) :: first_dof
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: first
        integer(plm_status) :: status
        if (size(row_ptr) < 1 .or. size(dof) /= size(coefficient)) then
            call refuse('add_outputs: the shapes of the arrays do not fit', stat, errmsg)
            return
        end if
        if (row_ptr(size(row_ptr)) /= size(dof) + 1) then
            call refuse('add_outputs: the last of row_ptr is not the number of entries of dof, and one', stat, errmsg)
            return
        end if
        first = 0
        status = plm_model_add_outputs(self%handle, 1_c_int32_t, size(row_ptr, kind=int64) - 1, row_ptr, dof, coefficient, &
            first)
        if (status >= 0) first_dof = int(first + 1)
        call finish(self%context, status, stat, errmsg)
    end subroutine add_outputs_int32

    ! Nodes that follow a reference node rigidly. DOFs: 3 or 6 of the reference node, (3, n) or (6, n) of the others,
    ! 0 for no such DOF; dependent_xyz(3, n).
    subroutine add_rigid_link_int32(self, reference_dof, reference_xyz, dependent_dof, dependent_xyz, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: reference_dof(:), dependent_dof(:, :)
        real(real64), intent(in), contiguous :: reference_xyz(:), dependent_xyz(:, :)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(reference_xyz) /= 3 .or. size(dependent_xyz, 1) /= 3 .or. &
            size(dependent_dof, 2) /= size(dependent_xyz, 2)) then
            call refuse('add_rigid_link: the shapes of the arrays do not fit', stat, errmsg)
            return
        end if
        call finish(self%context, plm_model_add_rigid_link_i32(self%handle, 1_c_int32_t, size(reference_dof, kind=int32), &
            reference_dof, reference_xyz, size(dependent_dof, 2, kind=int64), size(dependent_dof, 1, kind=int32), &
            dependent_dof, dependent_xyz), stat, errmsg)
    end subroutine add_rigid_link_int32

    ! Where the DOFs are, for the audit: dof(3, n) or (6, n), 0 for no such DOF; xyz(3, n)
    subroutine set_coordinates_int32(self, dof, xyz, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dof(:, :)
        real(real64), intent(in), contiguous :: xyz(:, :)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(xyz, 1) /= 3 .or. size(dof, 2) /= size(xyz, 2)) then
            call refuse('set_coordinates: the shapes of the arrays do not fit', stat, errmsg)
            return
        end if
        call finish(self%context, plm_model_set_coordinates_i32(self%handle, 1_c_int32_t, size(dof, 2, kind=int64), &
            size(dof, 1, kind=int32), dof, xyz), stat, errmsg)
    end subroutine set_coordinates_int32

    ! RBE3: a reference node (3 or 6 DOFs) by the rigid motion that fits the nodes best; dof(3, n), xyz(3, n), weight(n),
    ! absent: all alike
    subroutine add_distributing_coupling_int32(self, reference_dof, reference_xyz, dof, xyz, weight, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: reference_dof(:), dof(:, :)
        real(real64), intent(in), contiguous :: reference_xyz(:), xyz(:, :)
        real(real64), intent(in), contiguous, optional :: weight(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(reference_xyz) /= 3 .or. any(shape(dof) /= shape(xyz)) .or. size(xyz, 1) /= 3) then
            call refuse('add_distributing_coupling: the shapes of the arrays do not fit', stat, errmsg)
            return
        end if
        if (present(weight)) then
            if (size(weight) /= size(xyz, 2)) then
                call refuse('add_distributing_coupling: weight has the wrong length', stat, errmsg)
                return
            end if
        end if
        call finish(self%context, plm_model_add_distributing_coupling_i32(self%handle, 1_c_int32_t, &
            size(reference_dof, kind=int32), reference_dof, reference_xyz, size(xyz, 2, kind=int64), dof, xyz, weight), &
            stat, errmsg)
    end subroutine add_distributing_coupling_int32

    ! Nodes onto faces that do not match them: DOFs (0: none) and coordinates (3, n), those of the nodes of the surface
    ! (3, n_surface); faces by places among the latter, face_ptr(n_faces + 1), face_node. distance(n): from the surface
    subroutine add_tie_int32(self, dependent_dof, dependent_xyz, surface_dof, surface_xyz, face_ptr, face_node, &
        tolerance, distance, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dependent_dof(:, :), surface_dof(:, :), face_ptr(:), face_node(:)
        real(real64), intent(in), contiguous :: dependent_xyz(:, :), surface_xyz(:, :)
        real(real64), intent(in) :: tolerance
        real(real64), intent(inout), contiguous, optional :: distance(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (any(shape(dependent_dof) /= shape(dependent_xyz)) .or. any(shape(surface_dof) /= shape(surface_xyz)) .or. &
            size(dependent_xyz, 1) /= 3 .or. size(surface_xyz, 1) /= 3 .or. size(face_ptr) < 1) then
            call refuse('add_tie: the shapes of the arrays do not fit', stat, errmsg)
            return
        end if
        if (face_ptr(size(face_ptr)) /= size(face_node) + 1) then
            call refuse('add_tie: the last of face_ptr is not the number of entries of face_node, and one', stat, errmsg)
            return
        end if
        if (present(distance)) then
            if (size(distance) /= size(dependent_xyz, 2)) then
                call refuse('add_tie: distance has the wrong length', stat, errmsg)
                return
            end if
        end if
        call finish(self%context, plm_model_add_tie_i32(self%handle, 1_c_int32_t, size(dependent_xyz, 2, kind=int64), &
            dependent_dof, dependent_xyz, size(surface_xyz, 2, kind=int64), surface_dof, surface_xyz, &
            size(face_ptr, kind=int64) - 1, face_ptr, face_node, tolerance, distance), stat, errmsg)
    end subroutine add_tie_int32

    ! A surface for contact: DOFs (3, n; 0: none, a rigid wall where all are) and coordinates (3, n); faces face_ptr(n_faces + 1),
    ! face_node (both empty: nodes alone); its number, from 1. area(n): in place of what the faces give
    subroutine add_surface_int32(self, dof, xyz, face_ptr, face_node, surface, area, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dof(:, :), face_ptr(:), face_node(:)
        real(real64), intent(in), contiguous :: xyz(:, :)
        integer, intent(out) :: surface
        real(real64), intent(in), contiguous, optional :: area(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: number
        surface = 0
        if (any(shape(dof) /= shape(xyz)) .or. size(xyz, 1) /= 3) then
            call refuse('add_surface: the shapes of the arrays do not fit', stat, errmsg)
            return
        end if
        if (size(face_ptr) > 0) then
            if (face_ptr(size(face_ptr)) /= size(face_node) + 1) then
                call refuse('add_surface: the last of face_ptr is not the number of entries of face_node, and one', stat, errmsg)
                return
            end if
        end if
        if (present(area)) then
            if (size(area) /= size(xyz, 2)) then
                call refuse('add_surface: area has the wrong length', stat, errmsg)
                return
            end if
        end if
        number = -1
        call finish(self%context, plm_model_add_surface_i32(self%handle, 1_c_int32_t, size(xyz, 2, kind=int64), dof, xyz, &
            area, max(size(face_ptr, kind=int64) - 1, 0_int64), face_ptr, face_node, number), stat, errmsg)
        surface = int(number) + 1
    end subroutine add_surface_int32

    ! DOFs of the matrices that are Lagrange multipliers: their rows of K become constraints.
    subroutine set_multipliers_int32(self, dof, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dof(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_set_multipliers(self%handle, 1_c_int32_t, size(dof, kind=int64), dof), &
            stat, errmsg)
    end subroutine set_multipliers_int32

    ! all DOFs as the sparse factorization eliminates them, in place of the library's order
    subroutine set_elimination_order_int32(self, dof, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dof(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_set_elimination_order(self%handle, 1_c_int32_t, &
            size(dof, kind=int64), dof), stat, errmsg)
    end subroutine set_elimination_order_int32

    ! dof_a, dof_b, normal: 3 x n, 0 for no such DOF; the normal points out of the body of a; stiffness(n): k_n or
    ! PLM_AUTO_STIFFNESS; gap(n): initial distance, absent: 0
    subroutine add_node_pairs_int32(self, dof_a, dof_b, normal, stiffness, gap, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dof_a(:, :), dof_b(:, :)
        real(real64), intent(in), contiguous :: normal(:, :), stiffness(:)
        real(real64), intent(in), contiguous, optional :: gap(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (any( &
            [shape(dof_a), shape(dof_b), shape(normal)] /= &
            [3, size(stiffness), 3, size(stiffness), 3, size(stiffness)])) then
            call refuse('add_node_pairs: the shapes of the arrays do not fit', stat, errmsg)
            return
        end if
        if (present(gap)) then
            if (size(gap) /= size(stiffness)) then
                call refuse('add_node_pairs: gap has the wrong length', stat, errmsg)
                return
            end if
            call finish(self%context, plm_model_add_node_pairs_i32(self%handle, 1_c_int32_t, size(stiffness, kind=int64), &
                dof_a, dof_b, normal, stiffness, gap), stat, errmsg)
        else
            call finish(self%context, plm_model_add_node_pairs_i32(self%handle, 1_c_int32_t, size(stiffness, kind=int64), &
                dof_a, dof_b, normal, stiffness), stat, errmsg)
        end if
    end subroutine add_node_pairs_int32

    ! The normal points into the ground.
    subroutine add_ground_contacts_int32(self, dof, normal, stiffness, gap, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: dof(:, :)
        real(real64), intent(in), contiguous :: normal(:, :), stiffness(:)
        real(real64), intent(in), contiguous, optional :: gap(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (any([shape(dof), shape(normal)] /= [3, size(stiffness), 3, size(stiffness)])) then
            call refuse('add_ground_contacts: the shapes of the arrays do not fit', stat, errmsg)
            return
        end if
        if (present(gap)) then
            if (size(gap) /= size(stiffness)) then
                call refuse('add_ground_contacts: gap has the wrong length', stat, errmsg)
                return
            end if
            call finish(self%context, plm_model_add_ground_contacts_i32(self%handle, 1_c_int32_t, &
                size(stiffness, kind=int64), dof, normal, stiffness, gap), stat, errmsg)
        else
            call finish(self%context, plm_model_add_ground_contacts_i32(self%handle, 1_c_int32_t, &
                size(stiffness, kind=int64), dof, normal, stiffness), stat, errmsg)
        end if
    end subroutine add_ground_contacts_int32

    ! Rows of the gap matrix: u = sum of coefficient x q(dof) - gap, u > 0 closed.
    subroutine add_gap_rows_int32(self, row_ptr, dof, coefficient, stiffness, gap, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(int32), intent(in), contiguous :: row_ptr(:), dof(:)
        real(real64), intent(in), contiguous :: coefficient(:), stiffness(:)
        real(real64), intent(in), contiguous, optional :: gap(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(row_ptr) /= size(stiffness) + 1 .or. size(dof) /= size(coefficient)) then
            call refuse('add_gap_rows: the shapes of the arrays do not fit', stat, errmsg)
            return
        end if
        if (row_ptr(size(row_ptr)) /= size(dof) + 1) then
            call refuse('add_gap_rows: the last of row_ptr is not the number of entries of dof, and one', stat, errmsg)
            return
        end if
        if (present(gap)) then
            if (size(gap) /= size(stiffness)) then
                call refuse('add_gap_rows: gap has the wrong length', stat, errmsg)
                return
            end if
            call finish(self%context, plm_model_add_gap_rows(self%handle, 1_c_int32_t, size(stiffness, kind=int64), &
                row_ptr, dof, coefficient, stiffness, gap), stat, errmsg)
        else
            call finish(self%context, plm_model_add_gap_rows(self%handle, 1_c_int32_t, size(stiffness, kind=int64), &
                row_ptr, dof, coefficient, stiffness), stat, errmsg)
        end if
    end subroutine add_gap_rows_int32

    ! which, part: as in set_csc; value(ld, n_dof), ld >= n_dof
    subroutine set_dense_matrix(self, which, part, value, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(plm_status), intent(in) :: which, part
        real(real64), intent(in), contiguous :: value(:, :)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(value, 2) /= self%n_dof) then
            call refuse('set_dense_matrix: the matrix has not n_dof columns', stat, errmsg)
            return
        end if
        call finish(self%context, plm_model_set_dense_matrix(self%handle, which, part, value, &
            size(value, 1, kind=int64)), stat, errmsg)
    end subroutine set_dense_matrix

    ! Rows of the gap matrix, row(n, n_dof): u = row q - gap, u > 0 closed.
    subroutine add_dense_gap_rows(self, row, stiffness, gap, stat, errmsg)
        class(plm_model), intent(inout) :: self
        real(real64), intent(in), contiguous :: row(:, :), stiffness(:)
        real(real64), intent(in), contiguous, optional :: gap(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(int64) :: n
        n = size(stiffness, kind=int64)
        if (size(row, 1) /= n .or. size(row, 2) /= self%n_dof) then
            call refuse('add_dense_gap_rows: row is not n x n_dof', stat, errmsg)
            return
        end if
        if (present(gap)) then
            if (size(gap) /= n) then
                call refuse('add_dense_gap_rows: gap has the wrong length', stat, errmsg)
                return
            end if
        end if
        call finish(self%context, plm_model_add_dense_gap_rows(self%handle, n, row, max(n, 1_int64), stiffness, gap), &
            stat, errmsg)
    end subroutine add_dense_gap_rows

    ! recoverer must live (target or pointer) as long as the model; absent: none
    subroutine set_recovery(self, n_full, recoverer, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(in) :: n_full
        class(plm_recoverer), intent(inout), target, optional :: recoverer
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        if (present(recoverer)) then
            if (.not. associated(self%box)) allocate (self%box)
            self%box%recoverer => recoverer
            status = plm_model_set_recovery(self%handle, int(n_full, int64), c_funloc(forward_recovery), c_loc(self%box))
        else
            status = plm_model_set_recovery(self%handle, int(n_full, int64), c_null_funptr, c_null_ptr)
        end if
        call finish(self%context, status, stat, errmsg)
    end subroutine set_recovery

    ! reduced(n_dof, k), motions in the model's DOFs; full(n_full, k), the same on the whole structure
    subroutine recover(self, reduced, full, stat, errmsg)
        class(plm_model), intent(in) :: self
        real(real64), intent(in), contiguous :: reduced(:, :)
        real(real64), intent(inout), contiguous :: full(:, :)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (size(reduced, 1) /= self%n_dof .or. size(reduced, 2) /= size(full, 2)) then
            call refuse('recover: the shapes of the arrays do not fit', stat, errmsg)
            return
        end if
        call finish(self%context, plm_model_recover(self%handle, size(full, 2, kind=int64), reduced, &
            size(full, 1, kind=int64), full), stat, errmsg)
    end subroutine recover

    ! absent: none
    subroutine set_preload(self, force, stat, errmsg)
        class(plm_model), intent(inout) :: self
        real(real64), intent(in), contiguous, optional :: force(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (present(force)) then
            call finish(self%context, plm_model_set_preload(self%handle, size(force, kind=int64), force), stat, errmsg)
        else
            call finish(self%context, plm_model_set_preload(self%handle, int(self%n_dof, int64)), stat, errmsg)
        end if
    end subroutine set_preload

    ! F(t) = sum over h of Re(force_h exp(i h omega t))
    subroutine set_excitation_real(self, harmonic, force, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(in) :: harmonic
        real(real64), intent(in), contiguous :: force(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_set_excitation(self%handle, int(harmonic, c_int32_t), &
            size(force, kind=int64), force), stat, errmsg)
    end subroutine set_excitation_real

    subroutine set_excitation_complex(self, harmonic, force, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(in) :: harmonic
        complex(real64), intent(in) :: force(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_set_excitation(self%handle, int(harmonic, c_int32_t), &
            size(force, kind=int64), real(force, real64), aimag(force)), stat, errmsg)
    end subroutine set_excitation_complex

    ! and omega^power Re(force exp(i h omega t)), power 1 or 2: of an unbalance 2
    subroutine set_growing_excitation_real(self, harmonic, power, force, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(in) :: harmonic, power
        real(real64), intent(in), contiguous :: force(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_set_growing_excitation(self%handle, int(harmonic, c_int32_t), &
            int(power, c_int32_t), size(force, kind=int64), force), stat, errmsg)
    end subroutine set_growing_excitation_real

    subroutine set_growing_excitation_complex(self, harmonic, power, force, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(in) :: harmonic, power
        complex(real64), intent(in) :: force(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_set_growing_excitation(self%handle, int(harmonic, c_int32_t), &
            int(power, c_int32_t), size(force, kind=int64), real(force, real64), aimag(force)), stat, errmsg)
    end subroutine set_growing_excitation_complex

    ! Motion of fixed DOFs, Re(motion exp(i h omega t)), zero at all others; quantity: PLM_DISPLACEMENT, _VELOCITY or
    ! _ACCELERATION. Results are relative to the base, but for outputs with the option "absolute_outputs".
    subroutine set_base_motion_real(self, quantity, harmonic, motion, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(in) :: quantity, harmonic
        real(real64), intent(in), contiguous :: motion(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_set_base_motion(self%handle, int(quantity, c_int32_t), &
            int(harmonic, c_int32_t), size(motion, kind=int64), motion), stat, errmsg)
    end subroutine set_base_motion_real

    subroutine set_base_motion_complex(self, quantity, harmonic, motion, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(in) :: quantity, harmonic
        complex(real64), intent(in) :: motion(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_set_base_motion(self%handle, int(quantity, c_int32_t), &
            int(harmonic, c_int32_t), size(motion, kind=int64), real(motion, real64), aimag(motion)), stat, errmsg)
    end subroutine set_base_motion_complex

    ! gap(t) = gap + sum over h of Re(motion_h exp(i h omega t)), of all pairs added so far
    subroutine set_gap_motion_real(self, harmonic, motion, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(in) :: harmonic
        real(real64), intent(in), contiguous :: motion(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_set_gap_motion(self%handle, int(harmonic, c_int32_t), &
            size(motion, kind=int64), motion), stat, errmsg)
    end subroutine set_gap_motion_real

    subroutine set_gap_motion_complex(self, harmonic, motion, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(in) :: harmonic
        complex(real64), intent(in) :: motion(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_set_gap_motion(self%handle, int(harmonic, c_int32_t), &
            size(motion, kind=int64), real(motion, real64), aimag(motion)), stat, errmsg)
    end subroutine set_gap_motion_complex

    subroutine build(self, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_build(self%handle), stat, errmsg)
    end subroutine build

    ! Results: rest_displacement, rest_penetration, rest_closed, rest_force.
    subroutine solve_rest(self, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%context, plm_model_solve_rest(self%handle), stat, errmsg)
    end subroutine solve_rest

    ! The lowest size(frequency_hz) modes of a linear system: PLM_SYSTEM_OPEN, _SLIDING, _REST or _GIVEN (with closed).
    subroutine modes(self, system, frequency_hz, shape, closed, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer(plm_status), intent(in) :: system
        real(real64), intent(inout), contiguous :: frequency_hz(:)
        real(real64), intent(inout), contiguous, optional :: shape(:, :)
        logical, intent(in), optional :: closed(:)
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(c_int32_t), allocatable :: flags(:)
        integer(int64) :: n_pairs
        integer(plm_status) :: status
        if (present(shape)) then
            if (self%n_dof > 0 .and. any(ubound(shape) /= [self%n_dof, size(frequency_hz)])) then
                call refuse('modes: shape must be n_dof x size(frequency_hz)', stat, errmsg)
                return
            end if
        end if
        if (present(closed)) then
            n_pairs = -1
            status = plm_model_get_int(self%handle, 'n_pairs'//char(0), n_pairs)
            if (status >= 0 .and. size(closed) /= n_pairs) then
                call refuse('modes: closed must have n_pairs entries', stat, errmsg)
                return
            end if
            allocate (flags(size(closed)))
            flags(:) = merge(1_c_int32_t, 0_c_int32_t, closed)
        end if
        ! flags not allocated: absent
        if (present(shape)) then
            status = plm_model_get_modes(self%handle, system, flags, size(frequency_hz, kind=int64), frequency_hz, shape)
        else
            status = plm_model_get_modes(self%handle, system, flags, size(frequency_hz, kind=int64), frequency_hz)
        end if
        call finish(self%context, status, stat, errmsg)
    end subroutine modes

    ! Number i of the audit, from 1. severity: 0 a fact, 1 worth a look, 2 probably wrong.
    subroutine finding(self, i, severity, value, text, stat, errmsg)
        class(plm_model), intent(inout) :: self
        integer, intent(in) :: i
        integer, intent(out) :: severity
        real(real64), intent(out) :: value
        character(len=:), allocatable, intent(out) :: text
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        character(kind=c_char, len=2048) :: buffer
        integer(c_int32_t) :: level
        level = 0
        value = 0
        buffer = char(0)
        call finish(self%context, plm_model_get_finding(self%handle, int(i - 1, int64), level, value, &
            len(buffer, int64), buffer), stat, errmsg)
        severity = int(level)
        text = f_text(buffer)
    end subroutine finding

    ! the procedures *_int64, twins of those above
    include 'plm_model_int64.inc'

end module plm_models
