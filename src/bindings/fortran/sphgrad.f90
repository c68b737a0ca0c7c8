! sphgrad in Fortran: the C interface of sphgrad.h, whose comments are the manual, and views of arrays.
! SPDX-License-Identifier: MIT
!
! Types begin as sphg_... = {0} does in C: set what you need. Optional arguments that are absent are NULL
! there. Arrays that views or pointers point to need the attribute `target` (or pointer, allocatable with
! target), and must live until the call is over; lists until the next build.
!
! Numbers of targets and sources (indices, order, subsets, lists) count from 0, as in C.
!
! J[a][b] = d v_a / d x_b of C is j(b, a) here: Fortran stores the first index fastest. So the array for a
! Jacobian is j(3, 3, n), and j(b, a, i) the derivative of component a along axis b at particle i.
module sphgrad
  use, intrinsic :: iso_c_binding
  implicit none
  private

  integer(c_int32_t), parameter, public :: SPHG_HEADER_VERSION = 100 ! SPHG_VERSION of C

  ! sphg_result
  enum, bind(c)
    enumerator :: SPHG_OK = 0
    enumerator :: SPHG_ERROR_ARGUMENT = 1
    enumerator :: SPHG_ERROR_VERSION = 2
    enumerator :: SPHG_ERROR_TYPE = 3
    enumerator :: SPHG_ERROR_SIZE = 4
    enumerator :: SPHG_ERROR_STATE = 5
    enumerator :: SPHG_ERROR_UNSUPPORTED = 6
    enumerator :: SPHG_ERROR_CAPACITY = 7
    enumerator :: SPHG_ERROR_NOT_FINITE = 8
    enumerator :: SPHG_ERROR_BUSY = 9
    enumerator :: SPHG_ERROR_LISTS = 10
    enumerator :: SPHG_ERROR_MEMORY = -1
    enumerator :: SPHG_ERROR_INDEX = -2
    enumerator :: SPHG_ERROR_VOLUME = -3
  end enum
  ! sphg_type
  enum, bind(c)
    enumerator :: SPHG_F32 = 1
    enumerator :: SPHG_F64 = 2
    enumerator :: SPHG_U8 = 3
  end enum
  ! sphg_shape
  enum, bind(c)
    enumerator :: SPHG_SCALAR = 1
    enumerator :: SPHG_VECTOR = 2
    enumerator :: SPHG_SYM_TENSOR = 3
    enumerator :: SPHG_TENSOR = 4
  end enum

  ! sphg_layout
  enum, bind(c)
    enumerator :: SPHG_AS_SHAPE = 0
    enumerator :: SPHG_COLUMN_MAJOR = 1
    enumerator :: SPHG_FULL = 2
  end enum
  ! sphg_isa
  enum, bind(c)
    enumerator :: SPHG_ISA_BEST = 0
    enumerator :: SPHG_ISA_BASE = 1
    enumerator :: SPHG_ISA_X86_V3 = 2
    enumerator :: SPHG_ISA_X86_V4 = 3
    enumerator :: SPHG_ISA_NEON = 4
  end enum
  ! sphg_method
  enum, bind(c)
    enumerator :: SPHG_KGC = 0
    enumerator :: SPHG_MLS = 1
    enumerator :: SPHG_RKPM = 2
    enumerator :: SPHG_CMLS = 3
    enumerator :: SPHG_CRKPM = 4
    enumerator :: SPHG_PLAIN = 5
  end enum
  ! sphg_kernel
  enum, bind(c)
    enumerator :: SPHG_CUBIC_SPLINE = 0
    enumerator :: SPHG_QUINTIC_SPLINE = 1
    enumerator :: SPHG_WENDLAND_C2 = 2
    enumerator :: SPHG_WENDLAND_C4 = 3
    enumerator :: SPHG_WENDLAND_C6 = 4
    enumerator :: SPHG_POLY6 = 5
    enumerator :: SPHG_SPIKY = 6
  end enum
  ! sphg_policy
  enum, bind(c)
    enumerator :: SPHG_BLEND = 0
    enumerator :: SPHG_REPLACE = 1
    enumerator :: SPHG_TRUNCATE = 2
    enumerator :: SPHG_IDENTITY = 3
  end enum
  ! sphg_fault
  enum, bind(c)
    enumerator :: SPHG_FAULT_NONE = 0
    enumerator :: SPHG_FAULT_LENGTH = 1
    enumerator :: SPHG_FAULT_INDEX = 2
    enumerator :: SPHG_FAULT_DOUBLED = 3
    enumerator :: SPHG_FAULT_ONE_SIDED = 4
    enumerator :: SPHG_FAULT_MISSING = 5
  end enum
  ! sphg_form
  enum, bind(c)
    enumerator :: SPHG_DIFFERENCE = 0
    enumerator :: SPHG_DIRECT = 1
    enumerator :: SPHG_SYMMETRIC = 2
    enumerator :: SPHG_ADJOINT = 3
  end enum
  public :: SPHG_OK, SPHG_ERROR_ARGUMENT, SPHG_ERROR_VERSION, SPHG_ERROR_TYPE, SPHG_ERROR_SIZE, &
      SPHG_ERROR_STATE, SPHG_ERROR_UNSUPPORTED, SPHG_ERROR_CAPACITY, SPHG_ERROR_NOT_FINITE, &
      SPHG_ERROR_BUSY, SPHG_ERROR_LISTS, SPHG_ERROR_MEMORY, SPHG_ERROR_INDEX, &
      SPHG_ERROR_VOLUME, SPHG_F32, SPHG_F64, SPHG_U8, SPHG_SCALAR, SPHG_VECTOR, &
      SPHG_SYM_TENSOR, SPHG_TENSOR, SPHG_AS_SHAPE, SPHG_COLUMN_MAJOR, SPHG_FULL, &
      SPHG_ISA_BEST, SPHG_ISA_BASE, SPHG_ISA_X86_V3, &
      SPHG_ISA_X86_V4, SPHG_ISA_NEON, SPHG_KGC, SPHG_MLS, SPHG_RKPM, SPHG_CMLS, SPHG_CRKPM, &
      SPHG_PLAIN, SPHG_CUBIC_SPLINE, SPHG_QUINTIC_SPLINE, SPHG_WENDLAND_C2, SPHG_WENDLAND_C4, &
      SPHG_WENDLAND_C6, SPHG_POLY6, SPHG_SPIKY, SPHG_BLEND, SPHG_REPLACE, SPHG_TRUNCATE, &
      SPHG_IDENTITY, SPHG_FAULT_NONE, SPHG_FAULT_LENGTH, SPHG_FAULT_INDEX, SPHG_FAULT_DOUBLED, &
      SPHG_FAULT_ONE_SIDED, SPHG_FAULT_MISSING, SPHG_DIFFERENCE, SPHG_DIRECT, SPHG_SYMMETRIC, &
      SPHG_ADJOINT

  ! Strided view of the host's memory; see sphg_view_of, sphg_columns_of and sphg_same
  type, bind(c), public :: sphg_view
    type(c_ptr) :: x = c_null_ptr, y = c_null_ptr, z = c_null_ptr
    integer(c_ptrdiff_t) :: stride = 0
    integer(c_int) :: type = 0
    integer(c_int) :: layout = 0
  end type sphg_view

  type, bind(c), public :: sphg_config
    integer(c_int32_t) :: threads = 0
    integer(c_int) :: isa = 0
    integer(c_int32_t) :: trusted = 0
    type(c_funptr) :: allocate = c_null_funptr, release = c_null_funptr, log = c_null_funptr, &
      parallel_for = c_null_funptr
    type(c_ptr) :: user = c_null_ptr
  end type sphg_config

  type, bind(c), public :: sphg_context_info
    integer(c_int32_t) :: threads = 0
    integer(c_int) :: isa = 0
    integer(c_int32_t) :: openmp = 0
    integer(c_int64_t) :: bytes = 0
  end type sphg_context_info

  type, bind(c), public :: sphg_scheme
    integer(c_int32_t) :: dimension = 0
    integer(c_int) :: method = 0, kernel = 0, policy = 0
    real(c_double) :: support_radius = 0, threshold = 0
    integer(c_int32_t) :: order = 0
  end type sphg_scheme

  type, bind(c), public :: sphg_geometry
    type(sphg_view) :: sources, targets
    integer(c_int32_t) :: source_count = 0, target_count = 0
    integer(c_int) :: precision = 0
    integer(c_int32_t) :: list_free = 0, keep_weights = 0
    real(c_double) :: skin = 0
    real(c_double) :: period(3) = 0
    type(sphg_view) :: source_support, target_support
    integer(c_int32_t) :: mutual = 0
    type(c_ptr) :: targets_of = c_null_ptr
  end type sphg_geometry

  type, bind(c), public :: sphg_lists
    type(c_ptr) :: offsets = c_null_ptr, indices = c_null_ptr, rows = c_null_ptr, &
      lengths = c_null_ptr
    type(c_funptr) :: row = c_null_funptr
    type(c_ptr) :: user = c_null_ptr
    integer(c_int32_t) :: index_mask = 0, copy = 0
  end type sphg_lists

  type, bind(c), public :: sphg_neighbors_info
    integer(c_int64_t) :: pairs = 0, bytes = 0
    integer(c_int32_t) :: target_count = 0, source_count = 0, rebuilt = 0
    real(c_double) :: skin_left = 0
  end type sphg_neighbors_info

  type, bind(c), public :: sphg_list_fault
    integer(c_int) :: kind = 0
    integer(c_int32_t) :: target = 0, source = 0, faulty = 0
    real(c_double) :: distance = 0
  end type sphg_list_fault

  type, bind(c), public :: sphg_sources
    type(c_ptr) :: neighbors = c_null_ptr
    type(sphg_view) :: volume, density, correction
    integer(c_int32_t) :: same_volumes = 0
  end type sphg_sources

  ! Targets [begin, end), counted from 0 as in C
  type, bind(c), public :: sphg_subset
    integer(c_int32_t) :: begin = 0, end = 0
    type(c_ptr) :: indices = c_null_ptr, mask = c_null_ptr
  end type sphg_subset

  type, bind(c), public :: sphg_field
    integer(c_int) :: shape = 0, form = 0
    integer(c_int32_t) :: accumulate = 0
    type(c_ptr) :: at_sources = c_null_ptr
    type(sphg_view) :: at_targets, value, gradient, divergence, curl, square
    integer(c_int32_t) :: mirror = 0
    type(sphg_view) :: hessian, laplacian, curvature
    type(c_ptr) :: lenders = c_null_ptr, coefficient = c_null_ptr
    type(sphg_view) :: coefficient_at_targets
    integer(c_int32_t) :: shepard = 0
    type(c_ptr) :: value_volume = c_null_ptr
    type(sphg_view) :: tensor, contraction
  end type sphg_field

  ! rank(k + 1): targets of rank k
  type, bind(c), public :: sphg_stats
    integer(c_int64_t) :: rank(4) = 0
    integer(c_int64_t) :: certified = 0, decomposed = 0, empty = 0
    real(c_double) :: lambda_min = 0
    integer(c_int64_t) :: quadratic = 0
  end type sphg_stats

  type, bind(c), public :: sphg_request
    type(c_ptr) :: sources = c_null_ptr, fields = c_null_ptr
    integer(c_int32_t) :: set_count = 0, field_count = 0
    type(c_ptr) :: subset = c_null_ptr
    type(sphg_view) :: target_volume, target_density, target_correction, correction, rank, &
      lambda_min
    type(c_ptr) :: stats = c_null_ptr
    type(sphg_view) :: borrows
  end type sphg_request

  type, bind(c), public :: sphg_pairs
    type(c_ptr) :: offsets = c_null_ptr, indices = c_null_ptr
    type(sphg_view) :: gradient
    integer(c_int64_t) :: capacity = 0, count = 0
    integer(c_int32_t) :: any_order = 0, block = 0
    type(c_ptr) :: lengths = c_null_ptr
  end type sphg_pairs

  type, bind(c), public :: sphg_inversion
    type(sphg_view) :: correction, rank, lambda_min
    type(c_ptr) :: stats = c_null_ptr
  end type sphg_inversion

  ! ---- Functions of C --------------------------------------------------------------------------
  public :: sphg_result_string, sphg_version, sphg_context_create, sphg_context_destroy, &
      sphg_context_get_info, sphg_last_message, sphg_correction_width, sphg_kernel_value, &
      sphg_kernel_constants, sphg_neighbors_create, sphg_neighbors_destroy, &
      sphg_neighbors_search, sphg_neighbors_would_rebuild, sphg_neighbors_use_lists, sphg_neighbors_get_info, &
      sphg_neighbors_check, sphg_neighbors_get_order, sphg_evaluate, sphg_correction, &
      sphg_gradient, sphg_jacobian, sphg_divergence, sphg_curl, sphg_force, &
      sphg_pair_gradients, sphg_pair_gradient, sphg_invert_moments, sphg_eigen, sphg_svd

  interface
    function sphg_result_string(result) bind(c, name="sphg_result_string")
      import :: c_int, c_ptr
      integer(c_int), value :: result
      type(c_ptr) :: sphg_result_string
    end function sphg_result_string

    function sphg_version() bind(c, name="sphg_version")
      import :: c_int32_t
      integer(c_int32_t) :: sphg_version
    end function sphg_version

    function sphg_context_create(version, config, context) bind(c, name="sphg_context_create")
      import :: c_int, c_int32_t, c_ptr, sphg_config
      integer(c_int32_t), value :: version
      type(sphg_config), intent(in), optional :: config
      type(c_ptr), intent(out) :: context
      integer(c_int) :: sphg_context_create
    end function sphg_context_create

    subroutine sphg_context_destroy(context) bind(c, name="sphg_context_destroy")
      import :: c_ptr
      type(c_ptr), value :: context
    end subroutine sphg_context_destroy

    function sphg_context_get_info(context, info) bind(c, name="sphg_context_get_info")
      import :: c_int, c_ptr, sphg_context_info
      type(c_ptr), value :: context
      type(sphg_context_info), intent(out) :: info
      integer(c_int) :: sphg_context_get_info
    end function sphg_context_get_info

    function sphg_last_message(context) bind(c, name="sphg_last_message")
      import :: c_ptr
      type(c_ptr), value :: context
      type(c_ptr) :: sphg_last_message
    end function sphg_last_message

    function sphg_correction_width(scheme) bind(c, name="sphg_correction_width")
      import :: c_int32_t, sphg_scheme
      type(sphg_scheme), intent(in) :: scheme
      integer(c_int32_t) :: sphg_correction_width
    end function sphg_correction_width

    subroutine sphg_kernel_value(scheme, r, w, dw_over_r) bind(c, name="sphg_kernel_value")
      import :: c_double, sphg_scheme
      type(sphg_scheme), intent(in) :: scheme
      real(c_double), value :: r
      real(c_double), intent(out), optional :: w
      real(c_double), intent(out), optional :: dw_over_r
    end subroutine sphg_kernel_value

    subroutine sphg_kernel_constants(scheme, sigma, mu2) bind(c, name="sphg_kernel_constants")
      import :: c_double, sphg_scheme
      type(sphg_scheme), intent(in) :: scheme
      real(c_double), intent(out), optional :: sigma
      real(c_double), intent(out), optional :: mu2
    end subroutine sphg_kernel_constants

    function sphg_neighbors_create(context, neighbors) bind(c, name="sphg_neighbors_create")
      import :: c_int, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), intent(out) :: neighbors
      integer(c_int) :: sphg_neighbors_create
    end function sphg_neighbors_create

    subroutine sphg_neighbors_destroy(neighbors) bind(c, name="sphg_neighbors_destroy")
      import :: c_ptr
      type(c_ptr), value :: neighbors
    end subroutine sphg_neighbors_destroy

    function sphg_neighbors_search(context, neighbors, scheme, geometry) &
        bind(c, name="sphg_neighbors_search")
      import :: c_int, c_ptr, sphg_geometry, sphg_scheme
      type(c_ptr), value :: context
      type(c_ptr), value :: neighbors
      type(sphg_scheme), intent(in) :: scheme
      type(sphg_geometry), intent(in) :: geometry
      integer(c_int) :: sphg_neighbors_search
    end function sphg_neighbors_search

    function sphg_neighbors_would_rebuild(context, neighbors, scheme, geometry, rebuild) &
        bind(c, name="sphg_neighbors_would_rebuild")
      import :: c_int, c_int32_t, c_ptr, sphg_geometry, sphg_scheme
      type(c_ptr), value :: context
      type(c_ptr), value :: neighbors
      type(sphg_scheme), intent(in) :: scheme
      type(sphg_geometry), intent(in) :: geometry
      integer(c_int32_t), intent(out) :: rebuild
      integer(c_int) :: sphg_neighbors_would_rebuild
    end function sphg_neighbors_would_rebuild

    function sphg_neighbors_use_lists(context, neighbors, scheme, geometry, lists) &
        bind(c, name="sphg_neighbors_use_lists")
      import :: c_int, c_ptr, sphg_geometry, sphg_lists, sphg_scheme
      type(c_ptr), value :: context
      type(c_ptr), value :: neighbors
      type(sphg_scheme), intent(in) :: scheme
      type(sphg_geometry), intent(in) :: geometry
      type(sphg_lists), intent(in) :: lists
      integer(c_int) :: sphg_neighbors_use_lists
    end function sphg_neighbors_use_lists

    function sphg_neighbors_get_info(context, neighbors, info) &
        bind(c, name="sphg_neighbors_get_info")
      import :: c_int, c_ptr, sphg_neighbors_info
      type(c_ptr), value :: context
      type(c_ptr), value :: neighbors
      type(sphg_neighbors_info), intent(out) :: info
      integer(c_int) :: sphg_neighbors_get_info
    end function sphg_neighbors_get_info

    function sphg_neighbors_check(context, scheme, neighbors, fault) &
        bind(c, name="sphg_neighbors_check")
      import :: c_int, c_ptr, sphg_list_fault, sphg_scheme
      type(c_ptr), value :: context
      type(sphg_scheme), intent(in) :: scheme
      type(c_ptr), value :: neighbors
      type(sphg_list_fault), intent(out), optional :: fault
      integer(c_int) :: sphg_neighbors_check
    end function sphg_neighbors_check

    function sphg_neighbors_get_order(context, neighbors, order) &
        bind(c, name="sphg_neighbors_get_order")
      import :: c_int, c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: neighbors
      integer(c_int32_t), intent(out) :: order(*)
      integer(c_int) :: sphg_neighbors_get_order
    end function sphg_neighbors_get_order

    function sphg_evaluate(context, scheme, request) bind(c, name="sphg_evaluate")
      import :: c_int, c_ptr, sphg_request, sphg_scheme
      type(c_ptr), value :: context
      type(sphg_scheme), intent(in) :: scheme
      type(sphg_request), intent(in) :: request
      integer(c_int) :: sphg_evaluate
    end function sphg_evaluate

    function sphg_correction(context, scheme, sources, subset, correction, rank) &
        bind(c, name="sphg_correction")
      import :: c_int, c_ptr, sphg_scheme, sphg_sources, sphg_subset, sphg_view
      type(c_ptr), value :: context
      type(sphg_scheme), intent(in) :: scheme
      type(sphg_sources), intent(in) :: sources
      type(sphg_subset), intent(in), optional :: subset
      type(sphg_view), value :: correction
      type(sphg_view), value :: rank
      integer(c_int) :: sphg_correction
    end function sphg_correction

    function sphg_gradient(context, scheme, sources, subset, field, gradient) &
        bind(c, name="sphg_gradient")
      import :: c_int, c_ptr, sphg_scheme, sphg_sources, sphg_subset, sphg_view
      type(c_ptr), value :: context
      type(sphg_scheme), intent(in) :: scheme
      type(sphg_sources), intent(in) :: sources
      type(sphg_subset), intent(in), optional :: subset
      type(sphg_view), value :: field
      type(sphg_view), value :: gradient
      integer(c_int) :: sphg_gradient
    end function sphg_gradient

    function sphg_jacobian(context, scheme, sources, subset, field, jacobian) &
        bind(c, name="sphg_jacobian")
      import :: c_int, c_ptr, sphg_scheme, sphg_sources, sphg_subset, sphg_view
      type(c_ptr), value :: context
      type(sphg_scheme), intent(in) :: scheme
      type(sphg_sources), intent(in) :: sources
      type(sphg_subset), intent(in), optional :: subset
      type(sphg_view), value :: field
      type(sphg_view), value :: jacobian
      integer(c_int) :: sphg_jacobian
    end function sphg_jacobian

    function sphg_divergence(context, scheme, sources, subset, field, divergence) &
        bind(c, name="sphg_divergence")
      import :: c_int, c_ptr, sphg_scheme, sphg_sources, sphg_subset, sphg_view
      type(c_ptr), value :: context
      type(sphg_scheme), intent(in) :: scheme
      type(sphg_sources), intent(in) :: sources
      type(sphg_subset), intent(in), optional :: subset
      type(sphg_view), value :: field
      type(sphg_view), value :: divergence
      integer(c_int) :: sphg_divergence
    end function sphg_divergence

    function sphg_curl(context, scheme, sources, subset, field, curl) bind(c, name="sphg_curl")
      import :: c_int, c_ptr, sphg_scheme, sphg_sources, sphg_subset, sphg_view
      type(c_ptr), value :: context
      type(sphg_scheme), intent(in) :: scheme
      type(sphg_sources), intent(in) :: sources
      type(sphg_subset), intent(in), optional :: subset
      type(sphg_view), value :: field
      type(sphg_view), value :: curl
      integer(c_int) :: sphg_curl
    end function sphg_curl

    function sphg_force(context, scheme, sources, subset, shape, stress, force) &
        bind(c, name="sphg_force")
      import :: c_int, c_ptr, sphg_scheme, sphg_sources, sphg_subset, sphg_view
      type(c_ptr), value :: context
      type(sphg_scheme), intent(in) :: scheme
      type(sphg_sources), intent(in) :: sources
      type(sphg_subset), intent(in), optional :: subset
      integer(c_int), value :: shape
      type(sphg_view), value :: stress
      type(sphg_view), value :: force
      integer(c_int) :: sphg_force
    end function sphg_force

    function sphg_pair_gradients(context, scheme, sources, subset, target_correction, pairs) &
        bind(c, name="sphg_pair_gradients")
      import :: c_int, c_ptr, sphg_pairs, sphg_scheme, sphg_sources, sphg_subset, sphg_view
      type(c_ptr), value :: context
      type(sphg_scheme), intent(in) :: scheme
      type(sphg_sources), intent(in) :: sources
      type(sphg_subset), intent(in), optional :: subset
      type(sphg_view), value :: target_correction
      type(sphg_pairs), intent(inout) :: pairs
      integer(c_int) :: sphg_pair_gradients
    end function sphg_pair_gradients

    subroutine sphg_pair_gradient(scheme, x_ij, volume, correction, gradient) &
        bind(c, name="sphg_pair_gradient")
      import :: c_double, sphg_scheme
      type(sphg_scheme), intent(in) :: scheme
      real(c_double), intent(in) :: x_ij(*)
      real(c_double), value :: volume
      real(c_double), intent(in), optional :: correction(*)
      real(c_double), intent(out) :: gradient(*)
    end subroutine sphg_pair_gradient

    function sphg_invert_moments(context, scheme, count, moments, volume, wanted) &
        bind(c, name="sphg_invert_moments")
      import :: c_int, c_int32_t, c_ptr, sphg_inversion, sphg_scheme, sphg_view
      type(c_ptr), value :: context
      type(sphg_scheme), intent(in) :: scheme
      integer(c_int32_t), value :: count
      type(sphg_view), value :: moments
      type(sphg_view), value :: volume
      type(sphg_inversion), intent(in) :: wanted
      integer(c_int) :: sphg_invert_moments
    end function sphg_invert_moments

    function sphg_eigen(context, dimension, count, matrices, values, vectors) &
        bind(c, name="sphg_eigen")
      import :: c_int, c_int32_t, c_ptr, sphg_view
      type(c_ptr), value :: context
      integer(c_int32_t), value :: dimension
      integer(c_int32_t), value :: count
      type(sphg_view), value :: matrices
      type(sphg_view), value :: values
      type(sphg_view), value :: vectors
      integer(c_int) :: sphg_eigen
    end function sphg_eigen

    function sphg_svd(context, count, matrices, u, sigma, v) bind(c, name="sphg_svd")
      import :: c_int, c_int32_t, c_ptr, sphg_view
      type(c_ptr), value :: context
      integer(c_int32_t), value :: count
      type(sphg_view), value :: matrices
      type(sphg_view), value :: u
      type(sphg_view), value :: sigma
      type(sphg_view), value :: v
      integer(c_int) :: sphg_svd
    end function sphg_svd
  end interface

  ! ---- Views -----------------------------------------------------------------------------------
  !
  !   sphg_view_of(a)      a(n) scalars, a(d, n) vectors (or packed tensors, tables), a(d, d, n)
  !                        tensors; a section of an array as well
  !   sphg_matrices_of(a)  a(d, d, n) tensors whose a(i, k) is row i, column k of the matrix: J stands as
  !                        j(a, b), not as j(b, a)
  !   sphg_full_of(a)      a(d, d, n) symmetric tensors and corrections in full
  !   sphg_columns_of(a)   a(n, d) vectors: each component in a column of its own
  !   sphg_same(a)         one number for all particles
  !   sphg_absent()        nothing
  !
  ! of real(c_float) and real(c_double); for ranks of particles integer(c_int8_t), a(n). A section that a
  ! view cannot express, such as every second number of a packed tensor, gets the type -1, which every call
  ! refuses.
  public :: sphg_view_of, sphg_matrices_of, sphg_full_of, sphg_columns_of, sphg_same, sphg_absent
  public :: sphg_all, sphg_own_and_ghosts, sphg_targets_apart, sphg_targets_of, sphg_range, sphg_masked, sphg_listed
  public :: sphg_message, sphg_result_text

  interface sphg_view_of
    module procedure view_f32_1, view_f32_2, view_f32_3, view_f64_1, view_f64_2, view_f64_3, view_u8_1
  end interface
  interface sphg_matrices_of
    module procedure matrices_f32, matrices_f64
  end interface
  interface sphg_full_of
    module procedure full_f32, full_f64
  end interface
  interface sphg_columns_of
    module procedure columns_f32, columns_f64
  end interface
  interface sphg_same
    module procedure same_f32, same_f64
  end interface

