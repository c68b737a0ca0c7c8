/* SPDX-License-Identifier: MIT */
/* The C++ header: handles, views of standard containers, checks of every length, all operators. */
#include "check.hpp"

using vec = std::array<double, 3>;
using mat = std::array<vec, 3>;
struct mine {
    float x, y, z;
};
template <> struct sphgrad::item<mine> {
    using number = float;
    static constexpr int numbers = 3;
};

static_assert(std::is_nothrow_move_constructible_v<sphgrad::context>);
static_assert(!std::is_copy_constructible_v<sphgrad::context>);
static_assert(std::is_nothrow_move_assignable_v<sphgrad::neighbors>);
static_assert(!std::is_copy_assignable_v<sphgrad::neighbors>);

static const sphg_scheme scheme = sphgrad::scheme(2.2);

static std::vector<vec> cloud()
{
    std::vector<vec> x;
    for (int i = 0; i < 216; ++i)
        x.push_back({i % 6 + 0.1 * std::sin(i), i / 6 % 6 + 0.1 * std::cos(2 * i),
                     i / 36 + 0.1 * std::sin(3 * i)});
    return x;
}
static std::vector<vec> rotation(const std::vector<vec> &x)
{
    std::vector<vec> v;
    for (const vec &one : x)
        v.push_back({-one[1], one[0], 0});
    return v;
}
static bool near(double a, double b)
{
    return std::fabs(a - b) < 1e-11;
}

static void containers_of_all_kinds()
{
    const auto x = cloud();
    const auto v = rotation(x);
    const std::size_t n = x.size();
    const sphgrad::context context;
    sphgrad::neighbors neighbors(context);
    neighbors.search(scheme, sphgrad::all(x));
    const sphgrad::sources set(neighbors, sphgrad::same(1.0));
    std::vector<mat> j(n);
    context.jacobian(scheme, set, v, j);
    for (const mat &one : j)
        CHECK(near(one[0][1], -1) && near(one[1][0], 1) && near(one[0][0], 0) &&
              near(one[2][2], 0));

    double plain[216][3][3], volumes[216];
    std::vector<double> vx, vy, vz, jx(3 * n), jy(3 * n), jz(3 * n);
    for (std::size_t i = 0; i < n; ++i) {
        volumes[i] = 1;
        vx.push_back(v[i][0]), vy.push_back(v[i][1]), vz.push_back(v[i][2]);
    }
    context.jacobian(scheme, {neighbors, volumes}, sphgrad::xyz(vx, vy, vz), plain);
    CHECK(std::memcmp(plain, j.data(), sizeof plain) == 0);
    std::vector<double> flat(12 * n);
    context.jacobian(scheme, set, v, sphgrad::strided_output(flat.data() + 1, 216, 9, 96));
    for (std::size_t i = 0; i < n; ++i)
        CHECK(std::memcmp(&flat[12 * i + 1], &j[i], sizeof(mat)) == 0 && flat[12 * i] == 0);

    std::vector<double> divergence(n), gx(n), gy(n), gz(n);
    std::vector<vec> curl(n), gradient(n);
    context.divergence(scheme, set, v, divergence);
    context.curl(scheme, set, v, curl);
    context.gradient(scheme, set, vx, gradient);
    context.gradient(scheme, set, vx, sphgrad::xyz_output(gx, gy, gz));
    for (std::size_t i = 0; i < n; ++i) {
        CHECK(near(divergence[i], 0) && near(curl[i][2], 2) && near(gradient[i][1], -1));
        CHECK(gx[i] == gradient[i][0] && gy[i] == gradient[i][1] && gz[i] == gradient[i][2]);
    }

    std::vector<mine> small;
    for (const vec &one : x)
        small.push_back(
            {static_cast<float>(one[0]), static_cast<float>(one[1]), static_cast<float>(one[2])});
    sphgrad::neighbors single(context);
    single.search(scheme, sphgrad::all(small));
    std::vector<std::array<float, 9>> unit(n);
    context.jacobian(scheme, {single, sphgrad::same(1.0f)}, small, unit);
    CHECK(std::fabs(unit[7][0] - 1) < 1e-4f && std::fabs(unit[7][1]) < 1e-4f);
}

