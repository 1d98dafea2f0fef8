#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "maps/geometry.hpp"

namespace lodestar {

/// The turn at a place: the way on from there, and the corner around which it turns, both as seen from it.
struct TurnAround {
  Vec2 way = Vec2::Zero();
  Vec2 to_corner = Vec2::Zero();
};

/// Looks at the legs from all places to one of them at once, in single precision, so that only the few that
/// may be of use are looked at one by one. It errs to the safe side: a place left out fails the exact tests.
class PlaceScreen {
 public:
  void clear();
  /// The longest useful leg from here is shorter by this much than one that begins at the start. In cells.
  void add(const Vec2& position, double way_before_cells);
  /// No leg from this place is of use any more.
  void remove(std::uint32_t place);

  /// Places from which a leg to here is no longer than `longest_cells` less the way before it, and arrives
  /// such that the path turns around the corner, not away from it. In order; valid until the next call.
  std::span<const std::uint32_t> may_lead_to(const Vec2& here, const std::optional<TurnAround>& turn,
                                             double longest_cells);

 private:
  std::vector<float> x_;
  std::vector<float> y_;
  std::vector<float> way_before_cells_;
  std::vector<std::uint32_t> passes_;  ///< one for each place: 1 or 0
  std::vector<std::uint32_t> places_;
};

}  // namespace lodestar
