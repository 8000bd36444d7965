! The tall operations of a Fortran host (examples/fortran/tall_host.f90) against its matrices: a rod with loose joints, clamped, free
! with a dashpot, and with DOFs that have no mass.
program tall
    use, intrinsic :: iso_c_binding, only: c_funloc, c_loc
    use, intrinsic :: iso_fortran_env, only: real64
    use plm
    use plm_c, only: plm_model_set_tall_operations
    use tall_hosts
    implicit none
    integer, parameter :: n = 60, modes = 8
    type(plm_context) :: context
    integer :: failures = 0
    call context%create()
    call compare('clamped', .true., .false.)
    call compare('free', .false., .false.)
    call compare('with DOFs without mass', .true., .true.)
    call context%destroy()
    if (failures > 0) error stop 1

contains

    subroutine matrices(clamped, massless, m, k, c)
        logical, intent(in) :: clamped, massless
        real(real64), intent(out), allocatable :: m(:, :), k(:, :), c(:, :)
        integer :: i
        allocate (m(n, n), k(n, n), source=0.0_real64)
        do i = 1, n
            if (.not. massless .or. modulo(i, 7) /= 3) m(i, i) = 1 + 0.3d0*sin(real(i, real64))
            if (i < n) k(i:i + 1, i:i + 1) = k(i:i + 1, i:i + 1) + 4d4*(1 + 0.1d0*cos(real(i, real64)))* &
                reshape([1, -1, -1, 1], [2, 2])
        end do
        if (clamped) k(1, 1) = k(1, 1) + 5d4
        if (clamped) return
        allocate (c(n, n), source=0.0_real64)
        c(n/2:n/2 + 1, n/2:n/2 + 1) = reshape([0.8d0, -0.8d0, -0.8d0, 0.8d0], [2, 2])
    end subroutine matrices

    subroutine finish_model(model)
        type(plm_model), intent(inout) :: model
        real(real64) :: force(n)
        call model%set_rayleigh_damping(0d0, 2d-4)
        call model%set('space_tolerance', 1d-10) ! what is cut off is not the same in both
        call model%add_gap_rows([1, 3, 5], [n/4 + 1, n/4, n - 3, n - 4], [1d0, -1d0, 1d0, -1d0], [3d4, 5d4], [0d0, 0d0])
        force = 0
        force([n/3, n - 2]) = [3, -3] ! balanced, as a free rod must be
        call model%set_excitation(1, force)
        force = 0
        force([n, n/4]) = [0.2d0, -0.2d0] ! apart, which closes the joints
        call model%set_preload(force)
        call model%build()
    end subroutine finish_model

    subroutine compare(name, clamped, massless)
        character(len=*), intent(in) :: name
        logical, intent(in) :: clamped, massless
        type(tall_host), target :: host
        type(plm_model) :: model(2)
        real(real64) :: hz(modes, 2, 2), rest(2, 2), peak(2, 2)
        real(real64), allocatable :: penetration(:)
        integer :: system(2) = [PLM_SYSTEM_OPEN, PLM_SYSTEM_REST], i, s, status
        peak = 0
        call matrices(clamped, massless, host%m, host%k, host%c)
        call model(1)%create(context, n)
        call model(1)%set_dense_matrix(PLM_MASS, PLM_FULL, host%m)
        call model(1)%set_dense_matrix(PLM_STIFFNESS, PLM_FULL, host%k)
        if (allocated(host%c)) call model(1)%set_dense_matrix(PLM_DAMPING, PLM_FULL, host%c)
        call model(2)%create(context, n)
        status = plm_model_set_tall_operations(model(2)%handle, c_funloc(tall_operation), c_loc(host))
        do i = 1, 2
            call finish_model(model(i))
            do s = 1, 2
                call model(i)%modes(system(s), hz(:, s, i))
            end do
            call model(i)%solve_rest()
            call model(i)%get('rest_penetration', penetration)
            rest(:, i) = penetration
            if (clamped .and. .not. massless) call plm_compute_response(model(i), n/3, peak(1, i), peak(2, i), accuracy=1d-3)
        end do
        call expect(status == PLM_OK .and. host%calls > 100, name//': the operations are not called')
        call expect(all(abs(hz(:, :, 2) - hz(:, :, 1)) <= 1d-9*hz(:, :, 1)), name//': frequencies')
        call expect(maxval(abs(rest(:, 2) - rest(:, 1))) <= 1d-8*maxval(abs(rest(:, 1))), name//': rest')
        call expect(all(abs(peak(:, 2) - peak(:, 1)) <= 1d-8*peak(:, 1)), name//': peak')
        if (failures > 0) print *, name, maxval(abs(hz(:, :, 2)/max(hz(:, :, 1), 1d-9) - 1)), &
            maxval(abs(rest(:, 2) - rest(:, 1)))/maxval(abs(rest(:, 1))), peak
        call model(2)%destroy()
        call expect(host%ends == 1, name//': one end')
        call model(1)%destroy()
    end subroutine compare

    subroutine expect(holds, what)
        logical, intent(in) :: holds
        character(len=*), intent(in) :: what
        if (holds) return
        failures = failures + 1
        print '(a)', what
    end subroutine expect

end program tall
