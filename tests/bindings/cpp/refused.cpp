/* SPDX-License-Identifier: MIT */
/* What must not compile: one mistake each, chosen by MISTAKE; 0 is none. */
#include <sphgrad/sphgrad.hpp>

struct column_major { /* a matrix of fixed size in the manner of Eigen */
    using Scalar = double;
    enum { RowsAtCompileTime = 3, ColsAtCompileTime = MISTAKE == 1 ? 2 : 3, IsRowMajor = 0 };
    int innerStride() const { return 1; }
    int outerStride() const { return 3; }
    double numbers[9];
};

int main()
{
    const sphgrad::context context;
    sphgrad::neighbors neighbors(context);
    const sphg_scheme scheme = sphgrad::scheme(1.0);
    const sphgrad::sources set(neighbors, sphgrad::same(1.0));
    std::vector<std::array<double, 3>> v;
    std::vector<column_major> j;
    const std::vector<std::array<double, 9>> fixed;
    std::vector<int> whole;
    context.jacobian(scheme, set, v, j);
#if MISTAKE == 2
    context.jacobian(scheme, set, v, fixed);
#elif MISTAKE == 3
    context.gradient(scheme, set, whole, v);
#elif MISTAKE == 4
    const sphgrad::context copy = context;
#elif MISTAKE == 5
    const sphgrad::quiet_context quiet;
    sphgrad::quiet_neighbors(quiet).search(scheme, sphgrad::all(v)); /* with -Werror */
#endif
    return 0;
}
