/* SPDX-License-Identifier: MIT */
/* Views of the memory of the host that know their length: arrays, ranges, matrices of Eigen. Part
 * of sphgrad.hpp, which includes it. */
#ifndef SPHGRAD_CPP_VIEWS_HPP
#define SPHGRAD_CPP_VIEWS_HPP
#include <sphgrad/sphgrad.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <type_traits>
#include <utility>

namespace sphgrad
{

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
    static_assert(
        T::IsRowMajor || T::RowsAtCompileTime == 1 || T::ColsAtCompileTime == 1 ||
            T::RowsAtCompileTime == T::ColsAtCompileTime,
        "items are read row by row: take Eigen::RowMajor for matrices that are not square");
    using number = typename T::Scalar;
    static constexpr int numbers = T::RowsAtCompileTime * T::ColsAtCompileTime;
    static constexpr int side =
        T::RowsAtCompileTime == T::ColsAtCompileTime ? T::RowsAtCompileTime : 0;
    static constexpr bool by_columns = side > 1 && !T::IsRowMajor;
};

namespace detail
{
/* d, if an item is a matrix of d x d: it may stand for a tensor or a symmetric one in full. */
template <class Item, class = void> struct matrix_of {
    static constexpr int side = 0;
    static constexpr bool by_columns = false;
};
template <class Item> struct matrix_of<Item, std::void_t<decltype(Item::by_columns)>> {
    static constexpr int side = Item::side;
    static constexpr bool by_columns = Item::by_columns;
};
} // namespace detail

/* Strided numbers and their count: number k of item i stands at `first` + i stride + k step bytes.
 */
struct layout {
    const void *first = nullptr;
    std::ptrdiff_t stride = 0, step = 0;
    std::int64_t count = 0;
    int numbers = 0;
    int side = 0;            /* d: an item is a matrix of d x d ... */
    bool by_columns = false; /* ... column by column */
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
            return {l.apart[0], l.apart[1], l.apart[2], l.stride, l.type, SPHG_AS_SHAPE};
        const void *first = l.same ? static_cast<const void *>(l.own.data()) : l.first;
        sphg_view made = {first, nullptr, nullptr, l.same ? 0 : l.stride, l.type, SPHG_AS_SHAPE};
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
            made.side = detail::matrix_of<item<element>>::side;
            made.by_columns = detail::matrix_of<item<element>>::by_columns;
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

} // namespace sphgrad
#endif
