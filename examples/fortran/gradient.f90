! SPDX-License-Identifier: MIT
! A rotating block of particles in Fortran: dvx/dy at its corner is -1. Plain SPH finds -0.36.
program gradient
  use, intrinsic :: iso_c_binding
  use sphgrad
  implicit none
  integer, parameter :: n = 1000
  real(c_double), target :: x(3, n), v(3, n), j(3, 3, n), volume = 1 ! j(b, a, i) = d v_a / d x_b at i
  type(c_ptr) :: context, neighbors
  type(sphg_scheme) :: scheme
  type(sphg_sources) :: sources
  integer :: i

  do i = 0, n - 1 ! 10 x 10 x 10, spacing 1, v = (-y, x, 0)
    x(:, i + 1) = [mod(i, 10), mod(i/10, 10), i/100]
    v(:, i + 1) = [-x(2, i + 1), x(1, i + 1), 0d0]
  end do

  scheme%support_radius = 2 ! nothing else: 3D, KGC, cubic spline
  call check(sphg_context_create(SPHG_HEADER_VERSION, context=context))
  call check(sphg_neighbors_create(context, neighbors))
  call check(sphg_neighbors_search(context, neighbors, scheme, sphg_all(sphg_view_of(x), n)))
  sources%neighbors = neighbors
  sources%volume = sphg_same(volume)
  call check(sphg_jacobian(context, scheme, sources, field=sphg_view_of(v), jacobian=sphg_view_of(j)))
  print '(a, f11.7)', "dvx/dy =", j(2, 1, 1)
  if (abs(j(2, 1, 1) + 1) > 1d-9) error stop 1
  call sphg_neighbors_destroy(neighbors)
  call sphg_context_destroy(context)

contains

  subroutine check(result)
    integer(c_int), intent(in) :: result
    if (result == SPHG_OK) return
    print '(2a)', sphg_result_text(result)//": ", sphg_message(context)
    error stop 1
  end subroutine check
end program gradient
