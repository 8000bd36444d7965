! plm_facts.f90: what the library tells about itself.
module plm_library_facts
    use, intrinsic :: iso_c_binding, only: c_char, c_int32_t, c_double
    use, intrinsic :: iso_fortran_env, only: int64
    use plm_constants
    use plm_c
    use plm_errors, only: f_text
    implicit none
    private
    public :: plm_version_numbers, plm_build_line, plm_describe_keys

contains

    ! major, minor, patch
    function plm_version_numbers() result(version)
        integer :: version(3)
        integer(c_int32_t) :: part(3)
        part = 0
        if (plm_version(part(1), part(2), part(3)) < 0) part = 0
        version = int(part)
    end function plm_version_numbers

    function plm_build_line() result(text)
        character(len=:), allocatable :: text
        character(kind=c_char, len=1024) :: buffer
        text = ''
        if (plm_build_info(len(buffer, int64), buffer) >= 0) text = f_text(buffer)
    end function plm_build_line

    ! Writes the options and results of a kind of handle (PLM_KIND_MODEL ...) to a unit, one per line.
    subroutine plm_describe_keys(kind, unit)
        integer(plm_status), intent(in) :: kind
        integer, intent(in) :: unit
        integer(c_int32_t) :: n, i, type, is_option
        real(c_double) :: minimum, maximum
        n = 0
        if (plm_key_count(kind, n) < 0) return
        do i = 0_c_int32_t, n - 1_c_int32_t
            is_option = 0
            if (plm_key_info(kind, i, type, is_option, minimum, maximum) < 0) cycle
            if (is_option /= 0) then
                write (unit, '(a)') 'option '//field(PLM_KEY_NAME)//' = '//field(PLM_KEY_DEFAULT)//': '// &
                    field(PLM_KEY_DESCRIPTION)
            else
                write (unit, '(a)') 'result '//field(PLM_KEY_NAME)//': '//field(PLM_KEY_DESCRIPTION)
            end if
        end do

    contains

        function field(which) result(text)
            integer(plm_status), intent(in) :: which
            character(len=:), allocatable :: text
            character(kind=c_char, len=1024) :: buffer
            text = ''
            if (plm_key_text(kind, i, which, len(buffer, int64), buffer) >= 0) text = f_text(buffer)
        end function field

    end subroutine plm_describe_keys

end module plm_library_facts
