! plm_errors.f90: how every procedure of the module plm reports: by stat and errmsg where the caller gives stat. Else a
! failure is a line on error_unit and error stop; an outcome above 0 (not converged, truncated, something to look at) is a
! line on error_unit, and the program goes on with results that are valid as far as they go.
module plm_errors
    use, intrinsic :: iso_c_binding, only: c_char, c_ptr, c_null_char
    use, intrinsic :: iso_fortran_env, only: error_unit, int64
    use plm_constants
    use plm_c, only: plm_context_get_error_text, plm_context_get_error_info, plm_status_text
    implicit none
    private
    public :: finish, finish_with, refuse, c_text, f_text

contains

    ! What a procedure does last with the status of its C function. Without trailing words: the library's own text.
    subroutine finish(context, status, stat, errmsg)
        type(c_ptr), intent(in) :: context
        integer(plm_status), intent(in) :: status
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (status == PLM_OK) then
            if (present(stat)) stat = int(status)
        else
            call finish_with(error_text(context, status), status, stat, errmsg)
        end if
    end subroutine finish

    ! The same with the words of another handle than a context.
    subroutine finish_with(text, status, stat, errmsg)
        character(len=*), intent(in) :: text
        integer(plm_status), intent(in) :: status
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (present(stat)) stat = int(status)
        if (status == PLM_OK) return
        if (present(errmsg)) errmsg = text
        if (present(stat)) return
        if (status < 0) call stop_with(text)
        write (error_unit, '(a)') 'libplm: '//text
    end subroutine finish_with

    ! The same for an argument that this layer does not pass on.
    subroutine refuse(text, stat, errmsg)
        character(len=*), intent(in) :: text
        integer, intent(out), optional :: stat
        character(len=*), intent(inout), optional :: errmsg
        if (present(stat)) stat = int(PLM_ERR_ARGUMENT)
        if (present(errmsg)) errmsg = text
        if (.not. present(stat)) call stop_with(text)
    end subroutine refuse

    subroutine stop_with(text)
        character(len=*), intent(in) :: text
        write (error_unit, '(a)') 'libplm: '//text
        error stop 1
    end subroutine stop_with

    ! The context's text where it is about this call, else what the status says by itself.
    function error_text(context, status) result(text)
        type(c_ptr), intent(in) :: context
        integer(plm_status), intent(in) :: status
        character(len=:), allocatable :: text
        character(kind=c_char, len=2048) :: buffer
        integer(plm_status) :: last, code
        last = PLM_OK
        code = plm_context_get_error_info(context, status=last)
        if (code == PLM_OK .and. last == status) then
            code = plm_context_get_error_text(context, len(buffer, int64), buffer)
        else
            code = plm_status_text(status, len(buffer, int64), buffer)
        end if
        text = ''
        if (code >= 0) text = f_text(buffer)
    end function error_text

    pure function c_text(text) result(ended)
        character(len=*), intent(in) :: text
        character(kind=c_char, len=len_trim(text) + 1) :: ended
        ended = trim(text)//c_null_char
    end function c_text

    ! up to the NUL
    pure function f_text(buffer) result(text)
        character(kind=c_char, len=*), intent(in) :: buffer
        character(len=:), allocatable :: text
        integer :: ends
        ends = index(buffer, c_null_char)
        if (ends == 0) ends = len(buffer) + 1
        text = buffer(1:ends - 1)
    end function f_text

end module plm_errors
