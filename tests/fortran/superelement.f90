! superelement.f90: a structure that the host has reduced itself, through the module plm: one coordinate of two masses,
! T = (0.5, 1). Prints what fails and stops with an error.
module reduced_rods
    use, intrinsic :: iso_fortran_env, only: real64
    use plm, only: plm_recoverer
    implicit none
    private
    public :: reduced_rod

    type, extends(plm_recoverer) :: reduced_rod
        real(real64) :: t(2, 1) = reshape([0.5_real64, 1.0_real64], [2, 1])
        logical :: fails = .false.
    contains
        procedure :: recover
    end type reduced_rod

contains

    subroutine recover(self, reduced, full, failed)
        class(reduced_rod), intent(inout) :: self
        real(real64), intent(in) :: reduced(:, :)
        real(real64), intent(inout) :: full(:, :)
        logical, intent(inout) :: failed
        full = matmul(self%t, reduced)
        failed = self%fails
    end subroutine recover

end module reduced_rods

program superelement
    use, intrinsic :: iso_fortran_env, only: real64, error_unit
    use plm
    use reduced_rods, only: reduced_rod
    implicit none
    real(real64), parameter :: one(1, 1) = 1
    type(plm_context) :: context
    type(plm_model) :: model
    type(plm_branch) :: curve
    type(reduced_rod), target :: rod
    real(real64) :: hz, peak, full(2, 3), mass(2, 1)
    real(real64), allocatable :: first(:), second(:)
    integer :: failures = 0, stat
    character(len=200) :: text

    call context%create()
    call context%set_threads(2)
    call context%set_effort(30.0d0)
    call context%set_threads(0, stat)
    call check(stat == PLM_ERR_ARGUMENT, 'no thread at all is refused')
    call model%create(context, 1)
    mass(:, 1) = [1.25_real64, -99.0_real64] ! a leading dimension of two
    call model%set_dense_matrix(PLM_MASS, PLM_FULL, mass)
    call model%set_dense_matrix(PLM_STIFFNESS, PLM_LOWER, 5e3_real64*one)
    call model%add_dense_gap_rows(one, [5e3_real64], [1e-5_real64])
    call model%add_dense_gap_rows(reshape([one, one], [1, 2]), [5e3_real64], stat=stat)
    call check(stat == PLM_ERR_ARGUMENT, 'rows of another width are refused')
    call model%set_excitation(1, [1.0_real64])
    call model%set_rayleigh_damping(0.0_real64, 5e-4_real64)
    call model%set_recovery(2, rod)
    call model%build()
    call model%recover(reshape([1.0_real64, 2.0_real64, 3.0_real64], [1, 3]), full)
    call check(maxval(abs(full(2, :) - [1, 2, 3])) < 1e-12_real64 .and. maxval(abs(full(1, :) - 0.5*full(2, :))) < &
        1e-12_real64, 'three motions are recovered')
    call plm_compute_response(model, 1, hz, peak, curve)
    call curve%recovered_amplitude(model, 1, first)
    call curve%recovered_amplitude(model, 2, second)
    call check(abs(maxval(second) - peak) < 1e-2*peak, 'the mass that is kept has the peak')
    call check(all(abs(first - 0.5*second) <= 1e-12*peak), 'the other one moves half as far')
    rod%fails = .true.
    text = ''
    call model%recover(one, full(:, 1:1), stat, text)
    call check(stat == PLM_ERR_CALLBACK .and. index(text, 'recovery') > 0, 'a failure comes back')
    call model%destroy()
    call context%destroy()
    if (failures > 0) error stop 1
    print '(a)', 'all properties hold'

contains

    subroutine check(holds, what)
        logical, intent(in) :: holds
        character(len=*), intent(in) :: what
        if (holds) return
        write (error_unit, '(a)') 'FAILED: '//what
        failures = failures + 1
    end subroutine check

end program superelement
