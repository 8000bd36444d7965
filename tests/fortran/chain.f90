! chain.f90: the scenario of examples/fortran77/chain.f by the module plm; prints the same lines.
program chain
    use, intrinsic :: iso_fortran_env, only: real64, int64, output_unit
    use plm
    use counting_watchers, only: counting_watcher
    implicit none
    integer, parameter :: masses = 12
    type(plm_context) :: context
    type(plm_model) :: model
    type(plm_sampler) :: sampler
    type(plm_basis) :: basis
    type(plm_hbm) :: hbm
    type(plm_branch) :: curve, peak
    type(counting_watcher), target :: watcher
    real(real64) :: open_hz(2), sliding_hz(2), hz, amplitude, force(masses), q(masses)
    real(real64), allocatable :: coefficient(:, :), share(:)
    integer :: i, n

    call context%create()
    call context%set_progress(watcher)
    call model%create(context, masses)
    call model%set_triplets(PLM_MASS, PLM_LOWER, [(i, i=1, masses)], [(i, i=1, masses)], [(2.0_real64, i=1, masses)])
    ! integers of the other kind are taken, too; the diagonal, then the entries below it
    call model%set_triplets(PLM_STIFFNESS, PLM_LOWER, &
        [(int(i, int64), i=1, masses), (int(i, int64), i=2, masses)], &
        [(int(i, int64), i=1, masses), (int(i - 1, int64), i=2, masses)], &
        [(8e4_real64, i=1, masses - 1), 4e4_real64, (-4e4_real64, i=2, masses)])
    call model%set_rayleigh_damping(0.5_real64, 0.0001220703125_real64)
    call model%add_gap_rows([1, 2, 3, 4], [5, 9, 12], [1, 1, 1]*1.0_real64, [2e4_real64, 3e4_real64, 4e4_real64], &
        [0.0_real64, 0.0009765625_real64, 0.001953125_real64])
    force = 0
    force(masses) = 1
    call model%set_excitation(1, cmplx(force, 0, real64))
    call model%build()
    call model%modes(PLM_SYSTEM_OPEN, open_hz)
    call model%modes(PLM_SYSTEM_SLIDING, sliding_hz)
    do i = 1, 2
        write (output_unit, '(a, t20, es24.16e3)') 'open_hz', open_hz(i), 'sliding_hz', sliding_hz(i)
    end do

    call sampler%create(model)
    call sampler%set('mode', 1)
    call sampler%run()
    call basis%create(model)
    call basis%set('kind', 'plm')
    call basis%set_sampler(sampler)
    call basis%build()
    call hbm%create(basis)
    call hbm%set('n_harmonics', 7)
    call hbm%set('frequency_min_hz', 2.0_real64)
    call hbm%set('frequency_max_hz', 5.0)
    call hbm%sweep(curve)
    call basis%get('size', n)
    write (output_unit, '(a, t20, i8)') 'basis_size', n
    call curve%get('n_points', n)
    write (output_unit, '(a, t20, i8)') 'n_points', n
    if (watcher%calls == 0) error stop 'no progress was reported'

    call hbm%find_peak(curve, masses, hz, amplitude, PLM_HALF_PEAK_TO_PEAK, peak=peak)
    write (output_unit, '(a, t20, es24.16e3)') 'peak_hz', hz, 'peak_m', amplitude
    call peak%coefficients(1, masses, coefficient)
    write (output_unit, '(a, t20, es24.16e3)') ('coefficient', coefficient(i, 1), i=1, size(coefficient, 1))
    call peak%closed_share(1, share)
    write (output_unit, '(a, t20, es24.16e3)') ('closed_share', share(i), i=1, size(share))
    call peak%field(1, 0.25_real64, q)
    write (output_unit, '(a, t20, es24.16e3)') ('field', q(i), i=1, masses)
    call context%destroy()
    deallocate (coefficient, share) ! a main program's allocatables live on, and leak checkers report them
end program chain
