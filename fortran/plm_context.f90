! plm_context.f90: the context, the host's listeners on it, and what else of the host is called.
module plm_contexts
    use, intrinsic :: iso_c_binding, only: c_ptr, c_null_ptr, c_null_funptr, c_char, c_double, c_int8_t, c_int32_t, &
        c_int64_t, &
        c_null_char, c_loc, c_funloc, c_f_pointer, c_associated
    use, intrinsic :: iso_fortran_env, only: int8, real64
    use plm_constants
    use plm_c, only: plm_context_create, plm_context_destroy, plm_context_set_log, plm_context_set_progress, &
        plm_context_set_effort, &
        plm_context_set_threads, &
        plm_context_get_error_info
    use plm_errors, only: finish
    implicit none
    private
    public :: plm_context, plm_logger, plm_watcher, plm_recoverer, recoverer_box, forward_recovery
    public :: plm_writer, writer_box, forward_bytes

    ! Extend it to receive the library's remarks. It must not call the library.
    type, abstract :: plm_logger
    contains
        procedure(log_procedure), deferred :: log
    end type plm_logger

    ! Extend it to follow long work and to stop it.
    type, abstract :: plm_watcher
    contains
        procedure(progress_procedure), deferred :: progress
    end type plm_watcher

    ! Extend it by the way from a superelement to the structure it was reduced from: full = T reduced, one column per
    ! motion; failed is .false. on entry. It must not call the library.
    type, abstract :: plm_recoverer
    contains
        procedure(recover_procedure), deferred :: recover
    end type plm_recoverer

    ! Extend it by where the bytes of a state or the text of a table go, piece after piece; failed is .false. on entry. It
    ! must not call the library.
    type, abstract :: plm_writer
    contains
        procedure(write_procedure), deferred :: write
    end type plm_writer

    abstract interface
        ! level: 0 detail, 1 information, 2 warning
        subroutine log_procedure(self, level, text)
            import :: plm_logger
            implicit none
            class(plm_logger), intent(inout) :: self
            integer, intent(in) :: level
            character(len=*), intent(in) :: text
        end subroutine log_procedure
        ! stage: a word such as modes or sweep; fraction in [0, 1]; cancel is .false. on entry
        subroutine progress_procedure(self, stage, fraction, cancel)
            import :: plm_watcher, real64
            implicit none
            class(plm_watcher), intent(inout) :: self
            character(len=*), intent(in) :: stage
            real(real64), intent(in) :: fraction
            logical, intent(inout) :: cancel
        end subroutine progress_procedure
        subroutine recover_procedure(self, reduced, full, failed)
            import :: plm_recoverer, real64
            implicit none
            class(plm_recoverer), intent(inout) :: self
            real(real64), intent(in) :: reduced(:, :)
            real(real64), intent(inout) :: full(:, :)
            logical, intent(inout) :: failed
        end subroutine recover_procedure
        subroutine write_procedure(self, bytes, failed)
            import :: plm_writer, int8
            implicit none
            class(plm_writer), intent(inout) :: self
            integer(int8), intent(in) :: bytes(:)
            logical, intent(inout) :: failed
        end subroutine write_procedure
    end interface

    ! What the C side holds as `user`: C knows no polymorphic pointers.
    type :: listener_box
        class(plm_logger), pointer :: logger => null()
        class(plm_watcher), pointer :: watcher => null()
    end type listener_box
    type :: recoverer_box
        class(plm_recoverer), pointer :: recoverer => null()
    end type recoverer_box
    type :: writer_box
        class(plm_writer), pointer :: writer => null()
    end type writer_box

    ! Copies by assignment are the same context; destroy one of them, once.
    type :: plm_context
        type(c_ptr) :: handle = c_null_ptr ! for calls of the module plm_c
        type(listener_box), pointer, private :: box => null()
    contains
        procedure :: create
        procedure :: destroy
        procedure :: set_log
        procedure :: set_progress
        procedure :: set_effort
        procedure :: set_threads
        procedure :: error_reason
    end type plm_context

