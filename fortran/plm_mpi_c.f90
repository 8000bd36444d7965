! plm_mpi_c.f90: plm_mpi.h in bind(C) interfaces; a type(c_ptr) for a team. The meaning of everything is told there.
module plm_mpi_c
    use, intrinsic :: iso_c_binding, only: c_char, c_double, c_funptr, c_int32_t, c_int64_t, c_ptr
    use plm_constants, only: plm_status
    implicit none
    private :: c_char, c_double, c_funptr, c_int32_t, c_int64_t, c_ptr, plm_status

    interface
        function plm_team_create(fortran_communicator, n_dof, team) bind(c) result(code)
            import :: c_int32_t, c_int64_t, c_ptr, plm_status
            implicit none
            integer(c_int32_t), value :: fortran_communicator
            integer(c_int64_t), value :: n_dof
            type(c_ptr), intent(inout) :: team
            integer(plm_status) :: code
        end function plm_team_create
        function plm_team_destroy(team) &
            bind(c) result(code)
            import :: c_ptr, plm_status
            implicit none
            type(c_ptr), intent(inout) :: team
            integer(plm_status) :: code
        end function plm_team_destroy
        function plm_team_own_dofs_i64(team, index_base, n, dof) &
            bind(c) result(code)
            import :: c_int32_t, c_int64_t, c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            integer(c_int32_t), value :: index_base
            integer(c_int64_t), value :: n
            integer(c_int64_t), intent(in) :: dof(*)
            integer(plm_status) :: code
        end function plm_team_own_dofs_i64
        function plm_team_add_entries_i64(team, which, part, index_base, n, row, column, value) &
            bind(c) result(code)
            import :: c_double, c_int32_t, c_int64_t, c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            integer(c_int32_t), value :: which
            integer(c_int32_t), value :: part
            integer(c_int32_t), value :: index_base
            integer(c_int64_t), value :: n
            integer(c_int64_t), intent(in) :: row(*)
            integer(c_int64_t), intent(in) :: column(*)
            real(c_double), intent(in) :: value(*)
            integer(plm_status) :: code
        end function plm_team_add_entries_i64
        function plm_team_fix_dofs_i64(team, index_base, n, dof) &
            bind(c) result(code)
            import :: c_int32_t, c_int64_t, c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            integer(c_int32_t), value :: index_base
            integer(c_int64_t), value :: n
            integer(c_int64_t), intent(in) :: dof(*)
            integer(plm_status) :: code
        end function plm_team_fix_dofs_i64
        function plm_team_add_gap_rows_i64(team, index_base, n, row_ptr, dof, coefficient, stiffness, gap) &
            bind(c) result(code)
            import :: c_double, c_int32_t, c_int64_t, c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            integer(c_int32_t), value :: index_base
            integer(c_int64_t), value :: n
            integer(c_int64_t), intent(in) :: row_ptr(*)
            integer(c_int64_t), intent(in) :: dof(*)
            real(c_double), intent(in) :: coefficient(*)
            real(c_double), intent(in) :: stiffness(*)
            real(c_double), intent(in) :: gap(*)
            integer(plm_status) :: code
        end function plm_team_add_gap_rows_i64
        function plm_team_add_preload_i64(team, index_base, n, dof, force) &
            bind(c) result(code)
            import :: c_double, c_int32_t, c_int64_t, c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            integer(c_int32_t), value :: index_base
            integer(c_int64_t), value :: n
            integer(c_int64_t), intent(in) :: dof(*)
            real(c_double), intent(in) :: force(*)
            integer(plm_status) :: code
        end function plm_team_add_preload_i64
        function plm_team_add_excitation_i64(team, harmonic, index_base, n, dof, real_part, imag_part) &
            bind(c) result(code)
            import :: c_double, c_int32_t, c_int64_t, c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            integer(c_int32_t), value :: harmonic
            integer(c_int32_t), value :: index_base
            integer(c_int64_t), value :: n
            integer(c_int64_t), intent(in) :: dof(*)
            real(c_double), intent(in) :: real_part(*)
            real(c_double), intent(in), optional :: imag_part(*)
            integer(plm_status) :: code
        end function plm_team_add_excitation_i64
        function plm_team_set_field(team, fn, user) &
            bind(c) result(code)
            import :: c_funptr, c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            type(c_funptr), value :: fn
            type(c_ptr), value :: user
            integer(plm_status) :: code
        end function plm_team_set_field
        function plm_team_create_model(team, ctx, model) &
            bind(c) result(code)
            import :: c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            type(c_ptr), value :: ctx
            type(c_ptr), intent(inout) :: model
            integer(plm_status) :: code
        end function plm_team_create_model
        function plm_team_deliver(team, n_dof, value) &
            bind(c) result(code)
            import :: c_double, c_int64_t, c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            integer(c_int64_t), value :: n_dof
            real(c_double), intent(in) :: value(*)
            integer(plm_status) :: code
        end function plm_team_deliver
        function plm_team_dismiss(team, outcome) &
            bind(c) result(code)
            import :: c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            integer(plm_status), value :: outcome
            integer(plm_status) :: code
        end function plm_team_dismiss
        function plm_team_serve(team) &
            bind(c) result(code)
            import :: c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            integer(plm_status) :: code
        end function plm_team_serve
        function plm_team_get_error_text(team, capacity, buffer, needed) &
            bind(c) result(code)
            import :: c_char, c_int64_t, c_ptr, plm_status
            implicit none
            type(c_ptr), value :: team
            integer(c_int64_t), value :: capacity
            character(kind=c_char), intent(inout) :: buffer(*)
            integer(c_int64_t), intent(inout), optional :: needed
            integer(plm_status) :: code
        end function plm_team_get_error_text
    end interface
end module plm_mpi_c
