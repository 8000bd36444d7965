! brick_team.f90: a clamped block of bricks with a crack over half its section, as brick_team.c. Every rank assembles the
! bricks of its own slice; rank 0 computes the peak of the response.
!
!     mpirun -n 4 brick_team_fortran [bricks along the block, 12 if not given]

! --- the host's own code: numbers of DOFs, and the matrices of a slice -----------------------------------------------
module block_of_bricks
    use, intrinsic :: iso_fortran_env, only: real64
    use brick, only: brick_matrices, material
    implicit none
    integer, parameter :: ny = 3, nz = 4, nodes = (ny + 1)*(nz + 1), section = 3*nodes ! nodes and DOFs of a section
    integer :: nx = 12

contains

    ! Sections 0 ... nx, and behind them the other face of the crack, which stands at the middle section.
    pure integer function node_of(x, y, z, right_of_crack) result(node)
        integer, intent(in) :: x, y, z
        logical, intent(in) :: right_of_crack
        node = x*nodes + y*(nz + 1) + z
        if (right_of_crack .and. x == nx/2 .and. z >= nz/2) node = (nx + 1)*nodes + y*(nz + 1) + z
    end function node_of

    ! The bricks between the sections first and last; DOFs from 1.
    subroutine assemble(first, last, row, column, k, m)
        integer, intent(in) :: first, last
        integer, intent(out), allocatable :: row(:), column(:)
        real(real64), intent(out), allocatable :: k(:), m(:)
        integer, parameter :: corner(3, 8) = reshape([ &
            0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1], [3, 8])
        type(material), parameter :: steel = material(2.1d5, 0.3d0, 7.8d-9) ! N, mm, t
        real(real64) :: xyz(3, 8), stiffness(24, 24), mass(8, 8), full_mass(24, 24)
        integer :: x, y, z, c, i, dof(24), at(3), n
        n = 0
        allocate (row(576*ny*nz*(last - first)), column(576*ny*nz*(last - first)))
        allocate (k(size(row)), m(size(row)))
        do x = first, last - 1
            do y = 0, ny - 1
                do z = 0, nz - 1
                    full_mass = 0
                    do c = 1, 8
                        at = [x, y, z] + corner(:, c)
                        xyz(:, c) = 10*at
                        dof(3*c - 2:3*c) = 3*node_of(at(1), at(2), at(3), x >= nx/2) + [1, 2, 3]
                    end do
                    call brick_matrices(xyz, steel, stiffness, mass)
                    do i = 1, 3
                        full_mass(i::3, i::3) = mass
                    end do
                    row(n + 1:n + 576) = reshape(spread(dof, 2, 24), [576])
                    column(n + 1:n + 576) = reshape(spread(dof, 1, 24), [576])
                    k(n + 1:n + 576) = reshape(stiffness, [576])
                    m(n + 1:n + 576) = reshape(full_mass, [576])
                    n = n + 576
                end do
            end do
        end do
    end subroutine assemble

end module block_of_bricks

! --- from parts to peak ----------------------------------------------------------------------------------------------
program brick_team
    use, intrinsic :: iso_fortran_env, only: error_unit, real64
    use mpi_f08
    use plm
    use plm_mpi
    use block_of_bricks
    implicit none
    type(plm_team) :: team
    type(plm_context) :: context
    real(real64) :: hz, amplitude
    character(len=600) :: text
    integer :: rank, ranks, stat
    call MPI_Init()
    call MPI_Comm_rank(MPI_COMM_WORLD, rank)
    call MPI_Comm_size(MPI_COMM_WORLD, ranks)
    call get_command_argument(1, text)
    if (text /= '') read (text, *) nx
    call team%create(MPI_COMM_WORLD%mpi_val, (nx + 2)*section)
    call hand_over()
    if (rank == 0) then
        call context%create()
        call find_peak(stat, text)
        call team%dismiss(stat)
        if (stat < 0) write (error_unit, '(a)') trim(text)
        if (stat >= 0) print '(i0, a, i0, a, f12.10, a, f0.5, a)', (nx + 2)*section, ' DOFs on ', ranks, ' ranks: peak ', &
            amplitude, ' mm at ', hz, ' Hz'
        call context%destroy()
    else
        call team%serve(stat)
    end if
    call team%destroy()
    call MPI_Finalize()
    if (stat < 0) error stop 1

contains

    subroutine hand_over()
        integer, allocatable :: row(:), column(:)
        real(real64), allocatable :: k(:), m(:)
        integer :: first, last, y, z, i, left, right, failed ! what failed here is told by create_model
        first = nx*rank/ranks
        last = nx*(rank + 1)/ranks
        call assemble(first, last, row, column, k, m)
        call team%own_dofs([(i, i=first*section + 1, merge(nx + 2, last, rank == ranks - 1)*section)], failed)
        call team%add_entries(PLM_STIFFNESS, PLM_FULL, row, column, k, failed)
        call team%add_entries(PLM_MASS, PLM_FULL, row, column, m, failed)
        if (rank > 0) return
        call team%fix_dofs([(i, i=1, section)], failed) ! what is small may come from any rank
        do y = 0, ny
            do z = 0, nz
                left = 3*node_of(nx/2, y, z, .false.) + 1
                right = 3*node_of(nx/2, y, z, .true.) + 1
                if (left /= right) then
                    call team%add_gap_rows([1, 3], [left, right], [1d0, -1d0], [1d5], [0d0], failed)
                else ! numbers of the other face that are not used
                    i = 3*((nx + 1)*nodes + y*(nz + 1) + z)
                    call team%fix_dofs([i + 1, i + 2, i + 3], failed)
                end if
            end do
        end do
        call team%add_excitation(1, [(nx + 1)*section], [50d0], stat=failed)
    end subroutine hand_over

    subroutine find_peak(stat, text)
        integer, intent(out) :: stat
        character(len=*), intent(inout) :: text
        type(plm_model) :: model
        call team%create_model(context, model, stat, text) ! from here on the serial program
        if (stat < 0) return
        call model%set_rayleigh_damping(0d0, 1d-5)
        call model%build(stat, text)
        if (stat < 0) return
        call plm_compute_response(model, (nx + 1)*section, hz, amplitude, accuracy=1d-3, stat=stat, errmsg=text)
    end subroutine find_peak

end program brick_team
