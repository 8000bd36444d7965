! plm.f90: the module a modern Fortran host uses. The order of work is that of include/plm/plm.h:
!
!     type(plm_context) :: context        call context%create()
!     type(plm_model) :: model            call model%create(context, n_dof), set_csc ..., add_node_pairs ..., build()
!     type(plm_sampler) :: sampler        call sampler%create(model), set('mode', 1), run()
!     type(plm_basis) :: basis            call basis%create(model), set_sampler(sampler), build()
!     type(plm_hbm) :: hbm                call hbm%create(basis), sweep(curve), find_peak(curve, dof, hz, amplitude)
!     type(plm_branch) :: curve           call curve%amplitude(dof, value), field(point, time, q) ...
!     type(plm_transient) :: motion       call motion%create(model, basis), start_at(curve, point), run(), state(q, v)
!     type(plm_study) :: study            call study%create(model), set_output(dof), add_response('name', hbm), run() ...
!                                         call context%destroy(): and all that was made in it
!
! and plm_compute_response(model, dof, hz, amplitude, curve) goes from the model to the peak in one call.
!
! Every procedure ends with the optional arguments stat (a PLM_... status) and errmsg. Without stat a failure is written
! to error_unit and the program stops with error stop; an outcome (a status above 0: something to look at) is written
! there, too, and the program goes on. DOFs, points and columns count from 1; 0 stands for "no DOF".
! There are no finalizers: what is not destroyed goes with its context. A copy by assignment is the same object.
module plm
    use plm_constants
    use plm_contexts, only: plm_context, plm_logger, plm_watcher, plm_recoverer, plm_writer
    use plm_models, only: plm_model
    use plm_reductions, only: plm_sampler, plm_basis
    use plm_branches, only: plm_branch
    use plm_responses, only: plm_hbm, plm_compute_response
    use plm_motions, only: plm_transient
    use plm_studies, only: plm_study
    use plm_library_facts, only: plm_version_numbers, plm_build_line, plm_describe_keys
    implicit none
end module plm
