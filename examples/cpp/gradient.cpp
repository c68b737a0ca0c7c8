/* SPDX-License-Identifier: MIT */
/* A rotating block of particles in C++17: dvx/dy at its corner is -1. Plain SPH finds -0.36. */
#include <sphgrad/sphgrad.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

int main()
try {
    using vector = std::array<double, 3>;
    std::vector<vector> x, v;
    for (int i = 0; i < 1000; ++i) { /* 10 x 10 x 10, spacing 1, v = (-y, x, 0) */
        x.push_back({i % 10 * 1.0, i / 10 % 10 * 1.0, i / 100 * 1.0});
        v.push_back({-x.back()[1], x.back()[0], 0});
    }
    std::vector<std::array<vector, 3>> jacobian(x.size()); /* J[a][b] = d v_a / d x_b */

    const sphgrad::context context;
    sphgrad::neighbors neighbors(context);
    const sphg_scheme scheme = sphgrad::scheme(2.0); /* 3D, KGC, cubic spline */
    neighbors.search(scheme, sphgrad::all(x));
    context.jacobian(scheme, {neighbors, sphgrad::same(1.0)}, v, jacobian);
    std::printf("dvx/dy = %.7f\n", jacobian[0][0][1]);
    return std::fabs(jacobian[0][0][1] + 1) < 1e-9 ? 0 : 1;
} catch (const sphgrad::error &error) {
    std::printf("%s\n", error.what());
    return 1;
}
