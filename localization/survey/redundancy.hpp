#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

namespace lodestar {

/// Redundancy numbers (Baarda 1968): which share of an error in a measurement shows in that measurement's own
/// residuals, 0 to 1; the rest goes into the unknowns, where nothing else contradicts it. Rows of `jacobian`
/// are whitened residuals of measurements with `counts` numbers each; of each the first two numbers count, in
/// the direction that shows least. `covariance` is that of the unknowns `wanted`, on which alone these rows
/// may depend.
std::vector<double> least_redundancies(const Eigen::SparseMatrix<double, Eigen::RowMajor>& jacobian,
                                       std::span<const int> counts, std::span<const int> wanted,
                                       const Eigen::MatrixXd& covariance);

/// The error, in sigmas, that a chi-square test at this probability over this many numbers finds in 8 of 10
/// cases (minimal detectable bias); infinite where the measurement cannot be checked.
double least_noticeable(double redundancy, double probability, int numbers);

}  // namespace lodestar
