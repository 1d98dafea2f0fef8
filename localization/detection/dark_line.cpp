#include "localization/detection/dark_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

namespace lodestar {
namespace {

constexpr double step_px = 0.5;

/// Bilinear, between the four pixels around a place.
double gray_at(const cv::Mat& gray, const Vec2& place_px) {
  const double left = std::floor(place_px.x());
  const double top = std::floor(place_px.y());
  const double fx = place_px.x() - left;
  const double fy = place_px.y() - top;
  const auto* const above = gray.ptr<std::uint8_t>(static_cast<int>(top)) + static_cast<std::ptrdiff_t>(left);
  const auto* const below = above + gray.step[0];
  return (1.0 - fy) * ((1.0 - fx) * above[0] + fx * above[1]) + fy * ((1.0 - fx) * below[0] + fx * below[1]);
}

/// One direction through a disc.
class Crossing {
 public:
  Crossing(const cv::Mat& gray, const DiscOnCeiling& disc, double angle_rad)
      : gray_(gray),
        disc_(disc),
        along_px_(disc.ring_px * std::cos(angle_rad), disc.ring_px * std::sin(angle_rad)),
        across_(-std::sin(angle_rad), std::cos(angle_rad)) {}

  /// Is it dark where this direction enters and leaves the ring?
  [[nodiscard]] bool is_dark() const {
    return !is_ceiling(disc_.center_px - along_px_) && !is_ceiling(disc_.center_px + along_px_);
  }

  /// Is the ceiling's level seen on both sides of a dot?
  [[nodiscard]] bool has_ceiling_beside() const {
    return std::isfinite(ceiling_beyond(disc_.center_px, across_, disc_.side_px) +
                         ceiling_beyond(disc_.center_px, -across_, disc_.side_px));
  }

  /// Is the line as dark within the disc as where it enters and leaves the ring, and not wider?
  [[nodiscard]] bool goes_on_inside() const {
    const Vec2 enters = disc_.center_px - along_px_;
    const Vec2 leaves = disc_.center_px + along_px_;
    const double line_gray = 0.5 * (gray_at(gray_, enters) + gray_at(gray_, leaves));
    if (std::abs(gray_at(gray_, disc_.center_px) - line_gray) > disc_.tolerance_gray) return false;
    const double width_px = width_at(disc_.center_px);
    return std::isfinite(width_px) &&
           width_px <= std::min(width_at(enters), width_at(leaves)) + 2.0 * step_px;
  }

 private:
  [[nodiscard]] bool is_ceiling(const Vec2& place_px) const {
    return gray_at(gray_, place_px) > disc_.level_gray - disc_.tolerance_gray;
  }

  /// Distance to the first pixel at the ceiling's level, from `start_px` to the ring; infinite if there is
  /// none.
  [[nodiscard]] double ceiling_beyond(const Vec2& from_px, const Vec2& towards, double start_px) const {
    for (double distance = start_px; distance <= disc_.ring_px; distance += step_px)
      if (is_ceiling(from_px + distance * towards)) return distance;
    return std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] double width_at(const Vec2& place_px) const {
    return ceiling_beyond(place_px, across_, 0.0) + ceiling_beyond(place_px, -across_, 0.0);
  }

  const cv::Mat& gray_;
  const DiscOnCeiling& disc_;
  Vec2 along_px_;
  Vec2 across_;
};

template <typename Test>
bool any_crossing(const cv::Mat& gray, const DiscOnCeiling& disc, const Test& test) {
  constexpr int directions = 32;  // of half a turn
  const double reach_px = std::numbers::sqrt2 * disc.ring_px + 2.0;
  const bool inside = disc.center_px.x() >= reach_px && disc.center_px.y() >= reach_px &&
                      disc.center_px.x() + reach_px < gray.cols && disc.center_px.y() + reach_px < gray.rows;
  if (!inside) return false;
  for (int i = 0; i < directions; ++i) {
    const Crossing crossing(gray, disc, std::numbers::pi * i / directions);
    if (crossing.is_dark() && test(crossing)) return true;
  }
  return false;
}

}  // namespace

bool is_before_dark_line(const cv::Mat& gray, const DiscOnCeiling& dot) {
  return any_crossing(gray, dot, [](const Crossing& crossing) { return crossing.has_ceiling_beside(); });
}

bool shows_dark_line(const cv::Mat& gray, const DiscOnCeiling& cell) {
  return any_crossing(gray, cell, [](const Crossing& crossing) { return crossing.goes_on_inside(); });
}

}  // namespace lodestar