contains

  ! What the library last objected to.
  function sphg_message(context) result(text)
    type(c_ptr), value :: context
    character(:), allocatable :: text
    text = text_of(sphg_last_message(context))
  end function sphg_message

  function sphg_result_text(result) result(text)
    integer(c_int), value :: result
    character(:), allocatable :: text
    text = text_of(sphg_result_string(result))
  end function sphg_result_text

  function text_of(pointer) result(text)
    type(c_ptr), intent(in) :: pointer
    character(:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    integer :: length
    text = ""
    if (.not. c_associated(pointer)) return
    call c_f_pointer(pointer, letters, [huge(0)])
    length = 0
    do while (letters(length + 1) /= c_null_char)
      length = length + 1
    end do
    deallocate (text)
    allocate (character(length) :: text)
    text = transfer(letters(1:length), text)
  end function text_of

  pure function sphg_absent() result(view)
    type(sphg_view) :: view
    view%type = SPHG_F32
  end function sphg_absent

  pure function sphg_targets_apart(targets, target_count, sources, source_count) result(geometry)
    type(sphg_view), intent(in) :: targets, sources
    integer, intent(in) :: target_count, source_count
    type(sphg_geometry) :: geometry
    geometry%targets = targets
    geometry%sources = sources
    geometry%target_count = int(target_count, c_int32_t)
    geometry%source_count = int(source_count, c_int32_t)
  end function sphg_targets_apart

  pure function sphg_targets_of(other, sources, source_count) result(geometry)
    type(c_ptr), intent(in) :: other
    type(sphg_view), intent(in) :: sources
    integer, intent(in) :: source_count
    type(sphg_geometry) :: geometry
    geometry = sphg_targets_apart(sphg_absent(), 0, sources, source_count)
    geometry%targets_of = other
  end function sphg_targets_of

  pure function sphg_all(positions, count) result(geometry)
    type(sphg_view), intent(in) :: positions
    integer, intent(in) :: count
    type(sphg_geometry) :: geometry
    geometry = sphg_targets_apart(sphg_absent(), count, positions, count)
  end function sphg_all

  pure function sphg_own_and_ghosts(positions, own, ghosts) result(geometry)
    type(sphg_view), intent(in) :: positions
    integer, intent(in) :: own, ghosts
    type(sphg_geometry) :: geometry
    geometry = sphg_targets_apart(sphg_absent(), own, positions, own + ghosts)
  end function sphg_own_and_ghosts

  pure function sphg_range(begin, end) result(subset)
    integer, intent(in) :: begin, end
    type(sphg_subset) :: subset
    subset%begin = int(begin, c_int32_t)
    subset%end = int(end, c_int32_t)
  end function sphg_range

  ! A byte for each target; 0 leaves it out.
  function sphg_masked(mask) result(subset)
    integer(c_int8_t), intent(in), target, contiguous :: mask(:)
    type(sphg_subset) :: subset
    subset%end = int(size(mask), c_int32_t)
    if (size(mask) > 0) subset%mask = c_loc(mask)
  end function sphg_masked

  function sphg_listed(indices) result(subset)
    integer(c_int32_t), intent(in), target, contiguous :: indices(:)
    type(sphg_subset) :: subset
    subset%end = int(size(indices), c_int32_t)
    if (size(indices) > 0) subset%indices = c_loc(indices)
  end function sphg_listed

  function view_u8_1(a) result(view)
    integer(c_int8_t), intent(in), target :: a(:)
    type(sphg_view) :: view
    view%type = SPHG_U8
    view%stride = 1
    if (size(a) > 0) view%x = c_loc(a(1))
    if (size(a) > 1) view%stride = apart(c_loc(a(1)), c_loc(a(2)))
  end function view_u8_1

  ! Bytes from one place to another.
  pure function apart(from, to) result(bytes)
    type(c_ptr), intent(in) :: from, to
    integer(c_ptrdiff_t) :: bytes
    bytes = int(transfer(to, 0_c_intptr_t) - transfer(from, 0_c_intptr_t), c_ptrdiff_t)
  end function apart

  ! ---- real(c_float) ----------------------------------------------------------------------

  function same_f32(a) result(view)
    real(c_float), intent(in), target :: a
    type(sphg_view) :: view
    view%type = SPHG_F32
    view%x = c_loc(a)
  end function same_f32

  function view_f32_1(a) result(view)
    real(c_float), intent(in), target :: a(:)
    type(sphg_view) :: view
    view%type = SPHG_F32
    view%stride = 4
    if (size(a) > 0) view%x = c_loc(a(1))
    if (size(a) > 1) view%stride = apart(c_loc(a(1)), c_loc(a(2)))
  end function view_f32_1

  function view_f32_2(a) result(view)
    real(c_float), intent(in), target :: a(:, :)
    type(sphg_view) :: view
    view%type = SPHG_F32
    view%stride = 4 * size(a, 1)
    if (size(a) == 0) return
    view%x = c_loc(a(1, 1))
    if (size(a, 2) > 1) view%stride = apart(view%x, c_loc(a(1, 2)))
    if (size(a, 1) == 1) return
    if (apart(view%x, c_loc(a(2, 1))) == 4) return
    if (size(a, 1) > 3) then
      view%type = -1
      return
    end if
    view%y = c_loc(a(2, 1))
    if (size(a, 1) == 3) view%z = c_loc(a(3, 1))
  end function view_f32_2

  function view_f32_3(a) result(view)
    real(c_float), intent(in), target :: a(:, :, :)
    type(sphg_view) :: view
    view%type = SPHG_F32
    view%stride = 4 * size(a, 1) * size(a, 2)
    if (size(a) == 0) return
    view%x = c_loc(a(1, 1, 1))
    if (size(a, 3) > 1) view%stride = apart(view%x, c_loc(a(1, 1, 2)))
    if (size(a, 1) > 1) then
      if (apart(view%x, c_loc(a(2, 1, 1))) /= 4) view%type = -1
    end if
    if (size(a, 2) == 1) return
    if (apart(view%x, c_loc(a(1, 2, 1))) == 4 * size(a, 1)) return
    if (size(a, 2) > 3) then
      view%type = -1
      return
    end if
    view%y = c_loc(a(1, 2, 1))
    if (size(a, 2) == 3) view%z = c_loc(a(1, 3, 1))
  end function view_f32_3

  function matrices_f32(a) result(view)
    real(c_float), intent(in), target :: a(:, :, :)
    type(sphg_view) :: view
    view = view_f32_3(a)
    view%layout = SPHG_COLUMN_MAJOR
  end function matrices_f32

  function full_f32(a) result(view)
    real(c_float), intent(in), target :: a(:, :, :)
    type(sphg_view) :: view
    view = view_f32_3(a)
    if (c_associated(view%y)) view%type = -1 ! its numbers do not follow one another
    view%layout = SPHG_FULL
  end function full_f32

  function columns_f32(a) result(view)
    real(c_float), intent(in), target :: a(:, :)
    type(sphg_view) :: view
    view%type = SPHG_F32
    view%stride = 4
    if (size(a) == 0) return
    view%x = c_loc(a(1, 1))
    if (size(a, 1) > 1) view%stride = apart(view%x, c_loc(a(2, 1)))
    if (size(a, 2) == 1) return
    view%y = c_loc(a(1, 2))
    if (size(a, 2) > 2) view%z = c_loc(a(1, 3))
    if (size(a, 2) > 3) view%type = -1
  end function columns_f32

  ! ---- real(c_double) ----------------------------------------------------------------------

  function same_f64(a) result(view)
    real(c_double), intent(in), target :: a
    type(sphg_view) :: view
    view%type = SPHG_F64
    view%x = c_loc(a)
  end function same_f64

  function view_f64_1(a) result(view)
    real(c_double), intent(in), target :: a(:)
    type(sphg_view) :: view
    view%type = SPHG_F64
    view%stride = 8
    if (size(a) > 0) view%x = c_loc(a(1))
    if (size(a) > 1) view%stride = apart(c_loc(a(1)), c_loc(a(2)))
  end function view_f64_1

  function view_f64_2(a) result(view)
    real(c_double), intent(in), target :: a(:, :)
    type(sphg_view) :: view
    view%type = SPHG_F64
    view%stride = 8 * size(a, 1)
    if (size(a) == 0) return
    view%x = c_loc(a(1, 1))
    if (size(a, 2) > 1) view%stride = apart(view%x, c_loc(a(1, 2)))
    if (size(a, 1) == 1) return
    if (apart(view%x, c_loc(a(2, 1))) == 8) return
    if (size(a, 1) > 3) then
      view%type = -1
      return
    end if
    view%y = c_loc(a(2, 1))
    if (size(a, 1) == 3) view%z = c_loc(a(3, 1))
  end function view_f64_2

  function view_f64_3(a) result(view)
    real(c_double), intent(in), target :: a(:, :, :)
    type(sphg_view) :: view
    view%type = SPHG_F64
    view%stride = 8 * size(a, 1) * size(a, 2)
    if (size(a) == 0) return
    view%x = c_loc(a(1, 1, 1))
    if (size(a, 3) > 1) view%stride = apart(view%x, c_loc(a(1, 1, 2)))
    if (size(a, 1) > 1) then
      if (apart(view%x, c_loc(a(2, 1, 1))) /= 8) view%type = -1
    end if
    if (size(a, 2) == 1) return
    if (apart(view%x, c_loc(a(1, 2, 1))) == 8 * size(a, 1)) return
    if (size(a, 2) > 3) then
      view%type = -1
      return
    end if
    view%y = c_loc(a(1, 2, 1))
    if (size(a, 2) == 3) view%z = c_loc(a(1, 3, 1))
  end function view_f64_3

  function matrices_f64(a) result(view)
    real(c_double), intent(in), target :: a(:, :, :)
    type(sphg_view) :: view
    view = view_f64_3(a)
    view%layout = SPHG_COLUMN_MAJOR
  end function matrices_f64

  function full_f64(a) result(view)
    real(c_double), intent(in), target :: a(:, :, :)
    type(sphg_view) :: view
    view = view_f64_3(a)
    if (c_associated(view%y)) view%type = -1 ! its numbers do not follow one another
    view%layout = SPHG_FULL
  end function full_f64

  function columns_f64(a) result(view)
    real(c_double), intent(in), target :: a(:, :)
    type(sphg_view) :: view
    view%type = SPHG_F64
    view%stride = 8
    if (size(a) == 0) return
    view%x = c_loc(a(1, 1))
    if (size(a, 1) > 1) view%stride = apart(view%x, c_loc(a(2, 1)))
    if (size(a, 2) == 1) return
    view%y = c_loc(a(1, 2))
    if (size(a, 2) > 2) view%z = c_loc(a(1, 3))
    if (size(a, 2) > 3) view%type = -1
  end function columns_f64

end module sphgrad
