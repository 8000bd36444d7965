! scenario.f90: the scene of scenario.c in modern Fortran. DOFs, pairs and points count from 1 here.
module counting
    use, intrinsic :: iso_fortran_env, only: int8, real64
    use plm, only: plm_writer
    implicit none
    private
    public :: counter

    ! bytes, and the sum of their values, of pieces handed over
    type, extends(plm_writer) :: counter
        real(real64) :: n = 0, total = 0
    contains
        procedure :: write => count_bytes
    end type counter

contains

    subroutine count_bytes(self, bytes, failed)
        class(counter), intent(inout) :: self
        integer(int8), intent(in) :: bytes(:)
        logical, intent(inout) :: failed
        failed = size(bytes) < 1
        self%n = self%n + size(bytes)
        self%total = self%total + sum(real(iand(int(bytes), 255), real64))
    end subroutine count_bytes

end module counting

program scenario
    use, intrinsic :: iso_fortran_env, only: int8, real64, output_unit
    use plm
    use counting, only: counter
    implicit none
    integer, parameter :: n_masses = 10, n_harmonics = 5, n_times = 8, watched = 8
    integer :: relative ! output
    type(plm_context) :: context
    type(plm_model) :: model
    type(plm_basis) :: basis

    call context%create()
    call make_model(context, model)
    call show_model(model)
    call show_coupled(context)
    call make_basis(model, basis)
    call show_response(model, basis)
    call context%destroy()

