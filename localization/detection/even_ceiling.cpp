#include "localization/detection/even_ceiling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace lodestar {
namespace {

constexpr std::size_t plane_samples = 32;

/// Gray values on a ring and their directions.
struct Ring {
  std::array<double, plane_samples> gray{};
  std::array<Vec2, plane_samples> direction;
};

Ring ring_around(const cv::Mat& gray, const Vec2& center_px, double radius_px) {
  Ring ring;
  for (std::size_t i = 0; i < plane_samples; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / plane_samples;
    ring.direction[i] = {std::cos(angle), std::sin(angle)};
    const Vec2 at = center_px + radius_px * ring.direction[i];
    ring.gray[i] = gray.ptr<std::uint8_t>(static_cast<int>(std::lround(at.y())))[std::lround(at.x())];
  }
  return ring;
}

/// Level in the ring's middle, and its rise over the ring's radius along x and y.
struct Plane {
  double level = 0.0;
  Vec2 rise = Vec2::Zero();
  [[nodiscard]] double at(const Vec2& direction) const { return level + rise.dot(direction); }
};

double quantile(std::array<double, plane_samples> values, double share) {
  auto* const at = values.data() + static_cast<std::size_t>(share * (plane_samples - 1));
  std::nth_element(values.data(), at, values.data() + values.size());
  return *at;
}

/// Iteratively reweighted least squares: samples count less the farther they are from the plane, and those
/// below it sooner, as lines are darker than the ceiling. It starts above the median and closes in: with wide
/// slots in the ring, the ceiling is the brighter part.
Plane plane_through(const Ring& ring, double noise_gray) {
  constexpr double start_share = 0.7;
  constexpr int iterations = 8;
  constexpr double noise_sigmas = 3.0;
  constexpr double above_to_below = 2.0;  // tolerance
  constexpr double to_sigma = 1.48;       // from the median absolute deviation
  Plane plane{.level = quantile(ring.gray, start_share)};
  for (int n = 0; n < iterations; ++n) {
    std::array<double, plane_samples> off{};
    for (std::size_t i = 0; i < plane_samples; ++i)
      off[i] = std::abs(ring.gray[i] - plane.at(ring.direction[i]));
    const double scale = std::max(noise_sigmas * noise_gray, to_sigma * quantile(off, 0.5) / (1 + n));
    Eigen::Matrix3d sum = 1e-3 * Eigen::Matrix3d::Identity();
    Vec3 right = Vec3::Zero();
    for (std::size_t i = 0; i < plane_samples; ++i) {
      const bool above = ring.gray[i] > plane.at(ring.direction[i]);
      const double weight = 1.0 / square(1.0 + square(off[i] / (above ? above_to_below * scale : scale)));
      const Vec3 row(1.0, ring.direction[i].x(), ring.direction[i].y());
      sum += weight * row * row.transpose();
      right += weight * (ring.gray[i] - plane.at(ring.direction[i])) * row;
    }
    const Vec3 change = sum.ldlt().solve(right);
    plane.level += change[0];
    plane.rise += change.tail<2>();
  }
  return plane;
}

}  // namespace

bool EvenCeiling::copy(const cv::Mat& gray, const Vec2& center_px, double ring_px, double noise_gray,
                       double least_light_gray) {
  const bool inside = center_px.x() >= ring_px + 1.0 && center_px.y() >= ring_px + 1.0 &&
                      center_px.x() + ring_px + 1.0 < gray.cols && center_px.y() + ring_px + 1.0 < gray.rows;
  if (!inside || ring_px > most_reach_px || gray.cols < side_px || gray.rows < side_px) return false;
  const Plane plane = plane_through(ring_around(gray, center_px, ring_px), noise_gray);
  const double filled_below = plane.level + least_light_gray;
  const int left =
      std::clamp(static_cast<int>(std::lround(center_px.x())) - side_px / 2, 0, gray.cols - side_px);
  const int top =
      std::clamp(static_cast<int>(std::lround(center_px.y())) - side_px / 2, 0, gray.rows - side_px);
  shift_px_ = -Vec2(left, top);
  center_px_ = center_px + shift_px_;
  background_gray_ = plane.level;
  const Vec2 rise_per_px = plane.rise / ring_px;
  const int reach = static_cast<int>(std::ceil(ring_px)) + 2;
  const auto column = static_cast<int>(std::lround(center_px_.x()));
  const auto row = static_cast<int>(std::lround(center_px_.y()));
  pixels_.fill(cv::saturate_cast<std::uint8_t>(plane.level));
  cv::Mat evened = this->gray();
  for (int v = std::max(row - reach, 0); v <= std::min(row + reach, side_px - 1); ++v) {
    const auto* const from = gray.ptr<std::uint8_t>(top + v) + left;
    auto* const to = evened.ptr<std::uint8_t>(v);
    for (int u = std::max(column - reach, 0); u <= std::min(column + reach, side_px - 1); ++u) {
      const double even = from[u] - rise_per_px.dot(Vec2(u, v) - center_px_);
      to[u] = cv::saturate_cast<std::uint8_t>(even < filled_below ? plane.level : even);
    }
  }
  return true;
}

}  // namespace lodestar
