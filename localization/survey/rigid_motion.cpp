#include "localization/survey/rigid_motion.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace lodestar {
namespace {

/// The best rigid motion by (x, y, yaw) changes, of which the positions decide: 3 x 3 n.
Eigen::MatrixXd best_motion_by_changes(const Eigen::MatrixXd& motions) {
  Eigen::MatrixXd of_positions = motions;
  for (Eigen::Index row = 2; row < motions.rows(); row += 3) of_positions.row(row).setZero();
  Eigen::Matrix3d normal = of_positions.transpose() * motions;
  if (!(normal(2, 2) > 0.0)) normal(2, 2) = 1.0;  // a single marker does not turn its position
  return normal.ldlt().solve(of_positions.transpose());
}

Vec2 middle_of(std::span<const PointPair> pairs) {
  double total = 0.0;
  Vec2 middle_m = Vec2::Zero();
  for (const PointPair& pair : pairs) {
    total += pair.weight;
    middle_m += pair.weight * pair.from_m;
  }
  return middle_m / total;
}

/// Changes of (x, y, yaw) when the registry grows about its middle: each moves away from it.
Eigen::VectorXd growth(const Eigen::MatrixXd& motions) {
  Eigen::VectorXd grown = Eigen::VectorXd::Zero(motions.rows());
  for (Eigen::Index row = 0; row + 2 < motions.rows(); row += 3) {
    grown[row] = motions(row + 1, 2);
    grown[row + 1] = -motions(row, 2);
  }
  return grown;
}

}  // namespace

Pose2 best_rigid_motion(std::span<const PointPair> pairs, double turn_rad) {
  double total = 0.0;
  Vec2 to_middle_m = Vec2::Zero();
  for (const PointPair& pair : pairs) {
    total += pair.weight;
    to_middle_m += pair.weight * pair.to_m;
  }
  const Vec2 from_middle_m = middle_of(pairs);
  to_middle_m /= total;
  Vec2 turn_m2 = Vec2::Zero();
  for (const PointPair& pair : pairs) {
    const Vec2 from_m = pair.from_m - from_middle_m;
    const Vec2 to_m = pair.to_m - to_middle_m;
    turn_m2 += pair.weight / total * Vec2(from_m.dot(to_m), cross(from_m, to_m));
  }
  constexpr double one_point_m2 = 1e-8;
  const double yaw_rad = turn_m2.norm() > one_point_m2 ? heading_of(turn_m2) : turn_rad;
  return {to_middle_m - Eigen::Rotation2Dd(yaw_rad) * from_middle_m, yaw_rad};
}

SimilarMotion best_similar_motion(std::span<const PointPair> pairs, double scale_sigma) {
  SimilarMotion similar{.motion = best_rigid_motion(pairs), .middle_m = middle_of(pairs)};
  // The turn does not depend on the scale, nor do the middles; what is left is a weighted mean with the
  // prior.
  const Vec2 to_middle_m = similar.motion * similar.middle_m;
  const Eigen::Rotation2Dd turn(similar.motion.yaw_rad);
  double wanted = 1.0 / square(scale_sigma);
  double weight = wanted;
  for (const PointPair& pair : pairs) {
    const Vec2 from_m = turn * (pair.from_m - similar.middle_m);
    wanted += pair.weight * from_m.dot(pair.to_m - to_middle_m);
    weight += pair.weight * from_m.squaredNorm();
  }
  similar.scale = wanted / weight;
  return similar;
}

Eigen::MatrixXd rigid_motions(std::span<const RegisteredMarker> markers) {
  Vec2 middle = Vec2::Zero();
  for (const RegisteredMarker& marker : markers)
    middle += marker.position_m.head<2>() / static_cast<double>(markers.size());
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(markers.size()), 3);
  for (std::size_t m = 0; m < markers.size(); ++m) {
    const Vec2 off = markers[m].position_m.head<2>() - middle;
    motions.block<3, 3>(3 * static_cast<Eigen::Index>(m), 0) << 1.0, 0.0, -off.y(), 0.0, 1.0, off.x(), 0.0,
        0.0, 1.0;
  }
  return motions;
}

Eigen::MatrixXd shape_covariance(std::span<const RegisteredMarker> markers, const Eigen::MatrixXd& covariance,
                                 double scale_share) {
  Eigen::MatrixXd motions = rigid_motions(markers);
  Eigen::MatrixXd by_changes = best_motion_by_changes(motions);
  const Eigen::VectorXd grown = growth(motions);
  if (scale_share > 0.0 && grown.squaredNorm() > 0.0) {
    motions.conservativeResize(Eigen::NoChange, motions.cols() + 1);
    motions.rightCols<1>() = grown;
    by_changes.conservativeResize(by_changes.rows() + 1, Eigen::NoChange);
    by_changes.bottomRows<1>() = scale_share / grown.squaredNorm() * grown.transpose();
  }
  // (1 - M B) C (1 - M B)' by its few columns: in a hall the products in full would take seconds.
  const Eigen::MatrixXd moved = by_changes * covariance;
  const Eigen::MatrixXd once = covariance - motions * moved;
  return once - (once * by_changes.transpose()) * motions.transpose();
}

double turn_sigma_rad(std::span<const RegisteredMarker> markers, const Eigen::MatrixXd& covariance) {
  if (markers.size() == 1) return std::sqrt(covariance(2, 2));
  const Eigen::MatrixXd by_changes = best_motion_by_changes(rigid_motions(markers));
  return std::sqrt((by_changes.row(2) * covariance * by_changes.row(2).transpose()).value());
}

}  // namespace lodestar
