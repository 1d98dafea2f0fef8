#include "app/bench/cramer_rao.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "localization/pose/map_estimate.hpp"

namespace lodestar {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr std::array upright_motions{0, 1, 2, 5};  // position and yaw

/// Metres and radians are of similar magnitude here, so no scaling is needed.
template <int N>
std::optional<Eigen::Matrix<double, N, N>> inverse_of(const Eigen::Matrix<double, N, N>& information) {
  const Eigen::LDLT<Eigen::Matrix<double, N, N>> factors(information);
  const auto pivots = factors.vectorD().eval();
  if (!(pivots.minCoeff() > 1e-12 * pivots.maxCoeff())) return std::nullopt;
  return factors.solve(Eigen::Matrix<double, N, N>::Identity()).eval();
}

}  // namespace

double PoseBound::lateral_m() const {
  return std::sqrt(covariance(0, 0) + covariance(1, 1));
}

double PoseBound::height_m() const {
  return std::sqrt(covariance(2, 2));
}

double PoseBound::yaw_rad() const {
  return std::sqrt(covariance(5, 5));
}

std::optional<PoseBound> cramer_rao_bound(const Eigen::Isometry3d& map_from_camera,
                                          std::span<const InformativeDot> dots, const CameraModel& camera,
                                          Tilt tilt) {
  Mat6 information = Mat6::Zero();
  for (const InformativeDot& dot : dots) {
    const std::optional<Projection> seen = project_dot(map_from_camera, dot.point_in_map, camera);
    if (!seen) return std::nullopt;
    information += seen->jacobian.transpose() * dot.information_per_px2 * seen->jacobian;
  }
  PoseBound bound;
  if (tilt == Tilt::free) {
    const std::optional<Mat6> covariance = inverse_of<6>(information);
    if (!covariance) return std::nullopt;
    bound.covariance = *covariance;
    return bound;
  }
  const Eigen::Matrix4d of_motions = information(upright_motions, upright_motions);
  const std::optional<Eigen::Matrix4d> covariance = inverse_of<4>(of_motions);
  if (!covariance) return std::nullopt;
  bound.covariance(upright_motions, upright_motions) = *covariance;
  return bound;
}

}  // namespace lodestar