static void all_operators()
{
    const auto x = cloud();
    const std::size_t n = x.size();
    const sphgrad::context context;
    sphgrad::neighbors neighbors(context);
    neighbors.search(scheme, sphgrad::all(x));
    std::vector<std::array<double, 6>> table(n), moments;
    std::vector<std::uint8_t> rank(n), mask(n);
    CHECK(sphgrad::correction_width(scheme) == 6 && sphgrad::version() == SPHG_VERSION);
    context.correction(scheme, {neighbors, sphgrad::same(1.0)}, table, rank);
    CHECK(rank[0] == 3 && rank[215] == 3);

    std::vector<double> pressure(n);
    for (std::size_t i = 0; i < n; ++i)
        pressure[i] = x[i][0] * x[i][1], mask[i] = i % 2 == 0;
    std::vector<vec> force(n), other(n, vec{7, 7, 7});
    const sphgrad::sources set(neighbors, sphgrad::same(1.0), {}, table);
    context.force(scheme, set, SPHG_SCALAR, pressure, force);
    vec sum = {};
    for (const vec &one : force)
        for (std::size_t k = 0; k < 3; ++k)
            sum[k] += one[k];
    CHECK(near(sum[0] / 1e3, 0) && near(sum[1] / 1e3, 0) && std::fabs(force[215][0]) > 1);
    context.force(scheme, set, SPHG_SCALAR, pressure, other, sphgrad::masked(mask));
    CHECK(other[0] == force[0] && other[1] == (vec{7, 7, 7}));
    const std::vector<std::int32_t> some = {3, 5};
    context.force(scheme, set, SPHG_SCALAR, pressure, other, sphgrad::listed(some));
    context.force(scheme, set, SPHG_SCALAR, pressure, other, sphgrad::range(9, 10));
    CHECK(other[3] == force[3] && other[5] == force[5] && other[9] == force[9] && other[7][0] == 7);

    sphg_stats stats = {};
    std::vector<double> lambda(n), value(n), square(n);
    std::vector<vec> gradient(n);
    sphgrad::field field;
    field.form = SPHG_DIRECT;
    field.at_sources = {pressure};
    field.value = value, field.gradient = gradient, field.square = square;
    sphgrad::request request{{sphgrad::sources(neighbors, sphgrad::same(1.0))}, {field}};
    request.rank = rank, request.lambda_min = lambda, request.stats = &stats;
    context.evaluate(scheme, request);
    CHECK(stats.rank[3] == 216 && lambda[0] > 0 && value[100] > 0 && square[100] > 0);
    sphgrad::field heat;
    std::vector<double> flow(n), conductivity(n, 2.0);
    heat.form = SPHG_ADJOINT, heat.at_sources = {pressure}, heat.laplacian = flow;
    heat.coefficient = {conductivity}, heat.coefficient_at_targets = conductivity;
    sphgrad::request of_heat{{set}, {heat}};
    context.evaluate(scheme, of_heat);
    double lost = 0, most = 0;
    for (double one : flow)
        lost += one, most += std::fabs(one);
    CHECK(most > 1 && std::fabs(lost) < 1e-10 * most);
    of_heat.fields[0].coefficient.push_back(conductivity);
    check_throws(SPHG_ERROR_SIZE, "coefficient", [&] { context.evaluate(scheme, of_heat); });
    sphgrad::field mean;
    std::vector<std::array<double, 9>> turn(n, {1, 0, 0, 0, 1, 0, 0, 0, 1});
    std::vector<double> trace(n), divergence(n);
    std::vector<vec> means(n);
    mean.shape = SPHG_VECTOR, mean.form = SPHG_DIRECT, mean.at_sources = {x};
    mean.value = means, mean.shepard = true, mean.value_volume = {conductivity};
    mean.tensor = turn, mean.contraction = trace, mean.divergence = divergence;
    context.evaluate(scheme, {{set}, {mean}});
    CHECK(near(trace[100], divergence[100]) && std::fabs(means[100][0] - x[100][0]) < 1);
    sphgrad::field curved;
    std::vector<std::array<double, 6>> hessian(n);
    std::vector<double> laplacian(n);
    curved.at_sources = {pressure};
    curved.hessian = hessian, curved.laplacian = laplacian;
    sphg_scheme second = scheme;
    second.order = 2;
    sphgrad::request of_second{{sphgrad::sources(neighbors, sphgrad::same(1.0))}, {curved}};
    of_second.stats = &stats;
    context.evaluate(second, of_second);
    CHECK(stats.quadratic > 0 && std::isfinite(laplacian[100]) &&
          near(hessian[100][0] + hessian[100][3] + hessian[100][5], laplacian[100]));
    std::vector<std::array<double, 7>> lent(n);
    std::vector<std::uint8_t> borrows(n);
    of_second.fields[0].curvature = lent, of_second.borrows = borrows;
    context.evaluate(second, of_second);
    sphgrad::request third{{sphgrad::sources(neighbors, sphgrad::same(1.0))}, {curved}};
    std::vector<double> borrowed = laplacian;
    third.fields[0].hessian = {}, third.fields[0].laplacian = borrowed;
    third.fields[0].lenders = {lent}, third.subset = sphgrad::masked(borrows);
    context.evaluate(second, third);
    CHECK(borrows[0] == 1 && borrowed[0] != laplacian[0]);
    for (std::size_t i = 0; i < n; ++i)
        CHECK(lent[i][0] >= 0 && lent[i][0] <= 1 && (borrows[i] || borrowed[i] == laplacian[i]));
    third.fields[0].lenders.push_back(lent);
    check_throws(SPHG_ERROR_SIZE, "lenders", [&] { context.evaluate(second, third); });

    std::vector<std::int64_t> offsets;
    std::vector<std::int32_t> indices;
    std::vector<vec> g;
    std::int64_t count = 0;
    context.pair_gradients(scheme, set, offsets, nullptr, {}, count);
    CHECK(count == offsets.back() && count > 2000);
    indices.resize(static_cast<std::size_t>(count));
    g.resize(static_cast<std::size_t>(count));
    context.pair_gradients(scheme, set, offsets, &indices, g, count);
    const std::size_t j = static_cast<std::size_t>(indices[0]);
    const auto one = sphgrad::pair_gradient(
        scheme, {x[0][0] - x[j][0], x[0][1] - x[j][1], x[0][2] - x[j][2]}, 1, table[0].data());
    CHECK(near(one[0], g[0][0]) && near(one[1], g[0][1]) && near(one[2], g[0][2]));
    const vec first = g[0];
    std::vector<std::int32_t> lengths;
    context.pair_gradients(scheme, set, offsets, nullptr, {}, count, {}, {}, false, 8);
    indices.resize(static_cast<std::size_t>(count));
    g.resize(static_cast<std::size_t>(count));
    context.pair_gradients(scheme, set, offsets, &indices, g, count, {}, {}, false, 8, &lengths);
    CHECK(offsets[1] % 8 == 0 && lengths.size() == n && lengths[0] <= offsets[1]);
    const double *numbers = g[0].data();
    CHECK(near(numbers[0], first[0]) && near(numbers[8], first[1]) && near(numbers[16], first[2]));
    context.pair_gradients(scheme, set, offsets, nullptr, {}, count);
    indices.resize(static_cast<std::size_t>(count));
    context.pair_gradients(scheme, set, offsets, &indices, {}, count);
    g.resize(10);
    check_throws(SPHG_ERROR_CAPACITY, "capacity",
                 [&] { context.pair_gradients(scheme, set, offsets, &indices, g, count); });
    context.pair_gradients(scheme, set, offsets, nullptr, {}, count, sphgrad::masked(mask));
    CHECK(offsets.size() == 109 && offsets.back() == count);

    sphgrad::neighbors listed(context);
    context.pair_gradients(scheme, set, offsets, &indices, {}, count);
    listed.use_lists(scheme, sphgrad::all(x), sphgrad::lists(offsets, indices));
    sphg_list_fault fault = {};
    listed.check(scheme, fault);
    std::vector<std::int32_t> order;
    neighbors.get_order(order);
    CHECK(order.size() == n && fault.faulty == 0);
    indices[0] = indices[1];
    check_throws(SPHG_ERROR_LISTS, "", [&] { listed.check(scheme, fault); });

    const auto w = sphgrad::kernel_value(scheme, 0.5);
    CHECK(w.w > 0 && w.dw_over_r < 0 && sphgrad::kernel_constants(scheme).sigma > 2);
    sphg_context_info info = {};
    context.get_info(info);
    CHECK(info.threads >= 1);
}

