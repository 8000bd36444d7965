! cracked_beam.f90: a finite-element host in modern Fortran. It assembles its beam, hands it to libplm in process, and
! writes the response of the tip around the first bending resonance, where the crack opens and closes in every cycle. One
! call, and no option: basis, harmonics and range follow from the accuracy, 1e-3.
!
!     cracked_beam [file.csv]
program cracked_beam
    use, intrinsic :: iso_fortran_env, only: real64
    use plm
    use beam, only: beam_parameters, beam_structure, build_beam
    implicit none
    type(beam_parameters) :: parameters
    type(beam_structure) :: structure
    type(plm_context) :: context
    type(plm_model) :: model
    type(plm_branch) :: curve
    real(real64) :: hz, amplitude
    character(len=256) :: path

    call build_beam(parameters, structure)
    call context%create()
    call hand_over(structure, model)
    call plm_compute_response(model, structure%tip, hz, amplitude, curve, measure=PLM_HALF_PEAK_TO_PEAK)
    call report()
    path = 'cracked_beam.csv'
    if (command_argument_count() > 0) call get_command_argument(1, path)
    call write_curve(trim(path))
    call context%destroy()

contains

    subroutine hand_over(s, model)
        type(beam_structure), intent(in) :: s
        type(plm_model), intent(inout) :: model
        real(real64), parameter :: quality = 50, pi = acos(-1.0_real64)
        real(real64) :: force(s%n_dof), normal(3, size(s%lip_a, 2)), stiffness(size(s%lip_a, 2))
        call model%create(context, s%n_dof)
        call model%set_triplets(PLM_MASS, PLM_LOWER, s%m_row, s%m_column, s%m)
        call model%set_triplets(PLM_STIFFNESS, PLM_LOWER, s%k_row, s%k_column, s%k)
        call model%set_rayleigh_damping(0.0_real64, 1/(quality*2*pi*400))
        call model%fix_dofs(s%clamped)
        normal = spread([1.0_real64, 0.0_real64, 0.0_real64], 2, size(s%lip_a, 2)) ! out of the clamped part
        stiffness = PLM_AUTO_STIFFNESS
        call model%add_node_pairs(s%lip_a, s%lip_b, normal, stiffness)
        force = 0
        force(s%tip) = 10 ! N cos(omega t)
        call model%set_excitation(1, force)
        call model%build()
    end subroutine hand_over

    subroutine report()
        character(len=:), allocatable :: page
        real(real64) :: open_hz(3), sliding_hz(3)
        call model%modes(PLM_SYSTEM_OPEN, open_hz)
        call model%modes(PLM_SYSTEM_SLIDING, sliding_hz)
        print '(a, 3f10.3)', 'open_hz   ', open_hz
        print '(a, 3f10.3)', 'sliding_hz', sliding_hz
        print '(a, f12.6)', 'peak_hz', hz
        print '(a, es14.6)', 'peak_mm', amplitude
        call curve%describe(page)
        print '(a)', page
    end subroutine report

    subroutine write_curve(path)
        character(len=*), intent(in) :: path
        real(real64), allocatable :: hz(:), amplitude(:)
        integer, allocatable :: switching(:)
        integer :: unit, i
        call curve%get('frequency_hz', hz)
        call curve%get('n_switching', switching)
        call curve%amplitude(structure%tip, amplitude, PLM_HALF_PEAK_TO_PEAK)
        open (newunit=unit, file=path, action='write', status='replace')
        write (unit, '(a)') 'frequency_hz,amplitude_mm,switching_pairs'
        do i = 1, size(hz)
            write (unit, '(es22.15, a, es22.15, a, i0)') hz(i), ',', amplitude(i), ',', switching(i)
        end do
        close (unit)
        print '(a, i0, a)', 'wrote ', size(hz), ' points to '//path
    end subroutine write_curve

end program cracked_beam
