/* SPDX-License-Identifier: MIT */
/* An elastic bar in C++17. Its neighbours and corrections are those of the rest configuration,
 * built once; each step takes the deformation gradient over them, a stress, and forces. Prints the
 * error of the deformation gradient of a stretched and twisted bar, the sum of all forces, and how
 * far the work of the forces is from that of the stress. */
#include <sphgrad/sphgrad.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

using vector = std::array<double, 3>;
using tensor = std::array<vector, 3>; /* F[a][b] = d x_a / d X_b */

int main()
try {
    const double volume = 1, stiffness = 5;
    std::vector<vector> rest, now;
    for (int i = 0; i < 5 * 5 * 12; ++i) { /* a lattice with spacing 1 */
        const vector place = {i % 5 * 1.0, i / 5 % 5 * 1.0, i / 25 * 1.0};
        rest.push_back(place);
        now.push_back({place[0] + 0.1 * place[2], place[1] - 0.2 * place[0], 1.3 * place[2]});
    }
    const sphgrad::context context;
    const sphg_scheme scheme = sphgrad::scheme(2.0);
    sphgrad::neighbors neighbors(context);
    std::vector<std::array<double, 6>> table(rest.size());
    neighbors.search(scheme, sphgrad::all(rest));
    context.correction(scheme, {neighbors, sphgrad::same(volume)}, table);
    const sphgrad::sources bar(neighbors, sphgrad::same(volume), {}, table);

    /* What follows is done in each step. */
    std::vector<tensor> deformation(rest.size()), stress(rest.size());
    std::vector<vector> force(rest.size());
    context.jacobian(scheme, bar, now, deformation);
    for (std::size_t i = 0; i < rest.size(); ++i)
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b) /* linear in F - 1, so that the work is a square */
                stress[i][a][b] = stiffness * (deformation[i][a][b] - (a == b ? 1 : 0));
    context.force(scheme, bar, SPHG_TENSOR, stress, force);

    const tensor exact = {{{1, 0, 0.1}, {-0.2, 1, 0}, {0, 0, 1.3}}};
    double error = 0, largest = 0, inner = 0, outer = 0;
    vector sum = {};
    for (std::size_t i = 0; i < rest.size(); ++i)
        for (std::size_t a = 0; a < 3; ++a) {
            sum[a] += force[i][a];
            largest = std::fmax(largest, std::fabs(force[i][a]));
            outer += force[i][a] * (now[i][a] - rest[i][a]);
            for (std::size_t b = 0; b < 3; ++b) {
                error += std::fabs(deformation[i][a][b] - exact[a][b]) /
                         static_cast<double>(rest.size());
                inner -= volume * stress[i][a][b] * (deformation[i][a][b] - (a == b ? 1 : 0));
            }
        }
    const double momentum = std::hypot(sum[0], sum[1], sum[2]) / largest;
    std::printf("error of F %.1e, sum of forces %.1e of the largest, works differ by %.1e\n", error,
                momentum, outer / inner - 1);
    return !(error < 1e-12 && momentum < 1e-10 && std::fabs(outer / inner - 1) < 1e-10);
} catch (const sphgrad::error &error) {
    std::printf("%s\n", error.what());
    return 1;
}
