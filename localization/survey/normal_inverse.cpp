#include "localization/survey/normal_inverse.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

using Columns = Eigen::SparseMatrix<double>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// L D L' of a symmetric matrix, in the order of elimination, for solving with right sides that are units of
/// few unknowns. The solution at an unknown depends on those only that it meets on its way to the root of the
/// elimination tree (Gilbert and Peierls 1988): all others are skipped.
class PartialSolver {
 public:
  PartialSolver(const Eigen::SimplicialLDLT<Columns>& factors, const std::vector<int>& wanted)
      : lower_(factors.matrixL()), diagonal_(factors.vectorD()) {
    const auto& order = factors.permutationP().indices();
    std::vector<bool> needed(static_cast<std::size_t>(lower_.cols()), false);
    for (const int unknown : wanted) {
      places_.push_back(order[unknown]);
      needed[static_cast<std::size_t>(order[unknown])] = true;
    }
    for (Eigen::Index column = 0; column < lower_.cols(); ++column) {
      if (!needed[static_cast<std::size_t>(column)]) continue;
      needed_.push_back(column);
      if (Columns::InnerIterator below = first_below(column))
        needed[static_cast<std::size_t>(below.row())] = true;
    }
  }

  /// Rows `wanted` of the inverse's columns wanted[first] to wanted[first + count - 1].
  [[nodiscard]] Eigen::MatrixXd columns(Eigen::Index first, Eigen::Index count) const {
    Rows x = Rows::Zero(lower_.rows(), count);
    for (Eigen::Index k = 0; k < count; ++k) x(places_[static_cast<std::size_t>(first + k)], k) = 1.0;
    for (const Eigen::Index column : needed_)
      for (Columns::InnerIterator below = first_below(column); below; ++below)
        x.row(below.row()) -= below.value() * x.row(column);
    for (const Eigen::Index row : needed_) x.row(row) /= diagonal_[row];
    for (auto column = needed_.rbegin(); column != needed_.rend(); ++column)
      for (Columns::InnerIterator below = first_below(*column); below; ++below)
        x.row(*column) -= below.value() * x.row(below.row());
    Eigen::MatrixXd solved(static_cast<Eigen::Index>(places_.size()), count);
    for (std::size_t i = 0; i < places_.size(); ++i)
      solved.row(static_cast<Eigen::Index>(i)) = x.row(places_[i]);
    return solved;
  }

 private:
  /// Past the diagonal, which is 1.
  [[nodiscard]] Columns::InnerIterator first_below(Eigen::Index column) const {
    Columns::InnerIterator entry(lower_, column);
    while (entry && entry.row() <= column) ++entry;
    return entry;
  }

  Columns lower_;
  Eigen::VectorXd diagonal_;
  std::vector<Eigen::Index> places_;  ///< of the wanted unknowns in the order of elimination
  std::vector<Eigen::Index> needed_;  ///< ascending
};

}  // namespace

std::optional<Eigen::MatrixXd> inverse_part(const Eigen::SparseMatrix<double, Eigen::RowMajor>& jacobian,
                                            const std::vector<int>& wanted) {
  const Columns by_columns(jacobian);
  const Columns normal = by_columns.transpose() * by_columns;
  // Unknowns of very different size, as metres and radians, are scaled to a diagonal of ones.
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return std::nullopt;
  const Columns scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::SimplicialLDLT<Columns> factors(scaled);
  if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > 0.0)) return std::nullopt;
  const PartialSolver solver(factors, wanted);
  constexpr Eigen::Index at_once = 32;
  const auto count = static_cast<Eigen::Index>(wanted.size());
  Eigen::MatrixXd inverse(count, count);
  for (Eigen::Index first = 0; first < count; first += at_once) {
    const Eigen::Index columns = std::min(at_once, count - first);
    inverse.middleCols(first, columns) = solver.columns(first, columns);
  }
  Eigen::VectorXd scale_of_wanted(count);
  for (Eigen::Index i = 0; i < count; ++i) scale_of_wanted[i] = scale[wanted[static_cast<std::size_t>(i)]];
  inverse = scale_of_wanted.asDiagonal() * inverse * scale_of_wanted.asDiagonal();
  return Eigen::MatrixXd(0.5 * (inverse + inverse.transpose()));
}

}  // namespace lodestar
