! The module plm_mpi in a host of mpif.h, on half of its ranks: 12 masses in a chain, of which each rank has every second or
! third, against the same chain as a model of one process; a field that each rank receives; what is refused, with its words.
module chain_of_masses
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_mpi, only: plm_receiver
    implicit none
    integer, parameter :: n = 12

    type, extends(plm_receiver) :: sum_of_field
        real(real64) :: sum = 0
        integer :: first = 0
        logical :: fails = .false.
    contains
        procedure :: receive
    end type sum_of_field

contains

    subroutine receive(self, dof, value, failed)
        class(sum_of_field), intent(inout) :: self
        integer(int64), intent(in) :: dof(:)
        real(real64), intent(in) :: value(:)
        logical, intent(inout) :: failed
        self%sum = sum(dof*value)
        self%first = int(dof(1))
        failed = self%fails
    end subroutine receive

end module chain_of_masses

program test_team
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm
    use plm_mpi
    use chain_of_masses
    implicit none
    include 'mpif.h'
    integer :: world, rank, ranks, half, error, failures = 0, i
    real(real64) :: all_failures
    character(len=600) :: text
    call MPI_Init(error)
    call MPI_Comm_rank(MPI_COMM_WORLD, world, error)
    call MPI_Comm_split(MPI_COMM_WORLD, mod(world, 2), world, half, error)
    call MPI_Comm_rank(half, rank, error)
    call MPI_Comm_size(half, ranks, error)
    call over_ranks()
    call refused()
    call MPI_Allreduce(real(failures, real64), all_failures, 1, MPI_DOUBLE_PRECISION, MPI_SUM, MPI_COMM_WORLD, error)
    call MPI_Finalize(error)
    if (all_failures > 0) error stop 1

