/* SPDX-License-Identifier: MIT */
/* Fields in matrices of Eigen, n x 3 and 3 x n, in either storage order: the same bits, no copies.
 */
#include "check.hpp"
#include <Eigen/Core>

using row_major = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

template <class Matrix>
void orders(const sphgrad::context &context, const Eigen::MatrixXd &x,
            const std::vector<row_major> &expected)
{
    const sphg_scheme scheme = sphgrad::scheme(2.2);
    const bool transposed = Matrix::RowsAtCompileTime == 3;
    Matrix positions;
    if constexpr (transposed)
        positions = x.transpose();
    else
        positions = x;
    CHECK(sphgrad::input(positions).count() == x.rows() &&
          sphgrad::input(positions).numbers() == 3);
    CHECK(sphgrad::input(positions).view(true).x == positions.data());
    sphgrad::neighbors neighbors(context);
    neighbors.search(scheme, sphgrad::all(positions));
    std::vector<row_major> j(static_cast<std::size_t>(x.rows()));
    const sphgrad::sources set(neighbors, sphgrad::same(1.0));
    context.jacobian(scheme, set, positions, j);
    for (std::size_t i = 0; i < j.size(); ++i)
        CHECK(j[i] == expected[i]);

    Matrix gradient = Matrix::Constant(positions.rows(), positions.cols(), 7.0);
    const Eigen::VectorXd first = x.col(0);
    context.gradient(scheme, set, first, gradient);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
        for (Eigen::Index k = 0; k < 3; ++k)
            CHECK((transposed ? gradient(k, i) : gradient(i, k)) ==
                  expected[static_cast<std::size_t>(i)](0, k));
}

int main()
{
    const sphgrad::context context;
    Eigen::MatrixXd x(216, 3);
    for (int i = 0; i < 216; ++i)
        x.row(i) << i % 6 + 0.1 * std::sin(i), i / 6 % 6 + 0.1 * std::cos(2 * i), i / 36;
    const sphg_scheme scheme = sphgrad::scheme(2.2);
    sphgrad::neighbors neighbors(context);
    neighbors.search(scheme, sphgrad::all(x));
    std::vector<row_major> j(216);
    context.jacobian(scheme, {neighbors, sphgrad::same(1.0)}, x, j);
    for (const row_major &one : j)
        CHECK((one - row_major::Identity()).norm() < 1e-11);

    orders<Eigen::MatrixXd>(context, x, j);
    orders<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(context, x, j);
    orders<Eigen::Matrix<double, -1, 3>>(context, x, j);
    orders<Eigen::Matrix<double, -1, 3, Eigen::RowMajor>>(context, x, j);
    orders<Eigen::Matrix<double, 3, -1>>(context, x, j);
    orders<Eigen::Matrix<double, 3, -1, Eigen::RowMajor>>(context, x, j);

    /* Vectors of small matrices, parts of large ones, rows of numbers. */
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 216; ++i)
        points.push_back(x.row(i).transpose());
    std::vector<row_major> again(216);
    context.jacobian(scheme, {neighbors, sphgrad::same(1.0)}, points, again);
    Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(216, 8);
    wide.middleCols(2, 3) = x;
    Eigen::Matrix<double, -1, 9, Eigen::RowMajor> rows(216, 9);
    context.jacobian(scheme, {neighbors, sphgrad::same(1.0)}, wide.middleCols(2, 3), rows);
    context.gradient(scheme, {neighbors, sphgrad::same(1.0)}, x.col(1), wide.rightCols(3));
    for (int i = 0; i < 216; ++i) {
        CHECK(again[static_cast<std::size_t>(i)] == j[static_cast<std::size_t>(i)]);
        CHECK(rows(i, 0) == again[static_cast<std::size_t>(i)](0, 0));
        CHECK(wide(i, 6) == j[static_cast<std::size_t>(i)](1, 1) && wide(i, 1) == 0);
    }

    /* Matrices in Eigen's own order: tensors column by column, corrections and stresses in full. */
    const sphgrad::sources all(neighbors, sphgrad::same(1.0));
    std::vector<Eigen::Matrix3d> by_columns(216), whole(216), stress(216);
    std::vector<std::array<double, 6>> packed(216);
    std::vector<Eigen::Vector3d> force(216), expected(216), divergence(216);
    context.jacobian(scheme, all, points, by_columns);
    context.correction(scheme, all, whole);
    context.correction(scheme, all, packed);
    for (std::size_t i = 0; i < 216; ++i) {
        CHECK(by_columns[i] == j[i]);
        CHECK(whole[i] == whole[i].transpose());
        CHECK(whole[i](0, 2) == packed[i][2] && whole[i](2, 1) == packed[i][4]);
        stress[i] << points[i].x(), 1, 2, 1, points[i].y(), 3, 2, 3, points[i].z();
    }
    std::vector<std::array<double, 6>> triangle;
    for (const Eigen::Matrix3d &s : stress)
        triangle.push_back({s(0, 0), 1, 2, s(1, 1), 3, s(2, 2)});
    sphgrad::sources corrected(neighbors, sphgrad::same(1.0)), beside = corrected;
    corrected.correction = whole;
    beside.correction = packed;
    context.force(scheme, corrected, SPHG_SYM_TENSOR, stress, force);
    context.force(scheme, beside, SPHG_SYM_TENSOR, triangle, expected);
    for (std::size_t i = 0; i < 216; ++i)
        CHECK(force[i] == expected[i]);
    std::vector<row_major> by_rows(216);
    for (std::size_t i = 0; i < 216; ++i)
        by_columns[i] = by_rows[i] = points[i] * Eigen::RowVector3d(1, 2, 3);
    sphgrad::field tensors;
    tensors.shape = SPHG_TENSOR;
    tensors.at_sources = {by_columns};
    tensors.divergence = divergence;
    context.evaluate(scheme, {{all}, {tensors}});
    tensors.at_sources = {by_rows};
    tensors.divergence = force;
    context.evaluate(scheme, {{all}, {tensors}});
    for (std::size_t i = 0; i < 216; ++i)
        CHECK(divergence[i] == force[i] && (force[i] - Eigen::Vector3d(1, 2, 3)).norm() < 1e-10);

    /* Rows of tensors that are scattered cannot be expressed: refused, not transposed. */
    Eigen::Matrix<double, -1, 9> scattered(216, 9);
    check_throws(SPHG_ERROR_SIZE, "follow", [&] {
        context.jacobian(scheme, {neighbors, sphgrad::same(1.0)}, x, scattered);
    });
    Eigen::RowVectorXd volumes = Eigen::RowVectorXd::Constant(216, 1.0);
    context.jacobian(scheme, {neighbors, volumes}, x, again);
    CHECK(again[5] == j[5]);
    std::puts("all held");
    return 0;
}
