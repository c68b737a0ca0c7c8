/* SPDX-License-Identifier: MIT */
/* The context, and the calls on it. Part of sphgrad.hpp, which includes it. */
#ifndef SPHGRAD_CPP_CONTEXT_HPP
#define SPHGRAD_CPP_CONTEXT_HPP
#include "checks.hpp"
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace sphgrad
{

/* Move-only; calls one at a time. It must outlive its neighbours. */
template <class Errors> class basic_context
{
  public:
    using result = typename Errors::type;

    explicit basic_context(const sphg_config &config = {})
    {
        created_ = sphg_context_create(SPHG_VERSION, &config, &context_);
        if constexpr (std::is_same_v<Errors, throws>)
            Errors::finish(created_, "");
    }
    basic_context(basic_context &&other) noexcept
        : context_(std::exchange(other.context_, nullptr)), created_(other.created_)
    {
    }
    basic_context &operator=(basic_context &&other) noexcept
    {
        if (this != &other) {
            sphg_context_destroy(context_);
            context_ = std::exchange(other.context_, nullptr);
            created_ = other.created_;
        }
        return *this;
    }
    ~basic_context()
    {
        sphg_context_destroy(context_);
    }

    sphg_context *get() const noexcept
    {
        return context_;
    }
    sphg_result created() const noexcept
    {
        return created_;
    } /* of a quiet context */

    result get_info(sphg_context_info &info) const
    {
        return done(sphg_context_get_info(context_, &info));
    }

    result evaluate(const sphg_scheme &scheme, const request &wanted) const
    {
        detail::checker check("evaluate");
        const int d = detail::dimension_of(scheme);
        std::vector<sphg_sources> sets;
        std::vector<sphg_neighbors_info> infos;
        for (const sources &set : wanted.sources) {
            infos.push_back(info_of(set.neighbors));
            sets.push_back(of_set(check, scheme, set, infos.back()));
        }
        const std::int64_t n = infos.empty() ? 0 : infos[0].target_count;
        std::vector<std::vector<sphg_view>> views, loans, coefficients, volumes;
        std::vector<sphg_field> fields;
        for (const field &one : wanted.fields) {
            views.push_back(at_sources(check, one, infos, d));
            loans.push_back(
                of_sets(check, one.lenders, infos, numbers_lent(one.shape, d), "lenders"));
            coefficients.push_back(of_sets(check, one.coefficient, infos, 1, "coefficient"));
            volumes.push_back(of_sets(check, one.value_volume, infos, 1, "value_volume"));
            fields.push_back(of_field(check, one, n, d));
            sphg_field &made = fields.back();
            made.at_sources = views.back().data();
            made.lenders = first_of(loans.back());
            made.coefficient = first_of(coefficients.back());
            made.value_volume = first_of(volumes.back());
        }
        sphg_request made = {};
        made.sources = sets.data();
        made.fields = fields.empty() ? nullptr : fields.data();
        made.set_count = static_cast<std::int32_t>(sets.size());
        made.field_count = static_cast<std::int32_t>(fields.size());
        made.subset = of_subset(check, wanted.subset, n);
        made.target_volume = check.take(wanted.target_volume, n, 1, "target_volume");
        made.target_density = check.take(wanted.target_density, n, 1, "target_density");
        made.target_correction =
            check.take_table(wanted.target_correction, n, scheme, "target_correction");
        made.correction = check.take_table(wanted.correction, n, scheme, "correction");
        made.rank = check.take(wanted.rank, n, 1, "rank");
        made.lambda_min = check.take(wanted.lambda_min, n, 1, "lambda_min");
        made.stats = wanted.stats;
        made.borrows = check.take(wanted.borrows, n, 1, "borrows");
        if (check.failed())
            return refused(check);
        return done(sphg_evaluate(context_, &scheme, &made));
    }

    result correction(const sphg_scheme &scheme, const sources &set, output correction,
                      output rank = {}, const subset &some = {}) const
    {
        detail::checker check("correction");
        const sphg_neighbors_info info = info_of(set.neighbors);
        const sphg_sources made = of_set(check, scheme, set, info);
        const sphg_subset *which = of_subset(check, some, info.target_count);
        const sphg_view table =
            check.take_table(correction, info.target_count, scheme, "correction");
        const sphg_view ranks = check.take(rank, info.target_count, 1, "rank");
        if (check.failed())
            return refused(check);
        return done(sphg_correction(context_, &scheme, &made, which, table, ranks));
    }

    result gradient(const sphg_scheme &scheme, const sources &set, input values, output gradient,
                    const subset &some = {}) const
    {
        return short_way("gradient", sphg_gradient, scheme, set, values, SPHG_SCALAR, gradient,
                         SPHG_VECTOR, some);
    }
    result jacobian(const sphg_scheme &scheme, const sources &set, input values, output jacobian,
                    const subset &some = {}) const
    {
        return short_way("jacobian", sphg_jacobian, scheme, set, values, SPHG_VECTOR, jacobian,
                         SPHG_TENSOR, some);
    }
    result divergence(const sphg_scheme &scheme, const sources &set, input values,
                      output divergence, const subset &some = {}) const
    {
        return short_way("divergence", sphg_divergence, scheme, set, values, SPHG_VECTOR,
                         divergence, SPHG_SCALAR, some);
    }
    result curl(const sphg_scheme &scheme, const sources &set, input values, output curl,
                const subset &some = {}) const
    {
        return short_way("curl", sphg_curl, scheme, set, values, SPHG_VECTOR, curl,
                         detail::dimension_of(scheme) == 2 ? SPHG_SCALAR : SPHG_VECTOR, some);
    }
    result force(const sphg_scheme &scheme, const sources &set, sphg_shape shape, input stress,
                 output force, const subset &some = {}) const
    {
        detail::checker check("force");
        const int d = detail::dimension_of(scheme);
        const sphg_neighbors_info info = info_of(set.neighbors);
        const sphg_sources made = of_set(check, scheme, set, info);
        const sphg_subset *which = of_subset(check, some, info.target_count);
        const sphg_view in = check.take(stress, info.source_count, shape, d, "stress");
        const sphg_view out = check.take(force, info.target_count, SPHG_VECTOR, d, "force");
        if (check.failed())
            return refused(check);
        return done(sphg_force(context_, &scheme, &made, which, shape, in, out));
    }

    /* The counts of offsets, indices and gradient are those of the arrays: capacity is set here.
     * gradient, with a block: an item for each place, whose numbers stand as sphg_pairs says. */
    result pair_gradients(const sphg_scheme &scheme, const sources &set,
                          std::vector<std::int64_t> &offsets, std::vector<std::int32_t> *indices,
                          output gradient, std::int64_t &count, const subset &some = {},
                          input target_correction = {}, bool any_order = false,
                          std::int32_t block = 0,
                          std::vector<std::int32_t> *lengths = nullptr) const
    {
        detail::checker check("pair_gradients");
        const int d = detail::dimension_of(scheme);
        const sphg_neighbors_info info = info_of(set.neighbors);
        const sphg_sources made = of_set(check, scheme, set, info);
        const sphg_subset *which = of_subset(check, some, info.target_count);
        const sphg_view table = check.take(target_correction, info.target_count,
                                           correction_width(scheme), "target_correction");
        offsets.resize(selected(some, info.target_count) + 1);
        sphg_pairs pairs = {};
        pairs.offsets = offsets.data();
        pairs.indices = indices ? indices->data() : nullptr;
        pairs.any_order = any_order;
        pairs.block = block;
        if (lengths) {
            lengths->resize(offsets.size() - 1);
            pairs.lengths = lengths->data();
        }
        pairs.gradient = check.take(gradient, gradient.count(), d, "gradient", true);
        pairs.capacity = indices ? static_cast<std::int64_t>(indices->size()) : gradient.count();
        if (indices && !gradient.absent() && gradient.count() < pairs.capacity)
            pairs.capacity = gradient.count();
        if (check.failed())
            return refused(check);
        const sphg_result found =
            sphg_pair_gradients(context_, &scheme, &made, which, table, &pairs);
        count = pairs.count;
        return done(found);
    }

    result invert_moments(const sphg_scheme &scheme, input moments, input volume,
                          const inversion &wanted) const
    {
        detail::checker check("invert_moments");
        const std::int64_t n = moments.count();
        const int d = detail::dimension_of(scheme);
        sphg_inversion made = {};
        const std::int32_t count = check.count(n, "moments");
        const sphg_view in = check.take(moments, n, SPHG_SYM_TENSOR, d, "moments");
        const sphg_view volumes = check.take(volume, n, 1, "volume");
        made.correction = check.take(wanted.correction, n, SPHG_SYM_TENSOR, d, "correction");
        made.rank = check.take(wanted.rank, n, 1, "rank");
        made.lambda_min = check.take(wanted.lambda_min, n, 1, "lambda_min");
        made.stats = wanted.stats;
        if (check.failed())
            return refused(check);
        return done(sphg_invert_moments(context_, &scheme, count, in, volumes, &made));
    }
    result eigen(int dimension, input matrices, output values, output vectors = {}) const
    {
        detail::checker check("eigen");
        const std::int64_t n = matrices.count();
        const std::int32_t count = check.count(n, "matrices");
        const sphg_view in = check.take(matrices, n, SPHG_SYM_TENSOR, dimension, "matrices");
        const sphg_view made = check.take(values, n, SPHG_VECTOR, dimension, "values");
        const sphg_view columns = check.take(vectors, n, SPHG_TENSOR, dimension, "vectors");
        if (check.failed())
            return refused(check);
        return done(sphg_eigen(context_, dimension, count, in, made, columns));
    }
    result svd(input matrices, output u, output sigma, output v) const
    {
        detail::checker check("svd");
        const std::int64_t n = matrices.count();
        const std::int32_t count = check.count(n, "matrices");
        const sphg_view in = check.take(matrices, n, SPHG_TENSOR, 3, "matrices");
        const sphg_view left = check.take(u, n, SPHG_TENSOR, 3, "u");
        const sphg_view middle = check.take(sigma, n, SPHG_VECTOR, 3, "sigma");
        const sphg_view right = check.take(v, n, SPHG_TENSOR, 3, "v");
        if (check.failed())
            return refused(check);
        return done(sphg_svd(context_, count, in, left, middle, right));
    }

  private:
    result done(sphg_result outcome) const
    {
        return detail::done<Errors>(context_, outcome);
    }
    static result refused(const detail::checker &check)
    {
        return detail::refused<Errors>(check);
    }
    sphg_neighbors_info info_of(const sphg_neighbors *neighbors) const
    {
        sphg_neighbors_info info = {};
        if (neighbors && sphg_neighbors_get_info(context_, neighbors, &info) != SPHG_OK)
            info = {};
        return info;
    }
    sphg_sources of_set(detail::checker &check, const sphg_scheme &scheme, const sources &set,
                        const sphg_neighbors_info &info) const
    {
        sphg_sources made = {};
        made.neighbors = set.neighbors;
        made.volume = check.take(set.volume, info.source_count, 1, "volume");
        made.density = check.take(set.density, info.source_count, 1, "density");
        made.correction = check.take_table(set.correction, info.source_count, scheme,
                                           "correction of the sources");
        made.same_volumes = set.same_volumes;
        return made;
    }
    static const sphg_subset *of_subset(detail::checker &check, const subset &some, std::int64_t n)
    {
        if (some.mask_count >= 0 && some.mask_count != n)
            check.refuse("mask", " has " + std::to_string(some.mask_count) + " items, must have " +
                                     std::to_string(n));
        return some.everyone ? nullptr : &some.raw;
    }
    static std::size_t selected(const subset &some, std::int64_t n)
    {
        if (some.everyone)
            return static_cast<std::size_t>(n);
        std::size_t count = 0;
        for (std::int32_t k = some.raw.begin; k < some.raw.end; ++k)
            count += !some.raw.mask || (k < n && some.raw.mask[k]);
        return count;
    }
    static std::vector<sphg_view> at_sources(detail::checker &check, const field &one,
                                             const std::vector<sphg_neighbors_info> &infos, int d)
    {
        std::vector<sphg_view> made(infos.size(), sphg_absent());
        if (one.at_sources.size() != infos.size())
            check.refuse("at_sources", " has " + std::to_string(one.at_sources.size()) +
                                           " views, one per source set is needed");
        else
            for (std::size_t k = 0; k < infos.size(); ++k)
                made[k] = check.take(one.at_sources[k], infos[k].source_count, one.shape, d,
                                     "at_sources");
        return made;
    }
    static int numbers_lent(sphg_shape shape, int d)
    {
        return 1 + detail::numbers_of(shape, d) * detail::numbers_of(SPHG_SYM_TENSOR, d);
    }
    /* What a field may have of each source set. */
    static std::vector<sphg_view> of_sets(detail::checker &check, const std::vector<input> &given,
                                          const std::vector<sphg_neighbors_info> &infos,
                                          int numbers, const char *name)
    {
        std::vector<sphg_view> made;
        if (!given.empty() && given.size() != infos.size())
            check.refuse(name, " has " + std::to_string(given.size()) +
                                   " views, none or one per source set is needed");
        else
            for (std::size_t k = 0; k < given.size(); ++k)
                made.push_back(check.take(given[k], infos[k].source_count, numbers, name));
        return made;
    }
    static const sphg_view *first_of(const std::vector<sphg_view> &views)
    {
        return views.empty() ? nullptr : views.data();
    }
    static sphg_field of_field(detail::checker &check, const field &one, std::int64_t n, int d)
    {
        const sphg_shape up = one.shape == SPHG_SCALAR ? SPHG_VECTOR : SPHG_TENSOR;
        const sphg_shape down = one.shape == SPHG_VECTOR ? SPHG_SCALAR : SPHG_VECTOR;
        sphg_field made = {};
        made.shape = one.shape;
        made.form = one.form;
        made.accumulate = one.accumulate;
        made.mirror = one.mirror;
        made.at_targets = check.take(one.at_targets, n, one.shape, d, "at_targets");
        made.value = check.take(one.value, n, one.shape, d, "value");
        made.gradient = check.take(one.gradient, n, up, d, "gradient");
        made.divergence = check.take(one.divergence, n, down, d, "divergence");
        made.curl = check.take(one.curl, n, d == 2 ? SPHG_SCALAR : SPHG_VECTOR, d, "curl");
        made.square = check.take(one.square, n, SPHG_SCALAR, d, "square");
        made.hessian = check.take(one.hessian, n,
                                  (one.shape == SPHG_VECTOR ? d : 1) * d * (d + 1) / 2, "hessian");
        made.laplacian = check.take(one.laplacian, n, one.shape, d, "laplacian");
        made.curvature = check.take(one.curvature, n, numbers_lent(one.shape, d), "curvature");
        made.coefficient_at_targets =
            check.take(one.coefficient_at_targets, n, 1, "coefficient_at_targets");
        made.shepard = one.shepard;
        made.tensor = check.take(one.tensor, n, SPHG_TENSOR, d, "tensor");
        made.contraction = check.take(one.contraction, n, 1, "contraction");
        return made;
    }
    using short_function = sphg_result(sphg_context *, const sphg_scheme *, const sphg_sources *,
                                       const sphg_subset *, sphg_view, sphg_view);
    result short_way(const char *name, short_function *function, const sphg_scheme &scheme,
                     const sources &set, const input &values, sphg_shape shape,
                     const output &wanted, sphg_shape wanted_shape, const subset &some) const
    {
        detail::checker check(name);
        const int d = detail::dimension_of(scheme);
        const sphg_neighbors_info info = info_of(set.neighbors);
        const sphg_sources made = of_set(check, scheme, set, info);
        const sphg_subset *which = of_subset(check, some, info.target_count);
        const sphg_view in = check.take(values, info.source_count, shape, d, "field");
        const sphg_view out = check.take(wanted, info.target_count, wanted_shape, d, "result");
        if (check.failed())
            return refused(check);
        return done(function(context_, &scheme, &made, which, in, out));
    }

    sphg_context *context_ = nullptr;
    sphg_result created_ = SPHG_OK;
};

using context = basic_context<throws>;
using quiet_context = basic_context<returns>;

} // namespace sphgrad
#endif
