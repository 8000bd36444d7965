! module.f90: properties of the module plm: errors by stat and errmsg, options and results of every type, arrays and
! their shapes, listeners, destruction in any order. Prints what fails and stops with an error.
program module_test
    use, intrinsic :: iso_fortran_env, only: real64, int32, int64, error_unit, output_unit
    use plm
    use counting_watchers, only: counting_watcher, counting_logger
    implicit none
    integer, parameter :: n_dof = 6
    integer :: failures = 0

    call facts()
    call errors()
    call matrices()
    call whole_run()
    call study_of_methods()
    call cancelled_run()
    call any_order()
    if (failures > 0) error stop 1
    print '(a)', 'all properties hold'

contains

    subroutine check(holds, text)
        logical, intent(in) :: holds
        character(len=*), intent(in) :: text
        if (holds) return
        write (error_unit, '(a)') 'FAILED: '//text
        failures = failures + 1
    end subroutine check

    subroutine facts()
        integer :: unit
        character(len=80) :: line
        call check(any(plm_version_numbers() > 0), 'the version is not 0.0.0')
        call check(len(plm_build_line()) > 10, 'the build line says something')
        open (newunit=unit, status='scratch')
        call plm_describe_keys(PLM_KIND_HBM, unit)
        rewind (unit)
        read (unit, '(a)') line
        call check(line(1:7) == 'option ', 'keys are described: '//trim(line))
        close (unit)
    end subroutine facts

    ! Six masses in a row, springs of 1e4; the last one and the middle one against stops. Lower triangles.
    subroutine make_model(context, model)
        type(plm_context), intent(in) :: context
        type(plm_model), intent(inout) :: model
        integer :: i
        call model%create(context, n_dof)
        call model%set_csc(PLM_MASS, PLM_LOWER, [(i, i=1, n_dof + 1)], [(i, i=1, n_dof)], &
            [(1.0_real64, i=1, n_dof)])
        call model%set_csc(PLM_STIFFNESS, PLM_LOWER, [1_int64, 3_int64, 5_int64, 7_int64, 9_int64, 11_int64, 12_int64], &
            [1_int64, 2_int64, 2_int64, 3_int64, 3_int64, 4_int64, 4_int64, 5_int64, 5_int64, 6_int64, 6_int64], &
            [2e4_real64, -1e4_real64, 2e4_real64, -1e4_real64, 2e4_real64, -1e4_real64, 2e4_real64, -1e4_real64, &
             2e4_real64, -1e4_real64, 1e4_real64])
        call model%set_modal_damping([0.01_real64])
        call model%add_ground_contacts(reshape([3, 0, 0, 6, 0, 0], [3, 2]), &
            reshape(real([1, 0, 0, 1, 0, 0], real64), [3, 2]), [5e3_real64, PLM_AUTO_STIFFNESS])
        call model%set_excitation(1, real([0, 0, 0, 0, 0, 1], real64))
    end subroutine make_model

    subroutine errors()
        type(plm_context) :: context
        type(plm_model) :: model, never
        integer :: stat
        character(len=200) :: text
        call context%create(stat)
        call check(stat == PLM_OK, 'a context is created')
        call make_model(context, model)
        text = 'untouched'
        call model%set('max_blocks', 5, stat, text)
        call check(stat == PLM_OK .and. text == 'untouched', 'errmsg stays as it is on success')
        call model%set('max_block', 5, stat, text)
        call check(stat == PLM_ERR_KEY .and. index(text, 'max_blocks') > 0, &
            'a wrong key names the nearest: '//trim(text))
        call model%set('max_blocks', 500, stat, text)
        call check(stat == PLM_ERR_ARGUMENT, 'an option out of bounds')
        call model%set_preload([1.0_real64], stat, text)
        call check(stat == PLM_ERR_ARGUMENT .and. index(text, 'plm_model_set_preload') == 1, &
            'a short load: '//trim(text))
        call model%add_ground_contacts(reshape([1, 0, 0], [3, 1]), reshape([1.0_real64, 0.0_real64], [2, 1]), &
            [1.0_real64], stat=stat, errmsg=text)
        call check(stat == PLM_ERR_ARGUMENT .and. index(text, 'shapes') > 0, 'shapes that do not fit: '//trim(text))
        call model%add_gap_rows([1, 3], [1], [1.0_real64], [1.0_real64], stat=stat, errmsg=text)
        call check(stat == PLM_ERR_ARGUMENT .and. index(text, 'the last of row_ptr') > 0, 'a row beyond its entries: '//trim(text))
        call model%add_gap_rows([1, 2], [1, 2], [1.0_real64, -1.0_real64], [1.0_real64], stat=stat, errmsg=text)
        call check(stat == PLM_ERR_ARGUMENT .and. index(text, 'the last of row_ptr') > 0, 'an entry in no row: '//trim(text))
        call model%fix_dofs([7], stat, text)
        call check(stat == PLM_ERR_ARGUMENT .or. stat == PLM_ERR_MATRIX, 'DOF 7 of 6: '//trim(text))
        call never%build(stat, text)
        call check(stat == PLM_ERR_HANDLE .and. len_trim(text) > 0, 'a model that was never created: '//trim(text))
        call context%destroy()
        call model%build(stat, text)
        call check(stat == PLM_ERR_HANDLE .and. len_trim(text) > 0, 'a model whose context is gone: '//trim(text))
        call model%destroy() ! went with its context: nothing left to do, in whatever order
    end subroutine errors

    ! one matrix in each of the forms
    subroutine matrices()
        type(plm_context) :: context
        type(plm_model) :: model
        integer :: form
        real(real64) :: hz(2), expected(2)
        real(real64) :: strided(8)
        integer(int64) :: number(2) = [1, 2]
        call context%create()
        expected = sqrt((3 + [-1, 1]*sqrt(5.0_real64))/2)/(2*acos(-1.0_real64))
        strided = 0
        strided(1::4) = 1
        do form = 1, 4
            call model%create(context, 2)
            ! every fourth element of an array: copied as it must be
            call model%set_triplets(PLM_MASS, PLM_FULL, [1, 2], [1, 2], strided(1::4))
            select case (form)
            case (1)
                call model%set_csc(PLM_STIFFNESS, PLM_LOWER, [1, 3, 4], [1, 2, 2], real([2, -1, 1], real64))
            case (2)
                call model%set_csr(PLM_STIFFNESS, PLM_FULL, [1, 3, 5], [1, 2, 1, 2], real([2, -1, -1, 1], real64))
            case (3)
                call model%set_csr(PLM_STIFFNESS, PLM_UPPER, [1_int64, 3_int64, 4_int64], [1_int64, 2_int64, 2_int64], &
                    real([2, -1, 1], real64))
            case (4)
                call model%set_triplets(PLM_STIFFNESS, PLM_LOWER, [number, 2_int64], [number, 1_int64], &
                    real([2, 1, -1], real64))
            end select
            call model%build()
            call model%modes(PLM_SYSTEM_OPEN, hz)
            call check(all(abs(hz/expected - 1) < 1e-9), 'two masses on two springs')
            call model%destroy()
        end do
        call context%destroy()
    end subroutine matrices

    subroutine whole_run()
        type(plm_context) :: context
        type(plm_model) :: model
        type(plm_sampler) :: sampler
        type(plm_basis) :: basis
        type(plm_hbm) :: hbm
        type(plm_basis) :: small
        real(real64) :: error(3), shift(3)
        type(plm_branch) :: curve, peak, one
        type(counting_logger), target :: logger
        real(real64) :: hz(2), shapes(n_dof, 2), r, peak_hz, peak_m, q(n_dof), max_step
        real(real64), allocatable :: frequency(:), value(:), harmonic(:), c(:, :), u(:, :), f(:, :), columns(:, :)
        logical, allocatable :: closed(:, :)
        logical :: include_ends
        integer, allocatable :: iterations(:)
        integer(int64), allocatable :: wide(:)
        character(len=:), allocatable :: text
        character(len=200) :: message
        integer :: n, h, i, severity, stat
        integer(int64) :: n64
        call context%create()
        call context%set_log(logger)
        call make_model(context, model)
        call model%build()
        call model%modes(PLM_SYSTEM_GIVEN, hz, shapes, closed=[.true., .false.])
        call check(abs(norm2(shapes(:, 1)) - 1) < 1e-9, 'modes are mass-normalised')
        call model%audit(n)
        do i = 1, n
            call model%finding(i, severity, r, text)
            call check(severity >= 0 .and. len(text) > 0, 'a finding has words')
        end do
        call sampler%create(model)
        call sampler%set('mode', 1_int64)
        call sampler%set('include_ends', .false.)
        call sampler%get('include_ends', include_ends)
        call check(.not. include_ends, 'a logical is set and read')
        call sampler%set('system', 'open')
        call sampler%get('system', text)
        call check(text == 'open', 'a word is set and read')
        call sampler%run()
        call basis%create(model)
        call basis%set_sampler(sampler)
        call basis%build()
        call basis%get('size', n)
        allocate (columns(n_dof, n))
        call basis%vectors(columns)
        call basis%residual(columns(:, n), r)
        call check(r < 1e-10, 'a basis represents its own columns')
        call hbm%create(basis)
        call hbm%set('max_step', 0.125)
        call hbm%get('max_step', max_step)
        call check(abs(max_step - 0.125_real64) <= 0, 'a default real is set and read')
        call hbm%sweep(curve, stat)
        call check(stat == PLM_OK, 'the sweep ends well')
        call curve%get('n_points', n64)
        call curve%get('frequency_hz', frequency)
        call curve%get('iterations', iterations)
        call curve%get('iterations', wide)
        call check(size(frequency) == n64 .and. size(iterations) == n64, 'arrays have their lengths')
        call check(all(wide == iterations), 'integers of both kinds are the same')
        call hbm%find_peak(curve, n_dof, peak_hz, peak_m, PLM_HARMONIC, 1, peak)
        call curve%describe(text)
        call check(index(text, 'magnitude of one harmonic, number 1, of DOF') > 0, 'a page of text about the curve')
        call curve%amplitude(n_dof, value, PLM_HARMONIC, 1)
        call check(maxval(value) <= peak_m*1.01_real64, 'no point is above the peak, which has more harmonics')
        call peak%amplitude(n_dof, harmonic, PLM_HARMONIC, 1)
        call peak%get('n_harmonics', h)
        call peak%coefficients(1, n_dof, c)
        call check(all(shape(c) == [2*h + 1, 1]), 'coefficients have their shape')
        call check(abs(hypot(c(2, 1), c(3, 1))/harmonic(1) - 1) < 1e-12, 'harmonic 1 by its coefficients')
        call peak%field(1, 0.0_real64, q)
        ! its first ones: an exact motion has more
        call check(abs(q(n_dof) - c(1, 1) - sum(c(2::2, 1))) < 1e-4*peak_m, 'the field at time 0 by its coefficients')
        call peak%contact(1, 8, u, f, closed)
        call check(all(shape(u) == [2, 8]) .and. all(closed .eqv. u > 0), 'closed where the penetration is positive')
        call check(all(f >= 0), 'contact does not pull')
        call peak%get('frequency_hz', frequency)
        call hbm%solve(frequency(1), one, start=peak, point=1)
        call one%amplitude(n_dof, value, PLM_HARMONIC, 1)
        call check(abs(value(1)/peak_m - 1) < 1e-2, 'solve at the peak finds the peak') ! which has more harmonics
        call one%full_residual(1, r)
        call check(r < 1, 'the full residual is a number')
        call hbm%estimate_error(peak, 1, n_dof, error, measure=PLM_HARMONIC)
        call check(abs(error(1)) < 0.01*peak_m .and. abs(error(3)) <= 0, 'an exact motion lacks no harmonics')
        call hbm%estimate_error(peak, 1, n_dof, frequency_hz=shift)
        call check(maxval(abs(shift)) < 0.1*peak_hz, 'the error of the peak, without the amplitude')
        call hbm%refine_basis(n_dof, 1e-3_real64, small, error(1))
        call check(error(1) < 1e-3, 'a basis for a tolerance')
        call small%create(model)
        call small%set('kind', 'pod')
        call small%set_parent(basis)
        call small%set_responses([curve, peak])
        call small%set('pod_size', 1)
        call small%build()
        call small%get('size', h)
        call check(h == 1, 'a basis of responses')
        call small%set_responses()
        call small%build(stat)
        call check(stat == PLM_ERR_STATE, 'responses are forgotten')
        call check(logger%lines > 0, 'the logger was called')
        call hbm%set('max_points', 3)
        call hbm%sweep(curve, stat, message)
        call check(stat == PLM_TRUNCATED .and. index(message, 'max_points reached') > 0, 'an outcome: '//trim(message))
        call check(context%error_reason() == PLM_REASON_POINT_LIMIT, 'the reason of an outcome')
        call context%destroy()
    end subroutine whole_run

    subroutine study_of_methods()
        type(plm_context) :: context
        type(plm_model) :: model
        type(plm_sampler) :: sampler
        type(plm_basis) :: basis
        type(plm_hbm) :: hbm
        type(plm_transient) :: motion
        type(plm_study) :: study
        type(plm_branch) :: curve
        real(real64), allocatable :: error(:), hz(:), amplitude(:), low(:)
        integer, allocatable :: sizes(:)
        character(len=:), allocatable :: text
        character(len=200) :: message
        integer :: i, stat, n
        call context%create()
        call make_model(context, model)
        call model%build()
        call sampler%create(model)
        call sampler%set('mode', 1)
        call basis%create(model)
        call basis%set_sampler(sampler)
        call hbm%create(basis)
        call hbm%set('n_harmonics', 3)
        call hbm%set('stability', 'off')
        call motion%create(model, basis)
        call motion%set('settled', 1e-3_real64)
        call motion%set('periods', 1000)
        call study%create(model)
        call study%set('repeats', 1)
        call study%set('curve_tolerance', 1e-4_real64)
        call study%set_output(n_dof, PLM_HALF_PEAK_TO_PEAK)
        call study%set_force_levels([0.5_real64, 1.0_real64])
        call study%add_response('three harmonics', hbm, i)
        call check(i == 1, 'methods count from 1')
        call study%add_compressed('compressed', hbm, 2)
        call study%add_compressed('compressed by tolerance', hbm)
        call study%add_refined('refined', hbm, 1e-2_real64)
        call study%add_marching('marching', motion, 2, i)
        call check(i == 5, 'the fifth method')
        call study%add_response('refined', hbm, i, stat, message)
        call check(stat == PLM_ERR_ARGUMENT .and. i == 5, 'a name is used once: '//trim(message))
        call study%outcome(1, text, stat)
        call check(stat == PLM_ERR_STATE, 'no outcome before a run')
        call hbm%set('n_harmonics', 7)
        call study%set_reference(hbm)
        call study%run()
        call study%name(4, text)
        call check(text == 'refined', 'a name is read: '//text)
        call study%outcome(0, text)
        call check(text == 'reached the end of its range', 'the outcome of the reference: '//text)
        call study%get('amplitude_error', error)
        call study%get('basis_size', sizes)
        call check(size(error) == 5 .and. error(1) > 1e-8_real64 .and. error(1) < 0.1_real64, &
            'three harmonics are not seven')
        call check(sizes(2) == 2 .and. all(sizes > 0), 'sizes of bases')
        call study%curve(1, curve, 2)
        call curve%get('n_harmonics', n)
        call check(n == 3, 'the curve of a method is that of its options')
        call study%curve(5, curve, stat=stat)
        call check(stat == PLM_ERR_STATE, 'marching has points only')
        call study%points(1, hz, amplitude, 2)
        call study%points(1, hz, low)
        call check(size(hz) == size(low) .and. maxval(amplitude) > 1.2_real64*maxval(low), 'points at two levels')
        call study%points(1, hz, low, 3, stat)
        call check(stat == PLM_ERR_ARGUMENT, 'two levels only')
        call study%write('no/such/folder', stat, message)
        call check(stat == PLM_ERR_ARGUMENT .and. index(message, 'plm_study_write') == 1, 'files: '//trim(message))
        call study%set_reference()
        call study%run(stat)
        call study%curve(0, curve)
        call curve%get('n_harmonics', n)
        call check(stat == PLM_OK .and. n == 3, 'the reference by default has the options of the first method')
        call study%destroy()
        call context%destroy()
    end subroutine study_of_methods

    subroutine cancelled_run()
        type(plm_context) :: context
        type(plm_model) :: model
        type(plm_basis) :: basis
        type(plm_hbm) :: hbm
        type(plm_branch) :: curve
        type(counting_watcher), target :: watcher
        integer :: stat, reason, n
        call context%create()
        call make_model(context, model)
        call model%build()
        call basis%create(model)
        call basis%set('kind', 'full')
        call basis%set('frequency_min_hz', 2.0)
        call basis%set('frequency_max_hz', 8.0)
        call basis%build()
        call hbm%create(basis)
        call context%set_progress(watcher)
        watcher%cancel_at = watcher%calls + 30
        call hbm%sweep(curve, stat)
        call check(stat == PLM_CANCELLED, 'the watcher stops the sweep')
        if (stat == PLM_CANCELLED) then
            call curve%get('end_reason', reason)
            call curve%get('n_points', n)
            call check(reason == PLM_REASON_CANCELLED .and. n > 0, 'and leaves the points found')
        end if
        call context%set_progress()
        n = watcher%calls
        call hbm%sweep(curve)
        call check(watcher%calls == n, 'a watcher taken away is not called')
        call context%destroy()
    end subroutine cancelled_run

    ! parents first
    subroutine any_order()
        type(plm_context) :: context
        type(plm_model) :: model
        type(plm_sampler) :: sampler
        real(real64) :: blf
        call context%create()
        call make_model(context, model)
        call model%build()
        call sampler%create(model)
        call sampler%set('mode', 1)
        call model%destroy()
        call sampler%run()
        call sampler%get('blf_hz', blf)
        call check(blf > 0, 'a sampler keeps its model alive')
        call sampler%destroy()
        call sampler%destroy()
        call context%destroy()
        call context%destroy()
    end subroutine any_order

end program module_test