static void geometries()
{
    const auto x = cloud();
    const auto v = rotation(x);
    const sphgrad::context context;
    sphgrad::neighbors neighbors(context);
    sphgrad::geometry ghosts = sphgrad::own_and_ghosts(x, 100);
    ghosts.options.skin = 0.2;
    neighbors.search(scheme, ghosts);
    sphg_neighbors_info info = {};
    neighbors.get_info(info);
    CHECK(info.target_count == 100 && info.source_count == 216 && info.skin_left > 0);
    bool rebuild = true;
    neighbors.would_rebuild(scheme, ghosts, rebuild);
    CHECK(!rebuild);
    neighbors.would_rebuild(scheme, sphgrad::all(x), rebuild);
    CHECK(rebuild);
    std::vector<mat> j(100), all(216);
    const sphgrad::sources set(neighbors, sphgrad::same(1.0));
    context.jacobian(scheme, set, v, j);
    check_throws(SPHG_ERROR_SIZE, "100", [&] { context.jacobian(scheme, set, v, all); });

    const std::vector<vec> places = {{2.5, 2.5, 2.5}};
    sphgrad::neighbors apart(context);
    apart.search(scheme, sphgrad::targets_apart(places, x));
    sphgrad::field field;
    field.shape = SPHG_VECTOR;
    field.at_sources = {v};
    const auto here = rotation(places);
    field.at_targets = here;
    std::vector<mat> there(1);
    field.gradient = there;
    context.evaluate(scheme, {{sphgrad::sources(apart, sphgrad::same(1.0))}, {field}});
    CHECK(near(there[0][0][1], -1));
    sphgrad::neighbors same_targets(context);
    same_targets.search(scheme, sphgrad::targets_of(apart, x));
    there[0] = mat{};
    context.evaluate(scheme, {{sphgrad::sources(same_targets, sphgrad::same(1.0))}, {field}});
    CHECK(near(there[0][0][1], -1));

    const sphg_scheme flat = sphgrad::scheme(2.2, SPHG_MLS, 2);
    std::vector<std::array<double, 2>> plane;
    for (int i = 0; i < 36; ++i)
        plane.push_back({i % 6 * 1.0, i / 6 * 1.0});
    sphgrad::neighbors in_plane(context);
    in_plane.search(flat, sphgrad::all(plane));
    std::vector<double> curl(36);
    context.curl(flat, {in_plane, sphgrad::same(1.0)}, plane, curl);
    CHECK(near(curl[0], 0));
    check_throws(SPHG_ERROR_SIZE, "numbers", [&] { in_plane.search(flat, sphgrad::all(x)); });

    const std::vector<vec> none;
    sphgrad::neighbors empty(context);
    empty.search(scheme, sphgrad::all(none));
    std::vector<mat> nothing;
    context.jacobian(scheme, {empty, sphgrad::same(1.0)}, none, nothing);
    std::vector<std::int32_t> order;
    empty.get_order(order);
    CHECK(order.empty());
}

