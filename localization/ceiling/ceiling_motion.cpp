#include "localization/ceiling/ceiling_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "maps/median.hpp"

namespace lodestar {
namespace {

constexpr int most_iterations = 12;
constexpr double settled_m = 2e-4;
constexpr double settled_rad = 2e-4;
constexpr double least_noise_gray = 0.2;  // of the reduced image: quantization to whole gray values
constexpr double least_lean_rad = 1e-5;
constexpr double outlier_sigmas = 3.5;
/// Factor on the variance, as errors of neighbouring points are correlated: the image is smooth.
constexpr double error_growth = 3.0;

/// Correlation of weighted pairs, accumulated from sums.
class Correlation {
 public:
  void add(double a, double b, double weight) {
    weight_ += weight;
    a_ += weight * a;
    b_ += weight * b;
    aa_ += weight * a * a;
    bb_ += weight * b * b;
    ab_ += weight * a * b;
  }
  [[nodiscard]] double value() const {
    const double spread = (aa_ - a_ * a_ / weight_) * (bb_ - b_ * b_ / weight_);
    return spread > 0.0 ? (ab_ - a_ * b_ / weight_) / std::sqrt(spread) : 0.0;
  }

 private:
  double weight_ = 0.0, a_ = 0.0, b_ = 0.0, aa_ = 0.0, bb_ = 0.0, ab_ = 0.0;
};

}  // namespace

std::optional<double> ceiling_height_m(const MarkerRegistry& registry) {
  constexpr double same_m = 0.05;
  if (registry.markers.empty()) return std::nullopt;
  const auto [lowest, highest] = std::ranges::minmax_element(
      registry.markers, {}, [](const RegisteredMarker& marker) { return marker.position_m.z(); });
  if (highest->position_m.z() - lowest->position_m.z() > same_m) return std::nullopt;
  return 0.5 * (lowest->position_m.z() + highest->position_m.z());
}

CeilingMotion::CeilingMotion(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera,
                             double ceiling_height_m, double lean_sigma_rad,
                             const CeilingMotionOptions& options)
    : view_(camera, base_from_camera, ceiling_height_m, options.view),
      lean_sigma_rad_(lean_sigma_rad),
      sway_m_(lean_sigma_rad_ * ceiling_height_m),
      options_(options) {}

void CeilingMotion::set_frame(const Frame& frame) {
  current_ = contrasts(frame.gray, options_.view);
  current_at_ = frame.stamp;
}

bool CeilingMotion::set_keyframe() {
  points_.clear();
  keyframe_stamp_.reset();
  const int side = options_.cell_px;
  // Excludes the border: beyond it there is no image, so a vignette there is not removed as slow change.
  const auto margin = static_cast<int>(options_.view.contrast_reach_px);
  for (int top = margin; top + side + margin <= current_.rows; top += side)
    for (int left = margin; left + side + margin <= current_.cols; left += side)
      choose_points_of_cell({left, top, side, side});
  if (std::ssize(points_) < options_.least_points) return false;
  double squares = 0.0;
  for (const Point& point : points_) squares += point.gray * point.gray;
  if (std::sqrt(squares / static_cast<double>(points_.size())) < options_.least_contrast_gray) return false;
  keyframe_stamp_ = current_at_;
  return true;
}

void CeilingMotion::choose_points_of_cell(const cv::Rect& cell) {
  struct Candidate {
    float sharpness;
    cv::Point at;
  };
  std::vector<Candidate> candidates;
  for (int v = cell.y; v < cell.br().y; ++v) {
    for (int u = cell.x; u < cell.br().x; ++u) {
      const float across = current_(v, u + 1) - current_(v, u - 1);
      const float down = current_(v + 1, u) - current_(v - 1, u);
      candidates.push_back({across * across + down * down, {u, v}});
    }
  }
  const auto end =
      candidates.begin() + std::min<std::ptrdiff_t>(options_.most_in_a_cell, std::ssize(candidates));
  std::ranges::partial_sort(candidates, end, std::ranges::greater(), &Candidate::sharpness);
  for (auto candidate = candidates.begin(); candidate != end; ++candidate)
    if (const std::optional<Point> point = point_at(candidate->at.y, candidate->at.x))
      points_.push_back(*point);
}

std::optional<CeilingMotion::Point> CeilingMotion::point_at(int row, int column) const {
  const Vec2 pixel(column, row);
  const std::optional<Vec2> here = view_.ceiling_at(pixel);
  const std::optional<Vec2> right = view_.ceiling_at(pixel + Vec2(1.0, 0.0));
  const std::optional<Vec2> below = view_.ceiling_at(pixel + Vec2(0.0, 1.0));
  if (!here || !right || !below) return std::nullopt;
  Eigen::Matrix2d metres_by_pixels;
  metres_by_pixels << *right - *here, *below - *here;
  const Vec2 by_pixels(0.5 * (current_(row, column + 1) - current_(row, column - 1)),
                       0.5 * (current_(row + 1, column) - current_(row - 1, column)));
  const Vec2 by_metres = metres_by_pixels.inverse().transpose() * by_pixels;
  Point point{.on_ceiling_m = *here,
              .pixel = pixel,
              .gray = current_(row, column),
              .gray_variance = by_pixels.squaredNorm() * square(options_.sharpness_sigma_px),
              .gray_by_change = {}};
  point.gray_by_change << by_metres, by_metres.y() * here->x() - by_metres.x() * here->y(),
      view_.shift_by_lean(*here).transpose() * by_metres;
  return point;
}

/// Evaluates every fourth point.
CeilingMotion::Overlap CeilingMotion::overlap(const Pose2& keyframe_from_now) const {
  constexpr std::size_t every = 4;
  const Pose2 now_from_keyframe = inverse(keyframe_from_now);
  std::size_t looked_at = 0;
  std::size_t in_view = 0;
  double shifts_px = 0.0;
  for (std::size_t i = 0; i < points_.size(); i += every, ++looked_at) {
    const std::optional<Vec2> pixel = view_.pixel_of(now_from_keyframe * points_[i].on_ceiling_m);
    if (!pixel || !is_within(current_, *pixel)) continue;
    ++in_view;
    shifts_px += (*pixel - points_[i].pixel).norm();
  }
  if (in_view == 0) return {};
  return {.share_in_view = static_cast<double>(in_view) / static_cast<double>(looked_at),
          .shift_px = shifts_px / static_cast<double>(in_view)};
}

/// False when too few of the keyframe's points are in view.
bool CeilingMotion::sample(const Alignment& alignment, std::vector<Sample>& seen) const {
  const Pose2 now_from_keyframe = inverse(alignment.keyframe_from_now);
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(now_from_keyframe.yaw_rad).toRotationMatrix();
  seen.clear();
  for (const Point& point : points_) {
    const Vec2 upright_m = point.on_ceiling_m - view_.shift_by_lean(point.on_ceiling_m) * alignment.lean_rad;
    const std::optional<Vec2> pixel = view_.pixel_of(turn * upright_m + now_from_keyframe.position_m);
    if (pixel && is_within(current_, *pixel)) seen.push_back({&point, gray_at(current_, *pixel)});
  }
  return std::ssize(seen) >= options_.least_points &&
         static_cast<double>(seen.size()) >=
             options_.least_share_in_view * static_cast<double>(points_.size());
}

/// Standard deviation of the difference of both frames, robust against outliers of fewer than half of the
/// points.
double CeilingMotion::noise_of(std::span<const Sample> seen) {
  std::vector<double> misses;
  misses.reserve(seen.size());
  for (const Sample& sample : seen) misses.push_back(std::abs(sample.gray - sample.point->gray));
  constexpr double sigma_of_median = 1.4826;
  return std::max(sigma_of_median * median(std::move(misses)), least_noise_gray);
}

/// One Gauss-Newton step with Geman-McClure weights and a weak prior on the camera's lean.
std::optional<CeilingMotion::Fit> CeilingMotion::fit(std::span<const Sample> seen,
                                                     const Vec2& lean_rad) const {
  const double noise_gray = noise_of(seen);
  Eigen::Matrix<double, 5, 5> information = Eigen::Matrix<double, 5, 5>::Zero();
  Change right = Change::Zero();
  double squares = 0.0;
  double weights = 0.0;
  std::size_t agreeing = 0;
  Correlation correlation;
  for (const auto& [point, gray] : seen) {
    constexpr double robust_sigmas = 2.0;
    const double variance = square(noise_gray) + point->gray_variance;
    const double miss = (gray - point->gray) / std::sqrt(variance);
    const double weight = 1.0 / square(1.0 + square(miss / robust_sigmas));
    information += weight / variance * point->gray_by_change * point->gray_by_change.transpose();
    right += weight / variance * (gray - point->gray) * point->gray_by_change;
    squares += weight * square(miss);
    weights += weight;
    if (std::abs(miss) > outlier_sigmas) continue;
    correlation.add(point->gray, gray, 1.0 / variance);
    ++agreeing;
  }
  const double growth = squares / weights * error_growth;
  information /= growth;
  right /= growth;
  const double lean_information = 0.5 / square(std::max(lean_sigma_rad_, least_lean_rad));
  information.diagonal().tail<2>().array() += lean_information;
  right.tail<2>() -= lean_information * lean_rad;
  const Eigen::LDLT<Eigen::Matrix<double, 5, 5>> factors(information);
  if (factors.info() != Eigen::Success || !factors.isPositive()) return std::nullopt;
  Fit fit{.change = factors.solve(right),
          .covariance = factors.solve(Eigen::Matrix<double, 5, 5>::Identity()),
          .share_agreeing = static_cast<double>(agreeing) / static_cast<double>(seen.size()),
          .correlation = correlation.value()};
  if (!fit.change.allFinite() || !fit.covariance.allFinite()) return std::nullopt;
  return fit;
}

std::optional<VisualOdometryIncrement> CeilingMotion::motion(const Pose2& expected_keyframe_from_now) const {
  if (!keyframe_stamp_ || overlap(expected_keyframe_from_now).shift_px < options_.least_shift_px)
    return std::nullopt;
  Alignment alignment{expected_keyframe_from_now};
  std::vector<Sample> seen;
  seen.reserve(points_.size());
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    if (!sample(alignment, seen)) return std::nullopt;
    const std::optional<Fit> fitted = fit(seen, alignment.lean_rad);
    if (!fitted) return std::nullopt;
    // At this alignment the current frame shows the keyframe changed, so the alignment changes likewise.
    const Pose2 shift{fitted->change.head<2>(), fitted->change[2]};
    alignment.keyframe_from_now = shift * alignment.keyframe_from_now;
    alignment.lean_rad += fitted->change.tail<2>();
    const Pose2 deviation = inverse(expected_keyframe_from_now) * alignment.keyframe_from_now;
    if (deviation.position_m.norm() > options_.max_deviation_m ||
        std::abs(deviation.yaw_rad) > options_.max_deviation_rad) {
      return std::nullopt;
    }
    if (shift.position_m.norm() > settled_m || std::abs(shift.yaw_rad) > settled_rad) continue;
    if (fitted->share_agreeing < options_.least_share_agreeing ||
        fitted->correlation < options_.least_correlation) {
      return std::nullopt;
    }
    return concluded(alignment, fitted->covariance.topLeftCorner<3, 3>());
  }
  return std::nullopt;
}

VisualOdometryIncrement CeilingMotion::concluded(const Alignment& alignment,
                                                 const Eigen::Matrix3d& covariance_of_shift) const {
  Eigen::Matrix3d pose_by_shift = Eigen::Matrix3d::Identity();
  pose_by_shift.topRightCorner<2, 1>() << -alignment.keyframe_from_now.position_m.y(),
      alignment.keyframe_from_now.position_m.x();
  VisualOdometryIncrement motion{.from = *keyframe_stamp_,
                                 .to = current_at_,
                                 .then_from_now = alignment.keyframe_from_now,
                                 .sway_m = sway_m_};
  motion.covariance = pose_by_shift * covariance_of_shift * pose_by_shift.transpose();
  motion.covariance.diagonal() +=
      Vec3(square(options_.own_sigma_m), square(options_.own_sigma_m), square(options_.own_sigma_rad));
  return motion;
}

}  // namespace lodestar
