#include "localization/survey/normal_inverse.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "maps/random.hpp"

namespace lodestar {
namespace {

TEST(NormalInverse, is_a_part_of_the_whole_inverse) {
  Random random(4);
  constexpr int unknowns = 60;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(300, unknowns);
  for (int row = 0; row < jacobian.rows(); ++row)
    for (int k = 0; k < 3; ++k) jacobian(row, static_cast<int>(random.below(unknowns))) = random.normal();
  jacobian.col(7) *= 1e-4;  // of quite another unit
  const std::vector<int> wanted{3, 7, 8, 20, 59};
  const Eigen::SparseMatrix<double, Eigen::RowMajor> sparse = jacobian.sparseView();
  const auto part = inverse_part(sparse, wanted);
  ASSERT_TRUE(part);
  const Eigen::MatrixXd whole = (jacobian.transpose() * jacobian).inverse();
  for (std::size_t i = 0; i < wanted.size(); ++i)
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto column = static_cast<Eigen::Index>(k);
      const double scale = std::sqrt(whole(wanted[i], wanted[i]) * whole(wanted[k], wanted[k]));
      EXPECT_NEAR((*part)(row, column), whole(wanted[i], wanted[k]), 1e-9 * scale);
    }
}

TEST(NormalInverse, is_nothing_when_an_unknown_is_in_no_row) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Identity(4, 4);
  jacobian(2, 2) = 0.0;
  const Eigen::SparseMatrix<double, Eigen::RowMajor> sparse = jacobian.sparseView();
  EXPECT_FALSE(inverse_part(sparse, {0, 1}));
}

}  // namespace
}  // namespace lodestar
