#include "localization/calibration/lens_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

namespace lodestar {
namespace {

/// Unknowns of OpenCV's solvers.
struct Solution {
  cv::Matx33d k = cv::Matx33d::eye();
  std::vector<double> distortion;
  std::vector<cv::Mat> rotations;     ///< of the boards, as vectors
  std::vector<cv::Mat> translations;  ///< both camera_from_board
};

std::size_t coefficient_count(LensModel model) {
  switch (model) {
    case LensModel::pinhole:
      return 5;
    case LensModel::rational:
      return 8;
    case LensModel::fisheye:
      return 4;
  }
  return 0;
}

/// The views in OpenCV's format.
struct Corners {
  std::vector<std::vector<cv::Point3f>> points;
  std::vector<std::vector<cv::Point2f>> pixels;
  cv::Size size;
};

const cv::TermCriteria until_settled(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12);

cv::Matx33d guessed_matrix(cv::Size size, double focal_px) {
  return {focal_px, 0.0, 0.5 * (size.width - 1), 0.0, focal_px, 0.5 * (size.height - 1), 0.0, 0.0, 1.0};
}

/// Starts from a guessed focal length and frees the coefficients in stages: with strong distortion the full
/// model does not converge when all are free from the start. Returns the root mean square error.
double solve_in_stages(const Corners& corners, LensModel model, double focal_px, Solution& solution) {
  solution.k = guessed_matrix(corners.size, focal_px);
  constexpr int guess = cv::CALIB_USE_INTRINSIC_GUESS;
  constexpr int radial_only = guess | cv::CALIB_FIX_PRINCIPAL_POINT | cv::CALIB_ZERO_TANGENT_DIST |
                              cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3;
  std::vector<int> stages{radial_only, guess};
  if (model == LensModel::rational) stages.push_back(guess | cv::CALIB_RATIONAL_MODEL);
  double rms_px = 0.0;
  for (const int flags : stages) {
    rms_px =
        cv::calibrateCamera(corners.points, corners.pixels, corners.size, solution.k, solution.distortion,
                            solution.rotations, solution.translations, flags, until_settled);
  }
  return rms_px;
}

double solve_fisheye(const Corners& corners, double focal_px, Solution& solution) {
  solution.k = guessed_matrix(corners.size, focal_px);
  solution.distortion.assign(4, 0.0);
  constexpr int flags = cv::fisheye::CALIB_USE_INTRINSIC_GUESS | cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC |
                        cv::fisheye::CALIB_FIX_SKEW;
  return cv::fisheye::calibrate(corners.points, corners.pixels, corners.size, solution.k, solution.distortion,
                                solution.rotations, solution.translations, flags, until_settled);
}

bool is_finite(const Solution& solution) {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::ranges::all_of(solution.k.val, finite) && std::ranges::all_of(solution.distortion, finite);
}

/// The best of several starts, from a wide lens to a long one: each may end in its own local minimum, and in
/// a wrong one the reprojection error is tens of pixels.
std::optional<Solution> solve(std::span<const BoardView> views, cv::Size size, LensModel model) {
  Corners corners{.size = size};
  for (const BoardView& view : views) {
    corners.points.push_back(view.points_m);
    corners.pixels.push_back(view.pixels);
  }
  std::optional<Solution> best;
  double best_rms_px = std::numeric_limits<double>::infinity();
  for (const double focal_by_width : {0.32, 0.5, 0.8, 1.6}) {
    Solution solution;
    try {
      const double focal_px = focal_by_width * size.width;
      const double rms_px = model == LensModel::fisheye ? solve_fisheye(corners, focal_px, solution)
                                                        : solve_in_stages(corners, model, focal_px, solution);
      if (!(rms_px < best_rms_px) || !is_finite(solution)) continue;
      best_rms_px = rms_px;
      best = std::move(solution);
      constexpr double fits_px = 1.0;
      if (best_rms_px < fits_px) break;
    } catch (const cv::Exception&) {
      continue;  // homographies or normal equations without a solution from this start
    }
  }
  if (best) best->distortion.resize(coefficient_count(model), 0.0);
  return best;
}

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Reprojection errors of one view, and their derivatives by the intrinsics (fx fy cx cy, distortion) and by
/// the board's pose.
struct Linearized {
  Eigen::VectorXd error;
  Eigen::MatrixXd by_intrinsics;
  Eigen::MatrixXd by_place;
};

Linearized linearize(const BoardView& view, const Solution& solution, std::size_t index, LensModel model) {
  std::vector<cv::Point2d> predicted;
  const std::vector<cv::Point3d> points(view.points_m.begin(), view.points_m.end());
  const cv::Mat& rotation = solution.rotations[index];
  const cv::Mat& translation = solution.translations[index];
  cv::Mat jacobian;
  if (model == LensModel::fisheye) {
    cv::fisheye::projectPoints(points, predicted, rotation, translation, solution.k, solution.distortion, 0.0,
                               jacobian);
  } else {
    cv::projectPoints(points, rotation, translation, solution.k, solution.distortion, predicted, jacobian);
  }
  Linearized linear;
  linear.error.resize(2 * static_cast<Eigen::Index>(predicted.size()));
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    linear.error[row] = predicted[i].x - static_cast<double>(view.pixels[i].x);
    linear.error[row + 1] = predicted[i].y - static_cast<double>(view.pixels[i].y);
  }
  const Eigen::Map<const RowMajor> all(jacobian.ptr<double>(), jacobian.rows, jacobian.cols);
  const auto intrinsics = static_cast<Eigen::Index>(4 + coefficient_count(model));
  constexpr Eigen::Index place = 6;
  // OpenCV's columns: intrinsics, pose, skew (fisheye); pose, intrinsics (otherwise).
  linear.by_intrinsics = all.middleCols(model == LensModel::fisheye ? 0 : place, intrinsics);
  linear.by_place = all.middleCols(model == LensModel::fisheye ? intrinsics : 0, place);
  return linear;
}

IntrinsicSigmas sigmas_of(const Eigen::MatrixXd& normal, double variance_px2) {
  const Eigen::Index count = normal.rows();
  Eigen::VectorXd sigma = Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity());
  // Scaled to a unit diagonal, as focal lengths and coefficients differ by orders of magnitude.
  const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Eigen::MatrixXd> factors(scale.asDiagonal() * normal * scale.asDiagonal());
  constexpr double singular = 1e-14;
  if (factors.info() == Eigen::Success && factors.vectorD().minCoeff() > singular) {
    const Eigen::MatrixXd inverse = factors.solve(Eigen::MatrixXd::Identity(count, count));
    sigma = (variance_px2 * inverse.diagonal()).cwiseSqrt().cwiseProduct(scale);
  }
  IntrinsicSigmas sigmas{sigma[0], sigma[1], sigma[2], sigma[3], {}};
  for (Eigen::Index i = 4; i < count; ++i) sigmas.coefficients[static_cast<std::size_t>(i - 4)] = sigma[i];
  return sigmas;
}

