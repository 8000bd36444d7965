! watchers.f90: listeners for the tests: they count, and may ask to stop.
module counting_watchers
    use, intrinsic :: iso_fortran_env, only: real64
    use plm, only: plm_watcher, plm_logger
    implicit none
    private
    public :: counting_watcher, counting_logger

    type, extends(plm_watcher) :: counting_watcher
        integer :: calls = 0
        integer :: cancel_at = huge(0)
    contains
        procedure :: progress
    end type counting_watcher

    type, extends(plm_logger) :: counting_logger
        integer :: lines = 0
    contains
        procedure :: log
    end type counting_logger

contains

    subroutine progress(self, stage, fraction, cancel)
        class(counting_watcher), intent(inout) :: self
        character(len=*), intent(in) :: stage
        real(real64), intent(in) :: fraction
        logical, intent(inout) :: cancel
        if (len(stage) > 0 .and. fraction >= 0) self%calls = self%calls + 1
        cancel = self%calls >= self%cancel_at
    end subroutine progress

    subroutine log(self, level, text)
        class(counting_logger), intent(inout) :: self
        integer, intent(in) :: level
        character(len=*), intent(in) :: text
        if (level >= 0 .and. len(text) > 0) self%lines = self%lines + 1
    end subroutine log

end module counting_watchers
