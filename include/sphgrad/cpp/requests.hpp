/* SPDX-License-Identifier: MIT */
/* What calls are asked: geometries, lists, subsets, source sets, fields, requests; and the
 * kernel alone. Part of sphgrad.hpp, which includes it. */
#ifndef SPHGRAD_CPP_REQUESTS_HPP
#define SPHGRAD_CPP_REQUESTS_HPP
#include "views.hpp"
#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace sphgrad
{

inline sphg_scheme scheme(double support_radius, sphg_method method = SPHG_KGC, int dimension = 3,
                          sphg_kernel kernel = SPHG_CUBIC_SPLINE, sphg_policy policy = SPHG_BLEND,
                          double threshold = 0, int order = 1)
{
    return {dimension, method, kernel, policy, support_radius, threshold, order};
}

/* Positions, radii of their own, and counts. Precision, skin, period, list_free and mutual are set
 * in `options`, whose views and counts are not read. */
struct geometry {
    input sources, targets;
    std::int64_t own = -1; /* targets that are part of the sources; -1: all, or `targets` */
    sphg_geometry options = {};
    input source_support, target_support;
    const sphg_neighbors *targets_of = nullptr;
};
inline geometry all(input positions)
{
    geometry made;
    made.sources = positions;
    return made;
}
inline geometry own_and_ghosts(input positions, std::int64_t own)
{
    geometry made = all(positions);
    made.own = own;
    return made;
}
/* Targets of neighbours that were searched before: alive, and not searched again, while in use. */
template <class Neighbors> geometry targets_of(const Neighbors &other, input sources)
{
    geometry made = all(sources);
    made.targets_of = other.get();
    return made;
}
inline geometry targets_apart(input targets, input sources)
{
    geometry made = all(sources);
    made.targets = targets;
    return made;
}

/* CSR lists of your own, borrowed until the next build, or copied by it. For rows and functions see
 * sphg_lists. */
template <class Offsets, class Indices>
sphg_lists lists(const Offsets &offsets, const Indices &indices, bool copy = false)
{
    static_assert(std::is_same_v<detail::element_t<const Offsets>, std::int64_t> &&
                      std::is_same_v<detail::element_t<const Indices>, std::int32_t>,
                  "offsets are int64_t, indices int32_t");
    sphg_lists made = {};
    made.offsets = std::data(offsets);
    made.indices = std::data(indices);
    made.copy = copy;
    return made;
}

/* Which targets: all, a range, a mask with a byte for each, or indices. */
struct subset {
    sphg_subset raw = {};
    bool everyone = true;
    std::int64_t mask_count = -1;
};
inline subset range(std::int32_t begin, std::int32_t end)
{
    return {sphg_range(begin, end), false, -1};
}
template <class Range> subset masked(const Range &mask)
{
    const auto count = static_cast<std::int32_t>(std::size(mask));
    return {sphg_masked(std::data(mask), count), false, count};
}
template <class Range> subset listed(const Range &indices)
{
    return {sphg_listed(std::data(indices), static_cast<std::int32_t>(std::size(indices))), false,
            -1};
}

template <class Errors> class basic_neighbors;

/* One source set, as the targets see it. */
struct sources {
    template <class Errors>
    sources(const basic_neighbors<Errors> &built, input volumes = {}, input densities = {},
            input corrections = {})
        : neighbors(built.get()), volume(volumes), density(densities), correction(corrections)
    {
    }
    const sphg_neighbors *neighbors;
    input volume, density, correction;
    bool same_volumes = false; /* those of the sweep before: kept weights may be read */
};

struct field {
    sphg_shape shape = SPHG_SCALAR;
    sphg_form form = SPHG_DIFFERENCE;
    std::vector<input> at_sources = {}; /* one per source set */
    input at_targets = {};
    output value = {}, gradient = {}, divergence = {}, curl = {}, square = {};
    bool accumulate = false, mirror = false;
    output hessian = {}, laplacian = {};
    output curvature = {};           /* what targets lend ... */
    std::vector<input> lenders = {}; /* ... and sources offer, one per source set; empty: nobody */
    std::vector<input> coefficient = {}; /* of diffusion, one per source set; empty: 1 */
    input coefficient_at_targets = {};
    bool shepard = false;
    std::vector<input> value_volume = {}; /* one per source set; empty: those of the sets */
    input tensor = {};
    output contraction = {};
};

struct request {
    std::vector<sphgrad::sources> sources;
    std::vector<field> fields = {};
    sphgrad::subset subset = {};
    input target_volume = {}, target_density = {}, target_correction = {};
    output correction = {}, rank = {}, lambda_min = {};
    sphg_stats *stats = nullptr;
    output borrows = {};
};

struct inversion {
    output correction = {}, rank = {}, lambda_min = {};
    sphg_stats *stats = nullptr;
};

struct kernel_values {
    double w, dw_over_r;
};
inline kernel_values kernel_value(const sphg_scheme &scheme, double r)
{
    kernel_values made = {};
    sphg_kernel_value(&scheme, r, &made.w, &made.dw_over_r);
    return made;
}
struct kernel_constant_values {
    double sigma, mu2;
};
inline kernel_constant_values kernel_constants(const sphg_scheme &scheme)
{
    kernel_constant_values made = {};
    sphg_kernel_constants(&scheme, &made.sigma, &made.mu2);
    return made;
}
inline int correction_width(const sphg_scheme &scheme)
{
    return sphg_correction_width(&scheme);
}
/* correction: sphg_correction_width() numbers; nullptr for PLAIN. In 2D the third number is 0. */
inline std::array<double, 3> pair_gradient(const sphg_scheme &scheme,
                                           const std::array<double, 3> &x_ij, double volume,
                                           const double *correction = nullptr)
{
    std::array<double, 3> made = {};
    sphg_pair_gradient(&scheme, x_ij.data(), volume, correction, made.data());
    return made;
}
/* Of the library that was linked. */
inline int version()
{
    return sphg_version();
}

} // namespace sphgrad
#endif
