! SPDX-License-Identifier: MIT
! The Fortran module: every function of C, views of arrays of both kinds, of ranks 1 to 3, and of sections.
program test_fortran
  use, intrinsic :: iso_c_binding
  use sphgrad
  implicit none
  integer, parameter :: n = 216
  real(c_double), parameter :: radius = 2.2d0
  real(c_double), target :: x(3, n), v(3, n), columns(n, 3), one = 1
  real(c_float), target :: single(3, n), single_one = 1
  type(c_ptr) :: context, neighbors
  type(sphg_scheme) :: scheme
  type(sphg_sources), target :: sources
  integer :: i

  do i = 0, n - 1
    x(:, i + 1) = [mod(i, 6) + 0.1d0*sin(1d0*i), mod(i/6, 6) + 0.1d0*cos(2d0*i), i/36 + 0.1d0*sin(3d0*i)]
    v(:, i + 1) = [-x(2, i + 1), 2*x(1, i + 1), 3*x(1, i + 1)]
  end do
  columns = transpose(x)
  single = real(x, c_float)
  scheme%support_radius = radius
  call good(sphg_context_create(SPHG_HEADER_VERSION, context=context))
  call good(sphg_neighbors_create(context, neighbors))
  call good(sphg_neighbors_search(context, neighbors, scheme, sphg_all(sphg_view_of(x), n)))
  sources%neighbors = neighbors
  sources%volume = sphg_same(one)

  call views_of_all_kinds()
  call single_precision()
  call operators()
  call requests()
  call pairs_and_lists()
  call matrices()
  call refusals()
  call sphg_neighbors_destroy(neighbors)
  call sphg_context_destroy(context)
  print *, "all held"

