/* sphgrad in C++17: handles that free themselves, views that know their length, errors as
 * exceptions or as results. SPDX-License-Identifier: MIT
 *
 * Everything here calls sphgrad.h, whose comments are the manual; docs/cpp.md shows how the two go
 * together. Schemes, lists, statistics and enumerators are those of C.
 *
 *   sphgrad::context        throws sphgrad::error
 *   sphgrad::quiet_context  returns sphgrad::status, which must be looked at
 *
 * Before a call the length of every view is compared with the particles of the neighbours, and its
 * numbers per item with what the operator reads or writes: SPHG_ERROR_SIZE. */
#ifndef SPHGRAD_SPHGRAD_HPP
#define SPHGRAD_SPHGRAD_HPP
#include "cpp/checks.hpp"
#include "cpp/context.hpp"
#include "cpp/errors.hpp"
#include "cpp/neighbors.hpp"
#include "cpp/requests.hpp"
#include "cpp/views.hpp"
#endif
