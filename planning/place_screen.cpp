#include "planning/place_screen.hpp"

#include <limits>

namespace lodestar {
namespace {

/// Above the rounding errors of single precision on maps of up to 40,000 cells a side.
constexpr float tolerance_cells = 0.02F;

/// Two unit vectors, mirrored where the path turns right: an arrival turns around the corner when both are to
/// its left, or the way on is straight ahead.
struct Wedge {
  float way_x = 0.0F;
  float way_y = 0.0F;
  float corner_x = 0.0F;
  float corner_y = 0.0F;
};

/// All zero, which lets each arrival pass, where way and corner are in line.
Wedge wedge_of(const std::optional<TurnAround>& turn) {
  if (!turn) return {};
  const double side = cross(turn->way, turn->to_corner);
  if (side == 0.0) return {};
  const double sign = side > 0.0 ? 1.0 : -1.0;
  const Vec2 way = sign * turn->way.normalized();
  const Vec2 corner = sign * turn->to_corner.normalized();
  return {static_cast<float>(way.x()), static_cast<float>(way.y()), static_cast<float>(corner.x()),
          static_cast<float>(corner.y())};
}

std::uint32_t flag(bool is_so) {
  return static_cast<std::uint32_t>(is_so);
}

}  // namespace

void PlaceScreen::clear() {
  x_.clear();
  y_.clear();
  way_before_cells_.clear();
}

void PlaceScreen::add(const Vec2& position, double way_before_cells) {
  x_.push_back(static_cast<float>(position.x()));
  y_.push_back(static_cast<float>(position.y()));
  way_before_cells_.push_back(static_cast<float>(way_before_cells));
}

void PlaceScreen::remove(std::uint32_t place) {
  way_before_cells_[place] = std::numeric_limits<float>::max();
}

/// The first loop has no branches, so that the compiler makes vector instructions of it.
std::span<const std::uint32_t> PlaceScreen::may_lead_to(const Vec2& here,
                                                        const std::optional<TurnAround>& turn,
                                                        double longest_cells) {
  const std::size_t count = x_.size();
  passes_.resize(count);
  const Wedge wedge = wedge_of(turn);
  const auto here_x = static_cast<float>(here.x());
  const auto here_y = static_cast<float>(here.y());
  const float longest = static_cast<float>(longest_cells) * (1.0F + 1e-5F) + tolerance_cells;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = here_x - x_[i];
    const float y = here_y - y_[i];
    const float off_way = x * wedge.way_y - y * wedge.way_x;
    const float off_corner = x * wedge.corner_y - y * wedge.corner_x;
    const float most = longest - way_before_cells_[i];
    passes_[i] = flag(off_way >= -tolerance_cells) &
                 (flag(off_corner >= -tolerance_cells) | flag(off_way <= tolerance_cells)) &
                 flag(most >= 0.0F) & flag(x * x + y * y <= most * most);
  }
  places_.clear();
  for (std::uint32_t i = 0; i < count; ++i)
    if (passes_[i] != 0) places_.push_back(i);
  return places_;
}

}  // namespace lodestar
