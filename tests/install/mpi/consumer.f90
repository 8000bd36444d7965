! A mass on a spring by a team of one rank: its frequency is 1 Hz.
program consumer
    use plm
    use plm_mpi
    implicit none
    type(plm_team) :: team
    type(plm_context) :: context
    type(plm_model) :: model
    double precision :: hz(1)
    integer :: error
    include 'mpif.h'
    call MPI_Init(error)
    call team%create(MPI_COMM_WORLD, 1)
    call team%own_dofs([1])
    call team%add_entries(PLM_MASS, PLM_FULL, [1], [1], [1d0])
    call team%add_entries(PLM_STIFFNESS, PLM_FULL, [1], [1], [39.47841760435743d0])
    call context%create()
    call team%create_model(context, model)
    call model%build()
    call model%modes(PLM_SYSTEM_OPEN, hz)
    call team%dismiss()
    call context%destroy()
    call team%destroy()
    call MPI_Finalize(error)
    if (abs(hz(1) - 1) > 1d-9) error stop 1
end program consumer
