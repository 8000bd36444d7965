! brick.f90: 8-node brick with Wilson's incompatible modes 1 - xi^2, 1 - eta^2, 1 - zeta^2 in Taylor's corrected form
! (Taylor, Beresford, Wilson, IJNME 10 (1976) 1211-1219). The plain brick would lock in bending.
module brick
    use, intrinsic :: iso_fortran_env, only: real64
    implicit none
    private
    public :: material, brick_matrices

    type :: material
        real(real64) :: young, poisson, density
    end type material

    real(real64), parameter :: corner(3, 8) = reshape(real([ &
        -1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1], real64), [3, 8])

contains

    ! xyz: nodes 1-4 turn anticlockwise seen from nodes 5-8, which stand above them. k: DOF 3 (node - 1) + component;
    ! m: the mass between two nodes, the same for each component.
    subroutine brick_matrices(xyz, mat, k, m)
        real(real64), intent(in) :: xyz(3, 8)
        type(material), intent(in) :: mat
        real(real64), intent(out) :: k(24, 24), m(8, 8)
        real(real64) :: full(33, 33), gradient(3, 11), n(8), dn(3, 8), inv(3, 3), inv0(3, 3), xi(3), det, det0
        real(real64) :: lambda, mu
        integer :: point, i
        lambda = mat%young*mat%poisson/((1 + mat%poisson)*(1 - 2*mat%poisson))
        mu = mat%young/(2*(1 + mat%poisson))
        call shape_functions([0.0_real64, 0.0_real64, 0.0_real64], n, dn)
        call jacobian(xyz, dn, inv0, det0)
        full = 0
        m = 0
        do point = 1, 8 ! 2 x 2 x 2 Gauss, all weights one
            xi = corner(:, point)/sqrt(3.0_real64)
            call shape_functions(xi, n, dn)
            call jacobian(xyz, dn, inv, det)
            if (det <= 0 .or. det0 <= 0) error stop 'a brick is turned inside out'
            gradient(:, 1:8) = matmul(inv, dn)
            do i = 1, 3 ! Taylor: the centre's Jacobian, so that constant stress does no work on these modes
                gradient(:, 8 + i) = -2*xi(i)*inv0(:, i)*det0/det
            end do
            call add_stiffness(gradient, lambda, mu, det, full)
            m = m + mat%density*det*spread(n, 2, 8)*spread(n, 1, 8)
        end do
        call condense(full)
        k = full(1:24, 1:24)
    end subroutine brick_matrices

    pure subroutine shape_functions(xi, n, dn)
        real(real64), intent(in) :: xi(3)
        real(real64), intent(out) :: n(8), dn(3, 8)
        real(real64) :: f(3)
        integer :: a
        do a = 1, 8
            f = 1 + corner(:, a)*xi
            n(a) = product(f)/8
            dn(:, a) = corner(:, a)*[f(2)*f(3), f(1)*f(3), f(1)*f(2)]/8
        end do
    end subroutine shape_functions

    ! inv: gradients by x from those by xi
    pure subroutine jacobian(xyz, dn, inv, det)
        real(real64), intent(in) :: xyz(3, 8), dn(3, 8)
        real(real64), intent(out) :: inv(3, 3), det
        real(real64) :: jac(3, 3) ! jac(i, j) = dx_j / dxi_i
        jac = matmul(dn, transpose(xyz))
        inv(:, 1) = cross(jac(2, :), jac(3, :))
        inv(:, 2) = cross(jac(3, :), jac(1, :))
        inv(:, 3) = cross(jac(1, :), jac(2, :))
        det = dot_product(jac(1, :), inv(:, 1))
        inv = inv/det
    end subroutine jacobian

    pure function cross(a, b) result(c)
        real(real64), intent(in) :: a(3), b(3)
        real(real64) :: c(3)
        c = [a(2)*b(3) - a(3)*b(2), a(3)*b(1) - a(1)*b(3), a(1)*b(2) - a(2)*b(1)]
    end function cross

    ! k += weight B' D B in blocks: lambda ga gb' + mu (gb ga' + ga.gb I)
    pure subroutine add_stiffness(g, lambda, mu, weight, k)
        real(real64), intent(in) :: g(3, 11), lambda, mu, weight
        real(real64), intent(inout) :: k(33, 33)
        integer :: a, b, i, j
        real(real64) :: block(3, 3)
        do b = 1, 11
            do a = 1, 11
                do j = 1, 3
                    do i = 1, 3
                        block(i, j) = lambda*g(i, a)*g(j, b) + mu*g(j, a)*g(i, b)
                    end do
                    block(j, j) = block(j, j) + mu*dot_product(g(:, a), g(:, b))
                end do
                k(3*a - 2:3*a, 3*b - 2:3*b) = k(3*a - 2:3*a, 3*b - 2:3*b) + weight*block
            end do
        end do
    end subroutine add_stiffness

    ! eliminates the incompatible modes, 25 to 33
    pure subroutine condense(k)
        real(real64), intent(inout) :: k(33, 33)
        integer :: p, i
        do p = 33, 25, -1
            do i = 1, p - 1
                k(1:p - 1, i) = k(1:p - 1, i) - k(1:p - 1, p)*(k(p, i)/k(p, p))
            end do
        end do
        k = (k + transpose(k))/2 ! symmetric to the last bit
    end subroutine condense

end module brick
