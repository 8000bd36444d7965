! beam.f90: a clamped beam of bricks with a crack across it, from its upper side down: mesh, matrices, contact pairs.
! Knows nothing of libplm. mm, N, t, s.
module beam
    use, intrinsic :: iso_fortran_env, only: real64
    use brick, only: material, brick_matrices
    implicit none
    private
    public :: beam_parameters, beam_structure, build_beam

    type :: beam_parameters
        real(real64) :: size(3) = [200, 20, 10] ! along x; y is the height; z
        integer :: bricks(3) = [20, 6, 2]
        integer :: crack_column = 4             ! the crack follows this many bricks from the clamp
        integer :: crack_rows = 3               ! bricks it cuts, from the upper side
        type(material) :: steel = material(2.1e5_real64, 0.3_real64, 7.8e-9_real64)
    end type beam_parameters

    ! Matrices as they come from the elements: lower triangles in triplets, entries of the same place to be summed.
    type :: beam_structure
        integer :: n_dof = 0
        integer, allocatable :: k_row(:), k_column(:), m_row(:), m_column(:)
        real(real64), allocatable :: k(:), m(:)
        integer, allocatable :: clamped(:)              ! DOFs at x = 0
        integer, allocatable :: lip_a(:, :), lip_b(:, :) ! DOFs of the crack's two faces, 3 x n_pairs
        integer :: tip = 0                              ! the DOF along y in the middle of the free end
    end type beam_structure

contains

    subroutine build_beam(p, s)
        type(beam_parameters), intent(in) :: p
        type(beam_structure), intent(out) :: s
        integer :: nodes(8), ix, iy, iz, e, n_bricks
        real(real64) :: xyz(3, 8), ke(24, 24), me(8, 8)
        n_bricks = product(p%bricks)
        s%n_dof = 3*(product(p%bricks + 1) + p%crack_rows*(p%bricks(3) + 1))
        allocate (s%k_row(300*n_bricks), s%k_column(300*n_bricks), s%k(300*n_bricks))
        allocate (s%m_row(108*n_bricks), s%m_column(108*n_bricks), s%m(108*n_bricks))
        e = 0
        do ix = 1, p%bricks(1)
            do iy = 1, p%bricks(2)
                do iz = 1, p%bricks(3)
                    call corners(p, [ix, iy, iz], nodes, xyz)
                    call brick_matrices(xyz, p%steel, ke, me)
                    call scatter(nodes, ke, me, e, s)
                    e = e + 1
                end do
            end do
        end do
        call join_faces(p, s)
    end subroutine build_beam

    ! node of the grid, each index from 0; beyond the crack the twins of its nodes, numbered after the grid
    pure integer function node(p, i, beyond)
        type(beam_parameters), intent(in) :: p
        integer, intent(in) :: i(3)
        logical, intent(in) :: beyond
        integer :: row
        row = i(2) - (p%bricks(2) - p%crack_rows) ! > 0 in the crack
        if (beyond .and. i(1) == p%crack_column .and. row > 0) then
            node = product(p%bricks + 1) + (row - 1)*(p%bricks(3) + 1) + i(3) + 1
        else
            node = (i(1)*(p%bricks(2) + 1) + i(2))*(p%bricks(3) + 1) + i(3) + 1
        end if
    end function node

    pure subroutine corners(p, place, nodes, xyz)
        type(beam_parameters), intent(in) :: p
        integer, intent(in) :: place(3)
        integer, intent(out) :: nodes(8)
        real(real64), intent(out) :: xyz(3, 8)
        integer, parameter :: step(3, 8) = reshape( &
            [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1], [3, 8])
        integer :: a
        do a = 1, 8
            nodes(a) = node(p, place - 1 + step(:, a), place(1) > p%crack_column)
            xyz(:, a) = p%size*(place - 1 + step(:, a))/p%bricks
        end do
    end subroutine corners

    ! element e (from 0): 300 entries of the stiffness, 108 of the mass
    pure subroutine scatter(nodes, ke, me, e, s)
        integer, intent(in) :: nodes(8), e
        real(real64), intent(in) :: ke(24, 24), me(8, 8)
        type(beam_structure), intent(inout) :: s
        integer, parameter :: corner_of(24) = [1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6, 7, 7, 7, 8, 8, 8]
        integer :: i, j, at_k, at_m, dof(24)
        dof = [((3*(nodes(j) - 1) + i, i=1, 3), j=1, 8)]
        at_k = 300*e
        at_m = 108*e
        do j = 1, 24
            do i = j, 24
                at_k = at_k + 1
                s%k_row(at_k) = max(dof(i), dof(j))
                s%k_column(at_k) = min(dof(i), dof(j))
                s%k(at_k) = ke(i, j)
                if (mod(i - j, 3) /= 0) cycle
                at_m = at_m + 1
                s%m_row(at_m) = s%k_row(at_k)
                s%m_column(at_m) = s%k_column(at_k)
                s%m(at_m) = me(corner_of(i), corner_of(j))
            end do
        end do
    end subroutine scatter

    subroutine join_faces(p, s)
        type(beam_parameters), intent(in) :: p
        type(beam_structure), intent(inout) :: s
        integer :: iy, iz, c, pair, place(3)
        s%clamped = [(c, c=1, 3*(p%bricks(2) + 1)*(p%bricks(3) + 1))] ! the nodes of x = 0 come first
        allocate (s%lip_a(3, p%crack_rows*(p%bricks(3) + 1)))
        allocate (s%lip_b, mold=s%lip_a)
        pair = 0
        do iy = p%bricks(2) - p%crack_rows + 1, p%bricks(2)
            do iz = 0, p%bricks(3)
                pair = pair + 1
                place = [p%crack_column, iy, iz]
                s%lip_a(:, pair) = 3*(node(p, place, .false.) - 1) + [1, 2, 3]
                s%lip_b(:, pair) = 3*(node(p, place, .true.) - 1) + [1, 2, 3]
            end do
        end do
        s%tip = 3*(node(p, [p%bricks(1), p%bricks(2)/2, p%bricks(3)/2], .false.) - 1) + 2
    end subroutine join_faces

end module beam
