#pragma once

#include <Eigen/SparseCholesky>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

namespace lodestar {

/// Rows of a sparse linear least-squares problem, solved by its normal equations.
class LinearRows {
 public:
  explicit LinearRows(int unknowns) : unknowns_(unknowns) {}

  /// The sum of coefficient times unknown is `value`, with this standard deviation.
  void add(std::initializer_list<std::pair<int, double>> terms, double value, double sigma) {
    const auto row = static_cast<int>(values_.size());
    for (const auto& [unknown, coefficient] : terms)
      triplets_.emplace_back(row, unknown, coefficient / sigma);
    values_.push_back(value / sigma);
  }

  /// Nothing when they do not determine every unknown.
  [[nodiscard]] std::optional<Eigen::VectorXd> solve() const {
    Eigen::SparseMatrix<double> matrix(static_cast<Eigen::Index>(values_.size()), unknowns_);
    matrix.setFromTriplets(triplets_.begin(), triplets_.end());
    const Eigen::Map<const Eigen::VectorXd> right(values_.data(), static_cast<Eigen::Index>(values_.size()));
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix.transpose() * matrix);
    if (factors.info() != Eigen::Success) return std::nullopt;
    Eigen::VectorXd solution = factors.solve(matrix.transpose() * right);
    if (!solution.allFinite()) return std::nullopt;
    return solution;
  }

 private:
  int unknowns_;
  std::vector<Eigen::Triplet<double>> triplets_;
  std::vector<double> values_;
};

}  // namespace lodestar