contains

  subroutine good(result)
    integer(c_int), intent(in) :: result
    if (result == SPHG_OK) return
    print *, sphg_result_text(result), ": ", sphg_message(context)
    error stop 1
  end subroutine good

  subroutine expect(condition, what)
    logical, intent(in) :: condition
    character(*), intent(in) :: what
    if (condition) return
    print *, what
    error stop 1
  end subroutine expect

  ! It refuses with this result, and the message holds the words.
  subroutine refused(result, expected, words)
    integer(c_int), intent(in) :: result, expected
    character(*), intent(in) :: words
    call expect(result == expected, "result of "//words)
    call expect(index(sphg_message(context), words) > 0, sphg_message(context)//", not "//words)
  end subroutine refused

  logical function exact(j)
    real(c_double), intent(in) :: j(:, :, :) ! j(b, a, i)
    exact = all(abs(j(2, 1, :) + 1) < 1d-11) .and. all(abs(j(1, 2, :) - 2) < 1d-11) .and. &
      all(abs(j(1, 3, :) - 3) < 1d-11) .and. all(abs(j(1, 1, :)) < 1d-11) .and. all(abs(j(3, :, :)) < 1d-11)
  end function exact

  subroutine views_of_all_kinds()
    real(c_double), target :: j(3, 3, n), wide(5, 3, 2*n), tall(n, 5), three(9, n), apart(3, 2, n)
    real(c_double), target :: g(3, n), many(2*n), rows(4, 4, n), matrices(3, 3, n), table(6, n)
    type(sphg_view) :: view
    call good(sphg_jacobian(context, scheme, sources, field=sphg_view_of(v), jacobian=sphg_view_of(j)))
    call expect(exact(j), "j of an array")
    three = 0
    call good(sphg_jacobian(context, scheme, sources, field=sphg_view_of(v), jacobian=sphg_view_of(three)))
    call expect(all(reshape(three, [3, 3, n]) == j), "rank 2 for tensors")
    call good(sphg_jacobian(context, scheme, sources, field=sphg_view_of(v), &
      jacobian=sphg_matrices_of(matrices)))
    call expect(all(matrices(2, 1, :) == j(1, 2, :)) .and. all(matrices(1, 3, :) == j(3, 1, :)) .and. &
      all(matrices(3, 3, :) == j(3, 3, :)), "matrices as they are written")
    call good(sphg_correction(context, scheme, sources, correction=sphg_full_of(matrices), &
      rank=sphg_absent()))
    call good(sphg_correction(context, scheme, sources, correction=sphg_view_of(table), rank=sphg_absent()))
    call expect(all(matrices(1, 3, :) == table(3, :)) .and. all(matrices(3, 1, :) == table(3, :)) .and. &
      all(matrices(2, 2, :) == table(4, :)), "whole corrections")
    view = sphg_full_of(wide(2:4, :, 2::2))
    call expect(view%type == -1, "whole matrices that are scattered")
    wide = 7
    call good(sphg_jacobian(context, scheme, sources, field=sphg_view_of(v), &
      jacobian=sphg_view_of(wide(2:4, :, 2::2))))
    call expect(all(wide(2:4, :, 2::2) == j) .and. all(wide(1, :, :) == 7) .and. all(wide(5, :, :) == 7) &
      .and. all(wide(:, :, 1::2) == 7), "a section of an array of tensors")
    rows = 7
    call good(sphg_jacobian(context, scheme, sources, field=sphg_view_of(v), &
      jacobian=sphg_view_of(rows(:3, :3, n:1:-1))))
    call expect(all(rows(:3, :3, n:1:-1) == j) .and. all(rows(4, :, :) == 7), "backwards, 3 of 4")
    tall = 0
    tall(:, 1:5:2) = transpose(v)
    call good(sphg_jacobian(context, scheme, sources, field=sphg_columns_of(tall(:, 1:5:2)), &
      jacobian=sphg_view_of(three)))
    call expect(all(reshape(three, [3, 3, n]) == j), "columns")
    apart = 0
    apart(:, 2, :) = v
    call good(sphg_jacobian(context, scheme, sources, field=sphg_view_of(apart(:, 2, :)), &
      jacobian=sphg_view_of(three)))
    call expect(all(reshape(three, [3, 3, n]) == j), "every second vector")
    many = 0
    many(2::2) = v(2, :)
    g = 0
    call good(sphg_gradient(context, scheme, sources, field=sphg_view_of(many(2::2)), &
      gradient=sphg_view_of(g(3:1:-1, :))))
    call expect(all(g(3:1:-1, :) == j(:, 2, :)), "components backwards")
    view = sphg_view_of(wide(1:5:2, :, :))
    call expect(view%type == -1, "rows that are scattered")
    view = sphg_view_of(wide(1:5:2, 1, :))
    call expect(view%type == SPHG_F64 .and. c_associated(view%y), "vectors whose components are scattered")
    view = sphg_view_of(three(1:9:2, :))
    call expect(view%type == -1, "packed tensors that are scattered")
    view = sphg_columns_of(tall)
    call expect(view%type == -1, "five columns")
    call refused(sphg_jacobian(context, scheme, sources, field=view, jacobian=sphg_view_of(j)), &
      SPHG_ERROR_ARGUMENT, "not a type")
    call good(sphg_neighbors_search(context, neighbors, scheme, sphg_all(sphg_columns_of(columns), n)))
    call good(sphg_jacobian(context, scheme, sources, field=sphg_view_of(v), jacobian=sphg_view_of(three)))
    call expect(all(reshape(three, [3, 3, n]) == j), "positions in columns")
  end subroutine views_of_all_kinds

  subroutine single_precision()
    real(c_float), target :: j(3, 3, n), g(3, n), first(n)
    type(c_ptr) :: other
    type(sphg_sources) :: set
    call good(sphg_neighbors_create(context, other))
    call good(sphg_neighbors_search(context, other, scheme, sphg_all(sphg_view_of(single), n)))
    set%neighbors = other
    set%volume = sphg_same(single_one)
    call good(sphg_jacobian(context, scheme, set, field=sphg_view_of(single), jacobian=sphg_view_of(j)))
    call expect(all(abs(j(1, 1, :) - 1) < 1e-4) .and. all(abs(j(2, 1, :)) < 1e-4), "f32")
    first = single(1, :)
    call good(sphg_gradient(context, scheme, set, field=sphg_view_of(first), gradient=sphg_view_of(g)))
    call expect(all(abs(g - j(:, 1, :)) < 1e-5), "f32, gradient")
    call refused(sphg_jacobian(context, scheme, set, field=sphg_view_of(v), jacobian=sphg_view_of(j)), &
      SPHG_ERROR_TYPE, "type")
    call sphg_neighbors_destroy(other)
  end subroutine single_precision

  subroutine operators()
    real(c_double), target :: divergence(n), curl(3, n), table(6, n), force(3, n), again(3, n), p(n)
    integer(c_int8_t), target :: rank(n), mask(n)
    integer(c_int32_t), target :: some(2) = [3, 5]
    type(sphg_sources) :: set
    call good(sphg_divergence(context, scheme, sources, field=sphg_view_of(v), &
      divergence=sphg_view_of(divergence)))
    call good(sphg_curl(context, scheme, sources, field=sphg_view_of(v), curl=sphg_view_of(curl)))
    call expect(all(abs(divergence) < 1d-11) .and. all(abs(curl(2, :) + 3) < 1d-11) .and. &
      all(abs(curl(3, :) - 3) < 1d-11), "divergence and curl")
    call expect(sphg_correction_width(scheme) == 6, "width")
    call good(sphg_correction(context, scheme, sources, correction=sphg_view_of(table), &
      rank=sphg_view_of(rank)))
    call expect(all(rank == 3), "rank")
    set = sources
    set%correction = sphg_view_of(table)
    p = x(1, :)*x(2, :)
    call good(sphg_force(context, scheme, set, shape=SPHG_SCALAR, stress=sphg_view_of(p), &
      force=sphg_view_of(force)))
    call expect(all(abs(sum(force, 2)) < 1d-9) .and. maxval(abs(force)) > 1, "momentum")
    mask = 0
    mask(2::2) = 1
    again = 7
    call good(sphg_force(context, scheme, set, sphg_masked(mask), SPHG_SCALAR, sphg_view_of(p), &
      sphg_view_of(again)))
    call expect(all(again(:, 2::2) == force(:, 2::2)) .and. all(again(:, 1::2) == 7), "mask")
    call good(sphg_force(context, scheme, set, sphg_listed(some), SPHG_SCALAR, sphg_view_of(p), &
      sphg_view_of(again)))
    call good(sphg_force(context, scheme, set, sphg_range(0, 2), SPHG_SCALAR, sphg_view_of(p), &
      sphg_view_of(again)))
    call expect(all(again(:, [1, 2, 4, 6]) == force(:, [1, 2, 4, 6])) .and. all(again(:, 3) == 7), "subsets")
  end subroutine operators

  subroutine requests()
    type(sphg_field), target :: fields(1)
    type(sphg_view), target :: at_sources(1)
    type(sphg_sources), target :: sets(1)
    type(sphg_stats), target :: stats
    type(sphg_request) :: request
    type(sphg_geometry) :: geometry
    type(sphg_context_info) :: context_info
    type(sphg_neighbors_info) :: info
    real(c_double), target :: j(3, 3, n), lambda(n), places(3, 1), there(3, 1), slope(3, 3, 1)
    type(c_ptr) :: other, third
    integer(c_int32_t) :: rebuild
    at_sources(1) = sphg_view_of(v)
    fields(1)%shape = SPHG_VECTOR
    fields(1)%at_sources = c_loc(at_sources)
    fields(1)%gradient = sphg_view_of(j)
    sets(1) = sources
    request%sources = c_loc(sets)
    request%fields = c_loc(fields)
    request%set_count = 1
    request%field_count = 1
    request%lambda_min = sphg_view_of(lambda)
    request%stats = c_loc(stats)
    call good(sphg_evaluate(context, scheme, request))
    call expect(exact(j) .and. stats%rank(4) == n .and. all(lambda > 0), "evaluate")

    call good(sphg_neighbors_create(context, other))
    places(:, 1) = [2.5d0, 2.6d0, 2.4d0]
    geometry = sphg_targets_apart(sphg_view_of(places), 1, sphg_view_of(x), n)
    call good(sphg_neighbors_search(context, other, scheme, geometry))
    sets(1)%neighbors = other
    there(:, 1) = [-places(2, 1), 2*places(1, 1), 3*places(1, 1)]
    fields(1)%at_targets = sphg_view_of(there)
    fields(1)%gradient = sphg_view_of(slope)
    request%lambda_min = sphg_absent()
    call good(sphg_evaluate(context, scheme, request))
    call expect(exact(slope), "targets apart")
    call good(sphg_neighbors_create(context, third))
    call good(sphg_neighbors_search(context, third, scheme, sphg_targets_of(other, sphg_view_of(x), n)))
    sets(1)%neighbors = third
    slope = 0
    call good(sphg_evaluate(context, scheme, request))
    call expect(exact(slope), "targets of")
    call sphg_neighbors_destroy(third)
    geometry = sphg_own_and_ghosts(sphg_view_of(x), 200, 16)
    geometry%period(1) = 6
    geometry%skin = 0.1d0
    call good(sphg_neighbors_search(context, other, scheme, geometry))
    call good(sphg_neighbors_get_info(context, other, info))
    call expect(info%target_count == 200 .and. info%source_count == n .and. info%skin_left > 0, "info")
    call good(sphg_neighbors_would_rebuild(context, other, scheme, geometry, rebuild))
    call expect(rebuild == 0, "the skin holds")
    geometry%skin = 0.2d0
    call good(sphg_neighbors_would_rebuild(context, other, scheme, geometry, rebuild))
    call expect(rebuild == 1, "another skin")
    call good(sphg_context_get_info(context, context_info))
    call expect(context_info%threads >= 1 .and. sphg_version() == SPHG_HEADER_VERSION, "context")
    call sphg_neighbors_destroy(other)
  end subroutine requests

  subroutine pairs_and_lists()
    type(sphg_pairs) :: pairs
    type(sphg_lists) :: lists
    type(sphg_list_fault) :: fault
    type(c_ptr) :: listed
    integer(c_int64_t), target :: offsets(n + 1)
    integer(c_int32_t), allocatable, target :: indices(:)
    integer(c_int32_t) :: order(n)
    real(c_double), allocatable, target :: g(:, :)
    real(c_double), target :: table(6, n), j(3, 3, n)
    real(c_double) :: single_g(3)
    pairs%offsets = c_loc(offsets)
    call good(sphg_pair_gradients(context, scheme, sources, target_correction=sphg_absent(), pairs=pairs))
    allocate (indices(pairs%count), g(3, pairs%count))
    pairs%indices = c_loc(indices)
    pairs%gradient = sphg_view_of(g)
    pairs%capacity = pairs%count
    call good(sphg_pair_gradients(context, scheme, sources, target_correction=sphg_absent(), pairs=pairs))
    call good(sphg_correction(context, scheme, sources, correction=sphg_view_of(table), rank=sphg_absent()))
    call sphg_pair_gradient(scheme, x(:, 1) - x(:, indices(1) + 1), 1d0, table(:, 1), single_g)
    call expect(all(abs(single_g - g(:, 1)) < 1d-12), "one pair")
    pairs%capacity = 5
    call refused(sphg_pair_gradients(context, scheme, sources, target_correction=sphg_absent(), pairs=pairs), &
      SPHG_ERROR_CAPACITY, "capacity")
    call good(sphg_neighbors_create(context, listed))
    lists%offsets = c_loc(offsets)
    lists%indices = c_loc(indices)
    call good(sphg_neighbors_use_lists(context, listed, scheme, sphg_all(sphg_view_of(x), n), lists))
    call good(sphg_neighbors_check(context, scheme, listed))
    sources%neighbors = listed
    call good(sphg_jacobian(context, scheme, sources, field=sphg_view_of(v), jacobian=sphg_view_of(j)))
    sources%neighbors = neighbors
    call expect(exact(j), "lists")
    indices(1) = indices(2)
    call refused(sphg_neighbors_check(context, scheme, listed, fault), SPHG_ERROR_LISTS, "")
    call expect(fault%kind == SPHG_FAULT_DOUBLED .and. fault%target == 0, "fault")
    call good(sphg_neighbors_get_order(context, neighbors, order))
    call expect(sum(order) == n*(n - 1)/2, "order")
    call sphg_neighbors_destroy(listed)
  end subroutine pairs_and_lists

  subroutine matrices()
    real(c_double), target :: packed(6, 2), values(3, 2), vectors(3, 3, 2), full(3, 3, 1)
    real(c_double), target :: u(3, 3, 1), sigma(3, 1), right(3, 3, 1), inverse(6, 2)
    real(c_double) :: w, slope, norm, moment
    type(sphg_inversion) :: wanted
    packed(:, 1) = [4, 0, 0, 2, 0, 1]
    packed(:, 2) = [1, 0, 0, 1, 0, 1]
    call good(sphg_eigen(context, 3, 2, sphg_view_of(packed), sphg_view_of(values), sphg_view_of(vectors)))
    call expect(all(abs(values(:, 1) - [4, 2, 1]) < 1d-14), "eigen")
    full = reshape([0d0, 2d0, 0d0, 1d0, 0d0, 0d0, 0d0, 0d0, 3d0], [3, 3, 1])
    call good(sphg_svd(context, 1, sphg_view_of(full), sphg_view_of(u), sphg_view_of(sigma), &
      sphg_view_of(right)))
    call expect(all(abs(sigma(:, 1) - [3, 2, 1]) < 1d-14), "svd")
    wanted%correction = sphg_view_of(inverse)
    call good(sphg_invert_moments(context, scheme, 2, sphg_view_of(packed), sphg_same(one), wanted))
    call expect(abs(inverse(1, 1) - 0.25d0) < 1d-14, "inverse")
    call sphg_kernel_value(scheme, 0.5d0, w, slope)
    call sphg_kernel_value(scheme, 0.5d0, dw_over_r=slope)
    call sphg_kernel_constants(scheme, norm, moment)
    call expect(w > 0 .and. slope < 0 .and. norm > 2 .and. moment > 0, "kernel")
  end subroutine matrices

  subroutine refusals()
    type(sphg_scheme) :: wrong
    type(sphg_config) :: config
    type(c_ptr) :: none
    integer(c_int) :: result
    real(c_double), target :: bad(3, 2)
    wrong%support_radius = -1
    call refused(sphg_neighbors_search(context, neighbors, wrong, sphg_all(sphg_view_of(x), n)), &
      SPHG_ERROR_ARGUMENT, "support_radius is -1")
    bad = 0
    bad(2, 2) = bad(2, 2)/bad(1, 1)
    call refused(sphg_neighbors_search(context, neighbors, scheme, sphg_all(sphg_view_of(bad), 2)), &
      SPHG_ERROR_NOT_FINITE, "1")
    config%threads = -1
    result = sphg_context_create(SPHG_HEADER_VERSION, config, none)
    call expect(result == SPHG_ERROR_ARGUMENT .and. .not. c_associated(none), "no context")
    call expect(sphg_result_text(result) /= "" .and. sphg_message(none) == sphg_message(none), "text")
  end subroutine refusals
end program test_fortran