contains

    subroutine show(name, values)
        character(len=*), intent(in) :: name
        real(real64), intent(in) :: values(:)
        write (output_unit, '(a)') name
        write (output_unit, '(es24.16e3)') values
    end subroutine show

    subroutine show_integers(name, values)
        character(len=*), intent(in) :: name
        integer, intent(in) :: values(:)
        write (output_unit, '(a)') name
        write (output_unit, '(i0)') values
    end subroutine show_integers

    subroutine make_model(context, model)
        type(plm_context), intent(in) :: context
        type(plm_model), intent(inout) :: model
        real(real64) :: force(n_masses), preload(n_masses)
        complex(real64) :: grows(n_masses), base(n_masses)
        integer :: i
        call model%create(context, n_masses)
        call model%set_triplets(PLM_MASS, PLM_LOWER, [(i, i=1, n_masses)], [(i, i=1, n_masses)], &
            [(1.0_real64, i=1, n_masses)])
        call model%set_triplets(PLM_STIFFNESS, PLM_LOWER, [(i, i=1, n_masses), (i, i=2, n_masses)], &
            [(i, i=1, n_masses), (i - 1, i=2, n_masses)], &
            [(2e4_real64, i=1, n_masses - 1), 1e4_real64, (-1e4_real64, i=2, n_masses)])
        call model%set_rayleigh_damping(0.5_real64, 0.0002_real64)
        call model%fix_dofs([1])
        call model%add_constraints([1, 4], [7, 6, 8], [1.0_real64, -0.5_real64, -0.5_real64])
        call model%add_gap_rows([1, 3, 4], [3, 6, 9], [1.0_real64, -1.0_real64, 1.0_real64], &
            [PLM_AUTO_STIFFNESS, 2e4_real64], [0.0_real64, 0.001_real64])
        force = 0
        force(5) = 10
        preload = 0
        preload(9) = 5
        grows = 0
        grows(9) = 4e-4_real64
        grows(8) = cmplx(0.0_real64, 2e-4_real64, real64)
        call model%set_preload(preload)
        call model%set_excitation(1, force)
        call model%set_growing_excitation(1, 2, grows)
        call model%set_gap_motion(2, [(0.0_real64, 0.0_real64), (2e-5_real64, 1e-5_real64)])
        base = 0
        base(1) = cmplx(1e-4_real64, 5e-5_real64, real64)
        call model%set_base_motion(PLM_DISPLACEMENT, 1, base)
        call model%build()
        call model%add_outputs([1, 3], [3, 6], [1.0_real64, -1.0_real64], relative)
    end subroutine make_model

    subroutine show_coupled(context)
        type(plm_context), intent(in) :: context
        type(plm_model) :: model
        real(real64), allocatable :: values(:)
        integer :: i, n, others(23), face(3, 3), slave, master
        real(real64) :: corners(3, 3), distance(1), hz(4)
        others = [(i, i=1, 21), 23, 24]
        face = reshape([(i, i=7, 15)], [3, 3])
        corners = 0
        do i = 1, 3
            corners(i, i) = 1
        end do
        call model%create(context, 24)
        call model%set_triplets(PLM_MASS, PLM_LOWER, others, others, [(1.0_real64, i=1, 23)])
        call model%set_triplets(PLM_STIFFNESS, PLM_LOWER, [others, 23, 24], [others, 22, 22], &
            [1e3_real64 * others, -1.0_real64, 1.0_real64])
        call model%add_distributing_coupling([(i, i=1, 6)], [0.0_real64, 0.0_real64, 0.0_real64], face, corners, &
            [1.0_real64, 2.0_real64, 3.0_real64])
        call model%add_rigid_link([(i, i=1, 6)], [0.0_real64, 0.0_real64, 0.0_real64], reshape([16, 17, 18], [3, 1]), &
            reshape([1.0_real64, 1.0_real64, 0.0_real64], [3, 1]))
        call model%add_tie(reshape([19, 20, 21], [3, 1]), reshape([0.4_real64, 0.4_real64, 0.5_real64], [3, 1]), &
            face, corners, [1, 4], [1, 2, 3], 1.0_real64, distance)
        call model%set_multipliers([22])
        call model%add_surface(face, corners, [1, 4], [1, 2, 3], slave)
        call model%add_surface(spread(spread(0, 1, 3), 2, 3), reshape([1.5_real64, 0.5_real64, 0.5_real64, 0.5_real64, &
            0.5_real64, 1.5_real64, 0.5_real64, 1.5_real64, 0.5_real64], [3, 3]), [1, 4], [1, 2, 3], master)
        call model%add_surface_contact(slave, master, int(PLM_SURFACE_SMOOTH), 50.0_real64, 2.0_real64, 0.1_real64)
        call model%set_rest_force([3.0_real64, PLM_KEEP_GAP, 0.0_real64])
        call model%set_coordinates(face, corners)
        call model%build()
        call model%get('n_free', n)
        call show_integers('coupled_n_free', [n])
        call model%audit(n)
        call show_integers('coupled_findings', [n])
        call show('tie_distance', distance)
        call model%modes(PLM_SYSTEM_OPEN, hz)
        call show('coupled_hz', hz)
        call model%solve_rest()
        call model%get('surface_gap', values)
        call show('surface_gap', values)
        call model%get('rest_force', values)
        call show('surface_force', values)
        call model%get('initial_gap', values)
        call show('surface_rest_gap', values)
        call model%destroy()
    end subroutine show_coupled

    subroutine show_model(model)
        type(plm_model), intent(inout) :: model
        real(real64), allocatable :: values(:)
        real(real64) :: hz(3)
        integer :: n
        call model%get('n_free', n)
        call show_integers('n_free', [n])
        call model%get('contact_stiffness', values)
        call show('contact_stiffness', values)
        call model%solve_rest()
        call model%get('rest_displacement', values)
        call show('rest_displacement', values)
        call model%modes(PLM_SYSTEM_OPEN, hz)
        call show('open_hz', hz)
        call model%modes(PLM_SYSTEM_SLIDING, hz)
        call show('sliding_hz', hz)
    end subroutine show_model

    subroutine make_basis(model, basis)
        type(plm_model), intent(in) :: model
        type(plm_basis), intent(inout) :: basis
        type(plm_sampler) :: sampler
        real(real64), allocatable :: values(:)
        integer, allocatable :: closed(:)
        real(real64) :: blf_hz
        call sampler%create(model)
        call sampler%set('system', 'open')
        call sampler%set('mode', 1)
        call sampler%set('n_samples', 3)
        call sampler%run()
        call sampler%get('blf_hz', blf_hz)
        call show('blf_hz', [blf_hz])
        call sampler%get('sweep_alpha', values)
        call show('sweep_alpha', values)
        call sampler%get('selected_samples', closed)
        call show_integers('selected_samples', closed)
        call basis%create(model)
        call basis%set_sampler(sampler)
        call basis%set('n_harmonics', n_harmonics)
        call basis%build()
        call basis%get('singular_values', values)
        call show('singular_values', values)
        call sampler%destroy()
    end subroutine make_basis

    subroutine show_response(model, basis)
        type(plm_model), intent(in) :: model
        type(plm_basis), intent(in) :: basis
        type(plm_hbm) :: hbm
        type(plm_branch) :: curve, peak, lower
        real(real64), allocatable :: values(:)
        real(real64) :: hz, amplitude
        integer :: n
        call hbm%create(basis)
        call hbm%set('n_harmonics', n_harmonics)
        call hbm%set('unknowns', 'modal')
        call hbm%set('max_step', 0.05_real64)
        call hbm%sweep(curve)
        call curve%get('n_points', n)
        call show_integers('n_points', [n])
        call curve%get('frequency_hz', values)
        call show('frequency_hz', values)
        call curve%amplitude(watched, values, PLM_HALF_PEAK_TO_PEAK)
        call show('amplitude', values)
        call hbm%sweep_levels([0.8_real64, 0.5_real64], n)
        call hbm%found(n, lower)
        call lower%get('n_points', n)
        call show_integers('level_points', [n])
        call show_resumed(hbm)
        call hbm%find_peak(curve, watched, hz, amplitude, PLM_HALF_PEAK_TO_PEAK, peak=peak)
        call show('peak', [hz, amplitude])
        call show_read(model, basis, curve)
        call show_whole_way(model)
        call show_estimate(model, basis, hbm, curve, peak)
        call show_point(peak, 1)
        call show_stability(curve, 6)
        call show_motion(model, basis, curve, 6)
        call show_study(model, basis, hbm)
    end subroutine show_response

    ! a curve that ends early, and goes on
    subroutine show_resumed(hbm)
        type(plm_hbm), intent(inout) :: hbm
        type(plm_branch) :: part, whole
        real(real64), allocatable :: values(:)
        integer :: stat, unit
        call hbm%set('max_points', 12)
        call hbm%sweep(part, stat=stat)
        call hbm%set('max_points', 1000)
        call hbm%save_every(5, 'parity_f90.plm')
        call hbm%resume(part, whole)
        call hbm%save_every(0, '')
        open (newunit=unit, file='parity_f90.plm', status='old')
        close (unit, status='delete')
        call whole%amplitude(watched, values, PLM_HALF_PEAK_TO_PEAK)
        call show('resumed_amplitude', values)
        call part%destroy()
        call whole%destroy()
    end subroutine show_resumed

    ! basis and curve through their bytes
    subroutine show_read(model, basis, curve)
        type(plm_model), intent(in) :: model
        type(plm_basis), intent(in) :: basis
        type(plm_branch), intent(in) :: curve
        type(plm_basis) :: again
        type(plm_branch) :: read
        integer(int8), allocatable :: bytes(:)
        real(real64), allocatable :: values(:)
        real(real64) :: residual
        type(counter), target :: of_basis, of_curve, of_table
        call basis%write_to(of_basis)
        call show('written_basis', [of_basis%n])
        call curve%write_to(of_curve)
        call show('written_curve', [of_curve%n])
        call curve%write_csv_to(of_table, watched)
        call show('written_table', [of_table%n, of_table%total])
        call basis%to_bytes(bytes)
        call again%read(context, bytes)
        call again%attach(model)
        call curve%to_bytes(bytes)
        call again%read_branch(bytes, read)
        call read%amplitude(watched, values, PLM_HALF_PEAK_TO_PEAK)
        call show('read_amplitude', values)
        call read%full_residual(4, residual)
        call show('read_residual', [residual])
        call read%destroy()
        call again%destroy()
    end subroutine show_read

    subroutine show_whole_way(model)
        type(plm_model), intent(in) :: model
        type(plm_hbm) :: hbm
        type(plm_branch) :: curve
        real(real64) :: hz, amplitude, error
        integer :: n
        call plm_compute_response(model, watched, hz, amplitude, curve, 1e-4_real64, PLM_HALF_PEAK_TO_PEAK, error, hbm)
        call show('response', [hz, amplitude, error])
        call hbm%get('accuracy', error)
        call show('accuracy', [error])
        call curve%get('basis_size', n)
        call show_integers('basis_size', [n])
    end subroutine show_whole_way

    subroutine show_estimate(model, basis, hbm, curve, peak)
        type(plm_model), intent(in) :: model
        type(plm_basis), intent(in) :: basis
        type(plm_hbm), intent(inout) :: hbm
        type(plm_branch), intent(in) :: curve, peak
        type(plm_basis) :: small
        real(real64), allocatable :: values(:)
        real(real64) :: amplitude(3), hz(3)
        call hbm%estimate_error(peak, 1, watched, amplitude, hz, PLM_HALF_PEAK_TO_PEAK)
        call show('error', [amplitude, hz])
        call small%create(model)
        call small%set('kind', 'pod')
        call small%set('pod_tolerance', 1e-3_real64)
        call small%set_parent(basis)
        call small%set_responses([curve])
        call small%build()
        call small%get('lambda', values)
        call show('pod_lambda', values)
        call hbm%refine_basis(watched, 1e-2_real64, small, amplitude(1), PLM_HALF_PEAK_TO_PEAK)
        call show('refined_error', amplitude(:1))
        call small%get('lambda', values)
        call show('refined_lambda', values)
    end subroutine show_estimate

    subroutine show_stability(branch, point)
        type(plm_branch), intent(in) :: branch
        integer, intent(in) :: point
        integer, allocatable :: flags(:)
        complex(real64), allocatable :: multipliers(:)
        real(real64) :: x(2)
        call branch%get('bifurcation', flags)
        call show_integers('bifurcation', flags)
        call branch%get('stable', flags)
        call show_integers('stable', flags)
        call branch%multipliers(point, multipliers)
        call show('multipliers_real', real(multipliers))
        call show('multipliers_imag', aimag(multipliers))
        call branch%periodicity_defect(point, x(1))
        call show('periodicity_defect', x(1:1))
        call branch%energy(point, x(1), x(2))
        call show('energy', x)
    end subroutine show_stability

    subroutine show_motion(model, basis, branch, point)
        type(plm_model), intent(in) :: model
        type(plm_basis), intent(in) :: basis
        type(plm_branch), intent(in) :: branch
        integer, intent(in) :: point
        type(plm_transient) :: motion
        real(real64), allocatable :: values(:), q(:), v(:)
        complex(real64), allocatable :: multipliers(:)
        call motion%create(model, basis)
        call motion%set('periods', 2)
        call motion%set('steps_per_period', 16)
        call motion%observe([3, watched])
        call motion%start_at(branch, point)
        call motion%run()
        call motion%get('time', values)
        call show('time', values)
        call motion%history(2, values)
        call show('history', values)
        call motion%state(q, v)
        call show('state_q', q)
        call show('state_v', v)
        call motion%set_state(q)
        call motion%run()
        call motion%history(1, values)
        call show('let_go', values)
        call motion%start_at(branch, point)
        call motion%find_periodic()
        call motion%multipliers(multipliers)
        call show('periodic_multipliers_real', real(multipliers))
        call show('periodic_multipliers_imag', aimag(multipliers))
    end subroutine show_motion

    subroutine show_study(model, basis, hbm)
        type(plm_model), intent(in) :: model
        type(plm_basis), intent(in) :: basis
        type(plm_hbm), intent(inout) :: hbm
        character(len=15), parameter :: keys(4) = &
            [character(len=15) :: 'frequency_error', 'amplitude_error', 'curve_error_l2', 'curve_error_max']
        type(plm_study) :: study
        type(plm_transient) :: motion
        type(plm_branch) :: curve
        real(real64), allocatable :: values(:), hz(:)
        integer, allocatable :: sizes(:)
        character(len=:), allocatable :: text
        integer :: i, n
        call motion%create(model, basis)
        call motion%set('settled', 1e-4_real64)
        call motion%set('periods', 2000)
        call study%create(model)
        call study%set('repeats', 1)
        call study%set('curve_tolerance', 1e-4_real64)
        call study%set_output(watched, PLM_HALF_PEAK_TO_PEAK)
        call study%set_force_levels([0.5_real64, 1.0_real64])
        call hbm%set('max_step', 0.25_real64)
        call hbm%set('stability', 'off')
        call hbm%set('n_harmonics', 3)
        call study%add_response('three harmonics', hbm)
        call hbm%set('n_harmonics', n_harmonics)
        call study%add_compressed('compressed', hbm, 3)
        call study%add_refined('refined', hbm, 1e-2_real64)
        call study%add_marching('marching', motion, 3, n)
        call study%set_reference(hbm)
        call study%run()
        do i = 1, size(keys)
            call study%get(trim(keys(i)), values)
            call show(trim(keys(i)), values)
        end do
        call study%get('basis_size', sizes)
        call show_integers('basis_size', sizes)
        call study%name(n, text)
        call study%get('reference_size', n)
        call show_integers('reference_size', [n])
        write (output_unit, '(a)') text
        call study%outcome(0, text)
        write (output_unit, '(a)') text
        call study%curve(2, curve, 2)
        call curve%get('n_points', n)
        call show_integers('study_curve', [n])
        call study%points(1, hz, values, 2)
        call show('study_hz', hz)
        call show('study_amplitude', values)
        call study%destroy()
    end subroutine show_study

    subroutine show_point(branch, point)
        type(plm_branch), intent(in) :: branch
        integer, intent(in) :: point
        real(real64), allocatable :: coefficient(:, :), penetration(:, :), force(:, :), share(:)
        logical, allocatable :: closed(:, :)
        real(real64) :: q(n_masses), history(n_times), residual
        call branch%coefficients(point, watched, coefficient)
        call show('coefficients', coefficient(:, 1))
        call branch%coefficients(point, relative, coefficient)
        call show('relative', coefficient(:, 1))
        call branch%history(point, relative, history)
        call show('relative_history', history)
        call branch%field(point, 0.25_real64, q)
        call show('field', q)
        call branch%contact(point, n_times, penetration, force, closed)
        call show('penetration', [penetration])
        call show('force', [force])
        call show_integers('closed', merge(1, 0, [closed]))
        call branch%closed_share(point, share)
        call show('closed_share', share)
        call branch%full_residual(point, residual)
        call show('full_residual', [residual])
    end subroutine show_point

end program scenario