contains

    subroutine expect(holds, what)
        logical, intent(in) :: holds
        character(len=*), intent(in) :: what
        if (holds) return
        failures = failures + 1
        print '(a, i0, 2a)', 'rank ', world, ': ', what
    end subroutine expect

    ! k = 1 + i/10 between the masses i - 1 and i (0: the ground), each 1 + i/100; masses of 64-bit numbers, springs of 32-bit
    subroutine hand_over(team)
        type(plm_team), intent(inout) :: team
        integer(int64) :: own((n - rank - 1)/ranks + 1)
        own = [(int(i, int64), i=1 + rank, n, ranks)]
        call team%own_dofs(own)
        call team%add_entries(PLM_MASS, PLM_FULL, own, own, 1 + own/100d0)
        do i = 1 + rank, n, ranks
            call add_spring(team, i)
        end do
        if (rank == ranks - 1) then
            call team%add_gap_rows([1, 2], [n], [1d0], [5d0], [0d0])
            call team%add_preload([n], [0.3d0])
            call team%add_excitation(1, [n, n - 1], [0.5d0, 0d0], [0d0, 0d0])
        end if
    end subroutine hand_over

    subroutine add_spring(team, i)
        type(plm_team), intent(inout) :: team
        integer, intent(in) :: i
        real(real64) :: k
        k = 1 + i/10d0
        call team%add_entries(PLM_STIFFNESS, PLM_LOWER, [i], [i], [k])
        if (i > 1) call team%add_entries(PLM_STIFFNESS, PLM_LOWER, [i - 1, i], [i - 1, i - 1], [k, -k])
    end subroutine add_spring

    subroutine whole_chain(context, model)
        type(plm_context), intent(in) :: context
        type(plm_model), intent(inout) :: model
        real(real64) :: force(n)
        call model%create(context, n)
        call model%set_triplets(PLM_MASS, PLM_FULL, [(i, i=1, n)], [(i, i=1, n)], [(1 + i/100d0, i=1, n)])
        call model%set_triplets(PLM_STIFFNESS, PLM_LOWER, [(i, i=1, n), (i, i=2, n)], [(i, i=1, n), (i, i=1, n - 1)], &
            [(1 + i/10d0 + merge(1 + (i + 1)/10d0, 0d0, i < n), i=1, n), (-1 - i/10d0, i=2, n)])
        call model%add_gap_rows([1, 2], [n], [1d0], [5d0], [0d0])
        force = 0
        force(n) = 0.3d0
        call model%set_preload(force)
        force(n) = 0.5d0
        call model%set_excitation(1, force)
    end subroutine whole_chain

    subroutine look(model, hz, peak)
        type(plm_model), intent(inout) :: model
        real(real64), intent(out) :: hz(:), peak(2)
        call model%set_rayleigh_damping(0d0, 0.1d0)
        call model%build()
        call model%modes(PLM_SYSTEM_SLIDING, hz)
        call plm_compute_response(model, n, peak(1), peak(2), accuracy=1d-3)
    end subroutine look

    subroutine over_ranks()
        type(plm_team) :: team
        type(plm_context) :: context
        type(plm_model) :: one, many
        type(sum_of_field), target :: mine
        real(real64) :: hz(5, 2), peak(2, 2), total
        integer :: stat
        call team%create(half, n)
        call team%set_field(mine)
        call hand_over(team)
        if (rank == 0) then
            call context%create()
            call whole_chain(context, one)
            call look(one, hz(:, 1), peak(:, 1))
            call team%create_model(context, many)
            call look(many, hz(:, 2), peak(:, 2))
            call expect(all(abs(hz(:, 2) - hz(:, 1)) <= 1d-9*hz(:, 1)), 'the frequencies are not those of one process')
            call expect(all(abs(peak(:, 2) - peak(:, 1)) <= 1d-8*peak(:, 1)), 'the peak is not that of one process')
            call team%deliver([(1/real(i, real64), i=1, n)])
            call team%dismiss()
            call context%destroy()
        else
            call team%serve()
        end if
        call MPI_Allreduce(mine%sum, total, 1, MPI_DOUBLE_PRECISION, MPI_SUM, half, error)
        call expect(abs(total - n) < 1d-12*n .and. mine%first == 1 + rank, 'a field is not delivered to its owners')
        call team%destroy(stat)
        call expect(stat == PLM_OK, 'the team is not destroyed')
    end subroutine over_ranks

    ! A DOF that is not there, said by the last rank alone; then a rank that fails to receive.
    subroutine refused()
        type(plm_team) :: team
        type(plm_context) :: context
        type(plm_model) :: model
        type(sum_of_field), target :: mine
        integer :: stat
        call team%create(half, 0, stat, text)
        call expect(stat == PLM_ERR_ARGUMENT .and. index(text, 'n_dof is 0') > 0, 'n_dof: '//trim(text))
        call team%create(half, n)
        call team%add_entries(PLM_MASS, PLM_FULL, [1], [1, 2], [1d0], stat, text)
        call expect(stat == PLM_ERR_ARGUMENT .and. index(text, 'add_entries') > 0, 'lengths: '//trim(text))
        call hand_over(team)
        if (rank == ranks - 1) then
            call team%fix_dofs([n + 1], stat, text)
            call expect(stat == PLM_ERR_ARGUMENT .and. index(text, 'dof[0] is 13') > 0, 'a DOF outside: '//trim(text))
        end if
        call lead(team, context, model, stat)
        call expect(stat == PLM_ERR_ARGUMENT .and. index(text, 'dof[0] is 13') > 0, 'told on all ranks: '//trim(text))
        call team%create(half, n)
        mine%fails = rank == ranks - 1
        call team%set_field(mine)
        call hand_over(team)
        call lead(team, context, model, stat)
        call expect(stat == PLM_ERR_CALLBACK, 'a receiver that fails: '//trim(text))
    end subroutine refused

    subroutine lead(team, context, model, stat)
        type(plm_team), intent(inout) :: team
        type(plm_context), intent(inout) :: context
        type(plm_model), intent(inout) :: model
        integer, intent(out) :: stat
        integer :: gone
        text = ''
        if (rank == 0) then
            call context%create()
            call team%create_model(context, model, stat, text)
            if (stat == PLM_OK) call team%deliver([(0d0, i=1, n)], stat, text)
            call team%dismiss(stat)
            call context%destroy()
        else
            call team%serve(stat, text)
        end if
        call team%destroy(gone)
    end subroutine lead

end program test_team