static void lengths_are_checked()
{
    const auto x = cloud();
    const auto v = rotation(x);
    const sphgrad::context context;
    sphgrad::neighbors neighbors(context);
    neighbors.search(scheme, sphgrad::all(x));
    const sphgrad::sources set(neighbors, sphgrad::same(1.0));
    const std::vector<double> few(5, 1.0), nothing;
    const std::vector<vec> short_v(v.begin(), v.end() - 1);
    std::vector<mat> j(x.size()), short_j(x.size() - 1, mat{{{7, 7, 7}}});
    std::vector<vec> thin(x.size());
    std::vector<std::uint8_t> ranks(3);
    const auto refused = [](auto &&call) { check_throws(SPHG_ERROR_SIZE, "must have", call); };
    refused([&] { context.jacobian(scheme, set, short_v, j); });
    refused([&] { context.jacobian(scheme, set, v, short_j); });
    CHECK(short_j[0][0][0] == 7);
    refused([&] { context.jacobian(scheme, set, v, thin); });
    refused([&] { context.jacobian(scheme, {neighbors, few}, v, j); });
    refused([&] { context.jacobian(scheme, {neighbors, nothing}, v, j); });
    refused([&] { context.gradient(scheme, set, v, thin); });
    refused([&] { context.correction(scheme, set, j); });
    std::vector<std::array<double, 6>> table(x.size());
    refused([&] { context.correction(scheme, set, table, ranks); });
    refused([&] { context.jacobian(scheme, set, v, j, sphgrad::masked(ranks)); });
    sphgrad::request request{{set}};
    request.rank = ranks;
    refused([&] { context.evaluate(scheme, request); });
    request.rank = {};
    sphgrad::field field;
    field.shape = SPHG_VECTOR, field.gradient = j;
    request.fields = {field};
    check_throws(SPHG_ERROR_SIZE, "per source set", [&] { context.evaluate(scheme, request); });
    request.fields[0].at_sources = {v};
    request.fields[0].square = few.empty() ? sphgrad::output() : sphgrad::output(thin);
    refused([&] { context.evaluate(scheme, request); });
    refused([&] { context.eigen(3, few, thin); });
    std::vector<mat> u(2), a(3);
    std::vector<vec> sigma(3);
    refused([&] { context.svd(a, u, sigma, a); });
    check_throws(SPHG_ERROR_SIZE, "positions",
                 [&] { neighbors.search(scheme, sphgrad::all(sphgrad::xyz(few, few, nothing))); });
    std::vector<std::array<float, 9>> single(x.size());
    check_throws(SPHG_ERROR_TYPE, "type", [&] { context.jacobian(scheme, set, v, single); });
    check_throws(SPHG_ERROR_ARGUMENT, "support_radius",
                 [&] { neighbors.search(sphgrad::scheme(-1), sphgrad::all(x)); });
}

