/* SPDX-License-Identifier: MIT */
/* Neighbours: searched, or lists of the host. Part of sphgrad.hpp, which includes it. */
#ifndef SPHGRAD_CPP_NEIGHBORS_HPP
#define SPHGRAD_CPP_NEIGHBORS_HPP
#include "context.hpp"
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace sphgrad
{

/* Move-only. The context must outlive it. */
template <class Errors> class basic_neighbors
{
  public:
    using result = typename Errors::type;

    explicit basic_neighbors(const basic_context<Errors> &owner) : context_(owner.get())
    {
        created_ = sphg_neighbors_create(context_, &neighbors_);
        if constexpr (std::is_same_v<Errors, throws>)
            done(created_);
    }
    basic_neighbors(basic_neighbors &&other) noexcept
        : context_(other.context_), neighbors_(std::exchange(other.neighbors_, nullptr)),
          created_(other.created_)
    {
    }
    basic_neighbors &operator=(basic_neighbors &&other) noexcept
    {
        if (this != &other) {
            sphg_neighbors_destroy(neighbors_);
            context_ = other.context_;
            neighbors_ = std::exchange(other.neighbors_, nullptr);
            created_ = other.created_;
        }
        return *this;
    }
    ~basic_neighbors()
    {
        sphg_neighbors_destroy(neighbors_);
    }

    sphg_neighbors *get() const noexcept
    {
        return neighbors_;
    }
    sphg_result created() const noexcept
    {
        return created_;
    } /* with a quiet context */

    result search(const sphg_scheme &scheme, const geometry &where)
    {
        detail::checker check("search");
        const sphg_geometry made = of_geometry(check, scheme, where);
        if (check.failed())
            return detail::refused<Errors>(check);
        return done(sphg_neighbors_search(context_, neighbors_, &scheme, &made));
    }
    /* Would that search find pairs anew, or does the skin hold? */
    result would_rebuild(const sphg_scheme &scheme, const geometry &where, bool &rebuild) const
    {
        detail::checker check("would_rebuild");
        const sphg_geometry made = of_geometry(check, scheme, where);
        if (check.failed())
            return detail::refused<Errors>(check);
        std::int32_t answer = 0;
        const sphg_result known =
            sphg_neighbors_would_rebuild(context_, neighbors_, &scheme, &made, &answer);
        if (known == SPHG_OK)
            rebuild = answer != 0;
        return done(known);
    }
    result use_lists(const sphg_scheme &scheme, const geometry &where, const sphg_lists &lists)
    {
        detail::checker check("use_lists");
        const sphg_geometry made = of_geometry(check, scheme, where);
        if (check.failed())
            return detail::refused<Errors>(check);
        return done(sphg_neighbors_use_lists(context_, neighbors_, &scheme, &made, &lists));
    }
    result get_info(sphg_neighbors_info &info) const
    {
        return done(sphg_neighbors_get_info(context_, neighbors_, &info));
    }
    result check(const sphg_scheme &scheme, sphg_list_fault &fault) const
    {
        return done(sphg_neighbors_check(context_, &scheme, neighbors_, &fault));
    }
    /* order takes the number of the sources. */
    result get_order(std::vector<std::int32_t> &order) const
    {
        sphg_neighbors_info info = {};
        const sphg_result known = sphg_neighbors_get_info(context_, neighbors_, &info);
        if (known != SPHG_OK)
            return done(known);
        order.resize(static_cast<std::size_t>(info.source_count));
        /* An empty vector has no address, which C would take for a mistake. */
        std::int32_t none = 0;
        return done(
            sphg_neighbors_get_order(context_, neighbors_, order.empty() ? &none : order.data()));
    }

  private:
    result done(sphg_result outcome) const
    {
        return detail::done<Errors>(context_, outcome);
    }
    static sphg_geometry of_geometry(detail::checker &check, const sphg_scheme &scheme,
                                     const geometry &where)
    {
        const int d = detail::dimension_of(scheme);
        const bool apart = where.targets.numbers() > 0;
        const std::int64_t count = where.sources.count(), targets = where.targets.count();
        sphg_geometry made = where.options;
        made.sources = check.take(where.sources, count, SPHG_VECTOR, d, "positions");
        made.targets = check.take(where.targets, targets, SPHG_VECTOR, d, "targets");
        made.source_support =
            check.take(where.source_support, count, SPHG_SCALAR, d, "source_support");
        made.target_support =
            check.take(where.target_support, targets, SPHG_SCALAR, d, "target_support");
        made.source_count = check.count(count, "positions");
        made.targets_of = where.targets_of;
        if (!where.targets_of)
            made.target_count = check.count(apart           ? targets
                                            : where.own < 0 ? count
                                                            : where.own,
                                            "targets");
        return made;
    }

    sphg_context *context_;
    sphg_neighbors *neighbors_ = nullptr;
    sphg_result created_ = SPHG_OK;
};
template <class Errors> basic_neighbors(const basic_context<Errors> &) -> basic_neighbors<Errors>;

using neighbors = basic_neighbors<throws>;
using quiet_neighbors = basic_neighbors<returns>;

} // namespace sphgrad
#endif
