! tall_host.f90: a host that keeps all that is tall itself: the tall operations (plm_tall_fn of plm.h) on dense matrices, with
! an elimination of its own. examples/c/tall_host.c is the same in C.
!
!     code = plm_model_set_tall_operations(model%handle, c_funloc(tall_operation), c_loc(host))
module tall_hosts
    use, intrinsic :: iso_c_binding, only: c_associated, c_double, c_f_pointer, c_int32_t, c_int64_t, c_ptr
    use, intrinsic :: iso_fortran_env, only: int64, real64
    use plm_constants
    implicit none
    private
    public :: tall_host, tall_operation

    ! A block of columns, or a factor: L below the diagonal of value, D on it.
    type :: tall_thing
        integer(int64) :: handle = 0
        real(real64), allocatable :: value(:, :)
        logical, allocatable :: held(:) ! of a factor: DOFs that stand still
    end type tall_thing

    type :: tall_host
        real(real64), allocatable :: m(:, :), k(:, :), c(:, :) ! c: or not allocated
        integer :: calls = 0, ends = 0
        type(tall_thing), allocatable :: things(:)
    end type tall_host

contains

    integer(c_int32_t) function tall_operation(ctx, operation, number, factor, small_in, small_out, user) bind(c) result(code)
        type(c_ptr), value :: ctx, user
        integer(c_int32_t), value :: operation
        integer(c_int64_t), intent(in), optional :: number(*)
        real(c_double), intent(in), optional :: factor(*), small_in(*)
        real(c_double), intent(inout), optional :: small_out(*)
        type(tall_host), pointer :: host
        integer :: a(7), k
        call c_f_pointer(user, host)
        code = merge(0_c_int32_t, 1_c_int32_t, c_associated(ctx))
        if (code /= 0) return
        if (.not. allocated(host%things)) allocate (host%things(0))
        host%calls = host%calls + 1
        select case (operation)
        case (PLM_TALL_END)
            host%ends = host%ends + 1
            deallocate (host%things)
        case (PLM_TALL_FREE)
            do k = 1, int(number(1))
                host%things = pack(host%things, host%things%handle /= number(1 + k))
            end do
        case (PLM_TALL_FACTS)
            call facts(host, small_out(1:16))
        case (PLM_TALL_FILL)
            call fill(written(host, number(1), 0, int(number(2))), factor(1:3), int(number(3)))
        case (PLM_TALL_COPY)
            call copy(host, number(1), int(number(2)), found(host, number(3)), int(number(5:4 + number(4))))
        case (PLM_TALL_COMBINE)
            a(2:7) = int(number(2:7))
            call combine(host, number(1), number(4), a, factor(1:2), small_in)
        case (PLM_TALL_GRAM)
            call gram(columns(host, number(1), number(2), number(3)), columns(host, number(4), number(5), number(6)), &
                number(7) /= 0, number(8) /= 0, small_out)
        case (PLM_TALL_APPLY)
            call put(host, number(1), number(2), &
                matmul(weighted(host, factor(1:3)), columns(host, number(3), number(4), number(5))))
        case (PLM_TALL_FACTOR)
            call factored(host, number(1), number(2), int(number(5:4 + number(3))) + 1, &
                int(number(5 + number(3):4 + number(3) + number(4))) + 1, &
                int(number(5 + number(3) + number(4):4 + number(3) + 2*number(4))) + 1, factor(1:3), small_in, small_out(1:8))
        case (PLM_TALL_SOLVE)
            call put(host, number(2), number(3), &
                solved(host%things(found(host, number(1))), columns(host, number(2), number(3), number(4))))
        case (PLM_TALL_RESPONSES)
            call responses(host, number, small_in, small_out)
        case (PLM_TALL_ROWS, PLM_TALL_SET_ROWS)
            call rows(host, number, operation == PLM_TALL_ROWS, factor, small_in, small_out)
        case (PLM_TALL_LOOK)
            call look(columns(host, number(1), number(2), number(3)), small_out(1:3))
        case (PLM_TALL_ENERGY)
            call energy(weighted(host, factor(1:3)), columns(host, number(1), number(2), number(3)), small_out)
        case (PLM_TALL_RESIDUAL)
            call residual(host%k, columns(host, number(1), number(2), number(5)), &
                columns(host, number(3), number(4), number(5)), factor(1), small_in(1:number(5)), small_out)
        case (PLM_TALL_DIAGONAL)
            associate (sum => weighted(host, factor(1:3)))
                do k = 1, int(number(1))
                    small_out(k) = sum(number(1 + k) + 1, number(1 + k) + 1)
                end do
            end associate
        case default
            code = 1
        end select
    end function tall_operation

    ! --- blocks ------------------------------------------------------------------------------------------------------

    integer function found(host, handle) result(place)
        type(tall_host), intent(in) :: host
        integer(c_int64_t), intent(in) :: handle
        place = findloc(host%things%handle, handle, 1)
    end function found

    function columns(host, handle, first, cols) result(x)
        type(tall_host), intent(in) :: host
        integer(c_int64_t), intent(in) :: handle, first, cols
        real(real64), allocatable :: x(:, :)
        if (cols == 0) then
            allocate (x(size(host%k, 1), 0))
        else
            x = host%things(found(host, handle))%value(:, first + 1:first + cols)
        end if
    end function columns

    ! Columns first + 1 ... first + cols of a block, made, or made longer, where they are not there.
    function written(host, handle, first, cols) result(x)
        type(tall_host), intent(inout), target :: host
        integer(c_int64_t), intent(in) :: handle
        integer, intent(in) :: first, cols
        real(real64), pointer :: x(:, :)
        real(real64), allocatable :: longer(:, :)
        integer :: place
        place = found(host, handle)
        if (place == 0) then
            host%things = [host%things, tall_thing(handle, reshape([real(real64) ::], [size(host%k, 1), 0]))]
            place = size(host%things)
        end if
        associate (old => host%things(place)%value)
            if (size(old, 2) < first + cols) then
                allocate (longer(size(old, 1), first + cols), source=0.0_real64)
                longer(:, :size(old, 2)) = old
                call move_alloc(longer, host%things(place)%value)
            end if
        end associate
        x => host%things(place)%value(:, first + 1:first + cols)
    end function written

    subroutine put(host, handle, first, value)
        type(tall_host), intent(inout) :: host
        integer(c_int64_t), intent(in) :: handle, first
        real(real64), intent(in) :: value(:, :)
        real(real64), pointer :: x(:, :)
        x => written(host, handle, int(first), size(value, 2))
        x = value
    end subroutine put

    subroutine fill(x, factor, seed)
        real(real64), intent(out) :: x(:, :)
        real(real64), intent(in) :: factor(3)
        integer, intent(in) :: seed
        real(real64) :: noise
        integer :: i, j
        do j = 1, size(x, 2)
            do i = 1, size(x, 1)
                noise = sin(12.9898_real64*i + 78.233_real64*j + 37.719_real64*modulo(seed, 1009))*43758.5453_real64
                x(i, j) = factor(1) + factor(2)*sin(real(i - 1, real64)) + factor(3)*(2*modulo(noise, 1.0_real64) - 1)
            end do
        end do
    end subroutine fill

    subroutine copy(host, handle, first, y, column)
        type(tall_host), intent(inout) :: host
        integer(c_int64_t), intent(in) :: handle
        integer, intent(in) :: first, y, column(:)
        call put(host, handle, int(first, int64), host%things(y)%value(:, column + 1))
    end subroutine copy

    ! a: x_first, x_cols in 2 and 3, y_first, y_cols in 5 and 6, 1 in 7 for a diagonal
    subroutine combine(host, x_handle, y_handle, a, factor, s)
        type(tall_host), intent(inout) :: host
        integer(c_int64_t), intent(in) :: x_handle, y_handle
        integer, intent(in) :: a(7)
        real(real64), intent(in) :: factor(2)
        real(real64), intent(in), optional :: s(*)
        real(real64), pointer :: x(:, :)
        real(real64) :: y(size(host%k, 1), a(6)), sum(size(host%k, 1), a(3))
        integer :: j
        y = columns(host, y_handle, int(a(5), int64), int(a(6), int64))
        sum = 0
        do j = 1, merge(a(3), 0, a(6) > 0)
            if (a(7) == 0) then
                sum(:, j) = matmul(y, s(a(6)*(j - 1) + 1:a(6)*j))
            else
                sum(:, j) = y(:, j)*s(j)
            end if
        end do
        x => written(host, x_handle, a(2), a(3))
        if (factor(1) == 0) x = 0
        x = factor(1)*x + factor(2)*sum
    end subroutine combine

    subroutine gram(x, y, diagonal, absolute, out)
        real(real64), intent(in) :: x(:, :), y(:, :)
        logical, intent(in) :: diagonal, absolute
        real(real64), intent(inout) :: out(*)
        real(real64) :: product(size(x, 2), size(y, 2))
        integer :: j
        if (absolute) then
            product = matmul(transpose(abs(x)), abs(y))
        else
            product = matmul(transpose(x), y)
        end if
        if (diagonal) then
            out(1:size(x, 2)) = [(product(j, j), j=1, size(x, 2))]
        else
            out(1:size(product)) = reshape(product, [size(product)])
        end if
    end subroutine gram

    ! number: {x, x_first, x_cols, n, dof[n]}; n = -1: all DOFs of one column
    subroutine rows(host, number, reading, factor, small_in, small_out)
        type(tall_host), intent(inout) :: host
        integer(c_int64_t), intent(in) :: number(*)
        logical, intent(in) :: reading
        real(c_double), intent(in), optional :: factor(*), small_in(*)
        real(c_double), intent(inout), optional :: small_out(*)
        real(real64) :: x(size(host%k, 1), number(3))
        real(real64), allocatable :: in(:, :)
        integer :: dof(merge(size(host%k, 1, int64), number(4), number(4) < 0))
        integer :: i, j
        x = columns(host, number(1), number(2), number(3))
        do i = 1, size(dof)
            dof(i) = i
            if (number(4) >= 0) dof(i) = int(number(4 + i)) + 1
        end do
        if (reading) then
            small_out(1:size(dof)*size(x, 2)) = reshape(x(dof, :), [size(dof)*size(x, 2)])
            return
        end if
        in = reshape(small_in(1:size(dof)*size(x, 2)), [size(dof), size(x, 2)])
        do j = 1, size(x, 2)
            do i = 1, size(dof)
                x(dof(i), j) = in(i, j) + merge(0.0_real64, factor(1)*x(dof(i), j), factor(1) == 0)
            end do
        end do
        call put(host, number(1), number(2), x)
    end subroutine rows

    subroutine look(x, out)
        real(real64), intent(in) :: x(:, :)
        real(real64), intent(inout) :: out(3)
        real(real64) :: length(size(x, 1))
        length = norm2(x, 2)
        out(1) = merge(1, 0, all(abs(length) <= huge(length)))
        out(2) = maxval(length)
        out(3) = maxloc(length, 1) - 1
    end subroutine look

    ! --- matrices and factors ----------------------------------------------------------------------------------------

    function weighted(host, factor) result(sum)
        type(tall_host), intent(in) :: host
        real(real64), intent(in) :: factor(3)
        real(real64) :: sum(size(host%k, 1), size(host%k, 1))
        sum = factor(1)*host%m + factor(2)*host%k
        if (allocated(host%c)) sum = sum + factor(3)*host%c
    end function weighted

    subroutine facts(host, out)
        type(tall_host), intent(in) :: host
        real(real64), intent(inout) :: out(16)
        real(real64), dimension(size(host%k, 1)) :: m, k
        real(real64), allocatable :: ratio(:)
        logical :: coupled(size(host%k, 1))
        integer :: i, n
        n = size(host%k, 1)
        m = [(host%m(i, i), i=1, n)]
        k = [(host%k(i, i), i=1, n)]
        do i = 1, n
            coupled(i) = count(host%k(:, i) /= 0) > merge(1, 0, k(i) /= 0)
        end do
        out(1:5) = [real(n, real64), real(count(m > 0), real64), sum(m), sum(k), minval(k)]
        ratio = pack(k/merge(m, 1.0_real64, m > 0), m > 0 .and. k > 0)
        do i = 1, size(ratio) ! the median: as many are less as are more
            if (count(ratio < ratio(i)) <= size(ratio)/2 .and. count(ratio <= ratio(i)) > size(ratio)/2) out(6) = ratio(i)
        end do
        out(7) = findloc(.not. (m > 0 .or. k > 0 .or. coupled), .true., 1) - 1
        out(8) = findloc(.not. (m > 0 .or. k > 0) .and. coupled, .true., 1) - 1
        out(9) = count(.not. (m > 0 .or. k > 0) .and. coupled)
        out(10) = merge(1, 0, allocated(host%c))
        out(11:12) = [maxval(abs(host%m)), maxval(abs(host%k))]
        if (allocated(host%c)) out(13) = maxval(abs(host%c))
    end subroutine facts

    ! L D L^T without pivoting. purpose 1: only the count is wanted.
    subroutine factored(host, handle, purpose, held, row, column, factor, value, out)
        type(tall_host), intent(inout) :: host
        integer(c_int64_t), intent(in) :: handle, purpose
        integer, intent(in) :: held(:), row(:), column(:)
        real(real64), intent(in) :: factor(3)
        real(real64), intent(in), optional :: value(*)
        real(real64), intent(inout) :: out(8)
        type(tall_thing) :: made
        real(real64) :: pivot, least, most
        integer :: i, j, n
        n = size(host%k, 1)
        made%handle = handle
        made%value = weighted(host, factor)
        allocate (made%held(n), source=.false.)
        made%held(held) = .true.
        do i = 1, size(row)
            made%value(row(i), column(i)) = made%value(row(i), column(i)) + value(i)
        end do
        do i = 1, n
            if (.not. made%held(i)) cycle
            made%value(i, :) = 0
            made%value(:, i) = 0
            made%value(i, i) = 1
        end do
        least = huge(least)
        most = 0
        out(5) = -1
        associate (a => made%value)
            do j = 1, n
                if (made%held(j)) cycle
                pivot = a(j, j)
                if (merge(.not. pivot > 0, .not. abs(pivot) > 1d-14*most, purpose == 0)) then
                    out(4) = merge(1, 2, purpose == 0)
                    out(5) = j - 1
                    return
                end if
                least = min(least, abs(pivot))
                most = max(most, abs(pivot))
                if (pivot < 0) out(1) = out(1) + 1
                do i = j + 1, n
                    if (a(i, j) /= 0) a(i:, i) = a(i:, i) - a(i:, j)*(a(i, j)/pivot)
                end do
                a(j + 1:, j) = a(j + 1:, j)/pivot
            end do
        end associate
        out(2) = least/most
        out(3) = n*(n + 1)/2
        if (purpose == 0) host%things = [host%things, made]
    end subroutine factored

    function solved(f, right) result(x)
        type(tall_thing), intent(in) :: f
        real(real64), intent(in) :: right(:, :)
        real(real64) :: x(size(right, 1), size(right, 2))
        integer :: i, j, n
        n = size(x, 1)
        x = right
        do j = 1, size(x, 2)
            where (f%held) x(:, j) = 0
            do i = 1, n
                x(i + 1:, j) = x(i + 1:, j) - f%value(i + 1:, i)*x(i, j)
            end do
            do i = n, 1, -1
                x(i, j) = x(i, j)/f%value(i, i) - dot_product(f%value(i + 1:, i), x(i + 1:, j))
            end do
        end do
    end function solved

    ! number: {f, y, y_first, y_cols, s, n_entries, dof[n_entries], column[n_entries]}
    subroutine responses(host, number, value, out)
        type(tall_host), intent(in) :: host
        integer(c_int64_t), intent(in) :: number(*)
        real(real64), intent(in), optional :: value(*)
        real(real64), intent(inout) :: out(*)
        real(real64), allocatable :: force(:, :), x(:, :)
        integer(int64) :: e, dof, column
        integer :: s, t
        s = int(number(5))
        t = s + int(number(4))
        allocate (force(size(host%k, 1), t), source=0.0_real64)
        do e = 1, number(6)
            dof = number(6 + e) + 1
            column = number(6 + number(6) + e) + 1
            force(dof, column) = force(dof, column) + value(e)
        end do
        force(:, s + 1:) = columns(host, number(2), number(3), number(4))
        x = solved(host%things(found(host, number(1))), force)
        out(1) = 1
        out(2:1 + t*t) = reshape(matmul(transpose(force), x), [t*t])
        out(2 + t*t:1 + 2*t*t) = reshape(matmul(transpose(x), matmul(host%m, x)), [t*t])
    end subroutine responses

    subroutine energy(a, x, out)
        real(real64), intent(in) :: a(:, :), x(:, :)
        real(real64), intent(inout) :: out(*)
        integer, parameter :: longer = selected_real_kind(18) ! as many digits as can be had
        integer :: j
        do j = 1, size(x, 2)
            out(2*j - 1) = real(dot_product(real(x(:, j), longer), matmul(real(a, longer), real(x(:, j), longer))), real64)
            out(2*j) = dot_product(abs(x(:, j)), matmul(abs(a), abs(x(:, j))))
        end do
    end subroutine energy

    subroutine residual(k, x, y, rounding, lambda, out)
        real(real64), intent(in) :: k(:, :), x(:, :), y(:, :), rounding, lambda(:)
        real(real64), intent(inout) :: out(*)
        integer :: j
        do j = 1, size(x, 2)
            out(j) = norm2(max(0.0_real64, abs(matmul(k, x(:, j)) - lambda(j)*y(:, j)) &
                - rounding*matmul(abs(k), abs(x(:, j)))))
        end do
    end subroutine residual

end module tall_hosts
