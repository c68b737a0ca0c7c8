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
#include <sphgrad/sphgrad.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace sphgrad
{

/* ---- Errors ------------------------------------------------------------------------------ */

class error : public std::runtime_error
{
  public:
    error(sphg_result result, const std::string &message)
        : std::runtime_error(message.empty() ? sphg_result_string(result) : message),
          result_(result)
    {
    }
    sphg_result result() const noexcept
    {
        return result_;
    }

  private:
    sphg_result result_;
};

/* The outcome of a call that does not throw; true if it went well. */
struct [[nodiscard]] status {
    sphg_result result = SPHG_OK;
    std::string message;
    explicit operator bool() const noexcept
    {
        return result == SPHG_OK;
    }
};

/* What becomes of a failure. */
struct throws {
    using type = void;
    static void finish(sphg_result result, const char *message)
    {
        if (result != SPHG_OK)
            throw error(result, message);
    }
};
struct returns {
    using type = status;
    static status finish(sphg_result result, const char *message)
    {
        return result == SPHG_OK ? status{} : status{result, message};
    }
};

/* ---- Views ------------------------------------------------------------------------------- */

/* What stands in one element of a range: `numbers` values of the type `number`, one behind the
 * other. Specialise it for a vector type of yours. */
template <class T, class = void> struct item;
template <> struct item<float> {
    using number = float;
    static constexpr int numbers = 1;
};
template <> struct item<double> {
    using number = double;
    static constexpr int numbers = 1;
};
template <> struct item<std::uint8_t> {
    using number = std::uint8_t;
    static constexpr int numbers = 1;
};
template <class T, std::size_t N> struct item<std::array<T, N>> {
    using number = typename item<T>::number;
    static constexpr int numbers = static_cast<int>(N) * item<T>::numbers;
};
template <class T, std::size_t N> struct item<T[N]> {
    using number = typename item<T>::number;
    static constexpr int numbers = static_cast<int>(N) * item<T>::numbers;
};

namespace detail
{
/* Matrices in the manner of Eigen are known by their members: no header of Eigen is needed. */
template <class T, class = void> struct is_matrix : std::false_type {
};
template <class T>
struct is_matrix<T, std::void_t<typename T::Scalar, decltype(T::RowsAtCompileTime),
                                decltype(T::ColsAtCompileTime), decltype(T::IsRowMajor),
                                decltype(std::declval<const T &>().innerStride()),
                                decltype(std::declval<const T &>().outerStride())>>
    : std::true_type {
};
template <class T> constexpr bool is_fixed_matrix()
{
    if constexpr (is_matrix<T>::value)
        return T::RowsAtCompileTime > 0 && T::ColsAtCompileTime > 0;
    return false;
}
template <class T>
using element_t = std::remove_cv_t<std::remove_pointer_t<decltype(std::data(std::declval<T &>()))>>;
template <class T> constexpr sphg_type type_of()
{
    static_assert(std::is_same_v<T, float> || std::is_same_v<T, double> ||
                      std::is_same_v<T, std::uint8_t>,
                  "numbers are float, double or, for ranks and masks, uint8_t");
    return std::is_same_v<T, float> ? SPHG_F32 : std::is_same_v<T, double> ? SPHG_F64 : SPHG_U8;
}
} // namespace detail

/* A matrix of fixed size as an element of a range. */
template <class T> struct item<T, std::enable_if_t<detail::is_fixed_matrix<T>()>> {
    static_assert(T::IsRowMajor || T::RowsAtCompileTime == 1 || T::ColsAtCompileTime == 1,
                  "J[a][b] is stored row by row: take Eigen::RowMajor for matrices that are items");
    using number = typename T::Scalar;
    static constexpr int numbers = T::RowsAtCompileTime * T::ColsAtCompileTime;
};

/* Strided numbers and their count: number k of item i stands at `first` + i stride + k step bytes.
 */
struct layout {
    const void *first = nullptr;
    std::ptrdiff_t stride = 0, step = 0;
    std::int64_t count = 0;
    int numbers = 0;
    sphg_type type = SPHG_F32;
    bool same = false;                      /* one item for all */
    std::array<const void *, 3> apart = {}; /* separate arrays of components */
    std::array<double, 2> own = {};         /* a number that was given by value: of `type` */
};

/* Numbers that are read. An empty one is absent. */
class input
{
  public:
    input() = default;
    explicit input(const layout &made) : layout_(made)
    {
    }
    /* A vector, array or span of numbers, arrays, vectors ...; or a matrix of Eigen: n x d or d x
     * n, whichever extent is not fixed counts the items, and rows do if both may vary. */
    template <class Range,
              class = std::enable_if_t<!std::is_base_of_v<input, std::decay_t<Range>> &&
                                       !std::is_arithmetic_v<std::decay_t<Range>>>>
    input(const Range &range) : layout_(layout_of(range))
    {
    }

    bool absent() const noexcept
    {
        return layout_.numbers == 0;
    } /* not: given, but empty */
    std::int64_t count() const noexcept
    {
        return layout_.count;
    }
    int numbers() const noexcept
    {
        return layout_.numbers;
    }
    sphg_type type() const noexcept
    {
        return layout_.type;
    }
    const layout &get() const noexcept
    {
        return layout_;
    }

    /* The view of C; `this` must live as long as it is used. */
    sphg_view view(bool vectors) const
    {
        const layout &l = layout_;
        if (absent())
            return sphg_absent();
        if (l.apart[0])
            return {l.apart[0], l.apart[1], l.apart[2], l.stride, l.type};
        const void *first = l.same ? static_cast<const void *>(l.own.data()) : l.first;
        sphg_view made = {first, nullptr, nullptr, l.same ? 0 : l.stride, l.type};
        if (first && vectors && l.numbers > 1 && l.step != size()) {
            made.y = static_cast<const char *>(first) + l.step;
            made.z = l.numbers > 2 ? static_cast<const char *>(first) + 2 * l.step : nullptr;
        }
        return made;
    }
    /* Whether the numbers of an item follow one another. */
    bool together() const noexcept
    {
        return absent() || (!layout_.apart[0] && (layout_.numbers == 1 || layout_.step == size()));
    }

    template <class Range> static layout layout_of(const Range &range)
    {
        layout made;
        if constexpr (detail::is_matrix<Range>::value) {
            using number = typename Range::Scalar;
            constexpr auto size_of = static_cast<std::ptrdiff_t>(sizeof(number));
            const bool columns = Range::RowsAtCompileTime > 0 && Range::ColsAtCompileTime < 0;
            const std::ptrdiff_t row =
                size_of * (Range::IsRowMajor ? range.outerStride() : range.innerStride());
            const std::ptrdiff_t column =
                size_of * (Range::IsRowMajor ? range.innerStride() : range.outerStride());
            made.first = range.data();
            made.type = detail::type_of<number>();
            made.count = columns ? range.cols() : range.rows();
            made.numbers = static_cast<int>(columns ? range.rows() : range.cols());
            made.stride = columns ? column : row;
            made.step = columns ? row : column;
        } else {
            using element = detail::element_t<const Range>;
            made.first = std::data(range);
            made.type = detail::type_of<typename item<element>::number>();
            made.count = static_cast<std::int64_t>(std::size(range));
            made.numbers = item<element>::numbers;
            made.stride = static_cast<std::ptrdiff_t>(sizeof(element));
            made.step = static_cast<std::ptrdiff_t>(sizeof(typename item<element>::number));
        }
        return made;
    }

  private:
    std::ptrdiff_t size() const noexcept
    {
        return layout_.type == SPHG_F64 ? 8 : layout_.type == SPHG_F32 ? 4 : 1;
    }
    layout layout_;
};

/* Numbers that are written. */
class output : public input
{
  public:
    output() = default;
    explicit output(const layout &made) : input(made)
    {
    }
    template <class Range, class = std::enable_if_t<!std::is_base_of_v<input, std::decay_t<Range>>>>
    output(Range &&range) : input(layout_of(range))
    {
        static_assert(
            !std::is_const_v<std::remove_pointer_t<decltype(std::declval<Range &>().data())>>,
            "results are written to it");
    }
    template <class T, std::size_t N> output(T (&array)[N]) : input(layout_of(array))
    {
        static_assert(!std::is_const_v<T>, "results are written to it");
    }
};

/* `count` items of `numbers` values, `stride` bytes apart: members of your structs, parts of
 * arrays. */
template <class T>
input strided(const T *first, std::int64_t count, int numbers, std::ptrdiff_t stride)
{
    layout made;
    made.first = first;
    made.count = count;
    made.numbers = numbers;
    made.stride = stride;
    made.step = static_cast<std::ptrdiff_t>(sizeof(T));
    made.type = detail::type_of<T>();
    return input(made);
}
template <class T>
output strided_output(T *first, std::int64_t count, int numbers, std::ptrdiff_t stride)
{
    return output(strided(static_cast<const T *>(first), count, numbers, stride).get());
}

/* One number for all: a uniform volume. */
template <class T> input same(T number)
{
    layout made;
    made.same = true;
    made.numbers = 1;
    made.type = detail::type_of<T>();
    std::memcpy(made.own.data(), &number, sizeof number);
    return input(made);
}

/* Separate arrays of x, y and, in 3D, z. */
template <class Range> input xyz(const Range &x, const Range &y, const Range &z)
{
    layout made = input::layout_of(x);
    const bool alike =
        made.numbers == 1 && std::size(x) == std::size(y) && std::size(x) == std::size(z);
    made.numbers = 3;
    made.apart = {made.first, std::data(y), std::data(z)};
    made.count = alike ? made.count : -1; /* refused everywhere */
    return input(made);
}
template <class Range> input xyz(const Range &x, const Range &y)
{
    layout made = xyz(x, y, y).get();
    made.numbers = 2;
    made.apart[2] = nullptr;
    return input(made);
}
template <class... Range> output xyz_output(Range &...components)
{
    static_assert((!std::is_const_v<std::remove_pointer_t<decltype(components.data())>> && ...),
                  "results are written to it");
    return output(xyz(static_cast<const Range &>(components)...).get());
}

/* ---- Plain data -------------------------------------------------------------------------- */

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

/* ---- Checks ------------------------------------------------------------------------------ */

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

/* One call: remembers the first view that does not fit. */
class checker
{
  public:
    explicit checker(const char *function) : function_(function)
    {
    }
    sphg_view take(const input &view, std::int64_t count, int numbers, const char *name,
                   bool vectors = false)
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
        return view.view(vectors);
    }
    sphg_view take(const input &view, std::int64_t count, sphg_shape shape, int dimension,
                   const char *name)
    {
        return take(view, count, numbers_of(shape, dimension), name, shape == SPHG_VECTOR);
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

inline int dimension_of(const sphg_scheme &scheme)
{
    return scheme.dimension == 2 ? 2 : 3;
}
} // namespace detail

/* ---- Context ----------------------------------------------------------------------------- */

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
        const int width = correction_width(scheme);
        made.target_volume = check.take(wanted.target_volume, n, 1, "target_volume");
        made.target_density = check.take(wanted.target_density, n, 1, "target_density");
        made.target_correction =
            check.take(wanted.target_correction, n, width, "target_correction");
        made.correction = check.take(wanted.correction, n, width, "correction");
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
            check.take(correction, info.target_count, correction_width(scheme), "correction");
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

    /* The counts of offsets, indices and gradient are those of the arrays: capacity is set here. */
    result pair_gradients(const sphg_scheme &scheme, const sources &set,
                          std::vector<std::int64_t> &offsets, std::vector<std::int32_t> *indices,
                          output gradient, std::int64_t &count, const subset &some = {},
                          input target_correction = {}, bool any_order = false) const
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
        const int width = detail::numbers_of(SPHG_SYM_TENSOR, detail::dimension_of(scheme));
        sphg_inversion made = {};
        const std::int32_t count = check.count(n, "moments");
        const sphg_view in = check.take(moments, n, width, "moments");
        const sphg_view volumes = check.take(volume, n, 1, "volume");
        made.correction = check.take(wanted.correction, n, width, "correction");
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
        made.correction = check.take(set.correction, info.source_count, correction_width(scheme),
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

/* ---- Neighbours -------------------------------------------------------------------------- */

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
