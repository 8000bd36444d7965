! unanswered.f90: a failure that the program does not ask for (no stat) is reported and stops it.
program unanswered
    use plm
    implicit none
    type(plm_context) :: context
    type(plm_model) :: model
    call context%create()
    call model%create(context, 1)
    call model%set('no_such_option', 1)
    print '(a)', 'went on'
end program unanswered