CameraModel camera_of(const Solution& solution, cv::Size size, LensModel model) {
  CameraModel camera{.width_px = size.width,
                     .height_px = size.height,
                     .fx_px = solution.k(0, 0),
                     .fy_px = solution.k(1, 1),
                     .cx_px = solution.k(0, 2),
                     .cy_px = solution.k(1, 2)};
  camera.distortion = model == LensModel::fisheye    ? Distortion::equidistant
                      : model == LensModel::rational ? Distortion::rational_polynomial
                                                     : Distortion::plumb_bob;
  std::ranges::copy(solution.distortion, camera.coefficients.begin());
  camera.limit_rays();
  return camera;
}

Vec3 normal_of(const cv::Mat& rotation) {
  const Vec3 vector(rotation.at<double>(0), rotation.at<double>(1), rotation.at<double>(2));
  const double angle = vector.norm();
  if (angle == 0.0) return Vec3::UnitZ();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix().col(2);
}

}  // namespace

std::optional<LensFit> fit_lens(std::span<const BoardView> views, int width_px, int height_px,
                                LensModel model) {
  const cv::Size size(width_px, height_px);
  const std::optional<Solution> solution = solve(views, size, model);
  if (!solution) return std::nullopt;
  LensFit fit{.camera = camera_of(*solution, size, model)};
  const auto intrinsics = static_cast<Eigen::Index>(4 + coefficient_count(model));
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(intrinsics, intrinsics);
  double squared_px2 = 0.0;
  Eigen::Index numbers = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Linearized linear = linearize(views[i], *solution, i, model);
    const Eigen::MatrixXd cross = linear.by_intrinsics.transpose() * linear.by_place;
    const Eigen::MatrixXd place = linear.by_place.transpose() * linear.by_place;
    normal += linear.by_intrinsics.transpose() * linear.by_intrinsics -
              cross * place.ldlt().solve(cross.transpose());
    squared_px2 += linear.error.squaredNorm();
    numbers += linear.error.size();
    fit.rms_px.push_back(
        std::sqrt(2.0 * linear.error.squaredNorm() / static_cast<double>(linear.error.size())));
    fit.board_normals.push_back(normal_of(solution->rotations[i]));
  }
  const Eigen::Index unknowns = intrinsics + 6 * static_cast<Eigen::Index>(views.size());
  if (numbers <= unknowns) return std::nullopt;
  fit.all_rms_px = std::sqrt(2.0 * squared_px2 / static_cast<double>(numbers));
  fit.sigmas = sigmas_of(normal, squared_px2 / static_cast<double>(numbers - unknowns));
  return fit;
}

}  // namespace lodestar
