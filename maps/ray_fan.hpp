#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "maps/scan_rays.hpp"

namespace lodestar {

/// The rays of a scan by their direction, to find those that look at a point without asking all.
class RayFan {
 public:
  explicit RayFan(const DeskewedScan& scan);

  /// Does a ray pass the point within `aside_m` and go on for more than `before_end_m`?
  [[nodiscard]] bool passes(const Vec2& point_m, double aside_m, double before_end_m) const;

  /// Is the point on a surface that the rays beside it graze? The nearest on either side, within `aside_m`,
  /// meet it at a small angle, and between their ends, or up to `along_m` before or behind, it leads through
  /// there.
  [[nodiscard]] bool graze(const Vec2& point_m, double aside_m, double along_m) const;

  static constexpr std::size_t parts_across = 32;
  using PassedParts = std::bitset<parts_across>;

  /// Across the point, up to `aside_m` to its left and right: which parts of that do rays pass, and go on for
  /// more than `before_end_m`? One that was lost, or hit alone what is nearer than all around, may have met
  /// what is there, with half of its spot (a mixed pixel): then a part is not passed where there is room for
  /// a thin thing between the two beside it that pass. Nothing where a ray ends, nor without one that passes
  /// on either side of the point within `gap_m`: at the seam of a turn a robot that turns leaves a gap.
  [[nodiscard]] std::optional<PassedParts> passed_across(const Vec2& point_m, double aside_m,
                                                         double before_end_m, double gap_m) const;

 private:
  struct Line {
    Vec2 origin_m;
    Vec2 way;  ///< of length 1
    double length_m = 0.0;
    double turn = 0.0;      ///< pseudo-angle in [0, 4)
    bool is_lost = false;   ///< an invalid echo: nothing is known but its direction
    bool is_alone = false;  ///< nearer than both beside it

    [[nodiscard]] Vec2 end_m() const { return origin_m + length_m * way; }
  };
  /// How a ray looks past a point.
  struct Look {
    const Line& line;
    double aside_m = 0.0;   ///< positive: the point is on its left
    double beyond_m = 0.0;  ///< how far it goes on
  };

  /// That were not lost: with the point on their right, and on their left; null where there is none.
  [[nodiscard]] std::array<const Line*, 2> nearest_beside(const Vec2& point_m, double aside_m) const;
  template <typename More>
  void ask_beside(const Vec2& point_m, double aside_m, const More& more) const;

  std::vector<Line> lines_;          ///< by their turn
  std::vector<std::int32_t> first_;  ///< of each bin
  Vec2 middle_m_ = Vec2::Zero();     ///< of the origins
  double spread_m_ = 0.0;            ///< the farthest origin from there
};

}  // namespace lodestar
