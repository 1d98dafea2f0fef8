#include "localization/survey/redundancy.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <cmath>
#include <limits>

#include "maps/chi_square.hpp"

namespace lodestar {

std::vector<double> least_redundancies(const Eigen::SparseMatrix<double, Eigen::RowMajor>& jacobian,
                                       std::span<const int> counts, std::span<const int> wanted,
                                       const Eigen::MatrixXd& covariance) {
  std::vector<Eigen::Index> place(static_cast<std::size_t>(jacobian.cols()), -1);
  for (std::size_t i = 0; i < wanted.size(); ++i)
    place[static_cast<std::size_t>(wanted[i])] = static_cast<Eigen::Index>(i);
  std::vector<double> redundancies;
  Eigen::Index row = 0;
  for (const int count : counts) {
    const auto numbers = std::min<Eigen::Index>(count, 2);
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(numbers, covariance.cols());
    for (Eigen::Index i = 0; i < numbers; ++i) {
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(jacobian, row + i); entry;
           ++entry) {
        const Eigen::Index column = place[static_cast<std::size_t>(entry.col())];
        if (column >= 0) own(i, column) = entry.value();
      }
    }
    const Eigen::MatrixXd absorbed = own * covariance * own.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(absorbed, Eigen::EigenvaluesOnly);
    redundancies.push_back(std::clamp(1.0 - solver.eigenvalues().maxCoeff(), 0.0, 1.0));
    row += count;
  }
  return redundancies;
}

double least_noticeable(double redundancy, double probability, int numbers) {
  constexpr double power = 0.8;
  constexpr double none = 1e-3;  // what rounding leaves of no redundancy at all
  if (numbers <= 0 || redundancy < none) return std::numeric_limits<double>::infinity();
  const double noncentrality = boost::math::non_central_chi_squared::find_non_centrality(
      static_cast<double>(numbers), chi_square_quantile(1.0 - probability, numbers), 1.0 - power);
  return std::sqrt(noncentrality / redundancy);
}

}  // namespace lodestar
