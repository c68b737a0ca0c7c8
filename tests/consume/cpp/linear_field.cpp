/* SPDX-License-Identifier: MIT */
// A host in C++: the Jacobian of a linear field must come out, at corners too.
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <sphgrad/sphgrad.h>
#include <vector>

namespace
{
using vec3 = std::array<double, 3>;
using mat3 = std::array<double, 9>;

struct destroy {
    void operator()(sphg_context *context) const
    {
        sphg_context_destroy(context);
    }
    void operator()(sphg_neighbors *neighbors) const
    {
        sphg_neighbors_destroy(neighbors);
    }
};

const mat3 slope = {{0, -1, 0.5, 1, 0, 0, 0.25, 0, 2}};

std::vector<vec3> block(int side)
{
    std::vector<vec3> positions;
    for (int i = 0; i < side * side * side; ++i)
        positions.push_back({{i % side + 0.01 * (i * 3 % 17), i / side % side + 0.01 * (i * 4 % 17),
                              i / side / side + 0.01 * (i * 5 % 17)}});
    return positions;
}

std::vector<vec3> linear(const std::vector<vec3> &positions)
{
    std::vector<vec3> field(positions.size());
    for (std::size_t i = 0; i < field.size(); ++i)
        for (std::size_t k = 0; k < 9; ++k)
            field[i][k / 3] += slope[k] * positions[i][k % 3];
    return field;
}

sphg_result jacobian(const std::vector<vec3> &positions, const std::vector<vec3> &field,
                     std::vector<mat3> &result)
{
    sphg_context *context = nullptr;
    if (sphg_result refused = sphg_context_create(SPHG_VERSION, nullptr, &context))
        return refused;
    const std::unique_ptr<sphg_context, destroy> context_owner(context);
    sphg_neighbors *neighbors = nullptr;
    if (sphg_result refused = sphg_neighbors_create(context, &neighbors))
        return refused;
    const std::unique_ptr<sphg_neighbors, destroy> neighbors_owner(neighbors);

    sphg_scheme scheme{};
    scheme.method = SPHG_MLS;
    scheme.support_radius = 2;
    sphg_geometry geometry{};
    geometry.sources = sphg_view_f64(positions[0].data(), sizeof(vec3));
    geometry.source_count = geometry.target_count = static_cast<int32_t>(positions.size());
    if (sphg_result refused = sphg_neighbors_search(context, neighbors, &scheme, &geometry))
        return refused;

    const double volume = 1;
    sphg_sources sources{};
    sources.neighbors = neighbors;
    sources.volume = sphg_view_f64(&volume, 0);
    return sphg_jacobian(context, &scheme, &sources, nullptr,
                         sphg_view_f64(field[0].data(), sizeof(vec3)),
                         sphg_view_f64(result[0].data(), sizeof(mat3)));
}
} // namespace

int main()
{
    const std::vector<vec3> positions = block(5);
    mat3 unset;
    unset.fill(std::numeric_limits<double>::quiet_NaN());
    std::vector<mat3> jacobians(positions.size(), unset);
    const sphg_result result = jacobian(positions, linear(positions), jacobians);

    bool exact = true;
    for (const mat3 &item : jacobians)
        for (std::size_t k = 0; k < 9; ++k)
            exact = exact && std::fabs(item[k] - slope[k]) < 1e-12;
    std::printf("%s, %s\n", sphg_result_string(result), exact ? "exact" : "not exact");
    return result == SPHG_OK && exact ? 0 : 1;
}