static void small_matrices()
{
    const sphgrad::context context;
    const std::vector<std::array<double, 6>> packed = {{4, 0, 0, 2, 0, 1}, {1, 0, 0, 1, 0, 1}};
    std::vector<vec> values(2), sigma(2);
    std::vector<mat> vectors(2), u(2), v(2);
    context.eigen(3, packed, values, vectors);
    CHECK(near(values[0][0], 4) && near(values[0][2], 1));
    const std::vector<mat> full = {{{{0, 2, 0}, {1, 0, 0}, {0, 0, 3}}}, {{{1, 0, 0}, {0, 1, 0}}}};
    context.svd(full, u, sigma, v);
    CHECK(near(sigma[0][0], 3) && near(sigma[0][2], 1) && near(sigma[1][2], 0));
    std::vector<std::array<double, 6>> inverse(2);
    sphg_stats stats = {};
    sphgrad::inversion wanted;
    wanted.correction = inverse, wanted.stats = &stats;
    context.invert_moments(scheme, packed, sphgrad::same(1.0), wanted);
    CHECK(near(inverse[0][0], 0.25) && stats.rank[3] == 2);
}

static void handles_move_and_results_may_be_returned()
{
    const auto x = cloud();
    sphgrad::context first;
    sphgrad::neighbors a(first), b(first);
    a.search(scheme, sphgrad::all(x));
    b = std::move(a);
    CHECK(!a.get() && b.get());
    sphgrad::context second(std::move(first));
    CHECK(!first.get() && second.get());
    b.search(scheme, sphgrad::all(x)); /* it knows the context by its address in C */
    sphgrad::neighbors c(std::move(b));
    c = sphgrad::neighbors(second);

    sphg_config config = {};
    config.threads = -1;
    check_throws(SPHG_ERROR_ARGUMENT, "", [&] { sphgrad::context never(config); });
    CHECK(sphgrad::quiet_context(config).created() == SPHG_ERROR_ARGUMENT);
    const sphgrad::quiet_context quiet;
    sphgrad::quiet_neighbors n(quiet);
    CHECK(quiet.created() == SPHG_OK && n.created() == SPHG_OK);
    CHECK(n.search(scheme, sphgrad::all(x)));
    const sphgrad::status refused = n.search(sphgrad::scheme(-1), sphgrad::all(x));
    CHECK(!refused && refused.result == SPHG_ERROR_ARGUMENT &&
          refused.message.find("support_radius") != std::string::npos);
    std::vector<mat> few(3);
    const sphgrad::status short_of =
        quiet.jacobian(scheme, sphgrad::sources(n, sphgrad::same(1.0)), x, few);
    CHECK(short_of.result == SPHG_ERROR_SIZE && !short_of.message.empty());
}

int main()
{
    containers_of_all_kinds();
    all_operators();
    geometries();
    lengths_are_checked();
    small_matrices();
    handles_move_and_results_may_be_returned();
    std::puts("all held");
    return 0;
}
