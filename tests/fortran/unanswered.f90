! unanswered.f90: what the program does not ask for (no stat) is reported all the same: an outcome, and it goes on; a
! failure, and it stops.
program unanswered
    use plm
    implicit none
    integer, parameter :: d = kind(1d0)
    type(plm_context) :: context
    type(plm_model) :: model
    type(plm_basis) :: basis
    type(plm_hbm) :: hbm
    type(plm_branch) :: curve
    call context%create()
    call model%create(context, 1)
    call model%set_triplets(PLM_MASS, PLM_LOWER, [1], [1], [1d0])
    call model%set_triplets(PLM_STIFFNESS, PLM_LOWER, [1], [1], [1d0])
    call model%set_modal_damping([0.05_d])
    call model%add_gap_rows([1, 2], [1], [1d0], [1d0])
    call model%set_excitation(1, [1d0])
    call model%build()
    call basis%create(model)
    call basis%set('kind', 'full')
    call basis%set('frequency_min_hz', 0.1_d)
    call basis%set('frequency_max_hz', 0.3_d)
    call basis%build()
    call hbm%create(basis)
    call hbm%set('max_points', 3)
    call hbm%sweep(curve)
    print '(a)', 'looked at'
    call model%set('no_such_option', 1)
    print '(a)', 'went on'
end program unanswered