contains

    subroutine create(self, stat, errmsg)
        class(plm_context), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(c_null_ptr, plm_context_create(PLM_API_VERSION, self%handle), stat, errmsg)
        if (.not. associated(self%box)) allocate (self%box)
    end subroutine create

    ! and all that was created in it
    subroutine destroy(self, stat, errmsg)
        class(plm_context), intent(inout) :: self
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        status = plm_context_destroy(self%handle)
        if (status >= 0 .and. associated(self%box)) deallocate (self%box)
        call finish(self%handle, status, stat, errmsg)
    end subroutine destroy

    ! logger must live (target or pointer) until the context is destroyed or set_log is called again; absent: silence
    subroutine set_log(self, logger, stat, errmsg)
        class(plm_context), intent(inout) :: self
        class(plm_logger), intent(inout), target, optional :: logger
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        if (present(logger) .and. associated(self%box)) then
            self%box%logger => logger
            status = plm_context_set_log(self%handle, c_funloc(forward_log), c_loc(self%box))
        else
            status = plm_context_set_log(self%handle, c_null_funptr, c_null_ptr)
        end if
        call finish(self%handle, status, stat, errmsg)
    end subroutine set_log

    ! watcher: as logger in set_log
    subroutine set_progress(self, watcher, stat, errmsg)
        class(plm_context), intent(inout) :: self
        class(plm_watcher), intent(inout), target, optional :: watcher
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        integer(plm_status) :: status
        if (present(watcher) .and. associated(self%box)) then
            self%box%watcher => watcher
            status = plm_context_set_progress(self%handle, c_funloc(forward_progress), c_loc(self%box))
        else
            status = plm_context_set_progress(self%handle, c_null_funptr, c_null_ptr)
        end if
        call finish(self%handle, status, stat, errmsg)
    end subroutine set_progress

    ! what a search may cost: seconds of one core, as operations are counted; 0: no limit
    subroutine set_effort(self, seconds, stat, errmsg)
        class(plm_context), intent(inout) :: self
        real(real64), intent(in) :: seconds
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%handle, plm_context_set_effort(self%handle, seconds), stat, errmsg)
    end subroutine set_effort

    ! that a call may use; results are the same for any number
    subroutine set_threads(self, n, stat, errmsg)
        class(plm_context), intent(inout) :: self
        integer, intent(in) :: n
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        call finish(self%handle, plm_context_set_threads(self%handle, int(n, c_int32_t)), stat, errmsg)
    end subroutine set_threads

    ! PLM_REASON_... of the last failure or outcome
    integer function error_reason(self)
        class(plm_context), intent(in) :: self
        integer(c_int32_t) :: reason
        reason = PLM_REASON_NONE
        if (plm_context_get_error_info(self%handle, reason=reason) < 0) reason = PLM_REASON_NONE
        error_reason = int(reason)
    end function error_reason

    subroutine forward_log(ctx, level, text, user) bind(c, name='')
        type(c_ptr), value :: ctx, user
        integer(c_int32_t), value :: level
        character(kind=c_char), intent(in) :: text(*)
        type(listener_box), pointer :: box
        if (.not. c_associated(ctx)) return
        call c_f_pointer(user, box)
        call box%logger%log(int(level), collected(text))
    end subroutine forward_log

    integer(c_int32_t) function forward_progress(ctx, stage, fraction, user) bind(c, name='') result(code)
        type(c_ptr), value :: ctx, user
        character(kind=c_char), intent(in) :: stage(*)
        real(c_double), value :: fraction
        type(listener_box), pointer :: box
        logical :: cancel
        code = 0
        if (.not. c_associated(ctx)) return
        call c_f_pointer(user, box)
        cancel = .false.
        call box%watcher%progress(collected(stage), real(fraction, real64), cancel)
        code = merge(1_c_int32_t, 0_c_int32_t, cancel)
    end function forward_progress

    integer(c_int32_t) function forward_recovery(ctx, n_dof, n_columns, reduced, n_full, full, user) &
        bind(c, name='') result(code)
        type(c_ptr), value :: ctx, user
        integer(c_int64_t), value :: n_dof, n_columns, n_full
        real(c_double), intent(in) :: reduced(n_dof, n_columns)
        real(c_double), intent(inout) :: full(n_full, n_columns)
        type(recoverer_box), pointer :: box
        logical :: failed
        code = 0
        if (.not. c_associated(ctx)) return
        call c_f_pointer(user, box)
        failed = .false.
        call box%recoverer%recover(reduced, full, failed)
        code = merge(1_c_int32_t, 0_c_int32_t, failed)
    end function forward_recovery

    integer(c_int32_t) function forward_bytes(ctx, n, bytes, user) bind(c, name='') result(code)
        type(c_ptr), value :: ctx, user
        integer(c_int64_t), value :: n
        integer(c_int8_t), intent(in) :: bytes(n)
        type(writer_box), pointer :: box
        logical :: failed
        code = 0
        if (.not. c_associated(ctx)) return
        call c_f_pointer(user, box)
        failed = .false.
        call box%writer%write(bytes, failed)
        code = merge(1_c_int32_t, 0_c_int32_t, failed)
    end function forward_bytes

    pure function collected(characters) result(text)
        character(kind=c_char), intent(in) :: characters(*)
        character(len=:), allocatable :: text
        integer :: n, i
        n = 0
        do while (characters(n + 1) /= c_null_char)
            n = n + 1
        end do
        allocate (character(len=n) :: text)
        do i = 1, n
            text(i:i) = characters(i)
        end do
    end function collected

end module plm_contexts
