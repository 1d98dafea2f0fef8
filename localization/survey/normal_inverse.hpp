#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <vector>

namespace lodestar {

/// Rows and columns `wanted` of the inverse of J'J: the covariance of some unknowns of a least-squares
/// problem with this Jacobian (residuals in sigmas). Nothing when J'J is singular.
std::optional<Eigen::MatrixXd> inverse_part(const Eigen::SparseMatrix<double, Eigen::RowMajor>& jacobian,
                                            const std::vector<int>& wanted);

}  // namespace lodestar
