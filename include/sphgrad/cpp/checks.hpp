/* SPDX-License-Identifier: MIT */
/* Before a call: does every view have the items and numbers that are read or written? Part of
 * sphgrad.hpp, which includes it. */
#ifndef SPHGRAD_CPP_CHECKS_HPP
#define SPHGRAD_CPP_CHECKS_HPP
#include "errors.hpp"
#include "requests.hpp"
#include <cstdint>
#include <limits>
#include <string>

namespace sphgrad
{

namespace detail
{
constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();

inline int numbers_of(sphg_shape shape, int dimension)
{
    switch (shape) {
    case SPHG_SCALAR:
        return 1;
    case SPHG_VECTOR:
        return dimension;
    case SPHG_SYM_TENSOR:
        return dimension * (dimension + 1) / 2;
    case SPHG_TENSOR:
        return dimension * dimension;
    }
    return 0;
}

inline int dimension_of(const sphg_scheme &scheme)
{
    return scheme.dimension == 2 ? 2 : 3;
}

/* One call: remembers the first view that does not fit. */
class checker
{
  public:
    explicit checker(const char *function) : function_(function)
    {
    }
    sphg_view take(const input &view, std::int64_t count, int numbers, const char *name,
                   bool vectors = false, bool tensors = false)
    {
        if (view.absent())
            return sphg_absent();
        if (!view.get().same && view.count() != count)
            refuse(name, " has " + std::to_string(view.count()) + " items, must have " +
                             std::to_string(count));
        else if (view.numbers() != numbers)
            refuse(name, " has " + std::to_string(view.numbers()) + " numbers an item, must have " +
                             std::to_string(numbers));
        else if (!vectors && !view.together())
            refuse(name, ": the numbers of an item must follow one another");
        else if (!tensors && view.get().by_columns)
            refuse(name, ": its matrices stand column by column, which tensors may");
        sphg_view made = view.view(vectors);
        if (view.get().by_columns)
            made.layout = SPHG_COLUMN_MAJOR;
        return made;
    }
    sphg_view take(const input &view, std::int64_t count, sphg_shape shape, int dimension,
                   const char *name)
    {
        if (shape == SPHG_SYM_TENSOR && view.get().side == dimension && dimension > 1) {
            sphg_view made = take(view, count, dimension * dimension, name, false, true);
            made.layout = SPHG_FULL; /* in either order */
            return made;
        }
        return take(view, count, numbers_of(shape, dimension), name, shape == SPHG_VECTOR,
                    shape == SPHG_TENSOR);
    }
    /* Corrections: those of linearised methods are symmetric matrices. */
    sphg_view take_table(const input &view, std::int64_t count, const sphg_scheme &scheme,
                         const char *name)
    {
        if (scheme.method <= SPHG_RKPM && scheme.order != 2)
            return take(view, count, SPHG_SYM_TENSOR, dimension_of(scheme), name);
        return take(view, count, sphg_correction_width(&scheme), name);
    }
    void refuse(const char *name, const std::string &why)
    {
        if (message_.empty())
            message_ = std::string(function_) + ": " + name + why;
    }
    std::int32_t count(std::int64_t wanted, const char *name)
    {
        if (wanted < 0 || wanted > most)
            refuse(name, ": " + std::to_string(wanted) + " items");
        return static_cast<std::int32_t>(wanted);
    }
    bool failed() const
    {
        return !message_.empty();
    }
    const char *message() const
    {
        return message_.c_str();
    }

  private:
    const char *function_;
    std::string message_;
};

template <class Errors> typename Errors::type done(const sphg_context *context, sphg_result outcome)
{
    return Errors::finish(outcome, outcome == SPHG_OK ? "" : sphg_last_message(context));
}
template <class Errors> typename Errors::type refused(const checker &check)
{
    return Errors::finish(SPHG_ERROR_SIZE, check.message());
}

} // namespace detail

} // namespace sphgrad
#endif
