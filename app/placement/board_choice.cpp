#include "app/placement/board_choice.hpp"

#include <algorithm>
#include <utility>

namespace lodestar {
namespace {

/// From frame to frame, so that blur is less: a shutter is open for less than the period.
constexpr double still_px = 0.5;
/// Of the image's width, from each view taken.
constexpr double apart = 0.05;
/// Of a ChArUco board, two views may show different parts.
constexpr int least_in_common = 4;

/// Mean distance of the corners that both show; nothing where these are few.
std::optional<double> moved_px(const BoardView& a, const BoardView& b) {
  double sum_px = 0.0;
  int common = 0;
  for (std::size_t i = 0; i < a.points_m.size(); ++i) {
    const auto same = std::ranges::find(b.points_m, a.points_m[i]);
    if (same == b.points_m.end()) continue;
    sum_px += cv::norm(a.pixels[i] - b.pixels[static_cast<std::size_t>(same - b.points_m.begin())]);
    ++common;
  }
  return common >= least_in_common ? std::optional(sum_px / common) : std::nullopt;
}

}  // namespace

bool BoardChoice::takes(const std::optional<BoardView>& view) {
  const std::optional<BoardView> before = std::exchange(before_, view);
  if (!view || !before) return false;
  const std::optional<double> since_before_px = moved_px(*view, *before);
  if (!since_before_px || *since_before_px > still_px) return false;
  const bool is_new = std::ranges::all_of(taken_, [&](const BoardView& other) {
    const std::optional<double> way_px = moved_px(*view, other);
    return !way_px || *way_px > apart * width_px_;
  });
  if (is_new) taken_.push_back(*view);
  return is_new;
}

}  // namespace lodestar
